"""The contacts of a scene in a program: reactions that a stepper locates, impacts, and what a force may know of them."""

import sympy as sp

from ...errors import ProgramError, SceneError
from ...scene.contact.contact import friction
from ...scene.contact.contact_law import law_names
from ...scene.notation.derivative import Partial, Rate
from ...scene.notation.symbols import t, x
from ..algebra.complementarity import response
from ..events.guards import contact, coulomb
from ..events.taylor_method import Taylor
from ..ir.program import Channel
from ..ir.structural_zeros import dot
from .coordinate_bounds import BEYOND
from .impacts import impacts_of
from .impulses import dissipated
from .touch import Law, micro_impulses

#: what an expression may ask of a contact -> unit, and whether it adds up over the run or starts anew at each sample
SUMS = {"impulse": False, "impact_loss": True, "impact_work": True}


class Contacts:
    """The contacts with laws of an instant and the frictions that stick, of one program.

    Parameters
    ----------
    elements : sequence of Contact and friction
        Those whose force is an expression are left out: they are in the equations of motion.
    tracing : Tracing
    constant : callable expression -> Value
        Of parameters alone.
    at : callable (tau, q, w, s) -> translator
        What expressions are inside a step. It asks :attr:`leaves` for the reactions.
    """

    def __init__(self, elements, tracing, constant, at):
        elements = [e for e in elements if not e.is_force]
        _check_names(elements)
        self.frictions = [e for e in elements if isinstance(e, friction)]
        contacts = [e for e in elements if not isinstance(e, friction)]
        self.hovering = [c for c in contacts if not c.is_located]
        self.contacts = [c for c in contacts if c.is_located]
        self.tracing, self.constant, self.at = tracing, constant, at
        self.order = _order(self.contacts)
        # a contact that hovers has no reaction inside a step
        self.leaves = {c.force: tracing.tick.const(0.0) for c in self.hovering}
        self.impacts, self.sums = None, {}

    @property
    def located(self):
        """True where events have to be located: then the method must be taylor."""
        return bool(self.contacts or self.frictions)

    def check(self, method):
        """Refuse a method that cannot locate what the scene needs located."""
        if self.located and not isinstance(method, Taylor):
            names = [e.name for e in (*self.contacts, *self.frictions)]
            needs = "need" if len(names) > 1 else "needs"
            at_the_end = ["every impact is late by up to a step"] * bool(self.contacts)
            at_the_end += ["a friction never comes to rest"] * bool(self.frictions)
            others = [law_names(lambda law: not law.is_located)] * bool(self.contacts)
            others += ["a friction with a stick_speed"] * bool(self.frictions)
            raise ProgramError(
                f"method = {method.name!r}: {', '.join(names)} {needs} events located inside the step, which is "
                f"method='taylor'; at the end of a step instead, {' and '.join(at_the_end)}. Other methods take "
                f"{', and '.join(others)}"
            )

    @property
    def faults(self):
        """What notes say of contacts that a handle may press together."""
        touching = [*self.contacts, *self.hovering]
        if len(touching) < 2 or not any(c.gap.has(x(t)) for c in touching):
            return ()
        return (
            f"{BEYOND}no force keeps contacts apart ({', '.join(c.name for c in touching)}): the handle presses a body "
            "against something that does not give; use penalty, or a coupler between handle and body",
        )

    # the two callables of a stepper

    def reactions(self, tau, q, w, s, new):
        """Return the Reactions of a motion, in the order contacts, then frictions."""
        self.leaves |= {e.force: new() for e in (*self.contacts, *self.frictions)}
        rubbing = [c for c in self.contacts if c.law.mu != 0]
        self.rubs = [new() for _ in rubbing]
        self.leaves |= {c.rub: rub for c, rub in zip(rubbing, self.rubs, strict=True)}
        translate = self.at(tau, q, w, s)
        self.slips = [translate(c.slip) for c in rubbing]
        made = [contact(translate(c.gap), self.leaves[c.force]) for c in self.contacts]
        for f in self.frictions:
            made.append(coulomb(new, translate(f.slip), translate(f.F_c), translate(f.F_s), self.leaves[f.force]))
        return made

    def impact(self, motion):
        """Return the Impacts of a motion, or None where nothing strikes."""
        if not self.contacts:
            return None
        k, rubbing, laws = len(self.contacts), [c for c in self.contacts if c.law.mu != 0], []
        for c in self.contacts:
            slip = k + rubbing.index(c) if c in rubbing else None
            speed = c.law.rest_speed
            speed = float("inf") if speed == sp.oo else None if speed is None else self.constant(speed)
            laws.append(Law(c.name, self.constant(c.law.e), speed, slip, self.constant(c.law.mu)))
        self.impacts = impacts_of(motion, laws, list(range(k)), self.tracing.T, self.order, self.slips, self.rubs)
        return self.impacts

    # micro-impulses, at the end of a step of any method

    def hover(self, tau, state, M, f, coordinates, h, definite):
        """Return the rates after the micro-impulses at the end of a step; M and f as they are there.

        ``coordinates`` are those of the rates w, in order.
        """
        q, w, s = state
        translate, contacts = self.at(tau, q, w, s), self.hovering
        J = [[translate(Partial(c.gap, coordinate)) for coordinate in coordinates] for c in contacts]
        W, P = response(M, J, definite)
        u, gaps = ([translate(part) for part in parts] for parts in zip(*((Rate(c.gap), c.gap) for c in contacts), strict=True))
        b = [dot(f, column) + translate(Rate(Rate(c.gap))) for column, c in zip(P, contacts, strict=True)]
        laws = [Law(c.name, self.constant(c.law.e)) for c in contacts]
        envelopes = [self.constant(c.law.envelope) for c in contacts]
        p, after = micro_impulses(W, u, b, gaps, laws, envelopes, h)
        driven = [rate - dot(row, w) for rate, row in zip(u, J, strict=True)]
        work = [-(blow * rate) for blow, rate in zip(p, driven, strict=True)]
        for role, amounts in zip(SUMS, (p, dissipated(u, after, p), work), strict=True):
            for c, amount in zip(contacts, amounts, strict=True):
                self.sums[c, role] = self.sums[c, role] + amount if (c, role) in self.sums else amount
        return [rate + dot(p, [column[i] for column in P]) for i, rate in enumerate(w)]

    # what the force, the difference equations and the watched channels may know at a sample

    def at_sample(self, expr):
        """Return a reaction, or what impacts added up to, as a state that the step before this sample has set."""
        kind, tracing = type(expr), self.tracing
        name = kind.contact
        if name not in [e.name for e in (*self.contacts, *self.hovering, *self.frictions)]:
            raise SceneError(f"{name} is used but no model has it: hl.lagrange(..., contacts=[{name}])")
        if kind.role == "rub":
            return tracing.tick.const(0.0)
        channel = Channel(kind.__name__, kind.unit, tracing.real)
        return tracing.state(expr, channel, tracing.init.const(0.0))

    def at_the_end(self, expr):
        """Return a reaction, or what impacts added up to, at the end of the period."""
        self.at_sample(expr)
        return self.tracing.next_of(expr)

    def finish(self, reactions=()):
        """Set the states that :meth:`at_sample` gave: ``reactions`` are those at the end of the period, if any are located."""
        known = dict(zip((e.force for e in (*self.contacts, *self.frictions)), reactions, strict=True))
        if self.impacts:
            self.sums |= {(self.contacts[i], role): amount for (role, i), amount in self.impacts.sums.items()}
        for c in (*self.contacts, *self.hovering):
            for role, adds_up in SUMS.items():
                leaf, amount = getattr(c, role), self.sums.get((c, role), self.tracing.tick.const(0.0))
                known[leaf] = self.at_sample(leaf) + amount if adds_up else amount
        for c in self.hovering:
            known[c.force] = self.sums[c, "impulse"] * (1 / self.tracing.T)
        for leaf, value in known.items():
            self.at_sample(leaf)
            self.tracing.set_next(leaf, value)


def located(elements):
    """Tell whether any of contacts and frictions has events that a method must locate inside its step."""
    return any(e.is_located for e in elements)


def unfelt(form):
    """Yield a note on each contact with the handle whose impacts move the bodies, and nothing that is felt holds."""
    read = {leaf for e in (form.force, *form.updates.values()) for leaf in e.atoms(sp.Function)}
    for c in (c for model in form.models for c in model.contacts if not isinstance(c, friction)):
        if c.is_located and c.gap.has(x(t)) and c.impulse not in read:
            pulse = f"hl.felt_impulse({c.name}, tau='5 ms') makes them felt"
            yield f"{c.name} acts by impulses, which {c.name}.force does not hold; {pulse}"


def _check_names(elements):
    names = [e.name for e in elements]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice:
        raise SceneError(f"two contacts are called {twice}; give each a name of its own, name='...'")


def _order(contacts):
    orders = {c.law.order for c in contacts if c.law.order} or {"simultaneous"}
    if len(orders) > 1:
        named = "; ".join(f"{c.name}: {c.law.order}" for c in contacts if c.law.order)
        raise SceneError(f"{named}: the impacts of a scene are all sequential, or all simultaneous; choose one order")
    (order,) = orders
    rubbing = [c.name for c in contacts if c.law.mu != 0]
    if rubbing and order == "simultaneous" and len(contacts) > 1:
        raise SceneError(
            f"{rubbing[0]}: friction in impacts at several contacts at once has no unique outcome; take order='sequential', "
            "or mu = 0"
        )
    return order
