"""What one step of a method does to a linear motion: the step matrix, and the longest step for which it stays stable.

A method is applied to y' = J y from every basis vector; its lines are the ones that programs are traced from, so nothing
about a method is typed in here. A step is stable while the step matrix has no more eigenvalues outside the unit circle
than J has in the right half plane: an inverted pendulum falls under every method.
"""

import numpy as np

from .implicit_damping import dissipative

#: an eigenvalue this far outside grows; double ones, such as those of a free mass, are known to the root of the rounding
GROWS = 1e-7
#: steps looked at, times the largest |eigenvalue|: from where rounding hides growth to past every bounded region
GRID = np.geomspace(1e-3, 1e3, 240)
#: at this omega h a method that gains energy on every spring shows it: Heun y^4/8 = 8e-7
SHOWS = 0.05


def step_matrix(method, J, seconds, h, mass=None):
    """The matrix of one step, shape (..., S, S), for J of shape (..., S, S) and h that broadcasts with (...).

    Of a multistep method it is larger: it moves the rates of the steps before, too, shape (..., S steps, S steps).

    Parameters
    ----------
    method : Method
        See :mod:`hapticlab.compiler.methods.method_table`.
    J : array
        Rates of the states (q, w, s) by themselves, the ``seconds`` positions and their rates first.
    seconds : int
    h : float or array
        Step [s].
    mass : array (seconds, seconds), optional
        Of the positions, for implicit damping, which looks at forces; else each has a mass of 1.

    Examples
    --------
    >>> from hapticlab.compiler.methods.method_table import METHODS
    >>> step_matrix(METHODS["semi_implicit_euler"], np.array([[0.0, 1.0], [-100.0, 0.0]]), 1, 0.1).tolist()
    [[0.0, 0.1], [-10.0, 1.0]]
    """
    J, h = np.asarray(J, float), np.asarray(h, float)
    S, n = J.shape[-1], seconds
    shape = np.broadcast_shapes(J.shape[:-2], h.shape)
    if not S:
        return np.zeros((*shape, 0, 0))
    rows = J[..., n:, :] * np.ones((*shape, 1, 1))
    if method.implicit_damping and n:
        rows = _damped(rows, n, h, np.eye(n) if mass is None else np.asarray(mass, float))

    def rates(tau, q, w, s):
        found = rows @ np.stack([*q, *w, *s], axis=-2)
        found = [found[..., k, :] for k in range(S - n)]
        return found[:n], found[n:]

    parts, size = (slice(0, n), slice(n, 2 * n), slice(2 * n, S)), S * method.steps
    start = [np.broadcast_to(row, (*shape, size)) for row in np.eye(size)]
    state, *past = (tuple(start[k : k + S][part] for part in parts) for k in range(0, size, S))
    moved = method.step(rates, 0.0, state, h[..., None], *([past] if past else []))
    state, past = moved if past else (moved, [])
    return np.stack([row for group in (state, *past) for part in group for row in part], axis=-2)


def _damped(rows, n, h, mass):
    """The rates with implicit damping: of accelerations a, (M - h D)^-1 M a."""
    forces = mass @ rows[..., :n, :]
    slopes = [[forces[..., i, n + j] for j in range(n)] for i in range(n)]
    D = dissipative(slopes, lambda i, j: 1.0)
    D = np.stack([np.stack([d * np.ones(rows.shape[:-2]) for d in row], axis=-1) for row in D], axis=-2)
    return np.concatenate([np.linalg.solve(mass - h[..., None, None] * D, forces), rows[..., n:, :]], axis=-2)


def rising(J):
    """The number of eigenvalues of J, shape (..., S, S), in the right half plane."""
    values = np.linalg.eigvals(J)
    return (values.real > GROWS * np.abs(values).max(axis=-1, keepdims=True, initial=1e-300)).sum(axis=-1)


def growing(R, grows=GROWS):
    """The number of eigenvalues of step matrices outside the unit circle, by ``grows``; all where one has overflowed."""
    whole = np.isfinite(R).all(axis=(-2, -1))
    outside = np.abs(np.linalg.eigvals(np.where(whole[..., None, None], R, 0.0))) > 1.0 + grows
    return np.where(whole, outside.sum(axis=-1), R.shape[-1])


def excess(R, J, h, allowed):
    """The largest |eigenvalue| of step matrices beside those of what rises in truth, shape (N,); inf where one overflowed.

    Of what rises as exp(lambda t), the eigenvalue nearest to exp(lambda h) is left out where it grows at most twice as fast.

    Parameters
    ----------
    R : array of shape (N, M, M)
    J : array of shape (N, S, S)
        Of the motion.
    h : float
        Step [s].
    allowed : float
        Up to which nothing needs to be left out.
    """
    whole = np.isfinite(R).all(axis=(-2, -1))
    roots = np.linalg.eigvals(np.where(whole[..., None, None], R, 0.0))
    found = np.where(whole, np.abs(roots).max(axis=-1, initial=0.0), np.inf)
    some = np.flatnonzero(whole & (found > allowed))
    values, roots = np.linalg.eigvals(J[some]), roots[some].astype(complex)
    rises = values.real > GROWS * np.abs(values).max(axis=-1, keepdims=True, initial=1e-300)
    rows = np.arange(len(some))
    for value, rise in zip(values.T, rises.T, strict=True):
        if rise.any():
            true = np.exp(np.minimum(h * value.real, 300.0) + 1j * h * value.imag)
            nearest = np.abs(roots - true[:, None]).argmin(axis=-1)
            as_true = rise & (np.abs(roots[rows, nearest]) <= np.abs(true) ** 2)
            roots[rows[as_true], nearest[as_true]] = 0.0
    found[some] = np.abs(roots).max(axis=-1, initial=0.0)
    return found


def radius(R, besides=0):
    """The largest |eigenvalue| of matrices, shape (..., M, M), ``besides`` so many larger; inf where one overflowed."""
    whole = np.isfinite(R).all(axis=(-2, -1))
    sizes = np.sort(np.abs(np.linalg.eigvals(np.where(whole[..., None, None], R, 0.0))), axis=-1)
    found = sizes[..., -1 - besides] if sizes.shape[-1] > besides else np.zeros(whole.shape)
    return np.where(whole, found, np.inf)


def longest_step(step, J, grid=GRID, closing=(62, 62, 62)):
    """The longest stable step [s] of the motion y' = J y; inf where there is none, 0 where no step is stable.

    Parameters
    ----------
    step : callable ``h -> step matrices``
        For an array of steps, shape (H,) -> (H, M, M).
    J : array of shape (S, S)
    grid : array, optional
        Steps looked at first, times the largest |eigenvalue| of J.
    closing : sequence of int
        Places looked at between the last stable and the first unstable one, again and again.
    """
    values = np.linalg.eigvals(J)
    fastest = float(np.abs(values).max(initial=0.0))
    if not fastest:
        return np.inf
    allowed = int(rising(J))
    neutral = (np.abs(values.real) < GROWS * fastest) & (np.abs(values) > SHOWS * 1e-3 * fastest)
    if neutral.any():
        slowest = np.abs(values[neutral]).min()
        if growing(step(np.array([SHOWS / fastest, SHOWS / slowest])))[0] > allowed:
            return 0.0
    steps = grid / fastest
    with np.errstate(all="ignore"):
        too_long = growing(step(steps)) > allowed
    if not too_long.any():
        return np.inf
    first = int(too_long.argmax())
    low, high = (steps[first - 1] if first else 0.0), steps[first]
    for places in closing:
        between = np.linspace(low, high, places)
        with np.errstate(all="ignore"):
            late = int(np.append(growing(step(between[1:])) > allowed, True).argmax())
        low, high = between[late], between[min(late + 1, places - 1)]
    return float(low)
