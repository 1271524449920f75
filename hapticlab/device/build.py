"""A paddle as it is built: board, wiring and parts, and every wire of it by name."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from ..base.shows_itself import ShowsItself
from ..compiler.boards.board_pins import PINS, Pins
from .wiring import WITH_PWM, Wiring

#: of a driver, on every drawing and table
OUTPUTS, SUPPLY = ("OUT1", "OUT2"), ("V+", "GND")


@dataclass(frozen=True)
class Wire:
    """One wire: the part and the terminal at either end, what it carries, and whether it is already there.

    Attributes
    ----------
    begin, end : (str, str)
        Part, "board", "driver", "sensor", "motor" or "supply", and its terminal.
    carries : {"signal", "ground", "sensor supply", "motor"}
    fixed : bool
        True for a trace of a circuit board, or a plug of a shield: nothing to wire.
    """

    begin: tuple[str, str]
    end: tuple[str, str]
    carries: str
    fixed: bool = False


@dataclass(frozen=True, kw_only=True, eq=False)
class Build(ShowsItself):
    """A paddle as it is built: board, wiring, and the parts by their names.

    Attributes
    ----------
    name : str
    title : str
        What it is, in words.
    board : str
        Of hapticlab.compiler.boards.board_pins.PINS.
    wiring : Wiring
    driver, sensor : str
        The parts.
    source : str
        Where the pins are published, or that they are illustrative.
    notes : tuple of str
        What a person who wires it must know.
    plugged : tuple of str
        Parts that are on the board or plugged onto it: "driver", "sensor".
    marked : dict of str to str
        Terminals of driver and sensor that have another name printed beside them.
    """

    name: str
    title: str
    board: str
    wiring: Wiring
    driver: str
    sensor: str
    source: str
    notes: tuple[str, ...] = ()
    plugged: tuple[str, ...] = ()
    marked: Mapping[str, str] = field(default_factory=dict)

    @property
    def pins(self) -> Pins:
        """What its board can do with its pins."""
        return PINS[self.board]

    def wires(self) -> tuple[Wire, ...]:
        """Return every wire, those to the driver first.

        Examples
        --------
        >>> from hapticlab.device.wirings import build
        >>> [(wire.begin[1], wire.end[1]) for wire in build("l298").wires() if wire.end[0] == "driver"][:3]
        [('D7', 'IN1'), ('D8', 'IN2'), ('D6', 'ENA')]
        """
        return (*self._to_driver(), *self._to_sensor(), *self._of_power())

    def _to_driver(self):
        fixed = "driver" in self.plugged
        for role, pin in zip(self.wiring.motor_roles, self.wiring.motor_pins, strict=True):
            yield Wire(("board", self.pins.name(pin)), ("driver", self._mark(role)), "signal", fixed)
        yield Wire(("board", "GND"), ("driver", "GND"), "ground", fixed)

    def _to_sensor(self):
        fixed = "sensor" in self.plugged
        yield Wire(("board", self.pins.supply), ("sensor", "VCC"), "sensor supply", fixed)
        yield Wire(("board", "GND"), ("sensor", "GND"), "ground", fixed)
        for role, pin in zip(self.wiring.sensor_roles, self.wiring.sensor_pins, strict=True):
            yield Wire(("board", self.pins.name(pin)), ("sensor", self._mark(role)), "signal", fixed)
        if self.wiring.sensor == "AS5048A":
            for role, pin in self.pins.spi.items():
                yield Wire(("board", self.pins.name(pin)), ("sensor", self._mark(role)), "signal", fixed)

    def _of_power(self):
        for output, terminal in zip(OUTPUTS, ("1", "2"), strict=True):
            yield Wire(("driver", self._mark(output)), ("motor", terminal), "motor")
        for terminal, pole in zip(SUPPLY, "+-", strict=True):
            yield Wire(("supply", pole), ("driver", self._mark(terminal)), "motor")

    def _mark(self, terminal):
        return self.marked.get(terminal, terminal)

    def held_low(self) -> tuple[str, ...]:
        """Return the driver's inputs that need a resistor to GND, so that they are low while the board starts.

        Examples
        --------
        >>> from hapticlab.device.wirings import build
        >>> build("l298").held_low(), build("hapkit").held_low()
        (('EN',), ())
        """
        return () if "driver" in self.plugged else WITH_PWM[self.wiring.drive]

    def remarks(self) -> tuple[str, ...]:
        """Return the notes, and the resistors to add."""
        pins = [self.pins.name(self.wiring.pins()[role]) for role in self.held_low()]
        keep = "keep" if pins[1:] else "keeps"
        words = f"10 kOhm from {' and from '.join(pins)} to GND {keep} the motor off while the board starts."
        return (words, *self.notes) if pins else self.notes

    def in_short(self) -> str:
        """Return its name and the pin of each role.

        Examples
        --------
        >>> from hapticlab.device.wirings import build
        >>> build("hapkit").in_short()
        'hapkit (PWM D5, DIR D8, OUT A2)'
        """
        return f"{self.name} ({', '.join(f'{role} {self.pins.name(pin)}' for role, pin in self.wiring.pins().items())})"

    def table(self) -> list[str]:
        """Return the wires as the lines of a table.

        Examples
        --------
        >>> from hapticlab.device.wirings import build
        >>> print(build("hapkit").table()[3])
        board D5       driver PWM     already on the board
        """
        lines = [f"{'from':<14} {'to':<14} ", f"{'-' * 14} {'-' * 14}"]
        for wire in self.wires():
            lines.append(f"{' '.join(wire.begin):<14} {' '.join(wire.end):<14} {_remark(wire)}".rstrip())
        return [f"board   {self.board}, driver {self.driver}, sensor {self.sensor}", *(line.rstrip() for line in lines)]

    def __str__(self) -> str:
        return "\n".join([f"{self.name}: {self.title}", *self.table(), *self.remarks(), f"source: {self.source}"])


def _remark(wire):
    if wire.fixed:
        return "already on the board"
    return "through the fuse and the switch" if wire.begin == ("supply", "+") else ""
