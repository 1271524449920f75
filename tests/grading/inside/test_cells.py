"""Cells run here as IPython runs them, which is asked where it is there; and whatever they raise comes back as one line."""

import ast
import inspect
import sys

import pytest

from hapticlab.grading.inside.cells import Quiet, fresh_names, run_cell, runnable
from hapticlab.grading.inside.source_lines import logical_lines, statements

# cells, and the names that they bind
CELLS = {
    "plain": ("k = 2\nb = k % 3\n", {"k": 2, "b": 2}),
    "a magic before": ("%matplotlib inline\nk = 2", {"k": 2}),
    "a magic in a branch": ("if True:\n    %pwd\nk = 2", {"k": 2}),
    "a shell line with a quote": ("!echo it's (\nk = 2", {"k": 2}),
    "a long shell line": ("!echo a \\\n   b\nk = 2", {"k": 2}),
    "no magic in brackets": ("k = (7\n %4)\nd = '''\n%pwd\n!ls\n'''", {"k": 3, "d": "\n%pwd\n!ls\n"}),
    "no magic after a backslash": ("k = 7 \\\n %4", {"k": 3}),
    "a question": ("k = 2\nk?\n?k\nk??", {"k": 2}),
    "a question in a text": ("k = 'is it?'\n# really?\n", {"k": "is it?"}),
    "a timed statement": ("%time k = 2", {"k": 2}),
    "a timed cell": ("%%time\nk = 2", {"k": 2}),
    "a captured cell": ("%%capture\n%pwd\nk = 2", {"k": 2}),
    "another language": ("%%html\nk = 2", {}),
    "lines before": ("\n\n%%time\nk = 2", {"k": 2}),
    "indented": ("    k = 2\n    if k:\n        b = 3\n", {"k": 2, "b": 3}),
    "with prompts": (">>> k = 2\n>>> if k:\n...     b = 3\n... \n", {"k": 2, "b": 3}),
    "with carriage returns": ("k = 2\r\n%pwd\r\nb = 3\r\n", {"k": 2, "b": 3}),
    "await": ("import asyncio\nk = await asyncio.sleep(0, 7)", {"k": 7}),
    "an async loop": ("async def f():\n    yield 4\nasync for k in f():\n    pass", {"k": 4}),
    "a nested format": ("a = {'b': 2}\n%pwd\nk = f\"{a['b']}\"", {"k": "2"}),
    "an empty text": ("%pwd\nk = \"\" + ''", {"k": ""}),
}


@pytest.mark.parametrize("cell", CELLS)
def test_a_cell_binds_what_it_binds_in_jupyter(cell):
    source, expected = CELLS[cell]
    names = {"__name__": "__main__"}
    assert run_cell(source, names, 1) == ""
    assert {name: names[name] for name in expected} == expected
    assert len(runnable(source).split("\n")) in (1, len(source.splitlines()), len(source.split("\n")))
    if not expected:
        assert "k" not in names


@pytest.mark.parametrize("cell", [name for name, (source, _) in CELLS.items() if "%time" not in source and "%cap" not in source])
def test_ipython_agrees(cell):
    """Its transformations of the source, with magics that do nothing."""
    manager = pytest.importorskip("IPython.core.inputtransformer2").TransformerManager()
    source, expected = CELLS[cell]
    names = {"get_ipython": lambda: Quiet()}
    assert run_cell(manager.transform_cell(source.replace("\r\n", "\n")), names, 1) == ""
    assert {name: names[name] for name in expected} == expected


class Wrong(Exception):
    def __str__(self):
        raise RuntimeError


PROBLEMS = {
    "a = 1\nforce = a*y": "NameError in line 2: name 'y' is not defined",
    "%pwd\n\nk = (1,\n  2 +* 3)": "SyntaxError in line 4: invalid syntax",
    "def f(x):\n    return 1/x\n\nf(0)": "ZeroDivisionError in line 2: division by zero",
    "import sys\nsys.exit('bye')": "SystemExit in line 2: bye",
    "raise KeyboardInterrupt": "KeyboardInterrupt in line 1",
    "raise GeneratorExit('x')": "GeneratorExit in line 1: x",
    "def f(n):\n    return f(n + 1)\nf(0)": "RecursionError in line 2: maximum recursion depth exceeded",
    "raise MemoryError": "MemoryError in line 1",
    "k = '\ud800": "UnicodeEncodeError: 'utf-8' codec can't encode character '\\ud800' in position 5: surrogates not allowed",
    "class E(Exception):\n    def __str__(self):\n        raise SystemExit\nraise E": "E in line 4: no readable message",
    "class E(Exception):\n    def __str__(self):\n        return 'a\\n\\n b' * 10**6\nraise E": "E in line 4: a ba ba ba b",
    "class M(type):\n    __name__ = property(lambda c: 1 / 0)\nclass E(Exception, metaclass=M):\n    pass\nraise E('here')": (
        "E in line 5: here"
    ),
    "class E(Exception):\n    __traceback__ = property(lambda s: 1 / 0)\nraise E": "an error that cannot be read",
    "import asyncio\nawait asyncio.sleep(0)\nawait 3": "TypeError in line 3: ",  # then Python's words, which change
    "return 3": "SyntaxError in line 1: 'return' outside function",
    "input()": None,
}


@pytest.mark.parametrize("source", PROBLEMS, ids=range(len(PROBLEMS)))
def test_a_problem_is_one_line_and_nothing_is_raised(source, monkeypatch):
    monkeypatch.setattr(sys, "stdin", None)
    told = run_cell(source, {"__name__": "__main__"}, 4)
    assert told.startswith(PROBLEMS[source] or "RuntimeError in line 1: ")
    assert PROBLEMS[source] or told.endswith("lost sys.stdin")
    assert "\n" not in told
    assert len(told) < 360


def test_a_null_byte_is_a_problem():
    assert "null bytes" in run_cell("k = 1\x00", {}, 1)  # a ValueError or a SyntaxError, as Python's version has it


def test_a_problem_in_a_function_of_another_cell_names_that_cell():
    names = {"__name__": "__main__"}
    assert run_cell("\n\ndef force(x):\n    return k * x", names, 2) == ""
    assert run_cell("print(2)\nforce(3)", names, 7) == "NameError in line 4 of cell 2: name 'k' is not defined"


def test_what_follows_a_problem_in_its_cell_does_not_run_and_what_is_before_it_stays():
    names = {"__name__": "__main__"}
    run_cell("a = 1\nb = 1 / 0\nc = 3", names, 1)
    assert run_cell("d = a", names, 2) == ""
    assert {"a", "b", "c", "d"} & set(names) == {"a", "d"}


def test_the_figures_of_pyplot_are_closed_after_each_cell_as_in_jupyter():
    names = {}
    draw = "from matplotlib import pyplot as plt\nplt.plot([0, 1], [2, 3])\nfirst = plt.gcf()"
    assert run_cell(draw, names, 1) == "" == run_cell("plt.plot([0, 1], [4, 5])\nlines = plt.gca().get_lines()", names, 2)
    assert len(names["lines"]) == 1 == len(names["first"].axes)
    assert run_cell("plt.figure()\n1/0", names, 3).startswith("ZeroDivisionError") and not names["plt"].get_fignums()
    assert run_cell("\nplt.plot([0, 1], [2, 3])", names, 2) == "" == run_cell("\n\nlines = plt.gca().get_lines()", names, 3)
    assert len(names["lines"]) == 1  # statements of a script draw into the same one
    spoil = "import sys\nclass Spoilt:\n  def close(self, what): sys.exit()\nsys.modules['matplotlib.pyplot'] = Spoilt()"
    kept = sys.modules["matplotlib.pyplot"]
    try:
        assert run_cell(spoil, names, 4) == ""
    finally:
        sys.modules["matplotlib.pyplot"] = kept


def test_the_source_of_a_function_is_found():
    names = {"__name__": "__main__"}
    run_cell("%pwd\ndef force(x):\n    return 2 * x  # N\n", names, 5)
    assert inspect.getsource(names["force"]) == "def force(x):\n    return 2 * x  # N\n"


def test_the_namespace_is_that_of_a_main_module(monkeypatch):
    monkeypatch.setitem(sys.modules, "__main__", sys.modules["__main__"])
    names = fresh_names()
    told = run_cell(
        "import pickle, __main__\ndef f():\n    return 3\nback = pickle.loads(pickle.dumps(f))()\nsame = __main__.f is f\n"
        "h = display(f, display_id=True)\nh.update(3)\nget_ipython().run_line_magic('matplotlib', 'inline')\n"
        "colab = 'google.colab' in str(get_ipython())\nkernel = 'IPKernelApp' in get_ipython().config",
        names, 1,
    )  # fmt: skip
    assert told == ""
    assert (names["back"], names["same"], names["colab"], names["kernel"]) == (3, True, False, False)


def test_what_comes_from_the_future_holds_for_later_cells():
    names = {"__name__": "__main__"}
    asked = "def f(x: Nothing): pass\nf.__annotations__"  # Python 3.14 evaluates when it is asked
    assert run_cell(asked, names, 1).startswith("NameError in line ")
    run_cell("from __future__ import annotations", names, 2)
    assert run_cell(asked, names, 3) == ""
    assert names["f"].__annotations__ == {"x": "Nothing"}


SCRIPTS = {
    "import math\n\nk = 2\n": ["import math\n", "\nk = 2\n"],
    "if a:\n    b\n\n# why\nelif c:\n    d\nelse:\n    e\nf": ["if a:\n    b\n\n# why\nelif c:\n    d\nelse:\n    e\n", "f"],
    "try:\n  a\nexcept E:\n  b\nfinally:\n  c\nd\n": ["try:\n  a\nexcept E:\n  b\nfinally:\n  c\n", "d\n"],
    "@a\n# of b\n@b(\n1)\ndef c():\n    '''\nd\n'''\n\n    e\n": ["@a\n# of b\n@b(\n1)\ndef c():\n    '''\nd\n'''\n\n    e\n"],
    "a = [\n1,\n# (\n')',\n]\nb": ["a = [\n1,\n# (\n')',\n]\n", "b"],
    "a = (1,\ndef b():\n    c\n": ["a = (1,\n", "def b():\n    c\n"],
    "%a it's\n!b (\nc": ["%a it's\n", "!b (\n", "c"],
    "# only this": [],
    "a = '''\nnever closed\n": ["a = '''\nnever closed\n"],
    "a = 'never closed\nb = \"it's\"\nc": ["a = 'never closed\n", 'b = "it\'s"\n', "c"],
    "# %%\na\n# %% [markdown]\n# b\n": ["# %%\na\n# %% [markdown]\n# b\n"],
    "a = \\\n  2\nb": ["a = \\\n  2\n", "b"],
    "x = [\nfor_ := 1\nfor y in z\n]\n": ["x = [\nfor_ := 1\nfor y in z\n]\n"],
}


@pytest.mark.parametrize("source", SCRIPTS, ids=range(len(SCRIPTS)))
def test_a_script_falls_into_its_statements(source):
    assert statements(source) == SCRIPTS[source]
    assert "".join(logical_lines(source)) == source


def test_python_agrees_where_statements_begin():
    source, line, spans = inspect.getsource(inspect), 1, []
    for part in statements(source):
        spans.append((line, line + part.count("\n")))
        line = spans[-1][1]
    nodes = ast.parse(source).body
    assert len(spans) == len(nodes) > 100
    assert all(first <= node.lineno <= node.end_lineno < end for (first, end), node in zip(spans, nodes, strict=True))
