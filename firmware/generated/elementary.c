/* Written by hapticlab/compiler/cheaders.py: change the Python tables, not this file. */

#include "elementary.h"
#include "mathf.h"

HL_NO_CONTRACTION

float hl_sinf(float x)
{
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
    const float t19 = t17 * t18;
    const float t21 = t18 * (-0x1.9ac9b00000000p-13f);
    const float t23 = t21 + 0x1.110c280000000p-7f;
    const float t24 = t18 * t23;
    const float t26 = t24 + (-0x1.5555520000000p-3f);
    const float t27 = t19 * t26;
    const float t28 = t17 + t27;
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
    const float t46 = t5 * 0x1.0000000000000p-2f;
    const float t47 = hl_floorf(t46);
    const float t49 = t47 * 0x1.0000000000000p+2f;
    const float t50 = t5 - t49;
    const int32_t t51 = 0x1.0000000000000p+0f == t50;
    const int32_t t53 = t50 == 0x1.8000000000000p+1f;
    const int32_t t54 = t51 | t53;
    const float t55 = t54 ? t44 : t28;
    const int32_t t57 = 0x1.8000000000000p+0f < t50;
    const float t58 = -t55;
    const float t59 = t57 ? t58 : t55;
    const int32_t t61 = x == 0x0.0p+0f;
    const float t62 = t61 ? x : t59;
    const float t63 = hl_absf(x);
    const int32_t t65 = t63 <= 0x1.0000000000000p+13f;
    const float t67 = t65 ? t62 : HL_NAN;
    return t67;
}

float hl_cosf(float x)
{
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
    const float t19 = t17 * t18;
    const float t21 = t18 * (-0x1.9ac9b00000000p-13f);
    const float t23 = t21 + 0x1.110c280000000p-7f;
    const float t24 = t18 * t23;
    const float t26 = t24 + (-0x1.5555520000000p-3f);
    const float t27 = t19 * t26;
    const float t28 = t17 + t27;
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
    const float t46 = t5 * 0x1.0000000000000p-2f;
    const float t47 = hl_floorf(t46);
    const float t49 = t47 * 0x1.0000000000000p+2f;
    const float t50 = t5 - t49;
    const int32_t t51 = 0x1.0000000000000p+0f == t50;
    const int32_t t53 = t50 == 0x1.8000000000000p+1f;
    const int32_t t54 = t51 | t53;
    const float t55 = t54 ? t28 : t44;
    const int32_t t57 = t50 == 0x1.0000000000000p+1f;
    const int32_t t58 = t51 | t57;
    const float t59 = -t55;
    const float t60 = t58 ? t59 : t55;
    const float t61 = hl_absf(x);
    const int32_t t63 = t61 <= 0x1.0000000000000p+13f;
    const float t65 = t63 ? t60 : HL_NAN;
    return t65;
}

float hl_expf(float x)
{
    const int32_t t2 = x < (-0x1.a000000000000p+6f);
    const float t3 = t2 ? (-0x1.a000000000000p+6f) : x;
    const int32_t t5 = 0x1.6400000000000p+6f < t3;
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

float hl_logf(float x)
{
    const int32_t t2 = x < 0x1.0000000000000p+0f;
    const float t5 = t2 ? 0x1.0000000000000p+24f : 0x1.0000000000000p-1f;
    const float t6 = x * t5;
    const float t7 = hl_exponentf(t6);
    const float t8 = -t7;
    const float t9 = hl_exp2if(t8);
    const float t10 = t6 * t9;
    const float t12 = t2 ? (-0x1.8000000000000p+4f) : 0x1.0000000000000p+0f;
    const float t13 = t7 + t12;
    const int32_t t15 = 0x1.6a09e60000000p+0f < t10;
    const float t16 = 0x1.0000000000000p-1f * t10;
    const float t17 = t15 ? t16 : t10;
    const float t18 = t17 - 0x1.0000000000000p+0f;
    const float t19 = 0x1.0000000000000p+0f + t13;
    const float t20 = t15 ? t19 : t13;
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
    const int32_t t46 = x <= 0x1.fffffe0000000p+127f;
    const float t47 = t46 ? t44 : x;
    const int32_t t49 = x == 0x0.0p+0f;
    const float t52 = t49 ? (-HL_INFINITY) : HL_NAN;
    const int32_t t53 = 0x0.0p+0f < x;
    const float t54 = t53 ? t47 : t52;
    return t54;
}

float hl_atanf(float x)
{
    const float t1 = hl_absf(x);
    const int32_t t3 = 0x1.0000000000000p-1f < t1;
    const int32_t t5 = 0x1.3504f40000000p+1f < t1;
    const float t8 = t1 - 0x1.0000000000000p+0f;
    const float t9 = t3 ? t8 : t1;
    const float t10 = t5 ? (-0x1.0000000000000p+0f) : t9;
    const float t11 = t1 + 0x1.0000000000000p+0f;
    const float t12 = t3 ? t11 : 0x1.0000000000000p+0f;
    const float t13 = t5 ? t1 : t12;
    const float t14 = t10 / t13;
    const float t15 = t14 * t14;
    const float t18 = t3 ? 0x1.0000000000000p+0f : 0x0.0p+0f;
    const float t19 = t5 ? 0x1.0000000000000p+1f : t18;
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
    const int32_t t42 = 0x0.0p+0f < x;
    const int32_t t43 = x < 0x0.0p+0f;
    const float t44 = -t41;
    const float t45 = t43 ? t44 : x;
    const float t46 = t42 ? t41 : t45;
    return t46;
}

float hl_tanhf(float x)
{
    const float t1 = hl_absf(x);
    const float t3 = t1 * 0x1.0000000000000p+1f;
    const int32_t t5 = 0x1.4000000000000p+4f < t3;
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
    const int32_t t41 = t9 == 0x0.0p+0f;
    const float t42 = t41 ? t1 : 0x0.0p+0f;
    const float t43 = t1 * t39;
    const float t44 = t33 - t43;
    const float t45 = t41 ? t44 : t39;
    const float t46 = 0x1.0000000000000p+1f + t39;
    const float t47 = t45 / t46;
    const float t48 = t42 + t47;
    const int32_t t49 = 0x0.0p+0f < x;
    const int32_t t50 = x < 0x0.0p+0f;
    const float t51 = -t48;
    const float t52 = t50 ? t51 : x;
    const float t53 = t49 ? t48 : t52;
    return t53;
}
