"""A paddle of which only numbers are known, and the numbers that limits and bounds read of any paddle."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any, TypeAlias

from ..base.arguments import having, number
from ..base.shows_itself import ShowsItself
from ..base.unusual import DEVICE, warn_of_unusual
from ..errors import AnalysisError, PaddleError

if TYPE_CHECKING:
    from ..base.annotations import Number
    from ..base.profile.paddle_profile import PaddleProfile
    from .hand.hand import Hand
    from .paddle import Paddle

#: whatever a limit takes first
AnyDevice: TypeAlias = "Device | Paddle | PaddleProfile"

_UNITS = {
    "m": "kg", "b": "N s/m", "T": "s", "delay": "s", "coulomb": "N", "counts_per_metre": "1/m",
    "sensor_delay": "s",
}  # fmt: skip
_ABOVE_ZERO = ("m", "T", "counts_per_metre")
_NEVER_UNKNOWN = ("delay", "coulomb", "sensor_delay")
_WHY = {
    "b": "its damping dissipates the energy that the hold generates",
    "delay": "a force cannot come before its sample",
    "sensor_delay": "a sensor cannot show a position before the handle is there",
    "coulomb": "friction opposes motion",
}


@dataclass(frozen=True, kw_only=True)
class Device(ShowsItself):
    """The constants of a device, for a limit or a bound, without a paddle that runs.

    A limit uses the constants that it depends on, and raises an error that names a missing one.

    Parameters
    ----------
    m : float or text, optional
        Mass at the handle [kg], > 0.
    b : float or text, optional
        Viscous damping at the handle [N s/m], >= 0.
    T : float or text, optional
        Sampling period [s], > 0.
    delay : float or text
        Computational delay [s], >= 0.
    sensor_delay : float or text
        Lag of the sensor [s], >= 0. A limit adds it to the delay: a force from a position read late is a late force.
    coulomb : float or text
        Coulomb friction [N], >= 0.
    counts_per_metre : float or text, optional
        Of the encoder [1/m], > 0; without it positions are exact.
    velocity : {"backward_difference", "measured"}
        Where v(n) comes from.
    hand : Hand, optional

    Raises
    ------
    PaddleError
        For a value that is not a number or is out of its range.

    Examples
    --------
    >>> import hapticlab as hl
    >>> device = hl.Device(b=0.1, T="1 ms", delay="0.5 ms")
    >>> print(device)
    b = 0.1 N s/m, T = 0.001 s, delay = 0.0005 s
    """

    m: float | None = None
    b: float | None = None
    T: float | None = None
    delay: float = 0.0
    coulomb: float = 0.0
    counts_per_metre: float | None = None
    velocity: str = "backward_difference"
    hand: Hand | None = None
    sensor_delay: float = 0.0

    if TYPE_CHECKING:  # it takes texts and keeps floats

        def __init__(
            self,
            *,
            m: Number | None = None,
            b: Number | None = None,
            T: Number | None = None,
            delay: Number = 0.0,
            coulomb: Number = 0.0,
            counts_per_metre: Number | None = None,
            velocity: str = "backward_difference",
            hand: Hand | None = None,
            sensor_delay: Number = 0.0,
        ) -> None: ...

    def __post_init__(self) -> None:
        for name in _UNITS:
            given = getattr(self, name)
            if given is not None or name in _NEVER_UNKNOWN:
                value = _checked(name, given, PaddleError)
                object.__setattr__(self, name, value)
                warn_of_unusual(name, value, _UNITS[name], DEVICE.get(name))
        if self.velocity not in ("backward_difference", "measured"):
            raise PaddleError(f"velocity = {self.velocity!r}; needs 'backward_difference' or 'measured'")

    def _sentence(self):
        return f"the numbers of a paddle: {self}"

    def _line(self):
        return f"Device({self})"

    def __str__(self) -> str:
        known = {f.name: getattr(self, f.name) for f in fields(self) if f.name in _UNITS}
        return ", ".join(f"{name} = {value:g} {_UNITS[name]}" for name, value in known.items() if value)


def known(device: AnyDevice, *names: str, or_none: str = "") -> tuple[Any, ...]:
    """The numbers of these names, of a paddle, its profile or a :class:`Device`; a number that is missing is refused in words.

    A paddle on a board has those that its board keeps. A profile has no hand. The delay is that from where
    the handle is to the force that follows from it: the sensor's lag and the computational delay together.

    Parameters
    ----------
    or_none : str
        Names of numbers that may be None, apart by blanks; they come last.

    Examples
    --------
    >>> known(Device(b=0.1, T="1 ms"), "b", "T", "delay")
    (0.1, 0.001, 0.0)
    >>> known(Device(b=0.1), "b", "T")
    Traceback (most recent call last):
    hapticlab.errors.AnalysisError: the device has no T; needs hl.Device(T=..., ...)
    """
    given = getattr(device, "device", device)
    having(given, _CURE, *(name for name in names if name not in _OPTIONAL))
    values = {name: getattr(given, name, _DEFAULTS[name]) for name in (*names, *or_none.split())}
    if "delay" in values:
        values["delay"] = total_delay(given)
    checked = _UNITS.keys() - {name for name, value in values.items() if value is None}
    return tuple(_checked(name, value, AnalysisError) if name in checked else value for name, value in values.items())


def total_delay(device):
    """The time from where the handle is to the force that follows from it, less the hold [s].

    Sampling late by so much and giving the force as early as before is what giving it late by the sum is.
    """
    delay, lag = getattr(device, "delay", 0.0), getattr(device, "sensor_delay", 0.0)
    return delay + lag if lag else delay


_CURE = "a paddle, as hl.SimulatedPaddle(...), a profile, as hl.devices.profile('bench7.json'), or hl.Device(m=..., b=..., T=...)"
_DEFAULTS = {f.name: f.default for f in fields(Device)}
_OPTIONAL = {"delay", "sensor_delay", "coulomb", "counts_per_metre", "hand", "velocity"}


def _checked(name, given, error):
    least, above = (None, 0.0) if name in _ABOVE_ZERO else (0.0, None)
    return number(name, given, _UNITS[name], "a device", least=least, above=above, why=_WHY.get(name, ""), error=error)
