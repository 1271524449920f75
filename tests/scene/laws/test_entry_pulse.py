"""Pulses on entry against the momentum they take from a free handle, in closed form."""

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.compiler.boards.cost import cost
from hapticlab.compiler.engines.engine import load
from hapticlab.errors import SceneError, UnitsError

T, M, SPEED, BOUNDARY = 1e-3, 0.05, 0.25, 0.0101
#: a boundary and nothing behind it: what the pulse does to a free handle, alone
OPEN = hl.wall()(k=0, x_o=BOUNDARY)
FREE = hl.SimulatedPaddle(m=M, b=0.0, T=T)


def run(scene, paddle=FREE, duration=0.1, **start):
    return paddle.run(scene, duration=duration, **{"x": 0.0, "v": SPEED, "dtype": "float64", **start})


def entry(log):
    return int(np.argmax(log.x >= BOUNDARY))


@pytest.mark.parametrize("periods", [1, 2, 5])
@pytest.mark.parametrize("part", [0.3, 1.0])
@pytest.mark.always("0.3-1", "1.0-5")
def test_a_pulse_takes_its_part_of_the_momentum(part, periods):
    log = run(hl.laws.braking_pulse(OPEN, part=part, mass=M, periods=periods))
    at = entry(log)
    assert 35 < at < 50
    np.testing.assert_array_equal(log.v[: at + 1], SPEED)
    np.testing.assert_allclose(log.F[at : at + periods], part * M * SPEED / (periods * T), rtol=1e-14)
    assert not log.F[at + periods :].any()
    np.testing.assert_allclose(log.v[at + periods :], (1 - part) * SPEED, atol=1e-15)


def test_a_damped_handle_loses_what_the_damper_takes_besides():
    """Over N periods under a held force: v exp(-c) - F (1 - exp(-c))/b, c = b N T/m."""
    b, periods = 0.4, 4
    log = run(hl.laws.braking_pulse(OPEN, part=0.5, mass=M, periods=periods), hl.SimulatedPaddle(m=M, b=b, T=T))
    at, c = entry(log), b * periods * T / M
    force = 0.5 * M * log.v[at] / (periods * T)
    expected = log.v[at] * np.exp(-c) - force * (1 - np.exp(-c)) / b
    assert log.v[at + periods] == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("delay", [0.0, 1e-3, 2.5e-3])
def test_an_impulse_is_taken_whenever_it_arrives(delay):
    log = run(hl.laws.braking_pulse(OPEN, impulse="5 mN*s", periods=3), hl.SimulatedPaddle(m=M, b=0, T=T, delay=delay))
    assert log.v[-1] == pytest.approx(SPEED - 5e-3 / M, rel=1e-12)
    assert log.F.sum() * T == pytest.approx(5e-3, rel=1e-12)


def test_a_pulse_that_is_too_long_ends_where_the_handle_has_stopped():
    """1.5 times the momentum in 5 periods: after 4 the handle has turned, at -0.2 of its speed and not -0.5."""
    log = run(hl.laws.braking_pulse(OPEN, impulse=1.5 * M * SPEED, periods=5))
    assert log.v[-1] == pytest.approx(-0.2 * SPEED, rel=1e-12)
    assert np.count_nonzero(log.F) == 4


def test_a_pulse_keeps_within_its_force():
    log = run(hl.laws.braking_pulse(OPEN, part=1, mass=M, periods=2, force_max=2.0))
    assert log.F.max() == 2.0
    assert log.v[-1] == pytest.approx(SPEED - 2 * T * 2.0 / M, rel=1e-12)


def test_a_handle_inside_is_not_braked_and_one_that_comes_again_is():
    """Started inside: nothing. On a stiff wall it bounces, and every entry has its pulse."""
    assert not run(hl.laws.braking_pulse(OPEN, part=1, mass=M), x=0.02, duration=0.02).F.any()
    log = run(hl.laws.braking_pulse(OPEN, impulse=1e-4), hl.SimulatedPaddle(m=M, b=0.0, T=T, hand=hl.Hand(k=300, intent=0.012)))
    entries = np.count_nonzero((log.x[1:] >= BOUNDARY) & (log.x[:-1] < BOUNDARY))
    assert entries >= 2
    assert np.count_nonzero(log.F) == entries


def test_friction_decelerates_evenly_and_stops_without_turning():
    """friction/mass T a period, then what is left of the speed in one period, then rest to the last bit."""
    friction, periods = 1.1, 40
    log = run(hl.laws.friction_pulse(OPEN, friction=friction, mass=M, periods=periods))
    at, step = entry(log), friction * T / M
    whole = int(SPEED / step)
    np.testing.assert_allclose(log.v[at : at + whole + 1], SPEED - step * np.arange(whole + 1), rtol=1e-13)
    np.testing.assert_allclose(log.v[at + whole + 1 :], 0, atol=1e-15)
    assert log.v.min() > -1e-15


@pytest.mark.parametrize("factor", [0.6, 1.7])
def test_friction_of_a_wrong_mass_does_not_throw(factor):
    """(1 - factor) of the speed is left from one period to the next: it shrinks for every factor below 2."""
    log = run(hl.laws.friction_pulse(OPEN, friction=1.1, mass=factor * M, periods=60))
    assert abs(log.v[-1]) < 1e-4 * SPEED
    assert log.v.min() > -1.1 * T / M


@pytest.mark.parametrize(("factor", "periods"), [(1.9, 1), (1.9, 3), (1.5, 3), (0.7, 4)])
def test_what_a_wrong_mass_leaves_of_the_speed(factor, periods):
    """(1 - factor)^periods where the friction does not limit; too much mass throws it out."""
    log = run(hl.laws.friction_pulse(OPEN, friction=50.0, mass=factor * M, periods=periods), x=BOUNDARY - 1e-4, duration=0.02)
    left = SPEED * (1 - factor) ** np.arange(periods + 1)
    np.testing.assert_allclose(log.v[entry(log) :][: periods + 1], left, rtol=1e-12)
    assert (log.v.min() < -0.1 * SPEED) == (factor > 1)


@pytest.mark.parametrize(("late", "part"), [(1, 1 / 4), (2, 4 / 27), (3, 27 / 256)])
@pytest.mark.always("2-*")
def test_delayed_friction_stops_with_a_part_of_the_mass_and_swings_with_all(late, part):
    """v(n+1) = v(n) - part v(n-d): its roots meet at d/(d+1) for that part, and lie on the unit circle or beyond for 1."""
    roots = np.roots([1, -1, *[0] * (late - 1), part])
    assert abs(roots).max() == pytest.approx(late / (late + 1), abs=1e-6)
    assert abs(np.roots([1, -1, *[0] * (late - 1), 1])).max() > 1 - 1e-9
    paddle = hl.SimulatedPaddle(m=M, b=0.0, T=T, delay=late * T)
    pulses = [hl.laws.friction_pulse(OPEN, friction=1.1, mass=share * M, periods=90) for share in (part, 1)]
    good, bad = (run(pulse, paddle, duration=0.12, x=BOUNDARY - 1e-3) for pulse in pulses)
    assert good.v.min() > -1e-12 and abs(good.v[-1]) < 1e-6
    assert bad.v.min() < -0.1 * 1.1 * T / M


def test_friction_opposes_either_way():
    """A handle that comes back out of a spring is braked as well, while the pulse lasts."""
    scene = hl.laws.friction_pulse(hl.wall()(k=400, x_o=BOUNDARY), friction=0.4, mass=M, periods=80)
    log = run(scene, hl.SimulatedPaddle(m=M, b=0.05, T=T))
    spring = np.where(log.x >= BOUNDARY, 400 * (log.x - BOUNDARY), 0)
    added = log.F - spring
    assert added.min() < -0.39 and added.max() > 0.39
    assert (added * log.v >= -1e-15).all()


def test_a_pulse_makes_the_same_spring_harder():
    """The aim of it: at one K, a fifth of the penetration and of the rebound, and no chatter where there was none."""
    wall, paddle = hl.wall()(k=500, x_o=BOUNDARY), hl.SimulatedPaddle(m=M, b=0.3, T=T)
    plain = run(wall, paddle)
    braked = run(hl.laws.braking_pulse(wall, part=0.9, mass=M, periods=2), paddle)
    depth = [(log.x - BOUNDARY).max() for log in (plain, braked)]
    assert depth[1] < 0.25 * depth[0]
    assert abs(braked.v.min()) < 0.2 * abs(plain.v.min())


def test_a_speed_that_is_estimated_is_used():
    """With a window of 3 on an encoder of 20 um the speed is known to a count in 3 periods, 7 mm/s."""
    paddle = hl.SimulatedPaddle(m=M, b=0.0, T=T, counts_per_metre=5e4)
    estimate = hl.velocity.window(deviation="20 um", longest=3)
    log = run(hl.laws.braking_pulse(OPEN, part=1, mass=M, entry=hl.laws.Entry(velocity=estimate)), paddle)
    assert abs(log.v_true[-1]) < 20e-6 / (3 * T) + 1e-9


def test_an_estimate_that_the_wall_has_already_is_taken_once():
    estimate = hl.velocity.filtered(tau="1 ms")
    wall = hl.wall("half_sample", velocity=estimate)(k=300, x_o=BOUNDARY)
    assert (
        len(hl.laws.friction_pulse(wall, friction=1, mass=M, periods=3, entry=hl.laws.Entry(velocity=estimate)).eom)
        == len(wall.eom) + 1
    )


SCENES = (
    hl.laws.braking_pulse(hl.wall()(k=400, x_o=BOUNDARY), part=0.8, mass=M, periods=3, force_max=4),
    hl.laws.friction_pulse(hl.wall("ellis")(k=400, x_o=BOUNDARY), friction=1, mass=M, periods=20),
)


@pytest.mark.parametrize("scene", SCENES, ids=lambda scene: scene.name)
def test_the_firmware_core_gives_the_same_bits(scene):
    path = run(scene, hl.SimulatedPaddle(m=M, b=0.1, T=T, hand=hl.Hand(k=200, intent=0.009))).x.astype(np.float32)
    program = hl.compile(scene, T=T)
    there, here = (load(program, engine).run(len(path), path[:, None]).outputs for engine in ("vm", "interpreter"))
    assert there.max() > 1
    np.testing.assert_array_equal(there, here)


@pytest.mark.parametrize("scene", SCENES, ids=lambda scene: scene.name)
def test_pulses_fit_the_uno_at_1_khz(scene):
    assert cost(hl.compile(scene, T=1e-3)).fits


@pytest.mark.parametrize(
    ("make", "error", "words"),
    [
        (lambda: hl.laws.braking_pulse(OPEN), SceneError, "impulse=.*or part="),
        (lambda: hl.laws.braking_pulse(OPEN, impulse=1, part=1, mass=1), SceneError, "impulse=.*or part="),
        (lambda: hl.laws.braking_pulse(OPEN, part=1), SceneError, "and mass="),
        (lambda: hl.laws.braking_pulse(OPEN, impulse="1 N"), UnitsError, "impulse = '1 N'"),
        (lambda: hl.laws.braking_pulse(OPEN, part=-0.1, mass=M), SceneError, "part = -0.1; a pulse needs part > 0"),
        (lambda: hl.laws.braking_pulse(OPEN, part=1.5, mass=M), SceneError, "throws the handle back: needs part <= 1"),
        (lambda: hl.laws.braking_pulse(OPEN, impulse=1, periods=0), SceneError, "whole number of periods, 1 to 1000"),
        (lambda: hl.laws.braking_pulse(OPEN, impulse=1, entry=hl.laws.Entry(velocity="window")), SceneError, "needs an estimate"),
        (lambda: hl.laws.friction_pulse(hl.laws.virtual_damper(), friction=1, mass=M, periods=2), SceneError, "no parameter x_o"),
        (lambda: hl.laws.friction_pulse(OPEN, friction=0, mass=M, periods=2), SceneError, "friction = 0 N"),
    ],
)
def test_what_is_no_pulse_is_refused(make, error, words):
    with pytest.raises(error, match=words):
        make()
