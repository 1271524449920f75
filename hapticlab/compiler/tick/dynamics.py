"""The equations of motion of a scene at one instant of a step, as traced values: M a = f, constraints, contacts."""

import numpy as np
import sympy as sp

from ...errors import MassError, ParameterError, SceneError
from ...scene.notation.derivative import Partial
from ...scene.notation.symbols import acceleration, t, v, x
from ..algebra.first_sample import numbers
from ..algebra.linear_solve import solve
from ..constraints.enforcement_choice import enforcement
from ..constraints.port_mass import port_mass
from ..contacts.contact_starts import check_starts
from ..contacts.contact_steps import check_contacts
from ..contacts.coordinate_bounds import BEYOND
from ..contacts.scene_contacts import Contacts, unfelt
from ..events.switched_linear import linear_between
from ..events.taylor_method import Taylor, advance
from ..ir.structural_zeros import dot, plus, scaled
from ..methods.force_timing import IMPULSE
from ..methods.implicit_damping import stiffened
from ..methods.method_checks import check_suited
from ..methods.multistep import advanced
from ..prune.constraint_lengths import check_lengths
from ..prune.mass_matrix import is_definite, start_of


class Dynamics:
    """What moves between two samples.

    Parameters
    ----------
    lowering : the scene's lowering
        Its tracing, its handle, and what translates expressions.
    form : ExplicitForm
    method : Method or Taylor
    substeps : int

    Attributes
    ----------
    second, first : tuple of coordinates
        Those that are integrated: with their rates, and by a given rate.
    notes : tuple of str
        How constraints are kept, and what models say of where they came from.
    """

    def __init__(self, lowering, form, method, substeps):
        self.lowering, self.form, self.method, self.substeps = lowering, form, method, substeps
        self.h = lowering.tracing.T / substeps
        self.constraints = constraints = [g for model in form.models for g in model.constraints]
        try:
            self.definite = is_definite(form, lowering.scene.values, lowering.graph)
        except MassError:
            if not constraints:
                raise
            self.definite = False  # a constraint may carry what has no mass of its own
        self.enforced, self.notes = self._enforced(constraints) if constraints else (None, ())
        self.notes = (*self.notes, *(note for model in form.models for note in model.notes), *unfelt(form))
        kept = self.enforced.coordinates if self.enforced else ()
        orders = dict(zip(form.coordinates, form.orders, strict=True))
        self.others = tuple(q for q in form.coordinates if q not in kept)
        driven, following = (self.enforced.second, self.enforced.first) if self.enforced else ((), ())
        self.second = (*driven, *(q for q in self.others if orders[q] == 2))
        self.first = (*following, *(q for q in self.others if orders[q] == 1))
        self.states = (*self.second, *(q.diff(t) for q in self.second), *self.first)
        elements = [c for model in form.models for c in model.contacts]
        self.contacts = Contacts(elements, lowering.tracing, lowering.at_sample, self.at)
        self.largest = {}
        if form.coordinates:
            self.contacts.check(method)
            if not isinstance(method, Taylor):
                check_suited(method, form, lowering.graph, lowering.exact is not None)
            check_starts(form, lowering.scene.values)
            self.largest = check_contacts(form, lowering.scene.values, self.h, lowering.tracing.T, method)
        self._now = None
        self.at_the_sample = None  # (q, w, s) and (a, ds), without implicit damping, of the first stage that is traced
        self.masses = None  # those of ``second`` there, where no constraint adds to them

    def _enforced(self, constraints):
        form, lowering = self.form, self.lowering
        model = next(m for m in form.models if m.constraints)
        coordinates = tuple(q for m in form.models if m.constraints for q in m.coordinates)
        start = self._start()
        M = lowering.graph.evaluate([m for row in self._part(coordinates)[0] for m in row], start)
        enforced, notes = enforcement(
            constraints, coordinates, start, enforce=model.enforce, alpha=model.alpha,
            M=np.reshape(M, (len(coordinates), -1)), method=self.method, h=self.h, real=lowering.tracing.real,
            used=[form.force, *form.watch.values(), *(e for m in form.models for e in m.written)],
        )  # fmt: skip
        embedding = getattr(enforced, "embedding", None)
        check_lengths(constraints, coordinates, start, lowering.folded, lowering.tracing.real, embedding)
        return enforced, notes

    def _start(self):
        """Return what every variable is at the first sample: variable -> float."""
        scene = self.lowering.scene
        unbound = [p.name for p in scene.parameters.values() if p.name not in scene.values]
        if unbound:
            raise ParameterError(f"{', '.join(unbound)} needs a value to check the constraints: scene({unbound[0]}=...)")
        moving = [*self.form.coordinates, *(q.diff(t) for q in self.form.coordinates)]
        start = dict(zip(moving, numbers([start_of(s) for s in moving], scene.values), strict=True))
        start |= {p: scene.values[name] for name, p in scene.parameters.items()}
        return start | {x(t): 0.0, v(t): 0.0, acceleration(t): 0.0, t: 0.0}

    def _part(self, coordinates):
        """Return the rows of M and f of some coordinates; they must not hold accelerations of the others."""
        form, at = self.form, [self.form.coordinates.index(q) for q in coordinates]
        for k in at:
            held = [type(q).__name__ for q, m in zip(form.coordinates, form.M[k], strict=True) if m != 0 and q not in coordinates]
            if held:
                name = type(form.coordinates[k]).__name__
                raise SceneError(
                    f"the equation of {name} holds the acceleration of {held[0]}, which a constraint determines; "
                    f"put {name} into the same hl.lagrange(...)"
                )
        return [[form.M[k][j] for j in at] for k in at], [form.f[k] for k in at]

    def at(self, tau, q, w, s):
        """Return what translates expressions at ``tau`` [s] after the sample, in the state (q, w, s)."""
        lowering, exact = self.lowering, self.lowering.exact
        held = dict(zip(self.states, [*q, *w, *s], strict=True)) | (exact.at(tau) if exact else {})
        held |= lowering.handle.leaves(tau) | self.contacts.leaves
        return self.translator(held, tau, lowering.at_sample, lambda leaf: lowering.translator(leaf, tau))

    def translator(self, held, tau, at_sample, make):
        """Return what ``make(leaf)`` makes of a leaf: what is ``held``, what constraints determine, else ``at_sample``."""

        def leaf(expr):
            if expr in held:
                return held[expr]
            follows = instant.leaf(expr) if instant else None
            if follows is not None:
                return follows
            return at_sample(expr) + tau if expr == t else at_sample(expr)

        translate = make(leaf)
        instant = self.enforced.instant(translate) if self.enforced else None
        translate.instant = instant
        return translate

    def rates(self, tau, q, w, s, at=None):
        """Return (a, ds): the accelerations of ``second`` and the rates of ``first``; ``at`` makes the translator."""
        translate, implicit = (at or self.at)(tau, q, w, s), getattr(self.method, "implicit_damping", False)
        found = self._solved(translate, implicit)
        if at is None and self.at_the_sample is None:
            self.at_the_sample = (q, w, s), self._solved(translate, False) if implicit else found
            self.masses = None if self.enforced else self._values(translate, self.second)[0]
        return found

    def _solved(self, translate, implicit):
        """Return (a, ds) at the instant of a translator."""
        a, ds = [], []
        if self.enforced:
            M, f = self._values(translate, self.enforced.coordinates, implicit)
            a, ds = self.enforced.rates(translate.instant, M, f)
            averaged = self.form.f[self.form.coordinates.index(IMPULSE)] if IMPULSE in self.others else sp.S.Zero
            felt = [r for r in averaged.atoms(sp.Function) if hasattr(type(r), "constraint")]
            found = self.enforced.reactions(translate.instant, M, f) if felt else {}
            translate.known |= {r: found[type(r).constraint] for r in felt}
        solution = solve(*self._values(translate, self.others, implicit), self.definite) if self.others else []
        found = dict(zip(self.others, solution, strict=True))
        if implicit and IMPULSE in found:
            found[IMPULSE] = self._felt_at_the_end(translate, found)
        return [*a, *(found[q] for q in self.second if q in found)], [*ds, *(found[q] for q in self.first if q in found)]

    def reaction(self, expr, translate, instant):
        """Return the reaction of a constraint at the instant of a translator."""
        if type(expr).constraint not in self.constraints:
            raise SceneError(f"{expr} is the reaction of {type(expr).constraint} = 0; add it to the constraints of hl.lagrange")
        return self.enforced.reactions(instant, *self._values(translate, self.enforced.coordinates))[type(expr).constraint]

    def _values(self, translate, coordinates, implicit=False):
        """Return M and f of some coordinates as values, with ``implicit`` damping (M - h D, f)."""
        M, f = self._part(coordinates)
        if implicit:
            orders = [self.form.orders[self.form.coordinates.index(q)] for q in coordinates]
            return stiffened(M, f, coordinates, orders, translate, self.h, self.lowering.scene.values)
        return [list(map(translate, row)) for row in M], list(map(translate, f))

    def _felt_at_the_end(self, translate, found):
        """Return the force that implicit damping ends with: what it gives the bodies, with the rates it moves them to."""
        felt = self.form.f[self.form.coordinates.index(IMPULSE)]
        slopes = [translate(Partial(felt, q.diff(t))) for q in self.second if q in found]
        moved = [found[q] for q in self.second if q in found]
        return plus(found[IMPULSE], scaled(self.h, dot(slopes, moved)))

    def _hovering(self, tau, state):
        """Return the state after the micro-impulses at the end of a step."""
        if not self.contacts.hovering:
            return state
        if self.enforced:
            names = ", ".join(c.name for c in self.contacts.hovering)
            raise SceneError(f"{names}: micro-impulses know no constraints; take the law impulse or rigid, with method='taylor'")
        translate = self.at(tau, *state)
        M, f = self._values(translate, self.second)
        return state[0], self.contacts.hover(tau, state, M, f, self.second, self.h, self.definite), state[2]

    def settled(self, tau, state):
        """Return the state with the constraints met again, once a period."""
        if not self.enforced:
            return state

        def at(state):
            translate = self.at(tau, *state)
            return translate.instant, self._values(translate, self.enforced.coordinates)[0]

        n2, n1 = len(self.enforced.second), len(self.enforced.first)
        q, w, s = state
        met = self.enforced.settle(lambda part: at(self._whole(part, state)), (q[:n2], w[:n2], s[:n1]))
        return self._whole(met, state)

    @staticmethod
    def _whole(part, state):
        return tuple([*own, *rest[len(own) :]] for own, rest in zip(part, state, strict=True))

    def leaf_at_sample(self, expr):
        """Return a coordinate that others determine, or a reaction, at the sample; None for anything else."""
        role = getattr(type(expr), "role", None)
        if role in ("reaction", "impulse", "impact_loss", "impact_work", "rub") and not hasattr(type(expr), "constraint"):
            return self.contacts.at_sample(expr)
        if self.enforced and self._now is None:
            self._now = self.enforced.instant(self.lowering.at_sample)
        if hasattr(type(expr), "constraint"):
            return self.reaction(expr, self.lowering.at_sample, self._now)
        if not self.enforced:
            return None
        return self._now.leaf(expr)

    @property
    def facts(self):
        """The mass that is felt through a constraint on the handle, where the force is its reaction."""
        if not self.enforced or not any(hasattr(type(f), "constraint") for f in self.form.force.atoms(sp.Function)):
            return {}
        M, f = self._part(self.enforced.coordinates)
        return {"port_mass": port_mass(self.enforced, self.form.force, M, f, self._start())}

    def advance(self):
        """Trace one period; return (values of ``states`` after it, facts, count of unlocated steps or None)."""
        lowering, tracing = self.lowering, self.lowering.tracing
        if not self.states:
            return [], self.facts, None
        second = [lowering.state(q) for q in self.second]
        groups = (second, [lowering.state(q.diff(t)) for q in self.second], [lowering.state(q) for q in self.first])
        facts, unlocated, reacting = self.facts, None, []
        if isinstance(self.method, Taylor):
            contacts = self.contacts.reactions if self.contacts.located else None
            groups, located, unlocated = advance(
                self.method, tracing, self.rates, groups, self.h, self.substeps, lowering.scene.values,
                lowering.scene.name, contacts=contacts, impact=self.contacts.impact if contacts else None,
                after=reacting.extend, ranges=[(type(q).low, type(q).high) for q in self.second],
                bound=bool(self.enforced),
            )  # fmt: skip
            facts |= located
            if "maps" in located:
                self.notes += (linear_between(located),)
            if "remainder" in located:
                self.notes += (f"{BEYOND}the Taylor series of a step diverges; take more substeps",)
            self.notes += self.contacts.faults
            groups = self._hovering(tracing.T, groups)
        elif self.method.steps > 1:
            groups = advanced(self, groups)
        else:
            for step in range(self.substeps):
                groups = self._hovering((step + 1) * self.h, self.method.step(self.rates, step * self.h, groups, self.h))
        self.contacts.finish(reacting)
        groups = self.settled(tracing.T, groups)
        return [value for group in groups for value in group], facts, unlocated
