"""The same in a script: Python's own hook is asked for everything that is none of hapticlab's, and for the whole."""

import subprocess
import sys

import pytest

from hapticlab.slips.shown import show_in_script

BEGIN = "import hapticlab as hl\nfrom hapticlab import n, x\n\nk, x_o = hl.parameters('k x_o', units='N/m m')\n"
OURS = f"{BEGIN}hl.Scene(force=x(n))\n"
FOREIGN = f"{BEGIN}if x(n) > x_o:\n    pass\n"
OTHERS = f"{BEGIN}import sympy as sp\nif sp.Symbol('a') > 0:\n    pass\n"
MISSPELT = f"{BEGIN}hl.Sceen(force=0)\n"  # which says the cure itself


def raised(source, file):
    """The error of a script, with its traceback."""
    file.write_text(source)
    try:
        exec(compile(source, str(file), "exec"), {"__name__": "__main__"})
    except Exception as problem:
        return problem
    raise AssertionError("it raised nothing")


def test_an_error_of_hapticlab_is_shown_in_one_breath(tmp_path, capsys):
    problem = raised(OURS, tmp_path / "wall.py")
    show_in_script(problem, lambda: pytest.fail("Python's own hook is not asked"))
    where, own, _, said, _, more = capsys.readouterr().err.splitlines()
    assert where == "UnitsError in wall.py, line 5"
    assert own == "    hl.Scene(force=x(n))"
    assert said.startswith("force: x(n) is in m but (force, in N) is in N.")
    assert more == "python -X dev wall.py shows the whole traceback."


@pytest.mark.parametrize(
    ("source", "notes"), [(FOREIGN, 1), (OTHERS, 0), ("1/0", 0), pytest.param(MISSPELT, 0, marks=pytest.mark.wide)]
)
def test_another_librarys_error_is_shown_by_python_with_a_note_where_it_is_ours(tmp_path, capsys, source, notes):
    problem, asked = raised(source, tmp_path / "wall.py"), []
    show_in_script(problem, lambda: asked.append(True))
    assert asked == [True] and capsys.readouterr().err == ""
    said = getattr(problem, "__notes__", [])
    assert len(said) == notes and all("hl.when(x(n) > x_o, a, b)" in one for one in said)


@pytest.mark.wide
@pytest.mark.parametrize(
    ("source", "options", "first", "last"),
    [
        (OURS, [], "UnitsError in wall.py, line 5", "python -X dev wall.py shows"),
        (OURS, ["-X", "dev"], "Traceback (most recent call last)", "hapticlab.errors.UnitsError: force: x(n) is in m"),
        (FOREIGN, [], "Traceback (most recent call last)", "`if` has to know at once whether x(n) > x_o holds"),
        (OTHERS, [], "Traceback (most recent call last)", "TypeError: cannot determine truth value of Relational: a > 0"),
    ],
)
def test_a_script(tmp_path, source, options, first, last):
    (tmp_path / "wall.py").write_text(source)
    done = subprocess.run([sys.executable, *options, "wall.py"], cwd=tmp_path, capture_output=True, text=True)
    lines = done.stderr.splitlines()
    assert done.returncode == 1
    assert lines[0].startswith(first) and lines[-1].startswith(last), done.stderr
