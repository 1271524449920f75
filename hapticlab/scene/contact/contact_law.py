"""A contact law: the record that a contact, its checks and the compiler read, and how its constants are taken.

A law is one class of ``penalty_laws`` or ``contact_laws``, a frozen dataclass below :class:`ContactLaw`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from typing import Any, ClassVar

import sympy as sp

from ...base.units import dimension, quantity
from ...errors import SceneError, UnitsError
from ..notation.amount import Amount
from ..notation.checks import agree_with
from ..notation.units import dimension_of
from ..notation.written import expression

#: what a gap is measured in -> units of force, stiffness, damping and speed
_OF_GAP = {
    dimension("m"): ("N", "N/m", "N*s/m", "m/s"),
    (): ("N*m", "N*m/rad", "N*m*s/rad", "rad/s"),
}


@dataclass(frozen=True)
class Allowed:
    """Range of a constant of a law, and the reason for it; ``above`` leaves its lowest value out."""

    low: float
    high: float
    why: str
    above: bool = False


#: of stiffness and damping, of friction, of restitution
PASSIVE = Allowed(0.0, math.inf, "a negative one is not passive")
OPPOSING = Allowed(0.0, math.inf, "friction opposes the slip")
RESTITUTION = Allowed(
    0.0, 1.0, "above 1 every bounce would supply energy to the user, and below 0 the bodies would pass through each other"
)


class ContactLaw:
    """Base of the contact laws; a law says when it acts and which values its constants may have.

    A law with ``is_force`` is an expression: it has ``force(gap, rate)``, ``stored(gap)``, a stiffness ``k`` and
    ``duration(k, mass, speed)``. A law with ``is_located`` acts by impulses and reactions at instants that the method
    locates inside its step: it has ``e``, ``mu``, ``rest_speed`` and ``order``. A law with neither acts by the impulses
    of ``micro_impulse``, at the end of each step.
    """

    is_force = False
    is_located = False
    #: the duration of a contact depends on the speed of its approach
    speed_matters = False
    #: constant -> Allowed, at the values bound and at all that live parameters may be set to
    allowed: ClassVar[dict[str, Allowed]] = {}

    def check(self, gap: sp.Expr, where: str) -> None:
        """Refuse constants whose units do not belong to the gap: each law knows its own."""
        raise NotImplementedError


def law_names(chosen=lambda law: True):
    """Names of the laws that are chosen, as a sentence has them: "penalty, hunt_crossley or rigid"."""
    laws = sorted(ContactLaw.__subclasses__(), key=lambda law: not law.is_force)
    *first, last = [law.__name__ for law in laws if chosen(law)]
    return f"{', '.join(first)} or {last}" if first else last


def written_out(law: Any) -> str:
    """A law, contact or friction as it is written, its numbers in few digits."""
    values = {f.name: getattr(law, f.name) for f in fields(law)}
    text = {k: sp.sstr(value, full_prec=False) if isinstance(value, sp.Basic) else repr(value) for k, value in values.items()}
    return f"{type(law).__name__}({', '.join(f'{name}={value}' for name, value in text.items())})"


def gap_units(gap, where):
    """Units of force, stiffness, damping and speed that belong to a gap in m, or in rad."""
    units = _OF_GAP.get(dimension_of(gap, where))
    if units is None:
        raise SceneError(f"{where}: {gap} is neither a length nor an angle; a gap is a distance in m or an angle in rad")
    return units


def take(law, **words):
    """Keep the constants of a law as expressions; refuse a negative number."""
    for name, word in words.items():
        expr = constant(getattr(law, name), name)
        if expr.is_negative:
            fed = "friction opposes the slip" if name == "mu" else "a negative one is not passive"
            raise SceneError(f"{name} = {shown(expr)}; a contact needs a {word} {name} >= 0: {fed}")
        object.__setattr__(law, name, expr)


def constant(given, where):
    """A constant of a law, from an expression or a text with a unit such as '1000 N/m'."""
    if not isinstance(given, str):
        return expression(given, where)
    number, unit = quantity(given, where)
    return Amount(number, unit) if number else sp.S.Zero


def check_constant(expr, unit, where):
    """Refuse a constant of another unit; of a bare number, say how it gets one."""
    if expr.is_number and expr != 0 and unit != "1":
        name = where.rpartition(", ")[2]
        raise UnitsError(
            f"{where} = {shown(expr)} has no unit; needs {unit}: '{shown(expr)} {unit}', or "
            f"hl.parameters('{name}', units='{unit}', values={shown(expr)})"
        )
    agree_with(expr, unit, where)


def shown(number):
    """A number as a message has it."""
    return f"{float(number):g}" if sp.sympify(number).is_real else str(number)
