"""The handle, stepped, is the plant that the linked program runs."""

import numpy as np
import pytest

from hapticlab.device.hand.hand import Hand
from hapticlab.device.simulated.moved_handle import BLOCK, Handle
from hapticlab.device.simulated.simulated_paddle import SimulatedPaddle

SWAY = Hand(m=0.02, b=1.0, k=200.0, push=0.5, intent=lambda t: 0.004 * np.sin(20 * t))
BASE = dict(m=0.05, b=0.1, T=1e-3)
PADDLES = {
    "bare": {},
    "pushed": dict(hand=Hand(push=0.2)),
    "late by a fraction": dict(delay=4e-4, hand=Hand(push=0.2)),
    "late by a sample": dict(delay=1e-3, hand=Hand(k=100.0, intent=0.002)),
    "late by 2.3 samples": dict(delay=2.3e-3, hand=SWAY),
    "friction": dict(coulomb=0.05, hand=SWAY),
    "friction and late": dict(coulomb=0.05, delay=1.3e-3, hand=Hand(push=0.3, k=50.0, b=0.5)),
    "moving": dict(hand=SWAY),
    "noisy": dict(noise=1e-5, hand=Hand(k=100.0, b=1.0, intent=0.002, push_noise=0.05), seed=4),
    "encoder": dict(counts_per_metre=2e4, rounding="nearest", hand=SWAY, noise=2e-5, seed=7),
    "sensor late by a fraction": dict(sensor_delay=3e-4, delay=4e-4, hand=SWAY),
    "sensor late by 1.8 samples, friction": dict(sensor_delay=1.8e-3, delay=3e-4, coulomb=0.05, counts_per_metre=2e4, hand=SWAY),
    "limited": dict(force_max=0.3, hand=SWAY, counts_per_metre=5e4),
}


@pytest.mark.parametrize("name", PADDLES)
@pytest.mark.parametrize("start", [(0.003, -0.05)])
@pytest.mark.always(*(f"start0-{name}" for name in PADDLES if "1.8 samples" not in name and name != "friction"))
def test_it_moves_as_the_linked_program_does(spring, name, start):
    """1050 samples, beyond the first block of noise; 1e-12 leaves room for another order of sums."""
    paddle = SimulatedPaddle(**BASE | PADDLES[name])
    program = spring(40.0, velocity=paddle.velocity)
    log = paddle.run(program, duration=(BLOCK + 26) * paddle.T, x=start[0], v=start[1])
    truth = getattr(log, "x_true", log.x) if "x_true" in log.channels else log.x
    speed = log.channels.get("v_true", log.v)
    handle = Handle(paddle, *start)
    for k, F in enumerate(log.F):
        assert handle.x == pytest.approx(truth[k], abs=1e-12), k
        assert handle.v == pytest.approx(speed[k], abs=1e-10), k
        counts = handle.counts()
        if counts is not None:
            assert counts / paddle.counts_per_metre == pytest.approx(log.x[k], abs=1e-15), k
        elif paddle.noise:
            assert handle.seen == pytest.approx(log.x[k], abs=1e-15)
        handle.step(F)
    assert handle.steps == len(log) and handle.t == pytest.approx(len(log) * paddle.T)
    assert np.ptp(truth) > 1e-4 or name == "bare"  # it moved


def test_another_period_goes_on_from_the_same_place():
    """An intent that moves evenly is followed exactly at every period."""
    hand = Hand(m=0.02, b=1.0, k=200.0, intent=lambda t: 0.01 * t)
    slow, fast = (SimulatedPaddle(m=0.05, b=0.1, T=T, hand=hand) for T in (1e-3, 5e-4))
    handle, reference = Handle(slow, x=0.001), Handle(fast, x=0.001)
    for _ in range(500):
        handle.step(0.0)
    handle = handle.with_period(5e-4)
    assert handle.t == pytest.approx(0.5, abs=1e-12) and handle.paddle.T == 5e-4
    for _ in range(1000):
        handle.step(0.0)
    for _ in range(2000):
        reference.step(0.0)
    assert handle.x == pytest.approx(reference.x, abs=1e-12) and handle.v == pytest.approx(reference.v, abs=1e-12)


def test_without_an_encoder_there_are_no_counts_and_rounding_is_the_paddles():
    assert Handle(SimulatedPaddle(**BASE)).counts() is None
    places = {"floor": (-1, 0, 0, 1), "nearest": (0, 0, 1, 1)}
    for rounding, counts in places.items():
        paddle = SimulatedPaddle(**BASE, counts_per_metre=1000.0, rounding=rounding)
        assert tuple(Handle(paddle, x).counts() for x in (-0.0004, 0.0004, 0.0006, 0.0014)) == counts
