"""A paddle's wires, from pin to terminal, drawn from the record that its board is told; and where these pins are on the board."""

from __future__ import annotations

from textwrap import wrap

from ...device.build import OUTPUTS, SUPPLY, Build
from .pen import COLD, GREY, INK, WARM, arc, box, line, sheet, words

#: rows of pins as they are printed, USB on the left, the upper row first; "" where there is none
HEADERS = {
    "uno": (
        "SCL SDA AREF GND D13 D12 D11 D10 D9 D8 - D7 D6 D5 D4 D3 D2 D1 D0".split(),
        "- - - - NC IOREF RESET 3V3 5V GND GND Vin - A0 A1 A2 A3 A4 A5".split(),
    ),
    "pico": (
        "VBUS VSYS GND EN 3V3 VREF GP28 GND GP27 GP26 RUN GP22 GND GP21 GP20 GP19 GP18 GND GP17 GP16".split(),
        "GP0 GP1 GND GP2 GP3 GP4 GP5 GND GP6 GP7 GP8 GP9 GND GP10 GP11 GP12 GP13 GND GP14 GP15".split(),
    ),
}
CALLED = {"uno": "Uno", "pico": "Pico"}
COLOURS = {"signal": COLD, "ground": GREY, "sensor supply": WARM, "motor": WARM}
#: left and right edge of board, of driver and sensor; the motor's centre and the supply's left edge
BOARD, PART, MOTOR = (0.3, 3.7), (7.4, 10.6), 13.1
ROW, WIDE, SMALL = 0.62, 14.4, 9.5
#: rows of a driver beside its outputs and its supply, and letters in a line of notes
POWER, LETTERS = 5, 95


class WiringSheet:
    """The drawing of one wiring: TITLE, ALT and draw(), as the modules beside this one have them."""

    def __init__(self, build: Build):
        self.build = build
        self.TITLE = f"Wiring: {build.title}"
        wires = "; ".join(f"{' '.join(one.begin)} to {' '.join(one.end)}" for one in build.wires())
        self.ALT = (
            f"The wires of a {build.title}, from the board's pins on the left to driver, motor and sensor on the right: {wires}. "
            "The plus wire of the supply goes through a fuse and a switch."
        )

    def draw(self):
        """Draw board, driver, motor, supply and sensor, every wire between them, the board's edge, and what to know."""
        wires, notes = self.build.wires(), [part for note in self.build.remarks() for part in wrap(note, LETTERS)]
        of_driver = [one for one in wires if one.begin[0] == "board" and one.end[0] == "driver"]
        of_sensor = [one for one in wires if one.end[0] == "sensor"]
        wired = any(not one.fixed for one in (*of_driver, *of_sensor))
        edge = 0.55 * len(notes) + 0.2
        low = edge + (2.5 if wired else 0.1)
        top = low + ROW * (len(of_sensor) + max(len(of_driver), POWER) + 2.0)
        figure, axes = sheet(WIDE / 2, (top + 1.1) / 2, (0, WIDE), (0, top + 1.1))
        box(axes, BOARD[0], low, BOARD[1] - BOARD[0], top - low)
        words(axes, BOARD[0], top + 0.3, self._called(), at="left", bold=True)
        _part(axes, top, max(len(of_driver), POWER), of_driver, f"driver: {self.build.driver}")
        _resistors(axes, top - 0.7 * ROW, self.build, len(of_driver))
        _power(axes, top - 0.7 * ROW, self.build.marked)
        _part(axes, low + ROW * (len(of_sensor) + 0.4), len(of_sensor), of_sensor, f"sensor: {self.build.sensor}")
        if wired:
            _edge(axes, edge, self.build.board, wires)
        for row, note in enumerate(notes):
            words(axes, 0.3, edge - 0.4 - 0.55 * row, note, at="left", size=SMALL)
        return figure

    def _called(self):
        own = self.build.driver.startswith("on the Hapkit")
        return "Hapkit board" if own else CALLED[self.build.board]


def _part(axes, top, rows, wires, called):
    """Draw a part with its terminals and the wires that reach it, its upper edge at ``top``."""
    box(axes, PART[0], top - ROW * (rows + 0.4), PART[1] - PART[0], ROW * (rows + 0.4))
    words(axes, PART[0], top + 0.3, called, at="left", size=SMALL)
    for row, wire in enumerate(wires):
        y, colour = top - ROW * (row + 0.7), COLOURS[wire.carries]
        line(axes, [(BOARD[1], y), (PART[0], y)], colour, width=2, dashes="--" if wire.fixed else "-")
        for x in (BOARD[1], PART[0]):
            axes.plot(x, y, "o", color=colour, markersize=5)
        words(axes, BOARD[1] - 0.15, y, wire.begin[1], at="right")
        words(axes, PART[0] + 0.15, y, wire.end[1], at="left")
    if wires[0].fixed:
        words(axes, (BOARD[1] + PART[0]) / 2, top - 0.25 * ROW, "already on the board", size=SMALL - 1)


def _resistors(axes, first, build, rows):
    """Draw a resistor from each input that carries PWM to GND, the last row."""
    ground = first - ROW * (rows - 1)
    for k, role in enumerate(build.held_low()):
        x, y = 5.0 + 1.2 * k, first - ROW * build.wiring.motor_roles.index(role)
        line(axes, [(x, y), (x, ground)], INK)
        box(axes, x - 0.1, ground + 0.14, 0.2, 0.34, fill=INK)
        words(axes, x + 0.17, ground + 0.31, "10 k\N{GREEK CAPITAL LETTER OMEGA}", at="left", size=SMALL - 2)
        for end in (y, ground):
            axes.plot(x, end, "o", color=INK, markersize=3.5)


def _power(axes, first, marked):
    """Draw the motor at the driver's outputs, and the supply with its fuse and switch below it."""
    plus, minus, left = first - 3 * ROW, first - 4 * ROW, MOTOR - 0.3
    for row, output in enumerate(OUTPUTS):
        y = first - ROW * row
        line(axes, [(PART[1], y), (MOTOR - 0.62, y)], INK, width=2)
        words(axes, MOTOR - 0.85, y + 0.22, str(row + 1), size=SMALL)
        _terminal(axes, y, marked.get(output, output), INK)
    line(axes, arc((MOTOR, first - 0.5 * ROW), 0.7, 0, 360))
    words(axes, MOTOR, first - 0.5 * ROW, "motor", size=SMALL)
    fuse, switch = PART[1] + 0.35, PART[1] + 1.35
    for ends in ((PART[1], fuse), (fuse + 0.55, switch), (switch + 0.55, left)):
        line(axes, [(x, plus) for x in ends], WARM, width=2)
    box(axes, fuse, plus - 0.12, 0.55, 0.24, colour=WARM)
    line(axes, [(fuse, plus), (fuse + 0.55, plus)], WARM, width=1)
    line(axes, [(switch, plus), (switch + 0.5, plus + 0.3)], WARM, width=2)
    words(axes, fuse + 0.27, plus + 0.36, "fuse", size=SMALL - 1)
    words(axes, switch + 0.2, plus + 0.5, "switch", size=SMALL - 1)
    line(axes, [(PART[1], minus), (left, minus)], GREY, width=2)
    _terminal(axes, plus, marked.get(SUPPLY[0], SUPPLY[0]), WARM)
    _terminal(axes, minus, marked.get(SUPPLY[1], SUPPLY[1]), GREY)
    box(axes, left, minus - 0.65, 1.45, ROW + 1.0)
    words(axes, left + 0.15, plus, "+", at="left", bold=True)
    words(axes, left + 0.15, minus, "\N{MINUS SIGN}", at="left", bold=True)
    words(axes, left + 0.72, minus - 0.4, "supply", size=SMALL)


def _terminal(axes, y, name, colour):
    """Draw a terminal on the driver's right side."""
    axes.plot(PART[1], y, "o", color=colour, markersize=5)
    words(axes, PART[1] - 0.15, y, name, at="right")


def _edge(axes, low, board, wires):
    """Draw the board from above, USB on the left: the pins with wires of a person's own are filled and named."""
    used = {one.begin[1]: COLOURS[one.carries] for one in wires if one.begin[0] == "board" and not one.fixed}
    box(axes, 0.3, low, 13.8, 2.1)
    box(axes, 0.1, low + 0.65, 0.9, 0.8, colour=GREY)
    words(axes, 1.1, low + 1.05, "USB", at="left", size=SMALL)
    called = f"the {CALLED[board]} from above: a filled pin takes a wire; all GND are one"
    words(axes, 7.3, low + 1.05, called, size=SMALL)
    for row, (y, inward) in zip(HEADERS[board], ((low + 1.88, -1), (low + 0.22, 1)), strict=True):
        at = {k: 0.7 + k * 13.0 / (len(row) - 1) for k, name in enumerate(row) if name != "-"}
        axes.plot(list(at.values()), [y] * len(at), "s", color=GREY, markersize=7, fillstyle="none")
        for k, x in at.items():
            if row[k] in used:
                axes.plot(x, y, "s", color=used[row[k]], markersize=8)
                words(axes, x, y + 0.36 * inward, row[k], size=SMALL - 1)
