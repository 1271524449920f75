"""What a kind of paddle, or one paddle, is: its constants, with intervals where they were measured."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Any, Literal

from ...errors import AnalysisError, PaddleError
from ..arguments import choice
from ..facts import card
from ..shows_itself import ShowsItself
from .constants import CONSTANTS, ROUNDINGS, check_duties, in_range, unit_of
from .drive_train import DriveTrain
from .estimate import Estimate
from .prediction import Prediction, predicted
from .profile_file import write_profile

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from ..annotations import File, Number


#: digits of a number that is known exactly
EXACT = 6


@dataclass(frozen=True)
class PaddleProfile(ShowsItself):
    """The constants of a paddle, where they come from and, where they were measured, how well they are known.

    Every simulated paddle and every limit takes a profile. A profile whose constants have intervals is the digital twin
    of the paddle that they were measured on: ``twin["b"]`` is an Estimate, :meth:`at` chooses ends of the intervals,
    :meth:`predict` gives the interval of a prediction, and :meth:`save` writes a file to share.

    Attributes
    ----------
    name : str
    m : float
        Effective mass at the handle [kg].
    b : float
        Viscous damping at the handle [N s/m].
    counts_per_metre : float or None
        Encoder counts per metre of handle travel [1/m].
    rounding : {"floor", "nearest"}
    coulomb : float
        Coulomb friction at the handle [N].
    force_max : float or None
        Largest force magnitude [N].
    T : float
        Sampling period [s].
    nominal : bool
        True where no constant was measured on the very device: a lab identifies them.
    source : str
        Where all constants without an estimate come from.
    sensor_delay, sensor_noise, sensor_flight : float
        Of the sensor: its lag [s], the standard deviation of its noise at the handle [m], and how long a reading lies
        between the ends of its range when an angle sensor begins anew [s].
    duty_dead : float
        Part of full duty below which the motor gives no force, 0 ... 0.5.
    duty_25, duty_50, duty_75 : float or None
        Parts of full duty, dead band included, at which the motor gives a quarter, half and three quarters of its force.
    force_full : float or None
        Force at full duty [N].
    carrier : float or None
        PWM carrier that the motor's driver can follow [Hz].
    wiring : str
        Name of the usual wiring of its sensor and its driver.
    delay : float
        Computational delay [s].
    estimates : tuple of Estimate
        Of the constants that were measured: the interval of each, and its source.
    drive : DriveTrain or None
        What lies between motor and handle, from published numbers; limits and simulated paddles do not read it.

    Raises
    ------
    PaddleError
        For a constant that is not a number or is out of its range, and for an interval that does not contain its constant.

    Examples
    --------
    >>> import hapticlab as hl
    >>> print(hl.devices.PaddleProfile("toy", m=0.05, b=0.1, source="made up"))
    paddle toy: m = 0.05 kg, b = 0.1 N s/m, T = 0.001 s (nominal, not measured on this device; source: made up)
    """

    name: str
    m: float
    b: float
    counts_per_metre: float | None = None
    rounding: str = "floor"
    coulomb: float = 0.0
    force_max: float | None = None
    T: float = 1e-3
    nominal: bool = True
    source: str = ""
    sensor_delay: float = 0.0
    sensor_noise: float = 0.0
    sensor_flight: float = 0.0
    duty_dead: float = 0.0
    duty_25: float | None = None
    duty_50: float | None = None
    duty_75: float | None = None
    force_full: float | None = None
    carrier: float | None = None
    wiring: str = ""
    delay: float = 0.0
    estimates: tuple[Estimate, ...] = ()
    drive: DriveTrain | None = None

    def __post_init__(self) -> None:
        for name in CONSTANTS:
            given = getattr(self, name)
            value = given if given is None and name in _MAY_BE_NONE else in_range(name, given, f"the profile {self.name}")
            if isinstance(given, str):
                object.__setattr__(self, name, value)
        check_duties(self, PaddleError)
        choice("rounding", self.rounding, ROUNDINGS, error=PaddleError)
        if not isinstance(self.drive, DriveTrain | None):
            raise PaddleError(f"drive = {self.drive!r}; the profile {self.name} needs an hl.devices.DriveTrain, or None.")
        for estimate in self.estimates:
            _check_estimate(self, estimate)
        order = list(CONSTANTS)
        estimates = sorted(self.estimates, key=lambda one: order.index(one.name))
        if len({one.name for one in estimates}) < len(estimates):
            raise PaddleError(f"profile {self.name}: two estimates of one constant. Give one estimate for each constant.")
        object.__setattr__(self, "estimates", tuple(estimates))

    def __getitem__(self, name: str) -> Estimate:
        for estimate in self.estimates:
            if estimate.name == name:
                return estimate
        known = ", ".join(one.name for one in self.estimates) or "none"
        raise AnalysisError(
            f"{name!r} has no interval in the profile {self.name}; with intervals: {known}. A measurement adds some: "
            "hl.identify.twin(name, found, base=profile)"
        )

    def at(self, **values: Number | Literal["low", "high"]) -> PaddleProfile:
        """Return the profile with some constants at an end of their interval, or at a value; these are exact then.

        Which end is the safe one depends on the question: little damping is bad for a wall, and much damping is bad for
        transparency. :meth:`predict` finds the ends that matter.

        Parameters
        ----------
        **values : {"low", "high"} or float or text
            By name of the constant.

        Examples
        --------
        >>> import hapticlab as hl
        >>> rough = hl.devices.profile("hapkit_rough")
        >>> rough.at(coulomb="high", m="30 g").coulomb
        0.08
        """
        if unknown := sorted(set(values) - set(CONSTANTS)):
            raise PaddleError(f"{unknown[0]} is not a constant of a paddle; the constants are {', '.join(CONSTANTS)}.")
        chosen = {name: self._chosen(name, value) for name, value in values.items()}
        rest = tuple(one for one in self.estimates if one.name not in chosen)
        numbers = {name: one.value for name, one in chosen.items()}
        return replace(self, **numbers, estimates=(*rest, *chosen.values()))

    def _chosen(self, name, value):
        """An exact estimate: an end of an interval, or a value."""
        if value in ("low", "high"):
            known = self[name]
            value, source = getattr(known, value), f"{value} end of {_with_source(known)}"
        else:
            value, source = in_range(name, value, f"the profile {self.name}"), "given"
        return Estimate(name, value, value, value, unit_of(name), source)

    def predict(self, question: Callable[..., Any], *args: Any, **options: Any) -> Prediction:
        """Return the interval of a prediction: over all ends of the intervals of the constants that it depends on.

        Constants without an interval are taken as exact. The prediction's own docstring says what the interval means.

        Parameters
        ----------
        question : callable
            Takes a profile first, as every limit does, and returns a number, a Limit or an Estimate.
        *args, **options
            Passed on to it.

        Returns
        -------
        Prediction

        Raises
        ------
        AnalysisError
            If no constant has an interval, the answer is not a number, or the question has no answer at one of the ends.

        Examples
        --------
        >>> import hapticlab as hl
        >>> b = hl.identify.Estimate("b", 0.1, 0.08, 0.12, "N s/m")
        >>> twin = hl.devices.PaddleProfile("toy", m=0.05, b=0.1, estimates=(b,))
        >>> print(twin.predict(hl.passivity_limit))
        200 N/m, between 160 and 240
          lowest with   b low
          highest with  b high
          the other constants of the profile are taken as exact
        >>> cautious = hl.SimulatedPaddle.from_profile(twin.predict(hl.passivity_limit).at_low)
        >>> cautious.b
        0.08
        """
        return predicted(self, question, args, options)

    def save(self, path: File) -> Path:
        """Write the profile to a JSON file and return its path (``.json`` is added where missing).

        ``hl.devices.profile("bench7.json")`` reads it. It contains what ``print`` shows and nothing of the computer.

        Parameters
        ----------
        path : str or path
            The file to write, with ``.json`` added where missing; one that is there is replaced.
        """
        return write_profile(self, path)

    def __str__(self) -> str:
        parts = [f"m = {self._short('m')} kg", f"b = {self._short('b')} N s/m", f"T = {self.T:g} s"]
        if self.counts_per_metre:
            parts.append(f"{1e6 / self.counts_per_metre:g} um per count ({self.rounding})")
        if self.coulomb:
            parts.append(f"Coulomb friction {self._short('coulomb')} N")
        if self.delay:
            parts.append(f"delay {1e3 * self.delay:.4g} ms")
        if self.sensor_delay:
            parts.append(f"sensor {1e3 * self.sensor_delay:.4g} ms late")
        if self.duty_dead:
            parts.append(f"no force below {100 * self.duty_dead:.4g} % duty")
        if self.force_max:
            parts.append(f"|F| <= {self.force_max:g} N")
        if self.estimates and not self.nominal:
            standing = f"measured where listed; the others: {self.source or 'not given'}"
        else:
            nominal = "nominal, not measured on this device" if self.nominal else "measured"
            standing = f"{nominal}; source: {self.source or 'not given'}"
        return card(f"paddle {self.name}: {', '.join(parts)} ({standing})", self._rows_of_estimates())

    def _short(self, name):
        digits = next((_digits(one) for one in self.estimates if one.name == name), EXACT)
        return f"{getattr(self, name):.{digits}g}"

    def _rows_of_estimates(self):
        """Constant -> value, interval and source; nothing for a profile that has no estimate."""
        if not self.estimates:
            return {}
        rows = {one.name: _with_source(one) for one in self.estimates}
        others = [name for name in CONSTANTS if getattr(self, name) and name not in rows]
        return {**rows, "others": f"{', '.join(others)}: without an interval, from the source above"} if others else rows


#: constants that a profile may not know
_MAY_BE_NONE = {f.name for f in fields(PaddleProfile) if f.default is None}


def _check_estimate(profile, estimate):
    """Refuse an estimate that is not one of the profile's own constants."""
    if not isinstance(estimate, Estimate) or estimate.name not in CONSTANTS:
        raise PaddleError(
            f"profile {profile.name}: {estimate!r} is not an estimate of a constant. Use hl.identify.Estimate(name, value, low, "
            f"high, unit) with a name of {', '.join(CONSTANTS)}."
        )
    name, unit = estimate.name, unit_of(estimate.name)
    if estimate.unit != unit:
        raise PaddleError(
            f"profile {profile.name}: {name} in {estimate.unit!r}; the unit must be {unit!r}. Convert the estimate."
        )
    low, high = (in_range(name, end, f"the profile {profile.name}") for end in (estimate.low, estimate.high))
    if not low <= estimate.value <= high:
        raise PaddleError(
            f"profile {profile.name}: {name} = {estimate.value:g} {unit}, between {low:g} and {high:g}; the interval must "
            "contain the value, its lower end first. Correct the interval."
        )
    if estimate.value != getattr(profile, name):
        raise PaddleError(
            f"profile {profile.name}: {name} = {getattr(profile, name)} {unit}, but its estimate is {estimate.value} {unit}. "
            f"profile.at({name}=...) changes both."
        )


def _digits(one):
    return EXACT if one.low == one.high else one.digits()


def _with_source(one):
    digits, unit = _digits(one), "" if one.unit == "1" else f" {one.unit}"
    known = "exact" if one.low == one.high else f"{one.low:.{digits}g} to {one.high:.{digits}g}"
    source = f"; {one.source}" if one.source else ""
    return f"{one.value:.{digits}g}{unit}, {known}{source}"
