"""A constant with the interval in which it lies."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..shows_itself import ShowsItself


@dataclass(frozen=True)
class Estimate(ShowsItself):
    """A constant and its confidence interval, in ``unit``; and where it comes from, if that is known.

    Parameters
    ----------
    name : str
        Of the constant, as a profile has it: "m", "b" ...
    value : float
        In ``unit``.
    low, high : float
        Ends of the interval, in ``unit``.
    unit : str
        SI unit, such as "kg".
    source : str
        Where it comes from; empty if that is not known.

    Examples
    --------
    >>> print(Estimate("m", 0.0301, 0.0297, 0.0305, "kg"))
    m = 0.0301 kg, between 0.0297 and 0.0305
    """

    name: str
    value: float
    low: float
    high: float
    unit: str
    source: str = ""

    @property
    def half_width(self) -> float:
        """Half the width of the interval."""
        return (self.high - self.low) / 2

    def __contains__(self, value: float) -> bool:
        return self.low <= value <= self.high

    def __float__(self) -> float:
        return self.value

    def digits(self) -> int:
        """How many digits of the value its interval allows to be told, and a few more."""
        if self.half_width == 0:
            return 3
        return min(max(math.ceil(math.log10(abs(self.value / self.half_width) + 1)) + 2, 3), 9)

    def __str__(self) -> str:
        digits = self.digits()
        return f"{self.name} = {self.value:.{digits}g} {self.unit}, between {self.low:.{digits}g} and {self.high:.{digits}g}"
