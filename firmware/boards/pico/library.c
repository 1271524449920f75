/* What the core and the compiler ask of a C library: no other one is linked on this board. */
#include <math.h>
#include <stdint.h>
#include <string.h>

/* the compiler may not make calls of themselves out of these loops */
#if defined(__clang__)
#define LOOP __attribute__((used, no_builtin))
#else
#define LOOP __attribute__((used, optimize("no-tree-loop-distribute-patterns")))
#endif

LOOP void *memcpy(void *restrict to, const void *restrict from, size_t count)
{
    uint8_t *t = to;
    const uint8_t *f = from;
    if ((((uintptr_t)t | (uintptr_t)f) & 3) == 0) {
        for (; count >= 4; count -= 4, t += 4, f += 4) {
            *(uint32_t *)(void *)t = *(const uint32_t *)(const void *)f;
        }
    }
    while (count--) {
        *t++ = *f++;
    }
    return to;
}

LOOP void *memset(void *to, int byte, size_t count)
{
    for (uint8_t *t = to; count--;) {
        *t++ = (uint8_t)byte;
    }
    return to;
}

LOOP int memcmp(const void *a, const void *b, size_t count)
{
    for (const uint8_t *x = a, *y = b; count--; x++, y++) {
        if (*x != *y) {
            return *x - *y;
        }
    }
    return 0;
}

/* The root as IEEE 754 rounds it, to nearest: one bit of it after another, and whether anything is left. */
float sqrtf(float a)
{
    union {
        float f;
        uint32_t i;
    } s = {a};
    int32_t exponent = (int32_t)(s.i >> 23) - 127;
    uint32_t significand = s.i & UINT32_C(0x7fffff);
    if (s.i == UINT32_C(0x80000000) || s.i == 0 || s.i == UINT32_C(0x7f800000)) {
        return a;
    }
    if (s.i > UINT32_C(0x7f800000)) {
        return NAN; /* below zero, or nan */
    }
    if (exponent == -127) { /* subnormal */
        exponent = -126;
        while (!(significand & UINT32_C(0x800000))) {
            significand <<= 1;
            exponent--;
        }
    }
    significand = (significand | UINT32_C(0x800000)) << (exponent & 1);
    uint32_t rest = 0, root = 0, pairs = significand << 7; /* of bits, the highest first, of significand * 2^25 */
    for (uint8_t k = 0; k < 25; k++) {
        rest = rest << 2 | pairs >> 30;
        pairs <<= 2;
        const uint32_t trial = root << 2 | 1;
        root <<= 1;
        if (rest >= trial) {
            rest -= trial;
            root |= 1;
        }
    }
    root = (root >> 1) + (root & 1); /* a root is never halfway between two floats */
    s.i = ((uint32_t)((exponent >> 1) + 127) << 23) + (root - UINT32_C(0x800000));
    return s.f;
}
