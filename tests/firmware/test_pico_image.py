"""The Pico's image as it is committed, and in its emulator closed around a simulated paddle: every bit as on the PC."""

import numpy as np
import pytest
from build_image import FIRMWARE, build_image
from five_scenes import double_pendulum, mass_and_wall, pendulum, wall
from pico_emulator import missing
from pico_loop import emulated_pico, hapkit

import hapticlab as hl
from hapticlab.compiler.boards.board_records import BOARDS
from hapticlab.compiler.engines.engine import load
from hapticlab.device.paddle import Paddle
from hapticlab.device.setup.drive.uf2_blocks import parse_uf2

needs_emulator = pytest.mark.skipif(missing() is not None, reason=str(missing()))
HOW = BOARDS["pico"].flashing
HAND = hl.Hand(m=0.05, b=3, k=400, intent=lambda t: 0.004 * np.sin(9 * t) + 0.003 * np.sin(31 * t))
#: scene -> period [s] and ticks: among them periods that an Uno has no time for
SCENES = {wall: (100e-6, 1000), mass_and_wall: (200e-6, 1000), pendulum: (400e-6, 500), double_pendulum: (1e-3, 300)}
SENSORS = ("MAGNETORESISTIVE", "QUADRATURE", "AS5048A")


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    try:
        return build_image.build("pico", tmp_path_factory.mktemp("pico"))
    except SystemExit as problem:
        pytest.skip(str(problem))


def test_the_committed_image_is_what_the_sources_give(built):
    committed = FIRMWARE / "prebuilt" / HOW.image
    assert built[1].read_bytes() == committed.read_bytes(), "build it again: python firmware/build.py pico"


def test_the_image_is_in_order_and_leaves_the_settings_alone(built):
    pages = parse_uf2(built[1].read_bytes(), family=HOW.family)
    assert [at for at, _ in pages] == [0x10000000 + 256 * k for k in range(len(pages))]
    flash, ram = build_image.sizes(built[0])
    assert 256 * len(pages) <= HOW.flash and flash <= HOW.flash and ram <= HOW.ram
    boot2 = pages[0][1]
    assert int.from_bytes(boot2[252:], "little") == build_image.crc32_mpeg2(boot2[:252])


def test_the_checksum_is_the_one_that_the_rom_takes():
    """The check value of CRC-32/MPEG-2 in the catalogue of parametrised CRC algorithms."""
    assert build_image.crc32_mpeg2(b"123456789") == 0x0376E6E7


def same_bits(make, T, ticks, sensor="MAGNETORESISTIVE"):
    scene, options = make()
    with emulated_pico(HAND, T=T, settings=hapkit(sensor)) as paddle:
        program = Paddle.program(paddle, scene, **options)
        log = paddle.run(program, duration=ticks * T, progress=False)
        limit, timing, facts = paddle.settings.force_max, paddle.timing, paddle.loop.board.facts
    assert log.fault is None and len(log) == ticks and not log.gap.any() and timing.lost == timing.overruns == 0
    outputs, _ = load(program, "interpreter").run(ticks, log.x[:, None], program.values)
    F = np.clip(outputs[:, 0, 0], -np.float32(limit), np.float32(limit)).astype(np.float32)
    assert np.ptp(F) > 0.02  # something was felt
    assert np.array_equal(log.F.astype(np.float32).view(np.uint32), F.view(np.uint32))
    assert facts["violations"] == facts["warnings"] == facts["usb"]["errors"] == []
    assert timing.period_max - timing.period_min <= 2e-6, "two readings of a clock of 1 us"
    print(f"{make.__name__} at {1 / T:.0f} Hz: step {1e6 * timing.mean:.0f} us, worst {1e6 * timing.worst:.0f} us")


@needs_emulator
@pytest.mark.parametrize("make", SCENES, ids=lambda make: make.__name__)
@pytest.mark.wide
def test_telemetry_of_every_tick_equals_the_program_in_every_bit(make):
    same_bits(make, *SCENES[make])


@needs_emulator
@pytest.mark.parametrize("sensor", SENSORS)
@pytest.mark.always("MAGNETORESISTIVE")
def test_every_sensor_gives_positions_of_which_the_force_is_the_scene(sensor):
    same_bits(wall, 500e-6, 150, sensor)
