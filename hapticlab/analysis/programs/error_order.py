"""The order of the error that a scene's program may be expected to have: the least of what the method, the hold, the force
and the cases of the motion have."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import sympy as sp

from ...base.shows_itself import ShowsItself
from ...compiler.algebra.first_sample import numbers
from ...compiler.algebra.graph import Graph, driven
from ...compiler.ir.channels import short
from ...compiler.methods.chosen_method import chosen_method
from ...compiler.methods.method_checks import KINKS
from ...compiler.prune.dependence import Dependence, part_of
from ...compiler.prune.excluded_modes import excluded
from ...compiler.prune.mass_matrix import start_of
from ...compiler.tick.handle_samples import HOLDS, hold_named
from ...scene.notation.symbols import Parameter, acceleration, delay, n, t, v, x

if TYPE_CHECKING:
    from ...compiler.methods.chosen_method import AnyMethod
    from ...compiler.tick.handle_samples import Hold
    from ...scene.scene import Scene


@dataclass(frozen=True)
class Order(ShowsItself):
    """The order of an error in T, with what sets it.

    Attributes
    ----------
    limits : dict str -> float
        What limits it, in words, and the order that leaves; inf where nothing does.

    Examples
    --------
    >>> order = Order({"method rk4": 4, "hold zoh": 1})
    >>> float(order), str(order)
    (1.0, '1 (hold zoh; method rk4: 4)')
    """

    limits: dict[str, float]

    def __float__(self) -> float:
        return float(min(self.limits.values(), default=math.inf))

    def __str__(self) -> str:
        least = float(self)
        if least == math.inf:
            return "only rounding errors"
        first = [name for name, order in self.limits.items() if order == least]
        others = [f"{name}: {order:g}" for name, order in self.limits.items() if order > least and order < math.inf]
        return f"{least:g} ({'; '.join([', '.join(first), *others])})"


def order_of(
    scene: Scene,
    method: AnyMethod | None = None,
    *,
    hold: str | Hold = "soh",
    velocity: Literal["backward_difference", "measured"] = "backward_difference",
    force_at: Literal["before", "after", "mean"] = "before",
    **options: Any,
) -> Order:
    """The order in T of the error of the force that a scene's program computes, where T is short enough.

    Nothing is run: the order of a method is the one that its record states, and the others follow from the equations. The
    error is that beside the force at the sample, for ``force_at="mean"`` beside the mean force of the period, in a
    smooth motion of the handle.

    Parameters
    ----------
    scene : Scene
        Every parameter bound.
    method, hold, velocity, force_at
        Of :func:`hapticlab.compile`; its other options do not change the order.
    **options
        Other options of :func:`hapticlab.compile`.

    Returns
    -------
    Order
        ``float(order)``; printing it says what sets it.

    Examples
    --------
    >>> import hapticlab as hl, sympy as sp
    >>> K, b, m = hl.parameters("K b m", units="N/m N*s/m kg", values=(500, 0.2, 0.05))
    >>> z = hl.coordinate("z", unit="m")
    >>> F = K * (hl.x(hl.t) - z)
    >>> scene = hl.Scene(force=F, eom=[sp.Eq(m * z.diff(hl.t, 2), F - b * z.diff(hl.t))])
    >>> print(hl.methods.order_of(scene, "rk4"))
    3 (x(t) of hold soh; method rk4: 4)
    """
    form, _ = excluded(scene, options.get("T", 1e-3), ())
    graph = Graph(scene.values)
    form = part_of(form, Dependence(form, graph).needed)
    moving = graph.variables_of([*form.f, *sum(form.M, ()), *(g for model in form.models for g in model.constraints)])
    felt = graph.variables_of([form.force])
    chosen = chosen_method(method, form)
    seen = _seen(hold_named(hold), velocity, at_samples=_at_samples(chosen, options))
    limits: dict[str, float] = {}
    if form.coordinates:
        limits |= _of_method(chosen)
        limits |= _of_hold(moving, seen)
        if chosen.exact and any(a == t or isinstance(a, driven) for a in moving):
            limits["t followed by a parabola"] = 4
        if not chosen.locates:
            limits |= _of_cases(form, graph, scene.values)
    limits |= _of_force(felt, seen, velocity, force_at)
    return Order(limits)


def _of_method(method):
    order = method.rest.order if method.rest else None
    if method.locates and order:
        return {f"a series of order {order}": order}
    return {f"method {method}": order or math.inf}


def _at_samples(method, options):
    """Whether a method looks at the handle at samples alone: with steps before it, and no substeps between."""
    return not method.exact and not method.locates and method.rest.steps > 1 and options.get("substeps", 1) == 1


def _seen(hold, velocity, at_samples):
    """Text -> order: how x(t) and v(t) are seen over a period, and what is held from sample to sample."""
    of_x, of_v = HOLDS[hold].order_of_x, HOLDS[hold].order_of_v
    if not at_samples:
        return {f"x(t) of hold {hold}": of_x, f"v(t) of hold {hold}": of_v, "held over a period": 1}
    # at a sample x is exact, and v where it is measured; else it is the hold's slope there
    return {"x(n)": math.inf, "v(n)": math.inf if velocity == "measured" else of_v, "at samples": math.inf}


def _of_hold(variables, seen):
    """The limits that the handle between samples, and what is held over a period, set."""
    (of_x, of_v, (kept, of_held)), limits = seen.items(), {}
    for variable in variables:
        role = getattr(type(variable), "role", None)
        if variable in (x(t), v(t)):
            name, order = of_x if variable == x(t) else of_v
            limits[name] = order
        elif isinstance(variable, acceleration):
            limits["the handle's acceleration, estimated"] = 1
        elif isinstance(variable, delay):
            limits[f"{short(variable, 40)} late by one sample, held over a period"] = 1
        elif role == "signal" or (isinstance(variable, (x, v)) and variable.has(n)):
            limits[f"{variable} {kept}"] = of_held
    return limits


def _of_force(felt, seen, velocity, force_at):
    """The limits that the instant of the force sets, and the velocity in it."""
    limits = {}
    states = [a for a in felt if getattr(type(a.expr if a.is_Derivative else a), "role", None) in ("coordinate", "reaction")]
    if force_at == "after" and states:
        limits["states late by one period"] = 1
    if force_at == "mean":
        followed = [a for a in felt if a in (x(t), v(t))]
        limits |= {f"{name} in the force": order for name, order in _of_hold(followed, seen).items()}
        felt = [a for a in felt if a not in followed]
    if velocity == "backward_difference" and any(isinstance(a, v) for a in felt):
        limits["v(n) a backward difference"] = 1
    return limits


def _of_cases(form, graph, values):
    """The limits of cases that a method steps over: of a motion whose force goes as d**p at a distance d, p + 1."""
    limits, generator = {}, np.random.default_rng(7)
    for q, f in zip(form.coordinates, form.f, strict=True):
        for case in sorted(f.atoms(*KINKS), key=str):
            power = min(_power(side, f, graph, values, generator) for side in _sides(case))
            if power < math.inf:
                limits[f"{short(case, 40)} in the equation of {type(q).__name__}, not located"] = power + 1
    return limits


def _sides(case):
    """The expressions that are zero where a case ends."""
    if isinstance(case, sp.Piecewise):
        return [r.lhs - r.rhs for _, c in case.args for r in c.atoms(sp.core.relational.Relational)] or [sp.S.One]
    if isinstance(case, (sp.Max, sp.Min)):
        return [a - b for a, b in itertools.combinations(case.args, 2)]
    return [case.args[0]]


def _power(side, f, graph, values, generator, looks=6):
    """The least power of the distance from where ``side`` is zero by which f is not smooth there; inf where it is.

    The fourth difference of d**p goes as d**p, that of a smooth function as d**4. It is taken at some places of each.
    """
    found = math.inf
    moving = [a for a in graph.variables_of([side]) if not isinstance(a, Parameter)]
    for _ in range(looks if moving else 0):
        at = {a: _somewhere(a, values, generator) for a in graph.variables_of([side, f])}
        for a in moving:
            edge = _zero(lambda place, a=a, at=at: graph.evaluate([side], at | {a: place})[0], at[a])
            if edge is not None:
                found = min(found, _roughness(lambda place, a=a, at=at: graph.evaluate([f], at | {a: place})[0], edge))
    return found


def _somewhere(variable, values, generator):
    if isinstance(variable, Parameter):
        return values[variable.name]
    start = (numbers([start_of(variable)], values) or [0.0])[0]
    return start + generator.uniform(-0.05, 0.05) * (10.0 if variable.is_Derivative else 1.0)


def _zero(of, place):
    """A zero of a function, by the secant method from a place, or None."""
    a, b = place, place + 1e-3
    for _ in range(30):
        ya, yb = float(of(a)), float(of(b))
        if yb == 0:
            return b
        if not math.isfinite(ya - yb) or ya == yb:
            return None
        a, b = b, b - yb * (b - a) / (yb - ya)
        if abs(b - a) < 1e-14 * max(abs(b), 1e-3):
            return b
    return None


def _roughness(of, edge):
    """The power of the distance by which a function is not smooth at an edge, in halves; inf from 3 on."""
    steps = np.array([-1.63, -0.63, 0.37, 1.37, 2.37])  # not even about the edge: an odd jump would cancel
    for d in (1e-6, 1e-4, 1e-3):  # a smoother edge shows farther from it
        near, far = (of(edge + steps * k * d) @ [1.0, -4.0, 6.0, -4.0, 1.0] for k in (1.0, 4.0))
        size = np.abs(of(edge + 8.0 * d * steps)).max()
        if np.isfinite([near, far, size]).all() and near and abs(far) > 1e-11 * size:
            power = round(2.0 * math.log(abs(far / near), 4.0)) / 2.0
            return max(power, 0.0) if power < 3.0 else math.inf
    return math.inf
