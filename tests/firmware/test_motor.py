"""The motor in whole numbers: duty against its law, heat against the first-order model, the limit at every kind of float."""

import ctypes
import math
import shutil
import subprocess

import numpy as np
import pytest
from bare import HERE, Avr
from emulated import image
from emulator import RAM_BEGIN, Uno, missing
from host_driver import Host, spring

from hapticlab.compiler.tick.compile_scene import compile
from hapticlab.device.board.settings import nominal
from hapticlab.device.link.messages import FAULTS, MOTOR_LAWS, SAMPLE_FLAGS
from hapticlab.scene.notation.symbols import parameters
from hapticlab.scene.scene import Scene

CURVE = (0.2, 0.35, 0.5, 0.7)
LAWS = {
    "LINEAR": lambda part, dead: dead + (1 - dead) * part,
    "SQRT": lambda part, dead: dead + (1 - dead) * np.sqrt(part),
    "MEASURED": lambda part, dead: np.interp(part, [0, 0.25, 0.5, 0.75, 1], [dead, *CURVE[1:], 1]),
}
FULL = np.float32(7.3)


@pytest.fixture(scope="module")
def motor(tmp_path_factory):
    if not shutil.which("cc"):
        pytest.skip("needs a C compiler called cc")
    firmware, library = HERE.parents[1] / "firmware", tmp_path_factory.mktemp("motor") / "motor.so"
    folders = [f"-I{firmware / name}" for name in ("core", "generated", "boards", "boards/host")]
    files = [HERE / "motor_bench.c", firmware / "core/motor.c", firmware / "core/heat.c"]
    flags = ["-O2", "-std=c99", "-ffp-contract=off", "-DHL_WORD_BITS=16", "-shared", "-fPIC"]
    subprocess.run(["cc", *flags, *folders, *files, "-o", library], check=True)
    made = ctypes.CDLL(str(library))
    made.configure.argtypes = [*3 * [ctypes.c_float], ctypes.c_uint16, ctypes.c_uint8, ctypes.c_void_p]
    made.heat.argtypes = [ctypes.c_float, ctypes.c_uint32, ctypes.c_double, ctypes.c_uint8]
    made.heat.restype = ctypes.c_double
    return made


COLD, ON = 0.0, -1.0  # where heat begins, or goes on


def heat(motor, force, ticks, begin=COLD, followed=True):
    return motor.heat(force, ticks, begin, followed)


def found(motor, fault):
    return motor.found(FAULTS[fault][0])


def configure(motor, *, full=1.0, continuous=1.0, tau=60.0, us=1000, law="LINEAR", curve=(0.0,) * 4):
    motor.configure(full, continuous, tau, us, MOTOR_LAWS[law], np.array(curve, np.float32).ctypes.data_as(ctypes.c_void_p))


def forces(law, dead, steps):
    """Return forces just beside those where the nearest of so many duties changes, others, and both signs."""
    rng = np.random.default_rng(1)
    part = np.linspace(0, 1, 200_001)
    edges = np.interp((np.arange(steps) + 0.5) / steps, LAWS[law](part, dead), part)
    found = np.concatenate([edges * (1 + e) for e in (-1e-3, 1e-3)] + [rng.random(500), 10.0 ** rng.uniform(-9, 0, 500), [1.0]])
    found = (found[(found > 0) & (found <= 1)] * FULL).astype(np.float32)
    return np.concatenate([found, -found])


def check(duties, given, law, dead, full, margin):
    part = np.abs(given.astype(float)) / float(FULL)
    exact = full * LAWS[law](np.minimum(part, 1), dead)
    assert np.abs(np.abs(duties) - exact).max() <= 0.5 + margin
    assert (np.sign(duties) * np.sign(given) >= 0).all()
    order = np.argsort(given, kind="stable")
    assert (np.diff(duties[order]) >= 0).all(), "a larger force never has a smaller duty"


@pytest.mark.parametrize("dead", [0.0, 0.137, 0.5])
@pytest.mark.parametrize("law", LAWS)
def test_a_duty_is_the_nearest_to_its_law(motor, law, dead):
    """To 0.65 of a step of the 32767 beyond the rounding, 0.005 of a step of the Uno's 256."""
    curve = (dead, *CURVE[1:]) if dead < CURVE[1] else (dead, 0.6, 0.7, 0.8)
    configure(motor, full=FULL, law=law, curve=curve)
    given = forces(law, dead, 256)
    found = np.empty(len(given), np.int16)
    motor.duties(given.ctypes.data_as(ctypes.c_void_p), found.ctypes.data_as(ctypes.c_void_p), ctypes.c_uint32(len(given)))
    law_of = dict(LAWS, MEASURED=lambda part, dead: np.interp(part, [0, 0.25, 0.5, 0.75, 1], [*curve, 1]))
    exact = 32767 * law_of[law](np.minimum(np.abs(given.astype(float)) / float(FULL), 1), dead)
    found = found.astype(int)
    assert np.abs(np.abs(found) - exact).max() <= 0.5 + 0.65
    assert (np.sign(found) * np.sign(given) >= 0).all() and (np.diff(found[np.argsort(given, kind="stable")]) >= 0).all()


def test_no_force_has_no_duty_and_too_much_has_the_full_one(motor):
    configure(motor, full=FULL, law="SQRT", curve=(0.2,) * 4)
    given = np.array([0.0, -0.0, 1e-30, -1e-30, FULL, -FULL, 2 * FULL, 3e38], np.float32)
    found = np.empty(len(given), np.int16)
    motor.duties(given.ctypes.data_as(ctypes.c_void_p), found.ctypes.data_as(ctypes.c_void_p), ctypes.c_uint32(len(given)))
    assert list(found) == [0, 0, 6553, -6553, 32767, -32767, 32767, 32767]


COMPARE, PORTB = 0x48, 0x25  # OCR0B and the direction's port, on the Uno


@pytest.mark.skipif(missing() is not None, reason=str(missing()))
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.always("SQRT")
def test_every_duty_of_the_uno_is_the_nearest_to_its_law_with_either_sign(law):
    curve = {"duty_dead": CURVE[0], "duty_25": CURVE[1], "duty_50": CURVE[2], "duty_75": CURVE[3]} if law == "MEASURED" else {}
    kept = nominal("hapkit", wired=1, checked=1, motor_law=MOTOR_LAWS[law], force_full=float(FULL), motor_sign=1, **curve)
    dead = CURVE[0] if curve else 0.0
    with Uno(image(), eeprom=kept.to_bytes()) as board:
        board.run(0.1)
        memory = board.memory[RAM_BEGIN:].tobytes()
    cpu, given, found = Avr(image().with_suffix(".elf")), forces(law, dead, 256), []
    given = given[np.abs(LAWS[law](np.abs(given.astype(float)) / float(FULL), dead)) * 256 > 1]  # a duty that is not 0
    for k in range(0, len(given), 200):  # hl_heat waits for the main loop after 255
        cpu.write(RAM_BEGIN, memory)
        rows = np.ascontiguousarray(given[k : k + 200, None]).view(np.uint8)
        registers = cpu.rows("hl_motor", (cpu.place("uno_core"),), 20, rows, PORTB, COMPARE - PORTB + 1)[0]
        found.append((registers[:, -1] + 1.0) * np.where(registers[:, 0] & 1, 1, -1))
    duties = np.concatenate(found)
    assert set(np.abs(duties)) == set(range(int(np.abs(duties).min()), 257))
    check(duties, given, law, dead, 256, 0.02)


# ---------------------------------------------------------------- heat

#: period [us], heating time [s], full force over the continuous one, force over the full one, ticks
HEATING = [
    (1000, 60.0, 2.0, 0.9, 400_000), (250, 60.0, 3.0, 0.2, 400_000), (10_000, 1.0, 1.5, 1.0, 500),
    (10_000, 1000.0, 30.0, 0.01, 720_000), (250, 1.0, 1.0, 0.5, 20_000), (1000, 1e6, 2.0, 1.0, 3_600_000),
    (250, 1e6, 20.0, 0.04, 4_000_000),
]  # fmt: skip


@pytest.mark.parametrize("us, tau, ratio, part, ticks", HEATING)
def test_heat_is_the_first_order_model_and_never_much_below_it(motor, us, tau, ratio, part, ticks):
    """From cold, then cooling: at most 0.1 % less, at most 0.3 % more."""
    configure(motor, full=FULL, continuous=FULL / ratio, tau=tau, us=us)
    end, t = (ratio * part) ** 2, ticks * us * 1e-6
    hot = heat(motor, FULL * part, ticks)
    exact = -end * math.expm1(-t / tau)
    print(f"\n{us} us, {tau:g} s: heated {hot / exact - 1:+.2%}", end="")
    assert -0.001 <= hot / exact - 1 <= 0.003
    cooled = heat(motor, 0.0, ticks, ON)
    print(f", cooled {cooled - hot * math.exp(-t / tau):+.2e}")
    assert -0.003 * hot <= cooled - hot * math.exp(-t / tau) <= 0.003 * hot


def test_heat_grows_with_the_force_and_cannot_turn_over(motor):
    heats = []
    for part in np.linspace(0, 1, 41):
        configure(motor, full=FULL, continuous=FULL / 3, tau=10.0)
        heats.append(heat(motor, FULL * part, 3200))
    assert (np.diff(heats) > 0).all() and heats[0] == 0
    configure(motor, full=1e6, continuous=1e-6, tau=1.0, us=10_000)  # the ends of what settings may say
    assert 1 < heat(motor, 1e6, 100_000) <= 32 and found(motor, "OVER_HEAT") > 1000
    configure(motor, full=1e-6, continuous=1e6, tau=1e6, us=250)
    assert 0 <= heat(motor, 1e-6, 100_000) < 1e-6 and found(motor, "OVER_HEAT") == 0


def test_a_motor_whose_heat_nobody_follows_is_switched_off(motor):
    """Where steps leave the main loop no time: 255 ticks are kept, then it is an OVERRUN, and no force is forgotten before."""
    configure(motor)
    heat(motor, 0.5, 16 + 255, followed=False)  # the first 16 wait to be taken
    assert found(motor, "OVERRUN") == 0
    heat(motor, 0.5, 1, ON, followed=False)
    assert found(motor, "OVERRUN") == 1


@pytest.mark.parametrize("ticks, rest", [(13, 3), (15, 1), (7, 2)])
def test_heat_of_short_runs_with_long_periods_counts_in_full(ticks, rest):
    """Ticks of 10 ms that a STOP left were taken for ticks of 1 ms: at HOT the motor had 4.9 times the heat that it stands."""
    host, heat = Host(force_continuous=1.0, heating_time=10.0, force_max=4.0, speed_max=0.01), 0.5
    host.ready(spring(T=0.01), _0=-400.0)
    host.tick(0)
    while host.start() == "OK" and heat < 3:
        for k in range(ticks):
            force = 8.0 * abs(host.tick(1000))
            heat += (force**2 - heat) * -math.expm1(-0.01 / 10)
            if k % 5 == 0:
                host.state()
        host.ask("STOP")
        host.tick(1000, times=rest)
        heat *= math.exp(-rest * 1e-3 / 10)
    assert heat == pytest.approx(host.state()["heat"], rel=0.02) and 1 < heat < 1.25


def test_a_force_is_within_its_limit_at_every_kind_of_float():
    """The limit compares bits: zeros, denormals, the limit's neighbours, the largest floats, of either sign."""
    limit = np.float32(4.0)
    beside = [np.nextafter(limit, np.float32(0)), limit, np.nextafter(limit, np.float32(9))]
    any_bits = np.random.default_rng(2).integers(0, 0x7F800000, 60).astype(np.uint32).view(np.float32)
    special = np.array([0x0, 0x1, 0x7FFFFF, 0x800000, 0x7F7FFFFF], np.uint32).view(np.float32)
    constant = compile(Scene(force=parameters("k", units="N"), name="constant"), T=1e-3)
    host = Host(force_max=4.0, force_full=8.0).ready(constant, _0=0.0)
    assert host.start() == "OK"
    for value in np.concatenate([special, beside, any_bits]).astype(np.float32):
        for signed in (value, -value):
            assert host.set(_0=signed) == "OK"
            host.samples.clear()
            host.tick(0)
            payload = host.samples[-1].payload
            felt, flags = np.frombuffer(payload, "<f4", 1, 13)[0], payload[4]
            expected = np.clip(signed, -limit, limit)
            assert felt.tobytes() == expected.tobytes() or (felt == 0 == expected)
            assert bool(flags & SAMPLE_FLAGS["SATURATED"]) == (abs(signed) > limit)
