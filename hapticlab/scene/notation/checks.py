"""What a scene's expressions must be before anything is compiled: declared, sampled, of one name each, of one unit."""

from collections.abc import Mapping

import sympy as sp
from sympy.core.cache import cacheit
from sympy.core.function import AppliedUndef
from sympy.functions.elementary.trigonometric import TrigonometricFunction

from ...base.units import dimension
from ...base.unusual import warn_at_own_line
from ...errors import ParameterError, SceneError, SignalError, UnitsError
from ...slips.own_line import of_call
from ...slips.swallowed import swallowed
from .symbols import Parameter, T, delay, lag_of, n, t, v, x
from .units import agree
from .written import CONDITIONS, RESERVED, check_name, expression

#: of a scene's expressions, a part that stands in several places counted once: each is an instruction or more of a tick
MOST_PARTS = 100_000
#: names that a scene takes from hapticlab, and that a student may have given another value
CLOCK_AND_HANDLE = ("n", "t", "T", "x", "v")
_NOT_REAL = (sp.I, sp.zoo, sp.nan, sp.oo, -sp.oo)


def applied(expressions, *roles):
    """The applied functions of a role (coordinate, signal, handle), sorted by name."""
    atoms = {a for e in expressions for a in _functions(e)}
    return sorted((a for a in atoms if getattr(type(a), "role", None) in roles), key=str)


def check_size(expressions):
    """Refuse, before anything else walks through them, expressions that no program could hold."""
    seen, waiting = set(), list(expressions)
    while waiting:
        part = waiting.pop()
        if part in seen:
            continue
        seen.add(part)
        waiting.extend(part.args)
        if len(seen) > MOST_PARTS:
            raise SceneError(
                f"the force and the equations have more than {MOST_PARTS} different parts, and each costs at least one "
                "instruction per tick. Use fewer terms in a long sum or series, and a hl.shapes.Curve for a table of values"
            )


@cacheit  # a scene is asked many times, and a Lagrangian is long
def _functions(expr):
    return frozenset(expr.atoms(sp.Function))


def equations(eom):
    """The equations and models as a tuple; refuse anything else, and a signal that is not defined exactly once, at n."""
    is_one = isinstance(eom, (str, sp.Basic)) or is_model(eom) or not hasattr(eom, "__iter__")
    listed = (eom,) if is_one else tuple(eom)
    defined = set()
    for equation in listed:
        if is_model(equation):
            continue
        if hasattr(equation, "generalized_force"):
            raise SceneError(
                f"eom contains {equation.name}, which is not an equation. Add it to the equations of its bodies: "
                "hl.mechanics.lagrange(L, contacts=[...])"
            )
        if equation in (sp.true, sp.false):
            raise SceneError(
                f"eom contains {equation}; one side of this sp.Eq may be a condition, which is not a number. Write "
                "sp.Eq(s(n), hl.when(condition, 1, 0))"
            )
        if not isinstance(equation, sp.Eq):
            raise SceneError(
                f"eom contains {equation!r}; needs equations, sp.Eq(left side, right side), or hl.mechanics.lagrange(...)"
            )
        left = equation.lhs
        for side in equation.args:
            expression(side, "a side of an equation")
        if getattr(type(left), "role", None) == "signal":
            _check_defines(left, equation)
            if left in defined:
                raise SceneError(f"two equations define {left}; keep one, or give the other signal its own name")
            defined.add(left)
    return listed


def is_model(entry):
    """Whether an entry of ``eom`` is a model, of :func:`~hapticlab.scene.mechanics.lagrange.lagrange`, and no equation."""
    return hasattr(entry, "written")


def written_in(eom):
    """Every expression of equations of motion: the sides of equations, and the expressions of models."""
    return [expr for entry in eom for expr in (entry.written if is_model(entry) else entry.args)]


def _check_defines(left, equation):
    lag, name = n - left.args[0], type(left).__name__
    if lag.is_Integer and lag < 0:
        shifted = equation.subs(n, n + lag)
        raise SignalError(f"{left} lies in the future; shift the equation: sp.Eq({shifted.lhs}, {shifted.rhs})")
    if lag.is_Integer and lag > 0:
        raise SignalError(f"{left} is past and fixed; an equation defines the present sample: sp.Eq({name}(n), ...)")


def named(watch, coordinates):
    """The watched channels as a dict name -> expression."""
    if isinstance(watch, Mapping):
        return {check_name(name, "watched channel"): expression(expr, f"watch {name}") for name, expr in watch.items()}
    if not isinstance(watch, (str, sp.Basic)) and not hasattr(watch, "__iter__"):
        raise SceneError(f"watch = {watch!r}; needs a list such as [z, K*x(n)], or a dict name -> expression")
    by_name = {type(q).__name__: q for q in coordinates}
    channels = {}
    for item in (watch,) if isinstance(watch, (str, *CONDITIONS, sp.Expr)) else watch:
        if isinstance(item, str) and item not in by_name:
            raise SceneError(f"watch {item!r}: no such coordinate; there are {', '.join(by_name) or 'none'}")
        expr = by_name[item] if isinstance(item, str) else expression(item, "watch")
        is_named = getattr(type(expr), "role", None) == "coordinate" or hasattr(type(expr), "contact")
        name = type(expr).__name__ if is_named else sp.sstr(expr)
        if name in RESERVED:
            raise SceneError(
                f"watch [{name}]: a record has a column {name} of its own. Give the channel another name, "
                f"watch={{'{name}_1': {name}}}"
            )
        channels[name] = expr
    return channels


def check_symbols(expressions):
    """Refuse symbols without a unit, samples that are none, functions nobody declared and numbers that are not real."""
    for expr in expressions:
        for symbol in expr.free_symbols - {n, t}:
            if not isinstance(symbol, Parameter):
                raise ParameterError(_undeclared(symbol))
    _check_arguments(expressions)
    for expr in expressions:
        for f in expr.atoms(AppliedUndef):
            if type(f).__name__ in CLOCK_AND_HANDLE:
                raise SceneError(f"{f} is a different function with this name. Write from hapticlab import {type(f).__name__}")
            if not hasattr(type(f), "role"):
                raise SceneError(
                    f"unknown function {f}; declare a coordinate, {type(f).__name__} = "
                    f"hl.coordinate('{type(f).__name__}', unit='m'), or a signal with hl.signal"
                )
        for d in expr.atoms(sp.Derivative):
            if getattr(type(d.expr), "role", None) != "coordinate" or set(d.variables) != {t}:
                raise SignalError(_without_rate(d))
        if expr.has(*_NOT_REAL):
            raise SceneError(f"{expr} is not a real number; only finite real numbers can be felt")


def _check_arguments(expressions):
    for a in applied(expressions, "signal", "handle", "coordinate"):
        role, name = type(a).role, type(a).__name__
        if role == "coordinate":
            if a.args != (t,):
                raise SignalError(f"{a}: {name} is a coordinate, a function of time; write {name}(t), with t from hapticlab")
        elif lag_of(a) is None and role == "signal":
            raise SignalError(f"{a}: {name} is a discrete-time signal; write it at n, n-1, ...")


def _without_rate(d):
    of, name = d.expr, type(d.expr).__name__
    if of == x(t) and d.derivative_count == 1:
        return f"{d} is a derivative that was not evaluated. Write v(t), or x(t).diff(t)"
    if of in (x(t), v(t)):
        cure = "write (v(n) - v(n-1))/T in a force, or give its mass to a coordinate behind a coupler"
        return f"{d} is the acceleration of the handle, which no sample gives; {cure}"
    if isinstance(of, (x, v, delay)) or getattr(type(of), "role", None) == "signal":
        cure = {"x": "v(n)", "delay": f"({of.args[0]} - {of})/T"}.get(name, f"({name}(n) - {name}(n-1))/T")
        return f"{of} has no derivative, because it is known at the samples only; write {cure}"
    return (
        f"{d} is a derivative that was not evaluated. For the rate of a coordinate write q.diff(t); for any other "
        "expression add .doit()"
    )


def _undeclared(symbol):
    if symbol.name in CLOCK_AND_HANDLE:
        return f"{symbol} is a different symbol with this name. Write from hapticlab import {symbol}"
    return (
        f"{symbol} is a plain SymPy symbol: it has no unit and no range; declare it, "
        f"{symbol} = hl.parameters('{symbol}', units='...')"
    )


def parameters_in(expressions):
    """Name -> Parameter in alphabetical order; refuse two declarations, of any kind, under one name."""
    found = {}
    for p in sorted({p for e in expressions for p in e.atoms(Parameter)} - {T}, key=sp.default_sort_key):
        if found.setdefault(p.name, p) != p:
            raise ParameterError(
                f"two different parameters are called {p.name} ({_declared(found[p.name])} and {_declared(p)}); "
                "declare it once and use that one everywhere"
            )
    kinds = {p.name: ("parameter", p) for p in found.values()}
    moving = {type(a) for a in applied(expressions, "coordinate", "signal")}
    for kind in sorted(moving, key=lambda kind: (kind.__name__, _declared(kind))):
        name = kind.__name__
        word, known = kinds.setdefault(name, (kind.role, kind))
        if known != kind:
            what = f"two different {word}s" if word == kind.role else f"a {word} and a {kind.role}"
            raise SceneError(
                f"{what} are called {name} ({_declared(known)} and {_declared(kind)}); give each a name of its own, "
                "or declare it once and use that one everywhere"
            )
    return dict(sorted(found.items()))


def _declared(kind):
    """The facts that differ between two declarations of the same name."""
    if isinstance(kind, Parameter):
        value = f" = {kind.value:g}" if kind.value == kind.value else ""
        return f"{kind.unit}{value}"
    rate = f", rate {kind.rate}" if getattr(kind, "rate", 0) != 0 else ""
    return f"{kind.unit}, initial {kind.initial}{rate}"


def check_units(force, eom, watch, moving):
    """Refuse a force that is none, equations whose sides differ, and starts in another unit than their coordinate."""
    try:
        agree_with(force, "N", "force")
    except UnitsError as refusal:
        if applied([force], "handle", "signal", "coordinate"):
            raise
        cure = "The force contains neither x(n) nor v(n). Was x or v given another value? Write from hapticlab import x, v"
        raise UnitsError(f"{refusal} {cure}") from None
    for number, equation in enumerate(eom, 1):
        agree(equation.args, f"equation of motion {number}")
    for name, expr in watch.items():
        agree([expr], f"watch {name}")
    for kind in map(type, moving):
        # a number stands in the declared unit, as the value of a parameter does
        if not kind.initial.is_number:
            agree_with(kind.initial, kind.unit, f"initial value of {kind.__name__}")
        if hasattr(kind, "rate") and not kind.rate.is_number:
            rate_unit = f"({kind.unit})/s" if kind.unit != "1" else "1/s"
            agree_with(kind.rate, rate_unit, f"initial rate of {kind.__name__}")


def agree_with(expr, unit, where):
    """Check that an expression has a unit; any mismatch is raised as a disagreement with a quantity in that unit."""
    agree([expr, Parameter(f"({where}, in {unit})", unit)], where)
    return dimension(unit)


def check_angles(expressions):
    """Warn of a sine of 30, or of an angle in degrees: sines take radians."""
    for f in {f for e in expressions for f in _functions(e) if isinstance(f, TrigonometricFunction)}:
        angle = f.args[0]
        factor, rest = angle.as_independent(*angle.free_symbols, *angle.atoms(AppliedUndef, x, v), as_Add=False)
        if angle.is_number and not angle.has(sp.pi) and abs(angle) > 2 * sp.pi:
            cure = f"If you mean {angle} degrees, write sp.{type(f).__name__}(sp.pi*{angle}/180)."
            warn_at_own_line(f"{f}: the argument is in radians, and a full turn has 6.28 rad. {cure}")
        elif factor.is_number and abs(factor * sp.pi / 180 - 1) < 1e-6:
            warn_at_own_line(
                f"{f}: the argument is in radians, and the factor 180/pi converts it to degrees. Write "
                f"{type(f).__name__}({rest})."
            )


def check_swallowed(named):
    """Refuse what is zero because Python has rounded a fraction such as 1//2 down, in the lines that wrote it."""
    zero = next((name for name, expr in named.items() if expr == 0), None)
    own = of_call() if zero else None
    if own and (lost := swallowed(own, "")):
        raise SceneError(f"{zero} is 0 for every motion. {lost}")
