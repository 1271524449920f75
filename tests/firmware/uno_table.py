"""What the Uno's image takes, and a tick with each wiring: ``python tests/firmware/uno_table.py`` writes both into its README.

A tick is that of the virtual wall at 1 kHz, from the interrupt's call to the end of its return, in ticks that nothing
interrupted.
"""

import numpy as np
from build_image import FIRMWARE, FLASH, RAM, sizes
from closed_loop import ClosedLoop
from count_rate import fastest
from emulated import image
from emulator import Uno
from five_scenes import compiled, mass_and_wall, wall
from stack_bound import StackBound
from uno_port import offer
from whole_step import Watched, quiet
from wired import HAND, PADDLES

import hapticlab as hl
from hapticlab.compiler.boards.cost import cost
from hapticlab.device.wiring import Wiring

README = FIRMWARE / "boards" / "uno" / "README.md"
BEGIN, END = "<!-- written by tests/firmware/uno_table.py -->\n", "<!-- end -->\n"
SCENES = {"wall, 1 kHz": (wall, 1e-3), "mass and wall, 800 Hz": (mass_and_wall, 1.25e-3)}


def image_sizes():
    """Return the bytes that the image takes: flash, static RAM, and the stack at most."""
    elf = image().with_suffix(".elf")
    (flash, ram), stack = sizes(elf), StackBound(elf).image()
    return {"flash": flash, "RAM": ram, "stack": stack}


def tick_cycles(settings):
    """Return the median and the most cycles of a tick of the wall with a wiring."""
    program = compiled(wall)
    handle = Watched(hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=HAND))
    with Uno(image(), eeprom=settings.to_bytes()) as board:
        with hl.connect(offer("table", ClosedLoop.of(settings.to_float32(), board, handle))) as paddle:
            paddle.home(at=0.0)
            handle.board = board
            log = paddle.run(program, duration=0.25, every=17, progress=False, check_fit=False)
        assert log.fault is None, log.fault
        assert board.driver.conflicts == 0
    cycles = quiet(handle)
    return round(np.median(cycles)), round(max(cycles))


def promised_rate(make, T):
    """Return the most edges a second with which the program is promised to fit."""
    program, low, high = compiled(make, T=T), 0, 200_000
    if not cost(program).promised:
        return None
    while high - low > 500:
        middle = (low + high) / 2
        low, high = (middle, high) if cost(program, edges_per_second=middle).promised else (low, middle)
    return int(low // 1000) * 1000


def written():
    """Return the part of the README that this module writes."""
    found = image_sizes()
    lines = [
        "One image has all sensors and drives. Flash, variables and stack in bytes:", "",
        "| flash | of | RAM | stack, at most | of |", "|---|---|---|---|---|",
        f"| {found['flash']} | {FLASH} | {found['RAM']} | {found['stack']} | {RAM} |", "",
        "| paddle | sensor | drive, pins | carrier [Hz] | tick of the wall [cycles], median and most |", "|---|---|---|---|---|",
    ]  # fmt: skip
    for name, settings in PADDLES.items():
        wiring, (median, most) = Wiring.of(settings), tick_cycles(settings)
        pins = ", ".join(map(str, wiring.motor_pins))
        lines.append(f"| {name} | {wiring.sensor} | {wiring.drive} {pins} | {wiring.carrier} | {median}, {most} |")
    lines += ["", "| scene with an encoder | promised to [edges/s] | no late step to [edges/s] |", "|---|---|---|"]
    for name, (make, T) in SCENES.items():
        lines.append(f"| {name} | {promised_rate(make, T) or 'not promised'} | {fastest(make, T)['late']} |")
    return "\n".join(lines) + "\n"


def stated():
    """Return the rows of the README's part, a list of cells each."""
    part = README.read_text().partition(BEGIN)[2].partition(END)[0]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in part.splitlines() if line.startswith("| ")]


if __name__ == "__main__":
    before, _, rest = README.read_text().partition(BEGIN)
    README.write_text(before + BEGIN + "\n" + written() + "\n" + END + rest.partition(END)[2])
