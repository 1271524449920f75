"""Contact laws that act in an instant, or as the reaction that keeps a gap closed; chapter section 23.5.2."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, ClassVar

import sympy as sp

from ...base.arguments import choice
from ...base.shows_itself import ShowsItself
from ...errors import SceneError
from ..notation.amount import amount
from ..notation.checks import agree_with
from ..notation.symbols import Parameter
from ..notation.units import agree
from ..notation.written import expression
from .contact_law import OPPOSING, RESTITUTION, Allowed, ContactLaw, shown, take, written_out

ORDERS = ("sequential", "simultaneous")


@dataclass(frozen=True, kw_only=True)
class impulse(ShowsItself, ContactLaw):
    """Impact with restitution: in the instant of touch, u+ = -e u- for the rates u of the gap (Newton).

    For one frictionless contact Newton's law and Poisson's (release impulse = e times compression impulse) agree. For
    several at once the data do not settle the outcome, so it is named (Brach, *Mechanical Impact Dynamics*, 1991;
    Chatterjee and Ruina, J. Appl. Mech. 65 (1998) 939-951):

    ``"sequential"``
        One after the other, each with its own restitution, until none approaches: Newton's cradle.
    ``"simultaneous"``
        All at once: impulses p >= 0 with u+ >= -e u- and p > 0 only where equal, a linear complementarity problem: a
        stack that is struck, wedges. The order of the contacts does not matter.

    Parameters
    ----------
    e : number, Parameter or expression, within 0..1
        Coefficient of restitution. A Parameter declares that range: ``ranges=(0, 1)``.
    rest_speed : number [m/s], text such as "5 mm/s", Parameter, or None
        A rebound slower than this does not fly: the contact rests, held by its reaction, until that would have to pull.
        It bounds the events of a period, which without it have no end (Zeno): it must be at least a T/2, a the
        acceleration that closes the gap. None: exactly the rebounds that would be back within a period rest.
    impacts : {"sequential", "simultaneous"}
    mu : number, Parameter or expression, >= 0
        Friction: the tangential impulse opposes the slip, at most mu times the normal one. Needs the contact's
        ``slip``.

    Examples
    --------
    >>> import hapticlab as hl
    >>> hl.contact.impulse(e=1.3)
    Traceback (most recent call last):
    hapticlab.errors.SceneError: e = 1.3; restitution lies in 0..1: above 1 every bounce would supply energy to the user
    """

    e: Any
    rest_speed: Any = None
    impacts: str = "sequential"
    mu: Any = 0

    is_located = True
    allowed: ClassVar = {
        "e": RESTITUTION,
        "mu": OPPOSING,
        "rest_speed": Allowed(0.0, math.inf, "the speed below which a contact comes to rest needs to be > 0", above=True),
    }
    __repr__ = written_out

    def __post_init__(self) -> None:
        _take_restitution(self)
        take(self, mu="friction coefficient")
        choice(
            "impacts",
            self.impacts,
            ORDERS,
            need="'sequential' (one after the other) or 'simultaneous' (at once)",
            error=SceneError,
        )
        if self.rest_speed is not None:
            speed = _positive(self.rest_speed, "rest_speed", "m/s", "the speed below which a contact rests")
            object.__setattr__(self, "rest_speed", speed)

    def check(self, gap: sp.Expr, where: str) -> None:
        """Refuse constants with a unit of their own.

        Parameters
        ----------
        gap : expression
            The gap of the contact [m] or [rad].
        where : str
            Name of the contact, for the message.
        """
        agree_with(self.e, "1", f"{where}, e")
        agree_with(self.mu, "1", f"{where}, mu")


@dataclass(frozen=True, kw_only=True)
class micro_impulse(ShowsItself, ContactLaw):
    """Repeated impulses at the end of each step, for lasting contact too.

    Mirtich and Canny, *Impulse-based simulation of rigid bodies*, Symp. Interactive 3D Graphics (1995) 181-188: no
    constraint and no mode; a body at rest is held by a train of tiny collisions. A fast approach rebounds with e. A
    slow one, which gravity alone could have given in one step, rebounds as it came, more the deeper it lies in the
    envelope, so that it hovers there. Nothing is located: positions are right to the order of the step, and the gap is
    negative by at most the approach of one step.

    Parameters
    ----------
    e : number, Parameter or expression, within 0..1
    envelope : number [m], text such as "0.1 mm", or Parameter, > 0
        Distance at which bodies count as in contact.

    Examples
    --------
    >>> import hapticlab as hl
    >>> e = hl.parameters("e", units="1", values=0.5, ranges=(0, 1))
    >>> hl.contact.micro_impulse(e=e, envelope="0.1 mm").e
    e
    """

    e: Any
    envelope: Any = "0.1 mm"

    allowed: ClassVar = {
        "e": RESTITUTION,
        "envelope": Allowed(0.0, math.inf, "the distance at which bodies are regarded as in contact needs to be > 0", above=True),
    }
    __repr__ = written_out

    def __post_init__(self) -> None:
        _take_restitution(self)
        length = _positive(self.envelope, "envelope", "m", "the distance at which bodies are regarded as in contact")
        object.__setattr__(self, "envelope", length)

    def check(self, gap: sp.Expr, where: str) -> None:
        """Refuse constants with a unit of their own.

        Parameters
        ----------
        gap : expression
            The gap of the contact [m] or [rad].
        where : str
            Name of the contact, for the message.
        """
        agree_with(self.e, "1", f"{where}, e")
        agree([self.envelope, gap], f"{where}, envelope")


@dataclass(frozen=True, kw_only=True)
class rigid(ShowsItself, ContactLaw):
    """Rigid contact without rebound: the reaction keeps the gap closed while it pushes, and ends when it would pull.

    The reactions solve the linear complementarity problem 0 <= N, 0 <= d2gap/dt2, N d2gap/dt2 = 0 (Baraff, *Fast
    contact force computation for nonpenetrating rigid bodies*, SIGGRAPH 1994, 23-34), exactly, by trying every set of
    active contacts. An impact on the way in is plastic, e = 0.

    Parameters
    ----------
    mu : number, Parameter or expression, >= 0
        Friction of the impact on the way in.

    Examples
    --------
    A block that falls on the floor and stays:

    >>> import hapticlab as hl
    >>> z = hl.coordinate("z", unit="m", initial=0.1)
    >>> hl.contact.Contact(z, hl.contact.rigid(), name="floor").contact_law
    rigid(mu=0)
    """

    mu: Any = 0

    is_located = True
    allowed: ClassVar = {"mu": OPPOSING}
    __repr__ = written_out
    e = sp.S.Zero
    rest_speed = sp.oo
    #: it leaves the order to the other contacts of the scene
    impacts = None

    def __post_init__(self) -> None:
        take(self, mu="friction coefficient")

    def check(self, gap: sp.Expr, where: str) -> None:
        """Refuse constants with a unit of their own.

        Parameters
        ----------
        gap : expression
            The gap of the contact [m] or [rad].
        where : str
            Name of the contact, for the message.
        """
        agree_with(self.mu, "1", f"{where}, mu")


def _take_restitution(law):
    e = expression(law.e, "e")
    if e.is_number and not (e.is_real and 0 <= e <= 1):
        through = "below 0 the bodies would pass through each other"
        why = "above 1 every bounce would supply energy to the user" if e.is_real and e > 1 else through
        raise SceneError(f"e = {shown(e)}; restitution lies in 0..1: {why}")
    if isinstance(e, Parameter) and not (e.low >= 0 and e.high <= 1):
        raise SceneError(
            f"e = {e}, declared within {e.low:g}..{e.high:g}; restitution lies in 0..1: "
            f"hl.parameters('{e}', units='1', ranges=(0, 1))"
        )
    object.__setattr__(law, "e", e)


def _positive(given, name, unit, what):
    """An amount above 0: SI number, text with its unit, Parameter or expression."""
    expr = amount(given, unit, name)
    if expr == 0 or expr.is_negative:
        raise SceneError(f"{name} = {expr}; needs {what}, > 0 {unit}")
    return expr
