"""Juggling: the map of impacts by brute force, what a juggler makes of a flight, and whole juggles."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

from hapticlab.base.telemetry import Telemetry
from hapticlab.device.hand.hand import Hand
from hapticlab.device.hand.reacting_hand import Seen
from hapticlab.device.simulated.simulated_paddle import SimulatedPaddle
from hapticlab.errors import AnalysisError, PaddleError
from hapticlab.experiments.arm import Arm
from hapticlab.experiments.juggler import Juggler
from hapticlab.experiments.juggling import bounces, juggle, multipliers

PADDLE = SimulatedPaddle(m=0.05, b=0.1, T=1e-3, force_max=20.0, hand=Hand("grip"))
VALUES = {"m": 0.005, "M": 0.1, "K": 1000.0, "e": 0.8, "g": 9.81, "h": 0.2}
G = 9.81


def flight(state, plate, speed, e):
    """From one launch (time, velocity) off the plate to the next: the impact located, then Newton's restitution."""
    t, v = state

    def above(s):
        return plate(t) + v * s - G * s * s / 2 - plate(t + s)

    s = brentq(above, 0.5 * v / G, 4 * v / G, xtol=1e-15)
    return np.array([t + s, (1 + e) * speed(t + s) - e * (v - G * s)])


@pytest.mark.parametrize(("e", "phase"), [(0.8, 0.7), (0.6, 0.3), (0.7, -0.4)])
def test_multipliers_are_those_of_the_bouncing_ball(e, phase):
    """A plate A sin(w t) struck once a period at the phase: eigenvalues of the map by finite differences."""
    w = 2 * math.pi / 0.4
    v = G * 0.4 / 2
    A = v * (1 - e) / (1 + e) / (w * math.cos(phase))

    def plate(t):
        return A * math.sin(w * t)

    def speed(t):
        return A * w * math.cos(w * t)

    start, h = np.array([phase / w, v]), 1e-6
    np.testing.assert_allclose(flight(start, plate, speed, e) - start, [0.4, 0.0], atol=1e-12)
    jacobian = np.array([
        (flight(start + d, plate, speed, e) - flight(start - d, plate, speed, e)) / (2 * h) for d in h * np.eye(2)
    ]).T  # fmt: skip
    expected = multipliers(-A * w * w * math.sin(phase), e=e)
    for found in np.linalg.eigvals(jacobian):
        assert min(abs(found - expected)) < 1e-6


def test_stable_without_looking_where_schaal_sternad_and_atkeson_say():
    e = 0.75
    bound = -2 * G * (1 + e * e) / (1 + e) ** 2
    assert abs(multipliers(bound, e=e)).max() == pytest.approx(1.0)
    assert abs(multipliers(0.0, e=e)).max() == pytest.approx(1.0)
    assert abs(multipliers(0.9 * bound, e=e)).max() < 1 < abs(multipliers(1.1 * bound, e=e)).max()


def test_a_light_plate_gives_like_less_restitution():
    """Two free bodies: momentum is kept, and they part e times as fast as they met."""
    m, M, e, ball, plate = 0.005, 0.1, 0.8, -2.0, 0.3
    after = (m * ball + M * plate + M * e * (plate - ball)) / (m + M)
    same = (1 + e) * M / (m + M) - 1
    assert (1 + same) * plate - same * ball == pytest.approx(after)
    assert multipliers(-3.0, e=e, m=m, M=M) == pytest.approx(multipliers(-3.0, e=same))


def test_bounces_of_a_made_flight():
    t = np.arange(1000) * 1e-3
    y = 0.2 - G * ((t + 0.2) % 0.4 - 0.2) ** 2 / 2  # touches at 0.2, 0.6 s
    log = Telemetry(t=t, x=0 * t, v=0 * t, F=0 * t, T=1e-3, channels={"y": y})
    times, heights = bounces(log)
    assert times == pytest.approx([0.2, 0.6], abs=1.1e-3)
    assert heights == pytest.approx([G * 0.2**2 / 2], rel=0.02)


def juggler(senses, vision=1e-7, touch=1e-9):
    return Juggler(senses, 0.2, VALUES, Arm(m=0.25, b=0.1, b_hand=5.0, k=500.0), vision, touch, -5.0, 0)


def test_sight_finds_the_flight_and_the_next_impact():
    t = np.arange(450) * 1e-3
    fall = math.sqrt(2 * 0.2 / G)
    launch = 1.7
    y = np.where(t < fall, 0.2 - G * t**2 / 2, launch * (t - fall) - G * (t - fall) ** 2 / 2)
    seen = Seen({"t": t, "y": y, "x": 0 * t, "v": 0 * t, "F": 0 * t})
    sees = juggler("vision")
    sees._aim(*sees._look(seen))
    assert sees.hit == pytest.approx(fall + 2 * launch / G, abs=1e-6)
    kappa = 1.8 * 0.1 / 0.105
    aimed = math.sqrt(2 * G * 0.2)
    assert sees.goal[1] == pytest.approx((aimed - (1 - kappa) * -launch) / kappa, abs=1e-5)  # strikes to the aimed height


def test_blurred_sights_are_weighed_by_least_squares():
    """Place and velocity at launch against numpy's least squares of the same sights and expectation."""
    t = np.arange(400) * 1e-3
    y = np.where(t < 0.1, 0.05 - G * t**2 / 2, 1.9 * (t - 0.1) - G * (t - 0.1) ** 2 / 2)
    seen = Seen({"t": t, "y": y, "x": 0 * t, "v": 0 * t, "F": 0 * t})
    sees = juggler("vision", vision=0.02)
    begun, place, velocity = sees._look(seen)
    frames = np.arange(math.ceil(begun * 60), int(t[-1] * 60) + 1)
    at = np.round(frames / 60 / 1e-3).astype(int)
    since = t[at] - begun
    sights = y[at] + 0.02 * sees.sight_noise[frames] + G * since**2 / 2
    aimed = math.sqrt(2 * G * 0.2)
    rows = np.vstack([np.column_stack([np.ones_like(since), since]) / 0.02, [1 / 0.05, 0], [0, 1 / (0.1 * aimed)]])
    expected = np.linalg.lstsq(rows, np.r_[sights / 0.02, 0.0, 1 / 0.1], rcond=None)[0]
    assert (place, velocity) == pytest.approx(expected, rel=1e-9)


def test_a_felt_impulse_tells_the_launch():
    pytest.importorskip("llvmlite", reason="a plate that is struck, at a kilohertz")
    log = juggle(PADDLE, senses="none", duration=2.2).log
    seen = Seen({name: getattr(log, name) for name in ("t", "x", "v", "F", "y")})
    feels = juggler("touch")
    low = np.flatnonzero((log.y[1:-1] < log.y[:-2]) & (log.y[1:-1] <= log.y[2:])) + 1
    for begun in low[1:5]:
        (_, place, _), (_, launch, _) = feels._felt(seen, int(begun), 0)
        true = (log.y[begun + 4] - log.y[begun + 2]) / 2e-3 + G * 3e-3
        assert launch == pytest.approx(true, rel=0.06)  # 1.5 N at its peak, held for a period: up to 7 % of the impulse
        assert place == pytest.approx(log.y[begun], abs=2e-3)


def test_a_stroke_that_slows_keeps_the_ball_without_looking():
    pytest.importorskip("llvmlite", reason="six seconds at a kilohertz")
    found = juggle(PADDLE, senses="none", duration=4.0)
    assert len(found.impacts) == pytest.approx(4.0 / (2 * math.sqrt(2 * 0.2 / G)), abs=1)
    assert found.error < 0.03 and found.irregularity < 0.02
    lower = juggle(PADDLE, senses="none", duration=3.0, h=0.26)  # let fall from 30 % too high, which it does not know
    assert lower.heights[-1] == pytest.approx(0.2, rel=0.05)


def test_an_unstable_impact_is_left_for_the_stable_one_of_the_same_stroke():
    """Strokes that speed up at impact, eyes and hands shut: the plate is struck later, where it slows down."""
    pytest.importorskip("llvmlite", reason="six seconds at a kilohertz")
    found = juggle(PADDLE, senses="none", duration=6.0, acceleration=2.0)
    at, z = np.round(found.impacts / 1e-3).astype(int), found.log.z
    plate = [2 * np.polyfit(1e-3 * np.arange(-11, 0), z[k - 12 : k - 1], 2)[0] for k in (at[0], *at[-3:])]
    planned = math.sqrt(2 * 0.2 / G) * (1 + 2 * np.arange(len(at)))
    assert plate[0] > 0 and abs(multipliers(plate[0], e=0.8, m=0.005, M=0.1)).max() > 1
    assert max(plate[1:]) < 0 and abs(multipliers(plate[-1], e=0.8, m=0.005, M=0.1)).max() < 1
    assert found.impacts[-1] - planned[-1] == pytest.approx(0.038, abs=0.005) and found.irregularity < 0.02


def test_a_juggler_who_sees_and_feels():
    pytest.importorskip("llvmlite", reason="ten seconds at a kilohertz")
    both = juggle(PADDLE, senses="both", duration=3.0, seed=1)
    seen = juggle(PADDLE, senses="vision", duration=3.0, seed=1)
    assert both.error < 0.2 and seen.error < 0.2 and "impacts" in str(both)
    assert np.any(both.log.F != 0) and not np.any(seen.log.F)  # with the eyes alone the motor is off
    assert [a.get_ylabel() for a in both.plot().axes] == ["height [mm]"]
    assert juggle(PADDLE, senses="vision", duration=1.5, seed=2).heights != pytest.approx(seen.heights[:2])


def test_who_cannot_juggle_is_told():
    with pytest.raises(PaddleError, match="juggle needs a hand that holds the handle"):
        juggle(replace(PADDLE, hand=None))
    with pytest.raises(AnalysisError, match="vision, touch, both, none"):
        juggle(PADDLE, senses="smell")
    with pytest.raises(AnalysisError, match="height"):
        juggle(PADDLE, height=-0.1)
