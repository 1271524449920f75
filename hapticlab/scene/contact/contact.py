"""Contacts of a scene: a gap, the law that acts where it closes, and Coulomb friction."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import sympy as sp

from ...base.shows_itself import ShowsItself
from ...base.units import si_name
from ...errors import SceneError, SignalError
from ..notation.amount import number_of
from ..notation.cases import when
from ..notation.checks import applied, check_symbols
from ..notation.derivative import Partial, Rate
from ..notation.symbols import lag_of, t, v, x
from ..notation.units import dimension_of
from ..notation.written import check_name, expression
from . import instant_laws, penalty_laws  # noqa: F401 (law_names needs every law there is)
from .contact_law import OPPOSING, Allowed, ContactLaw, check_constant, constant, gap_units, law_names, written_out

if TYPE_CHECKING:
    from typing import NoReturn


class _InASum:
    """What is no expression, and says so where it is added to one."""

    name: str

    def _refuse(self, other: Any = None) -> NoReturn:
        raise SceneError(f"{self.name} is a {type(self).__name__}, not a force; its force is an expression, {self.name}.force")

    __add__ = __radd__ = __sub__ = __rsub__ = __mul__ = __rmul__ = __truediv__ = __neg__ = _refuse


@dataclass(frozen=True)
class Contact(ShowsItself, _InASum):
    """Two bodies, or a body and the handle, that cannot pass each other.

    Parameters
    ----------
    gap : expression [m], or [rad] for a joint that stops
        >= 0 apart, 0 in touch; of coordinates, parameters, t and the handle x(t). It starts so, the handle at 0; under
        a force law it may start pressed in by 1 mm, or with a force up to ten times what presses the bodies together.
    contact_law : penalty, hunt_crossley, impulse, micro_impulse or rigid
    name : str
        Names the contact in messages and records; two contacts of a scene need two names.
    slip : expression [m/s]
        Tangential velocity of the surfaces on each other, linear in rates; for a law with friction mu in its impacts. Friction
        of a body that stays in touch is ``hl.contact.friction(slip=..., coulomb=mu*contact.force)`` beside the contact.

    Attributes
    ----------
    force : expression [N]
        Normal force, never negative. For a force law an expression of the gap and its rate; for an event law the
        reaction found while the scene runs, zero in free flight (an impulse is not a force and not in it).

    Raises
    ------
    SceneError, UnitsError, SignalError

    Examples
    --------
    A ball on a table of stiffness k:

    >>> import hapticlab as hl
    >>> q = hl.coordinate("q", unit="m"); k = hl.parameters("k", units="N/m")
    >>> hl.contact.Contact(q, hl.contact.penalty(k=k), name="table").force
    Piecewise((-k*q(t), q(t) <= 0), (0, True))
    """

    gap: sp.Expr
    contact_law: Any
    name: str = "contact"
    slip: Any = sp.S.Zero

    __repr__ = written_out

    def __post_init__(self) -> None:
        check_name(self.name, "contact")
        _check_is_distance(self.gap, self.name)
        gap, slip = expression(self.gap, f"{self.name}: gap"), expression(self.slip, f"{self.name}: slip")
        object.__setattr__(self, "gap", gap)
        object.__setattr__(self, "slip", slip)
        if not isinstance(self.contact_law, ContactLaw):
            raise SceneError(f"{self.name}: contact_law = {self.contact_law!r}; needs {law_names()}")
        _check_gap(gap, self.name)
        gap_units(gap, f"{self.name}: gap")
        if not self.is_force and not applied([gap], "coordinate"):
            raise SceneError(
                f"{self.name}: gap = {gap} contains only the handle, whose velocity no impulse can reverse. Put a body "
                "behind a virtual coupler, or use a penalty, hunt_crossley or hl.laws.proxy_wall"
            )
        self.contact_law.check(gap, self.name)
        mu = getattr(self.contact_law, "mu", sp.S.Zero)
        if mu != 0 and slip == 0:
            raise SceneError(f"{self.name}: friction mu = {mu} needs a direction; give slip=, the tangential velocity [m/s]")
        if slip != 0:
            _check_slip(slip, self.name)
            if not hasattr(self.contact_law, "mu"):
                cure = "add hl.contact.friction(slip=..., coulomb=mu*contact.force) in addition to the contact"
                raise SceneError(f"{self.name}: a {type(self.contact_law).__name__} has no friction of its own; {cure}")

    @property
    def is_force(self) -> bool:
        """True for a law that is an expression of the state; False for one of impulses and reactions."""
        return self.contact_law.is_force

    @property
    def is_located(self) -> bool:
        """True for a law whose events a method must locate inside its step."""
        return self.contact_law.is_located

    @property
    def constants(self) -> Any:
        """The expressions of the law, and the slip."""
        return (self.slip, *(part for part in vars(self.contact_law).values() if isinstance(part, sp.Expr)))

    @property
    def unit(self) -> str:
        """Unit of the force: N, or N*m where the gap is an angle."""
        return gap_units(self.gap, self.name)[0]

    @property
    def force(self) -> sp.Expr:
        """The normal force [N], an expression."""
        if not self.is_force:
            return reaction(self.name, self.unit)
        return self._pressed()

    def _pressed(self, along=sp.S.One):
        """The force of a force law times a factor, of which an open contact needs nothing."""
        return when(self.gap <= 0, self.contact_law.force(self.gap, Rate(self.gap)) * along)

    @property
    def impulse(self) -> sp.Expr:
        """The sum of the normal impulses since the last sample [N s], found while the scene runs; zero of a force law."""
        return self._met("impulse", f"{self.unit}*s")

    @property
    def impact_loss(self) -> sp.Expr:
        """The energy that impacts have dissipated so far [J]; zero of a force law."""
        return self._met("impact_loss", "J")

    @property
    def impact_work(self) -> sp.Expr:
        """The work that handle and moving surfaces have done in impacts so far [J]; zero of a force law."""
        return self._met("impact_work", "J")

    @property
    def rub(self) -> sp.Expr:
        """The tangential force of an impact [N]: a leaf along which a program pushes in the instant, else zero."""
        return sp.Function(f"{self.name}_rub", real=True, unit=self.unit, role="rub", contact=self.name)(t)

    def _met(self, role, unit):
        """The leaf of a sum over impacts; zero of a force law."""
        if self.is_force:
            return sp.S.Zero
        return sp.Function(f"{self.name}_{role}", real=True, unit=unit, role=role, contact=self.name)(t)

    @property
    def felt(self) -> Any:
        """The force on the environment [N] where the gap holds the handle x(t): -force times dgap/dx; not its impulses."""
        return -self.generalized_force(x(t))

    def generalized_force(self, q: sp.Expr) -> sp.Expr:
        """Generalized force of the contact along a coordinate q, or the handle x(t): force times dgap/dq.

        With friction in its impacts, the leaf ``rub`` along dslip/dq' too, zero at all other times.

        Parameters
        ----------
        q : expression
            A coordinate q(t), or the handle x(t).
        """
        along = Partial(self.gap, q)
        if self.is_force and not along.is_number:
            return self._pressed(along)
        normal = self.force * along if along != 0 else along
        if self.slip == 0:
            return normal
        return normal + self.rub * Partial(self.slip, v(t) if q == x(t) else q.diff(t))


@dataclass(frozen=True, kw_only=True)
class friction(ShowsItself, _InASum):
    """Coulomb friction between two surfaces that slip on each other.

    Sliding: ``coulomb`` against the slip. Sticking: whatever keeps the slip at zero, up to ``breakaway``. Sticking is a
    mode with its own reaction, entered where the slip crosses zero and left where the reaction passes ``breakaway``, so
    it holds still, which a steep tanh cannot do.

    Parameters
    ----------
    slip : expression [m/s]
        Relative velocity, linear in rates; of coordinates' rates and the handle's v(t).
    coulomb : Parameter, expression or text with a unit [N], >= 0
        Sliding friction; ``mu * contact.force`` for dry friction at a contact.
    breakaway : Parameter, expression or text with a unit [N], optional
        Breakaway force, >= coulomb; as large unless given.
    stick_speed : Parameter, expression or text with a unit [m/s], optional
        Replaces sticking by a steep line: the force is coulomb slip/stick_speed up to that speed. An ordinary force, for
        every method; it creeps where it should stick.
    name : str

    Examples
    --------
    >>> import hapticlab as hl
    >>> q = hl.coordinate("q", unit="m"); F_c, v_s = hl.parameters("F_c v_s", units="N m/s")
    >>> hl.contact.friction(slip=q.diff(hl.t), coulomb=F_c, stick_speed=v_s).force
    F_c*Max(-1, Min(1, Derivative(q(t), t)/v_s))
    """

    slip: Any
    coulomb: Any
    breakaway: Any = None
    stick_speed: Any = None
    name: str = "friction"

    allowed: ClassVar = {
        "coulomb": OPPOSING,
        "breakaway": OPPOSING,
        "stick_speed": Allowed(0.0, math.inf, "the line needs a speed above 0 at which it ends", above=True),
    }
    __repr__ = written_out

    def __post_init__(self) -> None:
        check_name(self.name, "friction")
        for part in ("slip", "coulomb", "breakaway", "stick_speed"):
            given = getattr(self, part)
            if given is not None:
                object.__setattr__(self, part, constant(given, f"{self.name}: {part}"))
        if self.breakaway is not None and self.stick_speed is not None:
            raise SceneError(
                f"{self.name}: stick_speed replaces sticking, so there is no breakaway force. Give only one of the two"
            )
        if self.breakaway is None:
            object.__setattr__(self, "breakaway", self.coulomb)
        if self.slip == 0:
            raise SceneError(f"{self.name}: slip = 0; needs the relative velocity of the surfaces, such as q.diff(t)")
        _check_slip(self.slip, self.name)
        unit = self.unit
        for part in ("coulomb", "breakaway"):
            if not isinstance(getattr(self, part), sp.Expr):
                raise SceneError(f"{self.name}: {part} = {getattr(self, part)!r}; needs a force such as '0.5 N'")
            if getattr(self, part).is_negative:
                raise SceneError(f"{self.name}: {part} = {getattr(self, part)}; friction opposes the slip: needs {part} >= 0")
            check_constant(getattr(self, part), unit, f"{self.name}, {part}")
        if (number_of(self.breakaway) - number_of(self.coulomb)).is_negative:
            given = f"breakaway = {self.breakaway} < coulomb = {self.coulomb}"
            raise SceneError(f"{self.name}: {given}; a breakaway force is at least as large as the sliding force")
        if self.stick_speed is not None:
            check_constant(self.stick_speed, si_name(dimension_of(self.slip, self.name)), f"{self.name}, stick_speed")

    @property
    def is_force(self) -> bool:
        """True with a ``stick_speed``: then the force is an expression of the state."""
        return self.stick_speed is not None

    @property
    def is_located(self) -> bool:
        """True without a ``stick_speed``: sticking and breaking away are events."""
        return not self.is_force

    @property
    def constants(self) -> Any:
        """The expressions of the law."""
        return tuple(part for part in (self.coulomb, self.breakaway, self.stick_speed) if part is not None)

    @property
    def unit(self) -> str:
        """Unit of the force: N, or N*m where the slip is an angular velocity."""
        return "N" if si_name(dimension_of(self.slip, self.name)) == "m/s" else "N*m"

    @property
    def force(self) -> sp.Expr:
        """The friction force [N] against the slip, an expression."""
        if not self.is_force:
            return reaction(self.name, self.unit, "F")
        return self.coulomb * sp.Max(-1, sp.Min(1, self.slip / self.stick_speed))

    def generalized_force(self, q: sp.Expr) -> sp.Expr:
        """Generalized force of the friction along a coordinate q, or the handle x(t): -force times dslip/dq'.

        Parameters
        ----------
        q : expression
            A coordinate q(t), or the handle x(t).
        """
        return -self.force * Partial(self.slip, v(t) if q == x(t) else q.diff(t))


def reaction(name, unit, letter="N"):
    """The leaf of a reaction that is found while the scene runs; a contact may have the name of a function, floor."""
    printed = {"letter": letter, "_sympystr": _as_text, "_latex": _as_latex}
    return sp.Function(name, real=True, unit=unit, role="reaction", contact=name, **printed)(t)


def _as_text(leaf, printer):
    return f"{type(leaf).letter}_{type(leaf).__name__}(t)"


def _as_latex(leaf, printer, exp=None):
    name = type(leaf).__name__.replace("_", r"\_")
    plain = rf"{type(leaf).letter}_{{\mathrm{{{name}}}}}"
    return plain if exp is None else f"{plain}^{{{exp}}}"


def _check_is_distance(gap, name):
    if isinstance(gap, sp.core.relational.Relational):
        apart = gap.gts - gap.lts if hasattr(gap, "gts") else gap.lhs - gap.rhs
        raise SceneError(
            f"{name}: gap = {gap} is a condition; a contact needs the distance itself, >= 0 where the bodies "
            f"are apart. Write {apart}"
        )


def _check_gap(gap, name):
    check_symbols([gap])
    moving = applied([gap], "coordinate", "handle")
    if not moving:
        raise SceneError(
            f"{name}: gap = {gap} contains neither a coordinate nor x(t), so nothing can close the gap. Write "
            "a distance that depends on one"
        )
    for sample in applied([gap], "handle", "signal"):
        if lag_of(sample) is not None:
            raise SignalError(f"{name}: gap contains the sample {sample}, but a contact also acts between samples. Write x(t)")
    if gap.atoms(sp.Derivative) or gap.has(v(t)):
        raise SceneError(f"{name}: gap = {gap} contains a velocity; a gap is a distance. Write it with positions only")


def _check_slip(slip, name):
    check_symbols([slip])
    rates = [*slip.atoms(sp.Derivative), *({v(t)} & slip.atoms(v))]
    if not rates:
        raise SceneError(f"{name}: slip = {slip} contains no velocity; needs a relative velocity such as q.diff(t) - v(t)")
    dummies = {rate: sp.Dummy() for rate in rates}
    plain = slip.xreplace(dummies)
    if any(plain.diff(a, b) != 0 for a in dummies.values() for b in dummies.values()):
        raise SceneError(
            f"{name}: slip = {slip} is not linear in the velocities; needs a relative velocity such as q.diff(t) - v(t)"
        )
