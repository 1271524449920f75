"""Motions of a handle as functions of time, for questions about accuracy: what a hand does, with every derivative known."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import sympy as sp

from ...base.arguments import number
from ...base.drawing import STYLES, house_style, new_figure
from ...base.shows_itself import ShowsItself
from ...compiler.algebra.graph import Graph, driven
from ...errors import AnalysisError
from ...scene.notation.derivative import Partial
from ...scene.notation.symbols import t

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike

    from ...base.annotations import Array

#: band of a hand's voluntary motion [Hz]; irrational, so that no period is a whole number of samples
BAND = (math.sqrt(0.5), 5 * math.sqrt(2))
#: of a one-axis paddle, to either side [m], and how fast a hand moves it [m/s]
TRAVEL, SPEED = 0.05, 0.3
#: how slowly a motion that oscillates sets in [s]: position, velocity and acceleration start at zero
ONSET = 0.05


@dataclass(frozen=True, eq=False)
class HandleMotion(ShowsItself):
    """A motion x(t) of the handle, as an expression of time.

    Attributes
    ----------
    name : str
    x : sympy expression of ``hl.t`` [m]
        Smooth but where it has cases, and there continuous with its velocity.
    duration : float
        [s]
    why : str
        What it asks of a scene.
    breaks : tuple of float
        Where its cases change [s].

    Examples
    --------
    >>> import sympy as sp
    >>> import hapticlab as hl
    >>> motion = HandleMotion("press", 0.01 * hl.t**3, 1.0)
    >>> [float(part[0]) for part in motion.at([1.0])]
    [0.01, 0.03, 0.06]
    """

    name: str
    x: sp.Expr
    duration: float
    why: str = ""
    breaks: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        expr = sp.sympify(self.x)
        moving = any(hasattr(type(e), "role") for e in expr.atoms(sp.Function))
        if moving or expr.free_symbols - {t}:
            raise AnalysisError(f"{self.name}: x = {self.x}; a motion of the handle needs an expression of hl.t and numbers")
        if not (math.isfinite(self.duration) and self.duration > 0):
            raise AnalysisError(f"{self.name}: duration = {self.duration} s; needs a finite duration > 0 s")

    def at(self, times: ArrayLike) -> tuple[Array, Array, Array]:
        """Return (x, v, a) at an array of times [s]: three arrays, in m, m/s, m/s^2.

        Parameters
        ----------
        times : array_like
            [s], one dimension.
        """
        return tuple(self.derivatives(times, 2))

    def derivatives(self, times: ArrayLike, order: int) -> Array:
        """Return x and its derivatives up to an order at an array of times: array (order + 1, times).

        Parameters
        ----------
        times : array_like
            [s], one dimension.
        order : int
            Highest derivative, >= 0.
        """
        times, (graph, wanted) = np.atleast_1d(np.asarray(times, float)), _translated(sp.sympify(self.x), order)
        angles = {u: 2 * np.pi * float(u.args[0]) * times for u in graph.variables if isinstance(u, driven)}
        found = graph.evaluate(wanted, {t: times} | angles)
        return np.array([np.broadcast_to(part, times.shape) for part in found])

    def plot(self) -> Figure:
        """Return a figure: position and velocity over time."""
        t = np.linspace(0.0, self.duration, 1000)
        position, velocity, _ = self.at(t)
        with house_style():
            figure = new_figure(height=4.2)
            panels = figure.subplots(2, 1, sharex=True)
            panels[0].plot(t, 1e3 * position, **STYLES[0])
            panels[0].set(ylabel="handle position x [mm]")
            panels[0].set_title(f"{self.name}: {self.why}" if self.why else self.name, fontsize="small", wrap=True)
            panels[1].plot(t, 1e3 * velocity, **STYLES[0])
            panels[1].set(xlabel="time t [s]", ylabel="velocity v [mm/s]")
        return figure

    def scaled(self, factor: float) -> HandleMotion:
        """Return the same motion, scaled by a factor.

        Parameters
        ----------
        factor : float
            Of positions, velocities and accelerations.
        """
        return HandleMotion(self.name, factor * self.x, self.duration, self.why, self.breaks)

    def __str__(self) -> str:
        return f"{self.name}: {self.duration:g} s" + (f", {self.why}" if self.why else "")


@functools.lru_cache(maxsize=32)
def _translated(expr, order):
    """Return a graph with an expression of time and its derivatives, which takes longer than to evaluate them."""
    graph, wanted = Graph(), [expr]
    for _ in range(order):
        wanted.append(Partial(wanted[-1], t))
    graph.variables_of(wanted)  # translates them, and so finds the angles
    return graph, wanted


def handle_motions(
    scene: object = None, paddle: object = None, *, band: tuple[float, float] = BAND, travel: float = TRAVEL, seed: int = 0
) -> tuple[HandleMotion, ...]:
    """Motions that together show how accurate a scene is: those of a hand at its slowest, its quickest and in between.

    Parameters
    ----------
    scene, paddle : optional
        What they are for. A hand moves alike whatever it feels, so nothing depends on them.
    band : (low, high)
        Of the hand [Hz], 0 < low < high. Its edges should have no common multiple with the sampling period, which would
        hide errors.
    travel : float
        Of the paddle to either side [m], > 0. Amplitudes are 0.2 to 0.9 of it, or what the hand reaches at 0.3 m/s.
    seed : int
        Of the recorded-hand motion's phases.

    Returns
    -------
    tuple of HandleMotion

    Examples
    --------
    >>> [motion.name for motion in handle_motions()]
    ['slow sinusoid', 'quick sinusoid', 'push', 'drift', 'hand']
    """
    low, high = band
    if not 0 < low < high < math.inf:
        raise AnalysisError(f"band = {band}; needs 0 < low < high in Hz, such as (0.7, 7)")
    travel = number("travel", travel, "m", "a motion", above=0)
    reach, knots = 0.43 * travel, (0.25, 0.5, 0.75)
    rise = 2 * reach * minimum_jerk(t / knots[0])
    back = rise.subs(t, t - knots[1])
    push = sp.Piecewise((rise, t < knots[0]), (2 * reach, t < knots[1]), (2 * reach - back, t < knots[2]), (0, True))
    return (
        _sinusoid("slow sinusoid", low, reach, 1.0 / low, "the lower edge of the band"),
        _sinusoid("quick sinusoid", high, reach, 4.0 / high, "the upper edge of the band"),
        HandleMotion("push", push, 1.0, "into contact and back, with minimum jerk", knots),
        HandleMotion("drift", reach * minimum_jerk(t) / 2, 1.0, "slow: shows the loss of small differences"),
        HandleMotion("hand", _hand(low, high, reach, seed), 1.5, f"a hand's mixture of frequencies, seed {seed}"),
    )


def minimum_jerk(s):
    """Return 10 s^3 - 15 s^4 + 6 s^5, which goes from 0 to 1 with the least jerk (Flash and Hogan, 1985)."""
    return s**3 * (10 - 15 * s + 6 * s**2)


def _onset():
    return 1 - sp.exp(-((t / ONSET) ** 2))


def _sinusoid(name, f, reach, duration, why):
    amplitude = min(reach, SPEED / (2 * math.pi * f))
    return HandleMotion(name, amplitude * sp.sin(2 * sp.pi * sp.Float(f) * t) * _onset(), duration, f"{f:.3g} Hz, {why}")


def _hand(low, high, reach, seed):
    """Return a sum of eight sines over the band, each as fast as the others, their phases drawn."""
    phases = np.random.default_rng(seed).uniform(0, 2 * np.pi, 8)
    frequencies = np.geomspace(low, high, 8)
    sizes = np.minimum(reach, SPEED / (2 * np.pi * frequencies)) / math.sqrt(8)
    terms = [
        a * (sp.sin(2 * sp.pi * sp.Float(f) * t + sp.Float(p)) - sp.Float(math.sin(p)))
        for a, f, p in zip(sizes.tolist(), frequencies.tolist(), phases.tolist(), strict=True)
    ]
    return sp.Add(*terms) * _onset()
