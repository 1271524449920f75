"""Dry friction compensated beyond its limit, in simulation: with this period, delay, encoder and width of the sign."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from ..base.arguments import number, what_is
from ..base.drawing import WARM, house_style, new_figure
from ..base.shows_itself import ShowsItself
from ..base.units import in_si
from ..device.simulated.closed_loop import link, load_linked
from ..device.simulated.simulated_paddle import SimulatedPaddle
from ..errors import AnalysisError
from ..scene.laws.compensation import damping_compensation
from .compensation_limit import CompensationLimit, compensation_limit

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..base.annotations import Array, PlantEngine
    from ..scene.laws.estimators import VelocityEstimate

#: parts of the Coulomb friction looked at side by side, and how often the gap around the limit is divided again
LANES, ROUNDS = 33, 3
#: a run lasts so many times what the damping left needs to take all but 1/e of a motion, within bounds [s]
SETTLED, SHORTEST, LONGEST = 25.0, 1.0, 20.0
#: less than so much of what a handle needs to keep moving is trembling: it stretches the hand's spring until the friction
#: yields, and a free one is faster than the width of the sign
TREMBLING = 0.2
#: samples that are simulated at a time: memory for a few dozen lanes
CHUNK = 4000


@dataclass(frozen=True, eq=False)
class OverCompensation(ShowsItself):
    """What a paddle does for ever when its dry friction is compensated, over the part that is; prints and plots.

    Attributes
    ----------
    limit : float
        Least part of the Coulomb friction from which on it keeps moving, found by simulation.
    ideal : CompensationLimit
        Its closed forms, of a short period and a narrow ``speed``.
    viscous, speed : float
        Compensated part [1] of the viscous damping, and width of the sign [m/s].
    dry : array of shape (lanes,)
        Parts of the Coulomb friction that were simulated first.
    motion : array of shape (lanes,)
        The amplitude [m] about the hand's spring, or the speed [m/s] of a free handle, at the end; 0 at rest. The noise
        of a sensor makes a handle tremble, which does not count as motion that stays.
    expected : array of shape (lanes,)
        The same by the closed form.
    duration : float
        Of each run [s].
    """

    limit: float
    ideal: CompensationLimit
    viscous: float
    speed: float
    dry: Array
    motion: Array
    expected: Array
    duration: float

    def __str__(self) -> str:
        moves = "hunts about the hand's spring" if self.ideal.k else "keeps moving after a push,"
        return (
            f"{moves} above dry = {self.limit:.5g} at viscous = {self.viscous:g}, in simulations of {self.duration:.3g} s; "
            f"the limit for a short period and a narrow sign is {self.ideal.hunts_from(self.viscous):.5g}"
        )

    def plot(self) -> Figure:
        """Draw the motion that stays over the part that is compensated, simulated and by its closed form; a figure."""
        spring = self.ideal.k > 0
        scale, name = (1e3, "remaining amplitude [mm]") if spring else (1.0, "remaining speed [m/s]")
        jump = self.ideal.hunts_from(self.viscous) * np.array([1, 1 + 1e-9])
        fine = np.sort(np.r_[np.linspace(self.dry[0], self.dry[-1], 200), jump])
        closed = _expected(self.ideal, self.viscous, fine)
        with house_style():
            figure = new_figure(height=3.8)
            axes = figure.subplots()
            axes.plot(fine, scale * closed, color="black", linestyle="--", label="closed form")
            axes.plot(self.dry, scale * self.motion, color=WARM, linestyle="", marker="o", ms=4, label="simulated")
            axes.axvline(self.limit, color="0.5", linestyle=":", label="simulated limit")
            axes.set_xlabel(f"fraction of the Coulomb friction compensated, of {self.ideal.coulomb:g} N")
            axes.set_ylabel(name)
            axes.legend(loc="upper left")
        return figure


def over_compensation(
    paddle: SimulatedPaddle,
    *,
    speed: float | str,
    viscous: float = 0.0,
    sign: Literal["smooth", "dead_zone"] = "dead_zone",
    velocity: VelocityEstimate | None = None,
    up_to: float | None = None,
    duration: float | None = None,
    engine: PlantEngine = "auto",
) -> OverCompensation:
    """Simulate a paddle whose dry friction is compensated more and more, until it keeps moving by itself.

    Each run begins with a kick: beyond the motion that the closed forms expect, from where it dies down or stays. A
    wide sign and a velocity that lags compensate late, so that the limit lies above the ideal one: for a free handle with
    the dead zone at 1 + (damping left) speed/coulomb.

    Parameters
    ----------
    paddle : SimulatedPaddle
        With coulomb > 0 and a hand that rests.
    speed, sign, velocity
        Of :func:`~hapticlab.scene.laws.compensation.damping_compensation`.
    viscous : float
        Part of the viscous damping that is compensated; below its own limit.
    up_to : float, optional
        Largest part of the Coulomb friction; half as much again as the ideal limit unless given.
    duration : float, optional
        Of a run [s]; chosen by the damping left unless given.
    engine : {"auto", "llvm", "wasm", "interpreter"}

    Returns
    -------
    OverCompensation

    Raises
    ------
    AnalysisError
        No friction, a hand that moves, or nothing that keeps moving up to ``up_to``.

    Examples
    --------
    >>> import hapticlab as hl
    >>> paddle = hl.SimulatedPaddle(m=0.05, b=0.4, T=1e-3, coulomb=0.02)
    >>> round(hl.design.over_compensation(paddle, speed="2 mm/s").limit, 3)  # doctest: +SKIP
    1.04
    """
    if not isinstance(paddle, SimulatedPaddle):
        raise AnalysisError(
            f"paddle is {what_is(paddle)}; over-compensation runs in simulation only. Use hl.SimulatedPaddle(...)"
        )
    ideal = compensation_limit(paddle, velocity=velocity if velocity and velocity.is_linear else None)
    number("coulomb", paddle.coulomb, "N", above=0, why="without dry friction there is nothing to compensate")
    if paddle.hand is not None and paddle.hand.moves:
        raise AnalysisError(
            "the intent of the hand moves, so the hand itself would keep moving. Give intent=None, or a position in m"
        )
    if not 0 <= viscous < ideal.viscous:
        raise AnalysisError(
            f"viscous = {viscous:g} makes the handle run away by itself; needs 0 <= viscous < {ideal.viscous:.4g}"
        )
    width = in_si(speed, "m/s", "speed")
    scene = damping_compensation(b=paddle.b, coulomb=paddle.coulomb, speed=width, sign=sign, velocity=velocity)
    first = ideal.hunts_from(viscous)
    settling = (2 if ideal.k else 1) * ideal.m / ideal.left(viscous)
    duration = duration or min(max(SETTLED * settling, SHORTEST), LONGEST)
    runs = _Runs(paddle, scene(viscous=viscous, dry=1.0), ideal, viscous, width, duration, engine)
    dry = np.linspace(0.5, up_to or 1.5 * first, LANES)
    motion = runs(dry)
    limit = _first_moving(runs, dry, motion)
    return OverCompensation(limit, ideal, viscous, width, dry, motion, _expected(ideal, viscous, dry), duration)


def _first_moving(runs, dry, motion):
    for _ in range(ROUNDS):
        moving = np.flatnonzero(motion > runs.trembling)
        if not len(moving):
            raise AnalysisError(f"the handle comes to rest at all values up to dry = {dry[-1]:.4g}; give a larger up_to")
        if moving[0] == 0:
            raise AnalysisError(
                f"the handle keeps moving even at dry = {dry[0]:.4g}; compensate less of the viscous damping, or wait longer"
            )
        below, above = dry[moving[0] - 1], dry[moving[0]]
        dry = np.linspace(below, above, LANES)
        motion = runs(dry)
    return float(dry[np.flatnonzero(motion > runs.trembling)[0]])


def _expected(ideal, viscous, dry):
    """Return the amplitude or the speed that stays by the closed forms."""
    formula = ideal.hunting if ideal.k else ideal.speed
    return np.array([formula(viscous, part) for part in dry])


class _Runs:
    """Paddles side by side, kicked, each with its own part of the friction compensated."""

    def __init__(self, paddle, scene, ideal, viscous, width, duration, engine):
        self.paddle, self.ideal, self.viscous, self.width = paddle, ideal, viscous, width
        self.program = paddle.program(scene)
        linked = link(self.program, paddle)
        self.names = [c.name for c in linked.parameters]
        self.outputs = [c.name for c in linked.outputs]
        self.loaded = load_linked(linked, engine)
        self.inputs = paddle.inputs(paddle.ticks(duration))
        hand = paddle.hand
        self.rest = 0.0 if hand is None or hand.intent is None else hand.intent
        self.trembling = TREMBLING * (paddle.coulomb / ideal.k if ideal.k else width)

    def __call__(self, dry):
        """Return the amplitude or the speed that stays, for each part."""
        rows = np.array([*self.program.values, *self.paddle.plant_values(self.rest)])
        rows = np.repeat(rows[:, None], len(dry), axis=1)
        rows[self.names.index("dry")] = dry
        kick = 1.3 * _expected(self.ideal, self.viscous, dry)
        if self.ideal.k:
            least = self.paddle.coulomb / self.ideal.k
            rows[self.names.index("start.x")] = self.rest + np.maximum(kick, 1.3 * least)
        else:
            rows[self.names.index("start.v")] = np.maximum(kick, 5 * self.width)
        states, low, high, fast = None, np.inf, -np.inf, 0.0
        for start in range(0, len(self.inputs), CHUNK):
            inputs = self.inputs[start : start + CHUNK]
            outputs, states = self.loaded.run(len(inputs), inputs, rows, states)
            last = outputs[max(math.ceil(0.75 * len(self.inputs)) - start, 0) :]
            if len(last):
                x, v = (last[:, self.outputs.index(q + "_true" * (q + "_true" in self.outputs))] for q in "xv")
                low, high = np.minimum(low, x.min(axis=0)), np.maximum(high, x.max(axis=0))
                fast = abs(v[-1])
        return (high - low) / 2 if self.ideal.k else fast
