"""Step matrices and the longest stable steps, against the closed forms of an oscillator q'' = -w^2 q - 2 zeta w q'."""

import numpy as np
import pytest

from hapticlab.compiler.methods.method_table import METHODS
from hapticlab.compiler.methods.step_matrix import growing, longest_step, rising, step_matrix

W = 137.0


def oscillator(zeta):
    return np.array([[0.0, 1.0], [-W * W, -2 * zeta * W]])


def longest(name, J, seconds=1):
    return longest_step(lambda h: step_matrix(METHODS[name], J, seconds, h), J)


@pytest.mark.parametrize("zeta", [0.0, 0.05, 0.2, 0.5, 1.0, 2.0, 5.0])
def test_semi_implicit_euler(zeta):
    """Of z^2 + (w^2 h^2 + 2 zeta w h - 2) z + 1 - 2 zeta w h, the root -1: w h = 2 (sqrt(1 + zeta^2) - zeta)."""
    assert longest("semi_implicit_euler", oscillator(zeta)) * W == pytest.approx(2 * (np.hypot(1, zeta) - zeta), rel=1e-5)


@pytest.mark.parametrize(
    ("name", "zeta", "expected"),
    [
        ("rk4", 0.0, 2 * np.sqrt(2)), ("rk4", 1.0, 2.785293563405282), ("ssprk3", 0.0, np.sqrt(3)), ("verlet", 0.0, 2.0),
        ("heun", 1.0, 2.0), ("adams_bashforth2", 1.0, 1.0), ("adams_bashforth3", 1.0, 6 / 11), ("euler", 0.05, 0.1),
        ("adams_bashforth3", 0.0, 0.723627),
        ("semi_implicit_euler_damped", 1.0, 2 * (np.sqrt(2) + 1)),
    ],
)  # fmt: skip
def test_ends_of_stability_regions(name, zeta, expected):
    """Known intervals on the real and imaginary axes; of a double real root, and of what methods split."""
    assert longest(name, oscillator(zeta)) * W == pytest.approx(expected, rel=2e-4)


@pytest.mark.parametrize("name", ["euler", "heun", "midpoint", "adams_bashforth2"])
def test_no_step_is_stable_where_a_spring_gains_energy(name):
    assert longest(name, oscillator(0.0)) == 0.0


def test_what_falls_by_itself_sets_no_limit():
    """A pendulum upright beside a fast spring: the spring sets the limit, of every method 2 or so."""
    J = np.zeros((4, 4))
    J[:2, 2:] = np.eye(2)
    J[2, 0], J[3, 1], J[2, 1] = 25.0, -W * W, 3.0
    assert rising(J) == 1
    assert longest("semi_implicit_euler", J, 2) * W == pytest.approx(2.0, rel=1e-4)


def test_a_free_mass_is_no_growth():
    """Its double eigenvalue 1 is known to the root of the rounding only."""
    k, m = 300.0, 0.05
    J = np.block([[np.zeros((2, 2)), np.eye(2)], [np.array([[-k, k], [k, -k]]) / m, np.zeros((2, 2))]])
    assert growing(step_matrix(METHODS["verlet"], J, 2, 1e-4)) == 0
    assert longest("verlet", J, 2) == pytest.approx(2 / np.sqrt(2 * k / m), rel=1e-4)


def test_nothing_moves():
    assert longest_step(lambda h: np.ones((len(h), 1, 1)), np.zeros((1, 1))) == np.inf
    assert step_matrix(METHODS["rk4"], np.zeros((0, 0)), 0, 0.1).shape == (0, 0)
