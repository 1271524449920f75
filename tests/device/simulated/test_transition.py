"""The exact map over a stretch of time: against arbitrary precision and closed forms, down to next to no mass."""

import math

import mpmath
import numpy as np
import pytest

from hapticlab.device.simulated.transition import PHI, smallest_mass, transition


def mp_transition(M, b, k, h):
    """Return the same map from mpmath's own exponential, in 60 digits and SI units."""
    with mpmath.workdps(60):
        M, b, k, h = (mpmath.mpf(a) for a in (M, b, k, h))
        A = mpmath.matrix([[0, 1, 0, 0], [-k / M, -b / M, 1 / M, 0], [0, 0, 0, 1], [0, 0, 0, 0]])
        E = mpmath.expm(A * h, method="taylor")
        place = {name: position for position, name in enumerate("xvud")}
        return {e: E[place[e[0]], place[e[1]]] for e in PHI}


@pytest.mark.parametrize(
    ("M", "b", "k", "h"),
    [
        (0.05, 0.1, 0.0, 1e-3), (0.166, 0.057, 0.0, 1e-3), (0.266, 5.057, 500.0, 1e-3), (0.005, 2.0, 0.0, 1e-3),
        (0.03, 0.0, 0.0, 1e-7), (0.05, 1.1, 200.0, 1e-5), (0.03, 0.1, 900.0, 2e-2), (0.2, 0.0, 500.0, 5e-2),
        (1e-3, 0.99, 0.0, 1e-3), (1e-3, 1.01, 0.0, 1e-3), (1e-5, 0.1, 0.0, 2e-3), (1e12, 1e3, 0.0, 1e-5),
    ],
)  # fmt: skip
def test_transition_keeps_relative_accuracy(M, b, k, h):
    exact = mp_transition(M, b, k, h)
    for entry, value in transition(M, b, k, h).items():
        assert abs(value - exact[entry]) <= 1e-13 * abs(exact[entry]), entry


def test_a_handle_of_next_to_no_mass_is_dragged_at_once():
    """M = 1e-12 kg: e^-1e8 is 0, and what is left follows from x' = (u + d t)/b, less M/b of it."""
    phi, b, h, lag = transition(1e-12, 0.1, 0.0, 1e-3), 0.1, 1e-3, 1e-11
    expected = {"xx": 1.0, "xv": lag, "xu": (h - lag) / b, "xd": (h * h / 2 - lag * (h - lag)) / b}
    expected |= {"vx": 0.0, "vv": 0.0, "vu": 1 / b, "vd": (h - lag) / b}
    np.testing.assert_allclose([phi[e] for e in PHI], [expected[e] for e in PHI], rtol=2e-15)


def test_a_spring_far_faster_than_the_samples():
    """sqrt(k/M) h = 1414 rad: rounding of the angle alone is 1e-13 of a turn."""
    M, k, h = 1e-10, 200.0, 1e-3
    w, phi = math.sqrt(k / M), transition(M, 0.0, k, h)
    expected = {"xx": math.cos(w * h), "xv": math.sin(w * h) / w, "xu": (1 - math.cos(w * h)) / k}
    expected |= {"vx": -w * math.sin(w * h), "vv": math.cos(w * h), "vu": math.sin(w * h) / (M * w)}
    np.testing.assert_allclose([phi[e] for e in expected], [*expected.values()], rtol=1e-10)


def test_many_at_once_are_each_alone_to_the_bit():
    random = np.random.default_rng(8)
    M, h = random.uniform(0.01, 0.3, 200), random.uniform(1e-4, 0.2, 200)
    b, k = random.choice([0.0, 0.3, 90.0], 200), random.choice([0.0, 40.0, 3000.0], 200)
    M[::3] *= 10.0 ** random.integers(-18, -3, 67)
    many = transition(M, b, k, h)
    for j in range(200):
        assert {e: a[j] for e, a in many.items()} == transition(M[j], b[j], k[j], h[j])


def mp_closed(M, b, k, h):
    """Return the map on a spring from the roots of its characteristic equation, in 80 digits."""
    with mpmath.workdps(80):
        M, b, k, h = (mpmath.mpf(a) for a in (M, b, k, h))
        s1 = -(b / M + mpmath.sqrt(mpmath.mpc((b / M) ** 2 - 4 * k / M))) / 2
        s2 = k / M / s1
        e1, e2 = mpmath.exp(s1 * h), mpmath.exp(s2 * h)
        xv, vv, xx = (e2 - e1) / (s2 - s1), (s2 * e2 - s1 * e1) / (s2 - s1), (s2 * e1 - s1 * e2) / (s2 - s1)
        xu = (1 - xx) / k
        found = {"xx": xx, "xv": xv, "xu": xu, "xd": (h - xv - b * xu) / k}
        found |= {"vx": -k / M * xv, "vv": vv, "vu": xv / M, "vd": xu}
        return {e: a.real for e, a in found.items()}


@pytest.mark.parametrize(
    ("M", "b", "k", "h"),
    [
        (1e-12, 0.1, 200.0, 1e-3), (1e-12, 1e3, 200.0, 1e-3), (1e-12, 1e5, 1e4, 0.1), (1e-300, 0.1, 200.0, 1e-3),
        (1e-12, 1e-6, 1e-3, 1e-3), (1e-6, 0.04, 1e-9, 2e-3), (1e-6, 0.02, 20.0, 1e-3), (1e-4, 1.6, 1.0, 1e-3),
        (1e-12, 0.1, 1e12, 1e-3), (1e-12, 2e-6, 1e2, 1e-2), (1e-12, 1.999999e-4, 1e4, 1e-3), (1e-12, 2e-4, 1e4, 1e-3),
    ],
)  # fmt: skip
def test_a_light_handle_on_a_spring(M, b, k, h):
    """The squared matrix lost all of its digits on some of these; their rates differ up to 1e300 times."""
    exact = mp_closed(M, b, k, h)
    for entry, value in transition(M, b, k, h).items():
        assert abs(value - exact[entry]) <= 1e-13 * abs(exact[entry]) + 1e-300, entry


def test_both_forms_agree_where_they_meet():
    """Just inside and outside of each closed form, in coordinates of order one."""
    for below, above in [
        ((1.0, 15.99, 12.0, 1.0), (1.0, 16.0, 12.0, 1.0)),
        ((1.0, 30.0, 56.26, 1.0), (1.0, 30.0, 56.24, 1.0)),
        ((1.0, 3.0, 9999.0, 1.0), (1.0, 3.0, 10001.0, 1.0)),
    ]:
        for given in (below, above):
            exact, found = mp_closed(*given), transition(*given)
            assert max(abs(found[e] - exact[e]) for e in PHI) < 1e-12


def test_the_smallest_mass():
    """As told it is right, or at least finite; below it the angle of a spring, or the numbers themselves, are lost."""
    for b, k, h in [(0.1, 200.0, 1e-3), (0.0, 0.0, 1e-3), (0.0, 1e13, 1e-3), (1e9, 1e3, 10.0)]:
        least = smallest_mass(b, k, h)
        assert all(math.isfinite(a) for a in transition(least * 1.001, b, k, h).values())
    assert smallest_mass(0.0, 1e13, 1e-3) == pytest.approx(1e-11) and smallest_mass(1.0, 1e13, 1e-3) < 1e-290
    found, exact = transition(1e-11, 0.0, 1e13, 1e-3), mp_closed(1e-11, 0.0, 1e13, 1e-3)
    assert found["xx"] == pytest.approx(float(exact["xx"]), abs=3e-7)
