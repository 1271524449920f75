"""The handle in many passive hands at once: the closed loop of a tick map, by its eigenvalues."""

import numpy as np

from ...compiler.algebra.matrix_exponential import exponential
from ...limits.limit import whole_and_fraction

#: a closed loop is unstable where an eigenvalue is this far outside the unit circle
UNSTABLE = 1e-7


def network(generator, H, bodies, m, T):
    """Return (M, C, K) of H random hands on a handle of mass m, each of shape (H, bodies + 1, bodies + 1).

    Bodies hang on each other, on the handle and on the ground by random springs and dampers, some of them absent;
    frequencies from far below to far above what a period T resolves. The handle itself is body 0.
    """
    n = bodies + 1
    M = np.zeros((H, n, n))
    masses = m * 10 ** generator.uniform(-2, 2, (H, n))
    masses[:, 0] = m
    M[:, range(n), range(n)] = masses
    C, K = np.zeros((H, n, n)), np.zeros((H, n, n))
    for i in range(n):
        for j in range(-1, i):
            present = generator.random(H) < (1.0 if j == i - 1 and i > 0 else 0.5)
            omega = 10 ** generator.uniform(-1, 0.6, H) / T
            k = present * masses[:, i] * omega**2 * (generator.random(H) < 0.8) * 10 ** generator.uniform(-3, 0, H)
            c = present * masses[:, i] * omega * (generator.random(H) < 0.5) * 10 ** generator.uniform(-4, 0, H)
            _between(K, i, j, k)
            _between(C, i, j, c)
    return M, C, K


def _between(matrices, i, j, k):
    """Add springs k between bodies i and j, j = -1 the ground."""
    matrices[:, i, i] += k
    if j >= 0:
        matrices[:, j, j] += k
        matrices[:, i, j] -= k
        matrices[:, j, i] -= k


def single(masses, stiffnesses):
    """Return (M, C, K) of handles held by a spring to the ground, masses and stiffnesses of shape (H,)."""
    shape = (len(masses), 1, 1)
    return np.reshape(masses, shape), np.zeros(shape), np.reshape(stiffnesses, shape)


def radii(tick, hands, b, T, delay=0.0):
    """Return the spectral radius of each closed loop, shape (H,).

    Parameters
    ----------
    tick : (A, B, C, D)
        Of :mod:`hapticlab.limits.port`.
    hands : (M, C, K)
        Each of shape (H, n, n), the handle being body 0.
    b : float or array of shape (H,)
        Damping of the device [N s/m].
    T, delay : float
        [s]
    """
    A, B, C, D = tick
    M, damping, K = hands
    H, n = M.shape[:2]
    damping = damping.copy()
    damping[:, 0, 0] += b
    plant = np.zeros((H, 2 * n, 2 * n))
    plant[:, range(n), range(n, 2 * n)] = 1 / T  # in positions and moves a period
    plant[:, n:, :n], plant[:, n:, n:] = -T * np.linalg.solve(M, K), -np.linalg.solve(M, damping)
    force = np.zeros((H, 2 * n))
    force[:, n:] = -T * np.linalg.inv(M)[:, :, 0]
    whole, fraction = whole_and_fraction(delay, T)
    late, first = _held(plant, force, fraction * T) if fraction else (np.eye(2 * n), np.zeros((H, 2 * n)))
    rest, second = _held(plant, force, (1 - fraction) * T)
    P, S, kept = 2 * n, len(A), whole + (fraction > 0)
    loop = np.zeros((H, P + S + kept, P + S + kept))
    loop[:, :P, :P] = rest @ late
    loop[:, P : P + S, 0], loop[:, P : P + S, P : P + S] = B, A
    row = np.zeros(P + S + kept)  # the force of this sample
    row[0], row[P : P + S] = D, C

    def of(lag):
        return row if lag == 0 else np.eye(P + S + kept)[P + S + lag - 1]

    loop[:, :P] += second[:, :, None] * of(whole)
    if fraction:
        loop[:, :P] += (rest @ first[..., None]) * of(whole + 1)
    for lag in range(kept):
        loop[:, P + S + lag] = of(lag)
    return np.abs(np.linalg.eigvals(loop)).max(axis=1)


def _held(A, force, duration):
    """Return Phi of shape (H, n, n) and Gamma of shape (H, n) of plants y' = A y + force u, u held for a duration."""
    n = A.shape[-1]
    both = np.zeros((len(A), n + 1, n + 1))
    both[:, :n, :n], both[:, :n, n] = A * duration, force * duration
    both = exponential(both)
    return both[:, :n, :n], both[:, :n, n]
