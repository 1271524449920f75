"""The equations of motion of a scene at one instant of a step, as traced values: M a = f, constraints, contacts."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import NamedTuple

import numpy as np
import sympy as sp

from ...errors import MassError, ParameterError, SceneError
from ...scene.notation.derivative import Partial
from ...scene.notation.symbols import acceleration, t, v, x
from ..algebra.expressions import Translator
from ..algebra.first_sample import numbers
from ..algebra.linear_solve import solve
from ..constraints.enforcement_choice import enforcement
from ..constraints.felt_mass import port_mass
from ..contacts.scene_contacts import InstantContacts, Touching
from ..events.switched_linear import linear_between
from ..events.taylor_method import Taylor, advance
from ..ir.notes import UndefinedForceNote
from ..ir.structural_zeros import dot, plus, scaled
from ..ir.trace import Value
from ..methods.force_timing import IMPULSE
from ..methods.implicit_damping import stiffened
from ..methods.multistep import advanced
from ..prune.constraint_lengths import check_lengths
from ..prune.mass_matrix import is_definite, start_of
from .leaf_values import Tick, unknown_reaction


class Moment(NamedTuple):
    """One instant of a step: what translates expressions there, and what constraints determine there, or None."""

    translate: Translator
    follows: object


class Equations:
    """The equations of motion of a scene, in which state and at which instant whoever asks says.

    Parameters
    ----------
    form : ExplicitForm
    scene : Scene
    tick : Tick
    method : Method or Taylor
    h : float
        Step [s].

    Attributes
    ----------
    second, first : tuple of coordinates
        Those that are integrated: with their rates, and by a given rate.
    states : tuple of coordinates and rates
        In the order q, q', s.
    damped : float or None
        The step [s] of a method with implicit damping.
    enforced : Closed, Multipliers or Partitioned
        What keeps the constraints, or None.
    notes : tuple of str
        How constraints are kept, and what models say of where they came from.
    """

    def __init__(self, form, scene, tick, method, h):
        self.form, self.values, self.h = form, scene.values, h
        self.damped = h if getattr(method, "implicit_damping", False) else None
        self.constraints = [g for model in form.models for g in model.constraints]
        try:
            self.definite = is_definite(form, scene.values, tick.graph)
        except MassError:
            if not self.constraints:
                raise
            self.definite = False  # a constraint may carry what has no mass of its own
        self.enforced, self.notes = self._enforced(scene, tick, method) if self.constraints else (None, ())
        self.notes = (*self.notes, *(note for model in form.models for note in model.notes))
        kept = self.enforced.coordinates if self.enforced else ()
        orders = dict(zip(form.coordinates, form.orders, strict=True))
        self.others = tuple(q for q in form.coordinates if q not in kept)
        driven, following = (self.enforced.second, self.enforced.first) if self.enforced else ((), ())
        self.second = (*driven, *(q for q in self.others if orders[q] == 2))
        self.first = (*following, *(q for q in self.others if orders[q] == 1))
        self.states = (*self.second, *(q.diff(t) for q in self.second), *self.first)

    def _enforced(self, scene, tick, method):
        form, real = self.form, tick.tracing.real
        model = next(m for m in form.models if m.constraints)
        coordinates = tuple(q for m in form.models if m.constraints for q in m.coordinates)
        start = _start(form, scene)
        M = tick.graph.evaluate([m for row in self._part(coordinates)[0] for m in row], start)
        enforced, notes = enforcement(
            self.constraints, coordinates, start, enforce=model.enforce, alpha=model.alpha,
            M=np.reshape(M, (len(coordinates), -1)), method=method, h=self.h, real=real,
            used=[form.force, *form.watch.values(), *(e for m in form.models for e in m.written)],
        )  # fmt: skip
        embedding = getattr(enforced, "embedding", None)
        check_lengths(self.constraints, coordinates, start, tick.fixed, real, embedding)
        return enforced, notes

    def _part(self, coordinates):
        """The rows of M and f of some coordinates; they must not hold accelerations of the others."""
        form, at = self.form, [self.form.coordinates.index(q) for q in coordinates]
        for k in at:
            held = [type(q).__name__ for q, m in zip(form.coordinates, form.M[k], strict=True) if m != 0 and q not in coordinates]
            if held:
                name = type(form.coordinates[k]).__name__
                raise SceneError(
                    f"the equation of {name} contains the acceleration of {held[0]}, which a constraint determines; "
                    f"put {name} into the same hl.mechanics.lagrange(...)"
                )
        return [[form.M[k][j] for j in at] for k in at], [form.f[k] for k in at]

    def grouped(self, values):
        """Values in the order of ``states`` as the lists (q, w, s)."""
        n = len(self.second)
        return values[:n], values[n : 2 * n], values[2 * n :]

    def moment(self, make, held, otherwise):
        """The instant at which a leaf is what is ``held`` of it, what constraints determine, or ``otherwise(leaf)``.

        ``make(leaf)`` makes a translator of what leaves stand for.
        """

        def leaf(expr):
            if expr in held:
                return held[expr]
            value = follows.leaf(expr) if follows else None
            return otherwise(expr) if value is None else value

        translate = make(leaf)
        follows = self.enforced.instant(translate) if self.enforced else None
        return Moment(translate, follows)

    def solved(self, moment, damped=None):
        """(a, ds) at an instant: the accelerations of ``second`` and the rates of ``first``; ``damped`` as above."""
        translate, follows = moment
        a, ds = [], []
        if self.enforced:
            M, f = self.at(translate, self.enforced.coordinates, damped)
            a, ds = self.enforced.rates(follows, M, f)
            averaged = self.form.f[self.form.coordinates.index(IMPULSE)] if IMPULSE in self.others else sp.S.Zero
            felt = [r for r in averaged.atoms(sp.Function) if hasattr(type(r), "constraint")]
            found = self.enforced.reactions(follows, M, f) if felt else {}
            translate.known |= {r: found[type(r).constraint] for r in felt}
        solution = solve(*self.at(translate, self.others, damped), self.definite) if self.others else []
        found = dict(zip(self.others, solution, strict=True))
        if damped is not None and IMPULSE in found:
            found[IMPULSE] = self._felt_at_the_end(translate, found, damped)
        return [*a, *(found[q] for q in self.second if q in found)], [*ds, *(found[q] for q in self.first if q in found)]

    def at(self, translate, coordinates, damped=None):
        """M and f of some coordinates as values, with implicit damping (M - h D, f)."""
        M, f = self._part(coordinates)
        if damped is not None:
            orders = [self.form.orders[self.form.coordinates.index(q)] for q in coordinates]
            return stiffened(M, f, coordinates, orders, translate, damped, self.values)
        return [list(map(translate, row)) for row in M], list(map(translate, f))

    def _felt_at_the_end(self, translate, found, h):
        """The force that implicit damping ends with: what it gives the bodies, with the rates it moves them to."""
        felt = self.form.f[self.form.coordinates.index(IMPULSE)]
        slopes = [translate(Partial(felt, q.diff(t))) for q in self.second if q in found]
        moved = [found[q] for q in self.second if q in found]
        return plus(found[IMPULSE], scaled(h, dot(slopes, moved)))

    def reaction(self, expr, moment):
        """The reaction of a constraint at an instant."""
        if type(expr).constraint not in self.constraints:
            unknown_reaction(expr)
        M, f = self.at(moment.translate, self.enforced.coordinates)
        return self.enforced.reactions(moment.follows, M, f)[type(expr).constraint]

    def facts(self, scene):
        """The mass that is felt through a constraint on the handle, where the force is its reaction."""
        if not self.enforced or not any(hasattr(type(f), "constraint") for f in self.form.force.atoms(sp.Function)):
            return {}
        M, f = self._part(self.enforced.coordinates)
        return {"port_mass": port_mass(self.enforced, self.form.force, M, f, _start(self.form, scene))}


def _start(form, scene):
    """What every variable is at the first sample: variable -> float."""
    unbound = [p.name for p in scene.parameters.values() if p.name not in scene.values]
    if unbound:
        raise ParameterError(f"{', '.join(unbound)} needs a value to check the constraints: scene({unbound[0]}=...)")
    moving = [*form.coordinates, *(q.diff(t) for q in form.coordinates)]
    start = dict(zip(moving, numbers([start_of(s) for s in moving], scene.values), strict=True))
    start |= {p: scene.values[name] for name, p in scene.parameters.items()}
    return start | {x(t): 0.0, v(t): 0.0, acceleration(t): 0.0, t: 0.0}


@dataclass(frozen=True)
class Dynamics:
    """What moves between two samples: the equations of motion inside a step.

    Attributes
    ----------
    tick : Tick
    sample : Translator
        What expressions are at the sample.
    equations : Equations
    contacts : InstantContacts or None
    exact : callable tau -> {state: value}
        What is advanced exactly, at ``tau`` [s] after the sample.
    unknowns : dict expression -> Value
        What stands for the reactions of contacts.
    """

    tick: Tick
    sample: Translator
    equations: Equations
    contacts: InstantContacts | None
    exact: Callable
    unknowns: dict

    def at(self, tau, q, w, s, unknowns=MappingProxyType({})):
        """The :class:`Moment` at ``tau`` [s] after the sample, in the state (q, w, s), with more unknowns."""
        held = dict(zip(self.equations.states, [*q, *w, *s], strict=True)) | self.exact(tau)
        held |= self.tick.handle.leaves(tau) | self.unknowns | unknowns

        def otherwise(expr):
            return self.sample(expr) + tau if expr == t else self.sample(expr)

        return self.equations.moment(lambda leaf: self.tick.translator(leaf, tau, self.sample), held, otherwise)

    def rates(self, tau, q, w, s, unknowns=MappingProxyType({}), damped=None):
        """(a, ds) in a state, as :meth:`Equations.solved` has them."""
        return self.equations.solved(self.at(tau, q, w, s, unknowns), damped)

    def touching(self):
        """The :class:`Touching` of one motion; None where no event is located."""
        if not (self.contacts and self.contacts.located):
            return None
        return Touching(self.contacts, lambda *at: self.at(*at).translate, self.sample, self.tick.tracing.T)

    def at_the_end(self, moved):
        """What translates the force once the period is traced: states as they ``moved`` to, all else as at the sample."""

        def otherwise(expr):
            if hasattr(type(expr), "contact"):
                self.sample(expr)
                return self.tick.tracing.next_of(expr)
            return self.equations.reaction(expr, moment) if hasattr(type(expr), "constraint") else self.sample(expr)

        moment = self.equations.moment(lambda leaf: self.tick.translator(leaf, sample=self.sample), moved, otherwise)
        return moment.translate

    def hovered(self, tau, state):
        """(the state after the micro-impulses at the end of a step, what they added up to)."""
        if not (self.contacts and self.contacts.hovering):
            return state, {}
        equations = self.equations
        if equations.enforced:
            names = ", ".join(c.name for c in self.contacts.hovering)
            raise SceneError(
                f"{names}: micro-impulses do not account for constraints. Use the law impulse or rigid, with method='taylor'"
            )
        translate, (q, w, s) = self.at(tau, *state).translate, state
        M, f = equations.at(translate, equations.second)
        w, amounts = self.contacts.hover(translate, w, M, f, equations.second, equations.h, equations.definite, self.sample)
        return (q, w, s), amounts

    def settled(self, tau, state):
        """The state with the constraints met again, once a period."""
        enforced = self.equations.enforced
        if not enforced:
            return state

        def at(state):
            moment = self.at(tau, *state)
            return moment.follows, self.equations.at(moment.translate, enforced.coordinates)[0]

        n2, n1 = len(enforced.second), len(enforced.first)
        q, w, s = state
        met = enforced.settle(lambda part: at(_whole(part, state)), (q[:n2], w[:n2], s[:n1]))
        return _whole(met, state)


def _whole(part, state):
    return tuple([*own, *rest[len(own) :]] for own, rest in zip(part, state, strict=True))


@dataclass(frozen=True)
class Period:
    """One period of the motion, traced; nothing where nothing moves.

    Attributes
    ----------
    start, state : (q, w, s)
        At the sample, and at its end.
    first : ((q, w, s), (a, ds))
        The first state at which a method asked for accelerations, and these, without implicit damping.
    facts : dict
    notes : tuple of str
    unlocated : Value or None
        Steps that left an event out.
    overlap : (Channel, Value) or None
        How deep bodies with located contacts are inside each other at its end.
    """

    start: tuple = ()
    state: tuple = ()
    first: tuple | None = None
    facts: dict = field(default_factory=dict)
    notes: tuple = ()
    unlocated: Value | None = None
    overlap: tuple | None = None


def one_period(dynamics, method, substeps, start, name, at_start):
    """Trace the motion from a state (q, w, s) at the sample to the next sample.

    Parameters
    ----------
    dynamics : Dynamics
    method : Method or Taylor
    substeps : int
    start : (q, w, s)
    name : str
        Of the scene, for messages.
    at_start : Translator
        What expressions are at the first sample.

    Returns
    -------
    Period
    """
    equations, tracing, h = dynamics.equations, dynamics.tick.tracing, dynamics.equations.h
    first, sums, touching = [], {}, dynamics.touching()

    def rates(tau, q, w, s):
        moment = dynamics.at(tau, q, w, s, touching.unknowns if touching else {})
        found = equations.solved(moment, equations.damped)
        if not first:
            first.append(((q, w, s), found if equations.damped is None else equations.solved(moment)))
        return found

    def hovered(dynamics, tau, state):
        state, amounts = dynamics.hovered(tau, state)
        for key, amount in amounts.items():
            sums[key] = sums[key] + amount if key in sums else amount
        return state

    state, facts, notes, unlocated, reactions, overlap = start, {}, (), None, (), None
    if isinstance(method, Taylor):
        done = advance(
            method, tracing, rates, start, h, substeps, dynamics.tick.values, name, touching,
            ranges=[(type(q).low, type(q).high) for q in equations.second], bound=bool(equations.enforced),
        )  # fmt: skip
        facts, unlocated, reactions = done.facts, done.unlocated, done.reactions if touching else ()
        notes = (linear_between(facts),) if "maps" in facts else ()
        notes += (UndefinedForceNote("the Taylor series of a step diverges. Use more substeps"),) if "remainder" in facts else ()
        notes += dynamics.contacts.faults if dynamics.contacts else ()
        if touching:
            dynamics = replace(dynamics, unknowns=dynamics.unknowns | touching.unknowns)
            overlap = dynamics.contacts.overlap(done.gaps) if done.gaps else None
        state = hovered(dynamics, tracing.T, done.groups)
        sums |= {(dynamics.contacts.contacts[i], role): amount for (role, i), amount in done.sums.items()}
    elif method.steps > 1:
        state = advanced(method, substeps, equations, dynamics.tick, at_start, start, rates)
    else:
        for step in range(substeps):
            state = hovered(dynamics, (step + 1) * h, method.step(rates, step * h, state, h))
    if dynamics.contacts:
        dynamics.contacts.finish(tracing, reactions, sums)
    return Period(start, dynamics.settled(tracing.T, state), first[0] if first else None, facts, notes, unlocated, overlap)
