"""What is done on this computer and in Pyodide alike: labs, and the pages' sweep, map and trade-off. Each returns plain numbers.

``python both_ways.py solved_lab 02`` prints what one gives here, as JSON.
"""

import json
import shutil
import sys
import tempfile
from contextlib import chdir
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
#: the same in Pyodide, with the checkout as its folder; name and given are values
IN_PYODIDE = """
import json, sys
sys.path.append("/folder/tests/pyodide")
import both_ways
print(json.dumps(both_ways.WORK[name](*given)))
"""


def imports():
    """Import what labs and studies use of other packages."""
    import anywidget, IPython, ipywidgets, matplotlib.pyplot, pint, scipy.linalg, scipy.optimize, scipy.signal, sympy  # noqa

    import hapticlab.course.labs, hapticlab.grading  # noqa

    return {}


def untouched_lab(number):
    """Return what a lab prints, raises and earns as it is handed out."""
    from hapticlab.course.notebook import read

    folder = _folder(number)
    return _lab_run(folder, read(folder.notebook))


def solved_lab(number):
    """Return what a lab prints, raises and earns with the instructor's answers."""
    from hapticlab.course.instructor import solved_notebook

    folder = _folder(number)
    return _lab_run(folder, solved_notebook(folder, _answers(folder)))


def _folder(number):
    from hapticlab.course.labs import find_labs

    return next(folder for folder in find_labs(ROOT / "labs") if folder.number == number)


def _answers(folder):
    return ROOT / "tests" / "instructor" / folder.name


def _lab_run(folder, notebook):
    """Run all cells in IPython, and mark what they leave.

    Returns
    -------
    dict
        ``printed``, a list of lines, cards in text among them; ``raised``, a list of texts; ``marks``, a list of [exercise,
        points earned, right cases, all cases, words].
    """
    from IPython.core.interactiveshell import InteractiveShell
    from IPython.utils.capture import capture_output

    from hapticlab.course.marks import hidden_cases, marks
    from hapticlab.course.notebook import code_of

    shell, printed, raised = InteractiveShell.instance(), [], []
    shell.reset()
    with tempfile.TemporaryDirectory() as scratch, chdir(shutil.copytree(folder.path, Path(scratch) / folder.name)):
        for source in code_of(notebook):
            with capture_output() as seen:
                ran = shell.run_cell(source)
            texts = [seen.stdout, *(output.data.get("text/plain", "") for output in seen.outputs)]
            printed += [line for text in texts for line in text.splitlines()]
            raised += [f"{type(error).__name__}: {error}" for error in (ran.error_before_exec, ran.error_in_exec) if error]
    found = marks(folder.lab(), shell.user_ns, hidden_cases(folder.lab(), _answers(folder)))
    return {"printed": printed, "raised": raised, "marks": [[m.exercise, m.earned, m.right, m.cases, m.words] for m in found]}


def readme_example():
    """Return position and force of README's example, and what it prints."""
    from contextlib import redirect_stdout
    from io import StringIO

    text = (ROOT / "README.md").read_text("utf-8")
    names, printed = {}, StringIO()
    with redirect_stdout(printed):
        exec(text.partition("```python\n")[2].partition("```")[0], names)
    return {"bits": _bits(names["log"].x, names["log"].F), "printed": printed.getvalue()}


def sweep():
    """Return what the sweep of docs/how_to/scenes.md finds: the chatter of 600 walls."""
    import numpy as np

    import hapticlab as hl

    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand(push=2.0))
    grid = hl.sweep(hl.wall()(x_o=0), paddle, k=np.geomspace(20, 2000, 200), T=[5e-4, 1e-3, 2e-3])
    return {"bits": _bits(grid.values)}


def wall_map():
    """Return what the map of docs/how_to/measuring.md says of 40 x 40 walls: passive, stable, chatters or unusable."""
    import hapticlab as hl

    held = hl.SimulatedPaddle.from_profile("hapkit", coulomb=0.03, hand=hl.Hand("pinch", push=1.0))
    found = hl.stability.wall_map(held, points=40)
    return {"bits": _bits(found.regions, found.amplitude), "about": str(found)}


def tradeoff():
    """Return speed against accuracy of docs/explanation/methods.md: each method's error of force, and its cost on an Uno."""
    import hapticlab as hl

    tried = hl.methods.Tried(T=[2e-3, 1e-3])
    found = hl.methods.tradeoff(hl.library.mass_spring_damper(), hl.library.nominal, tried=tried, targets=["pc", "uno"])
    settings = "T", "method", "substeps", "hold", "force_at", "precision", "target"
    return {"rows": [[*(getattr(row, name) for name in settings), row.status, row.cycles, row.err_max] for row in found.table]}


def _bits(*arrays):
    """Return arrays as texts that hold every bit."""
    return [array.astype("<f8").tobytes().hex() for array in arrays]


WORK = {f.__name__: f for f in (imports, untouched_lab, solved_lab, readme_example, sweep, wall_map, tradeoff)}

if __name__ == "__main__":
    print(json.dumps(WORK[sys.argv[1]](*sys.argv[2:])))
