"""The Uno's board code under emulation: motor, tick, sensors, link, store, watchdog. A probe stands in for the core."""

import math
import struct

import numpy as np
import pytest
from build_image import FIRMWARE, build, symbols
from closed_loop import MagnetoresistiveSensor, QuadratureSensor
from emulator import (
    BROWN_OUT,
    CYCLES_PER_SECOND,
    EXTERNAL,
    INT0,
    PAINT,
    POWER,
    RAM_BEGIN,
    USART_UDRE,
    WATCHDOG,
    Uno,
    missing,
)

from hapticlab.device.board.settings import nominal
from hapticlab.device.link.messages import FAULTS, LOOP_SETTINGS, RESET_CAUSES, SENSORS

pytestmark = pytest.mark.skipif(missing() is not None, reason=str(missing()))

DDRD, PORTD, EIMSK, MCUSR, TIMSK1 = 0x2A, 0x2B, 0x3D, 0x54, 0x6F
FIELDS = (
    "period_us u2, duty i2, spin u2, echo u1, at u2, byte u1, kept u1, pieces u1, "
    "ticks u4, begin u2, shortest u2, longest u2, fault u1, cause u1, value f4, received u4, refused u2"
)
PROBE = np.dtype([tuple(field.split()) for field in FIELDS.split(", ")])  # as probe.c has it: an AVR pads nothing
MEMORY, SENSOR = FAULTS["MEMORY"][0], FAULTS["SENSOR"][0]


@pytest.fixture(scope="module")
def image(tmp_path_factory):
    """The board with the probe: its .hex, and its symbols."""
    elf, image = build("uno", tmp_path_factory.mktemp("probe"), core="../tests/firmware/probe.c")
    return image, symbols(elf)


def hapkit(**changes):
    return nominal("hapkit", **{"wired": 1, **changes})


@pytest.fixture
def start(image):
    """Start a board; ``board.probe`` is the probe's record."""
    boards = []

    def start(*, settings=None, run=0.002, **options):
        board = Uno(image[0], eeprom=(settings or hapkit()).to_bytes(), **options)
        boards.append(board)
        board.adc(500)
        board.probe = board.at(image[1]["probe"] - 0x800000, PROBE)
        board.counts = board.at(image[1]["counts"] - 0x800000, "int32")
        board.run(run)
        return board

    yield start
    for board in boards:
        board.close()


def test_the_motor_is_off_before_memory_is_initialised(start, image):
    board = start(run=0)
    board.run_to(40)  # vector, stack pointer, then .init3
    assert board.at(DDRD) & 0x20 and not board.at(PORTD) & 0x20, "D5 is no firm low yet"
    assert board.at(image[1]["__bss_start"] - 0x800000) == PAINT, "memory was initialised first"
    board.run(0.01)
    assert list(board.duties()[1]) == [0] and board.duty == 0


@pytest.mark.parametrize("duty", [1, 4, 100, 255, 256, -1, -100, -256])
def test_the_motor_follows_its_duty(start, duty):
    board = start(carrier=5)
    board.probe["duty"] = duty
    board.run(0.003)
    assert board.duty == duty
    cycles, levels = board.edges()
    rises, falls = cycles[levels == 1], cycles[levels == 0]
    if 4 <= abs(duty) < 256:  # at 256 the pin stays high
        # simavr moves a pin between two instructions, of 4 cycles at most: a shorter pulse would vanish
        periods = np.round((rises[2:] - rises[2]) / 256)
        assert len(rises) > 100 and np.ptp(rises[2:] - rises[2] - 256 * periods) <= 4, "not 62.5 kHz"
        high = falls[falls > rises[2]][: len(rises) - 3] - rises[2:-1]
        assert np.all(np.abs(high - abs(duty)) <= 4) and abs(np.mean(high) - abs(duty)) < 2, high[:9]
    board.probe["duty"] = 0
    board.run(0.002)
    assert board.duty == 0 and not board.at(PORTD) & 0x20


def test_direction_changes_with_the_motor_running(start):
    board = start()
    for duty in (200, -200, 50, -256, 0):
        board.probe["duty"] = duty
        board.run(0.002)
        assert board.duty == duty


@pytest.mark.parametrize("period", [250, 1000, 1237, 10000])
@pytest.mark.always("250", "1237")
def test_the_period_is_exact(start, period):
    """Over a second: each distance to one count of the timer, their sum to the last tick's distance from the grid."""
    board = start()
    board.probe["period_us"] = period
    board.run(0.0005)
    board.run(2.5 * period * 1e-6)
    first, ticks = int(board.probe["begin"]), int(board.probe["ticks"])
    board.run(1.0)
    done = int(board.probe["ticks"]) - ticks
    assert abs(done - 1e6 / period) <= 1
    assert abs(int(board.probe["shortest"]) - 2 * period) <= 1 and abs(int(board.probe["longest"]) - 2 * period) <= 1
    drift = (int(board.probe["begin"]) - first - done * 2 * period + 32768) % 65536 - 32768
    assert abs(drift) <= 1


@pytest.mark.parametrize(
    "period, length",
    [*((1000, length) for length in (0.9, 1.02, 1.5, 2.5, 3.998, 14.3)), (250, 0.9), (250, 2.5), (250, 113.3)],
)
def test_a_late_tick_is_not_repeated(start, period, length):
    """A step longer than the period: the next tick is at the first point of the grid that is still to come."""
    clocks = 2 * period
    board = start()
    board.probe["period_us"] = period
    board.run(10.1 * period * 1e-6)
    begin, ticks = int(board.probe["begin"]), int(board.probe["ticks"])
    board.probe["spin"] = round(clocks * length)
    skipped = math.floor(length + 0.05)  # a point of the grid nearer than a tick's own time is skipped, too
    board.run((skipped + 3) * period * 1e-6)
    assert board.probe["ticks"] == ticks + 3
    assert abs(int(board.probe["longest"]) - clocks * (skipped + 1)) <= 1
    off = (int(board.probe["begin"]) - begin - clocks * (skipped + 3)) % 65536
    assert min(off, 65536 - off) <= 1, "the grid moved"


def settled(board):
    """The board's counts, not in the middle of being written."""
    before = None
    while before != board.counts.item():
        before = board.counts.item()
        board.run(1e-6)
    return before


def sweep(board, sensor, begin, end, speed):
    """Move a sensor at a speed [counts/s]; return the worst lag of the board's counts, and their sum."""
    start, counts, worst, x = board.now, settled(board), 0.0, begin
    while x != end:
        passed = speed * (board.now - start)
        x = min(begin + passed, end) if end > begin else max(begin - passed, end)
        sensor.show(board, x)
        board.run(50e-6)
        worst = max(worst, abs(settled(board) - counts - (x - begin)))
    board.run(0.002)
    return worst, settled(board) - counts


@pytest.mark.parametrize("wrap", [920, 700])
@pytest.mark.parametrize("speed", [20e3, 300e3])
@pytest.mark.always("*-920")
def test_turns_of_the_magnet_are_counted(start, wrap, speed):
    board = start(settings=hapkit(wrap=wrap), run=0)
    sensor = MagnetoresistiveSensor(1.0, wrap=wrap)
    sensor.show(board, 0)
    board.run(0.004)
    for begin, end in ((0, 5000), (5000, -2700), (-2700, 0)):
        worst, counted = sweep(board, sensor, begin, end, speed)
        assert counted == end - begin, "at rest, counts are exact"
        assert worst <= speed * (1e-3 + 150e-6) + 1, "in motion: older than a period, a conversion and a step of 50 us"


def test_a_sensor_out_of_its_band_is_a_fault(start):
    board = start(settings=hapkit())
    for reading in (20, 52, 500, 972, 1003):
        board.adc(reading)
        board.run(0.003)
        assert board.probe["fault"] == 0, reading
    for reading in (0, 19, 1004, 1023):
        board.adc(500)
        board.run(0.003)
        counts = board.counts.item()
        board.probe["fault"] = 0
        board.adc(reading)
        board.run(0.003)
        assert (board.probe["fault"], board.probe["value"], board.counts) == (SENSOR, reading, counts)


def test_a_sensor_that_uses_the_whole_range_has_no_band(start):
    board = start(settings=hapkit(wrap=1024))
    for reading in (1020, 3, 1023, 0):
        board.adc(reading)
        board.run(0.003)
    assert board.probe["fault"] == 0
    assert board.counts == 500 - 500 - 500  # 1020, then 7, 4 and 1 counts up and down over the end of the range


@pytest.mark.parametrize("speed", [3e3, 60e3])
@pytest.mark.always("60000.0")
def test_the_encoder_is_counted(start, speed):
    board = start(settings=hapkit(sensor=SENSORS["QUADRATURE"]), run=0)
    sensor = QuadratureSensor(1.0)
    sensor.show(board, 0)
    board.run(0.002)
    for begin, end in ((0, 700), (700, -1500), (-1500, -1499), (-1499, 0)):
        worst, counted = sweep(board, sensor, begin, end, speed)
        assert counted == end - begin
        assert worst <= speed * (1e-3 + 150e-6) + 1
    assert board.probe["fault"] == 0


def test_an_edge_missed_is_a_fault(start):
    board = start(settings=hapkit(sensor=SENSORS["QUADRATURE"]), run=0)
    QuadratureSensor(1.0).show(board, 0)
    board.run(0.002)
    board.pin(2, 1)
    board.run(0.003)
    assert (board.probe["fault"], board.counts) == (0, 1)
    board.at(EIMSK)[()] = 0  # as if both edges came while the interrupt was held off
    board.pin(2, 0)
    board.run(1e-5)
    board.at(EIMSK)[()] = 3
    board.pin(3, 1)
    board.run(0.003)
    assert (board.probe["fault"], board.probe["value"]) == (SENSOR, 1)


@pytest.mark.parametrize("period", [250, 1000])
def test_the_link_loses_nothing_both_ways(start, period):
    """Half a second of bytes without a gap in either direction, the tick running."""
    board = start()
    board.probe["period_us"], board.probe["echo"] = period, 1
    board.run(0.001)
    data = np.random.default_rng(1).bytes(25000)
    begin = board.now
    board.write(data)
    board.run(len(data) * 20e-6 + 0.001)
    assert board.overruns == 0 and board.probe["received"] == len(data)
    assert board.read() == data
    assert board.now - begin < len(data) * 20e-6 + 0.0011, "a byte takes 20 us at 500000 baud"
    for distance in (board.probe["shortest"], board.probe["longest"]):
        assert abs(int(distance) - 2 * period) <= 24, "one interrupt of the link holds the tick off, not two"


def test_a_frame_is_taken_whole_or_not_at_all(start):
    board = start()
    board.probe["pieces"] = 5
    board.run(0.010)
    assert board.probe["refused"] > 0, "128 bytes of room were never full"
    assert board.read() == bytes((piece * 50 + k) % 256 for piece in (5, 4, 3, 2, 1) for k in range(50))


def test_the_watchdog_resets_a_board_whose_tick_stops(start):
    board = start()
    board.probe["duty"] = 77
    board.run(0.3)
    assert (board.duty, board.probe["cause"]) == (77, RESET_CAUSES["POWER"][0])
    board.at(TIMSK1)[()] = 0
    begin = board.cycle
    board.run(0.2)
    cycles, duties = board.duties()
    stopped = (cycles[(cycles > begin) & (duties == 0)][0] - begin) / CYCLES_PER_SECOND
    print(f"motor off {stopped * 1e3:.1f} ms after the tick hung")
    assert 0.1 < stopped <= 0.13
    assert (board.duty, board.probe["cause"]) == (0, RESET_CAUSES["WATCHDOG"][0])
    assert board.probe["ticks"] > 50, "it runs again"
    board.probe["echo"] = 1
    board.write(b"hello")
    board.run(0.002)
    assert board.read() == b"hello"


@pytest.mark.parametrize(
    "flags, cause",
    [
        (POWER, "POWER"),
        (POWER | BROWN_OUT | EXTERNAL, "POWER"),  # a slow rise of the supply sets the others, too
        (BROWN_OUT, "BROWN_OUT"),
        (EXTERNAL, "EXTERNAL"),
        (WATCHDOG, "WATCHDOG"),
        (0, "POWER_OR_RESET"),  # the bootloader cleared them
    ],
)
def test_the_reset_cause(start, flags, cause):
    board = start(cause=flags)
    assert board.probe["cause"] == RESET_CAUSES[cause][0]
    assert board.at(MCUSR) == 0, "the next reset must not find this one's cause; a flag left keeps the watchdog on"
    board.reset(EXTERNAL)
    board.run(0.002)
    assert board.probe["cause"] == RESET_CAUSES["EXTERNAL"][0], "the flags of the reset before are gone"


def test_the_store_keeps_what_is_written(start):
    settings = hapkit(ident=0x3F2A)
    board = start(settings=settings)
    loop = settings.to_bytes()[4 : 4 + struct.calcsize("<" + "".join(type for type, *_ in LOOP_SETTINGS))]
    assert loop in board.memory[RAM_BEGIN:].tobytes(), "read at the start"
    for at, byte in ((0, 0xA5), (700, 0), (1023, 0x5A), (700, 0x11)):
        board.probe["kept"] = 0
        board.probe["byte"], board.probe["at"] = byte, at
        board.run(0.02)
        assert board.probe["kept"] == 1 and board.eeprom[at] == byte
    expected = bytearray(settings.to_bytes().ljust(1024, b"\xff"))
    expected[0], expected[700], expected[1023] = 0xA5, 0x11, 0x5A
    assert board.eeprom == bytes(expected)


def test_a_stack_that_reaches_the_variables_is_a_fault(start, image):
    board = start()
    board.probe["duty"] = 9
    board.run(0.002)
    assert board.probe["fault"] == 0
    board.at(image[1]["_end"] - 0x800000 + 3)[()] ^= 1
    board.run(0.0005)
    assert board.probe["fault"] == MEMORY


def test_the_committed_image_is_what_the_sources_give(tmp_path):
    _, image = build("uno", tmp_path)
    committed = FIRMWARE / "prebuilt" / "uno.hex"
    assert image.read_bytes() == committed.read_bytes(), "build it again: python firmware/build.py uno"


@pytest.mark.parametrize("vector, most", [(INT0, 100), (USART_UDRE, 60)])
def test_an_interrupt_is_short(start, vector, most):
    """Cycles during which no other interrupt gets in: a byte comes every 320, an edge of the encoder every 160 at most."""
    board = start(settings=hapkit(sensor=SENSORS["QUADRATURE"]), run=0)
    board.probe["echo"] = 1
    sensor = QuadratureSensor(1.0)
    sensor.show(board, 0)
    board.run(0.002)
    board.probe["echo"] = 1
    board.write(bytes(100))
    sweep(board, sensor, 0, 100, 20e3)
    count, mean, worst = board.cost(vector)
    print(f"vector {vector}: {count} times, mean {mean:.1f}, worst {worst} cycles")
    assert count >= 50 and worst <= most
