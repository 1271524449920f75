"""What a passivity observer and controller did along a record, and for how long the environment was active."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...base.drawing import STYLES, house_style, new_figure
from ...base.shows_itself import ShowsItself
from ...base.telemetry import check_record
from ...errors import AnalysisError
from .energy import energy

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ...base.annotations import Array
    from ...base.telemetry import Telemetry


@dataclass(frozen=True, eq=False)
class PassivityTrace(ShowsItself):
    """Energy at the port along a record, beside what the observer saw and the controller took back.

    Attributes
    ----------
    t : array, shape (N,)
        [s]
    W : array, shape (N,)
        Work done on the environment [J], force and displacement as they acted.
    same_sample : array, shape (N,)
        The sum of F(n) (x(n) - x(n-1)) [J]: the wrong pairing, which hides what the hold generates.
    observed : array, shape (N,), or None
        The observer's W, or the controller's credit [J].
    error : array, shape (N,), or None
        The observer's W less the work at the handle [J]: what an encoder, delay or saturation hid from it.
    dissipated : array, shape (N,), or None
        What a series controller's damper took so far, of force and displacement as they acted [J], before force_max.
    active : (float, float)
        The longest drain: first and last time [s] between which W fell by most from a peak to a later sample.
    drained : float
        By how much it fell then [J]. A spring let go drains what it stored; the rest the environment generated, or
        gave back of what a human had paid before, Eq. (23.9) unbroken.
    """

    t: Array
    W: Array
    same_sample: Array
    observed: Array | None
    error: Array | None
    dissipated: Array | None
    active: tuple[float, float]
    drained: float

    @property
    def passive(self) -> bool:
        """Whether the environment never gave more than it had taken, Eq. (23.9) with nothing stored at the start."""
        return bool(self.W.min() >= -1e-7 * abs(self.W).max())

    def __str__(self) -> str:
        least = int(np.argmin(self.W))
        held = "held" if self.passive else f"violated by {-1e3 * self.W[least]:.4g} mJ at t = {self.t[least]:.4g} s"
        lines = [f"W >= 0 {held}; {1e3 * self.W[-1]:.4g} mJ taken in the end"]
        lines.append(f"at most {1e3 * self.drained:.4g} mJ drawn, from t = {self.active[0]:.4g} s to {self.active[1]:.4g} s")
        if self.error is not None:
            lines.append(f"the observer was wrong by at most {1e3 * abs(self.error).max():.2g} mJ")
        if self.dissipated is not None:
            lines.append(f"the controller's damper dissipated {1e3 * self.dissipated[-1]:.4g} mJ")
        return "\n".join(lines)

    def plot(self) -> Figure:
        """Draw the energy at the port, the observer's own, and the sum with the wrong pairing."""
        with house_style():
            figure = new_figure(height=4.2)
            axes = figure.subplots()
            axes.axvspan(*self.active, color="#e4e4e4", linewidth=0)
            axes.axhline(0, color="#000000", linewidth=0.8)
            axes.plot(self.t, 1e3 * self.W, label="taken, F(n-1) (x(n) - x(n-1))", **STYLES[0])
            axes.plot(self.t, 1e3 * self.same_sample, label="paired F(n) (x(n) - x(n-1))", **STYLES[3])
            if self.observed is not None:
                axes.plot(self.t, 1e3 * self.observed, label="the observer's", **STYLES[1])
            if self.dissipated is not None:
                axes.plot(self.t, 1e3 * self.dissipated, label="dissipated by the controller", **STYLES[2])
            axes.set(xlabel="time t [s]", ylabel="energy [mJ]")
            axes.set_title(f"grey: {1e3 * self.drained:.3g} mJ drawn", fontsize="small")
            axes.legend(loc="best")
        return figure


def passivity_trace(log: Telemetry) -> PassivityTrace:
    """Return the trace of a passivity observer or controller, and the longest time the environment was active.

    Parameters
    ----------
    log : Telemetry
        Of any scene; the channels W, credit and alpha of :func:`hapticlab.laws.passivity_observer` and
        :func:`hapticlab.laws.passivity_controller` are shown where they were recorded.

    Returns
    -------
    PassivityTrace

    Examples
    --------
    >>> import hapticlab as hl
    >>> paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3)
    >>> log = paddle.run(hl.laws.passivity_observer(hl.wall()(k=500)), duration=0.05, x=-0.002, v=0.2, progress=False)
    >>> print(hl.passivity.trace(log))
    W >= 0 violated by 0.1595 mJ at t = 0.042 s; -0.1595 mJ taken in the end
    at most 1.089 mJ drawn, from t = 0.026 s to 0.042 s
    the observer was wrong by at most ... mJ
    """
    check_record(log, "hl.passivity.trace")
    W = energy(log).W
    moved = np.r_[0.0, np.diff(np.asarray(log.channels.get("x_true", log.x), float))]
    observed = log.channels.get("W", log.channels.get("credit"))
    error = log.W - W if "W" in log.channels else None
    dissipated = None
    if "alpha" in log.channels:
        if log.delay:
            raise AnalysisError("hl.passivity.trace: a controller's damper acts late by the delay; needs a record without delay")
        damper = log.alpha * np.r_[0.0, np.diff(log.x)] / log.T
        dissipated = np.r_[0.0, np.cumsum(damper[:-1] * moved[1:])]
    peaks = np.maximum.accumulate(W)
    last = int(np.argmax(peaks - W))
    first = int(np.argmax(W[: last + 1]))
    return PassivityTrace(
        np.asarray(log.t), W, np.cumsum(log.F * moved), observed, error, dissipated,
        (float(log.t[first]), float(log.t[last])), float(W[first] - W[last]),
    )  # fmt: skip
