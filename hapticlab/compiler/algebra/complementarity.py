"""Contact forces of bodies that touch: linear complementarity, exact, in a fixed number of operations.

0 <= p, 0 <= W p + q, and p (W p + q) = 0 contact by contact, with W = J M^-1 J^T. As impulses p and gap rates it is the
simultaneous impact, as reactions and gap accelerations it is rest (Baraff, SIGGRAPH 1994, 23-34). Every set of active
contacts is tried, 2^k of them for k contacts that act on each other: exact where an iteration is still half wrong
after 250 rounds (projected Gauss-Seidel, two contacts, mass ratio 100). The lines work on floats, arrays and traced values.
"""

from itertools import chain, combinations

from ...errors import SceneError
from ..ir.structural_zeros import dot, is_zero, less_product
from ..ir.trace import Value, maximum, minimum, select
from .linear_solve import solve

#: contacts that act on each other at once: 2^4 = 16 sets
MOST_TOGETHER = 4
#: a pivot below this part of its diagonal entry is a rounded zero: its contact repeats another
SINGULAR = {"f64": 1e-9, "f32": 1e-4}
#: how far a candidate may violate its inequalities, of the largest term
TOLERANCE = {"f64": 1e-12, "f32": 3e-6}
#: a gap or gap rate that no reaction keeps from closing is one past this part of what it is the difference of,
IMPOSSIBLE = {"f64": 1e-6, "f32": 1e-3}
#: and past this, in m or m/s
SMALLEST = {"f64": 1e-9, "f32": 1e-5}
_NEVER = 1e30


def response(M, J, definite=True):
    """Return (W, P): W = J M^-1 J^T, shape (k, k), and the columns P = M^-1 J^T as rows, shape (k, N).

    Parameters
    ----------
    M : list of lists of Value or float, shape (N, N)
    J : list of lists, shape (k, N)
        Gradient of each gap.
    """
    P = [solve(M, list(row), definite) for row in J]
    k = len(J)
    W = [[None] * k for _ in range(k)]
    for i in range(k):
        for j in range(i + 1):
            # written once, so that W is symmetric to the last digit
            W[i][j] = W[j][i] = dot(J[i], P[j])
    return W, P


def complementarity(W, q, touching=None, names=None):
    """Return p with 0 <= p, 0 <= W p + q and p (W p + q) = 0.

    Contacts that cannot act on each other (structural zeros of W) are solved apart. Where W is singular, because contacts
    repeat each other, the vertices with fewer active contacts serve; of several solutions their mean is returned, so
    that the order of the contacts does not matter and repeated contacts share evenly. W p is unique all the same.

    Parameters
    ----------
    W : list of lists of Value, float or array, shape (k, k)
        Symmetric, positive semidefinite.
    q : list, shape (k,)
    touching : list of bool or Value, shape (k,), optional
        Contacts that may act; p is 0 for the others. All by default.
    names : list of str, optional
        For the message.

    Raises
    ------
    SceneError
        More than MOST_TOGETHER contacts act on each other.

    Examples
    --------
    >>> from hapticlab.compiler.algebra.complementarity import complementarity
    >>> complementarity([[2.0, -1.0], [-1.0, 2.0]], [-3.0, 0.0])
    [2.0, 1.0]
    """
    touching = touching or [True] * len(q)
    p = [None] * len(q)
    for island in islands(W):
        if len(island) > MOST_TOGETHER:
            named = ", ".join(names[i] for i in island) if names else f"{len(island)} contacts"
            raise SceneError(
                f"{named} act on each other at the same time; exact reactions need at most {MOST_TOGETHER} of them, because "
                "every set is tried. Give some of them a penalty or hunt_crossley law"
            )
        part = _enumerate([[W[i][j] for j in island] for i in island], [q[i] for i in island], [touching[i] for i in island])
        for i, value in zip(island, part, strict=True):
            p[i] = value
    return p


def impossible(W, after, touching, size):
    """A condition that some gaps close with any reactions p: nothing keeps these contacts apart.

    A body between two that do not give, an imposed handle and a wall, is the case. Only contacts that act on each other
    can be; False where there are none.

    Parameters
    ----------
    W : list of lists
        Its structural zeros tell which contacts act on each other.
    after : list of Value or float
        What should not be negative: gaps [m] or gap rates [m/s].
    touching : list of bool or Value
    size : Value or float
        Of what ``after`` is the small difference; what is lost of it in rounding is not held against a contact.
    """
    together = [i for island in islands(W) if len(island) > 1 for i in island]
    real = real_of(W, after)
    worst = False
    for i in together:
        closes = touching[i] & (after[i] < -(IMPOSSIBLE[real] * size + SMALLEST[real]))
        worst = closes if worst is False else closes | worst
    return worst


def islands(W):
    """Return lists of indices that structural zeros of W leave coupled."""
    left, found = set(range(len(W))), []
    while left:
        island, fresh = set(), {min(left)}
        while fresh:
            island |= fresh
            fresh = {j for i in fresh for j in left if not is_zero(W[i][j])} - island
        left -= island
        found.append(sorted(island))
    return found


def _enumerate(W, q, touching):
    """Try every active set; return the mean of the solutions."""
    k = len(q)
    if k == 1:
        return [select(touching[0] & (q[0] < 0.0), -q[0] / W[0][0], 0.0)]
    size = 0.0
    for value, here in zip(q, touching, strict=True):
        size = maximum(size, select(here, abs(value), 0.0))
    sets = list(chain.from_iterable(combinations(range(k), n) for n in range(k + 1)))
    tried = [_candidate(W, q, touching, active) for active in sets]
    least = tried[0][1]
    for _, violation in tried[1:]:
        least = minimum(least, violation)
    # rounding alone may leave none within the tolerance: then the best of them
    allowed = maximum(least, size * TOLERANCE[real_of(W, q)])
    share = [select(violation <= allowed, 1.0, 0.0) for _, violation in tried]
    count = _sum(share)
    return [_sum([weight * p[i] for weight, (p, _) in zip(share, tried, strict=True) if not is_zero(p[i])]) / count
            for i in range(k)]  # fmt: skip


def _candidate(W, q, touching, active):
    """Return (p, violation) of one active set: gap rates zero inside it, impulses zero outside, the worst sign wrong."""
    p, regular = _solve_active(W, q, active)
    violation = 0.0
    for i in range(len(q)):
        if i in active:
            # an impulse counts by the gap rate that it makes, so that kilograms and grams are measured alike
            wrong = select(touching[i], -p[i] * W[i][i], _NEVER)
        else:
            wrong = select(touching[i], -(q[i] + dot([W[i][j] for j in active], [p[j] for j in active])), 0.0)
        violation = maximum(violation, wrong)
    return p, select(regular, violation, _NEVER) if active else violation


def _solve_active(W, q, active):
    """Return (p, regular) with (W p + q) = 0 on the active set and p = 0 off it; LDL^T with its pivots tested."""
    n = len(active)
    A = [[W[i][j] for j in active] for i in active]
    L, inverse, y, regular = [[0.0] * n for _ in range(n)], [], [-q[i] for i in active], True
    least = SINGULAR[real_of(W, q)]
    for j in range(n):
        pivot = A[j][j]
        for m in range(j):
            pivot = less_product(pivot, A[j][m], L[j][m])
        sound = least * W[active[j]][active[j]] < pivot
        regular = sound if regular is True else regular & sound
        inverse.append(1.0 / select(sound, pivot, 1.0))
        for i in range(j + 1, n):
            for m in range(j):
                A[i][j] = less_product(A[i][j], A[i][m], L[j][m])
            L[i][j] = A[i][j] if is_zero(A[i][j]) else A[i][j] * inverse[j]
        for m in range(j):
            y[j] = less_product(y[j], L[j][m], y[m])
    x = [y[j] * inverse[j] for j in range(n)]
    for j in reversed(range(n)):
        for i in range(j + 1, n):
            x[j] = less_product(x[j], L[i][j], x[i])
    p = [0.0] * len(q)
    for i, value in zip(active, x, strict=True):
        p[i] = select(regular, value, 0.0)
    return p, regular


def reactions(A, b, active):
    """Return N with (A N + b) = 0 for the active contacts and N = 0 for the others.

    The contacts whose gaps are held closed; which they are is known only at run time, so the rows and columns of the
    others are masked. A contact that repeats one before it takes no share.

    Parameters
    ----------
    A : list of lists, shape (k, k)
        J M^-1 G^T; G is J without friction, else the direction in which each contact pushes.
    b : list, shape (k,)
        Second derivative of each gap without the reactions.
    active : list of bool or Value, shape (k,)
    """
    k = len(b)
    rows = [
        [select(active[i] & active[j], A[i][j], 0.0) if not is_zero(A[i][j]) or i == j else 0.0 for j in range(k)]
        + [select(active[i], -b[i], 0.0)]
        for i in range(k)
    ]
    least = SINGULAR[real_of(A, b)]
    inverse = []
    for j in range(k):
        sound = least * abs(A[j][j]) < abs(rows[j][j])
        inverse.append(select(sound, 1.0 / select(sound, rows[j][j], 1.0), 0.0))
        for i in range(j + 1, k):
            if not is_zero(rows[i][j]):
                factor = rows[i][j] * inverse[j]
                rows[i] = [*rows[i][: j + 1], *(less_product(rows[i][m], factor, rows[j][m]) for m in range(j + 1, k + 1))]
    N = [None] * k
    for j in reversed(range(k)):
        total = rows[j][k]
        for m in range(j + 1, k):
            total = less_product(total, rows[j][m], N[m])
        N[j] = total * inverse[j]
    return N


def constrained(M, f, J, bias, active, definite=True, directions=None):
    """Return (a, N): the accelerations of M a = f + G^T N with the active gaps held closed, and their reactions.

    Parameters
    ----------
    M : list of lists, shape (N, N)
    f : list, shape (N,)
    J : list of lists, shape (k, N)
        Gradient of each gap, d gap / d q.
    bias : list, shape (k,)
        The rest of the second derivative of each gap: J' q' and what the handle and time add.
    active : list of bool or Value, shape (k,)
    directions : list of lists, shape (k, N), optional
        Rows of G, the generalized force of a unit reaction: J unless friction goes with it, then J - mu s S for a
        slide of direction s along a slip with rows S.
    """
    free = solve(M, list(f), definite)
    G = directions or J
    columns = [solve(M, list(row), definite) for row in G]
    A = [[dot(row, column) for column in columns] for row in J]
    N = reactions(A, [dot(row, free) + extra for row, extra in zip(J, bias, strict=True)], active)
    a = [value + dot(N, [column[i] for column in columns]) for i, value in enumerate(free)]
    return a, N


def real_of(*given):
    """Return the real type of the first traced value, f64 for plain numbers."""
    flat = (item for part in given for row in part for item in (row if isinstance(row, list) else [row]))
    return next((item.type for item in flat if isinstance(item, Value)), "f64")


def _sum(values):
    total = 0.0
    for value in values:
        total = value if is_zero(total) else total + value
    return total
