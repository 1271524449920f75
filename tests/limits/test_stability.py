"""Stability limits against closed forms, and against matrix exponentials in 30 digits with the loop built another way."""

import math
from types import SimpleNamespace

import mpmath as mp
import numpy as np
import pytest

import hapticlab as hl
from hapticlab import n, parameters, x
from hapticlab.errors import AnalysisError, PaddleError
from hapticlab.limits.passivity import passivity_limit
from hapticlab.limits.stability import closed_loop_matrix, closed_loop_poles, damper_limit, stability_limit
from hapticlab.scene.laws.taps import LEAD, TAPS


def paddle(m=0.045, b=0.12, T=0.8e-3, delay=0.0, hand=None):
    return hl.Device(m=m, b=b, T=T, delay=delay, hand=hand, velocity="measured")


def hand(m=0.02, b=1.1, k=210.0):
    return SimpleNamespace(m=m, b=b, k=k)


def gains(m, b, T):
    """The exact map of a free handle: a, and the two numerators g0, g1 of its position, in 40 digits."""
    with mp.workdps(40):
        delta, tau = mp.mpf(b) * T / m, mp.mpf(m) / b
        a = mp.e**-delta
        return a, (tau * (1 - a) - a * T) / b, (T - tau * (1 - a)) / b


DAMPINGS = [1e-3, 0.12, 4.0, 56.25, 600.0]  # b T/m from 2e-5 to 11


@pytest.mark.parametrize("b", DAMPINGS)
def test_plain_wall(b):
    a, g0, g1 = gains(0.045, b, 0.8e-3)
    expected = (1 - a) / g0
    if g1 > g0:
        expected = min(expected, 2 * (1 + a) / (g1 - g0))
    assert stability_limit(paddle(b=b)).K == pytest.approx(float(expected), rel=1e-9)


@pytest.mark.parametrize("b", DAMPINGS)
def test_half_sample_flips_at_nyquist(b):
    a, _, _ = gains(0.045, b, 0.8e-3)
    tau = 0.045 / mp.mpf(b)
    limit = stability_limit(paddle(b=b), law="half_sample")
    assert limit.K == pytest.approx(float(b * (1 + a) / (0.8e-3 - tau * (1 - a))), rel=1e-9)
    assert limit.frequency == pytest.approx(625.0, rel=1e-12)


@pytest.mark.parametrize("b", DAMPINGS)
def test_backward_difference(b):
    a, g0, g1 = gains(0.045, b, 0.8e-3)
    q2, q1, q0 = g0**2 / 4 + 3 * g0 * g1 / 4, 3 * g0 / 2 - g1 / 2 - g0 * (1 + a) / 2, -(1 - a)
    expected = (-q1 + mp.sqrt(q1**2 - 4 * q2 * q0)) / (2 * q2)
    if g1 > g0:
        expected = min(expected, (1 + a) / (g1 - g0))
    assert stability_limit(paddle(b=b), law="backward_difference").K == pytest.approx(float(expected), rel=1e-9)


def test_without_damping():
    free = paddle(b=0.0)
    half, ellis = (stability_limit(free, law=law) for law in ("half_sample", "ellis"))
    assert half.K == pytest.approx(4 * 0.045 / 0.8e-3**2, rel=1e-12)
    assert ellis.K == pytest.approx(4 * 0.045 / (3 * 0.8e-3**2), rel=1e-12)
    assert ellis.frequency == pytest.approx(1250 / 4, rel=1e-9)  # exactly a quarter of the sampling rate
    for law in ("zoh", "backward_difference"):
        none = stability_limit(free, law=law)
        assert none.K == 0 and "without damping" in none.reason


def test_braked_feather():
    """Where the damping swamps the mass the limits are the passivity limits; b T = m gives half_sample 1 + e."""
    for law, ratio in (("zoh", 2), ("half_sample", 1), ("backward_difference", 1), ("ellis", 1 / 2)):
        limit = stability_limit(paddle(m=1e-12, b=1.0, T=1e-3), law=law)
        assert limit.K * 1e-3 == pytest.approx(ratio, rel=1e-7)  # 1 + m/(b T) = 1 + 1e-9 is left out
    one = stability_limit(paddle(m=0.05, b=50.0, T=1e-3), law="half_sample")
    assert one.K * 1e-3 / 50 == pytest.approx(1 + math.e, rel=1e-12)


def test_virtual_damper_edge():
    """b = 0: the plain wall is saved by B up to 2 m/T, and by none from there on."""
    edge = 2 * 0.045 / 0.8e-3
    assert stability_limit(paddle(b=0.0), B=edge * 0.999).K > 0
    beyond = stability_limit(paddle(b=0.0), B=edge * 1.001)
    assert beyond.K == 0 and "B = " in beyond.reason
    assert stability_limit(paddle(), B=-0.121).K == 0
    assert stability_limit(paddle(), B=-0.119).K > 0


@pytest.mark.parametrize("delay", [0.0, 0.3e-3, 0.8e-3])
@pytest.mark.parametrize("grip", [None, hand()])
def test_backward_difference_is_the_plain_wall_with_a_damper(delay, grip):
    """K (1.5 x[n] - 0.5 x[n-1]) = K x[n] + (K T/2) (x[n] - x[n-1])/T."""
    p = paddle(delay=delay, hand=grip)
    predicted = stability_limit(p, law="backward_difference")
    damped = stability_limit(p, law="zoh", B=predicted.K * p.T / 2)
    assert damped.K == pytest.approx(predicted.K, rel=1e-9)
    assert damped.frequency == pytest.approx(predicted.frequency, rel=1e-7)
    ours = closed_loop_poles(p, K=321.0, law="backward_difference")
    theirs = closed_loop_poles(p, K=321.0, B=321.0 * p.T / 2)
    np.testing.assert_allclose(ours, theirs, atol=1e-11)


def marching_loop(p, law, B, K):
    """Column by column: march the plant by 30-digit matrix exponentials from every unit state."""
    M = p.m + (p.hand.m if p.hand else 0)
    b = p.b + (p.hand.b if p.hand else 0)
    k = p.hand.k if p.hand else 0
    depth, ages = int(p.delay // p.T) + 1, 2  # forces and samples remembered
    change = mp.mpf(p.delay) - (depth - 1) * mp.mpf(p.T)

    def flow(h):
        rate = mp.matrix([[0, 1, 0], [-mp.mpf(k) / M, -mp.mpf(b) / M, -mp.mpf(1) / M], [0, 0, 0]])
        return mp.expm(rate * h)

    first, second = flow(change), flow(mp.mpf(p.T) - change)
    n = 2 + depth + ages
    columns = []
    for j in range(n):
        state = [mp.mpf(int(i == j)) for i in range(n)]
        x, v, old, past = state[0], state[1], state[2 : 2 + depth], state[2 + depth :]
        samples = [x, *past]
        force = K * sum(c * s for c, s in zip(TAPS[law], samples, strict=False)) + K * LEAD[law] * p.T * v
        force += B * (x - past[0]) / p.T
        forces = [force, *old]
        x, v, _ = first * mp.matrix([x, v, forces[depth]])
        x, v, _ = second * mp.matrix([x, v, forces[depth - 1]])
        columns.append([x, v, *forces[:depth], *samples[:ages]])
    return mp.matrix(columns).T


CASES = [
    ("zoh", 0.0, 0.0, hand()),
    ("ellis", 0.0, 0.0, hand(0.1, 5.0, 500.0)),
    ("backward_difference", 0.3, 0.8e-3, hand()),
    ("half_sample", -0.05, 0.3e-3, None),
    ("ellis", 0.0, 1.5 * 0.8e-3, hand()),
    ("zoh", 0.4, 2.25 * 0.8e-3, None),
]


@pytest.mark.parametrize("law, B, delay, grip", CASES)
@pytest.mark.always("zoh-*", "half_sample-*", "backward_difference-*", "ellis-0.0-0.0012*")
def test_limit_against_thirty_digits(law, B, delay, grip):
    p = paddle(delay=delay, hand=grip)
    limit = stability_limit(p, law=law, B=B)
    with mp.workdps(30):
        radius = [
            max(abs(z) for z in mp.eig(marching_loop(p, law, B, limit.K * s), left=False, right=False))
            for s in (1 - mp.mpf("1e-9"), 1 + mp.mpf("1e-9"))
        ]
        assert radius[0] < 1 < radius[1]
    for s in np.geomspace(1e-3, 0.999, 25):  # and nothing is lost before
        assert abs(closed_loop_poles(p, K=limit.K * s, law=law, B=B)[0]) < 1
    pole = closed_loop_poles(p, K=limit.K, law=law, B=B)[0]
    assert abs(np.angle(pole)) / (2 * np.pi * p.T) == pytest.approx(limit.frequency, rel=1e-6)


@pytest.mark.parametrize("law, B, delay, grip", CASES)
def test_closed_loop_matrix_marches_the_plant(law, B, delay, grip):
    p = paddle(delay=delay, hand=grip)
    ours = closed_loop_poles(p, K=777.0, law=law, B=B)
    march = mp.eig(marching_loop(p, law, B, 777.0), left=False, right=False)
    theirs = sorted((abs(complex(z)) for z in march), reverse=True)
    np.testing.assert_allclose(abs(ours), theirs[: len(ours)], atol=1e-6)  # multiple poles near 0 spread by rounding


def test_a_long_delay_is_the_small_frequency_limit():
    """Slow loop: K about (b + B)/(T/2 + delay) where mass and bandwidth leave it (Gil et al.)."""
    p = paddle(m=2.0, b=0.05, delay=20 * 0.8e-3)
    assert stability_limit(p).K == pytest.approx(0.05 / (20.5 * 0.8e-3), rel=2e-2)


def test_matrix_shape_and_units():
    assert closed_loop_matrix(paddle(), K=100.0).shape == (2, 2)
    assert closed_loop_matrix(paddle(delay=1.2e-3), K=100.0, law="ellis").shape == (2 + 2 + 2, 2 + 2 + 2)
    step = closed_loop_matrix(paddle(b=0.0), K=100.0)
    T, m = 0.8e-3, 0.045
    expected = [[1 - 100 * T**2 / (2 * m), T], [-100 * T / m, 1]]
    np.testing.assert_allclose(step, expected, rtol=1e-12)


def test_what_is_ignored_is_said():
    limit = stability_limit(paddle())
    assert "encoder" in str(limit) and "Coulomb" in str(limit) and "N/m" in str(limit) and "Hz" in str(limit)
    assert float(limit) == limit.K


@pytest.mark.parametrize(
    "change, words",
    [
        ({"m": 0.0}, "m = 0 kg"),
        ({"b": -1.0}, "b = -1 N s/m"),
        ({"T": 0.0}, "T = 0 s"),
        ({"delay": math.nan}, "delay = nan s"),
        ({"hand": hand(k=-3.0)}, "hand k = -3 N/m"),
    ],
)
def test_bad_plants_are_refused(change, words):
    with pytest.raises((AnalysisError, PaddleError), match=words.replace(".", r"\.")):
        stability_limit(paddle(**change))


def test_bad_laws_and_keywords_are_refused():
    with pytest.raises(AnalysisError, match="law = 'foh'"):
        stability_limit(paddle(), law="foh")
    with pytest.raises(AnalysisError, match="K = nan N/m"):
        closed_loop_matrix(paddle(), K=math.nan)
    with pytest.raises(TypeError, match="lawe"):
        stability_limit(paddle(), lawe="zoh")


def test_what_is_passive_is_stable():
    """The two limits come from different mathematics; passivity in any hand must not exceed stability in this one."""
    rng = np.random.default_rng(3)
    for _ in range(60):
        T, delta = 10 ** rng.uniform(-4, -2), 10 ** rng.uniform(-4, 1)
        m = 10 ** rng.uniform(-3, 0)
        b = delta * m / T
        delay = rng.choice([0.0, T, rng.uniform(0, 3) * T, rng.integers(0, 30) * T])
        grip = rng.choice([None, hand(m=rng.uniform(0, 2) * m, b=rng.uniform(0, 3) * b, k=rng.uniform(0, 1) * m / T**2)])
        law, B = rng.choice(["zoh", "backward_difference", "ellis"]), rng.choice([0.0, rng.uniform(-0.9, 0.9) * b])
        passive = passivity_limit(hl.Device(b=b, T=T, delay=delay), B=B, law=law).K
        stable = stability_limit(paddle(m=m, b=b, T=T, delay=delay, hand=grip), law=law, B=B).K
        assert 0 < passive <= stable * (1 + 1e-9)


@pytest.mark.parametrize("hand", [None, SimpleNamespace(m=0.02, b=1.0, k=200.0)])
def test_half_sample_with_an_estimated_velocity_is_the_backward_difference(hand):
    """Eq. (23.3) with the estimate is Eq. (23.5); the exact velocity would promise 45 times more."""
    plant = {"m": 0.05, "b": 0.1, "T": 1e-3, "delay": 0.0, "hand": hand}
    estimated, measured = (hl.Device(**plant, velocity=name) for name in ("backward_difference", "measured"))
    limit = stability_limit(estimated, law="half_sample")
    assert limit.K == stability_limit(measured, law="backward_difference").K
    assert limit.K < 0.5 * stability_limit(measured, law="half_sample").K
    assert any("backward difference" in note for note in limit.assumptions)


@pytest.mark.parametrize("m, b, T", [(0.05, 0.3, 1e-3), (0.002, 3.0, 1e-3), (0.01, 1e-7, 2e-3), (1e-4, 5.0, 1e-3)])
def test_the_largest_damper_by_a_closed_form_without_delay(m, b, T):
    """z^2 - (a - g1 B/T) z + g0 B/T inside the unit circle, with the constants of the held plant."""
    a, tau = math.exp(-b * T / m), m / b
    if b > 1e-3:
        g0, g1 = (tau * (1 - a) - a * T) / b, (T - tau * (1 - a)) / b
    else:
        g0 = g1 = T**2 / (2 * m)
    edges = [T / g0] + ([T * (1 + a) / (g1 - g0)] if g1 > g0 else [])
    assert damper_limit(hl.Device(m=m, b=b, T=T)) == pytest.approx(min(edges), rel=1e-9 if b > 1e-3 else 1e-7)


def test_without_device_damping_the_largest_damper_is_two_masses_a_period():
    assert damper_limit(hl.Device(m=0.03, b=0, T=2e-3)) == pytest.approx(2 * 0.03 / 2e-3, rel=1e-12)


def test_the_largest_damper_after_a_sample_of_delay_by_a_cubic():
    """b = 0: z^3 - z^2 + g z + g, g = B T/(2 m), has a pair on the unit circle where 1 - g^2 = |g + g| (Schur and Cohn)."""
    g = math.sqrt(2) - 1
    assert damper_limit(hl.Device(m=0.05, b=0, T=1e-3, delay=1e-3)) == pytest.approx(g * 2 * 0.05 / 1e-3, rel=1e-9)


@pytest.mark.parametrize("delay", [0.0, 3e-4, 1e-3, 2.6e-3])
def test_a_handle_rings_just_beyond_the_largest_damper_and_settles_just_below(delay):
    B = parameters("B", units="N*s/m")
    scene = hl.Scene(force=B * (x(n) - x(n - 1)) / hl.T)
    handle = hl.SimulatedPaddle(m=0.05, b=0.2, T=1e-3, delay=delay)
    limit = damper_limit(hl.Device(m=0.05, b=0.2, T=1e-3, delay=delay))

    def grown(B):
        log = handle.run(scene(B=B), duration=1.5, v=0.1, progress=False, dtype="float64")
        return np.abs(log.v[-100:]).max() / np.abs(log.v[600:700]).max()

    assert grown(1.01 * limit) > 1.5
    assert grown(0.99 * limit) < 0.7
