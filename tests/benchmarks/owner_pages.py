"""Write what the pages for owners take from code: words of faults, steps of the bench, forces of profiles, stop times.

``python tests/benchmarks/owner_pages.py`` writes what costs nothing; ``--measure`` also puts every fault into the emulated
boards and writes how long each took. tests/test_owner_pages.py compares.
"""

import argparse
import re
import sys
from pathlib import Path

import numpy as np

from hapticlab.device.board.settings import nominal
from hapticlab.device.bring_up.steps import table
from hapticlab.device.link.messages import FAULTS, UNCHECKED_FORCE_N
from hapticlab.device.profiles import PROFILES
from hapticlab.device.wirings import BUILDS
from hapticlab.errors import PaddleError

CLOCKS_PER_US = 16  # of an Uno
ROOT = Path(__file__).parents[2]
FAULTS_PAGE, GUIDE, SAFETY = (ROOT / "docs" / "paddle" / name for name in ("faults.md", "owners_guide.md", "SAFETY.md"))


def fault_quotes():
    """Return the sentence of every fault as a student reads it, by its name."""
    found = {}
    for name, (_, cause, cure) in FAULTS.items():
        found[name] = f"> {name}: {cause}; the motor is off from then on. {cure[:1].upper()}{cure[1:]}."
    return found


def block(page, name):
    """Return the lines between a page's two marks of a block."""
    return re.search(rf"^<!-- {name} -->\n(.*?)^<!-- end of {name} -->", page.read_text("utf-8"), re.M | re.S)[1]


def write_block(page, name, text):
    """Replace the lines between the marks of a block."""
    whole = page.read_text("utf-8")
    page.write_text(whole.replace(f"-->\n{block(page, name)}<!-- end of {name}", f"-->\n{text}<!-- end of {name}"), "utf-8")


def profile_rows():
    """Return the largest force, speed and energy of each profile that a board can be given, as a table.

    The energy is that of the moving mass at the speed limit, and the work of the largest force over the whole travel.
    """
    rows = [
        "| profile | largest force | until the sign is checked | speed limit | energy at that speed | work over the travel |",
        "| --- | --- | --- | --- | --- | --- |",
    ]
    for name in PROFILES:
        try:
            kept = nominal(name)
        except PaddleError:  # a paddle that this package only simulates
            continue
        force, travel = min(kept.force_max, kept.force_full), kept.travel_max - kept.travel_min
        energy = kept.m * kept.speed_max**2 / 2
        rows.append(
            f"| `{name}` | {force:.3g} N | {UNCHECKED_FORCE_N:g} N | {kept.speed_max:.3g} m/s | {energy:.2g} J "
            f"| {force * travel:.2g} J |"
        )
    return "\n".join(rows) + "\n"


def stop_rows(faults, measure):
    """Measure faults on an emulated board, and return the table."""
    rows = ["| fault | stated | found |", "| --- | --- | --- |"]
    for name, fault in faults.items():
        taken, _ = measure(fault)
        rows.append(f"| {name} | {stated(fault)} | {1e3 * taken:.3f} ms |")
    return "\n".join(rows) + "\n"


def scope_rows():
    """Watch the motor's pins of the emulated Uno for each paddle that people build, and return what a scope would show."""
    import wired
    from emulated import emulated_uno

    rows = ["| wiring | carrier, on | a new duty every | step, mean and worst |", "| --- | --- | --- | --- |"]
    for name, build in BUILDS.items():
        if build.board != "uno":
            continue
        wiring = build.wiring
        settings = wired.of(wiring.sensor, wiring.drive, wiring.motor_pins, wiring.sensor_pins, wiring.carrier)
        with emulated_uno(wired.HAND, settings=settings) as paddle:
            paddle.start(wired.SPRING)
            paddle.wait(0.5)
            board = paddle.loop.board
            carriers = {pin: board.carrier(pin) for pin in wiring.motor_pins if board.carrier(pin)}
            every = np.diff(board.updates()[-400:]) / CLOCKS_PER_US
            paddle.stop()
        (pin, hz), timing = next(iter(carriers.items())), paddle.timing
        rows.append(
            f"| `{name}` | {hz / 1e3:.2f} kHz, {build.pins.name(pin)} | {np.median(every):.0f} us, {every.min():.0f} to "
            f"{every.max():.0f} | {1e6 * timing.mean:.0f} us, {1e6 * timing.worst:.0f} us |"
        )
    return "\n".join(rows) + "\n"


def stated(fault):
    """The time that tests/firmware/faults.py states for a fault, in words."""
    return f"{1e3 * fault.within:g} ms"


def main():
    """Write the blocks."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--measure", action="store_true", help="measure the stop times as well, in the emulator")
    options = parser.parse_args()
    page = FAULTS_PAGE.read_text("utf-8")
    for name, quote in fault_quotes().items():
        page = re.sub(rf"^> {name}: .*$", lambda _, quote=quote: quote, page, flags=re.M)
    FAULTS_PAGE.write_text(page, "utf-8")
    write_block(GUIDE, "steps of the bench", table())
    write_block(SAFETY, "profiles", profile_rows())
    if options.measure:
        sys.path.insert(0, str(ROOT / "tests" / "firmware"))
        import faults
        import pico_faults

        write_block(SAFETY, "stop times of the Uno", stop_rows(faults.FAULTS, faults.measure))
        write_block(SAFETY, "stop times of the Pico", stop_rows(pico_faults.PICO_FAULTS, pico_faults.measure))
        write_block(GUIDE, "scope", scope_rows())


if __name__ == "__main__":
    main()
