"""Second-order reduction that matches moments at the handle and stays passive.

The masses z of a scene move with the handle x: M z'' + C z' + K z + (K_x + C_x d/dt) x = 0, F = (k + c d/dt) x + K_x.z +
C_x.z'. Two projections, each of which keeps the energies what they are, positive:

* z = V r. V spans the first terms z_0, z_1, ... of z(s)/x(s) in powers of s: a second-order Krylov space, found by SOAR
  (Bai and Su, SIAM J. Matrix Anal. Appl. 26, 2005). M, C and K become V^T M V, ...: congruence.
* the forces of the springs, phi = E^T [x, z] with E E^T the stiffness, are projected on those that belong to these terms,
  phi -> W W^T phi: the stiffness becomes T^T E W W^T E^T T, never negative. With V alone the handle would keep the first
  spring as it is, and one mass on it would match no more than the static mass; with both it takes the softness of the
  whole chain. It is the projection of momenta and of elastic forces apart, as for port-Hamiltonian systems (Gugercin,
  Polyuga, Beattie and van der Schaft, Automatica 48, 2012).
"""

from itertools import product

import numpy as np

#: a direction shorter than this part of its vector is rounding
ROUNDING = 1e-9


def candidates(stiffness, damping, count):
    """Yield reduced (stiffness, damping, V) of the handle and ``count`` unit masses: several bases, of which one is best.

    Parameters
    ----------
    stiffness, damping : array of shape (1 + N, 1 + N)
        Of the handle and N unit masses, positive semidefinite; time in units in which the band is of order one.
    count : int
        0 < count < N.

    Notes
    -----
    With light damping the terms of odd power are small, and a basis that leaves damping out of account matches more.
    """
    springs = _factor(stiffness)
    for damped, more in product((True, False), (0, 1, 2, None)):
        basis = soar(stiffness, damping if damped else 0 * damping, count + 1 + (more or 0))
        V = basis[1:, np.abs(basis[1:]).max(axis=0) > 0][:, :count]
        if V.shape[1] < count:
            continue
        T = np.block([[np.ones((1, 1)), np.zeros((1, count))], [np.zeros((len(V), 1)), V]])
        seen = T.T @ springs
        if more is not None:  # else V alone
            W, sizes, _ = np.linalg.svd(springs.T @ basis, full_matrices=False)
            seen = seen @ W[:, sizes > ROUNDING * np.linalg.norm(springs[0])]
        yield seen @ seen.T, T.T @ damping @ T, V


def soar(stiffness, damping, count):
    """Motion of handle and masses in the first terms of z(s)/x(s) in powers of s, shape (1 + N, found).

    Each column is a combination of the terms so far, the handle's own motion its first entry; the masses' parts are
    orthonormal, or zero where a term repeats others. About s = 0, or s = 1 where the stiffness alone holds no mass.

    Examples
    --------
    >>> soar(np.array([[2.0, -2.0], [-2.0, 2.0]]), np.zeros((2, 2)), 1).tolist()
    [[1.0], [1.0]]
    """
    K, C, by_rate = stiffness[1:, 1:], damping[1:, 1:], damping[1:, 0]
    by_handle, shift = stiffness[1:, 0], 0.0 if np.linalg.cond(K) < 1 / ROUNDING else 1.0
    K, C = K + shift * C + shift**2 * np.eye(len(K)), C + 2 * shift * np.eye(len(K))
    first = -np.linalg.solve(K, by_handle + shift * by_rate)
    size = np.linalg.norm(first)
    basis, behind = [np.r_[1.0, first] / size], [by_rate / size]
    for _ in range(3 * count):
        if sum(a[1:].any() for a in basis) >= count:
            break
        r, s = np.r_[0.0, -np.linalg.solve(K, C @ basis[-1][1:] + behind[-1])], basis[-1][1:]
        whole = np.linalg.norm(r)
        for a, b in [*zip(basis, behind, strict=True)] * 2:  # twice: orthogonal to rounding
            t = a[1:] @ r[1:]
            r, s = r - t * a, s - t * b
        if np.linalg.norm(r[1:]) <= ROUNDING * whole:
            r[1:] = 0.0  # deflation: nothing new here, the sequence goes on through s
        size = np.linalg.norm(r[1:]) or np.linalg.norm(s)
        if not size > 0:
            break
        basis.append(r / size)
        behind.append(s / size)
    return np.column_stack(basis)


def _factor(stiffness):
    """Return E with E E^T = stiffness, its columns the springs."""
    values, vectors = np.linalg.eigh(stiffness)
    kept = values > 1e-12 * values[-1]
    return vectors[:, kept] * np.sqrt(values[kept])
