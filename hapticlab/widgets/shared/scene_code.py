"""A scene as the Python that makes it: a call of the library where that gives the same scene, else its equations."""

import json
import math
import re
from functools import cache

import sympy as sp
from sympy.printing.str import StrPrinter

from ...library.entries import CATALOGUE
from ...scene.laws.chapter_laws import wall
from ...scene.laws.taps import TAPS
from ...scene.mechanics.lagrange import Mechanics
from ...scene.notation.checks import applied
from ...scene.notation.parameters import parameters
from ...scene.notation.typeset import is_named

IMPORTS = "import hapticlab as hl\n"
#: names of the package that stand alone in expressions
ALONE = ("T", "n", "t", "v", "x")


def scene_code(scene):
    """Return lines of Python whose ``scene`` is this scene, or None where it cannot be written out.

    It was run before it is returned, and gave an equal scene. What is not written out are contacts, shapes, estimates of the
    velocity and models of SymPy's mechanics, where they do not come from the library.

    Parameters
    ----------
    scene : Scene

    Returns
    -------
    str or None

    Examples
    --------
    >>> import hapticlab as hl
    >>> print(scene_code(hl.library.gears()(K="300 N/m")))
    import hapticlab as hl
    <BLANKLINE>
    scene = hl.library.gears()
    scene = scene(K=300.0)
    """
    for call, made in _ready():
        if _bare(made) == _bare(scene):
            changed = {name: value for name, value in scene.values.items() if made.values.get(name) != value}
            return f"{IMPORTS}\nscene = {call}" + (f"\nscene = scene({values_code(changed)})" if changed else "")
    try:
        code = _written_out(scene)
        names = {}
        exec(code, names)  # it holds nothing but what the printer below writes
    except Exception:  # whatever a scene holds that Python cannot be given in these words
        return None
    return code if names["scene"] == scene else None


def values_code(values):
    """Return values as arguments, such as ``k=300.0, x_o=0.01``."""
    return ", ".join(f"{name}={value!r}" for name, value in values.items())


def library_name(scene):
    """Return the name that a scene has in the library, or nothing where it is not of the library."""
    return next((name for name, made in _library().items() if _bare(made) == _bare(scene)), "")


def _ready():
    """Yield calls that make a scene, and the scene."""
    yield from ((f'hl.wall("{law}")', wall(law)) for law in TAPS)
    yield from ((f"hl.library.{name}()", made) for name, made in _library().items())


@cache
def _library():
    return {name: entry.scene() for name, entry in CATALOGUE.items()}


def _bare(scene):
    """A scene without values, and without what a live view watches."""
    return scene.name, scene.force, scene.eom, scene.watch


def _written_out(scene):
    expressions = scene._expressions()
    lines = [*_parameters(scene), *map(_coordinate, scene.coordinates)]
    signals = {type(y): None for y in applied(expressions, "signal")}
    lines += [f"{y.__name__} = hl.signal({_quoted(y.__name__)}, {_starts(y, 'initial')})" for y in signals]
    lines += ["", "scene = hl.Scene(", f"    force={_text(scene.force)},"]
    if scene.eom:
        lines += ["    eom=[", *(f"        {_text(e) if isinstance(e, sp.Basic) else _model(e)}," for e in scene.eom), "    ],"]
    if scene.watch:
        lines += ["    watch={", *(f"        {_quoted(name)}: {_text(expr)}," for name, expr in scene.watch.items()), "    },"]
    bound = {name: value for name, value in scene.values.items() if value != scene.parameters[name].value}
    lines += [f"    name={_quoted(scene.name)},", ")", *([f"scene = scene({values_code(bound)})"] if bound else [])]
    body = "\n".join(lines)
    alone = [name for name in ALONE if re.search(rf"\b{name}\b", body)]
    imports = [IMPORTS + "import sympy as sp", *([f"from hapticlab import {', '.join(alone)}"] if alone else [])]
    return "\n".join([*imports, "", body])


def _parameters(scene):
    for name, one in scene.parameters.items():
        value, ends = "" if math.isnan(one.value) else f", values={one.value!r}", (one.low, one.high)
        usual = parameters(name, units=one.unit)
        given = "" if ends == (usual.low, usual.high) else f", ranges=({_number(one.low)}, {_number(one.high)})"
        yield f"{name} = hl.parameters({_quoted(name)}, units={_quoted(one.unit)}{value}{given})"


def _coordinate(q):
    of = type(q)
    ends = f", range=({_number(of.low)}, {_number(of.high)})" if (of.low, of.high) != (-math.inf, math.inf) else ""
    return f"{of.__name__} = hl.coordinate({_quoted(of.__name__)}, {_starts(of, 'initial', 'rate')}{ends})"


def _starts(of, *parts):
    """The unit, and the starts that are not zero."""
    return ", ".join(
        [f"unit={_quoted(of.unit)}", *(f"{part}={_text(getattr(of, part))}" for part in parts if getattr(of, part) != 0)]
    )


def _quoted(text):
    return json.dumps(text, ensure_ascii=False)  # between double quotes, as the package writes texts


def _number(value):
    return repr(value) if math.isfinite(value) else f'float("{value}")'


def _model(model):
    """A model of energies without contacts, as the call that makes it."""
    if not isinstance(model, Mechanics) or model.lagrangian is None or model.contacts:
        raise NotImplementedError("a model with contacts, or without energies, is not written out")
    given = {
        "dissipation": _text(model.dissipation),
        "forces": "{" + ", ".join(f"{_text(q)}: {_text(Q)}" for q, Q in model.forces) + "}",
        "constraints": f"[{', '.join(map(_text, model.constraints))}]",
        "enforce": _quoted(model.enforce),
        "alpha": repr(model.alpha),
    }
    usual = {"dissipation": "0", "forces": "{}", "constraints": "[]", "enforce": '"auto"', "alpha": "None"}
    more = "".join(f", {name}={text}" for name, text in given.items() if text != usual[name])
    return f"hl.mechanics.lagrange({_text(model.lagrangian)}{more})"


def _text(expr):
    return _Printer().doprint(sp.sympify(expr))


class _Printer(StrPrinter):
    """Expressions as a person would type them, exactly."""

    def _print_Function(self, expr):
        name = type(expr).__name__
        if is_named(expr):
            if type(expr).role not in ("coordinate", "signal", "handle"):
                raise NotImplementedError(f"{name} comes from a call that an expression does not hold")
            return name if type(expr).role == "coordinate" else f"{name}({self._print(expr.args[0])})"
        return f"sp.{name}({self.stringify(expr.args, ', ')})"

    _print_Max = _print_Min = _print_Function

    def _print_delay(self, expr):
        return f"hl.laws.delay({self._print(expr.args[0])})"

    def _print_Derivative(self, expr):
        ((variable, order),) = expr.variable_count
        of = self._print(expr.expr)
        return f"{of if is_named(expr.expr) else f'({of})'}.diff({variable}{f', {order}' if order > 1 else ''})"

    def _print_Piecewise(self, expr):
        if len(expr.args) == 2 and expr.args[1].cond == sp.true:
            (inside, when), (outside, _) = expr.args
            return f"hl.when({self._print(when)}, {self._print(inside)}, {self._print(outside)})"
        return f"sp.Piecewise({', '.join(f'({self._print(value)}, {self._print(when)})' for value, when in expr.args)})"

    def _print_Relational(self, expr):
        if isinstance(expr, (sp.Eq, sp.Ne)):
            return f"sp.{type(expr).__name__.replace('uality', '')[:2]}({self._print(expr.lhs)}, {self._print(expr.rhs)})"
        return super()._print_Relational(expr)

    def _print_Pow(self, expr, rational=False):
        return super()._print_Pow(expr, rational=True)

    def _print_Rational(self, expr):
        return f"sp.Rational({expr.p}, {expr.q})" if expr.q != 1 else str(expr.p)

    def _print_Float(self, expr):
        return repr(float(expr))

    def _print_NumberSymbol(self, expr):
        return f"sp.{expr}"

    _print_Pi = _print_Exp1 = _print_NumberSymbol

    def emptyPrinter(self, expr):
        raise NotImplementedError(f"{type(expr).__name__} has no words here; SymPy's own would not run as Python")
