"""What a scene requires at the sample rate: what is kept, what is left out and why, and what that saves, measured."""

from __future__ import annotations

import inspect
import math
from dataclasses import replace
from typing import Any

import sympy as sp

from ...compiler.ir.channels import short
from ...compiler.ir.options import live_names
from ...compiler.methods.chosen_method import ChosenMethod, chosen_method
from ...compiler.prune.constant_coefficients import Coefficients, linear_rows
from ...compiler.prune.constraint_lengths import held
from ...compiler.prune.dependence import FORCE, Dependence, part_of
from ...compiler.prune.excluded_modes import excluded, open_conditions
from ...compiler.tick.compile_scene import compile, lowered
from ...compiler.tick.handle_samples import is_past_sample
from ...errors import HapticlabError, SceneError
from ...scene.notation.symbols import n, t, v
from ...scene.notation.written import no_scene
from ...scene.scene import Scene
from .requirement_report import PART, Item, Requirements


def requires(scene: Scene, *, T: float = 1e-3, **options: Any) -> Requirements:
    """Say what a scene requires at the sample rate, what the compiler leaves out, why, and the instructions saved.

    Parameters
    ----------
    scene : Scene
    T : float
        Sampling period [s], > 0.
    **options
        Of :func:`hapticlab.compile`: method, substeps, hold, dtype, velocity, live.

    Returns
    -------
    Requirements
        Every figure is the difference of two programs that were compiled.

    Raises
    ------
    SceneError, ProgramError, ParameterError

    Examples
    --------
    >>> import hapticlab as hl, sympy as sp
    >>> z, y = hl.coordinate("z", unit="m"), hl.coordinate("y", unit="m")
    >>> k, m = hl.parameters("k m", units="N/m kg", values=(200, 0.05))
    >>> eom = [sp.Eq(m * z.diff(hl.t, 2), k * (hl.x(hl.t) - z)), sp.Eq(m * y.diff(hl.t, 2), k * (z - y))]
    >>> report = requires(hl.Scene(force=k * (hl.x(hl.t) - z), eom=eom), live="k")
    >>> for item in report.dropped:
    ...     print(item.name, item.kind, item.why)
    y state no path to F or a watched channel
    m parameter folded to 0.05 kg
    """
    if not isinstance(scene, Scene):
        raise SceneError(no_scene(scene, "write hl.mechanics.requires(hl.Scene(force=...))"))
    compile(scene, T=T, **options)  # refuses what it does not know
    defaults = {name: p.default for name, p in inspect.signature(compile).parameters.items() if name != "scene"}
    return _Report(scene, {**defaults, **options, "T": T}).made()


class _Report:
    """One scene and its options, compiled with and without each item."""

    def __init__(self, scene, options):
        self.form, self.decisions = excluded(scene, options["T"], live_names(options["live"]))
        self.scene, self.options = scene, {**options, "method": chosen_method(options["method"], self.form)}
        self.program = lowered(scene, **options)
        self.graph = Dependence(self.form)
        # the force comes first: what a channel sees too is kept for the force all the same
        self.paths = self.graph.paths(*self.graph.channels) | self.graph.paths(FORCE)
        self.whole = Dependence(scene.explicit())  # a part of a scene keeps its modes, and all they hold

    def made(self):
        felt, view = self._split()
        dropped = [*self._unseen(), *self._folded(), *self._modes(), *self._pairs(), *self._velocity()]
        watched = [name for i in dropped if i.saves == 0 and i.kind == "state" for name in i.name.split(", ")]
        dropped = [_in_words(i) for i in dropped if i.saves != 0 or i.kind in ("parameter", "mode")]
        everything = self._everything()
        rest = everything - len(self.program) - sum(i.saves for i in dropped if i.saves and i.kind != PART)
        if rest and dropped:
            dropped.append(Item("shared", "together", "shared by the rows above, or saved only together", rest))
        offers, declined = self._offers(felt, view)
        why = "its declared range is used, and outside it the motor switches off"
        kept, made_of = (*self._kept(), *(Item("state", name, why) for name in watched)), self._made_of()
        return Requirements(self.program, kept, tuple(dropped), offers, everything, felt, view, made_of, declined)

    def _more(self, scene=None, **changes):
        """The additional instructions of another scene or other options; None where these cannot be had."""
        try:
            return len(lowered(scene or self.scene, **{**self.options, **changes})) - len(self.program)
        except HapticlabError:
            return None

    def _seeing(self, expressions):
        """The scene with more channels, which cost nothing themselves but keep what they see."""
        more = {f"seen_{k}": e for k, e in enumerate(expressions)}
        return replace(self.scene, watch={**self.scene.watch, **more})

    def _of(self, name):
        return self.graph.coordinates.get(name) or self.graph.signals[name]

    def _states(self, name):
        q = self._of(name)
        order = dict(zip(self.form.coordinates, self.form.orders, strict=True)).get(q)
        return [q, q.diff(t)] if order == 2 else [q]

    # what is kept

    def _kept(self):
        for name in (*self.graph.coordinates, *self.graph.signals):
            if name in self.paths:
                kind = "state" if name in self.graph.coordinates else "signal"
                yield Item(kind, name, self._why_kept(name, kind))
        for q in self.scene.coordinates:
            if q not in self.form.coordinates:
                means = next(e.rhs for e in self.scene.eom if isinstance(e, sp.Eq) and e.lhs == q)
                yield Item("alias", type(q).__name__, f"another name of {short(means, 40)}: no state of its own")
        for name, p in self.scene.parameters.items():
            if any(c.name == name for c in self.program.parameters):
                yield Item("parameter", name, f"live: can be changed while it runs{_limits(p)}")

        for model in self.form.models:
            for c in model.contacts:
                does = f"may close: {type(c.contact_law).__name__}" if hasattr(c, "contact_law") else "may stick: friction"
                does = "may slip and creep: friction" if c.is_force and not hasattr(c, "contact_law") else does
                yield Item("contact", c.name, does)
        for condition in open_conditions(self.form, self.graph.needed):
            yield Item("mode", short(condition, 40), "open over the declared ranges: both sides are computed")

    def _why_kept(self, name, kind):
        *way, _ = self.paths[name]
        if kind == "signal" and self._is_alias(self.form.updates[self._of(name)]):
            return f"another name of {self.form.updates[self._of(name)]}: no instruction of its own"
        through = f" through {', '.join(way[1:])}" if len(way) > 1 else ""
        return f"{'the force' if way[0] == FORCE else way[0]} depends on it{through}"

    @staticmethod
    def _is_alias(expr):
        return hasattr(type(expr), "role")

    # what is left out

    def _unseen(self):
        dead = [name for name in (*self.graph.coordinates, *self.graph.signals) if name not in self.paths]
        for group in self.graph.groups(dead):
            kind = "state" if all(name in self.graph.coordinates for name in group) else "signal"
            kept = self._seeing([s for name in group for s in self._states(name)])
            yield Item(kind, ", ".join(group), "no path to F or a watched channel", self._more(kept))

    def _folded(self):
        live = live_names(self.options["live"])
        used = self._parameters_used()
        folded = [] if live is None else [name for name in self.scene.parameters if name in used and name not in live]
        if len(folded) > 1:
            yield Item("parameters", ", ".join(folded), "folded, all of them together; each by itself:", self._more(live=None))
        for name, p in self.scene.parameters.items():
            if name not in used:
                yield Item("parameter", name, "only parts that are left out use it")
            elif name in folded:
                why = f"folded to {self.scene.values[name]:g} {p.unit}".removesuffix(" 1")
                yield Item(PART if len(folded) > 1 else "parameter", name, why, self._more(live=(*live, name)))

    def _parameters_used(self):
        """The names in what the outputs can see, in the starts of it, and in the laws of contacts."""
        form, seen = self.form, [self.form.force, *self.form.watch.values()]
        laws = [getattr(c, "contact_law", c) for model in form.models for c in model.contacts]
        seen += [a for law in laws for a in vars(law).values() if isinstance(a, sp.Basic)]
        for k, q in enumerate(form.coordinates):
            if type(q).__name__ in self.paths:
                seen += [*form.M[k], form.f[k], type(q).initial, getattr(type(q), "rate", sp.S.Zero)]
        for y, expr in form.updates.items():
            if type(y).__name__ in self.paths:
                seen += [expr, type(y).initial]
        return {s.name for e in seen for s in e.free_symbols}

    def _modes(self):
        for written, decision in self.decisions.items():
            becomes = {sp.true: "always holds", sp.false: "never holds"}.get(decision.becomes, f"is {decision.becomes}")
            yield Item("mode", short(written, 40), f"{becomes}: {decision.why}", self._more(undecided=(written,)))

    def _pairs(self):
        for model in self.form.models:
            for pair in getattr(model.contacts, "dropped", ()):
                yield Item("pair", f"{pair.first}, {pair.second}", f"cannot touch: {pair.why}")

    def _velocity(self):
        if not any("v(n" in c.name or c.name == "x(n-1)" for c in (*self.program.states, *self.program.inputs)):
            yield Item("velocity", "v", "nothing uses it", self._more(self._seeing([v(n)])))

    def _everything(self):
        """The instructions with nothing left out."""
        names = (*self.graph.coordinates, *self.graph.signals)
        all_of_it = self._seeing([*(s for name in names for s in self._states(name)), v(n)])
        live = {} if self.options["method"].exact else {"live": None}
        more = self._more(all_of_it, undecided=tuple(self.decisions), **live)
        return len(self.program) + (more or 0)

    def _made_of(self):
        """The states of the program, in words."""
        names = {c.name for c in self.program.states}
        rates = {f"d{name}/dt" for name in self.graph.coordinates} & names
        coordinates = set(self.graph.coordinates) & names
        past = {name for name in names if is_past_sample(name)}
        parts = [(len(coordinates), "coordinate"), (len(rates), "rate"), (len(past), "past sample")]
        parts.append((len(names) - len(coordinates) - len(rates) - len(past), "other"))
        return ", ".join(f"{count} {word}{'s' * (count > 1 and word != 'other')}" for count, word in parts if count)

    # what is offered

    def _split(self):
        """(felt, view): the scene without the islands that only feed a view, and these."""
        graph = self.whole
        shown = [c for c in graph.channels if set(graph.paths(c)) - {c} - set(graph.paths(FORCE))]
        if not shown:
            return self.scene, None
        watch = {c: graph.channels[c] for c in shown}
        rest = {name: expr for name, expr in self.scene.watch.items() if name not in watch.values()}
        others = [c for c in graph.channels if c not in shown]
        felt = self._part(self.scene.force, rest, graph.paths(FORCE, *others), self.scene.name)
        of_view = {name: self.scene.watch[name] for name in watch.values()}
        return felt, self._part(sp.S.Zero, of_view, graph.paths(*shown), f"view of {self.scene.name}")

    def _part(self, force, watch, needed, name):
        """The scene of a force and channels, with the equations they need."""
        orders = dict(zip(self.form.coordinates, self.form.orders, strict=True))
        eom = [e for e in self.scene.eom if _defined(e, orders) & set(needed)]
        made = Scene(force=force, eom=eom, watch=watch, name=name)
        return made(**{p: value for p, value in self.scene.values.items() if p in made.parameters})

    def _offers(self, felt, view):
        """(what is offered, why exact is not, or None)."""
        offered, declined = [], None
        if view is not None:
            seen = set(self.whole.paths(*self.whole.channels)) - set(self.whole.channels)
            names = sorted(seen - set(self.whole.paths(FORCE)))
            more = self._more(felt)
            why = "only a view shows it. Run .felt on the board, and hl.records.replay(.view, log) on the record"
            offered.append(Item("view", ", ".join(names), why, None if more is None else -more))
        if self.form.coordinates and not self.options["method"].exact:
            linear, declined = self._linear()
            offered += linear
        return tuple(offered), declined

    def _linear(self):
        """The savings of method="exact", or ([], why it cannot be had)."""
        form = part_of(self.form, self.graph.needed)
        found = Coefficients(form, {}, self.options["T"])
        rows, reasons = linear_rows(found)
        if not rows:
            return [], next(iter(reasons.values()), "no equation of motion is needed")
        live = live_names(self.options["live"])
        settable = [name for name in self.scene.parameters if name not in held(self.scene)] if live is None else live
        kept = [name for name in settable if name not in found.live(rows)]
        method = self.options["method"]
        exact = str(ChosenMethod(True, method.rest if reasons else None))
        before, after = (self._more(live=kept, method=m) for m in (method, exact))
        names = ", ".join(type(form.coordinates[k]).__name__ for k in rows)
        why = f"method={exact!r}, live={' '.join(kept)!r}: no step error at any stiffness"
        return [Item("linear", names, why, None if None in (before, after) else before - after)], None


def _in_words(item):
    """An item whose savings are none without a number, and with words where it costs instructions."""
    if item.saves is None or item.saves > 0:
        return item
    return replace(item, saves=None, why=item.why + (f"; this costs {-item.saves} more" if item.saves else ""))


def _limits(p):
    unit = "" if p.unit == "1" else f" {p.unit}"
    if math.isinf(p.low) or math.isinf(p.high):
        low, high = (f"{sign} {end:g}{unit}" for sign, end in ((">=", p.low), ("<=", p.high)))
        return f", {high}" if math.isfinite(p.high) else f", {low}" if math.isfinite(p.low) else ""
    return f", from {p.low:g} to {p.high:g}{unit}"


def _defined(equation, orders):
    """The names that an entry of eom determines: a signal, or the coordinates whose highest rate it holds."""
    if not isinstance(equation, sp.Eq):
        return {type(q).__name__ for q in equation.coordinates}
    if getattr(type(equation.lhs), "role", None) == "signal":
        return {type(equation.lhs).__name__}
    return {type(d.expr).__name__ for d in equation.atoms(sp.Derivative) if orders.get(d.expr) == d.derivative_count}
