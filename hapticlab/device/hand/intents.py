"""Where a hand means to be, as functions of time: smooth reaches and tremor, which add up."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.arguments import number
from ...base.shows_itself import ShowsItself
from ...errors import PaddleError

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike

    from ...base.annotations import Array, Number


class Intent:
    """A path of the hand: a function of an array of times [s] that gives positions [m]. Two of them add up."""

    def __call__(self, t: ArrayLike) -> Array:
        """Positions [m] at times [s]: each kind of intent has its own."""
        raise NotImplementedError

    def __add__(self, other: Callable[..., Any]) -> Any:
        if not callable(other):
            return NotImplemented
        return other.with_path(self) if hasattr(other, "with_path") else Together((self, other))

    def __radd__(self, other: Callable[..., Any]) -> Any:
        return Together((other, self)) if callable(other) else NotImplemented


@dataclass(frozen=True)
class Together(Intent):
    """The sum of paths."""

    parts: tuple[Callable, ...]

    def __call__(self, t):
        return sum(part(t) for part in self.parts)


@dataclass(frozen=True, kw_only=True)
class MinimumJerk(ShowsItself, Intent):
    """The smooth reach of a hand, which has the least mean square jerk: x = start + (end - start)(10 s^3 - 15 s^4 + 6 s^5).

    Flash and Hogan (1985): s runs from 0 to 1 over the duration. The fastest point is half way, at 1.875 times the mean
    velocity; the largest acceleration is 10/sqrt(3) times distance/duration^2.

    Parameters
    ----------
    start, end : float
        [m]
    duration : float
        [s], > 0.
    begin : float
        When the reach begins [s].

    Examples
    --------
    >>> from hapticlab.device.hand.intents import MinimumJerk
    >>> reach = MinimumJerk(end=0.02, duration=0.4, begin=0.1)
    >>> reach([0.0, 0.3, 1.0]).round(9).tolist()
    [0.0, 0.01, 0.02]
    """

    start: float = 0.0
    end: float
    duration: float
    begin: float = 0.0

    if TYPE_CHECKING:  # it takes texts and keeps floats

        def __init__(self, *, start: Number = 0.0, end: Number, duration: Number, begin: Number = 0.0) -> None: ...

    def __post_init__(self) -> None:
        for name, unit, low in (("start", "m", None), ("end", "m", None), ("begin", "s", None), ("duration", "s", 0)):
            object.__setattr__(self, name, number(name, getattr(self, name), unit, "a reach", above=low, error=PaddleError))

    def _phase(self, t):
        return np.clip((np.asarray(t, float) - self.begin) / self.duration, 0.0, 1.0)

    def __call__(self, t: ArrayLike) -> Array:
        s = self._phase(t)
        return self.start + (self.end - self.start) * s**3 * (10 - 15 * s + 6 * s * s)

    def at(self, t: ArrayLike) -> tuple[Array, Array, Array]:
        """Return position [m], velocity [m/s] and acceleration [m/s^2] at times [s].

        Parameters
        ----------
        t : array_like
            Times [s], any shape.
        """
        s, mean = self._phase(t), (self.end - self.start) / self.duration
        return self(t), mean * 30 * (s * (1 - s)) ** 2, mean / self.duration * 60 * s * (1 - s) * (1 - 2 * s)


@dataclass(frozen=True, kw_only=True)
class Tremor(ShowsItself, Intent):
    """Physiological tremor: a narrow band of noise, drawn once, as a number of sinusoids of random phase.

    The hand's tremor has its peak between 6 and 12 Hz (Lakie et al., J. Physiol. 593, 2015); the amplitude is yours to
    give, for it differs widely between people, postures and tasks.

    Parameters
    ----------
    rms : float
        Root mean square of the intent's tremor [m], >= 0, over a time long beside lines/(high - low). The handle's own
        is what hand and handle make of it.
    low, high : float
        Edges of the band [Hz], 0 < low < high.
    lines : int
        Sinusoids, at even distances within the band and each moved by a random part of one: the sum never repeats.
    seed : int

    Examples
    --------
    >>> import numpy as np
    >>> from hapticlab.device.hand.intents import Tremor
    >>> t = np.arange(0, 20, 1e-3)
    >>> round(1e6 * float(np.std(Tremor(rms=1e-4)(t))), 0)
    100.0
    """

    rms: float
    low: float = 8.0
    high: float = 12.0
    lines: int = 40
    seed: int = 0
    frequencies: np.ndarray = field(init=False, repr=False, compare=False)
    phases: np.ndarray = field(init=False, repr=False, compare=False)

    if TYPE_CHECKING:  # it takes texts and keeps floats

        def __init__(self, *, rms: Number, low: Number = 8.0, high: Number = 12.0, lines: int = 40, seed: int = 0) -> None: ...

    def __post_init__(self) -> None:
        for name, unit, low in (("rms", "m", 0), ("low", "Hz", 0), ("high", "Hz", 0)):
            object.__setattr__(self, name, number(name, getattr(self, name), unit, "a tremor", least=low, error=PaddleError))
        why = "It is the upper limit of the band."
        number("high", self.high, "Hz", "a band of tremor", above=self.low, why=why, error=PaddleError)
        if not isinstance(self.lines, int) or self.lines < 1:
            raise PaddleError(f"lines = {self.lines!r}; a tremor needs a whole number of sinusoids >= 1.")
        draw = np.random.default_rng([self.seed, 0x7E])
        step = (self.high - self.low) / self.lines
        object.__setattr__(self, "frequencies", self.low + step * (np.arange(self.lines) + draw.random(self.lines)))
        object.__setattr__(self, "phases", 2 * np.pi * draw.random(self.lines))

    def __call__(self, t: ArrayLike) -> Array:
        waves = np.sin(2 * np.pi * np.multiply.outer(np.asarray(t, float), self.frequencies) + self.phases)
        return self.rms * np.sqrt(2 / self.lines) * waves.sum(axis=-1)
