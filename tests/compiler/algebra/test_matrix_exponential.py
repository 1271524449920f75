"""The matrix exponential and its integrals, against scipy, closed forms and quadrature."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import expm

from hapticlab.compiler.algebra.matrix_exponential import exponential, held


@pytest.mark.parametrize("size", [0.01, 1.0, 30.0])
def test_exponential_agrees_with_scipy(size):
    A = size * np.random.default_rng(4).normal(size=(7, 7))
    E = expm(A)
    assert abs(exponential(A) - E).max() < 1e-12 * abs(E).max()  # norm 200 is halved six times: six squarings of rounding


@pytest.mark.parametrize("omega", [1e2, 1e4, 1e6])
@pytest.mark.parametrize("zeta", [0.0, 0.01, 0.7])
def test_oscillator_at_any_stiffness(omega, zeta):
    h = 1e-3
    Phi, _ = held(np.array([[0, 1], [-(omega**2), -2 * zeta * omega]]), h, [1, omega])
    damped = omega * np.sqrt(1 - zeta**2)
    decay, c, s = np.exp(-zeta * omega * h), np.cos(damped * h), np.sin(damped * h)
    closed = decay * np.array(
        [[c + zeta * omega / damped * s, s / damped], [-(omega**2) / damped * s, c - zeta * omega / damped * s]]
    )
    rounding = 1e-15 * (10 + omega * h)  # the angle omega h itself is known to that
    assert abs((Phi - closed) * [[1, omega], [1 / omega, 1]]).max() < rounding


def test_integrals_agree_with_an_integrator():
    A = np.array([[0, 1, 0], [-400.0, -3, 50], [2, 0, -7]])
    y0, g = np.array([0.3, -1, 2]), np.random.default_rng(2).normal(size=(3, 3))
    h = 0.13
    Phi, Psi = held(A, h, [1, 20, 1])

    def rate(s, y):
        return A @ y + g[0] + g[1] * s + g[2] * s * s / 2

    exact = solve_ivp(rate, (0, h), y0, method="DOP853", rtol=1e-13, atol=1e-13).y[:, -1]
    assert Phi @ y0 + sum(P @ a for P, a in zip(Psi, g, strict=True)) == pytest.approx(exact, abs=1e-10)


def test_zeros_stay_zeros():
    A = np.zeros((4, 4))
    A[0, 1], A[1, 0], A[2, 3], A[2, 0] = 1, -100, 1, 5  # 0 and 1 move 2; 3 moves 2 and is moved by nothing
    Phi, Psi = held(A, 0.1, np.ones(4))
    assert not Phi[:2, 2:].any() and Phi[3].tolist() == [0, 0, 0, 1]
    assert not Psi[1][:2, 2:].any() and Phi[2].all()
