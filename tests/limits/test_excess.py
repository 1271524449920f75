"""The ledger against Colgate's condition, against matrices of all motions, and against springs that bend."""

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.errors import AnalysisError

T = 1e-3
GENERATOR = np.random.default_rng(5)


@pytest.mark.parametrize("delay", [0.0, 1e-3, 3e-3, 2e-4, 5e-4, 1.7e-3, 2.95e-3])
def test_a_linear_spring_is_exact(delay):
    """Colgate's condition in the frequency domain says the same, to rounding."""
    ledger = hl.passivity.ledger(hl.Device(b=0, T=T, delay=delay), K=640)
    b = hl.passivity.margin(hl.Device(b=0, delay=delay), hl.laws.LinearLaw.of(K=640, T=T)).required
    assert -ledger.index == pytest.approx(b, rel=1e-9)


def least_damping(f, periods=120, K=1.0):
    """Smallest b of which no motion draws energy: T = K = 1, delay f < 1, by the eigenvalues of the work of all motions."""
    both = 2 * periods
    moved = np.eye(both)
    place = np.vstack([np.zeros(both), np.cumsum(moved[0::2] + moved[1::2], axis=0)])
    F = K * place[:-1]
    before = np.vstack([np.zeros(both), F[:-1]])
    work = before.T @ moved[0::2] + F.T @ moved[1::2]
    stored = K * np.outer(place[-1], place[-1]) / 2
    form = (work + work.T) / 2 - stored
    weight = np.tile([f, 1 - f], periods) ** 0.5  # D1^2/f + D2^2/(1-f) becomes a sum of squares
    return -np.linalg.eigvalsh(weight[:, None] * form * weight)[0]


@pytest.mark.parametrize("f", [0.25, 0.6])
def test_a_fraction_of_delay_costs_more_than_half_plus_f(f):
    """(1/2 + f) K T is not enough between whole periods; motions of 120 periods come within 0.1 % of the ledger."""
    found = -hl.passivity.ledger(hl.Device(b=0, T=1.0, delay=f), K=1.0).index
    least = least_damping(f)
    assert 0.5 + f < least <= found
    assert least == pytest.approx(found, rel=1e-3)


def bending(places, slopes):
    """Return F and its energy for a spring of piecewise linear slope, F(0) = U(0) = 0, exact by integration."""
    fine = np.linspace(places[0], places[-1], 100_001)
    step = fine[1] - fine[0]
    k = np.interp(fine, places, slopes)
    F = np.r_[0, np.cumsum((k[1:] + k[:-1]) / 2 * step)]
    F -= np.interp(0, fine, F)
    U = np.r_[0, np.cumsum((F[1:] + F[:-1]) / 2 * step)]
    return (lambda x: np.interp(x, fine, F)), (lambda x: np.interp(x, fine, U - U.min()))


@pytest.mark.parametrize("late", [0, 1, 2])
def test_springs_that_bend_keep_the_inequality(late):
    """Random steps through random springs with soft, stiff and negative slopes: work + paid >= what is stored, always."""
    for _ in range(8):
        slopes = GENERATOR.uniform(-300, 500, 9)
        force, energy = bending(np.linspace(-0.02, 0.02, 9), slopes)
        k_min, k_max = slopes.min(), slopes.max()
        b = -hl.passivity.ledger(hl.Device(b=0, T=T, delay=late * T), K=(k_min, k_max)).index
        x = np.clip(np.cumsum(GENERATOR.choice([1e-4, 1e-3, 4e-3]) * GENERATOR.normal(size=300)), -0.0199, 0.0199)
        x[: late + 2] = 0
        D, held = np.diff(x), np.r_[np.zeros(late), force(x)][: len(x) - 1]
        left = np.cumsum(held * D + b / T * D**2) - (energy(x[1:]) - energy(x[0]))
        assert left.min() > -1e-9  # J, of the interpolated energy


@pytest.mark.parametrize("f", [0.2, 0.5, 0.85])
@pytest.mark.parametrize("late", [0, 1])
def test_springs_that_bend_keep_it_when_the_force_changes_inside_the_period(late, f):
    for _ in range(4):
        slopes = GENERATOR.uniform(-300, 500, 9)
        force, energy = bending(np.linspace(-0.02, 0.02, 9), slopes)
        b = -hl.passivity.ledger(hl.Device(b=0, T=T, delay=(late + f) * T), K=(slopes.min(), slopes.max())).index
        size = GENERATOR.choice([1e-4, 1e-3, 4e-3])
        x = np.clip(np.cumsum(size * GENERATOR.normal(size=300)), -0.0199, 0.0199)
        x[: late + 2] = 0
        D = np.diff(x)
        before = GENERATOR.uniform(-1, 2, len(D)) * D  # of D, what was moved before the force changed: any part at all
        F = np.r_[np.zeros(late + 1), force(x)][: len(x)]  # the older force of each period, then the newer
        work = F[:-1] * before + F[1:] * (D - before)
        paid = b / T * (before**2 / f + (D - before) ** 2 / (1 - f))
        left = np.cumsum(work + paid) - (energy(x[1:]) - energy(x[0]))
        assert left.min() > -1e-9  # J, of the interpolated energy


def test_negative_slopes_cost_the_hold_nothing_and_the_stiffest_place_decides():
    """To and fro around the stiffest place draws k_max a^2/2 a period; a latch of -900 N/m elsewhere adds nothing."""
    force, _ = bending(np.array([-0.02, -0.011, -0.01, 0.01, 0.011, 0.02]), np.array([-900, -900, 400, 400, -900, -900]))
    a = 1e-3
    x = a * np.tile([1, -1], 50) / 2
    drawn = -(force(x[:-1]) * np.diff(x)).sum() / 99
    assert drawn == pytest.approx(400 * a**2 / 2, rel=1e-6)
    ledger = hl.passivity.ledger(hl.Device(b=0.25, T=T), K=(-900, 400), bounded=True)
    assert ledger.passive and ledger.index == pytest.approx(0.25 - 400 * T / 2)
    assert "bounded below" in str(ledger)


@pytest.mark.parametrize("given", [-100, (-100, -50), (-100, 0)])
def test_a_spring_that_only_pushes_off_is_kept_by_no_damping(given):
    """m z^2 + b z - k has a root beyond 1, whatever b is, so there is nothing to prove."""
    rate = max(np.roots([0.05, 5.0, -100]))  # 17 1/s
    falling = hl.Scene(force=-hl.parameters("k", units="N/m", values=100) * hl.x(hl.n))
    log = hl.SimulatedPaddle(m=0.05, b=5.0, T=T).run(falling, duration=0.5, x=1e-4, progress=False)
    assert log.x[-1] > 0.5 * 1e-4 * np.exp(0.49 * rate) > 0.1
    with pytest.raises(AnalysisError, match="no slope is positive"):
        hl.passivity.ledger(hl.Device(b=5.0, T=T), K=given)


def test_where_a_slope_is_negative_nothing_is_proved_unless_the_energy_is_bounded():
    """A slope of 400 N/m to one side and of -900 N/m to the other: within the range, and it falls off to that side."""
    paddle = hl.SimulatedPaddle(m=0.05, b=0.25, T=T)
    ledger = hl.passivity.ledger(paddle, K=(-900, 400))
    assert ledger.index > 0 and not ledger.passive and ledger.gain == np.inf
    assert "If it has one, give bounded=True" in str(ledger)
    k, c = hl.parameters("k c", units="N/m N/m", values=(400, 900))
    scene = hl.Scene(force=hl.when(hl.x(hl.n) > 0, k, -c) * hl.x(hl.n))
    assert hl.stability.local_stiffness(scene, -0.01, 0.01) == pytest.approx((-900, 400))
    assert paddle.run(scene, duration=0.2, x=-1e-4, progress=False).x[-1] < -1.0
    assert hl.passivity.ledger(paddle, K=(-900, 400), bounded=True).passive


def test_a_range_of_dampers_counts_by_its_largest_magnitude():
    assert hl.passivity.ledger(hl.Device(b=1, T=T), B=(-0.3, 0.2)).index == pytest.approx(0.7)
    assert hl.passivity.ledger(
        hl.Device(b=1, T=T), B=-0.3, K=100, parts=[("brake", 0.5, "eddy currents")]
    ).index == pytest.approx(1.15)


def test_an_environment_that_answers_late_is_a_sample_of_delay():
    late = hl.passivity.ledger(hl.Device(b=1, T=T), K=100, delayed=True)
    delayed = hl.passivity.ledger(hl.Device(b=1, T=T, delay=T), K=100)
    assert late.index == delayed.index == pytest.approx(1 - 1.5 * 0.1)


def test_it_says_what_is_left_and_what_it_bounds():
    ledger = hl.passivity.ledger(hl.Device(b=0.5, T=T, delay=5e-4), K=200, B=0.05)
    assert ledger.gain == pytest.approx(1 / ledger.index)
    assert "passive in every passive hand" in str(ledger)
    short = hl.passivity.ledger(hl.Device(b=0.05, T=T), K=200)
    assert not short.passive and short.gain == np.inf and "passivity is not proved" in str(short)
    axes = ledger.plot().axes[0]
    assert [label.get_text() for label in axes.get_yticklabels()] == ["device", "hold", "delay", "damper", "left"]
    assert axes.get_xlabel().endswith("[N s/m]")


def test_the_gain_bounds_what_the_hand_gets():
    """Mean squares over a run: a noisy hand on a wall that always acts; the bound is not far off at low stiffness."""
    b, K = 0.4, 60.0
    ledger = hl.passivity.ledger(hl.Device(b=b, T=T), K=K)
    paddle = hl.SimulatedPaddle(m=0.004, b=b, T=T, hand=hl.Hand(push_noise=1.0))
    log = paddle.run(hl.wall(unilateral=None)(k=K), duration=4.0, progress=False)
    force = paddle.inputs(len(log))[:, -1]
    mean_v = np.sqrt(np.mean((np.diff(log.x) / T) ** 2))
    assert mean_v < ledger.gain * np.sqrt(np.mean(force**2))
    assert mean_v > 0.2 * ledger.gain * np.sqrt(np.mean(force**2))


@pytest.mark.parametrize("given", [(1, 2, 3), (2.0, 1.0), float("nan"), "stiff"])
def test_ranges_are_checked(given):
    with pytest.raises(AnalysisError, match="K = .*least"):
        hl.passivity.ledger(hl.Device(b=1, T=T), K=given)
