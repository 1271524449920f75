"""Coulomb friction: closed forms of stopping, sticking and breaking away, and an integration with located events."""

import math
import re

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from hapticlab.device.hand.hand import Hand
from hapticlab.device.simulated import friction
from hapticlab.device.simulated.plant import plant_of, values
from hapticlab.device.simulated.simulated_paddle import SimulatedPaddle
from hapticlab.errors import PaddleError


def step(paddle, x, v, F=0.0, intent=0.0, rate=0.0):
    """Advance one period in plain floats."""
    plant = plant_of(paddle)
    p = dict(zip((c.name for c in plant.channels()), values(paddle), strict=True))
    return plant.step(p, x, v, F, F, intent, rate)[2:]


def test_spin_down_stops_at_the_closed_form():
    m, b, c, v = 0.05, 0.4, 0.31, 0.2
    x_stop = m * v / b - c * m / b**2 * math.log(1 + b * v / c)  # M v' = -b v - c from v to 0
    T = 2 * m / b * math.log(1 + b * v / c)
    for period in (T, T / 7, T / 50):
        paddle = SimulatedPaddle(m=m, b=b, T=period, coulomb=c)
        x, speed = 0.0, v
        for _ in range(60):
            x, speed = step(paddle, x, speed)
        assert speed == 0.0
        assert x == pytest.approx(x_stop, rel=1e-14)


def test_stopping_time_is_exact():
    """The position reached in a period that ends just before or after the stop brackets the stop to 1e-12 of it."""
    m, b, c, v = 0.05, 0.4, 0.31, 0.2
    t_stop = m / b * math.log(1 + b * v / c)
    before = step(SimulatedPaddle(m=m, b=b, T=t_stop * (1 - 1e-12), coulomb=c), 0.0, v)
    after = step(SimulatedPaddle(m=m, b=b, T=t_stop * (1 + 1e-12), coulomb=c), 0.0, v)
    assert 0 < before[1] < 1e-11 * v and after[1] == 0


@pytest.mark.parametrize("push", [0.29, -0.29, 0.2999, 0.3, 0.0])
def test_stuck_below_the_friction(push):
    paddle = SimulatedPaddle(m=0.05, b=0.1, T=1e-3, coulomb=0.3, hand=Hand(push=push, b=2))
    assert step(paddle, 0.017, 0.0) == (0.017, 0.0)


@pytest.mark.parametrize("push", [0.31, -0.31])
def test_slides_above_the_friction(push):
    paddle = SimulatedPaddle(m=0.05, b=0.0, T=1e-3, coulomb=0.3, hand=Hand(push=push))
    a = math.copysign(0.01 / 0.05, push)
    assert step(paddle, 0.0, 0.0) == pytest.approx((a * 1e-6 / 2, a * 1e-3), rel=1e-13)


def test_reversal_inside_the_period():
    m, c, F, v, T = 0.05, 0.3, 1.0, 0.02, 2e-3
    stop = m * v / (F + c)
    x_stop, left, back = v * stop / 2, T - stop, (F - c) / m
    got = step(SimulatedPaddle(m=m, b=0.0, T=T, coulomb=c), 0.0, v, F=F)
    assert got == pytest.approx((x_stop - back * left**2 / 2, -back * left), rel=1e-13)


def test_breaks_away_under_a_ramp():
    """Only k: M v' = k r (t - t_break), with the intent's ramp r, until the spring feels the motion: w t is small."""
    m, c, k, r, T = 0.05, 0.3, 100.0, 2.0, 4e-3
    t_break = c / (k * r)
    left, w = T - t_break, math.sqrt(k / m)
    x = r * (left - math.sin(w * left) / w)  # the spring-mass answer to a ramp from rest
    got = step(SimulatedPaddle(m=m, b=0.0, T=T, coulomb=c, hand=Hand(k=k, intent=np.sin)), 0.0, 0.0, rate=r)
    assert got == pytest.approx((x, r * (1 - math.cos(w * left))), rel=1e-12)


def reference(M, b, k, c, u, d, x, v, T, steps=25):
    """Integrate M x'' = u + d t - b x' - k x - c sign(x') with its events located on DOP853's dense output."""
    now, stops = 0.0, 0
    while now < T:

        def net(time, x=x):
            return u + d * time - k * x

        if v == 0 and abs(net(now)) <= c:
            if abs(net(T)) <= c:
                return x, 0.0, stops
            now = brentq(lambda time: abs(net(time)) - c, now, T, xtol=1e-17, rtol=1e-15)
            sign = math.copysign(1, net(T))
        else:
            sign = math.copysign(1, v if v else net(now))

        def stop(time, y):
            return y[1]

        stop.terminal, stop.direction = True, -sign
        run = solve_ivp(
            lambda time, y, sign=sign: [y[1], (u + d * time - b * y[1] - k * y[0] - c * sign) / M],
            (now, T), [x, v], method="DOP853", rtol=1e-12, atol=1e-16, events=stop, max_step=T / steps,
        )  # fmt: skip
        x, v, now = *run.y[:, -1], run.t[-1]
        if run.status == 1:
            v, stops = 0.0, stops + 1
    return x, v, stops


def random_case(seed):
    rng = np.random.default_rng(seed)
    M, T = rng.uniform(0.02, 0.2), rng.uniform(5e-4, 4e-3)
    b = M / T * rng.choice([1e-3, 0.1, 2.0]) * rng.uniform(0.5, 1.5)
    k = M / T**2 * rng.choice([1e-3, 0.1, 4.0]) * rng.uniform(0.5, 1.5)
    c = rng.uniform(0.1, 0.6)
    v = c * T / M * rng.uniform(-1.5, 1.5) * rng.choice([0, 1, 1])
    x = rng.uniform(-1, 1) * 2 * c / k
    F = rng.uniform(-2, 2) * c
    rate = rng.uniform(-4, 4) * c / (k * T) * rng.choice([0, 1, 1])
    return M, b, k, c, v, x, F, rate, T


@pytest.mark.parametrize("seed", range(120))
@pytest.mark.always("?", "?0")
def test_against_located_events(seed):
    M, b, k, c, v, x, F, rate, T = random_case(seed)
    paddle = SimulatedPaddle(m=M, b=b, T=T, coulomb=c, hand=Hand(k=k, intent=np.sin))
    *expected, _ = reference(M, b, k, c, -F, k * rate, x, v, T)
    got = step(paddle, x, v, F=F, rate=rate)
    scale = c * T / M
    # what DOP853 resolves at rtol 1e-12, and the rounding of x itself
    assert got[0] - expected[0] == pytest.approx(0, abs=2e-11 * scale * T + 1e-15 * abs(x))
    assert got[1] - expected[1] == pytest.approx(0, abs=2e-11 * scale)


def test_the_random_cases_stop():
    """Otherwise the comparison above would be of plain slipping."""
    stops = []
    for seed in range(120):
        M, b, k, c, v, x, F, rate, T = random_case(seed)
        stops.append(reference(M, b, k, c, -F, k * rate, x, v, T)[2])
    assert np.bincount(stops)[1] > 30 and np.bincount(stops)[2] >= 1


def test_touches_zero_and_goes_on():
    """Both ends of the period move forward, in between the handle stands still until the ramp pulls it on."""
    M, b, k, c, T = 0.05, 0.0, 30.0, 0.2, 4e-3
    rate = 1.2 / (k * T)
    for v in (0.1e-3, 0.5e-3, 0.7e-3, 0.749e-3):  # a smooth pass would need v > 0.15**2 M/(2 M k rate) = 0.75e-3
        *expected, stops = reference(M, b, k, c, 0.05, k * rate, 0.0, v, T, steps=400)
        paddle = SimulatedPaddle(m=M, b=b, T=T, coulomb=c, hand=Hand(k=k, push=0.05, intent=np.sin))
        assert stops == 1 and expected[1] > 0
        assert step(paddle, 0.0, v, rate=rate) == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("delay", [0.0, 3.7e-4])
@pytest.mark.parametrize("hand", [None, Hand(m=0.1, b=5, k=500), Hand(k=4e5, b=90, intent=np.sin)])
def test_vanishing_friction_is_the_matrix_exponential(hand, delay):
    """Two implementations of the same flow; the last hand needs several pieces a period."""
    given = {"m": 0.05, "b": 0.1, "T": 1e-3, "delay": delay, "hand": hand}
    rough, smooth = (SimulatedPaddle(**given, coulomb=c) for c in (1e-300, 0.0))
    rate = 0.3 if hand is not None and hand.moves else 0.0
    exact = step(smooth, 0.002, 0.4, F=0.7, rate=rate)
    assert step(rough, 0.002, 0.4, F=0.7, rate=rate) == pytest.approx(exact, rel=1e-13)


def test_terms_reach_machine_accuracy():
    """The first neglected term of the Taylor polynomial is below 1e-17 for every resolution in the table."""
    for terms, growth in friction.TERMS.items():
        assert growth**terms / math.factorial(terms) < 1e-17


@pytest.mark.parametrize(("M", "b", "k", "T"), [(0.05, 0.1, 0, 1e-3), (0.05, 40, 0, 1e-2), (0.01, 1, 5000, 1e-2)])
def test_pieces_bound_the_growth(M, b, k, T):
    pieces, terms = friction.resolution(T, M, b, k)
    rates = np.abs(np.roots([1, -b / M, -k / M]))  # of g^2 = (b/M) g + k/M
    assert rates.max() * T / pieces <= friction.TERMS[terms] * (1 + 1e-12)


def test_every_period_of_a_run(spring):
    """Stick and slip of a dragged handle on a spring, late by 1.3 periods: each period again, from its recorded start."""
    T, delay, c = 1e-3, 1.3e-3, 0.5
    hand = Hand(m=0.02, b=1.5, k=120, push=0.1, intent=lambda t: 0.004 * np.sin(60 * t))
    paddle = SimulatedPaddle(m=0.05, b=0.1, T=T, delay=delay, coulomb=c, hand=hand)
    log = paddle.run(spring(150.0), duration=0.12, v=-0.1)
    intent = hand.intent(np.arange(len(log) + 1) * T)
    part, stops = delay - T, 0
    for n in range(1, len(log) - 1):
        x, v, rate = log.x[n], log.v[n], (intent[n + 1] - intent[n]) / T
        for F, start, length in ((log.F_applied[n - 1], 0.0, part), (log.F_applied[n], part, T - part)):
            if start:
                assert log.x_switch[n] == pytest.approx(x, rel=1e-11)
            u = hand.push - F + hand.b * rate + hand.k * (intent[n] + start * rate)
            x, v, stopped = reference(0.07, 1.6, hand.k, c, u, hand.k * rate, x, v, length, steps=4)
            stops += stopped
        assert log.x[n + 1] == pytest.approx(x, rel=1e-10, abs=1e-15)
        assert log.v[n + 1] == pytest.approx(v, rel=1e-9, abs=1e-12)
    assert stops >= 2 and (log.v == 0).sum() >= 10


def test_too_many_pieces_are_refused():
    paddle = SimulatedPaddle(m=1e-6, b=1.0, T=1e-3, coulomb=0.1)
    words = "m = 1e-06 kg, T = 0.001 s.* settles in 1e-06 s.* into 1e[+]03 pieces; .*Use m >= 1.57e-05 kg, T"
    with pytest.raises(PaddleError, match=words):
        _ = paddle.plant
    with pytest.raises(PaddleError, match="m = 1e-200 kg.*into inf pieces"):
        _ = SimulatedPaddle(m=1e-200, b=1e90, T=1e-3, coulomb=0.1).plant


@pytest.mark.parametrize("hand", [None, Hand(m=1e-5, b=0.3, k=900.0)])
def test_what_the_refusal_says_is_taken(hand):
    given = {"m": 1e-9, "b": 1.0, "T": 1e-3, "coulomb": 0.1, "hand": hand}
    with pytest.raises(PaddleError) as refused:
        _ = SimulatedPaddle(**given).plant
    said = {name: float(number) for name, number in re.findall(r"(m|T) [<>]= (\S+)", str(refused.value))}
    for name, number in said.items():
        assert 60 <= SimulatedPaddle(**{**given, name: number}).plant.pieces <= friction.MOST_PIECES
    assert len(said) == 2
