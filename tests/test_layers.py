"""The architecture: contracts of imports stand in pyproject.toml; here also how long things may be, and what opens when."""

import ast
import re
import subprocess
import sys
import tomllib
from collections import Counter
from pathlib import Path

from importlinter.cli import EXIT_STATUS_SUCCESS, lint_imports

import hapticlab
from hapticlab.cli.options import parser

PACKAGE = Path(hapticlab.__file__).parent
SETTINGS = PACKAGE.parent / "pyproject.toml"
#: 300 lines are a question: is this one thing? Past 450 a module says here why it is: {"scene/module.py": "why"}.
MODULE_LINES, FUNCTION_LINES = 450, 60
LONG_FOR_A_REASON: dict[str, str] = {
    "device/board/serial_paddle.py": "one class; 177 of its lines are docstrings, which say every argument",
}
#: modules in a folder, its __init__ left out
FOLDER = 19
# opens the compiler when a function needs it: what judges answers seldom does
#: and the names in words when a wrong one is asked for
IMPORT_LATE = ("course/felt.py", "__init__.py")


def modules():
    """Yield (path in the package, source) of every module; examples are students' files, no part of it."""
    for path in sorted(PACKAGE.rglob("*.py")):
        name = path.relative_to(PACKAGE)
        if name.parts[0] not in ("examples", "firmware"):
            yield name.as_posix(), path.read_text("utf-8")


def too_long(source):
    """Return the functions, docstrings not counted, and the module that are too long, with their lines."""
    found = {"the module": source.count("\n")} if source.count("\n") > MODULE_LINES else {}
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.FunctionDef):
            body = node.body[1:] if ast.get_docstring(node) else node.body
            lines = node.end_lineno - body[0].lineno + 1 if body else 0
            found |= {node.name: lines} if lines > FUNCTION_LINES else {}
    return found


def own_imports_in_functions(source):
    """Return the lines of functions that import from the package: what is needed is named where a module begins."""
    if not re.search(r"^[ \t]+from\s+(\.|hapticlab)", source, re.M):  # seldom is there one, and to parse all takes a second
        return []
    functions = [f for f in ast.walk(ast.parse(source)) if isinstance(f, ast.FunctionDef | ast.AsyncFunctionDef)]
    nodes = {i for f in functions for i in ast.walk(f) if isinstance(i, ast.ImportFrom)}
    return sorted(i.lineno for i in nodes if i.level or i.module.partition(".")[0] == "hapticlab")


def test_contracts_are_kept(capsys):
    assert lint_imports(str(SETTINGS), no_cache=True) == EXIT_STATUS_SUCCESS, capsys.readouterr().out


def test_a_broken_contract_is_told(tmp_path, capsys):
    """The same contract, upside down."""
    text = SETTINGS.read_text("utf-8")
    rooms = tomllib.loads(text)["tool"]["importlinter"]["contracts"][1]["layers"]
    turned = text[: text.index("[[tool.importlinter.contracts]]")] + (
        '[[tool.importlinter.contracts]]\nname = "turned"\ntype = "layers"\ncontainers = ["hapticlab.compiler"]\n'
        f"layers = {rooms[::-1]}\n"
    )
    (tmp_path / "pyproject.toml").write_text(turned, "utf-8")
    assert lint_imports(str(tmp_path / "pyproject.toml"), no_cache=True) != EXIT_STATUS_SUCCESS
    assert "hapticlab.compiler.algebra is not allowed to import hapticlab" in capsys.readouterr().out


def test_each_module_is_a_page_or_two():
    found = {(name, what): lines for name, source in modules() for what, lines in too_long(source).items()}
    assert {one: lines for one, lines in found.items() if one not in {(name, "the module") for name in LONG_FOR_A_REASON}} == {}


def test_no_function_imports_from_the_package():
    found = {name: own_imports_in_functions(source) for name, source in modules() if name not in IMPORT_LATE}
    assert len(found) > 500 and not {name: lines for name, lines in found.items() if lines}


def test_a_long_function_and_an_import_in_one_are_found():
    body = "\n".join(f"    a{i} = {i}" for i in range(FUNCTION_LINES + 1))
    assert too_long(f"def f():\n    'words'\n{body}\n") == {"f": FUNCTION_LINES + 1}
    assert too_long("a = 1\n" * (MODULE_LINES + 1)) == {"the module": MODULE_LINES + 1}
    assert not too_long("def f():\n    return 1\n")
    assert own_imports_in_functions("from .a import b\ndef f():\n    from .c import d\n    from scipy import e\n") == [3]


def test_each_folder_is_a_room():
    """It has few modules, and its docstring says what it is for."""
    sources = dict(modules())
    inside = Counter(str(Path(name).parent) for name in sources if not name.endswith("__init__.py"))
    assert {folder: many for folder, many in inside.items() if many > FOLDER} == {}, "make rooms by what modules are about"
    folders = {str(Path(name).parent) for name in sources}
    assert [one for one in folders if not ast.get_docstring(ast.parse((PACKAGE / one / "__init__.py").read_text("utf-8")))] == []


HEAVY = (
    "pint", "llvmlite", "wasmtime", "scipy", "matplotlib", "serial", "ipywidgets", "anywidget", "IPython", "tqdm", "distributed",
    "nbgrader", "pytest", "numba",
)  # fmt: skip
FIRST_CELL = """
import hapticlab as hl
from hapticlab import n, x
k, x_o = hl.parameters("k x_o", units="N/m m")
wall = hl.Scene(force=hl.when(x(n) >= x_o, k*(x(n) - x_o)))
bound = wall(k="2 N/mm", x_o="10 mm")
"""


def opened(code, modules):
    """Return which of these modules a new Python has imported after running the code."""
    code += f"\nimport sys; print([name for name in {modules!r} if name in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=PACKAGE.parent, check=True)
    return ast.literal_eval(done.stdout.splitlines()[-1])


def test_import_opens_nothing_heavy():
    assert opened("import hapticlab", (*HEAVY, "sympy", "numpy")) == []


def test_help_waits_for_nothing():
    arguments = [["-h"], ["--version"], *([name, "-h"] for name in parser().commands)]
    code = "import contextlib\nfrom hapticlab.cli.main import main\n"
    code += f"for arguments in {arguments!r}:\n    with contextlib.suppress(SystemExit):\n        main(arguments)"
    assert opened(code, (*HEAVY, "sympy", "numpy", "importlib.metadata")) == []


def test_the_first_scene_waits_for_sympy_alone():
    assert opened(FIRST_CELL, (*HEAVY, "sympy", "numpy")) == ["sympy"]
    assert "pint" in opened(FIRST_CELL + "wall(x_o='1 inch')", HEAVY)  # so that the line above can fail
