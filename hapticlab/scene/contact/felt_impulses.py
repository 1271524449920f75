"""Impulses that are felt: an impact at the handle rendered as a force over a time, its impulse kept."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import sympy as sp

from ...base.shows_itself import ShowsItself
from ...base.units import in_si
from ...errors import SceneError
from ..notation.amount import amount
from ..notation.cases import when
from ..notation.derivative import Partial
from ..notation.symbols import T, n, signal, t, x
from .contact import Contact

if TYPE_CHECKING:
    from ...base.annotations import Number, Term


@dataclass(frozen=True)
class FeltImpulse(ShowsItself):
    """A force for a scene, the difference equations it needs, and what is worth watching.

    Attributes
    ----------
    force : expression [N]
        On the environment, positive into it, as :class:`~hapticlab.scene.scene.Scene` takes it.
    equations : tuple of sympy.Eq
        For ``eom``.
    watch : dict
        ``saturates``: 1 where the pulse passes F_max; empty without one.
    """

    force: sp.Expr
    equations: tuple
    watch: dict

    def __str__(self) -> str:
        return f"the force of a felt impulse, with {len(self.equations)} difference equations"


def felt_impulse(contact: Contact, *, tau: Term, F_max: Term | None = None) -> FeltImpulse:
    """Render the impacts of a contact that holds the handle: each impulse p as the pulse p s/tau^2 exp(-s/tau).

    The pulse starts at zero, peaks at p/(e tau) a time tau after the impact, and its integral is p: what the body loses
    the hand gets. It is linear, so that impacts that follow each other add up. Rendered in one period instead, 0.09 N s (50 g
    at 1 m/s, e = 0.8) would take 90 N. Each sample carries the mean of the pulse over its period, so that the held force
    of the motor has the impulse p to rounding, whatever tau/T is; it starts with the first sample after the impact.
    The reaction of a contact at rest is part of the force, too.

    The impact itself sees a handle that no impulse turns round, while a handle of mass M takes p^2/(2 M) from the pulse: 5 mJ
    of 0.05 N s at 0.25 kg, which the scene does not lose. Where that matters, let the body strike a plate with a mass of its
    own, tied to the handle by a virtual coupler.

    Parameters
    ----------
    contact : Contact
        With an event law, its gap holding x(t).
    tau : Parameter or expression [s], or text such as "4 ms"
        Time of the peak; at least one period. :func:`pulse_time` finds it from a largest force.
    F_max : Parameter or expression [N], or text such as "5 N", optional
        Largest force of the device; adds the watched channel ``<contact>_saturates``, since a pulse that is clipped loses
        part of its impulse.

    Returns
    -------
    FeltImpulse

    Examples
    --------
    >>> import hapticlab as hl
    >>> from hapticlab import t, x
    >>> q = hl.coordinate("q", unit="m", initial=x(hl.n))
    >>> ball = hl.contact.Contact(q - x(t), hl.contact.impulse(e=0.8), name="ball")
    >>> felt = hl.contact.felt_impulse(ball, tau="4 ms", F_max="5 N")
    >>> [str(e.lhs) for e in felt.equations], list(felt.watch)
    (['ball_rise(n)', 'ball_pulse(n)'], ['ball_saturates'])
    """
    if not isinstance(contact, Contact) or contact.is_force:
        raise SceneError(f"{contact!r}: only an impact needs a pulse. To feel a force law, use -contact.generalized_force(x(t))")
    if not contact.gap.has(x(t)):
        raise SceneError(
            f"{contact.name}: its gap = {contact.gap} does not contain x(t), so the handle feels nothing of "
            "it. Write a gap with x(t)"
        )
    tau = amount(tau, "s", f"{contact.name}: tau")
    if tau == 0 or tau.is_negative:
        raise SceneError(f"{contact.name}: tau = {tau} s; the impulse is felt over this time, which needs to be > 0 s")
    name = contact.name
    unit = contact.unit
    rise = signal(f"{name}_rise", unit=unit)
    pulse = signal(f"{name}_pulse", unit=unit)
    # over one period: s' = -s/tau, F' = (s - F)/tau, each impulse p adding p/tau to s
    decay = sp.exp(-T / tau)
    rising = sp.Eq(rise(n), decay * rise(n - 1) + contact.impulse / tau)
    pulsing = sp.Eq(pulse(n), decay * (pulse(n - 1) + rise(n - 1) * T / tau))
    mean = pulse(n) * tau / T * (1 - decay) + rise(n) * (tau / T * (1 - decay) - decay)
    force = -Partial(contact.gap, x(t)) * (mean + contact.force)
    watch = {}
    if F_max is not None:
        limit = amount(F_max, contact.unit, f"{name}: F_max")
        watch[f"{name}_saturates"] = when(sp.Abs(force) > limit, 1)
    return FeltImpulse(force, (rising, pulsing), watch)


def pulse_time(*, impulse: Number, F_max: Number) -> float:
    """The tau [s] with which an impulse peaks at F_max: p/(e F_max).

    Parameters
    ----------
    impulse : float [N s] or text
        The largest to be felt: (1 + e) m u of a body m on a handle that is held.
    F_max : float [N] or text

    Examples
    --------
    >>> import hapticlab as hl
    >>> round(hl.contact.pulse_time(impulse=0.09, F_max="5 N"), 6)
    0.006622
    """
    p, limit = in_si(impulse, "N*s", "impulse"), in_si(F_max, "N", "F_max")
    if not (0 < p < math.inf and 0 < limit < math.inf):
        raise SceneError(f"impulse = {p:g} N s and F_max = {limit:g} N; both need to be > 0")
    return p / (math.e * limit)
