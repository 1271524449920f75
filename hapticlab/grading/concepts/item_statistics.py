"""Statistics of a test that is given twice: gains, difficulty, discrimination, reliability, and intervals by resampling.

Sources: gains, Hake (1998), Am. J. Phys. 66, 64, doi:10.1119/1.18809; difficulty, discrimination and reliability, Ding, Chabay,
Sherwood and Beichner (2006), Phys. Rev. ST Phys. Educ. Res. 2, 010105, doi:10.1103/PhysRevSTPER.2.010105, whose ranges of
wanted values are here too; why the effect size stands beside the gain, Nissen, Talbot, Thompson and Van Dusen (2018), Phys.
Rev. Phys. Educ. Res. 14, 010115, doi:10.1103/PhysRevPhysEducRes.14.010115.

All scores are arrays of 0 and 1 with a row for each student and a column for each question.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from ...base.annotations import Array

#: values that Ding et al. want of a question and of a test
DIFFICULTY, DISCRIMINATION, RELIABILITY = (0.3, 0.9), 0.2, 0.7
#: classes drawn again for an interval, and the part of them inside it
RESAMPLED, INSIDE = 2000, 0.95
#: students below which classes drawn again are too much alike: the interval would be far too narrow
LEAST = 10


def gain(before: Array | float, after: Array | float) -> Array:
    """Normalised gain of a class, (after - before)/(1 - before) of its mean scores; NaN if all was right before.

    Parameters
    ----------
    before, after : float or array
        Mean scores of a class, from 0 to 1.

    Examples
    --------
    >>> round(float(gain(0.4, 0.8)), 3)
    0.667
    """
    first, last = np.asarray(before, dtype=float), np.asarray(after, dtype=float)
    left = 1 - first
    return np.where(left > 0, (last - first) / np.where(left > 0, left, 1), np.nan)


def effect_size(before: Array, after: Array) -> float:
    """Cohen's d: the difference of the mean totals over their pooled standard deviation; NaN without any deviation.

    Examples
    --------
    >>> effect_size(np.eye(4)[:2], np.eye(4)[:2] + np.eye(4)[2:])
    nan
    """
    first, last = before.sum(axis=1), after.sum(axis=1)
    spread = np.sqrt((np.var(first, ddof=1) + np.var(last, ddof=1)) / 2) if len(first) > 1 else 0.0
    return float((last.mean() - first.mean()) / spread) if spread > 0 else float("nan")


def interval(function: Callable[..., Array], *scores: Array, seed: int = 0) -> tuple[float, float]:
    """95 % percentile interval of a function of mean scores, from classes drawn again from the students, with replacement.

    Parameters
    ----------
    function : callable
        Of the mean of each array; it is called once, with arrays of the means of all classes drawn.
    *scores : array
        Rows of one number belong to one student in all of them.
    seed : int

    Returns
    -------
    low, high : float
        NaN for fewer than ten students, and where most of the classes drawn have no such number.

    Examples
    --------
    >>> low, high = interval(lambda mean: mean, np.array([[1], [0], [1], [1]] * 5))
    >>> low <= 0.75 <= high
    True
    """
    students = len(scores[0])
    if students < LEAST:
        return float("nan"), float("nan")
    rows = np.random.default_rng(seed).integers(students, size=(RESAMPLED, students))
    drawn = function(*(array.mean(axis=1)[rows].mean(axis=1) for array in scores))
    drawn = drawn[np.isfinite(drawn)]
    if len(drawn) < RESAMPLED / 2:
        return float("nan"), float("nan")
    low, high = np.quantile(drawn, [(1 - INSIDE) / 2, (1 + INSIDE) / 2])
    return float(low), float(high)


def difficulty(scores: Array) -> Array:
    """Part of the students who are right in each question; the larger, the easier."""
    return scores.mean(axis=0)


def discrimination(scores: Array) -> Array:
    """Corrected point-biserial correlation: of each question with the total of all *other* questions; NaN if either is constant.

    Examples
    --------
    >>> discrimination(np.array([[1, 1, 0], [1, 1, 1], [0, 0, 1], [0, 0, 0]])).round(3).tolist()
    [0.707, 0.707, 0.0]
    """
    rest = scores.sum(axis=1, keepdims=True) - scores
    one, other = scores - scores.mean(axis=0), rest - rest.mean(axis=0)
    spread = np.sqrt((one**2).sum(axis=0) * (other**2).sum(axis=0))
    return np.where(spread > 0, (one * other).sum(axis=0) / np.where(spread > 0, spread, 1), np.nan)


def reliability(scores: Array) -> float:
    """KR-20 of Kuder and Richardson, which is Cronbach's alpha of answers that are right or wrong; NaN if all totals are equal.

    Examples
    --------
    >>> round(reliability(np.array([[1, 1, 1], [1, 1, 0], [0, 0, 0], [1, 0, 0]])), 3)
    0.75
    """
    questions = scores.shape[1]
    total = float(np.var(scores.sum(axis=1)))
    right = scores.mean(axis=0)
    if questions < 2 or total == 0:
        return float("nan")
    return questions / (questions - 1) * (1 - float((right * (1 - right)).sum()) / total)
