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

/* the largest whole number not above a */
static inline float hl_floorf(float a)
{
    if (!(hl_absf(a) < 8388608.0f)) {
        return a; /* from 2^23 on every float is whole; infinities and nan pass */
    }
    const float whole = (float)(int32_t)a;
    if (whole == a) {
        return a; /* keeps -0 */
    }
    return whole > a ? whole - 1.0f : whole;
}

/* 2^k for a whole k, held within the normal exponents; nan counts as 0 */
static inline float hl_exp2if(float k)
{
    hl_slot s;
    const int32_t whole = k != k ? 0 : k < -126.0f ? -126 : k > 127.0f ? 127 : (int32_t)k;
    s.i = (whole + 127) * INT32_C(0x800000);
    return s.f;
}

/* the exponent field of a, whatever its sign: floor(log2(a)) of a positive normal a */
static inline float hl_exponentf(float a)
{
    hl_slot s;
    s.f = a;
    return (float)(((s.i >> 23) & 255) - 127);
}

#endif
