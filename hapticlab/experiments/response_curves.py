"""Psychometric functions: how often an answer is right, over the level of what is asked."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, get_args

import numpy as np

from ..base.arguments import choice
from ..base.shows_itself import ShowsItself
from ..base.statistics import normal
from ..errors import AnalysisError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ..base.annotations import Array

Shape = Literal["d_prime", "weibull", "normal"]
SHAPES: tuple[Shape, ...] = get_args(Shape)
ROOT_2, ROOT_PI = math.sqrt(2), math.sqrt(math.pi)


@dataclass(frozen=True)
class Psychometric(ShowsItself):
    """Psychometric function P = guess + (1 - guess - lapse) F(level).

    ===========  =====================================  ====================================================
    shape        F, with u = (level/threshold)^slope    at the threshold
    ===========  =====================================  ====================================================
    ``d_prime``  2 Phi(u/sqrt(2)) - 1                   d' = 1: right in 76 % of two alternatives
    ``weibull``  1 - exp(-u)                            F = 63 %: right in 82 % of two alternatives
    ``normal``   Phi(slope (level - threshold))         F = 50 %: the point of subjective equality
    ===========  =====================================  ====================================================

    ``d_prime`` is signal detection theory: d' grows as a power of the level, and two alternatives are told apart with
    Phi(d'/sqrt(2)); J. M. Foley and G. E. Legge, *Vision Research* 21 (1981) 1041. An observer whose noise does not depend
    on the level has slope 1.

    Attributes
    ----------
    threshold : float
        In the level's unit; > 0 unless ``normal``.
    slope : float
        > 0; 1/(unit of the level) for ``normal``, else without one.
    guess, lapse : float
        Part of right answers where nothing is felt, and of wrong ones where everything is.
    shape : {"d_prime", "weibull", "normal"}

    Examples
    --------
    >>> curve = Psychometric(threshold=0.2, slope=1.0)
    >>> round(float(curve(0.2)), 4), float(curve(0.0))
    (0.7602, 0.5)
    """

    threshold: float
    slope: float
    guess: float = 0.5
    lapse: float = 0.0
    shape: Shape = "d_prime"

    def __post_init__(self) -> None:
        choice("shape", self.shape, SHAPES)
        if not (self.slope > 0 and math.isfinite(self.slope) and (self.threshold > 0 or self.shape == "normal")):
            raise AnalysisError(
                f"threshold = {self.threshold:g}, slope = {self.slope:g}; {self.shape} needs both positive and finite"
            )
        if not (0 <= self.guess and 0 <= self.lapse and self.guess + self.lapse < 1):
            raise AnalysisError(f"guess = {self.guess:g}, lapse = {self.lapse:g}; needs both >= 0 and guess + lapse < 1")

    def __call__(self, levels: ArrayLike) -> Array:
        """The proportion of right answers at each level."""
        q = (self.threshold if self.shape == "normal" else math.log(self.threshold), math.log(self.slope))
        return self.guess + (1 - self.guess - self.lapse) * rise(self.shape, np.asarray(levels, float), *q)[0]


def rise(shape, levels, place, log_slope):
    """F and its derivatives with respect to place and log_slope.

    ``place`` is the logarithm of the threshold, the threshold itself for ``normal``.
    """
    slope = np.exp(log_slope)
    if shape == "normal":
        z = (levels - place) * slope
        density = np.exp(-z * z / 2) / (ROOT_2 * ROOT_PI)
        return normal(z), -density * slope, density * z
    with np.errstate(divide="ignore"):  # a level of zero: u = 0 whatever the slope
        log_u = slope * (np.log(levels) - place)
    u = np.exp(np.minimum(log_u, 50.0))
    if shape == "d_prime":
        F, dF = 2 * normal(u / ROOT_2) - 1, np.exp(-u * u / 4) / ROOT_PI
    else:
        F, dF = -np.expm1(-u), np.exp(-u)
    weight = dF * u
    return F, -slope * weight, weight * np.where(levels > 0, log_u, 0.0)
