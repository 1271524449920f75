"""The exact wall against mpmath, event by event, and against scipy where it is damped."""

import math

import mpmath as mp
import numpy as np
import pytest
from scipy.integrate import solve_ivp

import hapticlab as hl
from hapticlab.errors import AnalysisError


def crossings_by_mpmath(M, b, k, push, K, x, v, count):
    """Return the first crossings of x = 0, from the closed form of each mode and mpmath's root finder, in 30 digits."""
    with mp.workdps(30):
        M, b, k, push, K = map(mp.mpf, (M, b, k, push, K))
        now, x, v, inside, found = mp.mpf(0), mp.mpf(x), mp.mpf(v), x >= 0, []
        for _ in range(count):
            stiff = k + K * inside
            rest, decay = push / stiff, b / (2 * M)
            w = mp.sqrt(stiff / M - decay**2)
            a, c = x - rest, (v + decay * (x - rest)) / w
            place = lambda t: mp.exp(-decay * t) * (a * mp.cos(w * t) + c * mp.sin(w * t)) + rest  # noqa: B023, E731
            t = mp.mpf("1e-9")
            while place(t) * (1 if inside else -1) > 0:  # a hundredth of a swing at a time
                t += mp.pi / w / 100
            t = mp.findroot(place, (t - mp.pi / w / 100, t), solver="anderson", tol=1e-50)
            x, v = mp.mpf(0), mp.diff(place, t)
            now, inside = now + t, not inside
            found.append((float(now), float(v)))
    return np.array(found)


@pytest.mark.parametrize("b", [0.0, 0.4])
def test_crossings_agree_with_mpmath(b):
    paddle = hl.SimulatedPaddle(m=0.35, b=b, T=0.01, hand=hl.Hand(m=0.006, k=500, intent=0.01))
    motion = hl.laws.hybrid_wall(paddle, K=5000, duration=1.0, x=-0.02, v=0.1)
    expected = crossings_by_mpmath(0.356, b, 500, 5.0, 5000, -0.02, 0.1, 10)
    np.testing.assert_allclose(motion.crossings[:10], expected[:, 0], rtol=0, atol=1e-13)  # s; asked for: 1e-10
    np.testing.assert_allclose(motion.speeds[:10], expected[:, 1], rtol=1e-11)


def test_a_damped_wall_agrees_with_scipy():
    hand = hl.Hand(m=0.02, b=1.0, k=150.0, push=2.0)
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hand)
    motion = hl.laws.hybrid_wall(paddle, K=3000.0, B=1.5, duration=0.15, x=-0.004, v=0.5, x_o=0.003)

    def rate(t, s, inside):
        p = s[0] - 0.003
        return [s[1], (2.0 - 1.1 * s[1] - 150 * s[0] - inside * (3000 * p + 1.5 * s[1])) / 0.07]

    t, state, inside, found = 0.0, [-0.004, 0.5], False, []
    while t < 0.15:
        event = lambda t, s, inside: s[0] - 0.003  # noqa: E731
        event.terminal, event.direction = True, -1 if inside else 1
        run = solve_ivp(rate, (t, 0.15), state, "DOP853", events=event, args=(inside,), rtol=1e-12, atol=1e-14)
        t, state, inside = run.t[-1], run.y[:, -1], not inside
        found += [t] if run.status == 1 else []
    assert len(found) >= 2
    np.testing.assert_allclose(motion.crossings, found, rtol=0, atol=1e-11)
    np.testing.assert_allclose([motion.x[-1], motion.v[-1]], state, rtol=1e-9, atol=1e-12)


def test_without_damping_no_bounce_makes_or_loses_energy():
    paddle = hl.SimulatedPaddle(m=0.35, b=0.0, T=0.01, hand=hl.Hand(m=0.006, k=500, intent=0.01))
    motion = hl.laws.hybrid_wall(paddle, K=5000, duration=5.0, x=-0.02)
    assert len(motion.crossings) > 50
    assert np.ptp(motion.energy) < 1e-13 * 0.225  # 0.5 * 500 * 0.03^2 J, less a constant
    assert "22 times" not in str(motion) and "times into the wall, first at 0.0328" in str(motion)


def test_a_touch_between_two_samples_is_seen():
    """Thrown up against a pull, the handle passes the boundary by 1e-9 m, a few microseconds of a 1 ms period."""
    paddle = hl.SimulatedPaddle(m=0.05, b=0.0, T=1e-3, hand=hl.Hand(push=-0.5))  # 10 m/s^2 back
    speed = math.sqrt(2 * 10 * (1e-3 + 1e-9))
    motion = hl.laws.hybrid_wall(paddle, K=500, duration=0.05, x=-1e-3, v=speed)
    rise = (speed - math.sqrt(speed**2 - 20e-3)) / 10
    assert len(motion.crossings) == 2 and motion.crossings[0] == pytest.approx(rise, rel=1e-9)
    assert math.floor(motion.crossings[0] * 1e3) == math.floor(motion.crossings[1] * 1e3)


@pytest.mark.parametrize(
    ("x", "v", "push", "words"),
    [
        (0.0, 0.1, 0.0, "; 1 time into the wall, it begins inside"),
        (1e-3, 0.0, 0.0, "; 1 time into the wall, it begins inside"),
        (0.0, 0.0, 1.0, "; 1 time into the wall, it begins inside"),
        (0.0, -0.1, 0.0, "; 0 times into the wall\n"),
        (0.0, 0.0, -1.0, "; 0 times into the wall\n"),
        (0.0, 0.0, 0.0, "; 0 times into the wall\n"),
    ],
)
def test_a_start_inside_counts_as_one_time_into_the_wall(x, v, push, words):
    paddle = hl.SimulatedPaddle(m=0.05, b=0.0, T=1e-3, hand=hl.Hand(push=push))
    assert words in str(hl.laws.hybrid_wall(paddle, K=500, duration=0.05, x=x, v=v))


def test_less_than_a_period_is_refused():
    with pytest.raises(AnalysisError, match="needs at least one period"):
        hl.laws.hybrid_wall(hl.SimulatedPaddle(m=0.05, b=0.0, T=1e-3), K=500, duration=1e-4)


def test_it_draws_the_rendered_wall_beside_itself():
    paddle = hl.SimulatedPaddle(m=0.05, b=0.0, T=1e-3)
    motion = hl.laws.hybrid_wall(paddle, K=500, duration=0.05, x=-1e-3, v=0.1)
    log = paddle.run(hl.wall()(k=500), duration=0.05, x=-1e-3, v=0.1, progress=False)
    (axes,) = motion.plot(log).axes
    assert axes.get_xlabel() == "time t [ms]" and axes.get_ylabel() == "handle position x [mm]"
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["the wall itself", "zoh wall"]
    np.testing.assert_allclose(axes.lines[0].get_ydata(), 1e3 * motion.x)
