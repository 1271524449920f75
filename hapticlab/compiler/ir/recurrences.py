"""Taylor series through an operation: coefficient k of its result, from those of its operands and its own before.

Griewank and Walther, *Evaluating Derivatives*, ch. 13. A series is a list of coefficients, the constant first; u and v are
those of the operands, w is the result's, known below k. A structural zero is never computed. ``rows`` keeps the series
beside w that a function needs: a sine its cosine, an arc tangent 1 + u^2. They are cut with all others.
"""

from .structural_zeros import ZERO, dot, is_zero, minus, plus, times
from .values import cos, select, sin


def product(a, b, k):
    """Coefficient k of a product of two series; of a square at half the work."""
    if a is not b:
        return dot(a[: k + 1], b[k::-1])
    half = (k + 1) // 2
    twice = times(2.0, dot(a[:half], a[k : k - half : -1] if half else []))
    return twice if k % 2 else plus(twice, times(a[k // 2], a[k // 2]))


def slope(a, k):
    """The coefficients k a_k, ..., 1 a_1 of the derivative, highest first."""
    return [times(float(j), a[j]) for j in range(k, 0, -1)]


def quotient(rows, k, w, u, v):
    return times(minus(u[k], dot(v[1 : k + 1], w[k - 1 :: -1])), 1.0 / v[0])


def root(rows, k, w, u):
    return times(minus(u[k], dot(w[1:k], w[k - 1 : 0 : -1])), 0.5 / w[0])


def choice(rows, k, w, condition, u, v):
    return ZERO if is_zero(u[k]) and is_zero(v[k]) else select(condition[0], u[k], v[k])


def exponential(rows, k, w, u):
    return times(dot(slope(u, k), w[:k]), 1.0 / k)


def logarithm(rows, k, w, u):
    return times(minus(u[k], times(dot(slope(w, k - 1), u[1:k]), 1.0 / k)), 1.0 / u[0])


def turned(rows, k, u):
    """Coefficient k of the sine and the cosine of u, which need each other."""
    sines = rows.setdefault(("sin", id(u)), [sin(u[0])])
    cosines = rows.setdefault(("cos", id(u)), [cos(u[0])])
    for j in range(len(sines), k + 1):
        rate = slope(u, j)
        sines.append(times(dot(rate, cosines[:j]), 1.0 / j))
        cosines.append(times(dot(rate, sines[:j]), -1.0 / j))
    return sines[k], cosines[k]


def arc_tangent(rows, k, w, u):
    above = rows.setdefault(("1 + u^2", id(u)), [1.0 + u[0] * u[0]])
    for j in range(len(above), k):
        above.append(product(u, u, j))
    return times(minus(u[k], times(dot(slope(w, k - 1), above[1:k]), 1.0 / k)), 1.0 / above[0])


def hyperbolic_tangent(rows, k, w, u):
    below = rows.setdefault(("1 - w^2", id(w)), [1.0 - w[0] * w[0]])
    for j in range(len(below), k):
        below.append(times(-1.0, product(w, w, j)))
    return times(dot(slope(u, k), below[:k]), 1.0 / k)
