"""The admittance display's coupler: the expansion for slow motion, random passive pairs, and a servo that is active."""

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.errors import AnalysisError
from hapticlab.limits.admittance import admittance_design, admittance_display

T = 1e-3


def paddle(**values):
    return hl.SimulatedPaddle(**{"m": 0.05, "b": 0.5, "T": T, **values})


@pytest.mark.parametrize("delay", [0.0, 0.2e-3])
def test_slow_motion_sets_the_least_mass(delay):
    """m_a = b_s lag^2/(2 T), from the lag of servo and sensor to first order in w: (m - b_s tau)/(b + b_s) + tau + delay."""
    b_s, tau = 0.5, T / 2 + delay
    lag = (0.05 - b_s * tau) / (0.5 + b_s) + tau + delay
    design = admittance_design(paddle(delay=delay), servo=b_s)
    assert design.m_a == pytest.approx(b_s * lag**2 / (2 * T), rel=1e-4) and design.frequency < 1
    assert design.two_port.absolutely_stable


def test_no_environment_makes_the_hand_feel_a_negative_mobility_and_with_a_lighter_body_one_does():
    """Environments in resonance with the coupler, the worst there are, and random ones: by the felt mobility itself."""
    generator, theta = np.random.default_rng(5), np.linspace(0.01, np.pi, 300)
    turns = np.tan(np.linspace(-1.5, 1.5, 201))
    random = 10 ** generator.uniform(-4, 3, 100) * np.exp(1j * generator.uniform(-np.pi / 2, np.pi / 2, 100))
    for servo, b_a in ((0.5, 0.0), (10.0, 0.0), (2.0, 0.2)):
        design = admittance_design(paddle(), servo=servo, b_a=b_a)
        least = []
        for factor in (1.0, 0.7):
            display = admittance_display(m=0.05, b=0.5, T=T, b_s=servo, m_a=factor * design.m_a, b_a=b_a)
            own = display.h(theta)[:, 1, 1]
            resonant = [1 / (1j * (own.real * turn - own.imag)) for turn in turns]
            least.append(min(display.felt(theta, Y).real.min() for Y in (*resonant, *random)))
        assert least[0] > -1e-9 and least[1] < 0


def test_a_spring_in_the_servo_needs_a_damper_on_the_coupler():
    with pytest.raises(AnalysisError, match="slow motion against the servo's spring needs b_a >= 0.02"):
        admittance_design(paddle(), servo=2.0, servo_stiffness=500.0)
    # b_a >= (lag k_s)^2/(4 (b + b_s - k_s tau)) with the lag of slow motion, m and b hidden by the spring
    k_s, tau = 500.0, T / 2
    lag = 0.5 / k_s  # of C/(Z + C), Z = b + ...: b/k_s, the servo's own lag being in both
    least = (lag * k_s) ** 2 / (4 * (0.5 + 2.0 - k_s * tau))
    for b_a, stands in ((1.02 * least, True), (0.98 * least, False)):
        if stands:
            assert admittance_design(paddle(), servo=2.0, servo_stiffness=k_s, b_a=b_a).two_port.absolutely_stable
        else:
            with pytest.raises(AnalysisError, match="slow motion"):
                admittance_design(paddle(), servo=2.0, servo_stiffness=k_s, b_a=b_a)


def test_an_active_servo_is_refused():
    """With the spring alone late by T/2 it is the wall of Eq. (23.10): b + b_s >= k_s T/2 for slow motion."""
    with pytest.raises(AnalysisError, match="active in the hand"):
        admittance_design(paddle(), servo=0.1, servo_stiffness=1.01 * 2 * 0.6 / T, b_a=10)
    assert admittance_design(paddle(), servo=0.1, servo_stiffness=0.9 * 2 * 0.6 / T, b_a=10).m_a >= 0
    with pytest.raises(AnalysisError, match="servo = 0"):
        admittance_design(paddle(), servo=0)


def test_words_and_picture():
    design = admittance_design(paddle(), servo=2.0)
    assert str(design).startswith("admittance coupler m_a = 0.40401 kg, b_a = 0 N s/m")
    left, right = design.plot().axes
    assert "Hz" in left.get_xlabel() and right.lines[1].get_ydata().min() > -1e-9
