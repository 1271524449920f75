"""The limit cycle of over-compensated friction: against runs on many paddles, the exact half-swings, and where it is to begin."""

from importlib.util import find_spec

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.errors import AnalysisError, SceneError
from hapticlab.rendering.limit_cycle import limit_cycle

#: seconds of located friction take minutes in the interpreter
quick = pytest.mark.skipif(find_spec("llvmlite") is None, reason="needs llvmlite: a long simulation with friction")
SPEED = 0.006


def paddle(**changes):
    plain = {"m": 0.03, "b": 0.1, "T": 1e-3, "coulomb": 0.05, "hand": hl.Hand(m=0.005, b=0.02, k=20)}
    return hl.SimulatedPaddle(**{**plain, **changes})


def run(held, *, viscous, dry, sign="dead_zone", velocity=None, start, duration=9.0):
    """Amplitude and frequency that stay, by turns of the true position."""
    law = hl.laws.damping_compensation(b=held.b, coulomb=held.coulomb, speed=SPEED, sign=sign, velocity=velocity)
    log = held.run(law(viscous=viscous, dry=dry), duration=duration, x=start, progress=False)
    last = log.x[2 * len(log) // 3 :]
    last = last - (last.max() + last.min()) / 2
    up = np.flatnonzero((last[:-1] < 0) & (last[1:] >= 0))
    return np.ptp(last) / 2, (len(up) - 1) / max(up[-1] - up[0], 1) / held.T if len(up) > 1 else 0.0


def random_paddle(number):
    """A paddle with period, delay, lag, encoder and filter of its own, in a light hand."""
    draw = np.random.default_rng(number)
    count = (None, 12.8e-6)[number % 2]
    held = paddle(
        m=draw.uniform(0.02, 0.06), b=draw.uniform(0.03, 0.2), coulomb=draw.uniform(0.02, 0.1), T=draw.choice([5e-4, 1e-3, 2e-3]),
        hand=hl.Hand(m=draw.uniform(0, 0.02), b=draw.uniform(0, 0.1), k=draw.uniform(10, 100)),
        delay=draw.choice([0.0, 5e-4, 2e-3]), sensor_delay=draw.choice([0.0, 2.3e-4]), counts_per_metre=count and 1 / count,
    )  # fmt: skip
    velocity = hl.velocity.filtered(tau=draw.uniform(0.004, 0.01)) if count else hl.velocity.backward()
    begins = hl.design.compensation(held).hunts_from(0.0)
    return held, {"viscous": draw.uniform(0, 0.5), "dry": draw.uniform(1.3, 1.8) * begins, "velocity": velocity}


@quick
@pytest.mark.parametrize(
    "numbers",
    [range(1), pytest.param(range(1, 16), marks=pytest.mark.wide), pytest.param(range(16, 100), marks=pytest.mark.slow)],
)
def test_runs_end_in_the_cycles_said(numbers):
    """Over 100 paddles the amplitude is off by 0.6 % in the median and 5.7 % at most, the frequency by 0.1 % and 2.5 %."""
    ratios = []
    for number in numbers:
        held, options = random_paddle(number)
        said = limit_cycle(held, speed=SPEED, **options)
        amplitude, frequency = run(held, start=1.1 * said.amplitude, **options)
        ratios.append((said.amplitude / amplitude, said.frequency / frequency))
    off = np.abs(np.array(ratios) - 1)
    assert (off.max(axis=0) < [0.07, 0.03]).all()
    assert (np.median(off, axis=0) < [0.02, 0.005]).all()


@quick
def test_it_is_reached_from_both_sides_and_not_from_below_the_break_away():
    held = paddle(delay=1e-3, sensor_delay=5e-4)
    options = {"viscous": 0.0, "dry": 1.5, "velocity": hl.velocity.filtered(tau=6e-3)}
    said = limit_cycle(held, speed=SPEED, **options)
    assert said.threshold == pytest.approx(0.05 / 20, rel=1e-12)
    for start in (2 * said.threshold, 2 * said.amplitude):
        assert run(held, start=start, duration=15.0, **options)[0] == pytest.approx(said.amplitude, rel=0.02)
    assert run(held, start=0.95 * said.threshold, **options)[0] == 0.0


@quick
def test_the_smooth_sign_has_its_own_cycle():
    options = {"viscous": 0.3, "dry": 1.5, "sign": "smooth"}
    said = limit_cycle(paddle(), speed=SPEED, **options)
    assert said.amplitude == pytest.approx(run(paddle(), start=0.01, **options)[0], rel=0.02)


@pytest.mark.parametrize(("viscous", "dry"), [(0.0, 1.3), (0.6, 1.2)])
def test_without_delay_it_is_the_exact_cycle_of_half_swings(viscous, dry):
    """At a damping ratio of 0.02 the harmonics that are left out take a few parts in ten thousand."""
    held = paddle(T=1e-6, b=0.03, hand=hl.Hand(m=0.005, k=20))
    said = limit_cycle(held, viscous=viscous, dry=dry, speed=1e-6)
    assert said.amplitude == pytest.approx(hl.design.compensation(held).hunting(viscous, dry), rel=1e-3)
    assert said.frequency == pytest.approx(np.sqrt(20 / 0.035) / (2 * np.pi), rel=1e-3)


def test_without_delay_it_begins_where_the_spring_breaks_the_handle_away():
    held = paddle(T=1e-6, hand=hl.Hand(m=0.005, k=20))
    begins = hl.design.compensation(held).hunts_from(0.0)
    assert limit_cycle(held, viscous=0, dry=0.99 * begins, speed=1e-6).amplitude == 0
    assert limit_cycle(held, viscous=0, dry=1.01 * begins, speed=1e-6).amplitude > 0.05 / 20


@quick
def test_more_than_all_of_the_damping_grows_from_the_swing_said():
    """-b left pi w A = 4 (1 - dry) coulomb: an unstable cycle, below which dry friction wins."""
    held = paddle(T=1e-4, hand=hl.Hand(m=0.005, k=20))
    options = {"viscous": 1.5, "dry": 0.5}
    said = limit_cycle(held, speed=SPEED, **options)
    assert np.isinf(said.amplitude)
    assert said.threshold == pytest.approx(4 * 0.5 * 0.05 / (np.pi * 0.5 * 0.1 * np.sqrt(20 / 0.035)), rel=0.05)
    assert run(held, start=0.93 * said.threshold, duration=4.0, **options)[0] < 0.8 * said.threshold
    assert run(held, start=1.07 * said.threshold, duration=4.0, **options)[0] > 1.2 * said.threshold


def test_it_says_what_it_is():
    words = [
        str(limit_cycle(paddle(), viscous=viscous, dry=dry, speed="6 mm/s")) for viscous, dry in ((0, 1.5), (0, 1.0), (2, 0.5))
    ]
    assert words[0].startswith("limit cycle: 11.") and "Hz; a swing of less than 2.5 mm dies out" in words[0]
    assert words[1] == "limit cycle: none, the handle comes to rest"
    assert "a larger one grows without bound" in words[2]


@pytest.mark.parametrize(
    ("changes", "options", "error", "words"),
    [
        ({"hand": None}, {}, AnalysisError, "needs a spring to swing about"),
        ({"hand": hl.Hand(b=1)}, {}, AnalysisError, "needs a spring to swing about"),
        ({"coulomb": 0}, {}, AnalysisError, "coulomb = 0.*without dry friction"),
        ({}, {"dry": -1}, AnalysisError, "dry = -1"),
        ({}, {"speed": 0}, AnalysisError, "speed = 0"),
        ({}, {"sign": "round"}, ValueError, "round"),
        ({}, {"velocity": hl.velocity.window(deviation=1e-5)}, SceneError, "no transfer function"),
    ],
)
def test_what_has_no_cycle_is_refused(changes, options, error, words):
    with pytest.raises(error, match=words):
        limit_cycle(paddle(**changes), **{"viscous": 0, "dry": 1.5, "speed": SPEED, **options})
