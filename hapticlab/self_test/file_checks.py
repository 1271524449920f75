"""Checks of files and folders: names, lengths, line endings, and what a folder of labs keeps."""

import contextlib
import io
import os
import shutil
import sys

from ..cli.main import main
from ..cli.scene_file import load_scene
from ..course.labs import copy_labs, find_labs
from .outcome import Attention, need

#: characters beyond those of one alphabet, and spaces
NAME = "Übung 1 – Wände µ 壁"
#: the longest path of Windows unless a setting allows more
MAX_PATH = 260
SCENE = (
    "import hapticlab as hl\nfrom hapticlab import n, x\n\nk, x_o = hl.parameters('k x_o', units='N/m m')\n"
    "scene = hl.Scene(force=hl.when(x(n) >= x_o, k*(x(n) - x_o)), name='wall')(k='0.15 N/mm', x_o='10 mm')\nduration = 0.05\n"
)


def run_in(folder):
    """Run a scene file in a folder by the command line; return what went wrong, or an empty text."""
    said = io.StringIO()
    try:
        folder.mkdir(parents=True)
        (folder / "wall.py").write_text(SCENE, "utf-8")
        with contextlib.redirect_stderr(said), contextlib.redirect_stdout(said):
            code = main(["run", str(folder / "wall.py"), "--out", str(folder / "results")])
        made = {path.suffix for path in (folder / "results").iterdir()}
    except OSError as problem:
        return f"{type(problem).__name__}: {problem}"
    return "" if code == 0 and made == {".png", ".csv"} else f"exit code {code}, files {sorted(made)}: {said.getvalue()}"


def paths(folder):
    """Run a scene file in folders whose names are odd or long."""
    wrong = run_in(folder / NAME)
    need(not wrong, f"in a folder with spaces and other alphabets: {wrong}")
    longer = folder
    while len(str(longer)) <= MAX_PATH:
        longer /= "a_long_name" * 4
    wrong = run_in(longer)
    long = f"a path of {len(str(longer))} characters"
    if wrong and sys.platform == "win32":
        raise Attention(f"spaces and other alphabets work. With the settings of Windows here, {long} does not: {wrong}")
    need(not wrong, f"in {long}: {wrong}")
    return f"spaces, other alphabets and {long} work"


def line_endings(folder):
    """Load one scene file with the line endings of Windows and without; the scenes must be the same."""
    loaded = []
    for name, ending in (("lf", "\n"), ("crlf", "\r\n"), ("bom", "\r\n")):
        path = folder / f"{name}.py"
        path.write_bytes((b"\xef\xbb\xbf" if name == "bom" else b"") + SCENE.replace("\n", ending).encode())
        found = load_scene(path)
        loaded.append((str(found.scene.force), found.scene.values, found.duration))
    need(loaded[0] == loaded[1] == loaded[2], f"the scenes differ: {loaded}")
    return "LF, CRLF and a byte-order mark give the same scene"


def labs(folder):
    """Copy the labs, change one, and copy again: the change stays, also in a folder whose name is in capitals."""
    here = folder / NAME
    copy_labs(here)
    found = find_labs(here)
    need(len(found) == len(find_labs()) > 0, f"{len(found)} of {len(find_labs())} labs were copied")
    mine = found[0].notebook
    mine.write_bytes(mine.read_bytes() + b"\n")
    again = copy_labs(here)
    need(again[os.path.join(found[0].name, mine.name)] == "kept", f"a changed notebook was not kept: {again}")
    own = found[0].name.upper()
    case = "ignores" if (here / own).exists() else "heeds"
    shutil.copytree(here / found[0].name, folder / "own" / own)
    copy_labs(folder / "own")
    kept = (folder / "own" / own / mine.name).read_bytes() == mine.read_bytes()
    need(kept, "a lab folder written in capitals lost the student's changes")
    return f"{len(found)} labs copied; a changed notebook was kept. This file system {case} the case of letters"
