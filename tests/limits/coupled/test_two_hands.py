"""Limits of two coupled handles against the loop written out, against its modes, and against runs of two paddles."""

import numpy as np
import pytest
from scipy.linalg import expm

import hapticlab as hl
from hapticlab.limits.linear_law import LinearLaw

T = 1e-3
ARCHITECTURES = ("position-position", "position-force", "wave")


def device(m=0.05, b=0.5, hand=None, velocity="measured", delay=0.0):
    return hl.Device(m=m, b=b, T=T, hand=hand, velocity=velocity, delay=delay)


def growth(handles, ticks, architecture, k=0.0, b=0.0, cutoff=50.0):
    """Largest |pole| of the loop, one tick written out on positions, velocities and all that is remembered of them."""
    steps = []
    for m, damping in handles:
        E = expm(T * np.array([[0, 1, 0], [0, -damping / m, 1 / m], [0, 0, 0]]))
        steps.append((E[:2, :2], E[:2, 2]))
    gain, deep = 2 * np.pi * cutoff * T, 2 * ticks

    def tick(state):
        now, before = state[:4].reshape(2, 2), state[4:].reshape(deep, 2, 3)  # of each handle: x, v, wave that was used
        row, after = np.zeros((2, 3)), np.zeros((2, 2))
        row[:, :2] = now
        for i in range(2):
            own, far, echo = now[i], before[ticks - 1, 1 - i], before[deep - 1, i]
            if architecture == "wave":
                row[i, 2] = (before[0, i, 2] + gain * (2 * far[1] - far[2])) / (1 + gain)
                F = b * (own[1] - row[i, 2])
            else:
                first = echo if architecture == "position-force" and i == 0 else own
                F = k * (first[0] - far[0]) + b * (first[1] - far[1])
            after[i] = steps[i][0] @ own - steps[i][1] * F
        return np.r_[after.ravel(), row.ravel(), before[:-1].ravel()]

    return abs(np.linalg.eigvals(np.array([tick(e) for e in np.eye(4 + 6 * deep)]).T)).max()


@pytest.mark.parametrize("ticks", [1, 6])
@pytest.mark.parametrize("architecture", ARCHITECTURES)
def test_a_pole_of_the_loop_written_out_leaves_the_circle_there(architecture, ticks):
    handles = [(0.05, 0.5), (0.12, 0.3)]
    pair, delay = [device(*one) for one in handles], ticks * T
    if architecture == "wave":
        limit = hl.stability.wave_impedance_limit(*pair, delay=delay)
        below, above = (growth(handles, ticks, architecture, b=part * limit) for part in (0.9999, 1.0001))
    else:
        limit = hl.stability.coupling_limit(*pair, architecture=architecture, delay=delay, b=0.2).K
        below, above = (growth(handles, ticks, architecture, part * limit, 0.2) for part in (0.9999, 1.0001))
    assert below < 1 + 1e-9 < 1 + 1e-7 < above


@pytest.mark.always("hand1-9")
@pytest.mark.parametrize("ticks", [1, 9, 50])
@pytest.mark.parametrize("hand", [None, hl.Hand("pinch")])
def test_like_handles_have_the_limits_of_their_two_motions_together_and_against_each_other(hand, ticks):
    """With y = x_1 -+ x_2 each is one handle on the law k (y[n] +- y[n-d]), which has limits of its own; with a late motor."""
    like = device(hand=hand, velocity="backward_difference", delay=0.4 * T)
    limits = []
    for sign in (1, -1):
        taps = np.eye(1, ticks + 1)[0] + sign * np.eye(1, ticks + 1, ticks)[0]
        limits.append(hl.stability_limit(like, law=lambda K, taps=taps: LinearLaw.of_taps(K * taps, T=T)))
    least = min(limits, key=float)
    found = hl.stability.coupling_limit(like, like, delay=ticks * T)
    assert found.K == pytest.approx(least.K, rel=1e-9) and found.frequency == pytest.approx(least.frequency, rel=1e-7)


@pytest.mark.always("*-0.05-*")
@pytest.mark.parametrize(
    "architecture, beyond, seconds", [(ARCHITECTURES[0], 0.05, 0.9), (ARCHITECTURES[0], 0.01, 2.5), (ARCHITECTURES[1], 0.01, 2.5)]
)
def test_two_simulated_paddles_oscillate_longer_and_longer_just_beyond_it(architecture, beyond, seconds):
    paddle = hl.SimulatedPaddle(m=0.05, b=0.5, T=T)
    limit = hl.stability.coupling_limit(paddle, paddle, architecture=architecture, delay="10 ms")
    at_once = hl.laws.Engagement(ramp=T, jump=1.0, travel=1.0)
    scenes = [hl.laws.bilateral_coupling(architecture, role=role, engagement=at_once) for role in ("leader", "follower")]

    def grows(part):
        pair = hl.devices.TwoPaddles(paddle, paddle, *(scene(k=part * limit.K) for scene in scenes), delay="10 ms")
        run = pair.run(seconds, x=(1e-3, -1e-3))
        apart, period = run.left.x - run.right.x, round(1 / (limit.frequency * T))
        early, late = (np.ptp(apart[first : first + 2 * period]) for first in (400, len(apart) - 2 * period))
        return late / early

    assert grows(1 - beyond) < 0.97 < 1.03 < grows(1 + beyond)


def test_what_every_pair_of_hands_allows_is_what_heavy_hands_allow():
    """(b + 2 b_c)/(delay + T) by slow motion; a heavy handle is slow, and its own limit comes down to it."""
    heavy = hl.Device(m=100.0, b=0.5, T=T)
    for b_c in (0.0, 0.1):
        every = hl.passivity.coupling_any_hand(heavy, heavy, delay="9 ms", b=b_c)
        assert every.any_hand and every.K == pytest.approx((0.5 + 2 * b_c) / 10e-3, rel=1e-4)
        assert every.K == pytest.approx(hl.stability.coupling_limit(heavy, heavy, delay="9 ms", b=b_c).K, rel=1e-3)


def test_without_damping_no_stiffness_is_stable_in_every_pair():
    bare = hl.Device(b=0.0, T=T)
    assert hl.passivity.coupling_any_hand(bare, bare, delay="5 ms").K == 0


@pytest.mark.wide
@pytest.mark.parametrize("architecture", ARCHITECTURES)
def test_no_pair_of_passive_hands_is_unstable_where_it_says_so(architecture):
    """Masses and dampers drawn, one of the two with a spring; light and heavy ones on either side."""
    bare = hl.Device(b=0.3, T=T)
    draw = np.random.default_rng(5)
    if architecture == "wave":
        assert hl.passivity.coupled_paddles(bare, bare, architecture=architecture, b=0.05, delay="5 ms").absolutely_stable
        assert not hl.passivity.coupled_paddles(bare, bare, architecture=architecture, b=0.31, delay="5 ms").absolutely_stable
    else:
        every = hl.passivity.coupling_any_hand(bare, bare, architecture=architecture, delay="5 ms", b=0.05).K
    for _ in range(10):
        hands = [
            hl.Hand(m=m, b=b, k=k) for m, b, k in zip(10 ** draw.uniform(-2, 2, 2), draw.uniform(0, 1, 2), [0, 500], strict=True)
        ]
        pair = [hl.Device(m=1e-3, b=0.3, T=T, hand=hand) for hand in draw.permutation(np.array(hands, dtype=object))]
        if architecture == "wave":
            assert hl.stability.wave_impedance_limit(*pair, delay="5 ms") > 0.05
        else:
            assert hl.stability.coupling_limit(*pair, architecture=architecture, delay="5 ms", b=0.05).K > every


def test_what_cannot_be_is_refused():
    handle = device()
    with pytest.raises(hl.errors.AnalysisError, match="the same T"):
        hl.stability.coupling_limit(handle, hl.Device(m=0.05, b=0.5, T=2 * T))
    with pytest.raises(hl.errors.AnalysisError, match="at most 200"):
        hl.stability.coupling_limit(handle, handle, delay=1.0)
    with pytest.raises(hl.errors.AnalysisError, match="not passive"):
        hl.passivity.coupled_paddles(handle, handle, architecture="wave", k=5, b=0.1)
