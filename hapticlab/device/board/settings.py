"""What a board keeps over power-off: its calibration, its limits, its name."""

import math
import re
import zlib
from bisect import bisect
from dataclasses import dataclass, fields, replace

from ...base.facts import Fact
from ...base.profile.paddle_profile import PaddleProfile
from ...base.shows_itself import ShowsItself
from ...errors import PaddleError
from ..device import Device
from ..link.messages import (
    COUNTS_MAX,
    DRIVES,
    METRES_PER_COUNT_MIN,
    MOTOR_LAWS,
    NO_PIN,
    SENSORS,
    SETTING_RANGES,
    SETTINGS,
    SETTINGS_STRUCT,
    WRAP_MAX,
    WRAP_MIN,
    settings_hash,
)
from ..profiles import profile as named_profile

_CHOICES = {
    "ident": range(1 << 16), "date": range(1 << 32), "checked": (0, 1), "wired": (0, 1), "motor_sign": (1, -1),
    "motor_law": tuple(MOTOR_LAWS.values()), "sensor": tuple(SENSORS.values()), "drive": tuple(DRIVES.values()),
    "wrap": range(1 << 16), "carrier": range(1 << 32), "motor_pins": range(1 << 32), "sensor_pins": range(1 << 32),
}  # fmt: skip


def pin_word(*pins):
    """Return up to four pins as settings keep them: one a byte, the first one lowest, the others none.

    Examples
    --------
    >>> from hapticlab.device.board.settings import pin_word, pins_of
    >>> pins_of(pin_word(5, 8))
    (5, 8)
    """
    return int.from_bytes(bytes(pins).ljust(4, bytes([NO_PIN])), "little")


def pins_of(word):
    """Return the pins in a setting, without those that are none."""
    return tuple(pin for pin in word.to_bytes(4, "little") if pin != NO_PIN)


#: of an encoder, or of an angle sensor that nobody named
NO_PINS = pin_word()
#: duties at a quarter, half and three quarters of the force
CURVE = ("duty_25", "duty_50", "duty_75")
_DAY = re.compile(r"\b(\d{4})-(\d\d)-(\d\d)\b")


def day_in_words(date):
    """Return the day of a calibration, as settings keep it.

    Examples
    --------
    >>> day_in_words(20261120)
    '2026-11-20'
    """
    day = str(date)
    return f"{day[:4]}-{day[4:6]}-{day[6:]}"


@dataclass(frozen=True, kw_only=True)
class Settings(ShowsItself):
    """The record a board keeps; units and meanings are in messages.SETTINGS, and ``print`` shows them.

    Examples
    --------
    >>> from hapticlab.device.board.settings import Settings, nominal
    >>> kept = nominal("hapkit")
    >>> Settings.from_bytes(kept.to_bytes()).travel_max == kept.to_float32().travel_max
    True
    """

    ident: int = 0
    date: int = 0
    checked: int = 0
    metres_per_count: float
    travel_min: float
    travel_max: float
    force_full: float
    force_max: float
    force_continuous: float
    heating_time: float
    speed_max: float
    motor_law: int = MOTOR_LAWS["LINEAR"]
    motor_sign: int = 1
    duty_dead: float = 0.0
    duty_25: float = 0.25
    duty_50: float = 0.5
    duty_75: float = 0.75
    sensor: int = SENSORS["QUADRATURE"]
    wrap: int = 1024
    drive: int = DRIVES["PWM_DIRECTION"]
    motor_pins: int = NO_PINS
    sensor_pins: int = NO_PINS
    carrier: int = 62500
    wired: int = 0
    m: float = 0.0
    b: float = 0.0
    coulomb: float = 0.0
    sensor_delay: float = 0.0
    sensor_noise: float = 0.0
    sensor_flight: float = 0.0

    def __post_init__(self):
        for name, (low, high) in SETTING_RANGES.items():
            value = getattr(self, name)
            if not low <= value <= high:
                raise PaddleError(f"{name} = {value:g}; a setting of a board needs {low:g} to {high:g}. Calibrate again.")
        step = abs(self.metres_per_count)
        if step < METRES_PER_COUNT_MIN:
            raise PaddleError(f"metres_per_count = {self.metres_per_count:g}; needs at least {METRES_PER_COUNT_MIN:g}.")
        if not self.travel_min < self.travel_max:
            raise PaddleError(f"travel from {self.travel_min:g} to {self.travel_max:g} m; needs the lower stop first.")
        counts = max(-self.travel_min, self.travel_max, key=abs) / step
        if not abs(counts) < COUNTS_MAX:
            raise PaddleError(f"a stop at {counts:g} counts; a board counts to {COUNTS_MAX:g}: use a coarser encoder.")
        for name, allowed in _CHOICES.items():
            if getattr(self, name) not in allowed:
                raise PaddleError(f"{name} = {getattr(self, name)!r}; needs {_spoken(allowed)}.")
        if self.sensor != SENSORS["QUADRATURE"] and not WRAP_MIN <= self.wrap <= WRAP_MAX:
            raise PaddleError(f"wrap = {self.wrap}; an angle sensor needs {WRAP_MIN} to {WRAP_MAX} counts until it repeats.")
        curve = self._curve()
        if self.motor_law == MOTOR_LAWS["MEASURED"] and any(a >= b for a, b in zip(curve, curve[1:], strict=False)):
            raise PaddleError(
                f"duty_dead, duty_25, duty_50, duty_75 = {', '.join(f'{a:g}' for a in curve[:-1])}; a larger force needs a "
                "larger duty, and the largest stays below 1. Measure the force again."
            )
        if self.checked > self.wired:
            raise PaddleError(
                "checked = 1 with wired = 0; the motor's sign is checked after its wiring is confirmed. Use checked=0, or "
                "wired=1 where the wiring was confirmed."
            )

    def to_bytes(self):
        """Return the record as a board keeps it, its CRC-32 at the end."""
        names = [name for _, name, *_ in SETTINGS[1:-1]]
        body = SETTINGS_STRUCT.pack(settings_hash(), *(getattr(self, name) for name in names), 0)[:-4]
        return body + zlib.crc32(body).to_bytes(4, "little")

    @classmethod
    def from_bytes(cls, data):
        """Return the settings in a board's record, or None where it holds none of this layout."""
        values = dict(zip((name for _, name, *_ in SETTINGS), SETTINGS_STRUCT.unpack(data), strict=True))
        if values.pop("layout") != settings_hash() or values.pop("crc") != zlib.crc32(data[:-4]):
            return None
        return cls(**values)

    def to_float32(self):
        """Return the settings with every number rounded as a board keeps it."""
        return Settings.from_bytes(self.to_bytes())

    @property
    def is_nominal(self):
        """Whether nothing in it was measured on this very paddle."""
        return self.date == 0

    def device(self, T):
        """Return what limits read of a paddle that samples every T [s]; its mass and damping only once they were identified."""
        counts = 1 / abs(self.metres_per_count)
        known = {"m": self.m, "b": self.b, "coulomb": self.coulomb, "counts_per_metre": counts} if self.m else {}
        return Device(T=T, sensor_delay=self.sensor_delay, **known)

    def profile(self, T):
        """Return what simulated paddles and limits take of a paddle that samples every T [s]; its mass has to be known."""
        if not self.m:
            raise PaddleError("m = 0 in the board's settings, so its mass is not known. Identify it: hl.identify.paddle(paddle)")
        measured = self.motor_law == MOTOR_LAWS["MEASURED"]
        built = {kind: (usual["sensor"], usual.get("drive", Settings.drive)) for kind, usual in NOMINAL.items()}
        wiring = next((named_profile(kind).wiring for kind, one in built.items() if one == (self.sensor, self.drive)), "")
        curve = {name: getattr(self, name) for name in CURVE} if measured else {}
        return PaddleProfile(
            f"board {self.ident:04X}", T=T, counts_per_metre=1 / abs(self.metres_per_count), nominal=self.is_nominal,
            wiring=wiring,
            source="settings of a board" + ("" if self.is_nominal else f", calibrated on {day_in_words(self.date)}"),
            **{name: getattr(self, name) for name in _OF_PROFILE}, **curve,
        )  # fmt: skip

    def duty(self, force, steps=None):
        """Return the duty, -1 ... 1, that a board gives for a force at the handle [N]; rounded where it has so many steps."""
        part = min(abs(force) / self.force_full, 1.0)
        if part == 0:
            return 0.0
        if self.motor_law == MOTOR_LAWS["MEASURED"]:
            duty = _between(_PARTS, self._curve(), part)
        else:
            duty = self.duty_dead + (1 - self.duty_dead) * (part**0.5 if self.motor_law == MOTOR_LAWS["SQRT"] else part)
        duty = duty if steps is None else int(duty * steps + 0.5) / steps
        return math.copysign(duty, force) * self.motor_sign

    def force_of_duty(self, duty):
        """Return the force [N] at the handle of a duty in -1 ... 1, the motor's law undone; none within its dead band."""
        part, dead = min(abs(duty), 1.0), self.duty_dead
        if part <= dead:
            return 0.0
        if self.motor_law == MOTOR_LAWS["MEASURED"]:
            part = _between(self._curve(), _PARTS, part)
        else:
            part = (part - dead) / (1 - dead)
            part = part * part if self.motor_law == MOTOR_LAWS["SQRT"] else part
        return math.copysign(part * self.force_full, duty) * self.motor_sign

    def _curve(self):
        return self.duty_dead, self.duty_25, self.duty_50, self.duty_75, 1.0

    def _sentence(self):
        found = "nominal constants, nothing measured on this paddle" if self.is_nominal else f"calibrated on {self.date}"
        return f"what a board keeps of paddle {self.ident:04X}: {found}"

    def _facts(self):
        return [Fact(name, _in_words(name, getattr(self, name)), unit, meaning) for _, name, unit, meaning in SETTINGS[1:-1]]

    def __str__(self):
        rows = {name: (unit, meaning) for _, name, unit, meaning in SETTINGS}
        shown = {f.name: _in_words(f.name, getattr(self, f.name)) for f in fields(self)}
        lines = [
            f"{name:<17} {f'{value:.7g}' if isinstance(value, float) else value:<17} "
            f"{'' if rows[name][0] == '1' else rows[name][0]:<6} {rows[name][1]}"
            for name, value in shown.items()
        ]
        return "\n".join([*lines, "nominal: no value here was measured on this paddle"] if self.is_nominal else lines)


def _in_words(name, value):
    """Return what a number of the settings stands for: a paddle's name, pins, or a row of a table; else the number."""
    if name == "ident":
        return f"{value:04X}"
    if name in ("motor_pins", "sensor_pins"):
        return ", ".join(map(str, pins_of(value))) or "none"
    table = {"sensor": SENSORS, "drive": DRIVES, "motor_law": MOTOR_LAWS}.get(name, {})
    return next((word for word, number in table.items() if number == value), value)


#: of the full force, along the measured curve
_PARTS = (0.0, 0.25, 0.5, 0.75, 1.0)


def _between(xs, ys, x):
    """Return y at x, on straight lines between points."""
    k = min(max(bisect(xs, x), 1), len(xs) - 1)
    return ys[k - 1] + (x - xs[k - 1]) * (ys[k] - ys[k - 1]) / (xs[k] - xs[k - 1])


#: what the profiles do not say: travel, heating and speed are guesses that keep a motor cool
_USUAL = {"travel_min": -0.05, "travel_max": 0.05, "heating_time": 60.0, "speed_max": 2.0}
#: and for each its wiring, which is that of its build in wirings.py. Hapkits: the square-root law is of the published
#: sketches, and the KMA210 has nominally 920 counts per half turn
NOMINAL = {
    "hapkit": {
        "force_continuous": 2.0, "motor_law": MOTOR_LAWS["SQRT"], "sensor": SENSORS["MAGNETORESISTIVE"], "wrap": 920,
        "motor_pins": pin_word(5, 8),
    },
    "hapkit_as5048a": {
        "force_continuous": 1.5, "motor_law": MOTOR_LAWS["SQRT"], "sensor": SENSORS["AS5048A"], "wrap": 16_384,
        "motor_pins": pin_word(5, 8),
    },
    "longhorn": {
        "force_continuous": 1.0, "sensor": SENSORS["QUADRATURE"], "drive": DRIVES["TWO_INPUTS_ENABLE"],
        "motor_pins": pin_word(4, 5, 11),
    },
    "motor_shield": {
        "force_continuous": 1.0, "sensor": SENSORS["QUADRATURE"], "drive": DRIVES["SHIFT_REGISTER"],
        "motor_pins": pin_word(11, 12, 4, 8), "speed_max": 0.5,  # 41 000 edges a second, of which an Uno counts 82 000
    },
}  # fmt: skip
#: of a profile and of settings, by the same name
_OF_PROFILE = (
    "force_max",
    "force_full",
    "m",
    "b",
    "coulomb",
    "duty_dead",
    "carrier",
    "sensor_delay",
    "sensor_noise",
    "sensor_flight",
)
#: where a Hapkit has its sensor (A2), and an Uno an encoder or the chip select of an AS5048A instead
_SENSOR_PINS = {"MAGNETORESISTIVE": pin_word(16), "QUADRATURE": pin_word(2, 3), "AS5048A": pin_word(10)}


def _spoken(allowed):
    if isinstance(allowed, range):
        return f"a whole number from {allowed[0]} to {allowed[-1]}"
    return " or ".join(map(str, allowed))


def nominal(profile, **changes):
    """Return nominal settings for a kind of paddle: nothing in them was measured on the very device.

    Parameters
    ----------
    profile : {"hapkit", "hapkit_as5048a", "longhorn", "motor_shield"}
    **changes
        Fields that are known better.
    """
    if profile not in NOMINAL:
        raise PaddleError(f"no nominal settings for {profile!r}; they exist for {', '.join(NOMINAL)}.")
    return _settings(named_profile(profile), **{**NOMINAL[profile], **changes})


def of_profile(kind):
    """Return what the board of a paddle with this profile keeps; None if no kind has its wiring, or its drive is not known."""
    usual = next((name for name in NOMINAL if named_profile(name).wiring == kind.wiring), None)
    if usual is None or None in (kind.counts_per_metre, kind.force_max, kind.force_full, kind.carrier):
        return None
    curve = {name: getattr(kind, name) for name in CURVE if kind.duty_25 is not None}
    values = {**NOMINAL[usual], **curve, "carrier": int(kind.carrier), "date": _day_of(kind), "wired": 1, "checked": 1}
    values |= {"motor_law": MOTOR_LAWS["MEASURED"]} if curve else {}
    values["force_continuous"] = min(values["force_continuous"], kind.force_max)
    return _settings(kind, **values)


def _settings(kind, **values):
    known = {"metres_per_count": 1 / kind.counts_per_metre, **{name: getattr(kind, name) for name in _OF_PROFILE}}
    values = {**known, **_USUAL, **values}
    usual = {SENSORS[name]: pins for name, pins in _SENSOR_PINS.items()}.get(values["sensor"], NO_PINS)
    return Settings(**{"sensor_pins": usual, **values})


def _day_of(kind):
    """The last day on which a constant of a profile was measured, as a number of a board's settings; 0 if none was."""
    if kind.nominal:
        return 0
    told = " ".join([kind.source, *(one.source for one in kind.estimates)])
    return max((int("".join(day)) for day in _DAY.findall(told)), default=0)


def simulated(paddle):
    """Return the settings of a board around a simulated paddle: ideal where the paddle says nothing."""
    full = paddle.force_full or paddle.force_max or 20.0
    curve = {name: getattr(paddle, name) for name in CURVE if paddle.duty_25 is not None}
    return Settings(
        **curve,
        motor_law=MOTOR_LAWS["MEASURED" if curve else "LINEAR"],
        duty_dead=paddle.duty_dead,
        sensor_delay=paddle.sensor_delay,
        sensor_noise=paddle.noise,
        date=_day_of(paddle.profile) if paddle.profile else 0,
        wired=1,
        checked=1,
        metres_per_count=1 / (paddle.counts_per_metre or 1e7),  # without an encoder a tenth of a micrometre
        travel_min=-0.5, travel_max=0.5, force_full=full, force_max=paddle.force_max or full, force_continuous=full,
        heating_time=60.0, speed_max=10.0, m=paddle.m, b=paddle.b, coulomb=paddle.coulomb,
    )  # fmt: skip


def changed(settings, **values):
    """Return the settings with some fields replaced; a misspelt one is refused."""
    unknown = sorted(set(values) - {f.name for f in fields(Settings)})
    if unknown:
        raise PaddleError(f"{unknown[0]} is not a setting; the settings are {', '.join(f.name for f in fields(Settings))}.")
    return replace(settings, **values)
