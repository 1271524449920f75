"""How a search of walls goes, and what it calls a wall that stands: the two records of :func:`largest_stiffness`."""

from __future__ import annotations

from dataclasses import dataclass

from ..base.arguments import numbers


@dataclass(frozen=True, kw_only=True)
class Search:
    """Which walls a search tries: from the softest on, by a ratio, until the answer is close enough.

    Parameters
    ----------
    first : float or text, optional
        The softest wall [N/m]; by default one that 10 mm withstand the push, 20 N/m for a push of 0.2 N.
    most : float or text
        The stiffest [N/m], > 0.
    growth : float
        Ratio from one trial to the next, > 1.
    tolerance : float
        Of the stiffness, relative, > 0.

    Examples
    --------
    >>> import hapticlab as hl
    >>> hl.measure.Search(first="1 kN/m", tolerance=0.05)
    Search(first=1000.0, most=100000.0, growth=1.5, tolerance=0.05)
    """

    first: float | None = None
    most: float = 1e5
    growth: float = 1.5
    tolerance: float = 0.02

    def __post_init__(self) -> None:
        stiffness, ratio = {"unit": "N/m", "above": 0}, {"unit": "1", "above": 1}
        numbers(self, "a search", first=stiffness, most=stiffness, growth=ratio, tolerance={"unit": "1", "above": 0})


@dataclass(frozen=True, kw_only=True)
class Judgement:
    """How long a trial of a wall lasts, and what it may do and still stand.

    Parameters
    ----------
    energy_max : float or text
        The most energy that the wall may have given [J]; the guard cuts the motor there.
    speed_max : float or text
        Of the handle [m/s], where the guard cuts the motor; it leaves room for three encoder counts a period.
    buzz_max : float or text
        The force [N] by which a handle at the edge of one encoder count may buzz and still stand: without friction some
        count is always dithered over.
    duration, longest : float or text, optional
        Of a trial [s], 128 samples at least; doubled up to the longest while the record does not tell. By default 1 s,
        500 samples and ten periods at least, and four times that.

    Examples
    --------
    >>> import hapticlab as hl
    >>> hl.measure.Judgement(energy_max="10 mJ", longest="1 s").energy_max
    0.01
    """

    energy_max: float = 0.05
    speed_max: float = 1.0
    buzz_max: float = 0.05
    duration: float | None = None
    longest: float | None = None

    def __post_init__(self) -> None:
        energy, speed, force, time = ({"unit": unit, "least": 0} for unit in ("J", "m/s", "N", "s"))
        numbers(self, "a trial", energy_max=energy, speed_max=speed, buzz_max=force, duration=time, longest=time)
