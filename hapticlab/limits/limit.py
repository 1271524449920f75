"""A stiffness limit that always says which limit it is."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from ..base.guesses import Guessed
from ..base.shows_itself import ShowsItself
from ..errors import AnalysisError
from .plots import plot_limit

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: a limit's polynomials have a degree for each period of delay; past this their roots lose their digits
MOST_PERIODS = 200


class AnyHand(str):
    """The kind of a limit that holds in every passive hand."""


@dataclass(frozen=True)
class Limit(ShowsItself, Guessed):
    """The largest stiffness, and what it promises.

    Attributes
    ----------
    K : float
        Stiffness [N/m]; ``float(limit)`` is the same number.
    frequency : float or None
        Where the limit is reached [Hz]; None where no single frequency decides.
    kind : str
        Which limit this is: passivity, an :class:`AnyHand`, or stability of one plant.
    reason : str
        What decides it, or why it is zero.
    assumptions : tuple of str
        What the number leaves out.

    Examples
    --------
    >>> print(Limit(K=200.0, frequency=None, kind="passivity", reason="every frequency alike"))
    200 N/m: passivity; every frequency alike
    """

    MEANT: ClassVar[dict[str, str]] = {"k": "K", "value": "K", "stiffness": "K", "f": "frequency", "why": "reason"}

    unit: ClassVar[str] = "N/m"
    K: float
    frequency: float | None
    kind: str
    reason: str
    assumptions: tuple[str, ...] = ()

    @property
    def any_hand(self) -> bool:
        """Whether the limit holds in every passive hand."""
        return isinstance(self.kind, AnyHand)

    def __float__(self) -> float:
        return float(self.K)

    def __str__(self) -> str:
        at = "" if self.frequency is None else f" at {self.frequency:.4g} Hz"
        notes = "".join(f"\n  {a}" for a in self.assumptions)
        return f"{self.K:.6g} N/m{at}: {self.kind}; {self.reason}{notes}"

    def plot(self) -> Figure:
        """Return a figure: which stiffnesses the limit promises and which not, and what it leaves out."""
        return plot_limit(self)

    def __repr__(self) -> str:
        at = "None" if self.frequency is None else f"{self.frequency:.6g} Hz"
        return f"Limit(K={self.K:.9g} N/m, frequency={at}, kind={self.kind!r}, reason={self.reason!r})"


def whole_and_fraction(delay: float, T: float, most: float = math.inf) -> tuple[int, float]:
    """Split a delay [s] into whole periods and a fraction of one; 1e-9 of a period is rounding, not delay."""
    periods = delay / T
    if periods > most:
        raise AnalysisError(f"delay = {delay:g} s is {periods:.0f} periods of T = {T:g} s; needs at most {most} periods")
    nearest = round(periods)
    if abs(periods - nearest) < 1e-9:
        return nearest, 0.0
    return math.floor(periods), periods - math.floor(periods)
