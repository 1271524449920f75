/* The primitive operations that C has no operator for, exact on every target.
 *
 * Floats are IEEE binary32, evaluated in their own precision and never contracted: build with -ffp-contract=off. */
#ifndef HL_MATHF_H
#define HL_MATHF_H

#include <float.h>
#include <math.h>
#include <stdint.h>

#if defined(FLT_EVAL_METHOD) && FLT_EVAL_METHOD != 0
#error "floats must be evaluated as float: on 32-bit x86 build with -msse2 -mfpmath=sse"
#endif

/* gcc does not know the standard pragma and says so at every file; there the flag does it */
#if defined(__GNUC__) && !defined(__clang__)
#define HL_NO_CONTRACTION
#else
#define HL_NO_CONTRACTION _Pragma("STDC FP_CONTRACT OFF")
#endif

/* A function that is much shorter and hardly slower where it is made small: an AVR has 32 KB for everything. */
#if defined(__AVR__)
#define HL_MADE_SMALL __attribute__((__optimize__("Os")))
#else
#define HL_MADE_SMALL
#endif

/* avr-libc has these as double */
#define HL_NAN ((float)NAN)
#define HL_INFINITY ((float)INFINITY)

/* one register: a float, an int32, or a bool as 0 or 1 */
typedef union {
    float f;
    int32_t i;
} hl_slot;

static inline int hl_is_finite(hl_slot a)
{
    return (a.i & INT32_C(0x7f800000)) != INT32_C(0x7f800000);
}

static inline float hl_absf(float a)
{
    hl_slot s;
    s.f = a;
    s.i &= INT32_C(0x7fffffff);
    return s.f;
}

/* its 32 bits */
static inline uint32_t hl_bits(float a)
{
    hl_slot s;
    s.f = a;
    return (uint32_t)s.i;
}

/* the exponent field of a; in two shifts that an 8-bit processor does by taking bytes */
static inline uint8_t hl_exponent_field(float a)
{
    return (uint8_t)((uint16_t)(hl_bits(a) >> 16) >> 7);
}

/* whether the bits of a are in a range: a comparison with a constant without a call on processors that have no floats.
 * Positive floats are ordered as their bits are, negative ones in reverse, nan lies outside either infinity. */
static inline int hl_bits_within(float a, uint32_t low, uint32_t high)
{
    return hl_bits(a) - low <= high - low;
}

static inline int hl_is_zero(float a)
{
    return (hl_bits(a) & UINT32_C(0x7fffffff)) == 0;
}

/* the largest whole number not above a, by clearing the bits of the fraction */
static inline float hl_floorf(float a)
{
    const uint8_t exponent = hl_exponent_field(a);
    hl_slot s;
    s.f = a;
    if (exponent >= 150) {
        return a; /* from 2^23 on every float is whole; infinities and nan pass */
    }
    if (exponent < 127) {
        return s.i >= 0 ? 0.0f : s.i == INT32_MIN ? a : -1.0f; /* keeps -0 */
    }
    int32_t fraction = INT32_C(0x7fffff);
    uint8_t whole_bits = (uint8_t)(exponent - 127);
    for (; whole_bits >= 8; whole_bits = (uint8_t)(whole_bits - 8)) {
        fraction >>= 8;
    }
    for (; whole_bits > 0; whole_bits--) {
        fraction >>= 1;
    }
    if (s.i < 0) {
        s.i += fraction; /* away from zero, if there is a fraction */
    }
    s.i &= ~fraction;
    return s.f;
}

/* k mod 4 for a whole k, |k| < 2^31: 0, 1, 2 or 3 */
static inline float hl_mod4f(float k)
{
    return (float)(uint8_t)((int32_t)k & 3);
}

/* 2^k for a whole k, held within the normal exponents; nan counts as 0 */
static inline float hl_exp2if(float k)
{
    hl_slot s;
    int16_t whole = 0;
    if (hl_exponent_field(k) < 134) { /* |k| < 128 */
        whole = (int16_t)(int32_t)k;
        whole = whole < -126 ? -126 : whole;
    } else if (k == k) {
        whole = k < 0.0f ? -126 : 127;
    }
    s.i = (int32_t)((uint32_t)(uint16_t)((whole + 127) << 7) << 16);
    return s.f;
}

/* the exponent field of a, whatever its sign: floor(log2(a)) of a positive normal a */
static inline float hl_exponentf(float a)
{
    return (float)((int16_t)hl_exponent_field(a) - 127);
}

#endif
