"""sin, cos, exp, log, atan, tanh as straight-line arithmetic, defined once for every engine.

The six functions below are traced, never called in a loop. Engines on this computer run the arithmetic that ``expand`` of
:mod:`~hapticlab.compiler.ir.trace` puts in their place, firmware/generated/elementary.c is the same trace printed as C: the
same bits everywhere, with no C library. Measured against mpmath (tests/compiler/ir/test_elementary.py): within 1.5 units in
the last place, in both types, for |x| <= 100 (sin, cos; 2.5 up to the limit of the angle) and everywhere (the others).

Reductions after W. J. Cody and W. Waite, Software Manual for the Elementary Functions (1980); the form of log after
P. T. P. Tang (1990). The polynomials interpolate at Chebyshev nodes; a test computes them again at 50 digits.
"""

import math
from dataclasses import dataclass

from .values import equal, exp2i, exponent, floor, select


@dataclass(frozen=True)
class Table:
    """Constants of one real type. Polynomials are in ascending powers.

    ``half_pi`` and ``ln2`` are sums of pieces so short that whole multiples are exact, all but the last, rounded piece.
    The first two pieces of ``half_pi`` also end where the remainder does (2**-24, 2**-53): taking them off is exact.
    """

    half_pi: tuple  # pi/2 in four pieces
    angle_limit: float  # [rad]; beyond it the pieces are too short, and a sample of an angle means nothing any more
    ln2: tuple
    exp_range: tuple  # outside it exp is 0 or inf
    tanh_limit: float  # 2x at which tanh x rounds to 1
    normal_shift: int  # 2**normal_shift makes every denormal number normal
    largest: float
    atan_of_1: tuple  # pi/4 in two pieces
    sin: tuple  # (sin r/r - 1)/r^2 in r^2, |r| <= pi/4
    cos: tuple  # (cos r - 1 + r^2/2)/r^4 in r^2, |r| <= pi/4
    exp: tuple  # (e^r - 1 - r)/r^2 in r, |r| <= ln(2)/2
    expm1: tuple  # the same on 0 <= r <= ln 2
    log: tuple  # (2 atanh(s)/s - 2)/s^2 in s^2, |s| <= 3 - 2 sqrt 2
    atan: tuple  # (atan t/t - 1)/t^2 in t^2, |t| <= 1/2


TABLES = {
    "f32": Table(
        half_pi=(1.5703125, 0.0004837512969970703, 7.549533620476723e-08, 2.5633440682570896e-12),
        angle_limit=8192.0,
        ln2=(0.693145751953125, 1.428606765330187e-06),
        exp_range=(-104.0, 89.0),
        tanh_limit=20.0,
        normal_shift=24,
        largest=3.4028234663852886e38,
        atan_of_1=(0.7853981852531433, -2.1855694143368964e-08),
        sin=(-0.166666641831398, 0.008332747966051102, -0.00019587890710681677),
        cos=(0.0416666641831398, -0.001388830249197781, 2.454794230288826e-05),
        exp=(0.5, 0.16666577756404877, 0.041666556149721146, 0.008363173343241215, 0.0013926175888627768),
        expm1=(
            0.5, 0.16666683554649353, 0.04166371747851372, 0.008351285941898823,
            0.001339999958872795, 0.0002582843881100416,
        ),
        log=(0.6666668653488159, 0.3998878002166748, 0.29579949378967285),
        atan=(
            -0.33333325386047363, 0.19998212158679962, -0.14227204024791718, 0.10422716289758682,
            -0.05581662803888321,
        ),
    ),
    "f64": Table(
        half_pi=(1.570796325802803, 9.920935184482005e-10, 6.123233932053594e-17, 6.36831716351095e-25),
        angle_limit=1e8,
        ln2=(0.6931471805598903, 5.497923018708371e-14),
        exp_range=(-746.0, 710.0),
        tanh_limit=40.0,
        normal_shift=54,
        largest=1.7976931348623157e308,
        atan_of_1=(0.7853981633974483, 3.061616997868383e-17),
        sin=(
            -0.16666666666666666, 0.008333333333330948, -0.00019841269836758574, 2.755731610255244e-06,
            -2.5051131845003624e-08, 1.5918129294866608e-10,
        ),
        cos=(
            0.041666666666666664, -0.0013888888888887398, 2.480158729876569e-05, -2.7557317271729793e-07,
            2.08761462684032e-09, -1.1382632425521717e-11,
        ),
        exp=(
            0.5000000000000001, 0.16666666666666669, 0.041666666666624164, 0.008333333333330065,
            0.0013888888917196719, 0.00019841269863040545, 2.4801521322368692e-05, 2.7557268480310024e-06,
            2.7620075879983367e-07, 2.5100375832561234e-08,
        ),
        expm1=(
            0.5, 0.16666666666666605, 0.04166666666670265, 0.008333333332525018,
            0.0013888888981905408, 0.0001984126360594814, 2.480184735670985e-05, 2.755037500589881e-06,
            2.7675822427424673e-07, 2.3809145859037096e-08, 2.8057924179166324e-09,
        ),
        log=(
            0.666666666666667, 0.39999999999899505, 0.28571428625975487, 0.2222221113479508,
            0.18182889125261723, 0.15331721600556042, 0.14616449685043406,
        ),
        atan=(
            -0.33333333333333326, 0.199999999999916, -0.14285714284106285, 0.11111110990139533,
            -0.09090904370311348, 0.07692198451257941, -0.06665052856794013, 0.058664967492257074,
            -0.05157516225552972, 0.04283578705573422, -0.02895352123252625, 0.011152908092096216,
        ),
    ),
}  # fmt: skip


def _table(x):
    return TABLES[x.type]


def _const(x, value):
    """Return a constant of x's type, for the arms of a select."""
    return x.builder.const(value, x.type)


def _polynomial(coefficients, z):
    """Evaluate by Horner's rule."""
    total = coefficients[-1]
    for c in coefficients[-2::-1]:
        total = total * z + c
    return total


def _odd(x, y):
    """Give y, computed from abs(x), the sign of x; zeros and nan pass as they are."""
    return select(0.0 < x, y, select(x < 0.0, -y, x))


def _quarter_turns(x):
    """Return sin and cos of what is left of x after k quarter turns, and k mod 4."""
    c1, c2, c3, c4 = _table(x).half_pi
    k = floor(x * (2 / math.pi) + 0.5)
    r = ((x - k * c1) - k * c2) - k * c3 - k * c4
    z = r * r
    s = r + r * z * _polynomial(_table(x).sin, z)
    h = z * 0.5
    w = 1.0 - h
    c = w + (((1.0 - w) - h) + z * z * _polynomial(_table(x).cos, z))  # 1 - h to twice the precision
    return s, c, k - floor(k * 0.25) * 4.0


def _within_angle_limit(x, y):
    return select(abs(x) <= _table(x).angle_limit, y, _const(x, math.nan))


def sin(x):
    s, c, quarter = _quarter_turns(x)
    y = select(equal(quarter, 1.0) | equal(quarter, 3.0), c, s)
    y = select(1.5 < quarter, -y, y)
    return _within_angle_limit(x, select(equal(x, 0.0), x, y))


def cos(x):
    s, c, quarter = _quarter_turns(x)
    first, third = equal(quarter, 1.0), equal(quarter, 3.0)
    y = select(first | third, s, c)
    return _within_angle_limit(x, select(first | equal(quarter, 2.0), -y, y))


def exp(x):
    table = _table(x)
    low, high = table.exp_range
    held = select(x < low, _const(x, low), x)  # in this order nan stays nan
    held = select(high < held, _const(x, high), held)
    k = floor(held * (1 / math.log(2)) + 0.5)
    r = (held - k * table.ln2[0]) - k * table.ln2[1]
    y = 1.0 + (r + r * r * _polynomial(table.exp, r))
    half = floor(k * 0.5)  # in two steps: 2**k itself may be denormal or past the largest number
    return (y * exp2i(half)) * exp2i(k - half)


def log(x):
    table = _table(x)
    shift = table.normal_shift
    small = x < 1.0
    normal = x * select(small, _const(x, 2.0**shift), _const(x, 0.5))
    e = exponent(normal)
    m = normal * exp2i(-e)
    e = e + select(small, _const(x, -shift), _const(x, 1.0))
    above = math.sqrt(2) < m
    f = select(above, m * 0.5, m) - 1.0
    e = select(above, e + 1.0, e)
    s = f / (2.0 + f)
    z = s * s
    h = 0.5 * f * f
    y = e * table.ln2[0] - ((h - (s * (h + z * _polynomial(table.log, z)) + e * table.ln2[1])) - f)
    y = select(x <= table.largest, y, x)
    at_most_0 = select(equal(x, 0.0), _const(x, -math.inf), _const(x, math.nan))
    return select(0.0 < x, y, at_most_0)


def atan(x):
    table = _table(x)
    a = abs(x)
    middle, far = 0.5 < a, 1 + math.sqrt(2) < a
    above = select(far, _const(x, -1.0), select(middle, a - 1.0, a))
    t = above / select(far, a, select(middle, a + 1.0, _const(x, 1.0)))
    z = t * t
    quarters = select(far, _const(x, 2.0), select(middle, _const(x, 1.0), _const(x, 0.0)))
    high, low = table.atan_of_1
    y = quarters * high + (t + (t * z * _polynomial(table.atan, z) + quarters * low))
    return _odd(x, y)


def tanh(x):
    table = _table(x)
    twice = abs(x) * 2.0
    twice = select(table.tanh_limit < twice, _const(x, table.tanh_limit), twice)
    k = floor(twice * (1 / math.log(2)))
    r = (twice - k * table.ln2[0]) - k * table.ln2[1]
    q = r * r * _polynomial(table.expm1, r)
    scale = exp2i(k)
    e = scale * (r + q) + (scale - 1.0)  # exp(2|x|) - 1
    near = equal(k, 0.0)  # there r = 2|x| exactly, and e/(e + 2) = |x| + (q - |x| e)/(e + 2)
    a = abs(x)
    y = select(near, a, _const(x, 0.0)) + select(near, q - a * e, e) / (e + 2.0)
    return _odd(x, y)
