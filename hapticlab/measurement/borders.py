"""The border between walls that pass and walls that fail, searched from below for every start."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..base.shows_itself import ShowsItself

#: parts of the first stiffness tried before none is said to pass
SOFTER = 1e-2


@dataclass(frozen=True)
class Border(ShowsItself):
    """A stiffness up to which walls pass, found from several starts; it prints as the interval.

    Attributes
    ----------
    K : tuple of float
        The largest stiffness that passed, for every start [N/m]; 0 where all failed, nan where trials could not tell.
    fails_at : tuple of float
        The smallest that failed or could not be told [N/m]; inf where all passed.
    """

    K: tuple[float, ...]
    fails_at: tuple[float, ...]

    @property
    def lowest(self) -> float:
        """Over the starts [N/m]: the conservative end; nan where one start could not tell."""
        return math.nan if any(map(math.isnan, self.K)) else min(self.K)

    @property
    def highest(self) -> float:
        """Over the starts [N/m]; nan where one start could not tell."""
        return math.nan if any(map(math.isnan, self.K)) else max(self.K)

    def __str__(self) -> str:
        if math.isnan(self.lowest):
            return f"an undecided stiffness: above {min(self.fails_at):.3g} N/m some trials were undecided"
        more = ", the most that was searched" if math.isinf(max(self.fails_at)) else ""
        between = f"{self.lowest:.5g}" if self.lowest == self.highest else f"{self.lowest:.5g} to {self.highest:.5g}"
        starts = "start" if len(self.K) == 1 else f"{len(self.K)} starts"
        return f"{between} N/m over {starts}{more}"

    def __repr__(self) -> str:
        return f"Border({self.lowest:.6g} .. {self.highest:.6g} N/m)"


NOWHERE = Border((0.0,), (0.0,))


def borders(trial, starts, first, asked, durations):
    """Return the border of what comes to rest and that of what is quiet; ``trial(start, K, seconds)`` is made once for each.

    Only a handle that comes into the wall shows whether its swing dies out. Every start but the first begins a ratio or two
    below the lowest border of those before, on the same ladder.
    """
    found = {"rests": [], "quiet": []}
    for start in starts:
        for question, ends in found.items():
            if question == "rests" and start.run_up is None:
                continue
            lowest = min((K for K, _ in ends if K > 0), default=first)
            begin = first * asked.growth ** max(0, math.floor(math.log(lowest / first) / math.log(asked.growth)) - 1)
            ends.append(searched(lambda K, s, start=start: trial(start, K, s), question, first, asked, durations, begin))
    return tuple(Border(*zip(*ends, strict=True)) for ends in found.values())


def searched(trial, question, first, asked, durations, begin=None):
    """(largest that passed, smallest that did not), from below, never further than one ratio beyond.

    A trial is as short as tells; the one that is the answer is repeated, for longer. Where that finds a failure which a
    short one did not see, the search goes on below it, for as long. ``durations(K)`` gives both lengths first [s].
    Where none passed, the answer is 0 if every trial says so, and nan if one could not tell.
    """
    K, passed, sure, bad, told, short = begin or first, [], set(), math.inf, [], True
    while True:
        made = trial(K, durations(K)[0 if short else 1])
        told.append(getattr(made, question))
        if told[-1]:
            passed.append(K)
            sure |= {K} if made.duration >= 0.999 * durations(K)[1] else set()
        else:
            bad = K
        while passed and (passed[-1] >= asked.most or bad / passed[-1] <= 1 + asked.tolerance):
            if passed[-1] in sure or getattr(trial(passed[-1], durations(passed[-1])[1]), question):
                return passed[-1], bad
            bad, short = passed.pop(), False
        if not passed and bad <= first * SOFTER * 1.001:
            return (math.nan if None in told else 0.0), bad
        if not passed:
            K = max(bad / 10, first * SOFTER)
        else:
            K = min(passed[-1] * (math.sqrt(bad / passed[-1]) if math.isfinite(bad) else asked.growth), asked.most)
