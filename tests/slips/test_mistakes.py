"""Each mistake of the table, in a shell of IPython: the message names it and its cure, and shows the student's own line alone."""

import re
import sys
import warnings

import matplotlib.pyplot as plt
import pytest
from IPython.core.interactiveshell import InteractiveShell
from mistakes import BEFORE, CELLS, CHECKS, PENDULUM, WEAKER
from traitlets.config import Config

from hapticlab.slips.shown import show_in

#: these open pyplot, every page, or pint
SLOW = ("plot of a symbol", "misspelt name", "unit Nm-1")
ANSI = re.compile(r"\x1b\[[0-9;]*m")


@pytest.fixture(scope="module")
def kernel():
    main = sys.modules["__main__"]
    shell = InteractiveShell(config=Config(HistoryManager={"enabled": False}))
    show_in(shell)
    for cell in (BEFORE, PENDULUM):
        shell.run_cell(cell).raise_error()
    yield shell, dict(shell.user_ns)
    plt.close("all")
    sys.modules["__main__"] = main


@pytest.fixture
def shell(kernel):
    """The shell with every name as before the first cell, whatever another one did to it."""
    shell, names = kernel
    shell.user_ns.update(names)
    return shell


def said(shell, capsys, cell):
    """What a cell prints: its place, the own line indented, the sentence, and how to see more."""
    capsys.readouterr()
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always")
        shell.run_cell(cell, store_history=True)
    out, err = capsys.readouterr()
    warned = (warnings.formatwarning(one.message, one.category, one.filename, one.lineno) for one in heard)
    return ANSI.sub("", "".join((*warned, err, out)))


def a_sixth(names):
    """Of the mistakes, which CI tries all, README's line tries each sixth."""
    later = {name for number, name in enumerate(names) if name in SLOW or number % 6}
    return [pytest.param(name, marks=[pytest.mark.wide] * (name in later)) for name in names]


@pytest.mark.parametrize("name", a_sixth(CELLS))
def test_a_mistake_is_named_with_its_cure(shell, capsys, name):
    cell, mistake, cure = CELLS[name]
    text = said(shell, capsys, cell)
    sentence = re.sub(r"(?m)^    .*\n|^Out\[.*|^SyntaxError: .*", "", text)
    assert re.search(mistake, sentence), text
    assert re.search(cure, sentence), text
    assert "site-packages" not in text and "hapticlab/" not in text, text


@pytest.mark.parametrize("name", a_sixth(CHECKS))
def test_a_wrong_answer_is_named_with_its_cure(shell, capsys, name):
    cell, mistake, cure = CHECKS[name]
    text = said(shell, capsys, cell)
    sentence = re.sub(r"(?m)^  hint: .*\n|^    .*\n|^Out\[.*", "", text)
    assert re.search(mistake, sentence), text
    assert re.search(cure, sentence), text


def test_the_table_is_as_long_as_promised():
    assert len(CELLS) > 85 and len(CHECKS) > 50
    assert set(WEAKER) <= {*CELLS, *CHECKS} and len(WEAKER) <= 5


def test_an_error_is_the_own_line_and_the_sentence_and_the_rest_one_call_away(shell, capsys):
    text = said(shell, capsys, "a = 1\nhl.Scene(\n    force=k*x(n) + x(n))  # a sum")
    where, first, second, _, sentence, _, more = text.rstrip().splitlines()
    assert re.fullmatch(r"UnitsError in Cell In\[\d+\], line 2", where)
    assert (first, second) == ("    hl.Scene(", "        force=k*x(n) + x(n))  # a sum")
    assert sentence.startswith("force: k*x(n) is in N but x(n) is in m.")
    assert more == "%tb shows the whole traceback."
    for _ in range(2):  # the whole, as often as it is asked for
        whole = said(shell, capsys, "%tb")
        assert "Traceback (most recent call last)" in whole
        assert "hapticlab/scene/notation/units.py" in whole.replace("\\", "/")


@pytest.mark.parametrize("xmode", ["Plain", "Context"])
@pytest.mark.parametrize(
    "cell",
    [
        "a = sp.Symbol('a')\nif a > 1:\n    pass",
        "np.sin(np.array([sp.Symbol('a')]))",
        "max(np.ones(3), 0)",
        "math.sin(sp.Symbol('a'))",
        "{}['a']",
        "int('a')",
        "[1][hl.Device]",
        "def f():\n    return 1 ^ 'a'\n\nf()",
        "raise ExceptionGroup('several', [ValueError('1')])",
        # beside what hapticlab made, and not about it
        "log.F[0] + ' N'",
        "[paddle.run(wall, 0.01) for i in range(3.0)]",
        "log.F[0][1]",
        "np.sin('a') + log.F",
        "np.sqrt(np.array([2**70, 1], dtype=object) * 1) * k",
        "[1, 2](k)",
        "None.diff(t)",
        "sum(k for k in 3)",
        "k + pandas",
        "open(k.name)",
        "x(n",
        "2a = 3",
        "f(1) = 2",
    ],
)
@pytest.mark.always(*(f"{cell}-Context" for cell in ("a = *", "[[]1[]][[]hl*", "raise *", "log.F[[]0[]] + *", "None*", "x(n")))
def test_what_is_none_of_hapticlab_is_shown_as_ever(shell, capsys, cell, xmode):
    """Word for word what a shell shows that has never heard of hapticlab."""
    said(shell, capsys, f"%xmode {xmode}")
    ours = said(shell, capsys, cell)
    before, shell.custom_exceptions = shell.custom_exceptions, ()
    try:
        theirs = said(shell, capsys, cell)
    finally:
        shell.custom_exceptions = before
        said(shell, capsys, "%xmode Context")
    number = re.compile(r"(In|input-?)\s?\W\d+\S*")
    assert number.sub("", ours) == number.sub("", theirs) != ""


def test_a_file_that_a_notebook_runs_shows_its_own_line(shell, capsys, tmp_path):
    (tmp_path / "wall.py").write_text("from hapticlab import Scene, n, x\n\nScene(force=x(n))\n")
    text = said(shell, capsys, f"%run {(tmp_path / 'wall.py').as_posix()}")
    assert text.startswith("UnitsError in wall.py, line 3\n    Scene(force=x(n))\n\nforce: x(n) is in m but"), text


def test_a_handler_that_was_there_before_keeps_its_errors(capsys):
    main = sys.modules["__main__"]
    shell = InteractiveShell(config=Config(HistoryManager={"enabled": False}))
    shell.set_custom_exc((KeyError,), lambda *_, **__: print("their own") or [])
    show_in(shell)
    try:
        assert said(shell, capsys, "{}['a']").strip() == "their own"
        assert "UnitsError in" in said(shell, capsys, f"{BEFORE}\nhl.Scene(force=x(n))")
    finally:
        sys.modules["__main__"] = main
