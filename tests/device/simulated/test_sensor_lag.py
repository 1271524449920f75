"""A sensor that lags: against an integration from event to event, in lanes, in every engine, and at no cost where it is off."""

import itertools
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import hapticlab as hl
from hapticlab.analysis.sweeps.lane_runs import LaneRuns
from hapticlab.device.simulated.simulated_paddle import SimulatedPaddle, link
from hapticlab.errors import PaddleError

T = 1e-3
SWAY = hl.Hand(m=0.02, b=1.0, k=200.0, push=0.6, intent=lambda t: 0.004 * np.sin(40 * t))
WALL = hl.wall()(k=300, x_o=0.001)
BASE = {"m": 0.05, "b": 0.1, "T": T, "hand": SWAY}


def integrated(paddle, ticks, v):
    """Where the handle is at the samples, and what is read of it, by DOP853 between all instants at which anything happens."""
    hand, M, F = paddle.hand, paddle.m + paddle.hand.m, 0.0
    intent = hand.intent(np.arange(ticks + 1) * T)
    reads = {n * T - paddle.sensor_delay: n for n in range(ticks)}
    seen = {n: v * at for at, n in reads.items() if at < 0}  # it came evenly
    instants = sorted({*(n * T for n in range(ticks + 1)), *(at for at in reads if at >= 0), *(
        n * T + paddle.delay for n in range(ticks))})  # fmt: skip
    instants = [a for a, b in itertools.pairwise([*instants, np.inf]) if b - a > 1e-12 and a < ticks * T + 1e-12]
    y, truth, arrivals = np.array([0.0, v]), [], {}
    for now, until in itertools.pairwise(instants):
        tick = int(now / T + 1e-9)
        for at, n in reads.items():
            if abs(at - now) < 1e-12:
                seen[n] = y[0]
        if abs(now - tick * T) < 1e-12:
            truth.append(y[0])
            arrivals[now + paddle.delay] = 300 * (seen[tick] - 0.001) * (seen[tick] >= 0.001)
        F = next((force for at, force in arrivals.items() if abs(at - now) < 1e-12), F)
        slope = (intent[tick + 1] - intent[tick]) / T

        def field(t, y, F=F, at=intent[tick], slope=slope, begin=tick * T):
            pull = hand.k * (y[0] - at - slope * (t - begin)) + hand.b * (y[1] - slope)
            return [y[1], (hand.push - F - paddle.b * y[1] - pull) / M]

        y = solve_ivp(field, (now, until), y, method="DOP853", rtol=1e-12, atol=1e-16).y[:, -1]
    return np.array(truth), np.array([seen[n] for n in range(ticks)])


@pytest.mark.parametrize(
    ("delay", "lag"), [(0.0, 4e-4), (3e-4, 1e-3), (3e-4, 5e-4), (3e-4, 7e-4), (1.6e-3, 2.9e-3), (0.0, 2e-3), (2e-3, 1e-4)]
)
@pytest.mark.always("0.0003-*", "0.0-0.0004")
def test_what_the_scene_sees_is_where_the_handle_was(delay, lag):
    """A reading before the force changes, at that instant, after it; whole samples; both."""
    paddle = SimulatedPaddle(**BASE, delay=delay, sensor_delay=lag)
    log = paddle.run(WALL, duration=60 * T, v=0.2, dtype="float64")
    truth, seen = integrated(paddle, 60, 0.2)
    assert np.abs(log.x_true - truth).max() < 1e-9 * np.abs(truth).max()
    assert np.abs(log.x - seen).max() < 1e-9 * np.abs(seen).max() and log.F.max() > 0.5
    assert np.abs(log.x - log.x_true).max() > 0.5 * 0.2 * lag  # and that is not where it is
    assert log.sensor_delay == lag and log.delay == delay and log.v[0] == 0.0


def test_the_sum_of_lag_and_delay_is_what_counts():
    """In a hand at rest, the same motion as with all of it in the computation, begun so much earlier."""
    hand = hl.Hand(m=0.02, b=1.0, k=200.0)
    late = SimulatedPaddle(m=0.05, b=0.0, T=T, delay=2e-3, sensor_delay=3e-3, hand=hand)
    same = SimulatedPaddle(m=0.05, b=0.0, T=T, delay=5e-3, hand=hand)
    a = late.run(hl.wall(unilateral=None)(k=40), duration=0.2, x=1e-3, dtype="float64")
    b = same.run(hl.wall(unilateral=None)(k=40), duration=0.2, x=1e-3, dtype="float64")
    assert np.array_equal(a.x[3:], a.x_true[:-3]) and np.all(a.x[:3] == 1e-3)
    # until the first force of either, both swing freely; what then differs is the three samples of rest at the start
    assert np.array_equal(a.x_true[:3], b.x[:3]) and not np.array_equal(a.x_true[3:], b.x[3:])


def test_off_it_costs_nothing():
    """The same program, instruction by instruction, and no state or parameter more."""
    plain = link(SimulatedPaddle(**BASE, delay=3e-4).program(WALL), SimulatedPaddle(**BASE, delay=3e-4))
    off = SimulatedPaddle(
        **BASE, delay=3e-4, sensor_delay=0.0, duty_dead=0.2, duty_25=0.3, duty_50=0.4, duty_75=0.7, force_full=5.0
    )
    assert link(off.program(WALL), off).tick == plain.tick and off.structure == SimulatedPaddle(**BASE, delay=3e-4).structure
    assert not any("sensor" in c.name or "motor" in c.name for c in plain.parameters + plain.states)
    assert len(link(SimulatedPaddle(**BASE, delay=3e-4, sensor_delay=1e-4).program(WALL), SimulatedPaddle(
        **BASE, delay=3e-4, sensor_delay=1e-4))) > len(plain)  # fmt: skip


def test_lanes_and_sweeps_have_it():
    """Bit for bit what each paddle gives alone, also where a reading moves over the force's change from lane to lane."""
    paddle = SimulatedPaddle(**BASE)
    lags, masses, delays = np.array([0.0, 4e-4, 9e-4, 1.7e-3]), np.array([0.03, 0.05]), np.array([0.0, 3e-4, 1.6e-3])
    axes = {"sensor_delay": lags, "m": masses, "delay": delays}
    swept = hl.sweep(hl.wall(), paddle, 0.1, metric="peak_force", k=300, x_o=0.001, v=0.1, **axes)
    for at in np.ndindex(swept.values.shape):
        own = {name: axes[name][k] for name, k in zip(axes, at, strict=True)}
        log = replace(paddle, **own).run(WALL, duration=0.1, v=0.1)
        assert swept.values[at] == np.abs(log.F).max(), own


def test_a_lag_that_is_less_than_rounding_is_none_but_for_the_velocity():
    """Also right after a paddle without, whose program it shares but for where its velocity comes from."""
    for lag, columns in ((0.0, 4), (1e-13, 6), (0.0, 4)):
        log = SimulatedPaddle(m=0.05, b=0.1, T=T, sensor_delay=lag).run(hl.wall()(k=100), duration=0.01, v=0.1)
        assert len(log.columns) == columns


def test_a_map_over_the_lag():
    """Its line of passivity is 2 b / (T + 2 lag) for whole samples, as for a delay."""
    paddle, lags = SimulatedPaddle(m=0.05, b=0.5, T=T, hand=hl.Hand(push=0.5)), np.array([0.0, 1e-3, 2e-3])
    found = hl.stability.wall_map(paddle, over=("K", "sensor_delay"), sensor_delay=lags, K=np.array([100.0, 300.0]), duration=0.3)
    assert [float(hl.passivity_limit(replace(paddle, sensor_delay=lag))) for lag in lags] == pytest.approx(
        [2 * 0.5 / (T + 2 * lag) for lag in lags]
    )
    assert found.regions.shape == (2, 3) and found.regions[0, 0] < found.regions[1, 2]


def test_lanes_have_the_motor():
    """Its force at full duty is force_max where no other is given, also where that is an axis; energy is of what acted."""
    paddle, limits = SimulatedPaddle(m=0.05, b=0.1, T=T, duty_dead=0.1, force_max=1.0, compensated=False), np.array([1.0, 4.0])
    swept = hl.sweep(hl.wall(), paddle, 0.3, metric="energy", k=300, x_o=0, v=0.2, force_max=limits)
    alone = [replace(paddle, force_max=limit).run(hl.wall()(k=300, x_o=0), duration=0.3, v=0.2) for limit in limits]
    drawn = [hl.energy(log).extracted for log in alone]
    assert swept.values.ravel() == pytest.approx(drawn, rel=1e-9) and drawn[0] != drawn[1]


def test_lanes_of_other_periods_lag_as_long():
    """A map over T runs in one period by similarity, in which the lag shrinks with the delay."""
    wall = hl.wall(unilateral=None)(k=900.0)
    for own in (5e-4, 2e-3):
        runs = LaneRuns(wall, 0.5, workers=1)
        similar = runs.chatter(SimulatedPaddle(m=0.05, b=1.0, T=T, sensor_delay=4e-4), {"T": np.array([own])})[1]
        itself = runs.chatter(SimulatedPaddle(m=0.05, b=1.0, T=own, sensor_delay=4e-4), {"m": np.array([0.05])})[1]
        other = runs.chatter(SimulatedPaddle(m=0.05, b=1.0, T=own), {"m": np.array([0.05])})[1]
        assert similar == pytest.approx(itself, rel=1e-6) and abs(other - itself) > 1e-3 * itself


@pytest.mark.parametrize(("given", "words"), [
    ({"sensor_delay": -1e-3}, "cannot show a position before the handle is there"),
    ({"sensor_delay": 2.0, "hand": None}, "sensor_delay = 2 s is 2000 samples"),
    ({"duty_dead": 0.7}, "duty_dead = 0.7; needs a part of full duty from 0 to 0.5"),
    ({"duty_25": 0.3}, "needs three duties that rise from the dead band to 1, or none"),
    ({"duty_25": 0.3, "duty_50": 0.2, "duty_75": 0.8}, "needs three duties that rise"),
    ({"duty_dead": 0.1, "compensated": False}, "the force at full duty is not known. Give force_full"),
])  # fmt: skip
def test_what_no_paddle_has_is_refused(given, words):
    with pytest.raises(PaddleError, match=words):
        SimulatedPaddle(**BASE | given)


def test_a_motor_that_the_board_does_not_know():
    """Nothing in the dead band, the curve beyond; by hand, at the knots and between them. The energy is that of what acted."""
    curve = {"duty_dead": 0.1, "duty_25": 0.2, "duty_50": 0.4, "duty_75": 0.7, "force_full": 4.0}
    paddle = SimulatedPaddle(**BASE, **curve, compensated=False)
    log = paddle.run(hl.wall()(k=500, x_o=0.0), duration=0.2, v=0.6, dtype="float64")
    duty = np.abs(log.F) / 4.0
    assert log.F_applied == pytest.approx(4.0 * np.interp(duty, [0.1, 0.2, 0.4, 0.7, 1.0], [0, 0.25, 0.5, 0.75, 1]), abs=1e-12)
    assert duty.max() > 0.7 and (log.F_applied[log.F > 0] == 0).any()
    known = SimulatedPaddle(**BASE, **curve).run(hl.wall()(k=500, x_o=0.0), duration=0.2, v=0.4, dtype="float64")
    plain = SimulatedPaddle(**BASE).run(hl.wall()(k=500, x_o=0.0), duration=0.2, v=0.4, dtype="float64")
    assert np.array_equal(known.F, plain.F) and np.array_equal(known.x, plain.x)
