"""Checks of what a course uses: JupyterLab with a kernel and the server's extension, and a small class that is graded."""

import contextlib
import io
import json
import os
import sys
import zipfile
from importlib.util import find_spec
from pathlib import Path

from ..cli.main import main
from .outcome import Attention, need

NOTEBOOK = ("jupyterlab", "ipywidgets", "anywidget")
#: what makes Jupyter's server load hapticlab._jupyter
EXTENSION = Path("etc", "jupyter", "jupyter_server_config.d", "hapticlab.json")
#: s for a kernel to start, and to answer
KERNEL = 40
LAB = "20_spring"
CHECKS = """
from hapticlab.course.exercise import Case, Exercise, Lab

LAB = Lab("20", "A spring", 5, exercises=(
    Exercise("force", points=2, asks="the force", cases=(Case({"x": 0.01, "k": 200.0}, 2.0, unit="N"),)),
    Exercise("wall", kind="scene", points=1, asks="a wall", cases=(
        Case({"x": [0.0, 0.012], "T": 1e-3, "values": {"k": 150.0, "x_o": 0.01}}, [0.0, 0.3], unit="N"),)),
))
"""
HIDDEN = """
def cases(random):
    return {"force": lambda: [{"x": random.uniform(-0.02, 0.02), "k": random.uniform(50, 500)} for _ in range(2)]}
"""
RIGHT = """
import hapticlab as hl
from hapticlab import n, x

def force(x, k):
    return k * x

k, x_o = hl.parameters("k x_o", units="N/m m")
wall = hl.Scene(force=hl.when(x(n) >= x_o, k*(x(n) - x_o)))
"""
#: who hands in what, and earns how much; two names are one where a file system does not tell capitals from small letters
CLASS = {
    "Ada": (RIGHT, 3.0),
    "ada": (RIGHT.replace("return k * x", "return -k * x"), 1.0),
    "Zoë Müller 壁": (RIGHT.replace("\n", "\r\n"), 3.0),
    "ended": (RIGHT.replace("return k * x", "__import__('os')._exit(3)"), 1.0),
    "endless": (RIGHT.replace("return k * x", "while True: pass"), 1.0),
}


def written(folder):
    """Write a small lab, answers to it and a zip file of what a class hands in; return the three paths."""
    cell = {"cell_type": "code", "id": "a", "metadata": {}, "outputs": [], "execution_count": None}
    cells = [{**cell, "source": "force = wall = None"}]
    files = {
        f"{LAB}/checks.py": CHECKS,
        f"{LAB}/{LAB}.ipynb": json.dumps({"cells": cells, "metadata": {}, "nbformat": 4, "nbformat_minor": 5}),
        f"answers/{LAB}/solution.py": RIGHT,
        f"answers/{LAB}/hidden.py": HIDDEN,
    }
    for name, text in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, "utf-8")
    with zipfile.ZipFile(folder / "class.zip", "w") as handed_in:
        for student, (source, _) in CLASS.items():
            handed_in.writestr(f"{student}/{LAB}.py", source.encode())
    return folder / LAB, folder / "answers", folder / "class.zip"


def graded(folder, level):
    """Grade a small class at a level of walls; every mark must be right, and each student has a page."""
    lab, answers, handed_in = written(folder)
    said, marks, pages = io.StringIO(), folder / "marks.json", folder / "pages"
    asked = ["--lab", str(lab), "--instructor", str(answers), "--sandbox", level, "--workers", "2", "--timeout", "2"]
    with contextlib.redirect_stderr(said):
        code = main(["grade", str(handed_in), *asked, "--format", "json", "-o", str(marks), "--pages", str(pages)])
    need(code == 0, f"`hapticlab grade` ended with {code}: {said.getvalue()}")
    reports = json.loads(marks.read_text("utf-8"))["reports"]
    earned = {report["student"]: report["earned"] for report in reports}
    right = {student: points for student, (_, points) in CLASS.items()}
    need(earned == right, f"marks {earned}; these are right: {right}. {said.getvalue()}")
    names = {path.name.casefold() for path in pages.rglob("*.html")}
    need(len(names) == len(CLASS) + 1, f"{len(names)} pages for {len(CLASS)} students and the class: {sorted(names)}")
    told = [line for line in said.getvalue().splitlines() if line.startswith("hapticlab: ")]  # the others are a bar of progress
    return f"{len(CLASS)} submissions, every mark right; {'; '.join(told)}"


def graded_as_it_comes(folder):
    """Grade a small class at the best level of this system."""
    return graded(folder, "auto")


def graded_without_walls(folder):
    """Grade a small class at level none, which every system has."""
    return graded(folder, "none")


def jupyter(folder):
    """Look for JupyterLab and the server's extension, and run a cell in a kernel of this Python."""
    missing = [name for name in NOTEBOOK if find_spec(name) is None]
    if missing:
        raise Attention(f'not installed: {", ".join(missing)}; the labs need them. Do: pip install "hapticlab[notebook]"')
    from jupyter_client.manager import start_new_kernel

    os.environ["JUPYTER_PREFER_ENV_PATH"] = "1"  # as `hapticlab labs` does
    cell = "import sys, hapticlab as hl; print(sys.executable); print(hl.wall()(k='2 N/mm', x_o='1 cm').values)"
    manager, client = start_new_kernel(startup_timeout=KERNEL, cwd=str(folder))
    try:
        said = []
        hook = lambda message: said.append(message["content"].get("text", ""))  # noqa: E731
        reply = client.execute_interactive(cell, timeout=KERNEL, output_hook=hook)
    finally:
        client.stop_channels()
        manager.shutdown_kernel(now=True)
    need(reply["content"]["status"] == "ok", f"a cell failed in a kernel: {reply['content']}")
    executable = "".join(said).splitlines()[0]
    if Path(executable).resolve() != Path(sys.executable).resolve():
        raise Attention(f"the kernel python3 is another Python, {executable}; the labs need this one")
    if not (Path(sys.prefix) / EXTENSION).is_file():
        raise Attention(f"a kernel runs; {EXTENSION} is not in {sys.prefix}, so the live view may be up to 40 ms late")
    return "a kernel of this Python runs a cell; the server's extension is installed"
