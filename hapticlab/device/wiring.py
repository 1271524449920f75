"""A wiring: which sensor and driver a paddle has, on which pins of its board; what a board cannot do is rejected in words."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import groupby
from typing import TYPE_CHECKING

from ..base.shows_itself import ShowsItself
from ..errors import PaddleError
from .board.settings import pin_word, pins_of
from .link.messages import DRIVES, NO_PIN, SENSORS

if TYPE_CHECKING:
    from ..compiler.boards.board_records import Board
    from .board.settings import Settings

#: what each pin of a drive does, in the order of the setting motor_pins; and in words, what the driver is
DRIVE_ROLES = {
    "PWM_DIRECTION": ("PWM", "DIR"),
    "TWO_INPUTS": ("IN1", "IN2"),
    "TWO_INPUTS_ENABLE": ("IN1", "IN2", "EN"),
    "SHIFT_REGISTER": ("PWM", "LATCH", "CLK", "DATA"),
}
DRIVE_WORDS = {
    "PWM_DIRECTION": "PWM and direction, as on the Hapkit board",
    "TWO_INPUTS": "two inputs, one of them with PWM, such as a DRV8871",
    "TWO_INPUTS_ENABLE": "two inputs and an enable with PWM, such as an L298 or L293D",
    "SHIFT_REGISTER": "a motor shield with a 74HC595, such as Adafruit's version 1",
}
#: the roles that carry PWM
WITH_PWM = {
    "PWM_DIRECTION": ("PWM",), "TWO_INPUTS": ("IN1", "IN2"), "TWO_INPUTS_ENABLE": ("EN",), "SHIFT_REGISTER": ("PWM",),
}  # fmt: skip
SENSOR_ROLES = {"MAGNETORESISTIVE": ("OUT",), "QUADRATURE": ("A", "B"), "AS5048A": ("CSn",)}
SENSOR_WORDS = {
    "MAGNETORESISTIVE": "an analog magnet sensor, such as the KMA210 of the Hapkit",
    "QUADRATURE": "a quadrature encoder with lines A and B",
    "AS5048A": "an AS5048A magnet sensor over SPI",
}
#: pins that are listed one by one
FEW = 8


@dataclass(frozen=True)
class Wiring(ShowsItself):
    """How sensor and driver are wired to a board.

    Attributes
    ----------
    sensor : {"MAGNETORESISTIVE", "QUADRATURE", "AS5048A"}
    drive : {"PWM_DIRECTION", "TWO_INPUTS", "TWO_INPUTS_ENABLE", "SHIFT_REGISTER"}
    motor_pins, sensor_pins : tuple of int
        Numbers of the board's pins, in the order of :data:`DRIVE_ROLES` and :data:`SENSOR_ROLES`: on an Uno D0 to D13 are
        0 to 13 and A0 to A5 are 14 to 19, on a Pico they are the GP numbers.
    carrier : int
        Frequency of the PWM [Hz].

    Raises
    ------
    PaddleError
        If there is no such sensor or drive, or the number of pins is not the one that it needs.

    Examples
    --------
    >>> from hapticlab.device.wiring import Wiring
    >>> print(Wiring("QUADRATURE", "PWM_DIRECTION", motor_pins=(5, 8), sensor_pins=(2, 3)))
    sensor QUADRATURE (A 2, B 3), drive PWM_DIRECTION (PWM 5, DIR 8), PWM of 62500 Hz
    """

    sensor: str
    drive: str
    motor_pins: tuple[int, ...]
    sensor_pins: tuple[int, ...]
    carrier: int = 62_500

    def __post_init__(self) -> None:
        for name, table in (("sensor", SENSOR_ROLES), ("drive", DRIVE_ROLES)):
            if getattr(self, name) not in table:
                raise PaddleError(f"{name} = {getattr(self, name)!r}; needs one of {', '.join(table)}.")
        for name, roles in (("motor_pins", self.motor_roles), ("sensor_pins", self.sensor_roles)):
            pins = tuple(getattr(self, name))
            if len(pins) != len(roles) or not all(isinstance(pin, int) and 0 <= pin < NO_PIN for pin in pins):
                kind = self.drive if name == "motor_pins" else self.sensor
                raise PaddleError(f"{name} = {pins}; {kind} needs {len(roles)} pins: {', '.join(roles)}.")
            object.__setattr__(self, name, pins)

    @property
    def motor_roles(self) -> tuple[str, ...]:
        """What each of motor_pins does."""
        return DRIVE_ROLES[self.drive]

    @property
    def sensor_roles(self) -> tuple[str, ...]:
        """What each of sensor_pins does."""
        return SENSOR_ROLES[self.sensor]

    def pins(self) -> dict[str, int]:
        """Return the pin of each role of driver and sensor, such as {"PWM": 5, "DIR": 8, "OUT": 16}."""
        roles, pins = self.motor_roles + self.sensor_roles, self.motor_pins + self.sensor_pins
        return dict(zip(roles, pins, strict=True))

    def settings(self) -> dict[str, int]:
        """Return the fields of a board's settings that say this wiring.

        Examples
        --------
        >>> from hapticlab.device.wiring import Wiring
        >>> hex(Wiring("QUADRATURE", "PWM_DIRECTION", (5, 8), (2, 3)).settings()["motor_pins"])
        '0xffff0805'
        """
        kinds = {"sensor": SENSORS[self.sensor], "drive": DRIVES[self.drive], "carrier": self.carrier}
        return {**kinds, "motor_pins": pin_word(*self.motor_pins), "sensor_pins": pin_word(*self.sensor_pins)}

    @classmethod
    def of(cls, settings: Settings) -> Wiring:
        """Return the wiring that a board's settings say."""
        sensor = next(name for name, number in SENSORS.items() if number == settings.sensor)
        drive = next(name for name, number in DRIVES.items() if number == settings.drive)
        pins = pins_of(settings.motor_pins), pins_of(settings.sensor_pins)
        return cls(sensor, drive, *pins, carrier=settings.carrier)

    def __str__(self) -> str:
        sensor, motor = (
            ", ".join(f"{role} {pin}" for role, pin in zip(roles, pins, strict=True))
            for roles, pins in ((self.sensor_roles, self.sensor_pins), (self.motor_roles, self.motor_pins))
        )
        return f"sensor {self.sensor} ({sensor}), drive {self.drive} ({motor}), PWM of {self.carrier} Hz"


def require_possible(wiring: Wiring, board: Board) -> None:
    """Reject a wiring that a board cannot do.

    Raises
    ------
    PaddleError
        With what was given, what the board can do, and what to do.

    Examples
    --------
    >>> from hapticlab.compiler.boards.board_records import UNO
    >>> from hapticlab.device.wiring import Wiring, require_possible
    >>> require_possible(Wiring("QUADRATURE", "PWM_DIRECTION", (9, 8), (2, 3)), UNO)
    Traceback (most recent call last):
        ...
    hapticlab.errors.PaddleError: PWM on D9: an Uno has PWM on D3, D5, D6, D11. Move this wire to one of them.
    """
    if board.pins is None:
        raise PaddleError(f"{board.name} has no pins that this package drives. Choose another board.")
    problem = pin_problem(wiring, board.pins)
    if problem:
        given, needed, cure = problem
        raise PaddleError(f"{given}: {board.flashing.called if board.flashing else f'a {board.name}'} {needed}. {cure}.")


def pin_problem(wiring, pins):
    """Return the first thing that a board cannot do, as what was given, what it can do and what to do; None if there is none."""
    at = wiring.pins()
    for role, pin in at.items():
        if pin not in pins.names or pin in pins.busy:
            why = f"uses {pins.name(pin)} for {pins.busy[pin]}" if pin in pins.busy else f"has {_listed(pins, pins.names)}"
            return f"{role} on {pins.name(pin)}", why, "Move this wire to another pin"
    fixed = dict(pins.spi) if wiring.sensor == "AS5048A" else {}
    fixed |= {k: pin for k, pin in pins.register.items() if wiring.drive == "SHIFT_REGISTER" and k not in at}
    used = list((at | fixed).items())
    for k, (role, pin) in enumerate(used):
        twice = [other for other, taken in used[k + 1 :] if taken == pin]
        if twice:
            return f"{role} and {twice[0]} on {pins.name(pin)}", "takes one wire per pin", "Move one of them to another pin"
    for role in WITH_PWM[wiring.drive]:
        if at[role] not in pins.pwm:
            return f"{role} on {pins.name(at[role])}", f"has PWM on {_listed(pins, pins.pwm)}", "Move this wire to one of them"
    return _of_drive(wiring, pins, at) or _of_sensor(wiring, pins, at) or _of_carrier(wiring, pins)


def _of_drive(wiring, pins, at):
    if wiring.drive != "SHIFT_REGISTER":
        return None
    if at["PWM"] not in pins.shield:
        fits = ", ".join(f"{pins.name(pin)} ({motor})" for pin, motor in pins.shield.items())
        return f"a motor shield on {pins.name(at['PWM'])}", f"takes a shield's motor on {fits or 'no pin'}", "Choose one of them"
    for role in ("LATCH", "CLK", "DATA"):
        if at[role] != pins.register[role]:
            own = f"has the shield's {role} on {pins.name(pins.register[role])}"
            return f"{role} on {pins.name(at[role])}", own, "Choose this pin"
    return None


def _of_sensor(wiring, pins, at):
    if wiring.sensor == "MAGNETORESISTIVE" and at["OUT"] not in pins.analog:
        where = f"reads voltages on {_listed(pins, pins.analog)}"
        return f"OUT on {pins.name(at['OUT'])}", where, "Move this wire to one of them"
    if wiring.sensor == "QUADRATURE" and (at["A"], at["B"]) not in pins.quadrature:
        pairs = [f"{pins.name(a)} and {pins.name(b)}" for a, b in pins.quadrature]
        few = ", or ".join(pairs) if len(pairs) <= 3 else f"pairs such as {pairs[0]}, or {pairs[1]}"
        given = f"A on {pins.name(at['A'])} and B on {pins.name(at['B'])}"
        return given, f"counts an encoder on {few}, in this order", "Move these wires there"
    return None


def _of_carrier(wiring, pins):
    high, low = pins.carriers[0], pins.carriers[-1]
    if low <= wiring.carrier <= high:
        return None
    return f"PWM of {wiring.carrier} Hz", f"has {low} Hz to {high} Hz", f"Choose one of {', '.join(map(str, pins.carriers))}"


def _listed(pins, numbers):
    """Return the names of pins, many of a kind as a range."""
    names = [pins.names[k] for k in sorted(numbers) if k not in pins.busy]
    if len(names) <= FEW:
        return ", ".join(names)
    kinds = [list(kind) for _, kind in groupby(names, lambda name: name.rstrip("0123456789"))]
    return ", ".join(f"{kind[0]} to {kind[-1]}" for kind in kinds)
