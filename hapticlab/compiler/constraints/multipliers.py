"""Constrained equations of motion as straight-line arithmetic: M a = f + J^T lambda with J a = c.

Three ways to enforce a constraint, each of fixed cost: multipliers, the saddle-point matrix factored as LDL^T (its Schur
complement J M^-1 J^T appears as its last pivots); multipliers with Baumgarte's feedback on the drift; and embedding,
(B^T M B) a = B^T (f - M b), where the rates of all coordinates are B w + b of those that remain free.
The lines work on floats and on traced values. Baumgarte, Comput. Methods Appl. Mech. Eng. 1 (1972) 1-16; Hairer and
Wanner, *Solving Ordinary Differential Equations II*, section VII.2 (projection).
"""

from dataclasses import replace

import numpy as np

from ...errors import SceneError
from ..algebra.linear_solve import solve
from ..events.taylor_method import Taylor
from ..ir.structural_zeros import dot, is_zero, less_product, plus, scaled
from ..ir.trace import select
from ..methods.step_matrix import step_matrix

#: a pivot of J M^-1 J^T below this part of its first value is lost in rounding: J has lost a rank
LOST = {"f64": 4e-15, "f32": 2e-6}


def multipliers(M, J, f, c, tolerance=LOST["f64"]):
    """(a, reaction multipliers) with M a = f + J^T lambda and J a = c, M symmetric and positive definite.

    Where J has lost a rank the pivot is replaced by zero, so that the result is not finite: the motor goes off.

    Parameters
    ----------
    M : list of lists of Value or float, shape (N, N)
    J : list of lists, shape (m, N)
    f, c : lists, shapes (N,) and (m,)
    tolerance : float
        Part of its first value below which a pivot of J M^-1 J^T counts as zero.

    Examples
    --------
    >>> from hapticlab.compiler.constraints.multipliers import multipliers
    >>> multipliers([[2.0, 0.0], [0.0, 1.0]], [[1.0, -1.0]], [3.0, 0.0], [0.0])
    ([1.0, 1.0], [-1.0])
    """
    N, right = len(f), [*f, *c]
    K = [[*row, *(gradient[i] for gradient in J)] for i, row in enumerate(M)]
    K += [[*gradient, *([0.0] * len(c))] for gradient in J]
    L = [[0.0] * len(right) for _ in right]
    inverse, d = [], []
    for j in range(len(right)):
        scaled = [L[j][k] if is_zero(L[j][k]) else L[j][k] * d[k] for k in range(j)]
        pivot = first = K[j][j]
        for k in range(j):
            pivot = less_product(pivot, scaled[k], L[j][k])
            first = pivot if k == N - 1 else first
        if j > N:
            pivot = select(tolerance * abs(first) < abs(pivot), pivot, 0.0)
        d.append(pivot)
        inverse.append(1.0 / pivot)
        for i in range(j + 1, len(right)):
            entry = K[i][j]
            for k in range(j):
                entry = less_product(entry, L[i][k], scaled[k])
            L[i][j] = entry if is_zero(entry) else entry * inverse[j]
        for k in range(j):
            right[j] = less_product(right[j], L[j][k], right[k])
    solution = [value if is_zero(value) else value * inverse[j] for j, value in enumerate(right)]
    for j in reversed(range(len(right))):
        for i in range(j + 1, len(right)):
            solution[j] = less_product(solution[j], L[i][j], solution[i])
    return solution[:N], [-value for value in solution[N:]]


def stiffened(M, J, f, c, weight):
    """M + weight J^T J and f + weight J^T c: the same solution, and definite where M alone is not.

    A coordinate without mass of its own is determined by the constraints.
    """
    N = len(f)
    columns = [[gradient[i] for gradient in J] for i in range(N)]
    M = [list(row) for row in M]
    for i in range(N):
        for j in range(i + 1):
            M[i][j] = M[j][i] = plus(M[i][j], scaled(weight, dot(columns[i], columns[j])))
    return M, [plus(f[i], scaled(weight, dot(columns[i], c))) for i in range(N)]


def embedded(M, f, B, b, definite=True):
    """The accelerations w' of what remains free: (B^T M B) w' = B^T (f - M b).

    Parameters
    ----------
    M : list of lists of Value or float, shape (N, N)
    f : list, shape (N,)
    B : list of lists, shape (N, free)
        The rates of all coordinates are B w, and what time adds.
    b : list, shape (N,)
        Their accelerations are B w' + b.

    Examples
    --------
    >>> from hapticlab.compiler.constraints.multipliers import embedded
    >>> embedded([[2.0, 0.0], [0.0, 1.0]], [3.0, 0.0], [[1.0], [1.0]], [0.0, 0.0])
    [1.0]
    """
    rest = [plus(right, scaled(-1.0, dot(row, b))) for right, row in zip(f, M, strict=True)]
    columns = list(zip(*B, strict=True))
    moved = [[dot(row, column) for row in M] for column in columns]
    free = len(columns)
    A = [[0.0] * free for _ in range(free)]
    for i in range(free):
        for j in range(i + 1):
            A[i][j] = dot(columns[i], moved[j])
            # M itself may be unsymmetric when a student wrote the equations
            A[j][i] = A[i][j] if definite else dot(columns[j], moved[i])
    return solve(A, [dot(column, rest) for column in columns], definite)


def largest_feedback(method, most=100.0):
    """The largest alpha*h for which Baumgarte's feedback g'' + 2 alpha g' + alpha^2 g = 0 decays in a method.

    The step matrix of the method on that equation is formed and its spectral radius followed: 2 (sqrt(2) - 1) for
    semi-implicit Euler, 2.785 for RK4. A Taylor series is taken for steps of up to a radian of the fastest part, and
    the feedback is one: 1, within the 2 or more that every order is stable for.

    Examples
    --------
    >>> from hapticlab.compiler.constraints.multipliers import largest_feedback
    >>> from hapticlab.compiler.methods.method_table import METHODS
    >>> print(f"{largest_feedback(METHODS['semi_implicit_euler']):.6f} {largest_feedback(METHODS['rk4']):.6f}")
    0.828427 2.785294
    """
    if isinstance(method, Taylor):
        return 1.0
    if _radius(method, 1e-3) >= 1:
        raise SceneError(
            f"{method.name} does not damp a drift at any alpha. Use another method, or the projection, enforce='kkt'"
        )
    low = high = 1e-3
    while high < most and _radius(method, high) < 1:
        low, high = high, high * 1.05
    if high >= most:
        return most
    for _ in range(60):  # by halves, not by SciPy: half of it is written into programs, which keep their bits
        middle = (low + high) / 2
        low, high = (middle, high) if _radius(method, middle) < 1 else (low, middle)
    return low


def _radius(method, alpha_h):
    """The spectral radius of one step of h = 1; implicit damping is of forces, and has no part in a feedback."""
    J = np.array([[0.0, 1.0], [-(alpha_h**2), -2.0 * alpha_h]])
    return max(abs(np.linalg.eigvals(step_matrix(replace(method, implicit_damping=False), J, 1, 1.0))))


def check_feedback(alpha, method, h):
    """Refuse an alpha [1/s] that is not stable with this step [s]."""
    limit = largest_feedback(method) / h
    if not 0 < alpha < limit:
        raise SceneError(
            f"alpha = {alpha:g} 1/s: with {method.name} at steps of {h:g} s Baumgarte's feedback needs "
            f"0 < alpha < {limit:.4g} 1/s. Use half of that, smaller steps, or the projection, enforce='kkt'"
        )
