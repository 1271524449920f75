"""Settings: the board's bytes and Python's, bit for bit; what either refuses, the other refuses too."""

import math
import random
import struct
import zlib
from dataclasses import fields

import numpy as np
import pytest
from host_driver import SETTINGS, Host, settings, spring

from hapticlab.device.board.host_board import HostBoard
from hapticlab.device.board.settings import Settings, changed, nominal, pin_word, simulated
from hapticlab.device.link.messages import MOTOR_LAWS, SETTING_RANGES, SETTINGS_STRUCT, WIRING, settings_hash
from hapticlab.device.link.messages import SETTINGS as TABLE
from hapticlab.device.profiles import PROFILES
from hapticlab.device.simulated.simulated_paddle import SimulatedPaddle
from hapticlab.errors import PaddleError

CURVE = {"duty_dead": 0.2, "duty_25": 0.35, "duty_50": 0.5, "duty_75": 0.7}
TYPES = {name: type for type, name, *_ in TABLE}


def record(**values):
    """A record with a right CRC-32 whatever is in it."""
    known = {f.name: getattr(settings(), f.name) for f in fields(Settings)} | {"wired": 0, "checked": 0} | values
    body = SETTINGS_STRUCT.pack(known.pop("layout", settings_hash()), *(known[n] for _, n, *_ in TABLE[1:-1]), 0)[:-4]
    return body + struct.pack("<I", zlib.crc32(body))


def board_takes(data):
    host = Host(wired=1, checked=1)
    host.hello()
    return host.load(data, "SETTINGS")


def python_takes(values):
    try:
        Settings(**{f.name: getattr(settings(), f.name) for f in fields(Settings)} | values)
    except PaddleError:
        return False
    return True


def test_a_record_goes_to_the_board_and_back_bit_for_bit():
    rng = random.Random(2)
    for _ in range(200):
        values = dict(
            ident=rng.randrange(1 << 16), date=rng.randrange(1 << 32), checked=rng.randrange(2), motor_sign=rng.choice((1, -1)),
            drive=rng.randrange(4), motor_pins=rng.getrandbits(32), sensor_pins=rng.getrandbits(32), carrier=rng.getrandbits(32),
            sensor_delay=rng.random(), sensor_noise=rng.random(), sensor_flight=rng.uniform(0, 0.01),
            **dict(zip(CURVE, sorted(rng.uniform(0, 0.5) for _ in CURVE), strict=True)),
            metres_per_count=rng.choice((1, -1)) * 10 ** rng.uniform(-7, -3), travel_min=-rng.random(), travel_max=rng.random(),
            wrap=rng.randrange(16, 16385), sensor=rng.randrange(3), motor_law=rng.randrange(3), heating_time=rng.uniform(1, 1e4),
            **{name: 10 ** rng.uniform(-5, 5) for name in ("force_full", "force_max", "force_continuous", "speed_max", "m", "b")},
        )  # fmt: skip
        kept = settings(**values)
        data = kept.to_bytes()
        host = Host(HostBoard())
        host.hello()
        assert host.load(changed(kept, wired=0, checked=0).to_bytes(), "SETTINGS") == "OK"  # a new board's wiring is confirmed
        assert host.load(data, "SETTINGS") == "OK"
        assert host.board.store[: len(data)] == data
        read = b"".join(host.ask("READ", at, 40)["rest"] for at in range(0, len(data), 40))
        assert read == data
        back = Settings.from_bytes(read)
        assert back == kept.to_float32() and back.to_bytes() == data
        for name, value in values.items():
            assert getattr(back, name) == (np.float32(value) if TYPES[name] == "f" else value)


@pytest.mark.parametrize("name", SETTING_RANGES)
def test_every_number_out_of_its_range_is_refused_by_the_board_and_by_python(name):
    low, high = (np.float32(a) for a in SETTING_RANGES[name])
    outside = [np.nextafter(low, np.float32(-np.inf)), np.nextafter(high, np.float32(np.inf)), np.nan, np.inf, -np.inf]
    for value in map(float, outside):
        assert board_takes(record(**{name: value})) == "RANGE", value
        assert not python_takes({name: value}), value


@pytest.mark.parametrize("values, good", [
    ({"metres_per_count": 0.0}, False), ({"metres_per_count": -0.0}, False), ({"metres_per_count": 1e-13}, False),
    ({"metres_per_count": 4e-10}, False), ({"metres_per_count": 6e-10}, True), ({"metres_per_count": -1e-5}, True),
    ({"travel_min": 0.05}, False), ({"travel_min": 0.06}, False), ({"travel_max": 0.06}, True),
    ({"motor_sign": 0}, False), ({"motor_sign": 2}, False), ({"motor_sign": -1}, True), ({"motor_law": 3}, False),
    ({"sensor": 3}, False), ({"sensor": 0, "wrap": 15}, False), ({"sensor": 0, "wrap": 16}, True),
    ({"sensor": 2, "wrap": 15}, False), ({"sensor": 0, "wrap": 16385}, False), ({"sensor": 2, "wrap": 16384}, True),
    ({"sensor": 1, "wrap": 0}, True),
    ({"heating_time": 0.999}, False), ({"m": -1e-9}, False), ({"force_full": 1e-40}, False), ({"drive": 4}, False),
    ({"motor_law": 2}, True), ({"motor_law": 2, "duty_dead": 0.25}, False), ({"motor_law": 2, "duty_50": 0.75}, False),
    ({"motor_law": 2, "duty_75": 1.0}, False), ({"motor_law": 1, "duty_75": 0.1}, True),
    ({"wired": 0, "checked": 1}, False), ({"wired": 1, "checked": 0}, True), ({"wired": 1, "checked": 1}, True),
])  # fmt: skip
def test_choices_and_relations_are_judged_alike_on_both_sides(values, good):
    assert board_takes(record(**values)) == ("OK" if good else "RANGE")
    assert python_takes({"wired": 0, "checked": 0} | values) == good


@pytest.mark.parametrize("values", [{"ident": -1}, {"ident": 1 << 16}, {"checked": 2}, {"date": 1 << 32}, {"wrap": -1},
                                    {"m": math.nan}, {"travel_min": -math.inf}, {"force_max": 1e39}])  # fmt: skip
def test_what_does_not_fit_the_record_is_refused_in_words(values):
    (name,) = values
    with pytest.raises(PaddleError, match=f"{name} = .* need"):
        settings(**values)


def test_a_flipped_bit_anywhere_is_no_settings():
    data = settings().to_bytes()
    for k in range(8 * len(data)):
        damaged = bytearray(data)
        damaged[k // 8] ^= 1 << k % 8
        assert Settings.from_bytes(bytes(damaged)) is None
        host = Host(HostBoard(bytes(damaged)))
        host.hello()
        assert not host.has("CALIBRATED")
        assert host.ask("HOME", 0.0) == "NOT_CALIBRATED"


CHANGES = [
    {"sensor": 2, "wrap": 16384}, {"drive": 1}, {"motor_pins": pin_word(9, 8)}, {"sensor_pins": pin_word(3, 2)},
    {"carrier": 31250},
]  # fmt: skip


@pytest.mark.parametrize("wiring", CHANGES, ids=str)
def test_another_wiring_is_taken_unconfirmed_only_and_gives_no_force_until_it_is_confirmed(wiring):
    """Before, any settings were taken into use, and the motor was driven on whatever pins and drive they named."""
    host = Host().ready()
    assert set(wiring) & set(WIRING)
    for confirmed in ({"wired": 1, "checked": 1}, {"wired": 1, "checked": 0}):
        assert host.load(settings(**wiring, **confirmed).to_bytes(), "SETTINGS") == "NOT_WIRED"
    assert host.load(settings(**wiring, wired=0, checked=0).to_bytes(), "SETTINGS") == "OK"
    assert host.load(spring()) == "OK" and host.set(_0=100.0) == "OK" and host.ask("HOME", 0.0) == "OK"
    assert host.start() == "NOT_WIRED" and host.start(passive=1) == "OK"
    assert host.tick(100) == 0 and host.ask("STOP") == "OK"
    assert host.load(settings(**wiring, wired=1, checked=0).to_bytes(), "SETTINGS") == "OK"
    assert host.load(spring()) == "OK" and host.set(_0=100.0) == "OK" and host.ask("HOME", 0.0) == "OK"
    assert host.start() == "OK" and host.tick() == 0 and host.tick(host.counts + 100) != 0


def test_a_wiring_changes_in_idle_only():
    host = Host().running()
    other = settings(drive=1, wired=0, checked=0).to_bytes()
    assert host.load(other, "SETTINGS") == "BUSY" and host.tick(100) != 0
    host.board.fail("SENSOR")
    assert host.load(other, "SETTINGS") == "FAULT" and host.tick() == 0
    assert host.load(settings(force_max=2.0).to_bytes(), "SETTINGS") == "OK"  # the same wiring
    assert host.ask("CLEAR") == "OK" and host.load(other, "SETTINGS") == "OK"


def test_a_new_board_starts_unconfirmed():
    host = Host(HostBoard())
    host.hello()
    assert host.load(settings().to_bytes(), "SETTINGS") == "NOT_WIRED" and not host.has("CALIBRATED")
    assert host.load(settings(wired=0, checked=0).to_bytes(), "SETTINGS") == "OK" and host.has("CALIBRATED")
    assert host.load(settings().to_bytes(), "SETTINGS") == "OK" and host.has("SIGN_CHECKED")


def test_another_layout_is_not_taken_for_this_one():
    assert Settings.from_bytes(record(layout=settings_hash() ^ 1)) is None
    assert board_takes(record(layout=settings_hash() ^ 1)) == "RANGE"
    assert board_takes(record()[:-4]) == "LENGTH"


@pytest.mark.parametrize("dead", [0.0, 0.2])
@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("law", MOTOR_LAWS)
def test_a_duty_is_the_laws_and_python_undoes_it(law, sign, dead):
    """The board's duty for a force against numpy's of the law, and the force that Python makes of it."""
    motor = {"motor_law": MOTOR_LAWS[law], "motor_sign": sign, "force_max": 8.0, **CURVE, "duty_dead": dead}
    kept = settings(speed_max=1e3, **motor)
    host = Host(HostBoard(kept.to_bytes())).running(_0=200.0)
    for counts in (-3990, -3000, -1234, -1000, -10, 0, 10, 333, 2000, 3990):
        duty, part = host.tick(counts), min(abs(200.0 * counts * 1e-5) / 8.0, 1.0)
        host.tick(counts, beat=True)
        expected = {
            "LINEAR": dead + (1 - dead) * part,
            "SQRT": dead + (1 - dead) * np.sqrt(part),
            "MEASURED": np.interp(part, [0, 0.25, 0.5, 0.75, 1], [dead, 0.35, 0.5, 0.7, 1]),
        }[law] * (part > 0)
        assert abs(duty) == pytest.approx(expected, abs=1 / 32767) and duty * counts * sign <= 0
        assert kept.duty(-200.0 * counts * 1e-5) == pytest.approx(duty, abs=1 / 32767)
        steep = 8.0 / 32767 * {"SQRT": 2, "MEASURED": 0.25 / 0.15}.get(law, 1) / (1 - dead)
        assert kept.force_of_duty(duty) == pytest.approx(-200.0 * counts * 1e-5, abs=steep)


def test_no_force_is_within_the_dead_band():
    kept = settings(duty_dead=0.2)
    assert kept.duty(0.0) == 0 and [kept.force_of_duty(d) for d in (0.0, 0.1, 0.2, -0.2)] == [0] * 4
    assert kept.force_of_duty(1.0) == 8.0 and kept.duty(1e9) == 1.0 and kept.duty(-1e-9) == pytest.approx(-0.2)


def test_every_profile_makes_settings_or_says_why_not():
    assert nominal("hapkit").is_nominal and not changed(nominal("hapkit"), date=20261121).is_nominal
    with pytest.raises(PaddleError, match="no nominal settings for 'eth'; they exist for .*hapkit, "):
        nominal("eth")
    with pytest.raises(PaddleError, match="stiffness is not a setting; the settings are ident"):
        changed(nominal("hapkit"), stiffness=1)
    for name in PROFILES:
        assert board_takes(simulated(SimulatedPaddle.from_profile(name)).to_bytes()) == "OK"


def test_print_shows_every_field_with_its_unit():
    text = str(settings())
    assert all(name in text for name in SETTINGS) and "N s/m" in text and "nominal" in text
    assert isinstance(str(settings(date=20261121)), str) and "nominal" not in str(settings(date=20261121))


def test_settings_are_printed_as_people_call_them_with_every_digit():
    """A date of eight digits and the four bytes of pins are no measurements, to be rounded to seven digits."""
    kept = nominal("longhorn", ident=0x3F2A, date=20261120, wired=1)
    printed = {line.split()[0]: line[18:36].strip() for line in str(kept).splitlines()}
    assert (printed["ident"], printed["date"], printed["motor_pins"], printed["sensor_pins"]) == (
        "3F2A",
        "20261120",
        "4, 5, 11",
        "2, 3",
    )
    assert (printed["sensor"], printed["drive"], printed["motor_law"]) == ("QUADRATURE", "TWO_INPUTS_ENABLE", "LINEAR")
    assert (printed["carrier"], printed["metres_per_count"]) == ("31372", "0.0007417649")
    assert "TWO_INPUTS_ENABLE" in kept._repr_html_() and "4, 5, 11" in kept._repr_html_()
