"""What a student wrote, taken as expressions, conditions and names, or refused in words."""

from inspect import isfunction
from keyword import iskeyword

import sympy as sp
from sympy.core.function import FunctionClass
from sympy.core.relational import Relational
from sympy.logic.boolalg import BooleanAtom, BooleanFunction

from ...errors import SceneError

#: SymPy counts every symbol as a Boolean too; these are conditions and nothing else
CONDITIONS = (Relational, BooleanFunction, BooleanAtom)

#: what a scene, a record of a run (hapticlab/base/telemetry.py) and the loop around a scene call their own
RESERVED = frozenset(
    "n t T x v F x_true v_true F_applied x_switch tick intent noise unlocated overlap "
    "delay sensor_delay channels units paddle scene parameters fault saturated gap overrun every changes columns save load "
    "to_csv to_pandas to_xarray".split()
)


def check_name(name, what, error=SceneError):
    """A name that is free in Python, in a scene and in the record of its run; refuse any other.

    Examples
    --------
    >>> from hapticlab.scene.notation.written import check_name
    >>> check_name("x", "coordinate")
    Traceback (most recent call last):
    hapticlab.errors.SceneError: 'x' cannot name a coordinate, because a scene or its record already uses the name x. Use x_1
    """
    if not (isinstance(name, str) and name.isidentifier()) or iskeyword(name) or name.startswith("__"):
        raise error(f"{name!r} cannot name a {what}; needs one word of letters, digits and _, such as k_1")
    if name in RESERVED:
        raise error(f"{name!r} cannot name a {what}, because a scene or its record already uses the name {name}. Use {name}_1")
    return name


def expression(given, where):
    """A number or expression as SymPy has it; refuse texts, lists, conditions and functions that are not applied."""
    try:
        expr = given if isinstance(given, sp.Basic) else sp.sympify(given, strict=True)
    except (sp.SympifyError, TypeError):
        expr = None
    if isinstance(expr, sp.Eq):
        raise SceneError(f"{where} = {expr} is an equation; needs an expression, such as its right side")
    if isinstance(expr, CONDITIONS):
        raise SceneError(f"{where}: a condition is not a number; write hl.when(condition, 1, 0)")
    if isinstance(expr, sp.Expr):
        return expr
    if isinstance(given, FunctionClass):
        raise SceneError(f"{where} = {given.__name__}; needs one of its values: write {given.__name__}(n)")
    if hasattr(given, "generalized_force"):
        raise SceneError(f"{where} is the contact or friction {given.name} itself; its force is {given.name}.force")
    raise SceneError(f"{where} = {given!r}; needs a number, or an expression of parameters, x(n) and v(n)")


def zero_of(given, where):
    """The expression that a constraint sets to zero, from an equation or that expression."""
    if isinstance(given, bool):
        raise SceneError(f"{where} is {given}: Python's == compares at once. Write sp.Eq(a, b)")
    if given in (sp.true, sp.false):
        raise SceneError(
            f"{where} is {given}: its sides are equal for every motion or for none, so it determines nothing. "
            "Write an equation with x(n) or a coordinate"
        )
    return expression(given.lhs - given.rhs if isinstance(given, sp.Eq) else given, where)


def no_scene(given, cure):
    """The sentence about an argument that is not a scene; a function that makes one has to be called."""
    if isfunction(given) and given.__name__.isidentifier():
        place = "hl.library." if given.__module__.startswith("hapticlab.library.") else ""
        return f"{given.__name__} is a function, not a scene; call it: {place}{given.__name__}()"
    if hasattr(given, "lagrangian"):
        return "these are equations of motion, without a force; put them in a scene: hl.Scene(force=..., eom=[model])"
    text = repr(given)
    return f"{text if len(text) <= 80 else type(given).__name__} is not a scene; {cure}"


def condition(given):
    """A condition; refuse one that Python has decided already, and everything else."""
    if not isinstance(given, CONDITIONS):
        compared = "== and != compare at once; write sp.Eq(a, b) or sp.Ne(a, b)"
        cure = compared if isinstance(given, bool) else "write one, such as x(n) >= x_o"
        raise SceneError(f"{given!r} is not a condition; {cure}")
    if given == sp.false:
        raise SceneError(
            "the condition is False for every motion. A part of it may have been compared at once by Python's ==, as in "
            "(s(n-1) == 1) & (x(n) > x_o); write sp.Eq(s(n-1), 1)"
        )
    return given
