"""Every sensor and every drive in the whole loop: the pins give the force that the program commands, or nothing at all."""

import struct

import numpy as np
import pytest
from bare import Avr
from emulated import emulated_uno, image
from emulator import CYCLES_PER_SECOND, EXTERNAL, WATCHDOG, Uno, missing
from faults import FAULTS, off_from
from wired import HAND, PADDLES, SPRING, duties_of_ticks, expected_duty, high_pins

from hapticlab.compiler.engines.engine import load
from hapticlab.device.board.settings import Settings, changed, pin_word, pins_of
from hapticlab.device.board.upload import upload
from hapticlab.device.link.messages import DRIVES, LOOP_SETTINGS, SENSORS
from hapticlab.device.paddle import Paddle
from hapticlab.device.wiring import Wiring
from hapticlab.errors import PaddleError

pytestmark = pytest.mark.skipif(missing() is not None, reason=str(missing()))
#: of each drive one
DRIVEN = {Wiring.of(settings).drive: name for name, settings in reversed(PADDLES.items())}


def connected(name, **values):
    return emulated_uno(HAND, settings=changed(PADDLES[name], **values))


@pytest.mark.parametrize("name", PADDLES)
@pytest.mark.always("longhorn")
def test_the_pins_give_the_force_that_the_program_commands(name):
    settings = PADDLES[name]
    with connected(name) as paddle:
        program = Paddle.program(paddle, SPRING)
        paddle.start(program)
        paddle.wait(0.25)
        board = paddle.loop.board
        carriers = [carrier for pin in pins_of(settings.motor_pins) if (carrier := board.carrier(pin))]
        log = paddle.stop()
        assert log.fault is None and not log.gap.any() and not log.overrun.any()
        assert board.driver.conflicts == 0, "both inputs of the driver were high"
        given, after = duties_of_ticks(board, len(log)), board.duty
    outputs, _ = load(program, "interpreter").run(len(log), log.x[:, None], program.values)
    assert np.array_equal(log.F.astype(np.float32), outputs[:, 0, 0].astype(np.float32)), "other bits than the program's"
    assert np.ptp(log.F) > 0.5 and after == 0
    assert carriers == [pytest.approx(settings.carrier, rel=2e-3)]
    off = np.abs(given - expected_duty(log.F, settings))
    assert off.max() <= 1.51, "the nearest step of the duty, and one more where phase-correct PWM has 255 of them"


@pytest.mark.parametrize("fault", ["over-speed", "tick stops", "brown-out"])
@pytest.mark.parametrize("drive", DRIVES)
@pytest.mark.always("SHIFT_REGISTER-over-speed")
def test_every_drive_is_off_in_time(drive, fault):
    fault = FAULTS[fault]
    with connected(DRIVEN[drive]) as paddle:
        paddle.start(SPRING)
        board = paddle.loop.board
        paddle.wait(0.1)
        while abs(board.duty) < 30:
            paddle.wait(0.003)
        fault.inject(paddle)
        begun = board.cycle  # before the ticks stop the link is asked once more
        last = paddle.exchange.now() + fault.within + 0.05
        while paddle.exchange.now() < last:
            paddle.exchange.wait(lambda: paddle.exchange.now() >= last, 0.01)
        taken = (off_from(board, begun) - begun) / CYCLES_PER_SECOND
        assert board.driver.conflicts == 0
    assert 0 <= taken <= fault.within


@pytest.mark.parametrize("name", [*DRIVEN.values(), "hapkit_as5048a"])
@pytest.mark.always("motor_shield")
def test_nothing_is_driven_before_a_person_confirmed_the_wiring(name):
    with connected(name, wired=0, checked=0) as paddle:
        with pytest.raises(PaddleError, match="NOT_WIRED|confirmed the wiring"):
            paddle.start(SPRING)
        paddle.loop.run(0.05)
        board, wiring = paddle.loop.board, Wiring.of(PADDLES[name])
        chosen = {wiring.sensor_pins[0]} if wiring.sensor == "AS5048A" else set()
        assert set(high_pins(board)) - {2, 3} <= chosen  # pull-ups of an encoder are no drive
        assert set(board.duties()[1]) <= {0} and board.duty == 0
        assert all(board.high(pin) <= 0 for pin in wiring.motor_pins)


@pytest.mark.parametrize("name", [*DRIVEN.values(), "hapkit_as5048a"])
@pytest.mark.always("motor_shield")
def test_a_reset_in_the_middle_takes_the_motor_off_at_once(name):
    with connected(name) as paddle:
        paddle.start(SPRING)
        paddle.wait(0.1)
        board = paddle.loop.board
        for cause in (EXTERNAL, WATCHDOG):
            board.reset(cause)
            assert board.duty == 0, "a reset makes every pin an input"
            begun = board.cycle
            board.run_to(begun + 40)
            low = {5, 6, 8, 11} - set(Wiring.of(PADDLES[name]).sensor_pins)
            assert all(board.high(pin) == 0 for pin in low), "no firm low in the first instructions"
            board.run(0.05)
            cycles, duties = board.duties()
            assert not duties[cycles > begun].any() and board.driver.conflicts == 0


def test_another_wiring_lets_go_of_all_pins_until_it_is_confirmed():
    after = PADDLES["analog pins as inputs"]
    with connected("motor_shield") as paddle:
        board = paddle.loop.board
        assert board.high(7) == 0, "the shield's outputs are on"
        for wired, level in ((0, -1), (1, 0)):
            kept = changed(after, wired=wired, checked=0)
            upload(paddle.exchange, "SETTINGS", kept.to_bytes())
            assert [board.high(pin) for pin in pins_of(after.motor_pins)] == [level] * 3
            assert [board.high(pin) for pin in (4, 7)] == [-1, -1], "pins of the shield"
            assert set(high_pins(board)) == {9}, "only the sensor's chip select"
        assert board.driver.conflicts == 0


def test_the_shield_holds_nothing_when_its_outputs_are_enabled():
    """Whatever its register holds after power-on: both inputs of every motor, here."""
    settings = PADDLES["motor_shield"]
    with Uno(image(), eeprom=settings.to_bytes()) as board:
        board.adc(500)
        board.wire(settings.drive, pins_of(settings.motor_pins))
        assert board.driver.held == 0xFF
        board.run(0.05)
        assert (board.high(7), board.driver.held, board.driver.conflicts) == (0, 0, 0)


def dead_low(sensor):
    sensor.zeros = 0xFFFF


def dead_high(sensor):
    sensor.ones = 0xFFFF


def noisy(sensor):
    sensor.flips = 0x0010


def confused(sensor):
    sensor.errors = 1


def without_magnet(sensor):
    sensor.diagnostics |= 0x0200


@pytest.mark.parametrize(
    "wrong, ticks",
    [(dead_low, 1), (dead_high, 1), (noisy, 1), (confused, 1), (without_magnet, 2)],
    ids=lambda k: getattr(k, "__name__", k),
)
@pytest.mark.always("dead_low-1")
def test_an_as5048a_that_cannot_be_right_is_a_fault(wrong, ticks):
    """At the next tick; what its diagnostics say comes a tick after the question."""
    with connected("hapkit_as5048a") as paddle:
        paddle.start(SPRING)
        paddle.wait(0.1)
        board = paddle.loop.board
        assert board.sensor.hasty == 0, "faster than its data sheet allows"
        begun = board.cycle
        wrong(board.sensor)
        paddle.wait(0.02)
        log = paddle.stop()
        assert "SENSOR" in log.fault
        assert (off_from(board, begun) - begun) / CYCLES_PER_SECOND <= (ticks + 0.2) * 1e-3
        board.sensor.zeros = board.sensor.ones = board.sensor.flips = 0
        board.sensor.diagnostics = 0x0140
        paddle.loop.run(0.02)
        paddle.clear()
        paddle.home(at=0.0)
        assert paddle.run(SPRING, duration=0.05).fault is None, "it runs again, its error flag cleared"


class Led:
    """A handle on a path that no force changes, and a note of every angle that its sensor gave away."""

    def __init__(self, sensor):
        self.t, self.sensor, self.taken, self.moves = 0.0, sensor, [(0, 0)], False

    def step(self, force, seconds):
        self.t += seconds * self.moves
        return 0.002 * np.sin(50 * self.t)

    def show(self, board, x):
        if board.sensor.latched != self.taken[-1][0]:
            self.taken.append((board.sensor.latched, board.sensor.angle))
        self.sensor.show(board, x)


def test_the_angle_is_of_the_tick():
    settings = PADDLES["hapkit_as5048a"]
    with connected("hapkit_as5048a") as paddle:
        loop = paddle.loop
        led = loop.handle = loop.sensor = Led(loop.sensor)
        loop.run(0.005)
        paddle.home(at=0.0)
        home, led.moves = loop.board.sensor.angle, True
        paddle.run(SPRING(K=1500), duration=0.2)
        updates, duties = loop.board.updates(), loop.board.update_duties()
    cycles, angles = np.array(led.taken).T
    period = np.diff(cycles[-150:-10]) / CYCLES_PER_SECOND
    # a byte that came holds a sample off for 9 us at most, as the board's README says, one that goes for 2.4 us; nothing else
    assert np.abs(period - 1e-3).max() < 11.5e-6
    driven = duties != 0
    before = np.searchsorted(cycles, updates[driven]) - 1
    for late, allowed in ((0, True), (1, False)):
        x = (angles[before - late] - home) * settings.metres_per_count
        off = np.abs(duties[driven] - expected_duty(1500 * x, settings))[np.abs(x) > 5e-4]
        assert (off.max() <= 1.6) == allowed, (late, off.max())


def loop_bytes(settings):
    """Return what the board keeps of settings in its memory."""
    return settings.to_bytes()[4 : 4 + struct.calcsize("<" + "".join(type for type, *_ in LOOP_SETTINGS))]


@pytest.mark.parametrize(
    "values",
    [
        {"carrier": 489},
        {"motor_pins": pin_word(5, 8, 9)},
        {"motor_pins": pin_word(5)},
        {"wrap": 1025},
        {"sensor_pins": pin_word()},
    ],
)
def test_the_board_rejects_what_is_no_wiring_of_its_own(values):
    cpu = Avr(image().with_suffix(".elf"))
    place, good = cpu.place("uno_core"), PADDLES["hapkit"]
    for settings, accepted in ((good, 1), (Settings(**{**vars(good), **values}), 0)):
        cpu.write(place, loop_bytes(settings))
        assert cpu.call("board_accepts", place)[0] == accepted
    assert SENSORS["MAGNETORESISTIVE"] == good.sensor
