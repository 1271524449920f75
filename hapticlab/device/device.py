"""A paddle of which only numbers are known: what limits and bounds read of it."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING

from ..base.arguments import number
from ..errors import PaddleError

if TYPE_CHECKING:
    from .hand.hand import Hand

_UNITS = {"m": "kg", "b": "N s/m", "T": "s", "delay": "s", "coulomb": "N", "counts_per_metre": "1/m"}
_ABOVE_ZERO = ("m", "T", "counts_per_metre")
_NEVER_UNKNOWN = ("delay", "coulomb")


@dataclass(frozen=True, kw_only=True)
class Device:
    """The numbers of a paddle, for a limit or a bound where no paddle is at hand.

    A limit asks for the numbers that it depends on, and refuses in words where one is missing.

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
        For a value that is no number, or out of its range.

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

    def __post_init__(self) -> None:
        for name, unit in _UNITS.items():
            given = getattr(self, name)
            if given is not None or name in _NEVER_UNKNOWN:
                least, above = (None, 0.0) if name in _ABOVE_ZERO else (0.0, None)
                found = number(name, given, unit, "a device", least=least, above=above, error=PaddleError)
                object.__setattr__(self, name, found)
        if self.velocity not in ("backward_difference", "measured"):
            raise PaddleError(f"velocity = {self.velocity!r}; needs 'backward_difference' or 'measured'")

    def __str__(self) -> str:
        known = {f.name: getattr(self, f.name) for f in fields(self) if f.name in _UNITS}
        return ", ".join(f"{name} = {value:g} {_UNITS[name]}" for name, value in known.items() if value)
