"""Settings: the board's bytes and Python's, bit for bit; what either refuses, the other refuses too."""

import math
import random
import struct
import zlib
from dataclasses import fields

import numpy as np
import pytest
from host_driver import SETTINGS, Host, settings

from hapticlab.device.board.host_board import HostBoard
from hapticlab.device.board.settings import Settings, changed, nominal, simulated
from hapticlab.device.link.messages import SETTING_RANGES, SETTINGS_STRUCT, settings_hash
from hapticlab.device.link.messages import SETTINGS as TABLE
from hapticlab.device.profiles import PROFILES
from hapticlab.device.simulated.simulated_paddle import SimulatedPaddle
from hapticlab.errors import PaddleError

TYPES = {name: type for type, name, *_ in TABLE}


def record(**values):
    """A record with a right CRC-32 whatever is in it."""
    known = {f.name: getattr(settings(), f.name) for f in fields(Settings)} | values
    body = SETTINGS_STRUCT.pack(known.pop("layout", settings_hash()), *(known[n] for _, n, *_ in TABLE[1:-1]), 0)[:-4]
    return body + struct.pack("<I", zlib.crc32(body))


def board_takes(data):
    host = Host()
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
            metres_per_count=rng.choice((1, -1)) * 10 ** rng.uniform(-7, -3), travel_min=-rng.random(), travel_max=rng.random(),
            wrap=rng.randrange(16, 4097), sensor=rng.randrange(2), motor_law=rng.randrange(2), heating_time=rng.uniform(1, 1e4),
            **{name: 10 ** rng.uniform(-5, 5) for name in ("force_full", "force_max", "force_continuous", "speed_max", "m", "b")},
        )  # fmt: skip
        kept = settings(**values)
        data = kept.to_bytes()
        host = Host(HostBoard())
        host.hello()
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
    ({"motor_sign": 0}, False), ({"motor_sign": 2}, False), ({"motor_sign": -1}, True), ({"motor_law": 2}, False),
    ({"sensor": 2}, False), ({"sensor": 0, "wrap": 15}, False), ({"sensor": 0, "wrap": 16}, True),
    ({"sensor": 0, "wrap": 4097}, False), ({"sensor": 1, "wrap": 0}, True), ({"heating_time": 0.999}, False),
    ({"m": -1e-9}, False), ({"force_full": 1e-40}, False), ({"checked": 0}, True),
])  # fmt: skip
def test_choices_and_relations_are_judged_alike_on_both_sides(values, good):
    assert board_takes(record(**values)) == ("OK" if good else "RANGE")
    assert python_takes(values) == good


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


def test_another_layout_is_not_taken_for_this_one():
    assert Settings.from_bytes(record(layout=settings_hash() ^ 1)) is None
    assert board_takes(record(layout=settings_hash() ^ 1)) == "RANGE"
    assert board_takes(record()[:-4]) == "LENGTH"


def test_force_of_duty_undoes_the_boards_law():
    """The board's duty for a force, and the force Python makes of it, over laws and signs."""
    for law in (0, 1):
        for sign in (1, -1):
            kept = settings(motor_law=law, motor_sign=sign, force_full=8.0)
            host = Host(motor_law=law, motor_sign=sign, force_full=8.0, speed_max=1e3).running(_0=100.0)
            for counts in (-3900, -1000, -10, 0, 10, 333, 3900):
                duty = host.tick(counts)
                F = np.clip(100.0 * counts * 1e-5, -4, 4)
                assert kept.force_of_duty(duty) == pytest.approx(-F, abs=8.0 / 32767)
                host.tick(counts, beat=True)


def test_every_profile_makes_settings_or_says_why_not():
    assert nominal("hapkit").is_nominal and not changed(nominal("hapkit"), date=20261121).is_nominal
    with pytest.raises(PaddleError, match="no nominal settings for 'eth'; they exist for hapkit."):
        nominal("eth")
    with pytest.raises(PaddleError, match="stiffness is not a setting; the settings are ident"):
        changed(nominal("hapkit"), stiffness=1)
    for name in PROFILES:
        assert board_takes(simulated(SimulatedPaddle.from_profile(name)).to_bytes()) == "OK"


def test_print_shows_every_field_with_its_unit():
    text = str(settings())
    assert all(name in text for name in SETTINGS) and "N s/m" in text and "nominal" in text
    assert isinstance(str(settings(date=20261121)), str) and "nominal" not in str(settings(date=20261121))
