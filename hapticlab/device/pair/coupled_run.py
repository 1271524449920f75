"""What two coupled paddles recorded, and how late the link was."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...base.shows_itself import ShowsItself
from .run_plot import plot_coupled
from .sides import BEATS

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ...base.telemetry import Telemetry

#: clocks are compared anew so often [s]
WINDOW = 0.25


@dataclass(frozen=True)
class LinkTimes(ShowsItself):
    """How late one direction of the link was, and how often it spoke.

    Attributes
    ----------
    median, worst : float
        From a sample to the sample at which the other scene had it [s], jitter included; nan where nothing was heard.
    rate : float
        Messages heard in a second [1/s].
    lost : float
        Part of the samples, between the first and the last that were heard, that the other side did not use: lost,
        overtaken or not sent, 0 ... 1.

    Examples
    --------
    >>> print(LinkTimes(median=0.01, worst=0.012, rate=1000.0, lost=0.0))
    10 ms, worst 12 ms, 1000 messages/s, 0 % of the samples unused
    """

    median: float
    worst: float
    rate: float
    lost: float

    def __str__(self) -> str:
        return (
            f"{1e3 * self.median:.3g} ms, worst {1e3 * self.worst:.3g} ms, {self.rate:.0f} messages/s, "
            f"{100 * self.lost:.2g} % of the samples unused"
        )


@dataclass(frozen=True)
class CoupledRun(ShowsItself):
    """The recordings of two coupled paddles.

    Attributes
    ----------
    left, right : Telemetry
    to_right, to_left : LinkTimes
        The link in each direction. Clocks of two boards are compared by the samples of each that were fastest to arrive
        here, so that a delay that all samples have in common is not seen.
    fault : str or None
        What ended it, and on which side.

    Examples
    --------
    >>> import hapticlab as hl
    >>> paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand("pinch"))
    >>> run = hl.devices.TwoPaddles(paddle, paddle, hl.laws.bilateral_coupling()(k=50), delay="5 ms").run(0.1)
    >>> print(run.to_right)
    5 ms, worst 5 ms, 1000 messages/s, 0 % of the samples unused
    """

    left: Telemetry
    right: Telemetry
    to_right: LinkTimes
    to_left: LinkTimes
    fault: str | None = None

    def plot(self) -> Figure:
        """Return a figure: positions of both handles, and the forces of both motors."""
        return plot_coupled(self)

    def __str__(self) -> str:
        lines = [
            f"two paddles: {self.left.scene} / {self.right.scene}",
            f"  left to right  {self.to_right}",
            f"  right to left  {self.to_left}",
        ]
        return "\n".join(lines + [f"  ended: {self.fault}"] * bool(self.fault))


def link_times(sender, receiver):
    """Return the LinkTimes from one Side to another, after a run."""
    sent = np.concatenate([rows["t"] for rows in sender.rows]) if sender.rows else np.zeros(0)
    if not receiver.rows or not len(sent):
        return LinkTimes(np.nan, np.nan, 0.0, 1.0)
    heard, t = (np.concatenate([rows[name] for rows in receiver.rows]) for name in ("heard", "t"))
    new = np.flatnonzero(np.diff(heard, prepend=0.0) != 0)
    if not len(new):
        return LinkTimes(np.nan, np.nan, 0.0, 1.0)
    ticks = (heard[new] - 1) + BEATS * np.cumsum(np.diff(heard[new], prepend=0.0) < -BEATS / 2)
    late = t[new] + _offset(receiver, t[new]) - ticks * sender.T - _offset(sender, ticks * sender.T)
    offered = np.count_nonzero((sent > (ticks[0] - 0.5) * sender.T) & (sent < (ticks[-1] + 0.5) * sender.T))
    rate = (len(new) - 1) / (t[new[-1]] - t[new[0]]) if len(new) > 1 else 0.0
    return LinkTimes(float(np.median(late)), float(late.max()), float(rate), max(0.0, 1 - len(new) / max(1, offered)))


def _offset(side, t):
    """The host's time less a paddle's own at times t [s]: the least that was seen about then, for samples are only late."""
    at, offset = np.array(side.arrivals).T
    near = np.round(at / WINDOW)
    least = np.array([offset[np.abs(near - k) <= 1].min() for k in range(int(near.max()) + 1)])
    return least[np.clip(np.round(t / WINDOW).astype(int), 0, len(least) - 1)]
