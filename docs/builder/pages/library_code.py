"""The function of a scene of the library as a reader types it: with the package's public names, and without a ``def``."""

import ast
import inspect
from textwrap import dedent

import hapticlab as hl

#: names that stand alone in equations
ALONE = ("T", "n", "t", "v", "x")
#: modules of other packages, by the name that they have in the library
MODULES = {"sp": "import sympy as sp", "np": "import numpy as np", "math": "import math"}
#: pages of public names that a scene may use
PAGES = ("mechanics", "contact", "laws", "shapes")


def library_code(function):
    """Return lines whose ``scene`` is what a function of ``hl.library`` returns without arguments.

    Examples
    --------
    >>> print(library_code(hl.library.buckling_beam))
    import hapticlab as hl
    from hapticlab import n, x
    <BLANKLINE>
    P = hl.parameters("P", units="1", values=1.5, ranges=(0, 3))
    k, k_3 = hl.parameters("k k_3", units="N/m N/m^3", values=(90, 5e4), ranges=[None, (0, 1e7)])
    scene = hl.Scene(force=k * (1 - P) * x(n) + k_3 * x(n) ** 3, name="buckling beam")
    """
    used: dict = {}
    given = [f"{name} = {one.default!r}" for name, one in inspect.signature(function).parameters.items()]
    body = _renamed(_lines(function), function.__globals__, used).replace("\nreturn ", "\nscene = ")
    helpers = [text for text in used.values() if text.startswith(("def ", "TWO_PI"))]
    imports = ["import hapticlab as hl", *sorted(text for text in used.values() if text.startswith("import "))]
    alone = [name for name in ALONE if name in used]
    imports += [f"from hapticlab import {', '.join(alone)}"] if alone else []
    return "\n".join([*imports, "", *helpers, *given, body.strip()])


def _lines(function):
    """The lines of a function below its docstring, not indented, after an empty line."""
    source = dedent(inspect.getsource(function))
    body = ast.parse(source).body[0].body
    return "\n" + dedent("\n".join(source.splitlines()[body[1].lineno - 1 :]))


def _renamed(text, known, used):
    """Return a text with each name of the library's module replaced by its public one; ``used`` collects what that needs."""
    lines = text.splitlines()
    names = [node for node in ast.walk(ast.parse(text)) if isinstance(node, ast.Name) and node.id in known]
    for node in sorted(names, key=lambda one: (one.lineno, one.col_offset), reverse=True):
        line = lines[node.lineno - 1]
        lines[node.lineno - 1] = line[: node.col_offset] + _public(node.id, known, used) + line[node.end_col_offset :]
    return "\n".join(lines)


def _public(name, known, used):
    """Return the public name of what a module of the library calls ``name``, and note what a reader needs for it."""
    value = known[name]
    if name in MODULES:
        used[name] = MODULES[name]
    elif name in ALONE:
        used[name] = ""
    elif name == "TWO_PI":
        used["sp"], used[name] = MODULES["sp"], "TWO_PI = 2 * sp.pi\n"
    elif name == "coupler":
        body = _renamed(_lines(value), value.__globals__, used).strip().replace("\n", "\n    ")
        used[name] = f"def {name}(z):\n    {body}\n\n"
    elif getattr(hl, name, None) is value:
        return f"hl.{name}"
    else:
        return next(f"hl.{page}.{name}" for page in PAGES if getattr(getattr(hl, page), name, None) is value)
    return name
