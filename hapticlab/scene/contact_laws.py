"""Contact laws: what two bodies do to each other where their gap closes; chapter section 23.5.2.

Force laws act over a time: :class:`penalty`, :class:`hunt_crossley`. Event laws act in an instant, or as the reaction
that keeps the gap closed: :class:`impulse`, :class:`micro_impulse`, :class:`rigid`.
"""

import math
from dataclasses import dataclass

import sympy as sp

from ..errors import SceneError
from .amount import amount
from .checks import agree_with
from .symbols import Parameter
from .units import agree, dimension, dimension_of, fixed
from .written import expression

#: exponent of two spheres, or a sphere on a plane
HERTZ = sp.Rational(3, 2)
ORDERS = ("sequential", "simultaneous")
#: what a gap is measured in -> units of force, stiffness, damping and speed
_OF_GAP = {
    dimension("m"): ("N", "N/m", "N*s/m", "m/s"),
    (): ("N*m", "N*m/rad", "N*m*s/rad", "rad/s"),
}


def gap_units(gap, where):
    """Return the units of force, stiffness, damping and speed that belong to a gap in m, or in rad."""
    units = _OF_GAP.get(dimension_of(gap, where))
    if units is None:
        raise SceneError(f"{where}: a gap is a distance in m, or an angle in rad; {gap} is neither")
    return units


@dataclass(frozen=True, kw_only=True)
class penalty:
    """Penalty contact: a spring and a damper act on the penetration, and never pull.

    N = max(0, k d - b dgap/dt) where the gap is closed, with the penetration d = -gap. With b > 0 the force jumps at
    touch, which costs an explicit method its order; :class:`hunt_crossley` has no jump. A contact lasts
    pi sqrt(m/k) with the effective mass m; explicit methods need ten steps in that time.

    Parameters
    ----------
    k : Parameter or expression [N/m], >= 0
    b : Parameter or expression [N s/m], >= 0

    Examples
    --------
    >>> import hapticlab as hl
    >>> k = hl.parameters("k", units="N/m")
    >>> hl.penalty(k=k)
    penalty(k=k, b=0)
    """

    k: sp.Expr
    b: sp.Expr = 0

    def __post_init__(self):
        _take(self, k="stiffness", b="damping")

    def check(self, gap, where):
        """Refuse constants whose units do not belong to the gap."""
        _, stiffness, damping, _ = gap_units(gap, where)
        agree_with(self.k, stiffness, f"{where}, k")
        agree_with(self.b, damping, f"{where}, b")

    def force(self, gap, rate):
        """Return the normal force of a gap that changes at a rate."""
        return sp.Max(0, -self.k * gap - self.b * rate)


@dataclass(frozen=True, kw_only=True)
class hunt_crossley:
    """Hunt-Crossley contact: N = k d^n (1 + c dd/dt), never pulling, with the penetration d = -gap.

    Hunt and Crossley, *Coefficient of restitution interpreted as damping in vibroimpact*, J. Appl. Mech. 42 (1975)
    440-445: their lambda = 3/2 alpha k is k c here, and their restitution e = 1 - alpha v is e = 1 - 2/3 c v to first
    order in the approach speed v, for every mass, stiffness and exponent. :meth:`restitution` is exact. The force starts
    and ends at zero, unlike that of a damper, and the energy lost grows as v cubed. Hertz: n = 3/2 for spheres.

    Parameters
    ----------
    k : Parameter or expression [N/m^n], >= 0
    c : Parameter or expression [s/m], >= 0
    exponent : fraction
        n >= 1; 3/2 unless given. With a whole n the force is a polynomial in d.

    Examples
    --------
    >>> import hapticlab as hl
    >>> k, c = hl.parameters("k c", units="N/m^1.5 s/m")
    >>> hl.hunt_crossley(k=k, c=c)
    hunt_crossley(k=k, c=c, exponent=3/2)
    """

    k: sp.Expr
    c: sp.Expr
    exponent: sp.Rational = HERTZ

    def __post_init__(self):
        _take(self, k="stiffness", c="damping factor")
        exponent = fixed(expression(self.exponent, "exponent"))
        if not (exponent.is_Rational and exponent >= 1):
            raise SceneError(f"exponent = {self.exponent}; needs a fraction n >= 1, such as 3/2 for spheres (Hertz)")
        object.__setattr__(self, "exponent", exponent)

    def check(self, gap, where):
        """Refuse constants whose units do not belong to the gap."""
        force, _, _, speed = gap_units(gap, where)
        agree_with(self.k * gap**self.exponent, force, f"{where}, k gap^{self.exponent}")
        agree_with(1 / self.c if self.c != 0 else 0, speed, f"{where}, 1/c")

    def force(self, gap, rate):
        """Return the normal force of a gap that changes at a rate."""
        # the factor alone is held at zero: where it is negative the contact would pull
        return self.k * sp.Max(0, -gap) ** self.exponent * sp.Max(0, 1 - self.c * rate)

    @staticmethod
    def restitution(cv):
        """Return e for c times the approach speed v, exact: with y = c e v, y + ln(1 - y) = ln(1 + c v) - c v.

        From m v dv/dd = -k d^n (1 + c v), which separates: the energy of the entry and of the exit reach the same
        depth. Mass, stiffness and exponent cancel.

        Examples
        --------
        >>> import hapticlab as hl
        >>> round(hl.hunt_crossley.restitution(0.3), 9)
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


@dataclass(frozen=True, kw_only=True)
class impulse:
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
    order : {"sequential", "simultaneous"}
    mu : number, Parameter or expression, >= 0
        Friction: the tangential impulse opposes the slip, at most mu times the normal one. Needs the contact's ``slip``.

    Examples
    --------
    >>> import hapticlab as hl
    >>> hl.impulse(e=1.3)
    Traceback (most recent call last):
    hapticlab.errors.SceneError: e = 1.3; restitution lies in 0..1: above 1 every bounce would feed energy to the user
    """

    e: sp.Expr
    rest_speed: sp.Expr = None
    order: str = "sequential"
    mu: sp.Expr = 0

    def __post_init__(self):
        _take_restitution(self)
        _take(self, mu="friction coefficient")
        if self.order not in ORDERS:
            raise SceneError(f"order = {self.order!r}; needs 'sequential' (one after the other) or 'simultaneous' (at once)")
        if self.rest_speed is not None:
            speed = _positive(self.rest_speed, "rest_speed", "m/s", "the speed below which a contact rests")
            object.__setattr__(self, "rest_speed", speed)

    def check(self, gap, where):
        """Refuse constants with a unit of their own."""
        agree_with(self.e, "1", f"{where}, e")
        agree_with(self.mu, "1", f"{where}, mu")


@dataclass(frozen=True, kw_only=True)
class micro_impulse:
    """Repeated impulses at the end of each step, for lasting contact too.

    Mirtich and Canny, *Impulse-based simulation of rigid bodies*, Symp. Interactive 3D Graphics (1995) 181-188: no
    constraint and no mode; a body at rest is held by a train of tiny collisions. A fast approach rebounds with e. A slow
    one, which gravity alone could have given in one step, rebounds as it came, more the deeper it lies in the
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
    >>> hl.micro_impulse(e=e, envelope="0.1 mm").e
    e
    """

    e: sp.Expr
    envelope: sp.Expr = "0.1 mm"

    def __post_init__(self):
        _take_restitution(self)
        length = _positive(self.envelope, "envelope", "m", "the distance at which bodies count as in contact")
        object.__setattr__(self, "envelope", length)

    def check(self, gap, where):
        """Refuse constants with a unit of their own."""
        agree_with(self.e, "1", f"{where}, e")
        agree([self.envelope, gap], f"{where}, envelope")


@dataclass(frozen=True, kw_only=True)
class rigid:
    """Rigid contact without rebound: the reaction keeps the gap closed while it pushes, and lets go when it would pull.

    The reactions solve the linear complementarity problem 0 <= N, 0 <= d2gap/dt2, N d2gap/dt2 = 0 (Baraff, *Fast contact
    force computation for nonpenetrating rigid bodies*, SIGGRAPH 1994, 23-34), exactly, by trying every set of active
    contacts. An impact on the way in is plastic, e = 0.

    Parameters
    ----------
    mu : number, Parameter or expression, >= 0
        Friction of the impact on the way in.
    """

    mu: sp.Expr = 0

    e = sp.S.Zero
    rest_speed = sp.oo
    order = "simultaneous"

    def __post_init__(self):
        _take(self, mu="friction coefficient")

    def check(self, gap, where):
        """Refuse constants with a unit of their own."""
        agree_with(self.mu, "1", f"{where}, mu")


FORCE_LAWS = (penalty, hunt_crossley)
EVENT_LAWS = (impulse, micro_impulse, rigid)


def _take(law, **words):
    """Keep the constants of a law as expressions; refuse a negative number."""
    for name, word in words.items():
        expr = expression(getattr(law, name), name)
        if expr.is_number and expr < 0:
            fed = "friction opposes the slip" if name == "mu" else "a negative one feeds energy to the user"
            raise SceneError(f"{name} = {_shown(expr)}; a contact needs a {word} {name} >= 0: {fed}")
        object.__setattr__(law, name, expr)


def _take_restitution(law):
    e = expression(law.e, "e")
    if e.is_number and not 0 <= e <= 1:
        through = "below 0 the bodies would pass through each other"
        why = "above 1 every bounce would feed energy to the user" if e > 1 else through
        raise SceneError(f"e = {_shown(e)}; restitution lies in 0..1: {why}")
    if isinstance(e, Parameter) and not (e.low >= 0 and e.high <= 1):
        raise SceneError(
            f"e = {e}, declared within {e.low:g}..{e.high:g}; restitution lies in 0..1: "
            f"hl.parameters('{e}', units='1', ranges=(0, 1))"
        )
    object.__setattr__(law, "e", e)


def _positive(given, name, unit, what):
    """Return an amount above 0: SI number, text with its unit, Parameter or expression."""
    expr = amount(given, unit, name)
    if expr == 0 or expr.is_negative:
        raise SceneError(f"{name} = {expr}; needs {what}, > 0 {unit}")
    return expr


def _shown(number):
    return f"{float(number):g}"
