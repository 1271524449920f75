"""The real image in its emulator, closed around a simulated paddle: every bit as the PC's program, nothing lost."""

import numpy as np
import pytest
from emulated import emulated_uno
from emulator import missing
from five_scenes import cart_pole, double_pendulum, mass_and_wall, pendulum, wall

import hapticlab as hl
from hapticlab.compiler.engines.engine import load
from hapticlab.device.board.settings import nominal
from hapticlab.device.paddle import Paddle

pytestmark = pytest.mark.skipif(missing() is not None, reason=str(missing()))
# a hand that moves the handle over 8 mm and lets it swing; the scenes' periods are those that an Uno has time for, and
# its memory holds the double pendulum with one evaluation a step, not with four
HAND = hl.Hand(m=0.05, b=3, k=400, intent=lambda t: 0.004 * np.sin(9 * t) + 0.003 * np.sin(31 * t))
SCENES = {wall: 1e-3, mass_and_wall: 1.25e-3, cart_pole: 2e-3, pendulum: 2e-3, double_pendulum: 4e-3}
METHODS = {double_pendulum: "semi_implicit_euler"}


def run(make, ticks, T):
    scene, options = make()
    options = options | ({"method": METHODS[make]} if make in METHODS else {})
    slow = nominal("hapkit", wired=1, checked=1, ident=1, date=20261120, speed_max=1.0)  # at 4 ms the sensor allows no more
    with emulated_uno(HAND, T=T, settings=slow) as paddle:
        program = Paddle.program(paddle, scene, **options)
        log = paddle.run(program, duration=ticks * T)
        return program, log, paddle.settings.force_max, paddle.timing


def same_bits(make, ticks):
    program, log, limit, timing = run(make, ticks, SCENES[make])
    assert log.fault is None and len(log) == ticks and not log.gap.any() and timing.lost == 0
    outputs, _ = load(program, "interpreter").run(ticks, log.x[:, None], program.values)
    F = np.clip(outputs[:, 0, 0], -np.float32(limit), np.float32(limit)).astype(np.float32)
    assert np.ptp(F) > 0.05  # something was felt
    assert np.array_equal(log.F.astype(np.float32).view(np.uint32), F.view(np.uint32))
    x = log.x.astype(np.float32)
    v = np.diff(x, prepend=x[:1]) * (np.float32(1e6) / np.float32(program.T * 1e6))
    assert np.array_equal(log.v.astype(np.float32), v)


FEW = pytest.param(mass_and_wall, 300, id="few")


@pytest.mark.parametrize(("make", "ticks"), [FEW, *(pytest.param(make, 1000, id=make.__name__) for make in SCENES)])
@pytest.mark.always("few")
def test_telemetry_equals_the_program_in_every_bit(make, ticks):
    same_bits(make, ticks)


@pytest.mark.slow
@pytest.mark.parametrize("make", SCENES, ids=lambda make: make.__name__)
def test_telemetry_equals_the_program_in_every_bit_for_long(make):
    same_bits(make, 10_000)


@pytest.mark.wide
def test_three_numbers_a_millisecond_arrive_without_loss_and_on_time():
    with emulated_uno(HAND) as paddle:
        log = paddle.run(wall()[0], duration=3.0)
        assert len(log) == 3000 and not log.gap.any() and not log.overrun.any()
        assert paddle.timing.lost == paddle.timing.overruns == paddle.exchange.decoder.damaged == 0
        # the grid is the timer's; what moves a sample is who holds interrupts off, some 10 us at most
        assert 985e-6 < paddle.timing.period_min <= 1e-3 <= paddle.timing.period_max < 1015e-6


@pytest.mark.parametrize("running", [False, True])
@pytest.mark.always("True")
def test_a_ping_takes_less_than_a_millisecond(running):
    with emulated_uno(HAND) as paddle:
        if running:
            paddle.start(wall()[0])
        taken = []
        for token in range(100):
            paddle.exchange.refresh()  # a heartbeat is not due then, which would go before the question
            paddle.loop.run(1e-5 * token)  # at every phase of the tick
            begun = paddle.exchange.now()
            reply = paddle.exchange.ask("PING", token)
            assert reply.fields["token"] == token
            taken.append(paddle.exchange.now() - begun)
    assert np.median(taken) < 1e-3
    assert max(taken) < 3e-3  # behind two samples and a step


def test_parameters_change_together_between_two_ticks():
    k, x_o = hl.parameters("k x_o", units="N/m m")
    scene = hl.Scene(force=k * (hl.x(hl.n) - x_o), name="spring")
    with emulated_uno(HAND) as paddle:
        paddle.start(scene(k=50, x_o=0.001))
        paddle.wait(0.2)
        paddle.set(k=80, x_o=-0.002)
        paddle.wait(0.2)
        log = paddle.stop()
    x = log.x.astype(np.float32)
    before, after = (np.float32(k) * (x - np.float32(x_o)) for k, x_o in ((50, 0.001), (80, -0.002)))
    (at,) = [t for t, changed in log.changes]
    switch = round(at / log.T)
    assert log.changes[0][1] == {"k": 80.0, "x_o": -0.002}
    F = log.F.astype(np.float32)
    assert np.array_equal(F[:switch], before[:switch]) and np.array_equal(F[switch:], after[switch:])
    assert (before != after).all()


def test_a_new_scene_replaces_the_old_through_idle():
    k = hl.parameters("k", units="N/m")
    scene = hl.Scene(force=k * hl.x(hl.n), name="spring")
    with emulated_uno(HAND) as paddle:
        paddle.start(wall()[0])
        paddle.wait(0.05)
        log = paddle.run(scene(k=30), duration=0.1)
        assert np.array_equal(log.F.astype(np.float32), np.float32(30) * log.x.astype(np.float32))
        _, duties = paddle.loop.board.duties()
        assert duties[-1] == 0
