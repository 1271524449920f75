"""Advance a scene by ``method="taylor"``: the series of its motion, events located, the order chosen and the step checked."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ...base.shows_itself import ShowsItself
from ...errors import ProgramError, ProgramLimitError
from ..algebra.polynomial_crossing import FEWER_STEPS, STEPS
from ..ir.program import Channel
from ..ir.trace import Value, select
from .flow import motion_of
from .located_step import Stepper
from .series_checks import (
    MOST_INSTRUCTIONS,
    around,
    check_size,
    check_smooth,
    check_step,
    extremes,
    frequency,
    is_linear,
    live_in,
    numbers,
    order_for,
    within,
)
from .series_error import remainder_for
from .switched_linear import Maps

#: most located events of a step: what touches may leave within it, and something else may happen too
_EVENTS = (2, 3)
#: most radians a period that is followed piece by piece, at some 1500 instructions each
MOST_TURNS = 32
#: instructions of each surface, in each piece, an order of the series: at least, and of all but frictions at most
_LEAST, _MOST = 73, 100


@dataclass(frozen=True)
class Taylor(ShowsItself):
    """Taylor series of the motion over a step, with the instants located at which the equations change.

    Where the motion between events is linear, it is the closed form to rounding; elsewhere its error is that of the
    order. There the last term of the series, of order 6 at least, is compared with the state: a step in which it is
    more than 1e-8 of it (1e-5 in float32) is counted in the output ``unlocated``, if there is one; more than 1e-4 is a
    series that diverges, and makes the state nan: a fault, which more substeps mend.

    Walls, contacts, friction and every other case of the state end the series at the instant where they change. A step
    needs to be a radian of the fastest part at most, and costs as many times one of RK4 as the series has terms. Not to
    be confused with "exact", whose map is a constant; nor with a Taylor expansion at one place, for the series is made
    anew each step. Source: Griewank and Walther, *Evaluating Derivatives*, ch. 13; Jorba and Zou, Experimental
    Mathematics 14 (2005).

    Parameters
    ----------
    order : int, 2..20, optional
        Of the series. Chosen from the fastest part of the motion and the real type, unless given.
    events : int, 1..8, optional
        Most events located in a step; a step of one more is finished without locating, and counted in the output
        ``unlocated``. 2 for one or two surfaces, 3 for more, unless given. Where bodies bounce or rest, the output
        ``overlap`` says how deep they are inside each other at the end of a period. A run that left events out warns.

    Examples
    --------
    >>> from hapticlab.compiler.events.taylor_method import Taylor
    >>> Taylor(order=1)
    Traceback (most recent call last):
    hapticlab.errors.ProgramError: order = 1; needs a whole number in 2..20
    """

    order: int | None = None
    events: int | None = None
    name = "taylor"

    def __post_init__(self) -> None:
        for name, given, low, high in (("order", self.order, 2, 20), ("events", self.events, 1, 8)):
            if given is not None and (type(given) is not int or not low <= given <= high):
                raise ProgramError(f"{name} = {given!r}; needs a whole number in {low}..{high}")


@dataclass(frozen=True)
class Switched(Taylor):
    """``method="exact"`` of a motion that is linear between switches: see :mod:`hapticlab.compiler.events.switched_linear`.

    Parameters
    ----------
    reason, cure : str
        Why it is not one linear system, and what to do where it is not linear in every mode either.
    """

    reason: str = ""
    cure: str = ""
    name = "exact"


@dataclass(frozen=True)
class Advanced:
    """One period of a motion, traced.

    Attributes
    ----------
    groups : (q, w, s)
        The state after it.
    facts : dict
        Order, events, omega, and the part of a state past which the last term of its series makes it nan, for the
        listing.
    unlocated : Value or None
        Steps of this period that left an event out, or whose series had not converged; None where there is no event.
    reactions, gaps : list of Value
        Of the contacts and frictions, and of the contacts alone, at its end.
    sums : dict (role, number of the contact) -> Value
        What impacts added up to.
    """

    groups: tuple
    facts: dict
    unlocated: Value | None
    reactions: list
    gaps: list
    sums: dict


def advance(
    method, tracing, rates, groups, h, substeps, values, name, contacts=None, ranges=(), bound=False,
):  # fmt: skip
    """Trace one period of a motion.

    Parameters
    ----------
    method : Taylor
    tracing : Tracing
    rates : callable ``(tau, q, w, s) -> (a, ds)``
    groups : (q, w, s)
        The state at the sample, lists of values.
    h : float
        Step [s].
    substeps : int
    values : dict name -> float
        Of parameters, for the order and the longest step.
    name : str
        Of the scene, for messages.
    contacts : Touching, optional
        What the motion touches: its reactions, see :func:`~hapticlab.compiler.events.flow.motion_of`, and its impacts,
        see :class:`~hapticlab.compiler.events.located_step.Stepper`.
    ranges : sequence of (low, high), optional
        Declared for each q: where one is finite, a motion that is not linear is looked at within it too.
    bound : bool
        Constraints tie the positions.

    Returns
    -------
    Advanced
    """
    builder, real = tracing.tick, tracing.real
    motion = motion_of(builder, rates, len(groups[0]), len(groups[2]), contacts and contacts.reactions)
    check_smooth(motion, name)
    if isinstance(method, Switched):
        number = numbers(builder.instructions, tracing.at_start(values))
        return switched(method, tracing, motion, groups, h, name, contacts and contacts.impact(motion), number)
    linear = is_linear(motion)

    def fastest(values):
        given = tracing.at_start(values)
        number = numbers(builder.instructions, given)
        start = tuple([number(v.id) for v in part] for part in groups)
        others = () if linear else (*around(start, ranges, bound), *within(ranges, start))
        return frequency(motion, [start, *others], given, linear)

    omega = fastest(values)
    check_step(omega, h * substeps, substeps, name)
    for ends in extremes(live_in(motion, tracing.parameters)):
        check_step(fastest({**values, **ends}), h * substeps, substeps, name, ends)
    order = method.order or order_for(omega * h, real, linear)
    surfaces = len(motion.guards) + len(motion.reactions)
    events = method.events or _EVENTS[surfaces > 2]
    steps = FEWER_STEPS if omega * h <= 0.05 and linear else STEPS
    remainder = remainder_for(order, real, linear)
    impact = contacts and contacts.impact(motion)
    stepper = Stepper(motion, h, order, events, impact, steps=steps, remainder=remainder)
    now, missed = [held_state(tracing, k) for k in range(len(motion.reactions))], None
    for step in range(substeps):  # within a period the handle moves as its hold has it, and jumps at a sample only
        groups, now, left_out = stepper.step(builder.const(step * h), groups, now, jumped=step == 0)
        check_size(motion, builder, name)
        count = select(left_out, builder.const(1.0), 0.0)
        missed = count if missed is None else missed + count
    for k, value in enumerate(now):
        tracing.set_next(("held", k), value)
    reactions, gaps = stepper.end(builder.const(substeps * h), groups, now)
    facts = (
        {"order": order}
        | ({} if motion.smooth else {"events": events})
        | ({"remainder": remainder[1]} if remainder else {})
        | ({"omega": float(f"{omega:.4g}")} if omega > 0 else {})
    )
    return Advanced(groups, facts, None if motion.smooth else missed, reactions, gaps, impact.sums if impact else {})


def held_state(tracing, k):
    """Whether reaction k is held: sticking, or at rest; a motion starts free."""
    return tracing.state(("held", k), Channel(f"held({k})", "1", "bool"), tracing.init.const(False))


def switched(method, tracing, motion, groups, h, name, impact, number):
    """Trace one period of a motion that is linear between switches; see :func:`advance`."""
    start = [number(value.id) for part in groups for value in part]
    maps = Maps(motion, h, (method.reason, method.cure), tracing.parameters, start, number)
    turns, surfaces = maps.omega * h, len(motion.guards) + len(motion.reactions)
    if turns > MOST_TURNS:
        raise ProgramLimitError(
            f"{name}: its fastest part turns with omega = {maps.omega:.4g} rad/s, by {turns:.4g} rad in a period of {h:g} s; "
            f"method='exact' locates switches in pieces of a radian, {MOST_TURNS} at most. Use T <= "
            f"{MOST_TURNS / maps.omega:.2g} s, a softer contact, or one that does not yield (hl.contact.impulse, "
            "hl.contact.rigid)"
        )
    _check_pieces(name, surfaces, turns, h, tracing.real)
    order, events, pieces = _pieces(surfaces, turns, tracing.real)
    stepper = Stepper(motion, h, order, events, impact, longest=maps.longest, pieces=pieces)
    held = [held_state(tracing, k) for k in range(len(motion.reactions))]
    groups, held, missed = maps.step(stepper, groups, held)
    check_size(motion, tracing.tick, name, method.name)
    for k, value in enumerate(held):
        tracing.set_next(("held", k), value)
    reactions, gaps = stepper.end(tracing.tick.const(h), groups, held)
    facts = {"maps": len(maps.modes), "order": stepper.order, "events": events, "pieces": stepper.pieces}
    facts |= {"omega": float(f"{maps.omega:.4g}")} if turns else {}
    return Advanced(groups, facts, missed, reactions, gaps, impact.sums if impact else {})


def _pieces(surfaces, turns, real):
    """(order, events, pieces) of a period that turns by so many radians; the events of one contact each half turn."""
    events = _EVENTS[surfaces > 2] + int(2 * turns / math.pi)
    return order_for(min(turns, 1.0) / 2, real, True), events, events + max(1, math.ceil(turns))


def _check_pieces(name, surfaces, turns, h, real):
    """Refuse surfaces and pieces that are past the size of a program, before any of them is traced."""

    def size(surfaces, turns, each):
        order, _, pieces = _pieces(surfaces, turns, real)
        return each * surfaces * order * pieces

    least = size(surfaces, turns, _LEAST)
    if least <= MOST_INSTRUCTIONS:
        return
    shorter = next((k for k in range(2, 1000) if size(surfaces, turns / k, _MOST) <= MOST_INSTRUCTIONS), None)
    fewer = next(count for count in range(surfaces, -1, -1) if size(count, turns, _MOST) <= MOST_INSTRUCTIONS)
    cures = [f"T <= {h / shorter:.2g} s"] * bool(shorter) + [f"{fewer} surfaces at most"] * bool(fewer) + ["a softer contact"]
    raise ProgramLimitError(
        f"{name}: method='exact' locates switches at {surfaces} surfaces (cases, Max, Min, contacts, frictions) in "
        f"{_pieces(surfaces, turns, real)[2]} pieces of a period of {h:g} s, which is {least} instructions or more, and a "
        f"program has {MOST_INSTRUCTIONS} at most. Use {', '.join(cures[:-1])} or {cures[-1]}"
    )
