"""The notebook before and after its rewriting, side by side: `python tests/benchmarks/notebook_pictures.py`.

Both checkouts do the same in JupyterLab and Chromium at 1280 x 800, with what `pip install -e ".[test]"` brings: the present
one, and the commit BEFORE, unpacked into a temporary folder. Each pair is one picture in docs/images/notebook, and
docs/project/notebook_pictures.md shows them all. ``--only NAME`` takes one of them; ``--look FOLDER`` also keeps whole pictures.
"""

import argparse
import io
import os
import shutil
import subprocess
import sys
import tarfile
import tempfile
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "browser"))
from lab import Lab, browsing, command, grab  # noqa: E402

#: the last commit whose notebook had none of this
BEFORE = "9d3011d"
FOLDER = ROOT / "docs" / "images" / "notebook"
PAGE = ROOT / "docs" / "project" / "notebook_pictures.md"
WIDE, HIGH = 1280, 800
HEAD = """# The notebook, before and after

Each picture shows the same cells in JupyterLab on a screen of 1280 x 800 pixels. The left side is the package before its
notebook was rewritten (commit {before}), and the right side is the present package.
`python tests/benchmarks/notebook_pictures.py` takes these pictures again.
"""
FIRST = """
import numpy as np
import hapticlab as hl
from hapticlab import n, x
k, x_o = hl.parameters("k x_o", units="N/m m")
paddle = hl.SimulatedPaddle.from_profile("hapkit", hand=hl.Hand("pinch"))
wall = hl.Scene(force=hl.when(x(n) >= x_o, k*(x(n) - x_o)), name="my wall")
"""
HELD = "def held_work(k, x, D):\n    return k*(x + D)*D\n"


@dataclass(frozen=True)
class Shot:
    """What is done in both checkouts: cells that run, or a lab; then acts in the page; then a picture."""

    name: str
    words: str  # what there is to see
    cells: tuple[str, ...] = ()
    lab: str = ""
    press: bool = False  # drag the handle to the right
    dark: bool = False
    source: bool = True  # the cells' code is on the screen
    kill: bool = False  # the kernel ends


def live(scene):
    return f"view = hl.live(paddle, {scene})\nview"


SLIP = """
def force():
    if x(n) >= x_o:
        return k*(x(n) - x_o)
    return 0

hl.Scene(force=force())
"""
PRESSED = "pressed = hl.SimulatedPaddle(m=0.05, b=0.5, T=1e-3, hand=hl.Hand(push=2.0))"
RECORD = f"{PRESSED}\nlog = pressed.run(wall(k=500, x_o=0.01), duration=1.0)\nlog"
COMPILED = 'hl.compile(wall(k=300, x_o="10 mm"), T=1e-3)'
WALL = live("wall(k=500, x_o=0.01)")
PENDULUM = live("hl.library.pendulum_on_the_handle()")
SHOTS = (
    Shot("error", "A force whose terms have different units.", ("hl.Scene(force=k*x(n) + x(n))",)),
    Shot("slip", "A condition in Python's own words.", (SLIP,)),
    Shot("scene", "A scene and a compiled program as the last line of a cell.", ('wall(k=300, x_o="10 mm")', COMPILED)),
    Shot("record", "A recording and its energy.", (RECORD, "hl.energy(log)")),
    Shot("check", "The check of a wrong answer.", (f'{HELD}\nhl.check("02.held_work", held_work)',)),
    Shot("wall", "A wall, with the handle pressed into it.", (WALL,), press=True, source=False),
    Shot("wall_dark", "The same wall in a dark notebook.", (WALL,), press=True, source=False, dark=True),
    Shot("pendulum", "A pendulum of the library with all its parameters.", (PENDULUM,), press=True, source=False),
    Shot("ball", "A ball on the paddle.", (live("hl.library.ball_on_the_paddle()"),), source=False),
    Shot("silence", "The view two seconds after the kernel has ended.", (WALL,), source=False, kill=True),
    Shot("lab_00", "The first screen of lab 00.", lab="00_meet_the_paddle"),
    Shot("lab_04", "The first screen of lab 04.", lab="04_damping_compensation"),
)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", help="the name of one picture")
    parser.add_argument("--look", type=Path, help="a folder for the whole pictures of the present package")
    given = parser.parse_args()
    shots = [shot for shot in SHOTS if given.only in (None, shot.name)]
    with tempfile.TemporaryDirectory() as folder, browsing() as browser:
        unpack(Path(folder) / "before")
        sides = [take(browser, Path(folder), package, shots) for package in (Path(folder) / "before", ROOT)]
    FOLDER.mkdir(parents=True, exist_ok=True)
    for shot, before, after in zip(shots, *sides, strict=True):
        beside(before, after).save(FOLDER / f"{shot.name}.png", optimize=True)
        if given.look:
            given.look.mkdir(parents=True, exist_ok=True)
            (given.look / f"{shot.name}.png").write_bytes(after)
        print(f"{shot.name:12} {(FOLDER / f'{shot.name}.png').stat().st_size / 1e3:4.0f} kB  {shot.words}")
    parts = [f"![{shot.words} Before on the left, after on the right.](../images/notebook/{shot.name}.png)" for shot in SHOTS]
    words = [f"## {shot.words.rstrip('.')}\n\n{part}\n" for shot, part in zip(SHOTS, parts, strict=True)]
    PAGE.write_text("\n".join([HEAD.format(before=BEFORE), *words]), encoding="utf-8")


def unpack(target):
    """Unpack the package as it was, with the labs and the firmware that it needs."""
    packed = subprocess.run(
        ["git", "archive", BEFORE, "hapticlab", "labs", "firmware"], cwd=ROOT, check=True, capture_output=True
    )
    with tarfile.open(fileobj=io.BytesIO(packed.stdout)) as archive:
        archive.extractall(target, filter="data")


def take(browser, folder, package, shots):
    """Return a picture of each shot in the package of a checkout, as the bytes of a PNG."""
    taken = []
    with Lab(folder / f"jupyter-{package.name}", browser, package=package) as lab:
        for shot in shots:
            page = opened(lab, shot)
            taken.append(page.screenshot())
            page.close()
            lab.end_kernels()
    return taken


def opened(lab, shot):
    """Return a page that shows what the shot is about."""
    if shot.lab:
        shutil.copy(lab.package / "labs" / shot.lab / f"{shot.lab}.ipynb", lab.notebooks)
        page = lab.open(shot.lab, width=WIDE, height=HIGH)
        themed(page, dark=False)
        page.wait_for_timeout(6000)  # equations are being set
        page.locator(".jp-WindowedPanel-outer").first.evaluate("(node) => node.scrollTo(0, 0)")
        return page
    page = lab.open(shot.name, FIRST, *shot.cells, width=WIDE, height=HIGH)
    themed(page, shot.dark)
    if shot.source:
        page.evaluate("() => window.jupyterapp.commands.execute('notebook:show-all-cell-code')")
    page.wait_for_timeout(5000)
    if shot.press:
        x, y = grab(page, "canvas.hl-stage")
        for k in range(1, 16):
            page.mouse.move(x + 12 * k, y)
            page.wait_for_timeout(50)
        page.wait_for_timeout(1500)
    if shot.kill:
        lab.end_kernels()
        page.wait_for_timeout(2500)
    last = page.locator(".jp-CodeCell").nth(1)
    last.evaluate("(node) => node.scrollIntoView({ block: 'start' })")
    page.wait_for_timeout(300)
    return page


def themed(page, dark):
    """Give JupyterLab its light or its dark theme, which stays for the next page."""
    command(page, "apputils:change-theme", theme=f"JupyterLab {'Dark' if dark else 'Light'}")


def beside(before, after):
    """Return both pictures side by side, in few colours."""
    from PIL import Image

    left, right = (Image.open(io.BytesIO(each)).convert("RGB") for each in (before, after))
    gap = 16
    whole = Image.new("RGB", (2 * WIDE + gap, HIGH), "#808080")
    whole.paste(left, (0, 0))
    whole.paste(right, (WIDE + gap, 0))
    return whole.resize(((2 * WIDE + gap) * 5 // 8, HIGH * 5 // 8), Image.Resampling.LANCZOS).quantize(96)


if __name__ == "__main__":
    os.nice(5)
    main()
