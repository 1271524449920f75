"""What other libraries say of a student's slip, in our words: a table from their message to what is wrong and the cure.

Each row has the pattern of a message and a function of the place and the match, which returns the sentence, or nothing
where the slip is another one. Python, NumPy and SymPy stay as they are.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Callable
from difflib import get_close_matches
from inspect import signature

from .decided import decided
from .own_line import OwnLine, code_of, ours

Rule = Callable[[OwnLine, re.Match[str]], str]

CONDITION = r"'(?:\w+Than|Equality|Unequality|And|Or|Not|Boolean\w+)'"
#: functions of numbers whose name in SymPy is another
IN_SYMPY = {"arcsin": "asin", "arccos": "acos", "arctan": "atan", "arctan2": "atan2", "ceil": "ceiling", "fabs": "Abs",
            "absolute": "Abs", "int": "floor", "round": "floor", "trunc": "floor", "rint": "floor"}  # fmt: skip
FUNCTIONS = set("sin cos tan asin acos atan atan2 sinh cosh tanh exp log sqrt floor ceiling Abs sign".split())
#: what Python and NumPy call values that are no symbols, nor made of them
PLAIN = set("int float complex bool str list tuple dict set NoneType function method module range ndarray numpy.ndarray".split())
#: of hapticlab, which are no expressions either
OWN_OBJECTS = {"Scene", "Hand", "Device", "SimulatedPaddle", "_Library"}
CLOCK_AND_HANDLE = ("x", "v", "n", "t", "T")
IMPORTS = {
    "np": "import numpy as np", "sp": "import sympy as sp", "math": "import math", "plt": "import matplotlib.pyplot as plt",
    "hl": "import hapticlab as hl", "numpy": "import numpy", "sympy": "import sympy", "hapticlab": "import hapticlab",
}  # fmt: skip
RATES = {"dot", "d", "dt", "ddot", "prime", "velocity", "rate", "derivative"}
RECORD = "Samples are in the record of a run: log = paddle.run(scene, 2.0), then log.x."


def in_our_words(problem: BaseException, own: OwnLine) -> str:
    """The sentence about an error of another library; empty where the table does not know it."""
    said = str(problem)
    kinds = set(re.findall(r"'([\w.]+)'", said))
    if kinds and kinds <= PLAIN and not re.search(r"\^|NoneType|callable", said):
        return ""  # about Python's own numbers and lists
    for pattern, rule in TABLE:
        if (match := re.search(pattern, said)) and (sentence := rule(own, match)):
            return sentence
    return ""


def first(own: OwnLine, *kinds: type[ast.AST]) -> ast.AST | None:
    """The innermost part of these kinds that holds what was running; else the first of the statement."""
    return next((one for one in [*own.nodes(), *own.walk()] if isinstance(one, kinds)), None)


def _number_wanted(own, match):
    call = first(own, ast.Call, ast.FormattedValue)
    if isinstance(call, ast.FormattedValue):
        return _format(own, match)
    if not isinstance(call, ast.Call) or not any(_symbolic(own, one) for one in call.args):
        return ""
    function, given = code_of(call.func), ", ".join(map(code_of, call.args))
    name = function.rpartition(".")[2]
    if name == "float":
        if "(" in given:  # a sample
            return f"`float` needs a number, but {given} changes from sample to sample. {RECORD}"
        return f"`float` needs a number, but {given} has none before a scene gives it one. Take the scene's: scene.values['k']."
    if name == "range":
        return f"`range` needs a whole number, but {given} changes from sample to sample. Give a plain number, such as range(10)."
    if name == "heaviside":
        return f"`{function}` takes numbers. A step is a condition: write hl.when({code_of(call.args[0])} >= 0, 1, 0)."
    name = IN_SYMPY.get(name, name)
    cure = f"Write sp.{name}({given})" if name in FUNCTIONS else "Of a run take the numbers of its record, such as log.x"
    return f"`{function}` takes numbers, but {given} is an expression, whose value changes from sample to sample. {cure}."


def _symbolic(own, node):
    """Whether a name in a part stands for an expression, or for what hapticlab made."""
    names = [own.value(one) for one in ast.walk(node) if isinstance(one, ast.Name)]
    return any(hasattr(one, "free_symbols") or ours(one) for one in names)


def _format(own, match):
    return "A format such as .2f needs a number, and a symbol has none. Take it from a scene: scene.values['k']."


def _array_in_math(own, match):
    call = first(own, ast.Call)
    function = code_of(call.func) if isinstance(call, ast.Call) else ""
    name = function.rpartition(".")[2]
    if not function or name in ("float", "int"):
        return ""
    return f"`{function}` needs one number, but was given an array. Write np.{name}({', '.join(map(code_of, call.args))})."


def _power(own, match):
    power = first(own, ast.BinOp)
    cure = next((f"{code_of(p.left)}**{code_of(p.right)}" for p in own.walk() if _is(p, ast.BitXor)), "a**b")
    return f"`^` is not a power in Python. Write {cure}." if power else ""


def _is(node, *operators):
    return isinstance(node, ast.BinOp) and isinstance(node.op, operators)


def _condition_as_number(own, match):
    found = first(own, ast.Compare)
    condition = code_of(found) if found else "condition"
    return f"A condition such as {condition} is not a number. Write hl.when({condition}, 1, 0) for one that is 1 or 0."


def _parentheses(own, match):
    found = first(own, ast.Compare)
    sign = match[1]
    joined = next((one for one in getattr(found, "comparators", []) if _is(one, ast.BitAnd, ast.BitOr)), None)
    cure = f"(a) {sign} (b)"
    if joined is not None and len(found.ops) == 2:
        left = code_of(ast.Compare(found.left, found.ops[:1], [joined.left]))
        cure = f"({left}) {sign} ({code_of(ast.Compare(joined.right, found.ops[1:], found.comparators[1:]))})"
    return f"`{sign}` joins before the comparisons are made. Put each condition in parentheses: {cure}."


def _with_text(own, match):
    text = next((one for one in own.walk() if isinstance(one, ast.Constant) and isinstance(one.value, str)), None)
    shown = code_of(text) if text else "the text in quotes"
    return (
        f"{shown} is a text, not a quantity. Declare a parameter, length = hl.parameters('length', units='m'), "
        f"and give the scene its value: scene(length={shown})."
    )


def _with_list(own, match):
    return f"A {match[1]} is not a number, and an expression cannot be joined with it by + or *. Write its terms one by one."


def _with_none(own, match):
    return "One side is None, which is not a number: a function without `return` gives None. End it with return, and the value."


def _with_function(own, match):
    sample = next((one for one in own.walk() if isinstance(one, ast.Attribute) and one.attr in ("n", "t")), None)
    if sample:
        return _rounded(code_of(sample), code_of(sample.value), sample.attr)
    return "One side is a function, not its value. Call it, with round brackets: f(...)."


def _rounded(written, of, when):
    return f"{written} is not a sample. A sample is written with round brackets: {of}({when})."


def _subscript(own, match):
    node = first(own, ast.Subscript)
    if not isinstance(node, ast.Subscript):
        return ""
    written, of, which = code_of(node), code_of(node.value), code_of(node.slice)
    if match[1] == "Telemetry":
        which = which.strip("'\"")
        return f"{written}: write the name of a column after a dot, such as {of}.x, {of}.v, {of}.F or one that the scene watches."
    if isinstance(node.value, ast.Call):
        return f"{written}: {of} is one sample, not a list. Write x(n-1) for the sample before it. {RECORD}"
    if match[1] in ("x", "v") or _called(own, node.value):
        return _rounded(written, of, which)
    return f"{written}: {of} is one quantity, not a list. {RECORD}"


def _called(own, node):
    return callable(own.value(node))


def _attribute(own, match):
    name = match[2]
    if match[1] in PLAIN:
        return ""
    node = next((a for a in own.nodes() + own.walk() if isinstance(a, ast.Attribute) and a.attr == name), None)
    if node is None:
        return ""
    of = code_of(node.value)
    if match[1] == "Scene":
        has = name in own.value(node.value).parameters if own.value(node.value) else False
        cure = f"The value of a parameter is {of}.values['{name}']" if has else f"A paddle runs a scene: paddle.run({of}, 2.0)"
        return f"{of}.{name}: a scene has no {name} of its own. {cure}."
    if name in ("n", "t"):
        return _rounded(f"{of}.{name}", of, name)
    if IN_SYMPY.get(name, name) in FUNCTIONS:
        return f"{of}.{name}: a symbol has no such function of its own. Write sp.{IN_SYMPY.get(name, name)}({of})."
    if name in RATES:
        return f"{of}.{name} is not known. The rate of a coordinate is {of}.diff(t), its second derivative {of}.diff(t, 2)."
    if name in ("value", "values", "magnitude"):
        return f"{of}.{name}: a symbol has no value of its own. A scene holds it: scene.values['{of}']."
    return ""


def _call(own, match):
    call = first(own, ast.Call)
    if not isinstance(call, ast.Call) or match[1] in {"list", "tuple", "dict", "set", "str", "NoneType", "module"}:
        return ""
    of, given = code_of(call.func), ", ".join(map(code_of, call.args))
    if of in CLOCK_AND_HANDLE:
        return f"{of} was given another value in your code, so {of}({given}) is not a sample. Write: from hapticlab import {of}."
    if getattr(type(own.value(call.func)), "role", "") == "coordinate":
        return f"{of}({given}): a coordinate is a function of time already, so it is not called. Write {of} alone."
    return f"{of}({given}) calls {of} as if it were a function. Python needs the sign of a multiplication: write {of}*({given})."


def _record(own, match):
    if "'Telemetry'" in match[0]:
        return "A record holds several columns of numbers. Take one of them, such as log.x or log.F."
    if match[1] in PLAIN | OWN_OBJECTS:
        return ""
    what = {"len()": "`len` counts items", "iterable": "A loop takes one item after the other"}
    word = next(words for key, words in what.items() if key in match[0])
    return f"{word}, but this is one expression, not a list of numbers. {RECORD}"


def _uncalled(own, match):
    found = first(own, ast.Compare)
    sides = [found.left, *found.comparators] if isinstance(found, ast.Compare) else []
    name = next((code_of(one) for one in sides if isinstance(own.value(one), type)), "x")
    return f"{name} is a function of time, and has no value by itself. Write {name}(n) for its sample."


def _keyword(own, match):
    """A wrong or a missing argument of a public call, with what it takes."""
    call = first(own, ast.Call)
    if isinstance(call, ast.Call) and match[1] == "Scene.__call__":
        return f"A scene takes values by the names of its parameters. Write {code_of(call.func)}(k={code_of(call.args[0])})."
    function = own.value(call.func) if isinstance(call, ast.Call) else None
    if not ours(function):
        return ""
    known = signature(function).parameters.values()
    shown, taken = code_of(call.func), [one.name for one in known if one.name != "self" and one.kind != one.VAR_KEYWORD]
    takes = f"It takes {', '.join(taken)}."
    if "unexpected" in match[0]:
        near = [one for one in taken if one.lower() == match[2].lower()] or get_close_matches(match[2], taken, 1, 0.5)
        near = near or [one for one in taken if one.lower().startswith(match[2].lower())][:1]
        return f"{shown} has no argument {match[2]}. {f'Did you mean {near[0]}? ' if near else ''}{takes}"
    if "missing" in match[0]:
        given = " and ".join(f"{name} = {code_of(one)}" for name, one in zip(taken, call.args, strict=False))
        lacking = re.findall(r"'(\w+)'", match[2])
        cure = ", ".join([*(one for one in taken[:1] if one not in lacking), *(f"{one}=..." for one in lacking)])
        return f"{shown} was given {given or 'nothing'}, and lacks {', '.join(lacking)}. {takes} Write {shown}({cure})."
    return f"{shown} was given too many values without a name. {takes} Write the name before each: name=value."


def _unknown_name(own, match):
    """A name that a cell above should have made, or a library's function without its library."""
    name, function = match[1], IN_SYMPY.get(match[1], match[1])
    if name in IMPORTS:
        return f"{name} is not known yet. Write {IMPORTS[name]} above, and run it."
    if name in CLOCK_AND_HANDLE:
        return f"{name} is not known yet. Write from hapticlab import {name} above, and run it."
    if function in FUNCTIONS:
        return f"{name} is not known by itself. Write sp.{function}(...) of expressions, or np.{name}(...) of numbers."
    return ""


def _kept(own, match):
    target = next(iter(getattr(own.statement, "targets", [])), None)
    owner = getattr(target, "value", None)
    if isinstance(target, ast.Subscript) and isinstance(owner, ast.Attribute):
        owner = owner.value  # of wall.values["k"]
    value = own.value(owner) if owner else None
    if not ours(value):
        return ""
    kind, name = type(value).__name__, code_of(target.slice).strip("'\"") if isinstance(target, ast.Subscript) else match[1]
    new = f"{code_of(owner)}({name}=...)" if kind == "Scene" else f"hl.{kind}(..., {name}=...)"
    return f"A {kind} keeps its values once it is made. Make another one with {name}: {new}."


def _rate(own, match):
    return f"A rate is a derivative over time, but {match[1]} is none. Write .diff(t), with t from hapticlab."


ITEMS = r"'(list|tuple|dict|set)'"
TABLE: tuple[tuple[str, Rule], ...] = (
    (r"cannot determine truth value of Relational: (.*)", decided),
    (r"truth value of an array with more than one element is ambiguous", decided),
    (r"Cannot convert expression to float|Cannot convert symbols to int|Cannot round symbolic", _number_wanted),
    (
        r"interpreted as an integer|loop of ufunc does not support argument 0 of type (?!int|float)|ufunc '\w+' not supported",
        _number_wanted,
    ),
    (r"unsupported format string passed to", _format),
    (r"only (?:0-dimensional|length-1|size-1) arrays can be converted", _array_in_math),
    (r"unsupported operand type\(s\) for \^", _power),
    (r"unsupported operand type\(s\) for ([&|])", _parentheses),
    (rf"unsupported operand type\(s\) for .*{CONDITION}|bad operand type for .*{CONDITION}", _condition_as_number),
    (r"unsupported operand type\(s\) for .*'str'", _with_text),
    (rf"unsupported operand type\(s\) for .*{ITEMS}", _with_list),
    (r"unsupported operand type\(s\) for .*'NoneType'", _with_none),
    (r"unsupported operand type\(s\) for .*'(?:function|method)'", _with_function),
    (r"'(\w+)'(?: object)? is not subscriptable", _subscript),
    (r"'(\w+)'(?: object)? has no attribute '(\w+)'", _attribute),
    (r"'([\w.]+)' object is not callable", _call),
    (r"'(\w+)'(?: object is not iterable| has no len\(\))", _record),
    (r"name '(\w+)' is not defined", _unknown_name),
    (r"cannot assign to field '(\w+)'|'Frozen' object does not support item assignment", _kept),
    (r"calculate derivative wrt (.*?)\.", _rate),
    (r"not supported between instances of .*_Unapplied", _uncalled),
    (r"([\w.]+)\(\) got an unexpected keyword argument '(\w+)'", _keyword),
    (r"([\w.]+)\(\) missing \d+ required (?:positional|keyword-only) arguments?: (.*)", _keyword),
    (r"([\w.]+)\(\) takes .* positional arguments? but", _keyword),
)
