"""The program of a scene that moves: the sample, the force, the outputs, and one period of its equations of motion."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import sympy as sp

from ...errors import SceneError
from ...scene.explicit import ExplicitForm
from ..algebra.expressions import Translator
from ..contacts.constant_checks import bounded, limits
from ..contacts.contact_starts import check_starts
from ..contacts.contact_steps import check_contacts, limited
from ..contacts.coordinate_bounds import guarded, notes_of
from ..contacts.scene_contacts import InstantContacts, reaction_at_sample, unfelt
from ..events.taylor_method import Taylor
from ..ir.channels import channel_of
from ..ir.program import Channel
from ..methods.exact_linear import Exact, exact_or_switched
from ..methods.force_timing import IMPULSE, hints
from ..methods.method_checks import check_suited
from ..methods.method_table import Method
from ..prune.constraint_lengths import notes_on
from ..prune.excluded_modes import within
from ..prune.mass_matrix import start_of
from .dynamics import Dynamics, Equations, Moment, Period, one_period
from .leaf_values import Tick, at_sample, at_start, outputs_at_sample, real, tick_of, unknown_reaction
from .live_limits import kept_stable
from .live_stability import SteppedMotion


@dataclass(frozen=True)
class Moving:
    """A scene that moves, checked and ready to be traced.

    Attributes
    ----------
    form : ExplicitForm
        Its equations of motion but for those that are advanced exactly.
    tick : Tick
    start, sample : Translator
        What expressions are at the first sample, and at sample n.
    dynamics : Dynamics
    method : Method or Taylor
    exact : Exact or None
        What is advanced exactly.
    state_at_sample : callable state -> Value
    settable : dict name -> (low, high)
        What the constants of contacts leave of live parameters.
    largest : dict contact -> float
        The stiffness with which it lasts just ten steps.
    """

    form: ExplicitForm
    tick: Tick
    start: Translator
    sample: Translator
    dynamics: Dynamics
    method: Method | Taylor
    exact: Exact | None
    state_at_sample: Callable
    settable: dict
    largest: dict


def moving_scene(source, handle=None):
    """The :class:`Moving` of a :class:`Source`; ``handle`` as of :func:`motion_program`."""
    scene, form, options, tick = source.scene, source.form, source.options, tick_of(source, handle)
    tracing, h = tick.tracing, options.T / options.substeps
    elements = [c for model in form.models for c in model.contacts]
    settable = limits(form, scene.values, source.fixed, options.T) if elements else {}
    start, exact, method = at_start(tick), None, options.method.rest
    if options.method.exact:
        exact, method = exact_or_switched(scene, form, tick, start, method)
        form = exact.others if exact else form
    equations, contacts = Equations(form, scene, tick, method, h), InstantContacts(elements) if elements else None

    def state_at_sample(leaf):
        if leaf == IMPULSE:
            return tracing.tick.const(0.0)
        return tracing.state(leaf, channel_of(leaf, tracing.real), start(start_of(leaf)))

    sample = at_sample(tick, start, bodies_at_sample(form, equations, contacts, exact, tracing, state_at_sample))
    # a contact that hovers has no reaction inside a step
    still = {c.force: tracing.tick.const(0.0) for c in contacts.hovering} if contacts else {}
    dynamics = Dynamics(tick, sample, equations, contacts, exact.at_sample if exact else lambda tau: {}, still)
    largest = _check(form, scene.values, source.graph, contacts, method, h, options.T, exact) if form.coordinates else {}
    return Moving(form, tick, start, sample, dynamics, method, exact, state_at_sample, settable, largest)


def _check(form, values, graph, contacts, method, h, T, exact):
    """Refuse what a method cannot do with a motion; contact -> the stiffness with which it lasts just ten steps."""
    if contacts:
        contacts.check(method)
    if not isinstance(method, Taylor) and (method.steps > 1 or method.order_with_velocity):
        check_suited(method, form, graph, exact is not None)
    if not contacts:
        return {}
    check_starts(form, values)
    return check_contacts(form, values, h, T, method)


def bodies_at_sample(form, equations, contacts, exact, tracing, state_at_sample):
    """What a coordinate, a rate or a reaction is at the sample: a function (leaf, translate) -> Value."""
    instant = []  # the one at the sample, once a constraint is asked for it

    def moving(leaf, sample):
        kind = type(leaf)
        if exact and leaf in exact.states:
            return exact.state(leaf)
        if leaf in equations.states:
            return state_at_sample(leaf)
        if hasattr(kind, "contact"):
            return reaction_at_sample(leaf, tracing) if contacts and contacts.knows(leaf) else unknown_reaction(leaf)
        if equations.enforced and not instant:
            instant.append(Moment(sample, equations.enforced.instant(sample)))
        if hasattr(kind, "constraint"):
            return equations.reaction(leaf, *instant) if instant else unknown_reaction(leaf)
        value = instant[0].follows.leaf(leaf) if instant else None
        if value is not None:
            return value
        q, order = (leaf.expr, leaf.derivative_count) if isinstance(leaf, sp.Derivative) else (leaf, 0)
        if order >= form.orders[form.coordinates.index(q)]:
            raise SceneError(
                f"the equations of motion are solved for {leaf}; the force and the watched expressions may use "
                f"{type(q).__name__} and lower derivatives"
            )
        return state_at_sample(leaf)

    return moving


def motion_program(source, ranges, handle=None):
    """The program of a scene with coordinates.

    Parameters
    ----------
    source : Source
    ranges : dict coordinate -> (low, high)
        Outside of them the force is no number, since something was decided over them.
    handle : callable tracing -> Handle, optional
        In place of the handle that the options describe.
    """
    scene, options = source.scene, source.options
    suits = tuple(hints(source.form, source.graph, options))
    moving = moving_scene(source, handle)
    tick, exact, equations = moving.tick, moving.exact, moving.dynamics.equations
    outputs, period = _traced(moving, scene, options.force_at, options.substeps, ranges)
    outputs, ranges = _within_ranges(outputs, moving, scene, ranges)
    facts = {name: getattr(options, name) for name in ("method", "substeps", "hold", "velocity", "dtype")}
    facts |= {"method": str(options.method)} | ({"force_at": options.force_at} if options.force_at != "before" else {})
    unused = [*tick.signals.unused, *(exact.left_out if exact else ())]
    program = tick.tracing.finish(scene.name, outputs, scene.values, facts | equations.facts(scene) | period.facts, unused)
    program = bounded(limited(program, moving.largest), moving.settable) if moving.largest or moving.settable else program
    program = kept_stable(program, _stepped(moving, period), moving.form, source.graph) if period.first else program
    tick.check_values(program)
    notes = [*(exact.notes if exact else ()), *equations.notes]
    notes += [*(unfelt(moving.form) if moving.dynamics.contacts else ()), *period.notes, *suits]
    notes += [*(notes_on(scene, source.fixed) if equations.enforced else ()), *(notes_of(ranges) if ranges else ())]
    return replace(program, notes=(*program.notes, *notes))


def _traced(moving, scene, force_at, substeps, ranges):
    """(the outputs as (Channel, Value), the force first; the :class:`Period`): the tick in the order it runs."""
    tick, dynamics, tracing = moving.tick, moving.dynamics, moving.tick.tracing
    force, watched = outputs_at_sample(scene, moving.form, tracing, moving.sample, force_at == "before")
    moved, period = {}, Period()
    if moving.exact:
        exactly = moving.exact.period(tick, moving.sample)
        _set_next(tracing, dict(zip(moving.exact.keys, exactly.moved(tracing.T), strict=True)))
        moved, dynamics = exactly.at(tracing.T), replace(dynamics, exact=exactly.at)
    if states := dynamics.equations.states:
        start = dynamics.equations.grouped([moving.state_at_sample(state) for state in states])
        period = one_period(dynamics, moving.method, substeps, start, scene.name, moving.start)
        now = dict(zip(states, [value for part in period.state for value in part], strict=True))
        moved = moved | now
        _set_next(tracing, now)
    force = real(scene, tracing, dynamics.at_the_end(moved)(moving.form.force) if force is None else force)
    outputs = [(Channel("F", "N", tracing.real), within(force, ranges, moving.sample)), *watched]
    if period.unlocated is not None:
        outputs.append((Channel("unlocated", "1", tracing.real), period.unlocated))
    if period.overlap is not None:
        outputs.append(period.overlap)
    tracing.complete()
    return outputs, period


def _set_next(tracing, values):
    for state, value in values.items():
        if state != IMPULSE:  # it starts anew at each sample
            tracing.set_next(state, value)


def _within_ranges(outputs, moving, scene, ranges):
    """(outputs, ranges), the force guarded by what the coordinates declare that the program keeps."""
    tracing, enforced, exact = moving.tick.tracing, moving.dynamics.equations.enforced, moving.exact
    kept = tracing.observed([value for _, value in outputs])
    tied = enforced.coordinates if enforced and kept & {*enforced.second, *enforced.first} else ()
    moved = exact.states if exact and kept & set(exact.keys) else ()
    (channel, force), *others = outputs
    held = {*kept, *tied, *moved}
    declared = [q for q in scene.coordinates if q in held and any(map(math.isfinite, (type(q).low, type(q).high)))]
    if declared or ranges:
        force, ranges = guarded(force, declared, ranges, scene.values, moving.sample)
        tracing.complete()
    return [(channel, force), *others], ranges


def _stepped(moving, period):
    dynamics, equations = moving.dynamics, moving.dynamics.equations

    def damped(step):
        return dynamics.rates(0.0, *period.first[0], damped=step)

    return SteppedMotion(
        moving.tick.tracing, equations.values, moving.method, equations.h, equations.second, period.start, *period.first,
        damped, bool(equations.enforced),
    )  # fmt: skip
