"""The elements of a mechanism, read off its equations: masses, springs, dampers, weights, drives, pendulums."""

from dataclasses import dataclass, field

import sympy as sp
from sympy.polys.polyerrors import PolynomialError

from ...errors import HapticlabError
from ...scene.notation.symbols import v
from .plain_formulas import formula, plain_symbols

RATE = "rate of "


@dataclass(frozen=True)
class Tie:
    """A spring, a damper or both between two movers, ``second`` empty for the ground; coefficients, None for no such part."""

    first: str
    second: str
    spring: object = None
    damper: object = None


@dataclass
class Elements:
    """What a scene's equations say of its coordinates in metres and of what swings on them.

    Attributes
    ----------
    masses : dict of str to expression
    ties : list of Tie
        ``x`` is the handle.
    drives : dict of str to expression
        Forces that depend on time.
    weights : dict of str to expression
        Accelerations that pull each towards its negative direction.
    carriers : dict of str to str
        Angle -> the coordinate that its pivot moves with, whose inertia it shares: a body, or the pendulum that it hangs on.
    rods, bobs : dict of str to expression
        Of such an angle: length of its pendulum, positive where it turns towards positive coordinates; mass of the bob.
    """

    masses: dict = field(default_factory=dict)
    ties: list = field(default_factory=list)
    drives: dict = field(default_factory=dict)
    weights: dict = field(default_factory=dict)
    carriers: dict = field(default_factory=dict)
    rods: dict = field(default_factory=dict)
    bobs: dict = field(default_factory=dict)


def elements(scene):
    """Return the :class:`Elements` of a scene; empty where its equations cannot be read so.

    Examples
    --------
    >>> import hapticlab as hl
    >>> found = elements(hl.library.mass_spring_damper())
    >>> found.masses, [(tie.first, tie.second, tie.spring, tie.damper) for tie in found.ties]
    ({'z': m}, [('x', 'z', K, b_c), ('z', '', k, b)])
    """
    try:
        return _read(scene, scene.explicit())
    except (HapticlabError, PolynomialError, NotImplementedError, ArithmeticError):
        return Elements()  # equations beyond this reading: bodies are drawn without what ties them


def _read(scene, form):
    found = Elements()
    units = {type(q).__name__: type(q).unit for q in form.coordinates}
    lengths = [name for name, unit in units.items() if unit == "m"]
    reader = _Reader(scene, [*units, "x"])
    rows = {name: reader.row(form, k) for k, name in enumerate(units) if name in lengths}
    for name, (mass, acts) in rows.items():
        found.masses[name] = mass[name]
        constant = reader.at_rest(acts)
        weight = sp.cancel(-constant / mass[name]) if mass[name] != 0 else sp.S.Zero
        if weight != 0 and not weight.has(sp.Symbol("t", real=True)):
            found.weights[name] = weight
        drive = sum(term for term in sp.Add.make_args(acts) if term.has(sp.Symbol("t", real=True)))
        if drive != 0:
            found.drives[name] = drive
    found.ties = [tie for tie in reader.ties(rows) if tie]
    _pendulums(found, reader, form, units, rows)
    return found


def _pendulums(found, reader, form, units, rows):
    """Note what swings on a body, or on another pendulum that swings on it."""
    for k, (angle, unit) in enumerate(units.items()):
        inertia = reader.row(form, k)[0] if unit == "rad" else {}
        body = next((name for name in rows if inertia.get(name, 0) != 0), None)
        if body:
            rod = sp.cancel(inertia[angle] / inertia[body])
            bob = sp.cancel(rows[body][0][angle] / rod)
            above = [other for other in found.rods if found.carriers[other] == body and inertia[other] != 0]
            found.carriers[angle], found.rods[angle], found.bobs[angle] = (above or [body])[-1], rod, bob
            carried, mass = (found.bobs, above[-1]) if above else (found.masses, body)
            carried[mass] = sp.cancel(carried[mass] - bob)


class _Reader:
    """Expressions of a scene as polynomials in plain symbols, at rest where all is zero."""

    def __init__(self, scene, movers):
        self.movers = movers
        symbols = [sp.Symbol(prefix + name, real=True) for name in movers for prefix in ("", RATE)]
        self._rest = dict.fromkeys(symbols, sp.S.Zero)
        self._known = {s.name for s in symbols} | set(scene.parameters) | {"t", "T"}
        self.felt = self.plain(scene.force)

    def plain(self, expr):
        """An expression without what acts in cases alone, rates as symbols of their own."""
        expr = apart(expr)
        rates = {d: sp.Symbol(RATE + type(d.expr).__name__, real=True) for d in expr.atoms(sp.Derivative)}
        rates |= dict.fromkeys(expr.atoms(v), sp.Symbol(RATE + "x", real=True))
        expr = plain_symbols(expr.xreplace(rates))
        return expr.xreplace({s: sp.S.Zero for s in expr.free_symbols if s.name not in self._known})

    def at_rest(self, expr):
        """What an expression is where everything is at zero, at t = 0 for what is driven."""
        quiet = sum(term for term in sp.Add.make_args(sp.expand(expr)) if not term.has(sp.Symbol("t", real=True)))
        return sp.cancel(sp.sympify(quiet).xreplace(self._rest))

    def slope(self, expr, name, prefix=""):
        """The derivative of a force by a position or a rate, at rest; None where it has none anywhere."""
        slope = sp.sympify(expr).diff(sp.Symbol(prefix + name, real=True))
        if slope == 0:
            return None
        rest = sp.cancel(slope.xreplace(self._rest))
        return rest if rest.is_finite is not False else sp.S.Zero

    def row(self, form, k):
        """Inertias by name and the force of one equation, scaled so that it is a balance of forces."""
        acts, names = self.plain(form.f[k]), [type(q).__name__ for q in form.coordinates]
        scale, name = sp.denom(sp.together(acts)), names[k]
        for prefix in ("", RATE):
            felt, own = self.slope(self.felt, name, prefix), self.slope(acts, "x", prefix)
            if felt and own:
                scale = sp.cancel(-felt / own)
                break
        inertia = {
            other: sp.cancel(scale * self.plain(m).xreplace(self._rest)) for other, m in zip(names, form.M[k], strict=True)
        }
        return inertia, sp.expand(scale * acts)

    def ties(self, rows):
        """Yield the ties of each mover to the handle, to those after it, and to the ground."""
        names = list(rows)
        for k, name in enumerate(names):
            acts = rows[name][1]
            parts = {other: [self.slope(acts, other, prefix) for prefix in ("", RATE)] for other in ("x", *names)}
            if any(part is not None for part in parts["x"]):
                yield Tie("x", name, *parts["x"])
            for other in names[k + 1 :]:
                if any(part is not None for part in parts[other]):
                    yield Tie(name, other, *parts[other])
            sums = [sp.cancel(-sum(parts[other][way] or 0 for other in parts)) for way in (0, 1)]
            held = [total if total != 0 and parts[name][way] is not None else None for way, total in enumerate(sums)]
            if any(part is not None for part in held):
                yield Tie(name, "", *held)


def apart(expr):
    """Return a force without what acts in cases alone, as walls and contacts do."""
    left = _without_cases(sp.sympify(expr))  # of a distance between shapes, a case holds what is not differentiated in symbols
    return _without_cases(left.doit())


def _without_cases(expr):
    return expr.xreplace(dict.fromkeys(expr.atoms(sp.Piecewise, sp.Max, sp.Min), sp.S.Zero))


def value_of(expr):
    """Return (function of a dict of numbers -> number, None where one is not known; names) of a coefficient."""
    if expr is None:
        return (lambda known: None), frozenset()
    value, names = formula(expr)
    return (lambda known: value(known)[0] if names <= set(known) else None), names
