"""Force fields against their potentials, and against what the paddle does in them."""

import numpy as np
import pytest

import hapticlab as hl


def field(led, name, x, **values):
    """Return the force at rest at the places x."""
    scene = hl.library.catalogue[name].scene()(**values)
    return led(scene, x, T=1e-3).F


def potential(led, name, x, **values):
    """Return the work from x[0] on, Simpson's rule with a middle between any two places."""
    fine = np.linspace(x[0], x[-1], 2 * len(x) - 1)
    F = field(led, name, fine, **values)
    return np.r_[0, np.cumsum((F[:-2:2] + 4 * F[1:-1:2] + F[2::2]) * (x[1] - x[0]) / 6)]


def test_detents_repeat_hold_with_A_and_are_A_p_over_pi_deep(led):
    x, A, p = np.linspace(-0.02, 0.02, 4001), 0.7, 0.008
    F = field(led, "detents", x, A=A, p=p)
    assert np.abs(F[800:] - F[:-800]).max() < 1e-12  # 800 places are one pitch
    assert abs(F.max() - A) < 1e-12
    assert abs(field(led, "detents", [p / 4], A=A, p=p)[0] - A) < 1e-15
    U = potential(led, "detents", x, A=A, p=p)
    assert abs(np.ptp(U) - A * p / np.pi) < 1e-12


def test_a_paddle_rests_in_the_nearest_detent():
    paddle = hl.SimulatedPaddle.from_profile(hl.library.nominal, b=1.0)
    log = paddle.run(hl.library.detents(), duration=1.5, x=0.0145)
    assert abs(log.x[-1] - 0.01) < 1e-6


def test_texture_is_smooth_on_the_left_and_has_its_two_spatial_frequencies_on_the_right(led):
    x = np.linspace(0, 0.111, 8881)[:-1]  # 37 of one pitch, 60 of the other
    assert not field(led, "texture", -x).any()
    F = field(led, "texture", x, A=0.15)
    lines = np.abs(np.fft.rfft(F)) * 2 / len(x)
    assert sorted(np.flatnonzero(lines > 1e-9)) == [37, 60]
    assert lines[[37, 60]] == pytest.approx([0.15, 0.15], rel=1e-9)


def test_virtual_fixture_is_continuous_and_its_guide_k_w2_over_4_deep(led):
    x = np.linspace(-0.05, 0.034, 8401)
    F = field(led, "virtual_fixture", x, x_g=0.004, w=0.016, k=200)
    assert np.abs(np.diff(F)).max() <= 200 * 1.0001e-5
    U = potential(led, "virtual_fixture", x, x_g=0.004, w=0.016, k=200)
    assert abs(U.min() + 200 * 0.016**2 / 4) < 1e-9
    assert abs(x[np.argmin(U)] - 0.004) < 1e-12
    assert np.abs(U[-1]) < 1e-9  # level again beyond the guide


@pytest.mark.parametrize(("start", "rest"), [(0.017, 0.0), (-0.018, 0.0), (0.025, 0.025), (0.045, None)])
def test_virtual_fixture_draws_in_from_w_and_no_farther(start, rest):
    paddle = hl.SimulatedPaddle.from_profile(hl.library.nominal, b=1.0)
    log = paddle.run(hl.library.virtual_fixture(), duration=3, x=start)
    if rest is None:
        assert log.x[-1] < 0.035  # pushed out of the forbidden region
    else:
        assert abs(log.x[-1] - rest) < 1e-6


@pytest.mark.parametrize("P", [0.6, 1.0, 1.8])
def test_buckling_beam_has_the_equilibria_of_a_pitchfork(led, P):
    p = hl.library.buckling_beam().values
    x = np.linspace(-0.05, 0.05, 1001)
    F = field(led, "buckling_beam", x, P=P)
    there = np.array([0.0]) if P <= 1 else np.array([-1, 0, 1]) * np.sqrt(p["k"] * (P - 1) / p["k_3"])
    assert np.abs(field(led, "buckling_beam", there, P=P)).max() < 1e-12
    slope = np.interp(there, x, np.gradient(F, x))
    assert list(slope >= 0) == ([True] if P <= 1 else [True, False, True])


@pytest.mark.parametrize("side", [-1, 1])
def test_a_paddle_snaps_into_the_state_on_its_side(side):
    paddle = hl.SimulatedPaddle.from_profile(hl.library.nominal, b=1.0)
    log = paddle.run(hl.library.buckling_beam(), duration=3, x=side * 1e-3)
    assert abs(log.x[-1] - side * 0.03) < 1e-6
