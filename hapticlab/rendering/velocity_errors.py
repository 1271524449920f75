"""Velocity estimators side by side on one record: how late, how rough, and how dear."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from ..base.drawing import house_style, new_figure, style_of
from ..base.shows_itself import ShowsItself, Tabular
from ..base.telemetry import Telemetry
from ..compiler.boards.cost import cost
from ..compiler.engines.engine import load
from ..compiler.tick.compile_scene import compile
from ..errors import AnalysisError
from ..scene.laws.chapter_laws import virtual_damper
from ..scene.laws.estimators import VelocityEstimate, backward_velocity

if TYPE_CHECKING:
    from collections.abc import Iterable

    from matplotlib.figure import Figure

    from ..base.annotations import Array

MARKERS = "osD^v*P"


@dataclass(frozen=True)
class VelocityError(ShowsItself):
    """What one estimate says of a record whose velocity is known.

    Attributes
    ----------
    name : str
    rms : float
        Of its error [m/s].
    lag : float
        By which it is late [s]: the error's part along the acceleration, v_hat = v - lag a + noise.
    noise : float
        Root mean square of what is left of the error then [m/s].
    cycles : int
        Typical of a tick of a damper with this velocity on the board.
    fits : bool
        Whether that damper fits the board at this T.
    v : array of shape (samples,)
        The estimate [m/s].
    """

    name: str
    rms: float
    lag: float
    noise: float
    cycles: int
    fits: bool
    v: Array = field(repr=False, compare=False)

    def __str__(self) -> str:
        fits = "fits" if self.fits else "does not fit"
        return f"{self.name:<34} {1e3 * self.rms:>9.3g} {1e3 * self.lag:>9.3g} {1e3 * self.noise:>9.3g} {self.cycles:>9}  {fits}"


@dataclass(frozen=True)
class VelocityErrors(Tabular):
    """Estimators on one record, in the order given; prints a table and plots.

    Attributes
    ----------
    rows : tuple of VelocityError
    t, v_true : array of shape (samples,)
        [s], [m/s].
    T : float
        [s]
    board : str
    """

    rows: tuple[VelocityError, ...]
    t: Array = field(repr=False)
    v_true: Array = field(repr=False)
    T: float
    board: str

    def __getitem__(self, name: str) -> VelocityError:
        return next(row for row in self.rows if row.name == name)

    def _sentence(self):
        least = min(self.rows, key=lambda row: row.rms)
        return f"{len(self.rows)} estimates of one velocity, T = {1e3 * self.T:g} ms; the smallest error has {least.name}"

    def __str__(self) -> str:
        titles = f"{'velocity':<34} {'rms mm/s':>9} {'lag ms':>9} {'noise mm/s':>10} {'cycles':>8}"
        head = f"{titles}  {self.board}, T = {1e3 * self.T:g} ms"
        return "\n".join([head, *map(str, self.rows)])

    def plot(self, begin: float = 0.0, end: float | None = None) -> Figure:
        """Draw the estimates from ``begin`` to ``end`` [s], and noise over lag; return the figure."""
        shown = (self.t >= begin) & (self.t <= (self.t[-1] if end is None else end))
        with house_style():
            figure = new_figure(height=6.6)
            traces, trade = figure.subplots(2, 1, height_ratios=(3, 2))
            for number, row in enumerate(self.rows):
                style, marker = style_of(number + 1), MARKERS[number % len(MARKERS)]
                # its marker is in the legend only, which is that of both
                traces.plot(
                    1e3 * self.t[shown],
                    1e3 * row.v[shown],
                    **style,
                    linewidth=1.0,
                    marker=marker,
                    markevery=[],
                    label=row.name,
                )
                trade.plot(1e3 * row.lag, 1e3 * row.noise, color=style["color"], marker=marker, markersize=9)
            traces.plot(1e3 * self.t[shown], 1e3 * self.v_true[shown], color="black", linewidth=2.2, label="true")
            traces.set(xlabel="time t [ms]", ylabel="velocity v [mm/s]")
            trade.set(xlabel="lag [ms]", ylabel="noise, rms [mm/s]")
            trade.set(xlim=(0, None), ylim=(0, None))
            figure.legend(loc="outside upper center", ncols=2)
        return figure


def velocity_errors(
    log: Telemetry, estimates: VelocityEstimate | Iterable[VelocityEstimate] = (), *, board: str = "uno"
) -> VelocityErrors:
    """Compare velocity estimators on the sensed positions of a record whose true velocity is known.

    Each runs in float32 as a board runs it. A longer memory is smoother and later; the backward difference, which is in
    every comparison, is the earliest and the roughest.

    Parameters
    ----------
    log : Telemetry
        Of a simulated paddle with an encoder or noise, which records ``v_true``; without gaps.
    estimates : sequence of VelocityEstimate
    board : str
        Whose cycles are counted, by name: "uno", "pico" or "cortex-m4f".

    Returns
    -------
    VelocityErrors

    Raises
    ------
    AnalysisError
        The record has no true velocity, or what is given is no estimate.

    Examples
    --------
    >>> import numpy as np
    >>> import hapticlab as hl
    >>> hand = hl.Hand(k=400, b=3, intent=lambda t: 0.01 * np.sin(6 * t))
    >>> paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, counts_per_metre=5e4, hand=hand)
    >>> log = paddle.run(hl.wall()(k=0), duration=1.0)
    >>> found = hl.velocity.compare(log, [hl.velocity.filtered(tau="4 ms")])
    >>> [row.name for row in found.rows]
    ['backward difference', 'filtered difference']
    """
    if not isinstance(log, Telemetry) or "v_true" not in log.channels:
        raise AnalysisError(
            "the record has no true velocity; run a simulated paddle with an encoder: SimulatedPaddle(counts_per_metre=...)"
        )
    if log.every != 1 or np.any(log.gap):
        raise AnalysisError("the record has gaps; an estimator needs every sample. Record with every=1")
    estimates = [estimates] if isinstance(estimates, VelocityEstimate) else list(estimates)
    wrong = next((e for e in estimates if not isinstance(e, VelocityEstimate)), None)
    if wrong is not None:
        raise AnalysisError(
            f"{wrong!r} is not an estimate of a velocity; give estimates such as hl.velocity.filtered(tau='4 ms')"
        )
    rows = tuple(_row(estimate, log, board) for estimate in (backward_velocity(), *estimates))
    return VelocityErrors(rows, log.t, log.v_true, log.T, board)


def _row(estimate, log, board):
    program = compile(virtual_damper(velocity=estimate)(B=1), T=log.T)
    v = load(program).run(len(log.x), log.x[:, None]).outputs[:, 0, 0]
    error, acceleration = v - log.v_true, np.gradient(log.v_true, log.T)
    size = acceleration @ acceleration
    lag = -(error @ acceleration) / size if size else 0.0
    noise = error + lag * acceleration
    taken = cost(program, board)
    rms = [float(np.sqrt(np.mean(e**2))) for e in (error, noise)]
    return VelocityError(estimate.name, rms[0], float(lag), rms[1], taken.typical, taken.fits, v)
