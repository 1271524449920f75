"""A hand that reacts to what it has seen and felt, a reaction time ago."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.arguments import number
from ...base.shows_itself import ShowsItself
from ...errors import PaddleError
from .intents import Intent, Together

if TYPE_CHECKING:
    from typing import NoReturn

    from ...base.annotations import Number

#: between a signal and the press of a button it tells of, Section 23.3.3 [s]
REACTION = 0.18


class Seen:
    """What a person knows: everything recorded up to a reaction time ago; each column is an array by its name.

    Examples
    --------
    >>> seen = Seen({"t": [0.0, 0.1], "x": [0.0, 0.01]})
    >>> float(seen.x[-1])
    0.01
    """

    def __init__(self, columns):
        self.columns = {name: np.asarray(values, float) for name, values in columns.items()}

    def __len__(self):
        return len(self.columns["t"])

    def __getattr__(self, name):
        columns = self.__dict__.get("columns", {})
        if name in columns:
            return columns[name]
        raise AttributeError(f"{name!r} is not available; there are {', '.join(columns)}. Watch it: hl.Scene(..., watch=[...])")


@dataclass(frozen=True, kw_only=True)
class Reacting(ShowsItself, Intent):
    """An intent that responds to the motion one reaction time earlier: the feedback path of Section 23.3.3.

    Every so often the plan is asked where to be by the next time; the hand moves there in a straight line. What the
    plan knows ends a reaction time before it is asked. Runs on a simulated paddle alone.

    Parameters
    ----------
    plan : callable
        ``plan(t, seen, intent)`` gives the intent [m] at the time t [s]. ``seen`` has arrays t, x, v, F
        and the watched states; empty at first. x is the handle itself, also under an encoder. ``intent`` is where the
        hand means to be now [m]: a plan that adds to it needs no memory of its own.
    reaction : float
        [s], >= 0; 180 ms in the chapter.
    interval : float
        [s] between two decisions, > 0; whole samples are used.
    start : float
        The intent at t = 0 [m].
    beside : callable, optional
        A path that is added, of an array of times: ``hl.people.Reacting(plan=...) + hl.people.Tremor(rms=1e-4)``. The
        plan does not know it.

    Examples
    --------
    >>> import hapticlab as hl
    >>> def home(t, seen, intent):
    ...     return 0.01 if len(seen) else 0.0
    >>> paddle = hl.SimulatedPaddle(m=0.05, b=1.0, T=1e-3, hand=hl.Hand(k=200, b=5, intent=hl.people.Reacting(plan=home)))
    >>> log = paddle.run(hl.wall()(k=100, x_o=0.05), duration=0.5)
    >>> bool(log.x[180] == 0.0), bool(abs(log.x[-1] - 0.01) < 1e-4)
    (True, True)
    """

    plan: Callable[..., float]
    reaction: float = REACTION
    interval: float = 0.01
    start: float = 0.0
    beside: Callable[..., Any] | None = None

    if TYPE_CHECKING:  # it takes texts and keeps floats

        def __init__(
            self,
            *,
            plan: Callable[..., float],
            reaction: Number = REACTION,
            interval: Number = 0.01,
            start: Number = 0.0,
            beside: Callable[..., Any] | None = None,
        ) -> None: ...

    def __post_init__(self) -> None:
        if not callable(self.plan):
            raise PaddleError(f"plan = {self.plan!r}; needs a function plan(t, seen, intent) that returns an intent [m].")
        object.__setattr__(self, "reaction", number("reaction", self.reaction, "s", "a person", least=0, error=PaddleError))
        object.__setattr__(self, "interval", number("interval", self.interval, "s", "a person", above=0, error=PaddleError))
        object.__setattr__(self, "start", number("start", self.start, "m", "a hand", error=PaddleError))

    def __call__(self, t: Any) -> NoReturn:
        raise PaddleError(
            "this hand reacts to the motion, so its intent is not a function of time, and it runs on SimulatedPaddle.run "
            "only. Give a path instead, such as hl.people.MinimumJerk(...)."
        )

    def with_path(self, path: Callable[..., Any]) -> Reacting:
        """Return this plan with an added path of time, such as :class:`Tremor`.

        Parameters
        ----------
        path : callable
            Position added to the intent [m], as a function of an array of times [s].
        """
        if isinstance(path, Reacting):
            raise PaddleError("this hand has two plans; give one Reacting(plan=...) that does the work of both.")
        return replace(self, beside=path if self.beside is None else Together((self.beside, path)))

    __add__ = __radd__ = with_path

    def asked(self, t: float, seen: Any, intent: float) -> float:
        """The plan's next intent [m], checked.

        Parameters
        ----------
        t : float
            Time at which the intent is to be reached [s].
        seen : record
            What the hand has seen so far: arrays t, x, v, F and the watched states.
        intent : float
            Where the hand means to be now [m].
        """
        place: Any = self.plan(t, seen, intent)
        if not np.isscalar(place) or not np.isfinite(place):
            raise PaddleError(f"plan gave {place!r} at t = {t:g} s; needs one position [m].")
        return float(place)  # type: ignore[arg-type]


def run_reacting(loaded, paddle, parameters, ticks, outputs):
    """Run so many ticks, asking the hand's plan as it goes; return outputs of shape (ticks, outputs).

    Parameters
    ----------
    loaded, parameters
        The linked program and its values.
    paddle : SimulatedPaddle
        Whose hand has a :class:`Reacting` intent.
    outputs : sequence of str
        Names of the linked program's outputs.
    """
    mind, T = paddle.hand.intent, paddle.T
    chunk = max(1, round(mind.interval / T))
    # a hand that does not react: its noises are those of any hand, its path is what stands beside the plan
    still = replace(paddle.hand, intent=mind.beside or (lambda t: 0.0 * t))
    rows = replace(paddle, hand=still).inputs(ticks)
    intent = {c.name: j for j, c in enumerate(loaded.program.inputs) if c.name in ("intent", "intent.rate")}
    found, states, place = np.zeros((ticks, len(outputs))), None, mind.start
    for first in range(0, ticks, chunk):
        last = min(first + chunk, ticks)
        known = max(0, min(first, int(np.floor((first * T - mind.reaction) / T + 1e-9)) + 1))
        following = mind.asked((first + chunk) * T, _seen(found[:known], outputs, T), place)
        rate = (following - place) / (chunk * T)
        values = {"intent": place + rate * T * np.arange(last - first), "intent.rate": rate}
        for name, column in intent.items():
            rows[first:last, column] += values[name]
        given, states = loaded.run(last - first, rows[first:last], parameters, states)
        found[first:last], place = given[:, :, 0], following
    return found


def _seen(rows, outputs, T):
    columns = {name: rows[:, j] for j, name in enumerate(outputs) if name != "fault"}
    columns |= {name: columns[f"{name}_true"] for name in ("x", "v") if f"{name}_true" in columns}
    return Seen({"t": T * np.arange(len(rows)), **columns})
