"""A scene: what is felt, as equations. Frozen; calling it binds values."""

from dataclasses import dataclass, field, replace

import sympy as sp

from ..errors import ParameterError, SceneError, SignalError
from .explicit import explicit_form
from .symbols import Parameter, T, lag_of, n, t
from .units import agree, dimension, unit_of


@dataclass(frozen=True)
class Scene:
    """What is felt at the handle: a force law, and the equations of motion it needs.

    Parameters
    ----------
    force : sympy expression
        F_e [N], the force on the environment, positive into the wall (Eq. 23.1); the motor applies -F_e.
    eom : sequence of sympy.Eq
        Equations of motion of the coordinates, linear in the highest derivatives, and difference equations
        ``Eq(y(n), ...)`` of signals.
    watch : sequence of expressions or names, or dict name -> expression
        What a run records beside x, v and F.
    values : dict
        Parameter values in SI, or texts with a unit such as ``"10 mm"``.
    name : str

    Raises
    ------
    SceneError, UnitsError, ParameterError, SignalError
        At once, in the student's own symbols.

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
    eom: tuple = ()
    watch: dict = field(default_factory=dict)
    values: dict = field(default_factory=dict)
    name: str = "scene"

    def __post_init__(self):
        try:
            self._check()
        except RecursionError:
            raise SceneError(
                f"{self.name}: an expression is nested too deeply to check; name its parts as signals, "
                "y = hl.signal(...), with an equation for each"
            ) from None

    def _check(self):
        eom = (self.eom,) if isinstance(self.eom, sp.Eq) else tuple(self.eom)
        for equation in eom:
            if not isinstance(equation, sp.Eq):
                raise SceneError(f"eom holds {equation!r}; needs equations, sp.Eq(left side, right side)")
        _set(self, "eom", eom)
        _set(self, "force", sp.sympify(self.force))
        _check_symbols((self.force, *(side for e in eom for side in e.args)))
        _set(self, "watch", _named(self.watch, self.coordinates))
        _check_symbols(self.watch.values())
        self._check_units()
        known = self.parameters
        defaults = {p.name: p.value for p in known.values() if p.value == p.value}
        _set(self, "values", {**defaults, **{name: _bound(known, name, value) for name, value in self.values.items()}})

    def __call__(self, **values):
        """Return the scene with these parameters bound, each in SI or as a text with its unit."""
        return replace(self, values={**self.values, **values})

    @property
    def parameters(self):
        """The parameters in use, name -> Parameter, in alphabetical order."""
        found = {}
        for expr in self._expressions():
            for p in expr.atoms(Parameter) - {T}:
                if found.setdefault(p.name, p) != p:
                    raise ParameterError(
                        f"two different parameters are called {p.name} ({found[p.name].unit} and {p.unit}); "
                        "declare it once and use that one everywhere"
                    )
        return dict(sorted(found.items()))

    @property
    def coordinates(self):
        """The generalized coordinates in use, in alphabetical order."""
        return tuple(_applied(self._expressions(), "coordinate"))

    @property
    def watch_units(self):
        """The SI unit of each watched channel."""
        return {name: unit_of(expr) for name, expr in self.watch.items()}

    def explicit(self):
        """Return the equations solved for what they determine: ``M a = f`` and the difference equations."""
        return explicit_form(self)

    def _expressions(self):
        watched = self.watch.values() if isinstance(self.watch, dict) else ()
        written = [self.force, *(side for e in self.eom for side in e.args), *watched]
        used = _applied(written, "coordinate", "signal")
        starts = [getattr(type(q), part) for q in used for part in ("initial", "rate") if hasattr(type(q), part)]
        return [*written, *starts]

    def _check_units(self):
        agree_with(self.force, "N", "force")
        for number, equation in enumerate(self.eom, 1):
            agree(equation.args, f"equation of motion {number}")
        for name, expr in self.watch.items():
            agree([expr], f"watch {name}")
        for q in _applied(self._expressions(), "coordinate", "signal"):
            kind = type(q)
            agree_with(kind.initial, kind.unit, f"initial value of {kind.__name__}")
            if hasattr(kind, "rate"):
                rate_unit = f"({kind.unit})/s" if kind.unit != "1" else "1/s"
                agree_with(kind.rate, rate_unit, f"initial rate of {kind.__name__}")

    def __str__(self):
        lines = [f"scene {self.name}", f"  F = {self.force}"]
        lines += [f"  {e.lhs} = {e.rhs}" for e in self.eom]
        shown = (f"{p.name} = {self.values.get(p.name, '?')} {p.unit}" for p in self.parameters.values())
        return "\n".join([*lines, "  " + (", ".join(shown) or "no parameters")])

    def _repr_latex_(self):
        rows = [f"F_e = {sp.latex(self.force)}", *(sp.latex(e) for e in self.eom)]
        return "$\\displaystyle \\begin{array}{l}" + r" \\ ".join(rows) + "\\end{array}$"


def _set(scene, name, value):
    object.__setattr__(scene, name, value)


def agree_with(expr, unit, where):
    """Check that an expression has a unit; any mismatch is raised as a disagreement with a quantity in that unit."""
    expr = sp.sympify(expr)
    target = Parameter(f"({where}, in {unit})", unit)
    agree([expr, target], where)
    return dimension(unit)


def _applied(expressions, *roles):
    """Return the applied functions of a role (coordinate, signal, handle), sorted by name."""
    atoms = {a for e in expressions for a in sp.sympify(e).atoms(sp.Function)}
    return sorted((a for a in atoms if getattr(type(a), "role", None) in roles), key=str)


def _check_symbols(expressions):
    expressions = [sp.sympify(e) for e in expressions]
    for expr in expressions:
        for symbol in expr.free_symbols - {n, t}:
            if not isinstance(symbol, Parameter):
                known = "it has no unit and no range"
                raise ParameterError(
                    f"{symbol} is a plain SymPy symbol: {known}; declare it, "
                    f"{symbol} = hl.parameters('{symbol}', units='...')"
                )
    for applied in _applied(expressions, "signal", "handle"):
        if lag_of(applied) is None and type(applied).role == "signal":
            raise SignalError(f"{applied}: {type(applied).__name__} is a discrete-time signal; write it at n, n-1, ...")
    for expr in expressions:
        for f in expr.atoms(sp.core.function.AppliedUndef):
            if not hasattr(type(f), "role"):
                raise SceneError(
                    f"unknown function {f}; declare a coordinate, {type(f).__name__} = "
                    f"hl.coordinate('{type(f).__name__}', unit='m'), or a signal with hl.signal"
                )


def _named(watch, coordinates):
    if isinstance(watch, dict):
        return {str(name): sp.sympify(expr) for name, expr in watch.items()}
    by_name = {type(q).__name__: q for q in coordinates}
    named = {}
    for item in (watch,) if isinstance(watch, (str, sp.Basic)) else watch:
        if isinstance(item, str) and item not in by_name:
            raise SceneError(f"watch {item!r}: no such coordinate; there are {', '.join(by_name) or 'none'}")
        expr = by_name[item] if isinstance(item, str) else sp.sympify(item)
        is_named = getattr(type(expr), "role", None) == "coordinate"
        named[type(expr).__name__ if is_named else sp.sstr(expr)] = expr
    return named


def _bound(known, name, value):
    if name not in known:
        listed = ", ".join(f"{p.name} [{p.unit}]" for p in known.values()) or "none"
        raise ParameterError(f"{name} = {value!r}: the scene has no parameter {name}; it has {listed}")
    return known[name].check(value)
