"""Names whose values nothing but a new binding changes: numbers, texts, functions, expressions and scenes."""

import ast
import sys

#: of hapticlab, what gives values that never change; of builtins the same
FROZEN = frozenset(
    "Scene when delay parameters coordinate signal wall virtual_coupler virtual_damper lagrange damping_compensation friction "
    "force_filter predicted_sample backward filtered profile passivity_limit n x v t T".split()
)
#: what hapticlab makes and a notebook calls, as y(n) and scene(k=150), which gives values that never change
CALLED = frozenset("Scene signal".split())
BUILTINS = frozenset("abs bool complex float int len max min pow range round str sum tuple".split())
#: attributes of modules that are numbers, and packages whose names are functions, types and numbers
NUMBERS = frozenset("pi e tau inf nan".split())
PACKAGES = sys.stdlib_module_names | {"hapticlab", "matplotlib", "numpy", "scipy", "sympy"}
#: of SymPy, what can change
MATRICES = frozenset("Matrix MutableDenseMatrix SparseMatrix zeros ones eye diag".split())
#: methods of expressions, texts and profiles whose results never change, and attributes that are sets and dicts
METHODS = frozenset(
    "diff subs xreplace replace doit evalf expand simplify factor collect together coeff integrate limit at format strip".split()
)
CONTAINERS = frozenset("free_symbols parameters assumptions0".split())


def is_solid(node, solid, imports):
    """Return whether a statement binds only what nothing changes but a new binding.

    Parameters
    ----------
    node : ast.stmt
    solid : container of str
        Names that are known to be so, and as ``"y()"`` those whose calls also give such values.
    imports : dict of str to str
        Name to what it is in its module.

    Examples
    --------
    >>> [is_solid(ast.parse(text).body[0], {"k"}, {}) for text in ("b = 2 * k", "b = [k]", "b, c = k, 'c'", "b = y(k)")]
    [True, False, True, False]
    >>> is_solid(ast.parse("b = y(k)").body[0], {"k", "y", "y()"}, {})
    True
    """
    if isinstance(node, ast.Import | ast.ImportFrom):
        return isinstance(node, ast.Import) or (node.module or "").partition(".")[0] in PACKAGES
    if isinstance(node, ast.FunctionDef):
        defaults = [*node.args.defaults, *filter(None, node.args.kw_defaults)]
        return not node.decorator_list and all(_is_solid(one, solid, imports) for one in defaults)
    if isinstance(node, ast.Assign | ast.AnnAssign | ast.AugAssign) and node.value is not None:
        return _is_solid(node.value, solid, imports)
    return False


def makes_called(node, imports):
    """Return whether a statement binds only what may be called, and then gives values that never change.

    Parameters
    ----------
    node : ast.stmt
    imports : dict of str to str

    Examples
    --------
    >>> texts = "y = hl.signal('y', unit='m')", "y = lambda n: rows", "y = hl.wall()"
    >>> [makes_called(ast.parse(text).body[0], {"hl": "hapticlab"}) for text in texts]
    [True, False, False]
    """
    if not isinstance(node, ast.Assign):
        return False
    parts = node.value.elts if isinstance(node.value, ast.Tuple) else [node.value]
    return all(isinstance(part, ast.Call) and _made_by(part.func, imports) in CALLED for part in parts)


def _made_by(function, imports):
    """The name that a function has in hapticlab, empty for any other."""
    if isinstance(function, ast.Attribute):
        return function.attr if _module(function.value, imports) == "hapticlab" else ""
    module, _, name = imports.get(getattr(function, "id", ""), "").rpartition(".")
    return name if module == "hapticlab" else ""


def _is_solid(node, solid, imports):
    """Return whether the value of an expression never changes."""
    if isinstance(node, ast.Name):
        return node.id in solid
    if isinstance(node, ast.Call):
        given = [*node.args, *(keyword.value for keyword in node.keywords)]
        return _gives_solid(node.func, imports, solid) and all(_is_kept(part, solid, imports) for part in given)
    if isinstance(node, ast.Attribute):
        module = _module(node.value, imports)
        known = module is None or node.attr in NUMBERS or _is_known(module, node.attr)
        return known and node.attr not in CONTAINERS and _is_solid(node.value, solid, imports)
    if isinstance(node, ast.BinOp | ast.UnaryOp | ast.BoolOp | ast.Compare | ast.IfExp | ast.Tuple | ast.JoinedStr):
        return all(_is_solid(part, solid, imports) for part in ast.iter_child_nodes(node) if isinstance(part, ast.expr))
    return isinstance(node, ast.Constant | ast.Lambda | ast.FormattedValue)


def _is_kept(node, solid, imports):
    """Return whether what is given to a function never changes; a list that is written there is in nobody else's hands."""
    parts = [node]
    if isinstance(node, ast.List | ast.Dict):
        parts = [part for part in ast.iter_child_nodes(node) if isinstance(part, ast.expr)]
    return all(_is_solid(part, solid, imports) for part in parts)


def _gives_solid(function, imports, solid):
    """Return whether what a function gives never changes."""
    if isinstance(function, ast.Name):
        module, _, name = imports.get(function.id, "").rpartition(".")
        return (function.id in BUILTINS and not module) or _is_known(module, name) or f"{function.id}()" in solid
    if not isinstance(function, ast.Attribute):
        return False
    if module := _module(function.value, imports):
        return _is_known(module, function.attr)
    return function.attr in METHODS and _is_solid(function.value, solid, imports)  # of an expression, z.diff(t)


def _module(node, imports):
    """The module that a name stands for, or a page of hapticlab behind it, as ``hl.laws``; None where it is no module."""
    if isinstance(node, ast.Name):
        return imports.get(node.id)
    if isinstance(node, ast.Attribute) and _module(node.value, imports) == "hapticlab":
        return f"hapticlab.{node.attr}"
    return None


def _is_known(module, name):
    root = module.partition(".")[0]
    return (root == "hapticlab" and name in FROZEN) or root == "math" or (root == "sympy" and name not in MATRICES)
