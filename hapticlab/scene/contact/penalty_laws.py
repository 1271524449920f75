"""Contact laws that are forces over a time: the penalty spring and damper, and Hunt and Crossley's; chapter section 23.5.2."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, ClassVar

import sympy as sp

from ...base.shows_itself import ShowsItself
from ...errors import SceneError
from ..notation.checks import agree_with
from ..notation.units import fixed
from ..notation.written import expression
from .contact_law import PASSIVE, ContactLaw, check_constant, gap_units, take, written_out

#: exponent of two spheres, or a sphere on a plane
HERTZ = sp.Rational(3, 2)


@dataclass(frozen=True, kw_only=True)
class penalty(ShowsItself, ContactLaw):
    """Penalty contact: a spring and a damper act on the penetration, and never pull.

    N = max(0, k d - b dgap/dt) where the gap is closed, with the penetration d = -gap. With b > 0 the force jumps at
    touch, which costs an explicit method its order; :class:`hunt_crossley` has no jump. A contact lasts
    pi sqrt(m/k) with the effective mass m; explicit methods need ten steps in that time.

    Parameters
    ----------
    k : Parameter, expression or text with a unit [N/m], >= 0
    b : Parameter, expression or text with a unit [N s/m], >= 0

    Examples
    --------
    >>> import hapticlab as hl
    >>> k = hl.parameters("k", units="N/m")
    >>> hl.contact.penalty(k=k)
    penalty(k=k, b=0)
    """

    k: Any
    b: Any = 0

    is_force = True
    allowed: ClassVar = {"k": PASSIVE, "b": PASSIVE}
    __repr__ = written_out

    def __post_init__(self) -> None:
        take(self, k="stiffness", b="damping")

    def check(self, gap: sp.Expr, where: str) -> None:
        """Refuse constants whose units do not belong to the gap.

        Parameters
        ----------
        gap : expression
            The gap of the contact [m] or [rad].
        where : str
            Name of the contact, for the message.
        """
        _, stiffness, damping, _ = gap_units(gap, where)
        check_constant(self.k, stiffness, f"{where}, k")
        check_constant(self.b, damping, f"{where}, b")

    def force(self, gap: sp.Expr, rate: sp.Expr) -> sp.Expr:
        """Normal force of a gap, <= 0, that changes at a rate.

        Parameters
        ----------
        gap : expression
            [m], negative in overlap.
        rate : expression
            Rate of the gap [m/s], negative while the bodies approach.
        """
        # a spring alone never pulls while the gap is closed, and a case less is half the work of method="taylor"
        return sp.Max(0, -self.k * gap - self.b * rate) if self.b != 0 else -self.k * gap

    def stored(self, gap: sp.Expr) -> sp.Expr:
        """Energy in the spring.

        Parameters
        ----------
        gap : expression
            [m], negative in overlap.
        """
        return self.k * sp.Max(0, -gap) ** 2 / 2

    @staticmethod
    def duration(k: float, mass: float, speed: Any = None) -> Any:
        """Duration of a contact [s]: half a period, pi sqrt(m/k), whatever the speed.

        ``mass`` is the effective one of the contact, 1/W. A damper below critical makes it somewhat longer or shorter.

        Parameters
        ----------
        k : float
            Stiffness [N/m], > 0.
        mass : float
            Effective mass of the contact [kg], > 0.
        speed : float, optional
            Not used: the duration of a linear contact does not depend on it.
        """
        return math.pi * math.sqrt(mass / k)


@dataclass(frozen=True, kw_only=True)
class hunt_crossley(ShowsItself, ContactLaw):
    """Hunt-Crossley contact: N = k d^n (1 + c dd/dt), never pulling, with the penetration d = -gap.

    Hunt and Crossley, *Coefficient of restitution interpreted as damping in vibroimpact*, J. Appl. Mech. 42 (1975)
    440-445: their lambda = 3/2 alpha k is k c here, and their restitution e = 1 - alpha v is e = 1 - 2/3 c v to first
    order in the approach speed v, for every mass, stiffness and exponent. :meth:`restitution` is exact. The force starts
    and ends at zero, unlike that of a damper, and the energy lost grows as v cubed. Hertz: n = 3/2 for spheres.

    Parameters
    ----------
    k : Parameter, expression or text with a unit [N/m^n], >= 0
    c : Parameter, expression or text with a unit [s/m], >= 0
    exponent : fraction
        n >= 1; 3/2 unless given. With a whole n the force is a polynomial in d.

    Examples
    --------
    >>> import hapticlab as hl
    >>> k, c = hl.parameters("k c", units="N/m^1.5 s/m")
    >>> hl.contact.hunt_crossley(k=k, c=c)
    hunt_crossley(k=k, c=c, exponent=3/2)
    """

    k: Any
    c: Any
    exponent: sp.Rational = HERTZ

    is_force = speed_matters = True
    allowed: ClassVar = {"k": PASSIVE, "c": PASSIVE}
    __repr__ = written_out

    def __post_init__(self) -> None:
        take(self, k="stiffness", c="damping factor")
        exponent = fixed(expression(self.exponent, "exponent"))
        if not (exponent.is_Rational and exponent >= 1):
            raise SceneError(f"exponent = {self.exponent}; needs a fraction n >= 1, such as 3/2 for spheres (Hertz)")
        object.__setattr__(self, "exponent", exponent)

    def check(self, gap: sp.Expr, where: str) -> None:
        """Refuse constants whose units do not belong to the gap.

        Parameters
        ----------
        gap : expression
            The gap of the contact [m] or [rad].
        where : str
            Name of the contact, for the message.
        """
        force, _, _, speed = gap_units(gap, where)
        if self.k.is_number:
            check_constant(self.k, f"{force}/{speed.removesuffix('/s')}^{float(self.exponent):g}", f"{where}, k")
        if self.c.is_number:
            check_constant(self.c, f"s/{speed.removesuffix('/s')}", f"{where}, c")
        agree_with(self.k * gap**self.exponent, force, f"{where}, k gap^{self.exponent}")
        agree_with(1 / self.c if self.c != 0 else 0, speed, f"{where}, 1/c")

    def force(self, gap: sp.Expr, rate: sp.Expr) -> sp.Expr:
        """Normal force of a gap that changes at a rate.

        Parameters
        ----------
        gap : expression
            [m], negative in overlap.
        rate : expression
            Rate of the gap [m/s], negative while the bodies approach.
        """
        # the factor alone is held at zero: where it is negative the contact would pull
        return self.k * sp.Max(0, -gap) ** self.exponent * sp.Max(0, 1 - self.c * rate)

    def duration(self, k: float, mass: float, speed: float) -> Any:
        """Duration of an undamped contact at a speed [s]: 2 d/v int_0^1 dx/sqrt(1 - x^(n+1)), deepest at d.

        For n = 3/2, 2.943 d/v (Hertz; Johnson, *Contact Mechanics*, 1985, section 11.4): the faster the shorter.

        Parameters
        ----------
        k : float
            Stiffness [N/m^n], > 0.
        mass : float
            Effective mass of the contact [kg], > 0.
        speed : float
            Speed of approach [m/s], > 0.

        Examples
        --------
        >>> import hapticlab as hl
        >>> k_h, c = hl.parameters("k_h c", units="N/m^1.5 s/m")
        >>> round(hl.contact.hunt_crossley(k=k_h, c=c).duration(1e6, 0.05, 1.0) * 1e3, 4)
        3.8653
        """
        power = float(self.exponent) + 1
        deepest = (power * mass * speed**2 / (2 * k)) ** (1 / power)
        whole = math.sqrt(math.pi) / power * math.gamma(1 / power) / math.gamma(1 / power + 0.5)
        return 2 * whole * deepest / speed

    def stored(self, gap: sp.Expr) -> sp.Expr:
        """Energy in the spring.

        Parameters
        ----------
        gap : expression
            [m], negative in overlap.
        """
        return self.k * sp.Max(0, -gap) ** (self.exponent + 1) / (self.exponent + 1)

    @staticmethod
    def restitution(cv: Any) -> Any:
        """Restitution e for c times the approach speed v, exact: with y = c e v, y + ln(1 - y) = ln(1 + c v) - c v.

        From m v dv/dd = -k d^n (1 + c v), which separates: the energy of the entry and of the exit reach the same
        depth. Mass, stiffness and exponent cancel.

        Parameters
        ----------
        cv : float or array
            c times the speed of approach, without unit, >= 0.

        Examples
        --------
        >>> import hapticlab as hl
        >>> round(hl.contact.hunt_crossley.restitution(0.3), 9)
        0.832869792
        """
        if cv < 1e-4:  # where the two sides cancel, their series
            return 1.0 - 2.0 / 3.0 * cv + 4.0 / 9.0 * cv**2
        target = math.log1p(cv) - cv
        y = cv / (1.0 + cv)
        for _ in range(60):
            y -= (y + math.log1p(-y) - target) * (1.0 - y) / -y
            y = min(max(y, 1e-16), 1.0 - 1e-16)
        return y / cv
