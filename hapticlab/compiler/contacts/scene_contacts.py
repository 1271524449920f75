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
from ..ir.notes import UndefinedForceNote
from ..ir.program import Channel
from ..ir.structural_zeros import dot
from ..ir.trace import maximum
from .impacts import impacts_of
from .impulses import dissipated
from .touch import Law, micro_impulses

#: what an expression may ask of a contact -> unit, and whether it adds up over the run or starts anew at each sample
SUMS = {"impulse": False, "impact_loss": True, "impact_work": True}


class InstantContacts:
    """The contacts with laws of an instant and the frictions that stick, of one scene.

    Parameters
    ----------
    elements : sequence of Contact and friction
        Those whose force is an expression are left out: they are in the equations of motion.

    Attributes
    ----------
    contacts, frictions : list
        Those whose events a stepper locates.
    hovering : list of Contact
        Those with micro-impulses, at the end of a step of any method.
    """

    def __init__(self, elements):
        elements = [e for e in elements if not e.is_force]
        _check_names(elements)
        self.frictions = [e for e in elements if isinstance(e, friction)]
        contacts = [e for e in elements if not isinstance(e, friction)]
        self.hovering = [c for c in contacts if not c.is_located]
        self.contacts = [c for c in contacts if c.is_located]
        self.order = _order(self.contacts)

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

    def overlap(self, gaps):
        """The output that says how deep bodies are inside each other, (Channel, Value), from the gaps of ``contacts``.

        Of lengths [m]; of angles [rad] where every located contact is a joint that stops.
        """
        lengths = [gap for c, gap in zip(self.contacts, gaps, strict=True) if c.unit == "N"]
        depth = 0.0
        for gap in lengths or gaps:
            depth = maximum(-gap, depth)
        return Channel("overlap", "m" if lengths else "rad", depth.type), depth

    @property
    def faults(self):
        """What notes say of contacts that a handle may press together."""
        touching = [*self.contacts, *self.hovering]
        if len(touching) < 2 or not any(c.gap.has(x(t)) for c in touching):
            return ()
        where = (
            f"no force keeps contacts apart ({', '.join(c.name for c in touching)}): the handle presses a body against "
            "something that does not yield. Use penalty, or a coupler between handle and body"
        )
        return (UndefinedForceNote(where),)

    def knows(self, expr):
        """Whether a reaction, or what impacts add up to, is that of one of these contacts and frictions."""
        return type(expr).contact in [e.name for e in (*self.contacts, *self.hovering, *self.frictions)]

    def hover(self, translate, w, M, f, coordinates, h, definite, constant):
        """(rates after the micro-impulses at the end of a step, {(contact, role): amount}); M and f as they are there.

        Parameters
        ----------
        translate : Translator
            What expressions are at the end of the step.
        w : list of Value
            Rates of the ``coordinates``, before.
        constant : callable expression -> Value
            Of parameters alone.
        """
        contacts = self.hovering
        J = [[translate(Partial(c.gap, coordinate)) for coordinate in coordinates] for c in contacts]
        W, P = response(M, J, definite)
        u, gaps = ([translate(part) for part in parts] for parts in zip(*((Rate(c.gap), c.gap) for c in contacts), strict=True))
        b = [dot(f, column) + translate(Rate(Rate(c.gap))) for column, c in zip(P, contacts, strict=True)]
        laws = [Law(c.name, constant(c.contact_law.e)) for c in contacts]
        envelopes = [constant(c.contact_law.envelope) for c in contacts]
        p, after = micro_impulses(W, u, b, gaps, laws, envelopes, h)
        driven = [rate - dot(row, w) for rate, row in zip(u, J, strict=True)]
        work = [-(blow * rate) for blow, rate in zip(p, driven, strict=True)]
        amounts = {
            (c, role): amount
            for role, found in zip(SUMS, (p, dissipated(u, after, p), work), strict=True)
            for c, amount in zip(contacts, found, strict=True)
        }
        return [rate + dot(p, [column[i] for column in P]) for i, rate in enumerate(w)], amounts

    def finish(self, tracing, reactions, sums):
        """Set the states that :func:`reaction_at_sample` gave.

        Parameters
        ----------
        reactions : sequence of Value
            At the end of the period, of the contacts, then of the frictions; none where nothing is located.
        sums : dict (contact, role) -> Value
            What impacts and micro-impulses added up to in the period.
        """
        known = dict(zip((e.force for e in (*self.contacts, *self.frictions)), reactions, strict=True))
        for c in (*self.contacts, *self.hovering):
            for role, adds_up in SUMS.items():
                leaf, amount = getattr(c, role), sums.get((c, role), tracing.tick.const(0.0))
                known[leaf] = reaction_at_sample(leaf, tracing) + amount if adds_up else amount
        for c in self.hovering:
            known[c.force] = sums[c, "impulse"] * (1 / tracing.T)
        for leaf, value in known.items():
            reaction_at_sample(leaf, tracing)
            tracing.set_next(leaf, value)


def reaction_at_sample(expr, tracing):
    """A reaction, or what impacts added up to, as a state that the step before this sample has set."""
    kind = type(expr)
    if kind.role == "rub":
        return tracing.tick.const(0.0)
    channel = Channel(kind.__name__, kind.unit, tracing.real)
    return tracing.state(expr, channel, tracing.init.const(0.0))


class Touching:
    """The located contacts and frictions of one motion, over leaves of its own.

    Parameters
    ----------
    contacts : InstantContacts
    at : callable (tau, q, w, s, unknowns) -> Translator
        What expressions are inside a step; ``unknowns`` are the leaves that stand for reactions.
    constant : callable expression -> Value
        Of parameters alone.
    period : float
        T [s].

    Attributes
    ----------
    unknowns : dict expression -> Value
        The leaf of each reaction, once :meth:`reactions` has made them.
    """

    def __init__(self, contacts, at, constant, period):
        self.of, self.at, self.constant, self.period = contacts, at, constant, period
        self.rubbing = [c for c in contacts.contacts if c.contact_law.mu != 0]
        self.unknowns, self.rubs, self.slips = {}, [], []

    def reactions(self, tau, q, w, s, new):
        """The Reactions of the motion, in the order contacts, then frictions."""
        self.unknowns |= {e.force: new() for e in (*self.of.contacts, *self.of.frictions)}
        self.rubs += [new() for _ in self.rubbing]
        self.unknowns |= {c.rub: rub for c, rub in zip(self.rubbing, self.rubs, strict=True)}
        translate = self.at(tau, q, w, s, self.unknowns)
        self.slips += [translate(c.slip) for c in self.rubbing]
        made = [contact(translate(c.gap), self.unknowns[c.force]) for c in self.of.contacts]
        for f in self.of.frictions:
            made.append(coulomb(new, translate(f.slip), translate(f.coulomb), translate(f.breakaway), self.unknowns[f.force]))
        return made

    def impact(self, motion):
        """The Impacts of the motion, or None where nothing strikes."""
        if not self.of.contacts:
            return None
        k, laws = len(self.of.contacts), []
        for c in self.of.contacts:
            slip = k + self.rubbing.index(c) if c in self.rubbing else None
            speed = c.contact_law.rest_speed
            speed = float("inf") if speed == sp.oo else None if speed is None else self.constant(speed)
            laws.append(Law(c.name, self.constant(c.contact_law.e), speed, slip, self.constant(c.contact_law.mu)))
        return impacts_of(motion, laws, list(range(k)), self.period, self.of.order, self.slips, self.rubs)


def located(elements):
    """Whether any of contacts and frictions has events that a method must locate inside its step."""
    return any(e.is_located for e in elements)


def unfelt(form):
    """Yield a note on each contact with the handle whose impacts move the bodies, and nothing that is felt holds."""
    read = {leaf for e in (form.force, *form.updates.values()) for leaf in e.atoms(sp.Function)}
    for c in (c for model in form.models for c in model.contacts if not isinstance(c, friction)):
        if c.is_located and c.gap.has(x(t)) and c.impulse not in read:
            pulse = f"hl.contact.felt_impulse({c.name}, tau='5 ms') makes them felt"
            yield f"{c.name} acts by impulses, which {c.name}.force does not contain; {pulse}"


def _check_names(elements):
    names = [e.name for e in elements]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice:
        raise SceneError(f"two contacts have the name {twice}; give each a name of its own, name='...'")


def _order(contacts):
    orders = {c.contact_law.impacts for c in contacts if c.contact_law.impacts} or {"simultaneous"}
    if len(orders) > 1:
        named = "; ".join(f"{c.name}: {c.contact_law.impacts}" for c in contacts if c.contact_law.impacts)
        raise SceneError(f"{named}: the impacts of a scene are all sequential, or all simultaneous; choose one order")
    (order,) = orders
    rubbing = [c.name for c in contacts if c.contact_law.mu != 0]
    if rubbing and order == "simultaneous" and len(contacts) > 1:
        raise SceneError(
            f"{rubbing[0]}: friction in impacts at several contacts at once has no unique outcome. Use order='sequential', "
            "or mu = 0"
        )
    return order
