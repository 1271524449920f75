"""The admittance display's coupler: slow motion by hand, random passive pairs, and the eigenvalues of sampled loops."""

import numpy as np
import pytest
from scipy.linalg import expm

import hapticlab as hl
from hapticlab.errors import AnalysisError
from hapticlab.limits.admittance import admittance_design, admittance_display

T = 1e-3


def paddle(**values):
    return hl.SimulatedPaddle(**{"m": 0.05, "b": 0.5, "T": T, **values})


def radius(k, *, b, b_s, m_a=np.inf, k_e=0.0, m=0.05, k_s=0.0):
    """Largest |pole| of the whole sampled loop: hand of stiffness k, handle, servo, body m_a and a spring k_e beside it."""
    turn = expm(T * np.array([[0, 1, 0], [-k / m, -b / m, -1 / m], [0, 0, 0]]))
    x, _, before, w, z = np.eye(5)  # x, v, x[n-1], the body's velocity and place
    w = 0 * w if np.isinf(m_a) else (m_a / T * w - k * x - k_e * z) / (m_a / T + k_e * T)
    z = z + T * w
    loop = np.array([0 * x, 0 * x, x, w, z])
    loop[:2, :2] = turn[:2, :2]
    loop[:2] += np.outer(turn[:2, 2], b_s * ((x - before) / T - w) + k_s * (x - z))
    return np.abs(np.linalg.eigvals(loop)).max()


@pytest.mark.parametrize("delay", [0.0, 0.2e-3])
def test_slow_motion_sets_the_least_mass(delay):
    """m_a = b_s lag^2/(2 T), the lag of servo and sensor to first order: (m - b_s (tau + T/2))/(b + b_s) + tau + delay."""
    b_s, tau = 0.3, T / 2 + delay
    lag = (0.05 - b_s * (tau + T / 2)) / (0.5 + b_s) + tau + delay
    design = admittance_design(paddle(delay=delay), servo=b_s)
    assert design.m_a == pytest.approx(b_s * lag**2 / (2 * T), rel=1e-4) and design.frequency == 0
    assert "stopped by slow motion" in str(design)
    assert design.two_port.absolutely_stable


def test_no_environment_makes_the_hand_feel_a_negative_mobility_and_with_a_lighter_body_one_does():
    """Environments in resonance with the coupler, the worst there are, and random ones: by the felt mobility itself."""
    generator, theta = np.random.default_rng(5), np.linspace(0.01, np.pi, 300)
    turns = np.tan(np.linspace(-1.5, 1.5, 201))
    random = 10 ** generator.uniform(-4, 3, 100) * np.exp(1j * generator.uniform(-np.pi / 2, np.pi / 2, 100))
    for servo, b_a in ((0.3, 0.0), (0.45, 0.0), (0.4, 0.1)):
        design = admittance_design(paddle(), servo=servo, b_a=b_a)
        least = []
        for factor in (1.0, 0.7):
            display = admittance_display(m=0.05, b=0.5, T=T, b_s=servo, m_a=factor * design.m_a, b_a=b_a)
            own = display.h(theta)[:, 1, 1]
            resonant = [1 / (1j * (own.real * turn - own.imag)) for turn in turns]
            least.append(min(display.felt(theta, Y).real.min() for Y in (*resonant, *random)))
        assert least[0] > -1e-9 and least[1] < 0


def test_a_spring_in_the_servo_needs_a_damper_on_the_coupler():
    # b_a >= (lag k_s)^2/(4 (b + b_s - k_s tau)) with the lag of slow motion, m and b hidden by the spring
    b, b_s, k_s, tau = 0.5, 0.2, 500.0, T / 2
    lag = b / k_s - T / 2  # of C_2/(Z + C_1): b/k_s, less half a period by which the last velocity is told sooner
    least = (lag * k_s) ** 2 / (4 * (b + b_s - k_s * tau))
    servo = {"servo": b_s, "servo_stiffness": k_s}
    assert admittance_design(paddle(), b_a=1.02 * least, **servo).two_port.absolutely_stable
    for b_a in (0.0, 0.98 * least):
        with pytest.raises(AnalysisError, match="slow motion against the servo's spring needs b_a >= 0.03"):
            admittance_design(paddle(), b_a=b_a, **servo)


@pytest.mark.parametrize(("b_s", "k_s"), [(2.0, 0.0), (1.5, 200.0), (150.0, 0.0), (2000.0, 0.0)])
def test_a_servo_that_some_hand_makes_unstable_is_refused(b_s, k_s):
    """Eq. (23.10) with the environment at rest, b >= k_s T/2 + b_s: eigenvalues find the spring of the hand."""
    hands = np.geomspace(1e4, 1e6, 60)
    alone = radius(0.0, b=0.5, b_s=b_s, k_s=k_s) > 1 + 1e-6
    assert alone == (b_s > hl.stability.damper_limit(hl.Device(m=0.05, b=0.5, T=T)))
    assert max(radius(k, b=0.5, b_s=b_s, k_s=k_s) for k in hands) > 1 + 1e-4
    with pytest.raises(AnalysisError, match="diverges without a hand" if alone else "active in some hand"):
        admittance_design(paddle(), servo=b_s, servo_stiffness=k_s, b_a=10)
    assert admittance_display(m=0.05, b=0.5, T=T, b_s=b_s, k_s=k_s).stable != alone


def test_the_servo_that_is_accepted_is_stable_and_with_it_the_display():
    design = admittance_design(paddle(), servo=0.45)
    for k in np.geomspace(1, 3e5, 60):
        assert radius(k, b=0.5, b_s=0.45) < 1 + 1e-9
        assert radius(k, b=0.5, b_s=0.45, m_a=design.m_a) < 1 + 1e-7
        assert radius(k, b=0.5, b_s=0.45, m_a=design.m_a, k_e=1e3) < 1 + 1e-7
    with pytest.raises(AnalysisError, match="servo = 0"):
        admittance_design(paddle(), servo=0)


def test_words_and_picture():
    design = admittance_design(paddle(), servo=0.3)
    assert "continuous approximation below the Nyquist frequency" in str(design)
    left, right = design.plot().axes
    assert "Hz" in left.get_xlabel() and right.lines[1].get_ydata().min() > -1e-9
