"""The held map against the closed form of a damped free mass and against its own definition."""

import numpy as np

from hapticlab.limits.loop import held


def test_a_damped_free_mass():
    for delta in (1e-4, 0.3, 12.0):
        Phi, Psi = held(np.array([[0.0, 1.0], [0.0, -delta]]), 1.0)
        rise = -np.expm1(-delta) / delta
        np.testing.assert_allclose(Phi, [[1, rise], [0, np.exp(-delta)]], rtol=1e-13)
        slow = (1 - rise) / delta if delta > 0.1 else 1 / 2 - delta / 6 + delta**2 / 24  # the closed form cancels
        np.testing.assert_allclose(Psi, [[1, slow], [0, rise]], rtol=1e-11)


def test_phi_is_one_plus_a_psi():
    A = np.array([[0.0, 1.0], [-0.7, -0.2]])
    Phi, Psi = held(A, 1.7)
    np.testing.assert_allclose(Phi, np.eye(2) + A @ Psi, atol=1e-15)
