"""The limits of damping compensation against loops written out by hand, and against paddles that run away."""

from importlib.util import find_spec

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.optimize import brentq

import hapticlab as hl
from hapticlab.errors import AnalysisError, SceneError
from hapticlab.limits.stability import closed_loop_poles
from hapticlab.rendering.compensation_limit import compensation_limit
from hapticlab.rendering.over_compensation import over_compensation

#: seconds of located friction take minutes in the interpreter
quick = pytest.mark.skipif(find_spec("llvmlite") is None, reason="needs llvmlite: a long simulation with friction")
T, M, DAMPING, COULOMB = 1e-3, 0.05, 0.1, 0.02


def paddle(**changes):
    return hl.SimulatedPaddle(**{"m": M, "b": DAMPING, "T": T, "coulomb": COULOMB, **changes})


def radius(part, hand, delay, tau):
    """Largest pole of the loop, by hand: x, v, the filtered velocity, the last sample, and forces under way."""
    m, b, k = M + hand.m, DAMPING + hand.b, hand.k
    whole = round(delay / T)
    both = expm(T * np.array([[0, 1, 0], [-k / m, -b / m, -1 / m], [0, 0, 0]]))
    size = 4 + whole
    step, force = np.zeros((size, size)), np.zeros(size)
    rate = np.zeros(size)  # (tau w + x - x_last)/(tau + T)
    rate[[0, 2, 3]] = np.array([1, tau, -1]) / (tau + T)
    force = -part * DAMPING * rate
    felt = force if not whole else np.eye(size)[4 + whole - 1]
    step[:2, :2] = both[:2, :2]
    step[:2] += np.outer(both[:2, 2], felt)
    step[2], step[3, 0] = rate, 1
    for age in range(whole):
        step[4 + age] = force if age == 0 else np.eye(size)[3 + age]
    return abs(np.linalg.eigvals(step)).max()


@pytest.mark.parametrize("tau", [0.0, 3e-3])
@pytest.mark.parametrize("delay", [0.0, 2e-3])
@pytest.mark.parametrize("hand", [hl.Hand(k=150), hl.Hand(m=0.05, b=1, k=400)], ids=["spring", "hand"])
def test_about_a_spring_it_is_where_a_pole_leaves_the_circle(hand, delay, tau):
    limit = compensation_limit(paddle(hand=hand, delay=delay), velocity=hl.velocity.filtered(tau=tau))
    at = (DAMPING + hand.b) / DAMPING
    expected = brentq(lambda part: radius(part, hand, delay, tau) - 1, 0.5 * at, 3 * at, xtol=1e-14)
    # the radius is known to 1e-15, and grows by 1e-4 or more over the part
    assert limit.viscous == pytest.approx(expected, rel=1e-9)
    natural = np.sqrt(hand.k / (M + hand.m)) / (2 * np.pi)
    assert limit.frequency == pytest.approx(natural, rel=0.05)


@quick
@pytest.mark.parametrize("delay", [0.0, 3.5e-3])
@pytest.mark.parametrize("velocity", [None, hl.velocity.filtered(tau=5e-3), hl.velocity.kalman(acceleration=2, noise=1e-5)])
@pytest.mark.always("None-*", "velocity1-0.0035")
def test_a_free_handle_drifts_off_at_one_whatever_the_lag(velocity, delay):
    limit = compensation_limit(paddle(delay=delay), velocity=velocity)
    assert (limit.viscous, limit.frequency) == (1.0, 0.0)
    scene = hl.laws.damping_compensation(b=DAMPING, velocity=velocity)
    for part, grows in ((0.97, False), (1.03, True)):
        log = paddle(delay=delay, coulomb=0).run(scene(viscous=part), duration=1.0, v=0.1)
        assert (abs(log.v[-1]) > abs(log.v[300])) == grows


def test_a_hand_s_damping_counts():
    assert compensation_limit(paddle(hand=hl.Hand(b=0.25))).viscous == pytest.approx(3.5, rel=1e-15)


def test_a_light_handle_under_a_slow_filter_turns_before_it_drifts():
    """A handle that settles within a period, and a filter that overshoots: another pole leaves first."""
    light = paddle(m=2e-5, b=0.5, coulomb=0, delay=2e-3)
    limit = compensation_limit(light, velocity=hl.velocity.kalman(acceleration=100, noise=1e-5))
    assert limit.frequency > 50
    assert limit.viscous < 1
    scene = hl.laws.damping_compensation(b=0.5, velocity=hl.velocity.kalman(acceleration=100, noise=1e-5))
    for part, grows in ((0.97, False), (1.03, True)):
        poles = closed_loop_poles(light, K=part * limit.viscous, law=scene, parameter="viscous")
        assert (abs(poles).max() > 1 + 1e-6) == grows


@quick
@pytest.mark.parametrize("delay", [0.0, 2.5e-3])
def test_over_compensated_a_free_handle_settles_at_the_speed_said(delay):
    """(dry - 1) coulomb/(damping left), whatever the delay: from below and from above."""
    here = paddle(delay=delay)
    scene = hl.laws.damping_compensation(b=DAMPING, coulomb=COULOMB, speed=0.01, sign="dead_zone")(viscous=0.6, dry=1.5)
    expected = compensation_limit(here).speed(viscous=0.6, dry=1.5)
    assert expected == pytest.approx(0.5 * COULOMB / (0.4 * DAMPING), rel=1e-14)
    for start in (0.05, 0.6):
        log = here.run(scene, duration=30.0, v=start, dtype="float64")
        assert log.v[-1] == pytest.approx(expected, rel=1e-9)  # exp(-24) of the start is left


@quick
def test_it_runs_away_beyond_the_kick_said():
    limit = compensation_limit(paddle())
    kick = limit.kick(viscous=1.5, dry=0.5)
    assert kick == pytest.approx(0.2, rel=1e-14)
    scene = hl.laws.damping_compensation(b=DAMPING, coulomb=COULOMB, speed=0.01, sign="dead_zone")(viscous=1.5, dry=0.5)
    for start, away in ((0.99 * kick, False), (1.01 * kick, True)):
        log = paddle().run(scene, duration=8.0, v=start)
        assert (log.v[-1] > 2 * kick) == away
        assert away or log.v[-1] == 0
    assert limit.kick(viscous=0.9, dry=0.5) == np.inf
    assert limit.speed(viscous=1.1, dry=0.5) == np.inf
    assert limit.speed(viscous=0.1, dry=0.5) == 0


def hunting_by_pieces(viscous, dry, k, m):
    """Amplitude of the limit cycle from the exact half-swings of the piecewise linear motion, followed until it settles."""
    b, g = (1 - viscous) * DAMPING, (dry - 1) * COULOMB
    decay, w = b / (2 * m), np.sqrt(k / m - (b / (2 * m)) ** 2)
    kept, at = np.exp(-np.pi * decay / w), 0.02
    for _ in range(2000):
        at = g / k + kept * (at + g / k)
    return at


@quick
@pytest.mark.parametrize(("viscous", "dry"), [(0.0, 1.4), (0.5, 1.2)])
def test_about_a_spring_it_hunts_with_the_amplitude_said(viscous, dry):
    k = 20.0
    here = paddle(T=1e-4, hand=hl.Hand(k=k, intent=0.0))
    limit = compensation_limit(here)
    assert limit.hunts_from(viscous) < dry
    expected = limit.hunting(viscous, dry)
    assert expected == pytest.approx(hunting_by_pieces(viscous, dry, k, M), rel=1e-12)
    scene = hl.laws.damping_compensation(b=DAMPING, coulomb=COULOMB, speed=2e-4, sign="dead_zone")(viscous=viscous, dry=dry)
    log = here.run(scene, duration=6.0, x=0.95 * expected, dtype="float64", progress=False)
    last = log.x[log.t > 5]
    # the period, 0.1 ms of a swing of 0.3 s, and the width of the dead zone each take a part in a thousand
    assert (last.max() - last.min()) / 2 == pytest.approx(expected, rel=0.01)


@quick
@pytest.mark.parametrize(("part", "hunts"), [(0.97, False), (1.06, True)])
def test_it_hunts_from_the_part_said(part, hunts):
    here = paddle(T=1e-4, b=0.4, hand=hl.Hand(k=20, intent=0.0))
    limit = compensation_limit(here)
    dry = part * limit.dry
    assert limit.dry > 1.2
    scene = hl.laws.damping_compensation(b=0.4, coulomb=COULOMB, speed=2e-4, sign="dead_zone")(viscous=0, dry=dry)
    log = here.run(scene, duration=4.0, x=0.004, dtype="float64", progress=False)
    assert (np.ptp(log.x[log.t > 3.5]) > 0) == hunts
    assert (limit.hunting(0.0, dry) > 0) == hunts


@pytest.mark.parametrize("delay", [0.0, 2e-3])
@pytest.mark.parametrize("hand", [hl.Hand(k=150), hl.Hand(m=0.05, b=1, k=400)], ids=["spring", "hand"])
def test_a_damping_believed_too_high_leaves_less_to_cancel(hand, delay):
    """5 % too high: the loop of the true handle, by hand, is unstable from 1.05 times that part on."""
    late = hl.velocity.filtered(tau=3e-3)
    limit = compensation_limit(paddle(hand=hand, delay=delay, b=1.05 * DAMPING), b_least=DAMPING, velocity=late)
    at = (DAMPING + hand.b) / DAMPING
    expected = brentq(lambda part: radius(part, hand, delay, 3e-3) - 1, 0.5 * at, 3 * at, xtol=1e-14)
    assert limit.viscous == pytest.approx(expected / 1.05, rel=1e-9)
    alone = compensation_limit(paddle(b=1.05 * DAMPING, delay=delay), b_least=DAMPING)
    assert alone.viscous == pytest.approx(1 / 1.05, rel=1e-15)
    assert "for every device with b from 0.1 N s/m," in str(alone)


@quick
def test_the_whole_of_a_friction_believed_too_high_runs_away():
    """The speed and the kick said, of a true handle with 5 % less damping and 10 % less Coulomb friction than believed."""
    believed, true = paddle(b=1.05 * DAMPING, coulomb=1.1 * COULOMB), paddle()
    limit = compensation_limit(believed, b_least=DAMPING, coulomb_least=COULOMB)
    assert limit.dry == pytest.approx(1 / 1.1, rel=1e-15)
    scene = hl.laws.damping_compensation(b=believed.b, coulomb=believed.coulomb, speed=0.01, sign="dead_zone")
    expected = limit.speed(viscous=0.5, dry=1.0)
    assert expected == pytest.approx(0.1 * COULOMB / (DAMPING - 0.5 * believed.b), rel=1e-12)
    assert true.run(scene(viscous=0.5, dry=1.0), duration=25.0, v=0.1).v[-1] == pytest.approx(expected, rel=1e-4)
    kick = limit.kick(viscous=1.0, dry=0.5)
    assert kick == pytest.approx(0.45 * COULOMB / (0.05 * DAMPING), rel=1e-12)
    for start, away in ((0.99 * kick, False), (1.01 * kick, True)):
        log = true.run(scene(viscous=1.0, dry=0.5), duration=3.0, v=start)
        assert (log.v[-1] > start) == away


@quick
@pytest.mark.wide
def test_friction_identified_then_cancelled_comes_to_rest_up_to_the_limit_of_its_intervals():
    """The intervals hold the truth here; so 0.99 of the limit rests, and 1.02 of all that is there keeps moving."""
    true = hl.SimulatedPaddle(m=M, b=0.4, T=T, coulomb=0.05, noise=5e-6, force_max=2.0)
    found = hl.identify.paddle(true, kinds=("steps",))
    like = found.paddle()
    safe = compensation_limit(like, b_least=found["b"].low, coulomb_least=found["coulomb"].low)
    assert safe.viscous == pytest.approx(found["b"].low / found["b"].value, rel=1e-12) and 0.9 < safe.viscous < 1
    assert safe.dry == pytest.approx(found["coulomb"].low / found["coulomb"].value, rel=1e-12) and safe.dry < 1
    scene = hl.laws.damping_compensation(b=like.b, coulomb=like.coulomb, speed=0.01, sign="dead_zone")
    exact = hl.SimulatedPaddle(m=M, b=0.4, T=T, coulomb=0.05)
    for part, rests in ((0.99, True), (1.02 / safe.viscous, False)):
        log = exact.run(scene(viscous=part * safe.viscous, dry=part * safe.dry), duration=15.0, v=0.05)
        assert (log.v[-1] == 0) == rests


def test_it_says_what_it_is():
    text = str(compensation_limit(paddle(hand=hl.Hand(k=150), delay=1e-3)))
    assert "exact linear stability of this plant" in text
    assert "Hz" in text and "hunts about the hand's spring" in text
    figure = compensation_limit(paddle(hand=hl.Hand(k=150))).plot()
    assert {t.get_text() for t in figure.axes[0].texts} == {"runs away", "comes to rest", "hunts"}


@pytest.mark.parametrize(
    ("call", "error", "words"),
    [
        (lambda: compensation_limit("hapkit"), AnalysisError, "a str has no m; needs a paddle"),
        (
            lambda: over_compensation("hapkit", speed=0.01),
            AnalysisError,
            "paddle is a str; over-compensation runs in simulation only.",
        ),
        (lambda: compensation_limit(paddle(b=0)), AnalysisError, "b = 0.*nothing to compensate"),
        (
            lambda: compensation_limit(paddle(), b_least=-1e-3),
            AnalysisError,
            "b_least = -0.001.*Identify the damping more precisely",
        ),
        (lambda: compensation_limit(paddle(), coulomb_least=1), AnalysisError, "coulomb_least <= 0.02"),
        (
            lambda: compensation_limit(paddle(), velocity=hl.velocity.window(deviation=1e-5)),
            SceneError,
            "no transfer function",
        ),
        (lambda: compensation_limit(paddle()).hunting(0, 2), AnalysisError, "no spring to hunt about"),
        (lambda: compensation_limit(paddle(hand=hl.Hand(k=9))).speed(0, 2), AnalysisError, "needs a free handle"),
    ],
)
def test_what_has_no_answer_is_refused(call, error, words):
    with pytest.raises(error, match=words):
        call()
