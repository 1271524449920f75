"""How fast the library's scenes run on each board: ``python tests/firmware/scene_rates.py`` writes it into docs/paddle/boards.md.

Predicted by the package's model. Found on the Uno: the shortest period, in steps of 10 us, with which the real image runs the
scene in the emulator, parameters set a hundred times a second and every sample sent, without a late step or a lost sample.
"""

import math
from functools import cache
from pathlib import Path
from unittest.mock import patch

import numpy as np
from emulated import emulated_uno
from five_scenes import SCENES

import hapticlab as hl
from hapticlab.compiler.boards.cost import cost
from hapticlab.device.board.settings import nominal
from hapticlab.errors import HapticlabError

PAGE = Path(__file__).resolve().parents[2] / "docs" / "paddle" / "boards.md"
BEGIN, END = "<!-- written by tests/firmware/scene_rates.py -->\n", "<!-- end -->\n"
HAND = hl.Hand(m=0.05, b=3, k=400, intent=lambda t: 0.006 * np.sin(9 * t) + 0.003 * np.sin(31 * t))
#: of the link: its bytes, and by them what takes a few us of a tick, differ from session to session
SESSION = patch("hapticlab.device.link.exchange.secrets.randbits", lambda bits: 20261120 % 2**bits)
#: of a slow handle, so that its magnet may be looked at every 10 ms
SLOW = nominal("hapkit", wired=1, checked=1, ident=0x3F2A, date=20261120, speed_max=0.4)
GRID = 10e-6  # [s]
SECONDS = 0.25


@cache
def scenes():
    """Return name -> (scene, options of hl.compile): the library's, and the five of the firmware's tests."""
    library = {name: (entry.scene(), entry.uno or entry.options) for name, entry in hl.library.catalogue.items()}
    tests = {f"own_{make.__name__}": make() for make in SCENES}
    return {name: (scene, {k: v for k, v in options.items() if k != "T"}) for name, (scene, options) in (library | tests).items()}


def predicted(name, board, promise=False):
    """Return the shortest period that fits [s], or is promised; None where it is too long or memory too small."""
    scene, options = scenes()[name]
    T = 2e-3
    for _ in range(3):  # the scene's own constants hold T
        said = cost(hl.compile(scene, T=T, **options), board)
        T = math.ceil(said.T_needed(promise) / 1e-6 - 1e-6) * 1e-6
        if said.memory_problem or said.board.T_max < T:
            return None
    return T


def holds(name, T, seconds=SECONDS):
    """Whether the image runs the scene at T, while its parameters are set, with no step late, no sample lost and no fault."""
    scene, options = scenes()[name]
    with SESSION, emulated_uno(HAND, T=T, settings=SLOW) as paddle:
        try:
            paddle.start(scene, check_fit=False, **options)
            values = paddle._loaded.program.values[:8]
            rest = b"".join(bytes([k]) + np.float32(v).tobytes() for k, v in enumerate(values))
            for k in range(round(seconds / 0.01)):
                if paddle.under_way is None or paddle.under_way.fault:
                    return False
                if values:
                    paddle.exchange.command("SET", len(values), rest=rest)
                paddle.wait(0.01 + (k * 0.382 % 1) * T)
            log = paddle.stop()
        except HapticlabError:
            return False
        return log.fault is None and paddle.timing.overruns == paddle.timing.lost == 0


def found(name):
    """Return the shortest period [s], at most the predicted one, at which it holds as it does at the longer ones looked at."""
    most = predicted(name, "uno")
    if most is None or not holds(name, most):
        return None
    low, high = 0.3 * most, most
    while high - low > GRID:
        middle = round((low + high) / 2 / 1e-6) * 1e-6
        low, high = (low, middle) if holds(name, middle) else (middle, high)
    return high


def in_us(T):
    return "-" if T is None else f"{T * 1e6:.0f}"


def row(name):
    """Return the cells of a scene that the model says: the Uno's, the Pico's and the Cortex-M4F's."""
    scene, options = scenes()[name]
    said = [predicted(name, "uno"), predicted(name, "uno", promise=True)]
    said += [predicted(name, board, promise) for board in ("pico", "cortex-m4f") for promise in (False, True)]
    return [scene.name or name, options.get("method", "rk4").replace("_", " "), *map(in_us, said)]


def written():
    """Return the part of the page that this module writes."""
    lines = [
        "| scene | method | Uno: fits | promised | found | Pico: fits | promised | M4F: fits | promised |", "|" + 9 * "---|",
    ]  # fmt: skip
    for name in scenes():
        cells = row(name)
        lines.append("| " + " | ".join([*cells[:4], in_us(found(name)), *cells[4:]]) + " |")
        print(lines[-1], flush=True)
    return "\n".join(lines) + "\n"


def stated():
    """Return scene -> the cells that the page states of it."""
    part = PAGE.read_text("utf-8").partition(BEGIN)[2].partition(END)[0]
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in part.splitlines() if line.startswith("| ")]
    return dict(zip(scenes(), (cells for cells in rows if cells[0] != "scene"), strict=True))


if __name__ == "__main__":
    before, _, rest = PAGE.read_text("utf-8").partition(BEGIN)
    PAGE.write_text(before + BEGIN + "\n" + written() + "\n" + END + rest.partition(END)[2], "utf-8")
