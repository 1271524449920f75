"""Velocity by windows that adapt: the longest line that the last positions allow."""

from __future__ import annotations

from typing import TYPE_CHECKING

import sympy as sp

from ...base.arguments import choice, count
from ...errors import SceneError
from ..notation.amount import Amount, amount
from ..notation.parameters import T
from ..notation.symbols import n, signal, when, x
from .estimators import VelocityEstimate, backward_velocity

if TYPE_CHECKING:
    from ...base.annotations import Term


#: samples back that a window may reach: each takes a dozen instructions of every tick
LONGEST_WINDOW = 32
#: no displacement is less [m]
_CLOSED = Amount(-1e30, "m")


def window_velocity(*, deviation: Term, longest: int = 8, fit: str = "end", name: str = "v_window") -> VelocityEstimate:
    """First-order adaptive window: the slope of the longest line that the last samples allow.

    Janabi-Sharifi, Hayward and Chen, *Discrete-time adaptive windowing for velocity estimation*, IEEE Trans. Control
    Systems Technology 8 (2000) 1003-1009. The window grows sample by sample into the past while a line stays within
    ``deviation`` of every sample in it: long, and smooth, where the handle moves evenly; short where it turns.

    Parameters
    ----------
    deviation : float, text or Parameter
        How far a sample may be off the line [m], >= 0: one encoder count, or the peak of the noise.
    longest : int
        Longest window [periods], 1 to 32.
    fit : {"end", "best"}
        ``"end"``: the line through the newest and the oldest sample; work grows with ``longest``. ``"best"``: the line of
        least squares, which is smoother; work grows with the square of ``longest``.
    name : str
        Of its signals.

    Returns
    -------
    VelocityEstimate

    Examples
    --------
    >>> import hapticlab as hl
    >>> hl.velocity.window(deviation="20 um", longest=3).name
    'adaptive window of 3, end fit'
    """
    longest = count("longest", longest, "a window", of="periods", most=LONGEST_WINDOW, error=SceneError)
    choice(
        "fit", fit, ("end", "best"), need="'end' (the newest and the oldest sample) or 'best' (least squares)", error=SceneError
    )
    deviation = amount(deviation, "m", "deviation", "a window", least=0)
    half = window_velocity(deviation=deviation, longest=longest // 2, name=name) if longest > 3 else backward_velocity()
    cheaper = (half, *half.cheaper)
    if fit == "best":
        cheaper = (window_velocity(deviation=deviation, longest=longest, name=name), *cheaper)
    slope, eom = (_end_fit if fit == "end" else _best_fit)(deviation, longest, name)
    v = signal(name, unit="m/s", instead=cheaper)(n)
    return VelocityEstimate(
        v, (*eom, sp.Eq(v, slope / T)), f"adaptive window of {longest}, {fit} fit", cheaper,
        source="Janabi-Sharifi, Hayward and Chen, IEEE Trans. Control Systems Technology 8 (2000) 1003-1009",
        confused_with="a moving average, whose window is as long at rest as in a turn; its lag is half its window, T/2 at least",
    )  # fmt: skip


def _end_fit(deviation, longest, name):
    """The displacement per period and its equations.

    With s_i = (x(n) - x(n-i))/i the line over i periods passes within deviation of every sample between where s_i lies within
    all s_j -+ deviation/j, j < i. These cones only narrow, so that the work grows with longest alone; one that a line has left
    is closed for the longer lines.
    """
    eom = []

    def kept(part, value):
        named = signal(f"{name}_{part}", unit="m")(n)
        eom.append(sp.Eq(named, value))
        return named

    slope = line = x(n) - x(n - 1)
    low, high = kept("low_1", line - deviation), kept("high_1", line + deviation)
    for i in range(2, longest + 1):
        line = kept(f"line_{i}", (x(n) - x(n - i)) / i)
        inside = (line >= low) & (line <= high)
        slope = kept(f"step_{i}", when(inside, line, slope))
        if i < longest:
            low = kept(f"low_{i}", sp.Max(low, line - deviation / i))
            high = kept(f"high_{i}", when(inside, sp.Min(high, line + deviation / i), _CLOSED))
    return slope, tuple(eom if longest > 1 else ())


def _best_fit(deviation, longest, name):
    """The displacement per period and its equations, from the line of least squares over each window."""
    slope, longer, eom = x(n) - x(n - 1), None, []

    def kept(part, unit, value):
        named = signal(f"{name}_{part}", unit=unit)(n)
        eom.append(sp.Eq(named, value))
        return named

    back = [sp.S.Zero, *(x(n) - x(n - j) for j in range(1, longest + 1))]  # how far the handle has come since
    for i in range(2, longest + 1):
        weights = [sp.Rational(6 * (2 * j - i), i * (i + 1) * (i + 2)) for j in range(i + 1)]
        line = kept(f"line_{i}", "m", sp.Add(*(w * d for w, d in zip(weights, back, strict=False))))
        # the line's own place at the newest sample, beside that sample: the mean of its distances
        ahead = kept(f"ahead_{i}", "m", sp.Add(*back[: i + 1]) / (i + 1) - line * sp.Rational(i, 2))
        off = [sp.Abs(back[j] - ahead - j * line) for j in range(i + 1)]
        inside = sp.Max(*off) <= deviation
        longer = kept(f"longer_{i}", "1", when(inside if longer is None else inside & (longer > 0), 1, 0))
        slope = kept(f"step_{i}", "m", when(longer > 0, line, slope))
    return slope, tuple(eom)
