"""Where methods are stable, against polynomials and closed forms written here."""

import math

import numpy as np
import pytest

from hapticlab.compiler.methods.method_table import METHODS

Z = np.random.default_rng(3).normal(size=(40, 2)) @ [1.0, 1.0j]
#: R(z) = 1 + z + ... + z^p/p!, for p stages of order p
STAGES = {"euler": 1, "midpoint": 2, "heun": 2, "ssprk3": 3, "rk4": 4}


@pytest.mark.parametrize(("name", "p"), STAGES.items(), ids=STAGES)
def test_amplification_is_the_taylor_polynomial(name, p):
    R = sum(Z**k / math.factorial(k) for k in range(p + 1))
    np.testing.assert_allclose(METHODS[name].amplification(Z), abs(R), rtol=1e-13)


@pytest.mark.parametrize(
    ("name", "weights"), [("adams_bashforth2", (3 / 2, -1 / 2)), ("adams_bashforth3", (23 / 12, -16 / 12, 5 / 12))]
)
def test_the_amplification_of_a_multistep_method_is_the_largest_root_of_its_polynomial(name, weights):
    """r^k = r^(k-1) + z (b_1 r^(k-1) + ... + b_k), Hairer and Wanner II, V.1."""
    for z in Z:
        polynomial = np.array([1.0, *[0.0] * len(weights)], complex)
        polynomial[1:] -= z * np.array(weights)
        polynomial[1] -= 1.0
        assert METHODS[name].amplification(z) == pytest.approx(abs(np.roots(polynomial)).max(), rel=1e-10)


LIMITS = {  # real, imaginary: numbers of Hairer, Norsett and Wanner and of closed forms
    "euler": (2, 0), "semi_implicit_euler": (2, 2), "semi_implicit_euler_damped": (math.inf, 2), "verlet": (2, 2),
    "midpoint": (2, 0), "heun": (2, 0), "ssprk3": (2.512745327, math.sqrt(3)), "rk4": (2.785293563, 2 * math.sqrt(2)),
    "nystrom4": (math.nan, 2.586519), "adams_bashforth2": (1, 0), "adams_bashforth3": (6 / 11, 0.723627),
}  # fmt: skip


@pytest.mark.parametrize(("name", "real", "imaginary"), [(name, *both) for name, both in LIMITS.items()], ids=LIMITS)
def test_the_intervals_on_the_axes(name, real, imaginary):
    assert METHODS[name].real == pytest.approx(real, rel=2e-6, nan_ok=True)
    assert METHODS[name].imaginary == pytest.approx(imaginary, rel=2e-6)


def test_every_method_has_its_limits_looked_at():
    assert set(LIMITS) == set(METHODS)


ZETA = (0.05, 0.2, 0.5, 1.0, 2.0, 5.0)


@pytest.mark.parametrize(
    ("name", "closed"),
    [
        ("euler", lambda s: 2 * s if s < 1 else 2 / (s + math.sqrt(s**2 - 1))),
        ("semi_implicit_euler", lambda s: 2 * (math.sqrt(1 + s**2) - s)),
        ("semi_implicit_euler_damped", lambda s: 2 * (math.sqrt(1 + s**2) + s)),
    ],
)
def test_the_longest_step_of_an_oscillator_is_the_closed_form(name, closed):
    for zeta in ZETA:  # a growth of 1e-7 a step counts as none, which is 2e-5 of Euler's limit
        assert METHODS[name].longest_step(zeta) == pytest.approx(closed(zeta), rel=3e-5)


@pytest.mark.parametrize(
    ("name", "steps"),
    [
        ("verlet", (1.912, 1.757, 2.0, 1.0, 0.5, 0.2)), ("heun", (0.80, 1.39, 2.0, 2.0, 0.536, 0.202)),
        ("ssprk3", (1.988, 2.370, 2.522, 2.513, 0.673, 0.254)), ("rk4", (2.910, 2.940, 2.623, 2.785, 0.746, 0.281)),
    ],
)  # fmt: skip
def test_the_longest_step_of_an_oscillator_is_that_measured_before(name, steps):
    """Numbers of a prototype that ran each method to its blow-up, three figures."""
    for zeta, longest in zip(ZETA, steps, strict=True):
        assert METHODS[name].longest_step(zeta) == pytest.approx(longest, rel=5e-3)


@pytest.mark.parametrize(
    ("name", "gain"),
    [
        ("euler", lambda y: y**2), ("heun", lambda y: y**4 / 4), ("midpoint", lambda y: y**4 / 4),
        ("ssprk3", lambda y: -(y**4) / 12 + y**6 / 36), ("rk4", lambda y: -(y**6) / 72 + y**8 / 576),
    ],
)  # fmt: skip
def test_the_energy_gain_on_a_spring_is_the_polynomials(name, gain):
    for y in (0.05, 0.3, 1.0):
        assert METHODS[name].energy_gain(y) == pytest.approx(gain(y), rel=1e-6, abs=1e-14)


def test_the_energy_gain_of_the_others_on_a_spring():
    """Leading terms y^4/2, -3 y^4/4 and -y^6/288 at small y; nothing for the symplectic ones."""
    for name, leading in (("adams_bashforth2", 1 / 2), ("adams_bashforth3", -3 / 4)):
        assert METHODS[name].energy_gain(0.02) / 0.02**4 == pytest.approx(leading, rel=5e-3)
    assert METHODS["nystrom4"].energy_gain(0.1) / 0.1**6 == pytest.approx(-1 / 288, rel=1e-2)
    for name in ("semi_implicit_euler", "semi_implicit_euler_damped", "verlet"):
        assert abs(METHODS[name].energy_gain(1.3)) < 1e-14
