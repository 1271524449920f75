"""How a search of walls goes, from which starts, and how a trial is judged: the records of :func:`largest_stiffness`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..base.arguments import count, number, numbers
from ..base.shows_itself import ShowsItself
from ..device.hand.hand import Hand
from ..errors import AnalysisError


@dataclass(frozen=True, kw_only=True)
class Search(ShowsItself):
    """The walls that a search tries: from the softest upwards, by a ratio, until the answer is close enough.

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
    tolerance: float = 0.01

    def __post_init__(self) -> None:
        stiffness, ratio = {"unit": "N/m", "above": 0}, {"unit": "1", "above": 1}
        numbers(self, "a search", first=stiffness, most=stiffness, growth=ratio, tolerance={"unit": "1", "above": 0})


@dataclass(frozen=True, kw_only=True)
class Starts(ShowsItself):
    """The starts from which every wall is tried, with each push and each hand.

    The handle is let go before the wall, or, where a sensor's counts may make it buzz, at rest in the wall already.

    Parameters
    ----------
    run_ups : sequence of float or text
        From how far before the wall the push brings the handle [m], >= 0: it enters with sqrt(2 push run_up/m), 90 mm/s
        for 0.2 N, 1 mm and 50 g. On a board the motor leads it there.
    pushes : sequence of float or text
        Constant forces of the motor into the wall [N]. By default one of 0.2 N, at most a quarter of what the paddle's
        force limit leaves the wall, and none where a simulated hand pushes or leans. Friction above it hides what the
        wall does.
    within_count : int
        Places spread over one encoder count at which the handle rests in every wall, >= 1, by as many pushes: in the
        middle of a count it may be quiet, and buzz at its edge.
    hands : sequence of Hand
        That hold a simulated paddle in turn, by default its own. On a board, measure again in another hand.

    Examples
    --------
    >>> import hapticlab as hl
    >>> hl.measure.Starts(run_ups=[0, "5 mm"], within_count=2).run_ups
    (0.0, 0.005)
    """

    run_ups: Any = (0.0, 1e-3)
    pushes: Any = ()
    within_count: int = 3
    hands: Any = ()

    def __post_init__(self) -> None:
        run_ups = tuple(number("run_ups", way, "m", "a start", least=0) for way in _each(self.run_ups))
        pushes = tuple(number("pushes", push, "N", "a start") for push in _each(self.pushes))
        hands = _each(self.hands)
        if not run_ups or not all(isinstance(hand, Hand) for hand in hands):
            raise AnalysisError(
                f"run_ups = {run_ups}, hands = {hands}; a start needs at least one run-up, and hands such as hl.Hand('pinch')"
            )
        for name, value in {"run_ups": run_ups, "pushes": pushes, "hands": hands}.items():
            object.__setattr__(self, name, value)
        count("within_count", self.within_count, "a start")


def _each(given):
    return tuple(given) if np.iterable(given) and not isinstance(given, str) else (given,)


@dataclass(frozen=True, kw_only=True)
class Judgement(ShowsItself):
    """The duration of a trial of a wall, and the motion up to which it passes.

    Parameters
    ----------
    energy_max : float or text
        The most energy that the wall may have given [J]; the guard cuts the motor there.
    speed_max : float or text
        Of the handle [m/s], where the guard cuts the motor; it leaves room for three encoder counts a period.
    buzz_max : float or text
        Amplitude of the force's ripple [N] up to which a wall is quiet: without friction some count is always dithered
        over.
    duration, longest : float or text, optional
        Of a trial [s], 128 samples at least; doubled up to the longest while the record does not tell. By default 1 s,
        500 samples and ten periods at least, and 16 times that.

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
