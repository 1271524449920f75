"""Implicit damping: (M - h D) a = f, with D what damps of the slopes of f by the rates.

A damper that is stiff for its step, h b/m > 2, throws an explicit step further than it came from. With the force at the
end of the step, taken along its slope, it only stops. What drives (a negative damping, Van der Pol's) is left explicit,
since a step that trusts it divides by 1 - h d, and explodes where that is zero.
"""

import sympy as sp

from ...scene.notation.derivative import Partial
from ...scene.notation.symbols import t
from ..algebra.first_sample import numbers
from ..ir.structural_zeros import is_zero, minus, plus, scaled
from ..ir.trace import minimum, select, sqrt

#: a slope past this is that of no damper, nor is nan
STEEP = 1e18


def stiffened(M, f, coordinates, orders, translate, h, values):
    """(M - h D, f) as values, rows of negative mass turned over.

    Parameters
    ----------
    M, f : sequences of expressions
    coordinates : sequence, shape (N,)
        Of their rows.
    orders : sequence of int
        A coordinate of first order has no rate to be damped.
    translate : Translator
    h : float
        Step [s].
    values : dict name -> float
        Of parameters, for the signs of masses as written.
    """
    signs = [_sign(M[k][k], values) for k in range(len(f))]
    M, f = ([[sign * m for m in row] for sign, row in zip(signs, M, strict=True)],
            [sign * e for sign, e in zip(signs, f, strict=True)])  # fmt: skip
    rates = [q.diff(t) if order == 2 else None for q, order in zip(coordinates, orders, strict=True)]
    slopes = [[_slope(e, rate, translate) if own and rate else 0.0 for rate in rates] for own, e in zip(rates, f, strict=True)]
    M = [list(map(translate, row)) for row in M]

    def scale(i, j):
        alike = type(coordinates[i]).unit == type(coordinates[j]).unit
        return 1.0 if alike else sqrt(M[i][i] / M[j][j])

    D = dissipative(slopes, scale)
    return [[minus(m, scaled(h, d)) for m, d in zip(*rows, strict=True)] for rows in zip(M, D, strict=True)], list(
        map(translate, f)
    )


def dissipative(slopes, scale):
    """The symmetric D, none of whose eigenvalues is positive, that slopes have where they are those of dampers.

    Off the diagonal it is the symmetric part; on the diagonal the slope, or what outweighs the row where that is more.
    A damper between two coordinates, and each to the ground, is kept as it is; action stays reaction, which a diagonal
    D would break: it gives two bodies on one damper different impulses. What drives is left out; so is what turns
    (the part that is not symmetric), which does no work.

    Parameters
    ----------
    slopes : list of lists, shape (N, N)
    scale : callable i, j -> Value or float
        How row i weighs row j, so that a length beside an angle has no say in it: scale(i, j) scale(j, i) = 1.

    Examples
    --------
    >>> from hapticlab.compiler.methods.implicit_damping import dissipative
    >>> alike = lambda i, j: 1.0
    >>> dissipative([[-3.0, 3.0], [3.0, -3.0]], alike), dissipative([[2.0, 1.0], [-1.0, -1.0]], alike)
    ([[-3.0, 3.0], [3.0, -3.0]], [[0.0, 0.0], [0.0, -1.0]])
    """
    N = len(slopes)
    D = [[0.0] * N for _ in range(N)]
    for i in range(N):
        weight = 0.0
        for j in range(N):
            if j != i:
                first, second = (slopes[i][j], slopes[j][i]) if i < j else (slopes[j][i], slopes[i][j])
                D[i][j] = scaled(0.5, plus(first, second))
                if not is_zero(D[i][j]):
                    weight = plus(weight, abs(D[i][j]) * scale(i, j))
        outweighs = -weight if not is_zero(weight) else 0.0
        D[i][i] = outweighs if is_zero(slopes[i][i]) else minimum(slopes[i][i], outweighs)
    return D


def _slope(e, rate, translate):
    """The slope of a force by a rate; 0 at the tip of a root, such as a drag by sqrt(u'^2 + w'^2) has at rest."""
    slope = translate(Partial(e, rate))
    if all(power.exp.is_integer for power in e.atoms(sp.Pow)):
        return slope
    return select(abs(slope) < STEEP, slope, 0.0)


def _sign(m, values):
    found = numbers([m], values)
    return -1 if found is not None and found[0] < 0 else 1
