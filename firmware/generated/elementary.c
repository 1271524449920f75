/* Written by hapticlab/compiler/boards/c_headers.py: change the Python tables, not this file. */

#include "elementary.h"
#include "mathf.h"

HL_NO_CONTRACTION

float hl_sinf(float x)
{
    const float t63 = hl_absf(x);
    const int t65 = hl_bits_within(t63, 0x00000000UL, 0x46000000UL);
    float t67 = HL_NAN;
    if (t65) {
        const int t61 = hl_is_zero(x);
        float t62;
        if (t61) {
            t62 = x;
        } else {
            const float t2 = x * 0x1.45f3060000000p-1f;
            const float t4 = t2 + 0x1.0000000000000p-1f;
            const float t5 = hl_floorf(t4);
            const float t7 = t5 * 0x1.9200000000000p+0f;
            const float t8 = x - t7;
            const float t10 = t5 * 0x1.fb40000000000p-12f;
            const float t11 = t8 - t10;
            const float t13 = t5 * 0x1.4440000000000p-24f;
            const float t14 = t11 - t13;
            const float t16 = t5 * 0x1.68c2340000000p-39f;
            const float t17 = t14 - t16;
            const float t18 = t17 * t17;
            const float t50 = hl_mod4f(t5);
            const int t51 = hl_bits_within(t50, 0x3f800000UL, 0x3f800000UL);
            const int t53 = hl_bits_within(t50, 0x40400000UL, 0x40400000UL);
            const int t54 = t51 | t53;
            float t55;
            if (t54) {
                const float t29 = 0x1.0000000000000p-1f * t18;
                const float t31 = 0x1.0000000000000p+0f - t29;
                const float t32 = 0x1.0000000000000p+0f - t31;
                const float t33 = t32 - t29;
                const float t34 = t18 * t18;
                const float t36 = t18 * 0x1.9bd89c0000000p-16f;
                const float t38 = t36 + (-0x1.6c12d20000000p-10f);
                const float t39 = t18 * t38;
                const float t41 = t39 + 0x1.5555540000000p-5f;
                const float t42 = t34 * t41;
                const float t43 = t33 + t42;
                const float t44 = t31 + t43;
                t55 = t44;
            } else {
                const float t19 = t17 * t18;
                const float t21 = t18 * (-0x1.9ac9b00000000p-13f);
                const float t23 = t21 + 0x1.110c280000000p-7f;
                const float t24 = t18 * t23;
                const float t26 = t24 + (-0x1.5555520000000p-3f);
                const float t27 = t19 * t26;
                const float t28 = t17 + t27;
                t55 = t28;
            }
            const int t57 = hl_bits_within(t50, 0x3fc00001UL, 0x7f800000UL);
            float t59 = t55;
            if (t57) {
                const float t58 = -t55;
                t59 = t58;
            }
            t62 = t59;
        }
        t67 = t62;
    }
    return t67;
}

float hl_cosf(float x)
{
    const float t61 = hl_absf(x);
    const int t63 = hl_bits_within(t61, 0x00000000UL, 0x46000000UL);
    float t65 = HL_NAN;
    if (t63) {
        const float t2 = x * 0x1.45f3060000000p-1f;
        const float t4 = t2 + 0x1.0000000000000p-1f;
        const float t5 = hl_floorf(t4);
        const float t7 = t5 * 0x1.9200000000000p+0f;
        const float t8 = x - t7;
        const float t10 = t5 * 0x1.fb40000000000p-12f;
        const float t11 = t8 - t10;
        const float t13 = t5 * 0x1.4440000000000p-24f;
        const float t14 = t11 - t13;
        const float t16 = t5 * 0x1.68c2340000000p-39f;
        const float t17 = t14 - t16;
        const float t18 = t17 * t17;
        const float t50 = hl_mod4f(t5);
        const int t51 = hl_bits_within(t50, 0x3f800000UL, 0x3f800000UL);
        const int t53 = hl_bits_within(t50, 0x40400000UL, 0x40400000UL);
        const int t54 = t51 | t53;
        float t55;
        if (t54) {
            const float t19 = t17 * t18;
            const float t21 = t18 * (-0x1.9ac9b00000000p-13f);
            const float t23 = t21 + 0x1.110c280000000p-7f;
            const float t24 = t18 * t23;
            const float t26 = t24 + (-0x1.5555520000000p-3f);
            const float t27 = t19 * t26;
            const float t28 = t17 + t27;
            t55 = t28;
        } else {
            const float t29 = 0x1.0000000000000p-1f * t18;
            const float t31 = 0x1.0000000000000p+0f - t29;
            const float t32 = 0x1.0000000000000p+0f - t31;
            const float t33 = t32 - t29;
            const float t34 = t18 * t18;
            const float t36 = t18 * 0x1.9bd89c0000000p-16f;
            const float t38 = t36 + (-0x1.6c12d20000000p-10f);
            const float t39 = t18 * t38;
            const float t41 = t39 + 0x1.5555540000000p-5f;
            const float t42 = t34 * t41;
            const float t43 = t33 + t42;
            const float t44 = t31 + t43;
            t55 = t44;
        }
        const int t57 = hl_bits_within(t50, 0x40000000UL, 0x40000000UL);
        const int t58 = t51 | t57;
        float t60 = t55;
        if (t58) {
            const float t59 = -t55;
            t60 = t59;
        }
        t65 = t60;
    }
    return t65;
}

HL_MADE_SMALL
float hl_expf(float x)
{
    const int t2 = hl_bits_within(x, 0xc2d00001UL, 0xff800000UL);
    const float t3 = t2 ? (-0x1.a000000000000p+6f) : x;
    const int t5 = hl_bits_within(t3, 0x42b20001UL, 0x7f800000UL);
    const float t6 = t5 ? 0x1.6400000000000p+6f : t3;
    const float t8 = t6 * 0x1.7154760000000p+0f;
    const float t10 = t8 + 0x1.0000000000000p-1f;
    const float t11 = hl_floorf(t10);
    const float t13 = t11 * 0x1.62e4000000000p-1f;
    const float t14 = t6 - t13;
    const float t16 = t11 * 0x1.7f7d1c0000000p-20f;
    const float t17 = t14 - t16;
    const float t18 = t17 * t17;
    const float t20 = t17 * 0x1.6d10fc0000000p-10f;
    const float t22 = t20 + 0x1.120b620000000p-7f;
    const float t23 = t17 * t22;
    const float t25 = t23 + 0x1.55551a0000000p-5f;
    const float t26 = t17 * t25;
    const float t28 = t26 + 0x1.5554de0000000p-3f;
    const float t29 = t17 * t28;
    const float t30 = 0x1.0000000000000p-1f + t29;
    const float t31 = t18 * t30;
    const float t32 = t17 + t31;
    const float t34 = t32 + 0x1.0000000000000p+0f;
    const float t35 = 0x1.0000000000000p-1f * t11;
    const float t36 = hl_floorf(t35);
    const float t37 = hl_exp2if(t36);
    const float t38 = t34 * t37;
    const float t39 = t11 - t36;
    const float t40 = hl_exp2if(t39);
    const float t41 = t38 * t40;
    return t41;
}

HL_MADE_SMALL
float hl_logf(float x)
{
    const int t53 = hl_bits_within(x, 0x00000001UL, 0x7f800000UL);
    float t54;
    if (t53) {
        const int t46 = x <= 0x1.fffffe0000000p+127f;
        float t47 = x;
        if (t46) {
            const int t2 = x < 0x1.0000000000000p+0f;
            const float t5 = t2 ? 0x1.0000000000000p+24f : 0x1.0000000000000p-1f;
            const float t6 = x * t5;
            const float t7 = hl_exponentf(t6);
            const float t8 = -t7;
            const float t9 = hl_exp2if(t8);
            const float t10 = t6 * t9;
            const float t12 = t2 ? (-0x1.8000000000000p+4f) : 0x1.0000000000000p+0f;
            const float t13 = t7 + t12;
            const int t15 = hl_bits_within(t10, 0x3fb504f4UL, 0x7f800000UL);
            float t17 = t10;
            if (t15) {
                const float t16 = 0x1.0000000000000p-1f * t10;
                t17 = t16;
            }
            const float t18 = t17 - 0x1.0000000000000p+0f;
            float t20 = t13;
            if (t15) {
                const float t19 = 0x1.0000000000000p+0f + t13;
                t20 = t19;
            }
            const float t22 = t18 + 0x1.0000000000000p+1f;
            const float t23 = t18 / t22;
            const float t24 = t23 * t23;
            const float t25 = 0x1.0000000000000p-1f * t18;
            const float t26 = t18 * t25;
            const float t28 = t20 * 0x1.62e4000000000p-1f;
            const float t30 = t24 * 0x1.2ee6100000000p-2f;
            const float t32 = t30 + 0x1.997c300000000p-2f;
            const float t33 = t24 * t32;
            const float t35 = t33 + 0x1.55555c0000000p-1f;
            const float t36 = t24 * t35;
            const float t37 = t26 + t36;
            const float t38 = t23 * t37;
            const float t40 = t20 * 0x1.7f7d1c0000000p-20f;
            const float t41 = t38 + t40;
            const float t42 = t26 - t41;
            const float t43 = t42 - t18;
            const float t44 = t28 - t43;
            t47 = t44;
        }
        t54 = t47;
    } else {
        const int t49 = hl_is_zero(x);
        const float t52 = t49 ? (-HL_INFINITY) : HL_NAN;
        t54 = t52;
    }
    return t54;
}

float hl_atanf(float x)
{
    const float t1 = hl_absf(x);
    const int t3 = hl_bits_within(t1, 0x3f000001UL, 0x7f800000UL);
    const int t5 = hl_bits_within(t1, 0x401a827bUL, 0x7f800000UL);
    float t10;
    if (t5) {
        t10 = (-0x1.0000000000000p+0f);
    } else {
        float t9 = t1;
        if (t3) {
            const float t8 = t1 - 0x1.0000000000000p+0f;
            t9 = t8;
        }
        t10 = t9;
    }
    float t13;
    if (t5) {
        t13 = t1;
    } else {
        float t12 = 0x1.0000000000000p+0f;
        if (t3) {
            const float t11 = t1 + 0x1.0000000000000p+0f;
            t12 = t11;
        }
        t13 = t12;
    }
    const float t14 = t10 / t13;
    const float t15 = t14 * t14;
    float t19;
    if (t5) {
        t19 = 0x1.0000000000000p+1f;
    } else {
        const float t18 = t3 ? 0x1.0000000000000p+0f : 0x0.0p+0f;
        t19 = t18;
    }
    const float t21 = t19 * 0x1.921fb60000000p-1f;
    const float t22 = t14 * t15;
    const float t24 = t15 * (-0x1.c93ff40000000p-5f);
    const float t26 = t24 + 0x1.aaea1a0000000p-4f;
    const float t27 = t15 * t26;
    const float t29 = t27 + (-0x1.235f860000000p-3f);
    const float t30 = t15 * t29;
    const float t32 = t30 + 0x1.99903a0000000p-3f;
    const float t33 = t15 * t32;
    const float t35 = t33 + (-0x1.5555500000000p-2f);
    const float t36 = t22 * t35;
    const float t38 = t19 * (-0x1.777a5c0000000p-26f);
    const float t39 = t36 + t38;
    const float t40 = t14 + t39;
    const float t41 = t21 + t40;
    const int t42 = hl_bits_within(x, 0x00000001UL, 0x7f800000UL);
    float t46;
    if (t42) {
        t46 = t41;
    } else {
        const int t43 = hl_bits_within(x, 0x80000001UL, 0xff800000UL);
        float t45 = x;
        if (t43) {
            const float t44 = -t41;
            t45 = t44;
        }
        t46 = t45;
    }
    return t46;
}

HL_MADE_SMALL
float hl_tanhf(float x)
{
    const float t1 = hl_absf(x);
    const float t3 = t1 * 0x1.0000000000000p+1f;
    const int t5 = hl_bits_within(t3, 0x41a00001UL, 0x7f800000UL);
    const float t6 = t5 ? 0x1.4000000000000p+4f : t3;
    const float t8 = t6 * 0x1.7154760000000p+0f;
    const float t9 = hl_floorf(t8);
    const float t11 = t9 * 0x1.62e4000000000p-1f;
    const float t12 = t6 - t11;
    const float t14 = t9 * 0x1.7f7d1c0000000p-20f;
    const float t15 = t12 - t14;
    const float t16 = t15 * t15;
    const float t18 = t15 * 0x1.0ed4b00000000p-12f;
    const float t20 = t18 + 0x1.5f45e00000000p-10f;
    const float t21 = t15 * t20;
    const float t23 = t21 + 0x1.11a7aa0000000p-7f;
    const float t24 = t15 * t23;
    const float t26 = t24 + 0x1.554f260000000p-5f;
    const float t27 = t15 * t26;
    const float t29 = t27 + 0x1.55556c0000000p-3f;
    const float t30 = t15 * t29;
    const float t32 = t30 + 0x1.0000000000000p-1f;
    const float t33 = t16 * t32;
    const float t34 = hl_exp2if(t9);
    const float t35 = t15 + t33;
    const float t36 = t34 * t35;
    const float t38 = t34 - 0x1.0000000000000p+0f;
    const float t39 = t36 + t38;
    const int t41 = hl_is_zero(t9);
    const float t42 = t41 ? t1 : 0x0.0p+0f;
    float t45 = t39;
    if (t41) {
        const float t43 = t1 * t39;
        const float t44 = t33 - t43;
        t45 = t44;
    }
    const float t46 = 0x1.0000000000000p+1f + t39;
    const float t47 = t45 / t46;
    const float t48 = t42 + t47;
    const int t49 = hl_bits_within(x, 0x00000001UL, 0x7f800000UL);
    float t53;
    if (t49) {
        t53 = t48;
    } else {
        const int t50 = hl_bits_within(x, 0x80000001UL, 0xff800000UL);
        float t52 = x;
        if (t50) {
            const float t51 = -t48;
            t52 = t51;
        }
        t53 = t52;
    }
    return t53;
}
