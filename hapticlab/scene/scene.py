"""A scene: what is felt, as equations. Frozen; calling it binds values."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from copy import copy
from dataclasses import dataclass, field
from difflib import get_close_matches
from textwrap import shorten
from typing import TYPE_CHECKING, Any

import sympy as sp

from ..base.facts import Fact
from ..base.grid import Grid
from ..base.shows_itself import Typeset
from ..base.unusual import SCENE, warn_of_unusual
from ..errors import ParameterError, SceneError
from .explicit import explicit_form
from .frozen import Frozen
from .mechanics.lagrange import Mechanics
from .notation.checks import (
    applied,
    check_angles,
    check_size,
    check_swallowed,
    check_symbols,
    check_units,
    equations,
    is_model,
    named,
    parameters_in,
    written_in,
)
from .notation.typeset import typeset
from .notation.units import unit_of
from .notation.written import expression, no_scene

if TYPE_CHECKING:
    from ..base.annotations import Number
    from .explicit import ExplicitForm
    from .notation.parameters import Parameter


@dataclass(frozen=True)
class Scene(Typeset):
    """A scene: the force law at the handle, and the equations of motion that it needs.

    Parameters
    ----------
    force : sympy expression
        F_e [N], the force on the environment, positive into the wall (Eq. 23.1); the motor applies -F_e. A power whose
        exponent is not a fixed fraction, such as a parameter, runs as exp(exponent*log(base)): its base must be
        positive.
    eom : sequence of sympy.Eq, or models of :func:`~hapticlab.scene.mechanics.lagrange.lagrange`
        Equations of motion of the coordinates, linear in the highest derivatives, and difference equations
        ``Eq(y(n), ...)`` of signals.
    watch : sequence of expressions or names, or dict name -> expression
        Expressions that a run records in addition to x, v and F. The channel of an expression in a sequence has the
        name that is written; the names of a dict are single words that a record does not use itself.
    values : dict
        Parameter values in SI, or texts with a unit such as ``"10 mm"``. Read-only once the scene is made.
    name : str

    Raises
    ------
    SceneError, UnitsError, ParameterError, SignalError
        When the scene is made, in the student's own symbols.

    Examples
    --------
    >>> import hapticlab as hl
    >>> from hapticlab import n, x
    >>> k, x_o = hl.parameters("k x_o", units="N/m m")
    >>> wall = hl.Scene(force=hl.when(x(n) >= x_o, k * (x(n) - x_o)), name="wall")
    >>> wall(k=150, x_o="10 mm").values
    {'k': 150.0, 'x_o': 0.01}
    """

    force: sp.Expr
    eom: tuple[Any, ...] = ()
    watch: Mapping[str, sp.Expr] = field(default_factory=dict)
    values: Mapping[str, float] = field(default_factory=dict)
    name: str = "scene"

    if TYPE_CHECKING:  # it takes more than it keeps

        def __init__(
            self,
            force: sp.Expr | float,
            eom: Sequence[Any] | sp.Basic | bool | Mechanics = (),
            watch: Sequence[sp.Expr | str] | Mapping[str, sp.Expr] = (),
            values: Mapping[str, Number] = {},
            name: str = "scene",
        ) -> None: ...

    def __post_init__(self) -> None:
        try:
            self._check()
        except RecursionError:
            raise SceneError(
                f"{self.name}: an expression is nested too deeply to check. Name its parts as signals, "
                "y = hl.signal(...), with an equation for each"
            ) from None

    def _check(self):
        _set(self, "eom", equations(self.eom))
        _set(self, "force", expression(self.force, "force"))
        written = [self.force, *written_in(self.eom)]
        check_size(written)
        _set(self, "watch", Frozen(named(self.watch, applied(written, "coordinate"))))
        check_symbols(self._expressions())
        known = self.parameters
        plain = [e for e in self.eom if not is_model(e)]
        used = self._expressions()
        check_units(self.force, plain, self.watch, applied(used, "coordinate", "signal"))
        sides = {f"a side of equation {number}": side for number, e in enumerate(plain, 1) for side in e.args}
        check_swallowed({"force": self.force, **{f"watch {name}": expr for name, expr in self.watch.items()}, **sides})
        check_angles(used)
        _set(self, "_coordinates", tuple(applied(used, "coordinate")))
        if not isinstance(self.values, Mapping):
            raise ParameterError(f"values = {self.values!r}; needs a dict, such as values={{'k': 150}}")
        defaults = {p.name: p.value for p in known.values() if p.value == p.value}
        bound = {name: _bound(known, name, value) for name, value in self.values.items()}
        _set(self, "values", Frozen({**defaults, **bound}))

    def __call__(self, /, **values: Number) -> Scene:
        """The scene with these parameters bound, each in SI or as a text with its unit."""
        known, bound = self.parameters, copy(self)  # the equations are checked already
        _set(bound, "values", Frozen({**self.values, **{name: _bound(known, name, one) for name, one in values.items()}}))
        return bound

    @property
    def parameters(self) -> dict[str, Parameter]:
        """The parameters in use, name -> Parameter, in alphabetical order."""
        if "_parameters" not in self.__dict__:  # looked for once: every compilation asks again and again
            _set(self, "_parameters", parameters_in(self._expressions()))
        return dict(self.__dict__["_parameters"])

    @property
    def coordinates(self) -> tuple[sp.Expr, ...]:
        """The generalized coordinates in use, in alphabetical order."""
        return self.__dict__["_coordinates"]

    @property
    def signals(self) -> tuple[sp.Expr, ...]:
        """The signals that its equations define, at sample n, in alphabetical order."""
        defined = [e.lhs for e in self.eom if isinstance(e, sp.Eq) and getattr(type(e.lhs), "role", None) == "signal"]
        return tuple(sorted(defined, key=str))

    @property
    def models(self) -> tuple[Mechanics, ...]:
        """The models among the equations of motion, such as those of :func:`~hapticlab.scene.mechanics.lagrange.lagrange`."""
        return tuple(e for e in self.eom if isinstance(e, Mechanics))

    @property
    def watch_units(self) -> dict[str, str]:
        """The SI unit of each watched channel."""
        return {name: _unit_shown(expr) for name, expr in self.watch.items()}

    def explicit(self) -> ExplicitForm:
        """The equations solved for the unknowns they determine: ``M a = f`` and the difference equations."""
        return explicit_form(self)

    def _expressions(self):
        """Every expression of the scene, and the starts of its coordinates and signals, whose own starts follow."""
        found = [self.force, *written_in(self.eom), *self.watch.values()]
        started, kinds = set(), {type(q) for q in applied(found, "coordinate", "signal")}
        while kinds - started:
            fresh = sorted(kinds - started, key=str)
            starts = [getattr(kind, part) for kind in fresh for part in ("initial", "rate") if hasattr(kind, part)]
            found += starts
            started |= kinds
            kinds = {type(q) for q in applied(starts, "coordinate", "signal")}
        return found

    def __str__(self) -> str:
        lines = [f"scene {self.name}", f"  F = {self.force}"]
        lines += [f"  {e}" if is_model(e) else f"  {e.lhs} = {e.rhs}" for e in self.eom]
        shown = (f"{p.name} = {self.values.get(p.name, '?')} {p.unit}" for p in self.parameters.values())
        return "\n".join([*lines, "  " + (", ".join(shown) or "no parameters")])

    def _sentence(self):
        names = ", ".join(type(q).__name__ for q in self.coordinates)
        moving = f" and the equations of motion of {names}" if names else ""
        unbound = ", ".join(name for name in self.parameters if name not in self.values)
        return f"scene {self.name}: the force on the environment{moving}" + (
            f"; without a value yet: {unbound}" if unbound else ""
        )

    def _line(self):
        return f"Scene({shorten(f'{self.name}: F = {self.force}', 110, placeholder=' ...')})"

    def _equations(self):
        shown = [part for e in self.eom for part in (e._equations() if is_model(e) else (typeset(e),))]
        return [f"F_e = {typeset(self.force)}", *shown]

    def _facts(self):
        given = [(name, one, self.values.get(name)) for name, one in self.parameters.items()]
        return [
            Fact(name, "no value yet", "", f"In {one.unit}") if value is None else Fact(name, value, one.unit, "")
            for name, one, value in given
        ]

    def _is_open(self, fact):
        return True

    def _tables(self):
        yield "Recorded beside x, v and F", Grid({"watch": list(self.watch), "unit": list(self.watch_units.values())})


def _unit_shown(expr):
    """SI unit of a watched expression; an angle and its rate keep the rad they were declared with."""
    unit, kind = unit_of(expr), type(expr.expr if isinstance(expr, sp.Derivative) else expr)
    return f"rad{unit[1:]}" if getattr(kind, "unit", "") == "rad" and unit[:1] == "1" else unit


def _set(scene, name, value):
    object.__setattr__(scene, name, value)


def _bound(known, name, value):
    if name not in known:
        listed = ", ".join(f"{p.name} [{p.unit}]" for p in known.values()) or "none"
        near = [one for one in known if one.lower() == name.lower()] or get_close_matches(name, known, 1)
        meant = f". Did you mean {near[0]}?" if near else ""
        raise ParameterError(f"{name} = {value!r}: the scene has no parameter {name}; it has {listed}{meant}")
    number, unit = known[name].check(value), known[name].unit
    warn_of_unusual(name, number, unit, SCENE.get(unit.replace(" ", "*")))
    return number


def check_scene(scene, cure="needs a Scene, such as hl.wall()"):
    """Refuse what is no scene."""
    if not isinstance(scene, Scene):
        raise SceneError(no_scene(scene, cure))
