"""Solve M a = f as straight-line arithmetic: LDL^T where M is symmetric, else LU. Structural zeros cost nothing.

M is never inverted or factored in symbols, whose size grows eightfold per link. Golub and Van Loan, *Matrix
Computations*, sections 4.1.2 and 3.2. Pivots are inverted once: a constant mass then costs one division for all the
stages of a method. A pivot that reaches zero gives a nan or an infinity, and so a fault.
"""

from .trace import Value


def solve(M, f):
    """Return a with M a = f.

    Parameters
    ----------
    M : list of lists of Value or float, shape (N, N)
    f : list of Value or float, shape (N,)

    Examples
    --------
    >>> from hapticlab.compiler.solve import solve
    >>> solve([[2.0, 1.0], [1.0, 3.0]], [4.0, 7.0])
    [1.0, 2.0]
    """
    N = len(f)
    symmetric = all(_same(M[i][j], M[j][i]) for i in range(N) for j in range(i))
    return _ldl(M, f) if symmetric else _lu(M, f)


def _same(a, b):
    """Tell whether two entries are the same value: value numbering has made equal expressions one."""
    return a.id == b.id if isinstance(a, Value) and isinstance(b, Value) else a is b or a == b


def _zero(a):
    return (a.constant if isinstance(a, Value) else a) == 0


def _less_product(a, b, c):
    """Return a - b * c, untouched where the product is a structural zero."""
    if _zero(b) or _zero(c):
        return a
    return -(b * c) if _zero(a) else a - b * c


def _ldl(M, f):
    N = len(f)
    L = [[None] * N for _ in range(N)]
    d, inverse, y = [], [], list(f)
    for j in range(N):
        scaled = [L[j][k] * d[k] if not _zero(L[j][k]) else L[j][k] for k in range(j)]
        pivot = M[j][j]
        for k in range(j):
            pivot = _less_product(pivot, scaled[k], L[j][k])
        d.append(pivot)
        inverse.append(1.0 / pivot)
        for i in range(j + 1, N):
            entry = M[i][j]
            for k in range(j):
                entry = _less_product(entry, L[i][k], scaled[k])
            L[i][j] = entry if _zero(entry) else entry * inverse[j]
        for k in range(j):
            y[j] = _less_product(y[j], L[j][k], y[k])
    a = [y[j] * inverse[j] for j in range(N)]
    for j in reversed(range(N)):
        for i in range(j + 1, N):
            a[j] = _less_product(a[j], L[i][j], a[i])
    return a


def _lu(M, f):
    N = len(f)
    U, y, inverse = [list(row) for row in M], list(f), []
    for j in range(N):
        inverse.append(1.0 / U[j][j])
        for i in range(j + 1, N):
            if _zero(U[i][j]):
                continue
            factor = U[i][j] * inverse[j]
            for k in range(j + 1, N):
                U[i][k] = _less_product(U[i][k], factor, U[j][k])
            y[i] = _less_product(y[i], factor, y[j])
    a = [None] * N
    for j in reversed(range(N)):
        total = y[j]
        for k in range(j + 1, N):
            total = _less_product(total, U[j][k], a[k])
        a[j] = total * inverse[j]
    return a
