"""Dead-beat pairs against closed forms, and against the exact wall, whose own reference is mpmath."""

import math
from dataclasses import replace

import mpmath as mp
import numpy as np
import pytest

import hapticlab as hl
from hapticlab.compiler.boards.cost import cost
from hapticlab.compiler.engines.engine import load
from hapticlab.errors import AnalysisError, SceneError

#: Gillespie and Cutkosky (1996): 0.35 kg, a finger of 0.006 kg on 500 N/m, a floor of 5000 N/m, 100 Hz
BED = hl.SimulatedPaddle(m=0.35, b=0.0, T=0.01, hand=hl.Hand(m=0.006, k=500, intent=0.01))
BALL = hl.SimulatedPaddle(m=0.05, b=0.0, T=1e-3)


def run(paddle, scene, duration, x, v=0.0):
    return paddle.run(scene, duration=duration, x=x, v=v, progress=False, dtype="float64")


def test_the_pair_of_an_entry_has_its_closed_form():
    """A free mass enters after d/v0; two held forces add (3 F1 + F2) T^2/2M and (F1 + F2) T/M, which is what the wall does."""
    M, T, v0, K, depth = BALL.m, BALL.T, 0.4, 20000.0, 0.05e-3
    log = run(BALL, hl.laws.deadbeat_wall(BALL, K=K), 4e-3, -depth, v0)
    w, inside = math.sqrt(K / M), 2 * T - depth / v0
    dx = 2 * T * v0 - depth - v0 / w * math.sin(w * inside)
    dv = v0 - v0 * math.cos(w * inside)
    pair = [M * (dx / T**2 - dv / (2 * T)), M * (3 * dv / (2 * T) - dx / T**2)]
    # 1e-16 m of rounding times M/T^2 = 5e4 N/m
    np.testing.assert_allclose(log.F[:2], pair, rtol=1e-9, atol=1e-10)
    assert log.pair[:2].tolist() == [1, 2]
    assert [log.x[2], log.v[2]] == pytest.approx([2 * T * v0 - depth - dx, v0 - dv], rel=1e-11)


@pytest.mark.wide
@pytest.mark.parametrize(("delay", "x_o"), [(0.0, 0.0), pytest.param(0.01, 0.003, marks=pytest.mark.slow), (0.004, 0.003)])
def test_the_test_bed_emulates_the_floor_for_two_seconds(delay, x_o):
    """After every pair the handle is where finger, handle and floor would be; so it does not chatter."""
    paddle = hl.SimulatedPaddle(m=0.35, b=0.0, T=0.01, delay=delay, hand=BED.hand)
    log = run(paddle, hl.laws.deadbeat_wall(paddle, K=5000)(x_o=x_o), 2.0, -0.02)
    exact = hl.laws.hybrid_wall(paddle, K=5000, duration=2.0, x=-0.02, x_o=x_o)
    assert len(exact.crossings) >= 40
    if delay:  # the pair ends between samples; by the next sample outside, the floor is done with
        away = (log.x < x_o - 5e-3) & (exact.x[:-1] < x_o - 5e-3) & (log.F == 0)
        away[2:] &= (log.F[:-2] == 0) & (log.F[1:-1] == 0)
    else:
        away = np.r_[True, log.pair[:-1] != 1]
    assert np.count_nonzero(away) > 40
    # the crossing's accuracy 1e-10 of what moves in a period, 22 times over, in a motion that keeps what it is given
    assert abs(log.x - exact.x[:-1])[away].max() < 1e-10
    assert not log.fault


@pytest.mark.wide
def test_a_reactive_pair_makes_good_what_the_entry_missed():
    log = run(BED, hl.laws.deadbeat_wall(BED, K=5000, pairs=hl.laws.Pairs(begins="reactive")), 2.0, -0.02)
    exact = hl.laws.hybrid_wall(BED, K=5000, duration=2.0, x=-0.02)
    late = np.r_[False, log.pair[:-1] == 2]
    assert np.count_nonzero(late) > 30
    assert abs(log.x - exact.x[:-1])[late].max() < 1e-10
    begins = np.flatnonzero(log.pair == 1)
    first = begins[0]
    assert log.x[first] > 0 > log.x[first - 1] and log.F[first - 1] == 0  # the boundary was crossed before it knew


def test_a_damped_paddle_in_a_damped_wall():
    hand = hl.Hand(m=0.02, b=1.0, k=150.0, push=1.0)
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=2e-3, hand=hand)
    log = run(paddle, hl.laws.deadbeat_wall(paddle, K=3000.0, B=1.5, velocity="model"), 0.1, -0.004, 0.5)
    exact = hl.laws.hybrid_wall(paddle, K=3000.0, B=1.5, duration=0.1, x=-0.004, v=0.5)
    even = np.r_[True, log.pair[:-1] != 1]
    assert log.x.max() > 1e-3 and abs(log.x - exact.x[:-1])[even].max() < 1e-10


@pytest.mark.slow
def test_between_crossings_half_a_sample_is_cheaper_and_second_best():
    """The chapter's combination: exact at crossings, and inside as good as a prediction of one period can be."""
    exact = hl.laws.hybrid_wall(BALL, K=500, duration=0.05, x=-0.3e-3, v=0.2)
    stray = {}
    for between in ("pairs", "half_sample", "digital"):
        log = run(BALL, hl.laws.deadbeat_wall(BALL, K=500, pairs=hl.laws.Pairs(between=between)), 0.05, -0.3e-3, 0.2)
        stray[between] = abs(log.x - exact.x[:-1])[np.r_[True, log.pair[:-1] != 1]].max() / exact.x.max()
    zoh = run(BALL, hl.wall()(k=500), 0.05, -0.3e-3, 0.2)
    assert stray["pairs"] < 1e-9
    assert stray["half_sample"] < 2e-3 and stray["digital"] < 2e-3  # some (wT)^2/10
    assert abs(zoh.x - exact.x[:-1]).max() / exact.x.max() > 0.1


@pytest.mark.slow
def test_a_touch_of_less_than_two_periods_keeps_its_energy():
    """Half a swing in the wall lasts 1.8 periods: in and out within one pair."""
    K = BALL.m * (math.pi / (1.8 * BALL.T)) ** 2
    log = run(BALL, hl.laws.deadbeat_wall(BALL, K=K), 0.02, -0.05e-3, 0.3)
    exact = hl.laws.hybrid_wall(BALL, K=K, duration=0.02, x=-0.05e-3, v=0.3)
    assert len(exact.crossings) == 2 and np.diff(exact.crossings)[0] < 2 * BALL.T
    assert log.v[-1] == pytest.approx(-0.3, rel=1e-8) and abs(log.x[-1] - exact.x[-2]) < 1e-10


def test_the_gains_blow_up_and_the_limit_says_so():
    """An error e of the position alone changes the forces of a free mass by M e/T^2: 4 times as much at half the period."""
    gains = [hl.design.deadbeat_gains(hl.SimulatedPaddle(m=0.05, b=0.0, T=T, counts_per_metre=1e5)) for T in (1e-3, 5e-4)]
    assert gains[0].position == pytest.approx((5e4, -5e4), rel=1e-12)
    assert gains[1].count == pytest.approx(4 * gains[0].count, rel=1e-12)
    weak = hl.SimulatedPaddle(m=0.05, b=0.0, T=1e-3, force_max=1.0)
    log = run(weak, hl.laws.deadbeat_wall(weak, K=2000), 0.05, -0.3e-3, 0.4)
    assert log.limited.max() == 1 and abs(log.F).max() == 1.0
    assert hl.design.deadbeat_gains(weak).count is None


@pytest.mark.parametrize("begins", ["predictive", "reactive"])
@pytest.mark.always("predictive")
def test_it_runs_bit_for_bit_in_the_firmware_core(begins):
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, counts_per_metre=1e6, force_max=8.0)
    program = paddle.program(hl.laws.deadbeat_wall(paddle, K=600.0, pairs=hl.laws.Pairs(begins=begins), velocity="model"))
    path = (0.002 * np.sin(0.06 * np.arange(250))).astype(np.float32)[:, None]
    there, here = (load(program, engine).run(250, path).outputs for engine in ("vm", "interpreter"))
    np.testing.assert_array_equal(there, here)
    assert there[:, 1].max() == 2


def test_the_uno_has_room_for_a_rough_one():
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=2.5e-3, counts_per_metre=1e5)
    rough = hl.laws.deadbeat_wall(paddle, K=500, pairs=hl.laws.Pairs(accuracy=0.05, crossings=1, between="half_sample"))
    fine = hl.laws.deadbeat_wall(paddle, K=500)
    assert cost(paddle.program(rough)).fits
    assert "needs" in cost(paddle.program(fine)).memory_problem


def test_what_is_no_pair_is_refused():
    with pytest.raises(
        SceneError, match="begins = 'now', between = 'pairs', crossings = 2; needs begins to be one of predictive,"
    ):
        hl.laws.deadbeat_wall(BALL, K=500, pairs=hl.laws.Pairs(begins="now"))
    with pytest.raises(AnalysisError, match=r"the handle reverses within T = 0.001 s; .* Use T <= 0.0007"):
        hl.laws.deadbeat_wall(BALL, K=1e6)
    with pytest.raises(AnalysisError, match="accuracy = 1; needs a number from 1e-15 to 0.1"):
        hl.laws.deadbeat_wall(BALL, K=500, pairs=hl.laws.Pairs(accuracy=1))


@pytest.mark.parametrize(
    ("start", "speed"),
    [
        (-0.004, 0.6),
        pytest.param(0.0062, -0.75, marks=pytest.mark.slow),
        pytest.param(0.003, -0.5, marks=pytest.mark.slow),
        pytest.param(-0.0001, 0.05, marks=pytest.mark.slow),
    ],
)
def test_a_crossing_is_located_to_1e_10_s(start, speed):
    """On the damped test bed, from outside and from inside: the time the scene finds, against mpmath's."""
    paddle = hl.SimulatedPaddle(m=0.35, b=1.2, T=0.01, hand=BED.hand)
    scene = hl.laws.deadbeat_wall(paddle, K=5000)
    lines = {type(e.lhs).__name__: e.lhs for e in scene.eom}
    last = max(int(name[2:-2]) for name in lines if name.startswith("at") and name.endswith("_1"))
    scene = replace(scene, watch={"crosses": lines[f"at{last}_1"]})
    found = paddle.run(scene, duration=0.01, x=start, v=speed, progress=False, dtype="float64").crosses[0] * paddle.T
    with mp.workdps(30):
        M, decay, stiff = mp.mpf("0.356"), mp.mpf("1.2") / (2 * mp.mpf("0.356")), mp.mpf(500 + 5000 * (start >= 0))
        w, rest = mp.sqrt(stiff / M - decay**2), 5 / stiff
        a = start - rest
        c = (speed + decay * a) / w
        place = lambda t: mp.exp(-decay * t) * (a * mp.cos(w * t) + c * mp.sin(w * t)) + rest  # noqa: E731
        root = mp.findroot(place, (0, paddle.T), solver="anderson", tol=1e-50)
    assert 0 < root < paddle.T and found == pytest.approx(float(root), abs=1e-11)
