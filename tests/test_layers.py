"""The architecture: imports point one way, each heavy dependency has one door, nothing grows past a page or two."""

import ast
import functools
import subprocess
import sys
from pathlib import Path

import pytest

import hapticlab

PACKAGE = Path(hapticlab.__file__).parent
LAYERS = (
    "errors", "records", "drawing", "scene", "library", "compiler", "device", "limits", "rendering", "analysis",
    "measurement", "identification", "experiments", "course", "grading", "widgets", "cli", "self_test",
)  # fmt: skip
# the public names, and `python -m hapticlab`: above every layer; what Jupyter's server loads, which opens nothing else
OUTSIDE = {"__init__", "__main__", "_jupyter"}
# dependency -> the only modules that may open it
DOORS = {
    "pint": {"scene.notation.units"},
    "llvmlite": {"compiler.engines.llvm", "compiler.engines.llvm_emit"},
    "scipy": {"analysis.accuracy.hybrid_solver", "limits.matrix", "identification.fit", "experiments.fit"},
    "matplotlib": {"drawing"},
    "serial": {"device.link.serial_ports", "device.urls.protocol_sim"},
    "ipywidgets": {"widgets.view", "widgets.plain"},
    "anywidget": {"widgets.front"},
    "IPython": {"widgets.show"},
    "tqdm": {"device.progress"},
    "distributed": {"grading.cluster"},
    "nbgrader": {"grading.export.gradebook"},
    "pytest": set(),
}
# modules that open their dependency at once, because nothing imports them but a function that has opened it already
BEHIND_A_DOOR = {"compiler.engines.llvm_emit", "device.urls.protocol_sim"}
# modules that open the compiler when a function needs it: what judges answers seldom does
OPENS_THE_COMPILER = {"course.felt"}
FUNCTION_LINES, MODULE_LINES = 60, 300


def modules(package):
    """Yield (dotted name inside the package, source) of every module; examples are students' files, no part of it."""
    for path in sorted(package.rglob("*.py")):
        parts = path.relative_to(package).with_suffix("").parts
        if parts[0] not in ("examples", "firmware"):
            yield ".".join(parts[:-1] if parts[-1] == "__init__" and len(parts) > 1 else parts), path.read_text("utf-8")


@functools.cache
def parsed(source):
    return ast.parse(source)


def imported(name, is_package, node):
    """Return the absolute dotted names an import statement opens; names inside the package start with hapticlab."""
    if isinstance(node, ast.Import):
        return [alias.name for alias in node.names]
    base = ["hapticlab", *name.split(".")] if name != "__init__" else ["hapticlab"]
    if node.level:
        keep = len(base) - node.level + (1 if is_package else 0)
        prefix = ".".join(base[:keep] + ([node.module] if node.module else []))
    else:
        prefix = node.module
    return [f"{prefix}.{alias.name}" for alias in node.names]


def in_functions(tree):
    """Return the import statements inside functions."""
    bodies = [f for f in ast.walk(tree) if isinstance(f, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda)]
    return {i for f in bodies for i in ast.walk(f) if isinstance(i, ast.Import | ast.ImportFrom)}


def faults(name, source, is_package=False):
    """Return what one module does against the architecture, one line each."""
    tree, found = parsed(source), []
    deferred = in_functions(tree)
    layer = name.split(".")[0]
    for node in ast.walk(tree):
        if not isinstance(node, ast.Import | ast.ImportFrom):
            continue
        for target in imported(name, is_package, node):
            root, *inside = target.split(".")
            if root in DOORS and name not in DOORS[root]:
                found.append(f"{name}:{node.lineno} opens {root}; its door is {sorted(DOORS[root]) or 'tests only'}")
            if root in DOORS and node not in deferred and name not in BEHIND_A_DOOR:
                found.append(f"{name}:{node.lineno} imports {root} at once; open it inside the function that needs it")
            if root != "hapticlab" or target == "hapticlab.__version__":
                continue
            if node in deferred and not (name in OPENS_THE_COMPILER and inside[0] == "compiler"):
                found.append(f"{name}:{node.lineno} imports {target} inside a function")
            if layer in OUTSIDE:
                continue
            below = inside[0] if inside else ""
            if below not in LAYERS or LAYERS.index(below) > LAYERS.index(layer):
                found.append(f"{name}:{node.lineno} imports {target}, which is not below {layer}")
    return found


def lengths(name, source):
    """Return the functions and modules that are too long."""
    found = [f"{name} has {source.count(chr(10))} lines"] if source.count("\n") > MODULE_LINES else []
    for node in ast.walk(parsed(source)):
        if isinstance(node, ast.FunctionDef):
            body = node.body[1:] if ast.get_docstring(node) else node.body
            lines = node.end_lineno - body[0].lineno + 1 if body else 0
            if lines > FUNCTION_LINES:
                found.append(f"{name}.{node.name} has {lines} lines after its docstring")
    return found


def cycles(graph):
    """Return the modules that can reach themselves."""
    reach, before = {name: set(targets) for name, targets in graph.items()}, None
    while reach != before:
        reach, before = {name: near | {far for k in near for far in reach.get(k, ())} for name, near in reach.items()}, reach
    return sorted(name for name, far in reach.items() if name in far)


def graph_of(sources):
    """Return module -> modules of the package it imports, for sources {dotted name: (source, is_package)}."""
    graph = {}
    for name, (source, is_package) in sources.items():
        nodes = [i for i in ast.walk(parsed(source)) if isinstance(i, ast.Import | ast.ImportFrom)]
        targets = [t.removeprefix("hapticlab.") for i in nodes for t in imported(name, is_package, i)]
        exact = {t if t in sources else t.rpartition(".")[0] for t in targets}
        graph[name] = (exact & set(sources)) - {name}
    return graph


@functools.cache
def sources():
    return {name: (text, (PACKAGE / Path(*name.split("."))).is_dir()) for name, text in modules(PACKAGE)}


@pytest.mark.parametrize("name", sorted(sources()))
def test_module_keeps_to_its_layer(name):
    source, is_package = sources()[name]
    assert name.split(".")[0] in (*LAYERS, *OUTSIDE), f"{name} belongs to no layer"
    assert not faults(name, source, is_package)
    assert not lengths(name, source)


def test_no_cycles():
    assert len(sources()) > 20
    assert cycles(graph_of(sources())) == []


@pytest.mark.parametrize(
    ("name", "source", "word"),
    [
        ("scene.bad", "from ..compiler.ir import Program", "not below"),
        ("scene.bad", "from .. import compiler", "not below"),
        ("scene.bad", "import hapticlab.device.hand.hand", "not below"),
        ("scene.bad", "import hapticlab", "not below"),
        ("device.bad", "def f():\n    from ..scene import Scene", "inside a function"),
        ("course.felt", "def f():\n    from ..device.hand import Hand", "inside a function"),
        ("analysis.bad", "def f():\n    import pint", "its door is"),
        ("compiler.bad", "from scipy.linalg import expm", "its door is"),
        ("limits.matrix", "import scipy.linalg", "at once"),
        ("scene.bad", "if True:\n    from ..analysis.energy import energy", "not below"),
    ],
)
def test_a_bad_import_is_found(name, source, word):
    assert any(word in fault for fault in faults(name, source)), faults(name, source)


def test_good_imports_pass():
    good = "import numpy as np\nfrom ..errors import SceneError\nfrom .hand import Hand\nfrom ..compiler import ir"
    assert faults("device.simulated.simulated_paddle", good) == []
    assert faults("limits.matrix", "def f():\n    from scipy.linalg import expm") == []


def test_a_cycle_is_found():
    ring = {
        "scene.a": ("from .b import one", False),
        "scene.b": ("from . import c", False),
        "scene.c": ("import hapticlab.scene.a", False),
        "scene.d": ("from .a import two", False),
    }
    assert cycles(graph_of(ring)) == ["scene.a", "scene.b", "scene.c"]
    ring["scene.c"] = ("import numpy", False)
    assert cycles(graph_of(ring)) == []


def test_a_long_function_is_found():
    body = "\n".join(f"    a{i} = {i}" for i in range(FUNCTION_LINES + 1))
    assert lengths("scene.long", f"def f():\n    'words'\n{body}\n")
    assert not lengths("scene.short", "def f():\n    return 1\n")
    assert lengths("scene.long", "a = 1\n" * (MODULE_LINES + 1))


HEAVY = (*DOORS, "numba")
COMMANDS = ("demo", "labs", "assign", "grade", "run", "tradeoff", "ports", "doctor", "flash", "calibrate")
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


@pytest.mark.parametrize("arguments", [["-h"], ["--version"], *([name, "-h"] for name in COMMANDS)], ids=" ".join)
def test_help_waits_for_nothing(arguments):
    code = "import contextlib\nfrom hapticlab.cli.main import main\n"
    code += f"with contextlib.suppress(SystemExit):\n    main({arguments!r})"
    assert opened(code, (*HEAVY, "sympy", "numpy", "importlib.metadata")) == []


def test_the_first_scene_waits_for_sympy_alone():
    assert opened(FIRST_CELL, (*HEAVY, "sympy", "numpy")) == ["sympy"]
    assert "pint" in opened(FIRST_CELL + "wall(x_o='1 inch')", HEAVY)  # so that the line above can fail
