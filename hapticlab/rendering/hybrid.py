"""The wall that the laws mean: handle, hand and unilateral wall in continuous time, every crossing located."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.drawing import axis_label, house_style, new_figure, style_of
from ..base.shows_itself import ShowsItself
from ..errors import AnalysisError
from .model import WallModel

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from ..base.annotations import Array
    from ..base.telemetry import Telemetry
    from ..device.device import AnyDevice
    from ..device.hand.hand import Hand

#: of a mode's own time, how long a piece of the motion is: it turns round once at most, and few terms are all its digits
PART = math.pi / 8
TERMS = 18
#: crossings in one period past which the handle is said to rest on the boundary
MOST = 1000


@dataclass(frozen=True, eq=False)
class HybridMotion(ShowsItself):
    """The exact motion against a wall, at the samples.

    Attributes
    ----------
    t, x, v, F : array, shape (N,)
        [s], [m], [m/s], [N]; F is the wall's force at that instant.
    crossings : array, shape (M,)
        When the boundary is crossed [s].
    speeds : array, shape (M,)
        At the crossings [m/s]; positive where the handle enters.
    x_o : float
        The boundary [m].
    model : WallModel
    """

    t: Array
    x: Array
    v: Array
    F: Array
    crossings: Array
    speeds: Array
    x_o: float
    model: WallModel

    @property
    def energy(self) -> Array:
        """Kinetic energy and what the hand's and the wall's springs and the push hold [J], shape (N,)."""
        m, inside = self.model, self.F != 0
        depth = np.where(inside, (self.F - m.B * self.v) / m.K, 0.0)
        return m.M * self.v**2 / 2 + m.k * self.x**2 / 2 - m.push * self.x + m.K * depth**2 / 2

    @property
    def begins_inside(self) -> bool:
        """Whether the start lies inside the wall, or on its boundary and going in."""
        depth, v = self.x[0] - self.x_o, self.v[0]
        return bool(depth > 0 or (depth == 0 and (v > 0 or (v == 0 and self.x[1] > self.x_o))))

    def plot(self, *logs: Telemetry) -> Figure:
        """Draw the motion, where it crosses the boundary, and runs of rendered walls beside it, from one start."""
        with house_style():
            figure = new_figure(height=3.6)
            axes = figure.subplots()
            scale, label = axis_label("x", "m")
            axes.plot(1e3 * self.t, scale * self.x, label="the wall itself", **style_of(0))
            axes.plot(1e3 * self.crossings, np.full(len(self.crossings), scale * self.x_o), "k|", markersize=12)
            for number, log in enumerate(logs, 1):
                x = log.channels.get("x_true", log.x)
                axes.plot(1e3 * log.t, scale * x, label=log.scene, marker=".", **style_of(number))
            axes.axhline(scale * self.x_o, color="black", linewidth=0.8)
            axes.set(xlabel="time t [ms]", ylabel=label)
            axes.legend(loc="lower left", bbox_to_anchor=(0, 1), ncols=3, fontsize="small")
        return figure

    def __str__(self) -> str:
        entered = self.speeds > 0
        begins, times = self.begins_inside, int(np.count_nonzero(entered)) + self.begins_inside
        return (
            f"{len(self.t)} samples over {self.t[-1]:g} s; {times} {'time' if times == 1 else 'times'} into the wall"
            + (", it begins inside" if begins else "")
            + (
                f", {'then' if begins else 'first'} at {self.crossings[entered][0]:.6g} s with {self.speeds[entered][0]:.4g} m/s"
                if any(entered)
                else ""
            )
            + f"\n  {self.model}"
        )


def hybrid_wall(
    paddle: AnyDevice,
    *,
    K: float,
    B: float = 0.0,
    duration: float,
    x: float = 0.0,
    v: float = 0.0,
    x_o: float = 0.0,
    hand: Hand | None = None,
) -> HybridMotion:
    """Exact motion of handle and hand against the wall itself, without sampling: the ideal of a rendered wall.

    F = K p + B p' where p = x - x_o >= 0, else 0, in continuous time. In each mode the motion is a power series of all
    its digits; a crossing is bracketed, a turning point beyond the boundary included, and bisected to the last one.

    Parameters
    ----------
    paddle, K, B, hand
        As in :func:`digital_gains`; only mass, damping and T of the paddle count.
    duration, x, v, x_o : float
        [s], and the start and the boundary in [m], [m/s], [m].

    Returns
    -------
    HybridMotion

    Examples
    --------
    Half a swing in a wall lasts pi/w:

    >>> import hapticlab as hl
    >>> motion = hl.laws.hybrid_wall(hl.SimulatedPaddle(m=0.05, b=0, T=1e-3), K=500, duration=0.1, x=-0.01, v=0.5)
    >>> motion.crossings.round(9).tolist(), round(0.02 + 3.141592653589793 / 100, 9)
    ([0.02, 0.051415927], 0.051415927)
    """
    model = WallModel.of(paddle, K=K, B=B, hand=hand)
    count = round(duration / model.T)
    if not count >= 1:
        raise AnalysisError(f"duration = {duration!r} s; needs at least one period T = {model.T:g} s")
    path = _Path(model, x_o, x - x_o, v * model.T)
    rows = [path.state]
    for _ in range(count):
        path.fly(1.0)
        rows.append(path.state)
    p, w, inside = (np.array(column) for column in zip(*rows, strict=True))
    rate = w / model.T
    F = np.where(inside, model.K * p + model.B * rate, 0.0)
    when, speed = np.array(path.crossings).reshape(-1, 2).T
    t: NDArray[Any] = np.arange(count + 1) * model.T
    return HybridMotion(t, p + x_o, rate, F, when * model.T, speed / model.T, x_o, model)


class _Path:
    """A state (p, w, inside) that flies on in pieces, each a power series; times in periods, lengths in metres."""

    def __init__(self, model, x_o, p, w):
        self.now, self.crossings = 0.0, []
        self.outer = (model.push - model.k * x_o) / model.K
        self.state = (p, w, p >= 0)
        self.rates = {wall: model.rates(wall) for wall in (True, False)}

    def fly(self, periods):
        """Go on for a time, through every crossing."""
        end, most = self.now + periods, len(self.crossings) + MOST
        while self.now < end:
            beta, kappa, _ = self.rates[self.state[2]]
            h = min(end - self.now, PART / max(math.sqrt(kappa), beta, 1e-300))
            motion = self._series()
            at = self._crossing(motion, h)
            self.now = end if at is None and h == end - self.now else self.now + (h if at is None else at)
            p, w = motion(h if at is None else at)
            self.state = (p, w, self.state[2])
            if at is not None:
                self.state = (0.0, w, not self.state[2])
                self.crossings.append((self.now, w))
            if len(self.crossings) > most:
                raise AnalysisError("the handle rests on the boundary, which it crosses endlessly within one period")

    def _series(self):
        """Return the motion from the state on as a function of time, by its power series."""
        p, w, inside = self.state
        beta, kappa, mu = self.rates[inside]
        c = [p, w, (mu * self.outer - kappa * p - beta * w) / 2]
        for i in range(1, TERMS):
            c.append(-(kappa * c[i] + beta * (i + 1) * c[i + 1]) / ((i + 1) * (i + 2)))

        def motion(at):
            position = rate = 0.0
            for coefficient in reversed(c):
                rate = rate * at + position
                position = position * at + coefficient
            return position, rate

        return motion

    def _crossing(self, motion, h):
        """Return when the side is left, within h, or None."""
        inside = self.state[2]
        p, w, _ = self.state
        if inside and p == 0.0 and (w < 0 or (w == 0 and self.outer < 0)):
            return 0.0

        def gone(at):
            return motion(at)[0] < 0 if inside else motion(at)[0] >= 0

        turned = (motion(h)[1] > 0) != (w > 0)
        if turned:
            turn = _bisect(lambda at: (motion(at)[1] > 0) != (w > 0), h)
            if gone(turn):
                return _bisect(gone, turn)
        return _bisect(gone, h) if gone(h) else None


def _bisect(true, high):
    """Return the first number found from which on a condition is true, which it is at ``high``.

    Not by SciPy: after a crossing the motion starts at p = 0, which a search for a change of sign would take for the
    next.
    """
    low = 0.0
    while low < (middle := (low + high) / 2) < high:
        low, high = (low, middle) if true(middle) else (middle, high)
    return high
