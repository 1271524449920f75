"""What a slice says is held against a run of all cells: where it gives an answer, the answer is the same."""

import math
import os
import sys
from pathlib import Path

import numpy as np
import pytest

from hapticlab.course.instructor import solved_notebook
from hapticlab.course.labs import find_labs
from hapticlab.course.marks import marks
from hapticlab.course.notebook import code_of, read
from hapticlab.grading.inside.cells import run_cell
from hapticlab.grading.inside.slices import needed, run_pieces

ANSWERS = Path(__file__).parents[2] / "instructor"
MISSING = "missing"


def values(names, answers):
    """Return what answers are, functions called with 3."""
    return {one: names[one](3) if callable(names.get(one)) else names.get(one, MISSING) for one in answers}


def whole(cells, answers):
    names = {"__name__": "__main__"}
    for number, source in enumerate(cells, start=1):
        run_cell(source, names, number)
    return values(names, answers)


def sliced(cells, answers):
    names, pieces = {"__name__": "__main__"}, needed(cells, answers)
    if pieces is None:  # the whole notebook runs instead
        return dict.fromkeys(answers, MISSING), "unknown"
    problem = run_pieces(cells, pieces, names)
    return values(names, answers), problem


# what a statement left out would make right, one notebook a line: cells, and what the answer k is at the end of each
TRAPS = {
    "bound anew": (["k = 2", "k = 3"], 3),
    "bound anew in a loop": (["k = 2", "for k in (4, 5):\n    pass"], 5),
    "bound anew in a branch": (["k = 2", "if True:\n    k = 7"], 7),
    "bound by with": (["import contextlib\nk = 2", "with contextlib.nullcontext(6) as k:\n    pass"], 6),
    "bound by import": (["pi = 2\nk = pi", "from math import pi", "k = pi > 3"], True),
    "bound by a star": (["e = 2", "from math import *", "k = e > 2.5"], True),
    "bound by a walrus": (["k = 2", "print(k := 9)"], 9),
    "bound by except": (["k = 2", "try:\n    1 / 0\nexcept ZeroDivisionError as k:\n    pass"], MISSING),
    "bound by match": (["k = 2", "match (1, 8):\n    case (1, k):\n        pass"], 8),
    "bound by a class": (
        [
            "k = 2",
            "class k:\n    def __init__(self, x):\n        pass\n    def __eq__(self, other):\n        return other == 1",
        ],
        1,
    ),
    "bound by a tuple": (["k = 2", "(k, b), *c = (3, 4), 5"], 3),
    "deleted": (["k = 2", "del k"], MISSING),
    "added to": (["k = 2", "k += 1"], 3),
    "a global of a function": (["k = 2", "def set_it():\n    global k\n    k = 5", "set_it()"], 5),
    "a global that is deleted": (["k = 2", "def drop():\n    global k\n    del k", "drop()"], MISSING),
    "a global behind two functions": (
        ["k = 2", "def set_it():\n    global k\n    k = 5\ndef call():\n    set_it()", "call()"],
        5,
    ),
    "a constant that a function reads": (["C = 2\ndef k(x):\n    return C * x", "C = 3"], 9),
    "a helper that a function calls": (
        ["def twice(x):\n    return 2 * x\ndef k(x):\n    return twice(x)", "def twice(x):\n    return x"],
        3,
    ),
    "a loop over the name of a constant": (["C = 2\ndef k(x):\n    return C * x", "for C in (5, 6):\n    pass"], 18),
    "an item": (["rows = [1, 2]\ndef k(x):\n    return rows[0] * x", "rows[0] = 4"], 12),
    "a method": (["rows = [1]\ndef k(x):\n    return len(rows) * x", "rows.append(4)"], 6),
    "a method whose result is kept": (["rows = [1, 2]\ndef k(x):\n    return len(rows) * x", "last = rows.pop()"], 3),
    "a method inside print": (["rows = [1, 2]\ndef k(x):\n    return len(rows) * x", "print(rows.pop())"], 3),
    "a function that changes what it is given": (
        ["import random\nrows = [1, 2]\nk = rows", "rows.sort(reverse=True)"],
        [2, 1],
    ),
    "a second name": (["rows = [1]\nk = rows", "other = rows", "other.append(2)"], [1, 2]),
    "two names at once": (["k = rows = [1]", "rows.append(2)"], [1, 2]),
    "a name in a list": (["k = [1]", "several = [k, 3]", "several[0].append(2)"], [1, 2]),
    "a loop over lists": (["k = [1]", "for row in [k]:\n    row.append(2)"], [1, 2]),
    "numpy's out": (
        ["import numpy as np\na = np.array([1.0, 2.0])\ndef k(x):\n    return float(a[0])", "np.negative(a, out=a)"],
        -1.0,
    ),
    "a view of an array": (
        ["import numpy as np\na = np.zeros(2)\ndef k(x):\n    return a[0]", "b = a[:1]", "b += 5"],
        5.0,
    ),
    "a module's function": (
        ["import math\ndef k(x):\n    return math.floor(x / 2)", "import math\nmath.floor = lambda x: 70", "1"],
        70,
    ),
    "a module's other name": (
        ["import math\ndef k(x):\n    return math.ceil(x / 2)", "import math as m\nm.ceil = lambda x: 70"],
        70,
    ),
    "a module's part": (["import os.path\ndef k(x):\n    return os.path.sep", "import os\nos.path.sep = 'T'"], "T"),
    "an attribute of a function": (["def k(x):\n    return k.n\nk.n = 1", "k.n = 2"], 2),
    "an attribute of a class": (["class A:\n    n = 1\ndef k(x):\n    return A.n", "A.n = 2"], 2),
    "a list of a class": (["class A:\n    rows = []\ndef k(x):\n    return len(A.rows)", "A.rows.append(2)"], 1),
    "an object's method": (
        [
            "class A:\n    n = 1\n    def grow(self):\n        self.n += 1\na = A()\ndef k(x):\n    return a.n",
            "a.grow()",
        ],
        2,
    ),
    "an object behind a function": (
        ["rows = []\ndef note(x):\n    rows.append(x)\ndef k(x):\n    return len(rows)", "note(3)"],
        1,
    ),
    "an object behind a lambda": (
        ["rows = []\nnote = lambda x: rows.append(x)\ndef k(x):\n    return len(rows)", "note(3)"],
        1,
    ),
    "a default that grows": (["def k(x, seen=[]):\n    seen.append(x)\n    return len(seen)", "k(1)"], 2),
    "a decorator": (
        [
            "calls = []\ndef noted(f):\n    return lambda x: calls.append(f) or len(calls)\n@noted\ndef k(x):\n    return 0",
            "k(1)",
        ],
        2,
    ),
    "a closure": (
        [
            "def make():\n    n = 0\n    def f(x):\n        nonlocal n\n        n += 1\n        return n\n    return f",
            "k = make()",
            "k(1)",
        ],
        2,
    ),
    "a generator": (["rows = iter([1, 2])\ndef k(x):\n    return next(rows)", "for row in rows:\n    break"], 2),
    "exec": (["k = 2", "exec('k = 3')"], 3),
    "globals": (["k = 2", "globals()['k'] = 3"], 3),
    "setattr of a module": (
        ["import math\ndef k(x):\n    return math.trunc(x)", "setattr(math, 'trunc', lambda x: 71)"],
        71,
    ),
    "the main module": (["k = 2", "import __main__\n__main__.k = 3"], 2),  # of the tests' own process
    "random numbers": (
        [
            "import random",
            "random.seed(1)",
            "random.random()",
            "random.seed(2)\nrandom.random()",
            "k = random.randint(1, 10**6)",
        ],
        993870,
    ),
    "numpy's random numbers": (
        ["import numpy as np", "np.random.seed(1)", "np.random.rand(2)", "k = int(1e6 * np.random.rand())"],
        114,
    ),
    "random numbers under another name": (
        [
            "import random as r",
            "r.seed(1)",
            "r.random()",
            "r.seed(2)\nr.random()",
            "k = r.randint(1, 10**6)",
        ],
        993870,
    ),
    "a function of its own with a builtin's name": (
        ["rows = []\ndef max(*given):\n    return rows", "k = max(1, 2)", "c = k\nc.append(3)"],
        [3],
    ),
    "a module's name for something else": (
        ["import math", "class math:\n    floor = staticmethod(lambda x: [x])", "k = math.floor(2)", "c = k\nc.append(3)"],
        [2, 3],
    ),
    "pyplot under another name": (
        [
            "import matplotlib\nmatplotlib.use('agg')\nimport matplotlib.pyplot as p",
            "p.plot([5, 6])",
            "p.plot([1, 2])\nfigure = p.gcf()\ndef k(x):\n    return len(figure.axes[0].lines)\np.plot([3, 4])",
        ],
        2,
    ),
    "files": (
        [
            "from pathlib import Path\nPath('slice.txt').write_text('4')",
            "Path('slice.txt').write_text('5')",
            "k = Path('slice.txt').read_text()",
        ],
        "5",
    ),
    "numpy's errors": (
        [
            "import numpy as np\ndef k(x):\n    with np.errstate():\n        return str(np.geterr()['over'])",
            "np.seterr(over='ignore')",
        ],
        "ignore",
    ),
    "the recursion limit": (
        ["import sys\ndef k(x):\n    return sys.getrecursionlimit()", "sys.setrecursionlimit(1234)"],
        1234,
    ),
    "a cell that fails before": (["k = 1", "print(nothing)\nk = 2"], 1),
    "a cell that fails before, deep": (["k = 1", "if 3:\n    nothing()\nk = 2"], 1),
    "a cell that fails after": (["k = 1", "k = 2\nprint(nothing)"], 2),
    "a binding that fails": (["k = 1", "k = nothing"], 1),
    "a helper whose binding fails": (["C = 1\ndef k(x):\n    return C * x", "C = 1 / 0"], 3),
    "an import that fails": (["k = 1", "import no_such_module\nk = 2"], 1),
    "a raise": (["k = 1", "raise SystemExit\nk = 2"], 1),
    "an assertion": (["k = 1", "assert k == 2\nk = 2"], 1),
    "a cell that is no Python": (["k = 1", "k = 2\ndef f(:"], 1),
    "a cell that only fails to compile": (["k = 1", "k = 2\nreturn k"], 1),
    "a magic": (["%matplotlib inline\nk = 1", "%%time\nk = 2", "%%bash\nk = 3"], 2),
    "await": (["async def two():\n    return 2", "k = await two()"], 2),
    "statements on one line": (["k = 1; b = 2; k += b"], 3),
    "statements that share lines": (["k = '''1\n'''; b = (\n2)"], "1\n"),
    "annotations of the future": (["from __future__ import annotations", "def k(x: nothing):\n    return x"], 3),
    "a string that names it": (["k = 2", "vars()['k'] = 4"], 4),
    "an unpacked call": (["rows = [1, 2]\nk = rows", "def turn(a):\n    a.reverse()", "turn(*[rows])"], [2, 1]),
    "a print of its own": (["rows = [1]\nk = rows", "def print(what):\n    what.append(2)", "print(rows)"], [1, 2]),
    "a check of its own": (
        [
            "import types\nhl = types.SimpleNamespace()\nrows = [1]\nk = rows",
            "hl.check = lambda name, what: what.append(2)",
            "hl.check('01.k', rows)",
        ],
        [1, 2],
    ),
    "a cell that fails by what changed before it": (["k = 1\nrows = [1]", "rows.clear()", "rows[0]\nk = 2"], 1),
    "a cell that fails by what changed under another name": (
        ["k = 1\nrows = [1]", "other = rows", "other.clear()", "rows[0]\nk = 2"],
        1,
    ),
    "a cell that fails in a function": (
        ["k = 1\nrows = [1]\ndef first():\n    return rows[0]", "rows.clear()", "first()\nk = 2"],
        1,
    ),
    "a second name in the cell of the answer": (["rows = [1]", "other = rows\nk = rows", "other.append(2)"], [1, 2]),
    "a name that a cell needs twice": (["rows = [1]", "rows[0]\nb = rows\nb[0]\nk = b", "rows.append(2)"], [1, 2]),
    "a loop's name, afterwards": (["k = [1]", "for row in [k]:\n    pass", "row.append(2)"], [1, 2]),
    "a loop's name, before": (["k = [1]\nrow = k", "for row in []:\n    pass", "row.append(2)"], [1, 2]),
    "a loop over its own name": (["row = [1]\nk = row", "for row in [row, [5]]:\n    row.append(2)"], [1, 2]),
    "a loop with else": (["k = [1]\nrow = k", "for row in []:\n    pass\nelse:\n    row.append(2)"], [1, 2]),
    "a loop's name in a function": (["k = [1]", "def grow():\n    row.append(2)", "for row in [k]:\n    grow()"], [1, 2]),
    "a loop inside a loop": (
        ["k = [1]\nrow = k", "for n in (1, 2):\n    row.append(n)\n    for row in [[0]]:\n        pass"],
        [1, 1],
    ),
    "a second name whose next binding fails": (["k = [1]", "b = k\nb = nothing", "b.append(2)"], [1, 2]),
    "a function whose next binding is not reached": (
        ["k = [1]\ndef f():\n    k.append(2)", "nothing()\ndef f():\n    pass", "f()"],
        [1, 2],
    ),
    "a cell that deletes what is deleted": (["k = [1]\na = 1", "del a", "del a\nk.clear()"], [1]),
    "a list that a text gives": (["k = 'a b'.split()", "k.append('c')"], ["a", "b", "c"]),
    "a set that an expression gives": (["import sympy as sp\ns = sp.Symbol('s')\nk = s.free_symbols", "k.clear()"], set()),
    "a signal's name for something else": (
        [
            "import hapticlab as hl\nrows = [1]\ny = hl.signal('y', unit='m')",
            "if True:\n    y = lambda n: rows",
            "k = y(2)",
            "c = k\nc.append(3)",
        ],
        [1, 3],
    ),
    "shown first": (["rows = [3]\nk = rows\nprint(rows)", "print(rows, rows.append(1))"], [3, 1]),
}


@pytest.fixture
def modules(monkeypatch, tmp_path):
    """What the traps change outside of their notebook is put back, between two runs and at the end."""
    kept, sep, limit = dict(vars(math)), os.path.sep, sys.getrecursionlimit()

    def put_back():
        vars(math).update(kept)
        os.path.sep = sep
        sys.setrecursionlimit(limit)

    monkeypatch.chdir(tmp_path)
    with np.errstate():
        yield put_back
    put_back()


@pytest.mark.parametrize("trap", TRAPS)
def test_a_slice_gives_no_answer_that_the_notebook_does_not_give(trap, modules):
    cells, expected = TRAPS[trap]
    assert whole(cells, ["k"])["k"] == expected
    modules()
    found, problem = sliced(cells, ["k"])
    assert found["k"] == (MISSING if problem else expected)


@pytest.mark.parametrize(
    ("cells", "kept"),
    [
        (["k = 2", "print(k)", "hl.check('01.k', k)", "b = k + 1", "b"], [(0, 1, 1)]),
        (["import math\nimport numpy as np", "area = math.pi", "k = 2"], [(2, 1, 1)]),
        (
            ["import numpy as np", "def k(x):\n    return np.sin(x)", "rows = np.array([k(1)])\nrows.sort()"],
            [(0, 1, 1), (1, 1, 2)],
        ),
        (["C = 5\nfor C in rows:\n    simulate(C)", "C = 2", "k = 3 * C"], [(1, 1, 1), (2, 1, 1)]),
        (["print(1)\nk = 2", "print(3)"], [(0, 1, 1), (0, 2, 2)]),
        (["def other(x):\n    return 1 / 0\nk = 2"], [(0, 3, 3)]),
        (["@wrong\ndef other(x):\n    return 1\nk = 2"], [(0, 1, 3), (0, 4, 4)]),
        (["k = 2", "def f(load, random, compile):\n    return load(compile)\nf(1, 2, 3)"], [(0, 1, 1)]),
        (["result = hl.check('01.k', k)\nif result.passed:\n    k = 2"], [(0, 1, 1), (0, 2, 3)]),
        (["times = made()\nk = 3", "times.append(2)\nplotted(times)"], [(0, 1, 1), (0, 2, 2)]),
        (
            ["for row in rows:\n    plotted(row)", "k = [2]", "for row in k:\n    plotted(row)"],
            [(1, 1, 1), (2, 1, 2)],
        ),
        (
            [
                "import hapticlab as hl, sympy as sp\nfrom hapticlab import n, x",
                "paddle = hl.devices.profile('hapkit')\nstiff = round(0.8 * hl.passivity_limit(paddle).K)",
                "c = hl.parameters('c', units='N/m', values=stiff)\ny = hl.signal('y', unit='m')",
                "kept = hl.when(x(n) > 0, 1, y(n - 1))\nk = hl.Scene(force=c * y(n), eom=[sp.Eq(y(n), kept)])",
                "machines = {'k': k(c=3)}\nsimulated(machines, paddle, k, c)",
            ],
            [(cell, line, line) for cell in range(4) for line in (1, 2)],
        ),
    ],
)
def test_what_shows_checks_or_goes_on_with_an_answer_is_left_out(cells, kept):
    assert needed(cells, ["k"]) == kept


@pytest.mark.parametrize(
    "cell",
    [
        "import sys\nk = len(sys._getframe().f_code.co_name)",
        "import traceback\nk = str(traceback.extract_stack())",
        "try:\n    1 / 0\nexcept ZeroDivisionError as e:\n    k = e.__traceback__.tb_frame.f_back",
        "k = (lambda: (yield))().gi_frame",
        "from inspect import stack\nk = len(stack())",
        "exec('k = 2')",
    ],
)
def test_code_that_can_see_what_runs_it_is_run_by_nothing_but_the_whole_notebook(cell):
    assert needed(["k = 2", cell], ["k"]) is None
    assert needed(["k = 2", "b = 3"], ["k"]) == [(0, 1, 1)]


def test_names_that_are_never_bound_need_nothing():
    assert needed(["import numpy as np", "b = 2"], ["k"]) == []


@pytest.mark.parametrize("folder", find_labs(), ids=lambda folder: folder.name)
@pytest.mark.always("02_*", "03_*", "09_*")
def test_the_slice_of_a_solved_lab_earns_full_marks(folder, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    lab, cells = folder.lab(), code_of(solved_notebook(folder, ANSWERS / folder.name))
    judged = [one.name for one in lab.exercises if one.judged]
    pieces, names = needed(cells, judged), {"__name__": "__main__"}
    assert run_pieces(cells, pieces, names) == ""
    assert sum(mark.earned for mark in marks(lab, names)) == lab.points > 0
    part = sum(last - first + 1 for _, first, last in pieces) / sum(len(source.splitlines()) for source in cells)
    assert part < 0.5


@pytest.mark.parametrize("folder", find_labs(), ids=lambda folder: folder.name)
@pytest.mark.always("0[!4]*", "10*")
def test_the_slice_of_an_untouched_lab_runs_and_earns_nothing(folder, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    lab, cells = folder.lab(), code_of(read(folder.notebook))
    names = {"__name__": "__main__"}
    assert run_pieces(cells, needed(cells, [one.name for one in lab.exercises if one.judged]), names) == ""
    assert sum(mark.earned for mark in marks(lab, names)) == 0
