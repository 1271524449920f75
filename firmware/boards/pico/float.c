/* Floats for a processor that has none: sum, product, quotient and comparisons as IEEE 754 rounds them, to nearest, denormals
 * and all. The compiler's own library is slower, and one unit beside the right denormal quotient now and then.
 *
 * A significand is worked on with three bits more, its leading one at bit 26: half a unit, and whether anything is left
 * below it. What is lost in shifting right stays as the lowest bit. */
#include <stdint.h>

#define SIGN UINT32_C(0x80000000)
#define INFINITE UINT32_C(0x7f800000)
#define NO_NUMBER UINT32_C(0x7fc00000)
#define FRACTION UINT32_C(0x7fffff)
#define ONE (UINT32_C(1) << 23)
#define LEADING (UINT32_C(1) << 26)
enum { MOST = 255, BIAS = 127, GUARD = 3, ALL_GONE = 27 };

typedef uint32_t bits;

bits __aeabi_fadd(bits a, bits b);
bits __aeabi_fsub(bits a, bits b);
bits __aeabi_fmul(bits a, bits b);
bits __aeabi_fdiv(bits a, bits b);
int __aeabi_fcmpeq(bits a, bits b);
int __aeabi_fcmplt(bits a, bits b);
int __aeabi_fcmple(bits a, bits b);
int __aeabi_fcmpgt(bits a, bits b);
int __aeabi_fcmpge(bits a, bits b);
int __aeabi_fcmpun(bits a, bits b);

static inline int is_nan(bits a)
{
    return a << 1 > INFINITE << 1;
}

static inline bits shifted_right(bits m, int32_t by)
{
    return by >= ALL_GONE ? m != 0 : m >> by | (m << (32 - by) != 0); /* by > 0 */
}

/* How far the leading one is below a place; m is not 0 and has nothing above that. */
static inline int32_t to_leading(bits m, bits leading)
{
    int32_t by = 0;
    for (int32_t step = 16; step; step >>= 1) {
        if (m < leading >> (step - 1)) {
            m <<= step;
            by += step;
        }
    }
    return by;
}

/* Round; `exponent` is at least 1, and 1 where the leading bit is missing. */
static inline bits rounded(bits sign, int32_t exponent, bits m)
{
    if (exponent >= MOST) {
        return sign | INFINITE;
    }
    const bits below = m & 7, number = ((bits)(exponent - 1) << 23) + (m >> GUARD); /* the leading bit counts as one exponent */
    return sign | (number + (below > 4 || (below == 4 && number & 1)));
}

/* The same for any exponent: what is too small loses bits first. */
static inline bits denormalised(bits sign, int32_t exponent, bits m)
{
    return exponent > 0 ? rounded(sign, exponent, m) : rounded(sign, 1, shifted_right(m, 1 - exponent));
}

bits __aeabi_fadd(bits a, bits b)
{
    if (a << 1 < b << 1) {
        const bits larger = b;
        b = a;
        a = larger;
    }
    int32_t exponent = a >> 23 & MOST, other = b >> 23 & MOST;
    if (exponent == MOST) {
        return is_nan(a) || (other == MOST && a != b) ? NO_NUMBER : a;
    }
    bits m = (a & FRACTION) << GUARD, n = (b & FRACTION) << GUARD;
    if (other) {
        m |= LEADING;
        n |= LEADING;
    } else if (exponent) {
        m |= LEADING;
        other = 1;
    } else {
        exponent = other = 1;
    }
    if (exponent != other) {
        n = shifted_right(n, exponent - other);
    }
    if (!((a ^ b) & SIGN)) {
        m += n;
        if (m >= 2 * LEADING) {
            m = m >> 1 | (m & 1);
            exponent++;
        }
        return rounded(a & SIGN, exponent, m);
    }
    m -= n;
    if (m == 0) {
        return 0;
    }
    if (m < LEADING) {
        int32_t by = to_leading(m, LEADING);
        by = by < exponent ? by : exponent - 1;
        m <<= by;
        exponent -= by;
    }
    return rounded(a & SIGN, exponent, m);
}

bits __aeabi_fsub(bits a, bits b)
{
    return __aeabi_fadd(a, b ^ SIGN);
}

/* Give a significand its leading one at ONE; a denormal's exponent goes below 1. */
static inline bits significand(bits a, int32_t *exponent)
{
    bits m = a & FRACTION;
    if (*exponent) {
        return m | ONE;
    }
    const int32_t by = to_leading(m, ONE);
    *exponent = 1 - by;
    return m << by;
}

bits __aeabi_fmul(bits a, bits b)
{
    const bits sign = (a ^ b) & SIGN;
    int32_t of_a = a >> 23 & MOST, of_b = b >> 23 & MOST;
    if (of_a == MOST || of_b == MOST) {
        return is_nan(a) || is_nan(b) || !(a << 1) || !(b << 1) ? NO_NUMBER : sign | INFINITE;
    }
    if (!(a << 1) || !(b << 1)) {
        return sign;
    }
    const bits m = significand(a, &of_a), n = significand(b, &of_b);
    /* 48 bits from four products of halves of 16 and 8 bits */
    const bits lowest = (m & 0xffff) * (n & 0xffff);
    const bits middle = (m >> 16) * (n & 0xffff) + (m & 0xffff) * (n >> 16) + (lowest >> 16);
    bits product = ((m >> 16) * (n >> 16) << 11) + (middle >> 5); /* without the lowest 21 bits */
    product |= (middle << 27 | lowest << 16) != 0;
    int32_t exponent = of_a + of_b - BIAS;
    if (product >= LEADING) {
        exponent++;
    } else {
        product <<= 1;
    }
    return denormalised(sign, exponent, product);
}

bits __aeabi_fdiv(bits a, bits b)
{
    const bits sign = (a ^ b) & SIGN;
    int32_t of_a = a >> 23 & MOST, of_b = b >> 23 & MOST;
    if (of_a == MOST || of_b == MOST) {
        if (is_nan(a) || is_nan(b) || of_a == of_b) {
            return NO_NUMBER;
        }
        return of_a == MOST ? sign | INFINITE : sign;
    }
    if (!(b << 1)) {
        return a << 1 ? sign | INFINITE : NO_NUMBER;
    }
    if (!(a << 1)) {
        return sign;
    }
    bits m = significand(a, &of_a), quotient = 0;
    const bits n = significand(b, &of_b);
    int32_t exponent = of_a - of_b + BIAS;
    if (m < n) {
        m <<= 1;
        exponent--;
    }
    /* 27 bits of 5 clocks each, where C takes 14: a comparison's carry is the next bit */
    __asm__(".rept 27\n\tcmp %0, %2\n\tbcc 1f\n\tsubs %0, %0, %2\n1:\tadcs %1, %1\n\tlsls %0, %0, #1\n\t.endr"
            : "+l"(m), "+l"(quotient)
            : "l"(n)
            : "cc");
    return denormalised(sign, exponent, quotient | (m != 0));
}

/* As whole numbers that grow with the float. */
static inline int32_t order(bits a)
{
    return a & SIGN ? (int32_t)(SIGN - a) : (int32_t)a;
}

int __aeabi_fcmpun(bits a, bits b)
{
    return is_nan(a) || is_nan(b);
}

int __aeabi_fcmpeq(bits a, bits b)
{
    return !is_nan(a) && !is_nan(b) && order(a) == order(b);
}

int __aeabi_fcmplt(bits a, bits b)
{
    return !is_nan(a) && !is_nan(b) && order(a) < order(b);
}

int __aeabi_fcmple(bits a, bits b)
{
    return !is_nan(a) && !is_nan(b) && order(a) <= order(b);
}

int __aeabi_fcmpgt(bits a, bits b)
{
    return __aeabi_fcmplt(b, a);
}

int __aeabi_fcmpge(bits a, bits b)
{
    return __aeabi_fcmple(b, a);
}
