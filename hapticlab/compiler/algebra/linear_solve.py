"""Solve M a = f as straight-line arithmetic: LDL^T where M is symmetric and definite, else LU with partial pivoting.

M is never inverted or factored in symbols, whose size grows eightfold per link. Golub and Van Loan, *Matrix
Computations*, sections 4.1.2, 4.2 and 3.4: a definite matrix needs no pivoting, any other does. Which row holds the
largest entry is known only at run time, so rows change places by selects; structural zeros are never compared, and
constants fold to plain code. Pivots are inverted once: a constant mass then costs one division for all the stages of a
method. A pivot that is zero all the same, of a singular M, gives a nan or an infinity, and so a fault.
"""

from ..ir.structural_zeros import is_zero, less_product
from ..ir.trace import Value, select


def solve(M, f, definite=False):
    """Return a with M a = f.

    Parameters
    ----------
    M : list of lists of Value or float, shape (N, N)
    f : list of Value or float, shape (N,)
    definite : bool
        M has eigenvalues of one sign wherever it is evaluated; where it is symmetric too, LDL^T solves it at half the
        cost.

    Raises
    ------
    ZeroDivisionError
        If a matrix of plain floats is singular.

    Examples
    --------
    >>> from hapticlab.compiler.algebra.linear_solve import solve
    >>> solve([[2.0, 1.0], [1.0, 3.0]], [4.0, 7.0])
    [1.0, 2.0]
    >>> solve([[0.0, 1.0], [1.0, 0.0]], [1.0, 2.0])
    [2.0, 1.0]
    """
    N = len(f)
    symmetric = all(same(M[i][j], M[j][i]) for i in range(N) for j in range(i))
    return _ldl(M, f) if definite and symmetric else _lu(M, f)


def same(a, b):
    """True of two entries that are the same value: value numbering has made equal expressions one."""
    return a.id == b.id if isinstance(a, Value) and isinstance(b, Value) else a is b or a == b


def _ldl(M, f):
    N = len(f)
    L, LD = ([[None] * N for _ in range(N)] for _ in range(2))  # entries divided by their pivot, and not yet
    inverse, y = [], list(f)
    for j in range(N):
        for i in range(j, N):
            entry = M[i][j]
            for k in range(j):
                entry = less_product(entry, L[i][k], LD[j][k])
            LD[i][j] = entry
        inverse.append(1.0 / LD[j][j])
        for i in range(j + 1, N):
            L[i][j] = LD[i][j] if is_zero(LD[i][j]) else LD[i][j] * inverse[j]
        for k in range(j):
            y[j] = less_product(y[j], L[j][k], y[k])
    a = [y[j] * inverse[j] for j in range(N)]
    for j in reversed(range(N)):
        for i in range(j + 1, N):
            a[j] = less_product(a[j], L[i][j], a[i])
    return a


def _lu(M, f):
    N = len(f)
    rows, inverse = [[*row, right] for row, right in zip(M, f, strict=True)], []
    for j in range(N):
        for i in range(j + 1, N):
            rows[j], rows[i] = _larger_first(rows[j], rows[i], j)
        inverse.append(1.0 / rows[j][j])
        for i in range(j + 1, N):
            if is_zero(rows[i][j]):
                continue
            factor = rows[i][j] * inverse[j]
            for k in range(j + 1, N + 1):
                rows[i][k] = less_product(rows[i][k], factor, rows[j][k])
    a = [None] * N
    for j in reversed(range(N)):
        total = rows[j][N]
        for k in range(j + 1, N):
            total = less_product(total, rows[j][k], a[k])
        a[j] = total * inverse[j]
    return a


def _larger_first(upper, lower, j):
    """Return the two rows, the one whose entry j is larger first; before j they are zero by now and not looked at."""
    if is_zero(lower[j]):
        return upper, lower
    if is_zero(upper[j]):
        return lower, upper
    swap = abs(upper[j]) < abs(lower[j])
    pairs = list(zip(upper[j:], lower[j:], strict=True))
    return (
        upper[:j] + [select(swap, b, a) for a, b in pairs],
        lower[:j] + [select(swap, a, b) for a, b in pairs],
    )
