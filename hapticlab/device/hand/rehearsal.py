"""What a simulated hand does in a live view where nobody recorded."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...base.arguments import numbers
from ...base.shows_itself import ShowsItself
from ...errors import PaddleError
from .intents import MinimumJerk

#: how far the usual push goes to either side [m]
REACH = 0.015
#: of a rehearsal [s]
DURATIONS = (0.01, 600.0)


@dataclass(frozen=True, kw_only=True)
class Rehearsal(ShowsItself):
    """The motion of a simulated hand for ``view.rehearsal``, if there is no recording.

    Parameters
    ----------
    intent : callable, optional
        Where the hand means to be [m], of an array of times [s]: by default a push from -15 mm to 15 mm and back.
    duration : float or text
        [s], 0.01 to 600.

    Examples
    --------
    >>> import hapticlab as hl
    >>> hl.people.Rehearsal(duration="2 s").duration
    2.0
    """

    intent: Callable[..., Any] | None = None
    duration: float = 4.0

    def __post_init__(self) -> None:
        least, most = DURATIONS
        numbers(self, "a rehearsal", error=PaddleError, duration={"unit": "s", "least": least, "most": most})
        if self.intent is not None:
            _check_intent(self.intent)

    def path(self) -> Callable[..., Any]:
        """The intent, or the usual push."""
        return self.intent or _push(self.duration)


REHEARSAL = Rehearsal()


def _check_intent(intent):
    try:
        at_zero = np.asarray(intent(np.zeros(1)), float)
    except Exception as problem:
        raise PaddleError(
            f"intent = {intent!r}; a rehearsal needs an intent: a function of an array of times [s] that returns positions "
            f"[m], such as hl.people.MinimumJerk(end=0.02, duration=1.0). At 0 s: {type(problem).__name__}: {problem}"
        ) from problem
    if at_zero.size != 1 or not np.isfinite(at_zero).all():
        raise PaddleError(f"the rehearsal's intent at 0 s is {at_zero}; needs one finite position [m] for each time")


def _push(duration):
    """Return the usual rehearsal: from 0 to -15 mm, to 15 mm, a rest, and back."""
    out, to, back = 0.15 * duration, 0.35 * duration, 0.35 * duration
    begin = MinimumJerk(end=-REACH, duration=out)
    push = MinimumJerk(end=2 * REACH, duration=to, begin=out)
    return begin + push + MinimumJerk(end=-2 * REACH, duration=back, begin=duration - back)
