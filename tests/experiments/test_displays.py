"""Displays against the exact stability limit of the same wall, statics by hand, and their own eigenvalues in time."""

import math
from dataclasses import replace

import numpy as np
import pytest

from hapticlab.device.hand.hand import Hand
from hapticlab.device.simulated.simulated_paddle import SimulatedPaddle
from hapticlab.errors import AnalysisError, PaddleError
from hapticlab.experiments.display_laws import Admittance, Impedance, display_motion, growth, largest_stiffness
from hapticlab.experiments.displays import compare_displays, render
from hapticlab.limits.stability import stability_limit

GRIP = Hand(m=0.1, b=5.0, k=500.0)
PADDLE = SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=GRIP)
LAW = {"m_v": 0.2, "k_p": 1500.0, "k_d": 17.0}


@pytest.mark.parametrize("paddle", [PADDLE, replace(PADDLE, m=0.2, b=2.0, T=5e-4)], ids=["light", "heavy"])
def test_the_impedance_displays_limit_is_the_exact_one_of_that_wall(paddle):
    """Two derivations: eigenvalues of a stepped handle, and poles of the closed loop's transfer function."""
    found = largest_stiffness(paddle, lambda k: Impedance(k=k))
    assert found == pytest.approx(float(stability_limit(paddle, law="zoh")), rel=1e-8)


def test_eigenvalues_say_how_a_motion_dies_out():
    """The tail of a press against the largest eigenvalue: an admittance display that rings."""
    display = Admittance(k=1000.0, m_v=1.0, k_p=1500.0, k_d=17.0)
    paddle = replace(PADDLE, hand=replace(GRIP, intent=lambda t: np.where(np.asarray(t) < 0.05, 0.0, 0.05)))
    _, x, *_ = display_motion(paddle, display, duration=3.0)
    away = x - 500 * 0.05 / 1500  # both springs in balance; it never leaves the wall
    # one pair of eigenvalues is left after a second: away[n + 2] = 2 Re(z) away[n + 1] - |z|^2 away[n]
    late = away[1000:]
    _, square = np.linalg.lstsq(np.column_stack([late[1:-1], late[:-2]]), late[2:], rcond=None)[0]
    assert math.sqrt(-square) == pytest.approx(growth(paddle, display), rel=1e-9)


@pytest.mark.parametrize(("ahead", "expected"), [(0.0, 1 / (1 / 800 + 1 / 1500)), (1.0, 800.0)])
def test_a_wall_is_felt_in_series_with_the_position_controller(ahead, expected):
    found = render(PADDLE, Admittance(k=800.0, ahead=ahead, **LAW))
    assert found.state == "at rest"
    assert found.k == pytest.approx(expected, rel=1e-3)


def test_each_display_shows_its_own_mass():
    wall = render(PADDLE, Impedance(k=400.0))
    assert wall.mass == pytest.approx(0.05, rel=0.06) and wall.k == pytest.approx(400, rel=1e-3)
    assert render(PADDLE, Admittance(k=400.0, **LAW)).mass == pytest.approx(0.2, rel=0.06)


def test_a_body_that_is_late_by_half_a_period_drives_the_hand():
    """Force of a body m a(t - T/2): at 3 Hz a damping of -m w^2 T/2, -0.036 N s/m."""
    found = render(PADDLE, Admittance(k=300.0, **LAW))
    assert found.damping == pytest.approx(-0.2 * (6 * math.pi) ** 2 * 1e-3 / 2, rel=0.2) and "drives the hand" in str(found)
    assert found.misfit > abs(found.friction) and "friction below" in str(found)  # there is none
    alone = render(PADDLE, Impedance(k=300.0))
    assert alone.damping == pytest.approx(0.1, rel=0.01) and alone.misfit < 1e-4


@pytest.mark.wide
def test_an_admittance_display_hides_friction():
    rough = replace(PADDLE, coulomb=0.1)
    assert render(rough, Impedance(k=400.0)).friction == pytest.approx(0.1, rel=0.1)
    assert abs(render(rough, Admittance(k=400.0, **LAW)).friction) < 0.02


def test_a_light_virtual_mass_costs_stiffness():
    limits = [largest_stiffness(PADDLE, lambda k, m=m: Admittance(k=k, **{**LAW, "m_v": m})) for m in (0.02, 0.1, 0.5)]
    assert limits[0] < limits[1] < limits[2]


def test_the_comparison_tells_and_draws():
    found = compare_displays(PADDLE, [300.0, 30_000.0])
    states = {(row.display, row.wanted): row.state for row in found.rows}
    assert states["impedance", 30_000.0] == "unstable" and states["admittance", 30_000.0] == "at rest"
    assert math.isnan(found.rows[1].k) and "unstable" in str(found) and "largest stable stiffness" in str(found)
    assert [a.get_xlabel() for a in found.plot().axes] == ["stiffness of the wall k [N/m]"]


def test_a_late_sensor_makes_it_worse():
    heavy = Admittance(k=3000.0, **LAW)
    swings = []
    for late in (0, 6):
        _, x, *_ = display_motion(replace(PADDLE, hand=replace(GRIP, intent=lambda t: 0.02 * (np.asarray(t) > 0))), heavy,
                                  duration=0.6, sensor_delay=late)  # fmt: skip
        swings.append(np.ptp(x[-100:]))
    assert swings[1] > 2 * swings[0]


def test_what_cannot_be_compared_is_refused():
    with pytest.raises(PaddleError, match="moves by an intent"):
        display_motion(PADDLE, Impedance(k=1.0), duration=0.1)
    with pytest.raises(PaddleError, match="needs a hand that feels it."):
        growth(replace(PADDLE, hand=None), Impedance(k=1.0))
    with pytest.raises(AnalysisError, match="m_v"):
        compare_displays(PADDLE, [100.0], m_v=0.0)
    for k in (math.nan, math.inf):
        with pytest.raises(AnalysisError, match="finite"):
            compare_displays(PADDLE, [k])
    with pytest.raises(AnalysisError, match="some k > 0"):
        compare_displays(PADDLE, [])
