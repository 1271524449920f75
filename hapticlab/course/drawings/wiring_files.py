"""Write the drawing of every known wiring: ``python -m hapticlab.course.drawings.wiring_files docs/paddle/images/wiring``."""

import sys
from pathlib import Path

from ...device.build import Build
from ...device.wirings import BUILDS
from .drawing import Drawing
from .wiring import WiringSheet


def wiring_svg(build: Build) -> str:
    """Return the SVG file of a paddle's wiring.

    Examples
    --------
    >>> from hapticlab.device.wirings import build
    >>> wiring_svg(build("hapkit"))[:4]
    '<svg'
    """
    sheet = WiringSheet(build)
    return Drawing(f"wiring {build.name}", sheet.TITLE, sheet.ALT, sheet.draw).page_svg()


def write(folder):
    """Write one file for each wiring into a folder."""
    Path(folder).mkdir(parents=True, exist_ok=True)
    for name, build in BUILDS.items():
        (Path(folder) / f"{name}.svg").write_text(wiring_svg(build), "utf-8", newline="\n")


if __name__ == "__main__":
    write(sys.argv[1])
