"""Where a polynomial first becomes negative on [0, 1], with the same work for every polynomial.

A guard of the motion is a polynomial p(theta) >= 0 of the step. Over omega h <= 1, one radian of its fastest part, p''
changes sign at most once, so p has at most one minimum inside: it is found first (a body that touches and leaves within
the step), and tells which interval holds the one sign change of p. Each root starts from the parabola through its
interval's ends and is polished by a fixed number of Newton steps held within the bracket. Quadratics are closed form.
Traced values, floats and arrays alike.
"""

import numpy as np

from ..ir.structural_zeros import ZERO, is_zero, plus, times
from ..ir.trace import Value, equal, maximum, select, sqrt

#: Newton steps for the bend, where a few digits do; for the minimum; for the root
STEPS = {"f64": (2, 3, 5), "f32": (1, 2, 4)}
#: the same where the motion turns by a tenth of a radian at most, so that a parabola is nearly right
FEWER_STEPS = {"f64": (1, 2, 4), "f32": (1, 1, 2)}


def horner(p, x):
    """Return p(x) for coefficients p, the constant first."""
    value = ZERO
    for c in reversed(p):
        value = plus(times(value, x), c)
    return value


def derivative(p):
    """Return the coefficients of p'."""
    return [times(float(k), c) for k, c in enumerate(p)][1:]


def degree(p):
    """Return the degree that the structural zeros leave."""
    return max((k for k, c in enumerate(p) if not is_zero(c)), default=0)


def scaled(p, length):
    """Return the coefficients of p on [0, length], taken as [0, 1]."""
    parts, power = [p[0]], length
    for c in p[1:]:
        parts.append(times(power, c))
        power = power * length
    return parts


def departing(p, just, level):
    """Return a gap or slip that was just let go without what rounding left of its first derivatives: it opens."""
    p = list(p)
    p[1] = select(just, maximum(p[1], 0.0), p[1])
    if level == 2:
        p[2] = select(just & (p[1] <= 0.0), maximum(p[2], 0.0), p[2])
    return p


def first_crossing(p, starts_at_zero=False, steps=None):
    """The first place in [0, 1] where p goes from positive to negative, and a condition that there is one.

    Parameters
    ----------
    p : list of coefficients, the constant first
        p(0) >= 0; a negative one is taken for the rounding of a zero. A root at 0 that p leaves upwards is divided out.
    starts_at_zero : bool, traced condition or array
        p(0) is known to be a root, whatever rounding left of it.
    steps : dict type -> (bend, minimum, root), optional
        Newton steps: STEPS unless given.

    Returns
    -------
    place, found
        place is 1 where nothing is found.

    Examples
    --------
    >>> import numpy as np
    >>> place, found = first_crossing([np.float64(c) for c in (1.0, -3.0, 0.0, 1.0)])
    >>> round(float(place), 12), bool(found)
    (0.347296355334, True)
    """
    n = degree(p)
    if n == 0:
        return 1.0, np.False_
    p = [np.float64(c) if isinstance(c, (int, float)) else c for c in p]
    start = maximum(select(starts_at_zero, 0.0 * p[1], p[0]) if starts_at_zero is not False else p[0], 0.0)
    p = [start, *p[1 : n + 1]]
    with np.errstate(all="ignore"):  # numbers divide by zero as every engine does; what comes of it is not selected
        place, found = _of_parabola(*p, *[0.0] * (2 - n)) if n <= 2 else _of_polynomial(p, steps or STEPS)
    return select(found, place, 1.0), found


def _of_parabola(c, b, a):
    if is_zero(a):
        return c / -b, (b < 0.0) & (b <= -c)
    inside = b * b - times(4.0, a * c)
    root = sqrt(maximum(inside, 0.0))
    place = select(b < 0.0, 2.0 * c / (root - b), (b + root) / (-2.0 * a))
    within = place <= 1.0
    return place, within & ((b < 0.0) & (0.0 <= inside) | (0.0 <= b) & (a < 0.0))


def _of_polynomial(p, steps):
    at_zero = equal(p[0], 0.0)
    q = [select(at_zero, below, above) for above, below in zip(p, [*p[1:], 0.0], strict=True)]
    steps = steps[next((c.type for c in q if isinstance(c, Value)), "f64")]
    first, second = derivative(q), derivative(derivative(q))
    bend = _bend(second, steps[0])
    slopes = q[1], horner(first, bend), horner(first, 1.0)
    early = (slopes[0] < 0.0) & (0.0 < slopes[1])
    late = (slopes[1] < 0.0) & (0.0 < slopes[2])
    start = select(late, bend, 0.0), -select(late, slopes[1], slopes[0])
    stop = select(early, bend, 1.0), -select(early, slopes[1], slopes[2])
    falling = [times(-1.0, c) for c in first]
    turns = early | late
    lowest = select(turns, between(falling, start, stop, steps[1]), 1.0)
    depth, end = horner(q, lowest), horner(q, 1.0)
    dips, ends = depth < 0.0, end < 0.0
    beyond = ~dips & turns
    low = select(beyond, lowest, 0.0), select(beyond, depth, q[0])
    place = between(q, low, (select(dips, lowest, 1.0), select(dips, depth, end)), steps[2])
    at_once = q[0] < 0.0
    return select(at_once, 0.0, place), at_once | dips | ends


def _bend(second, steps):
    """The place where p'' changes sign, 1 if there is none."""
    start, end = second[0], horner(second, 1.0)
    sign = select(end < start, 1.0, -1.0)
    falling = [times(sign, c) for c in second]
    return select(start * end < 0.0, between(falling, (0.0, sign * start), (1.0, sign * end), steps), 1.0)


def between(p, low, high, steps):
    """Return the root of p between two points (x, p(x)), p(low) >= 0 > p(high).

    It starts from the parabola through both with the slope at ``high``, exact for a double root there, and takes so
    many Newton steps, each held within what the signs leave.
    """
    (a, at_a), (b, at_b) = low, high
    slopes = derivative(p)
    slope, length = horner(slopes, b), b - a
    bend = (at_a - at_b + slope * length) / (length * length)
    root = sqrt(maximum(slope * slope - 4.0 * bend * at_b, 0.0))
    x = _within(b - select(0.0 < slope, (slope + root) / (2.0 * bend), 2.0 * at_b / (slope - root)), a, b)
    for _ in range(steps):
        value = horner(p, x)
        ahead = 0.0 <= value
        a, b = select(ahead, x, a), select(ahead, b, x)
        x = _within(x - value / horner(slopes, x), a, b)
    return x


def _within(x, a, b):
    """Return x if it lies in [a, b], else the middle; a nan lies nowhere."""
    return select((a <= x) & (x <= b), x, 0.5 * (a + b))
