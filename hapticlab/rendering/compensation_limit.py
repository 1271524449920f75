"""How much of a paddle's friction may be compensated before the paddle runs away, and what it then does."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..base.arguments import number
from ..base.drawing import house_style, new_figure
from ..base.shows_itself import ShowsItself
from ..device.device import Device, known
from ..errors import AnalysisError
from ..limits.loop import Loop
from ..limits.stability import crossings, stability_limit
from ..scene.laws.compensation import damping_compensation

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..device.device import AnyDevice
    from ..scene.laws.estimators import VelocityEstimate

#: relative distance from a crossing at which the poles say whether it counts
NEAR = 1e-6


@dataclass(frozen=True)
class CompensationLimit(ShowsItself):
    """The fractions of the device's friction that can be compensated; ``print`` shows them in words.

    Attributes
    ----------
    viscous : float
        Largest part of b [1]: from there on a pole lies outside the unit circle. Exact for the sampled loop.
    frequency : float
        Where that pole turns [Hz]; 0 where the handle drifts off without turning.
    dry : float
        Largest part of the Coulomb friction at viscous = 0: 1, or where the paddle begins to hunt about its hand's
        spring.
    m, b, k : float
        Of handle and hand: mass [kg], damping at the least [N s/m], stiffness [N/m].
    b_device, coulomb : float
        What is compensated: the device's own damping [N s/m] and Coulomb friction [N], as they are believed to be.
    T : float
        Sampling period [s].
    b_least, coulomb_least : float
        What they may be at the least [N s/m], [N]; the limits hold from there on.
    """

    viscous: float
    frequency: float
    m: float
    b: float
    k: float
    b_device: float
    coulomb: float
    T: float
    b_least: float
    coulomb_least: float

    @property
    def dry(self) -> float:
        """The fraction of the Coulomb friction that can be compensated where no viscous friction is."""
        return self.hunts_from(0.0)

    def left(self, viscous: float) -> float:
        """Return the remaining damping [N s/m], negative if the handle is driven.

        Parameters
        ----------
        viscous : float
            Fraction of the viscous damping that is compensated, >= 0.
        """
        return self.b - viscous * self.b_device

    def hunts_from(self, viscous: float) -> float:
        """Return the fraction of the Coulomb friction above which the paddle, after a push, keeps moving for ever.

        Without a hand's spring that is 1. About a spring the handle must break away at every turn, so that more is
        needed: 2/(1 + r), where r is the part of its swing that half a period with the damping left keeps. Of sampling
        period and width ``speed`` to zero. Less by as much as the friction may be less than believed.

        Parameters
        ----------
        viscous : float
            Fraction of the viscous damping that is compensated, >= 0.
        """
        kept = self._kept(viscous)
        sure = self.coulomb_least / self.coulomb if self.coulomb else 1.0
        return 2 / (1 + kept) * sure if self.k and kept < 1 else sure

    def speed(self, viscous: float, dry: float) -> float:
        """Return the steady speed [m/s] of a free handle that is over-compensated: (dry coulomb - coulomb_least)/(damping left).

        0 where it comes to rest, infinite where nothing holds it. Exact for the sampled loop and any estimate of v,
        with ``sign="dead_zone"``; for ``"smooth"`` where it is far beyond ``speed``.

        Parameters
        ----------
        viscous : float
            Fraction of the viscous damping that is compensated, >= 0.
        dry : float
            Fraction of the Coulomb friction that is compensated, >= 0.
        """
        self._free("a steady speed")
        if viscous >= self.viscous:
            return math.inf
        return max(self._excess(dry) / self.left(viscous), 0.0)

    def kick(self, viscous: float, dry: float) -> float:
        """Return the speed [m/s] above which a free handle runs away, although Coulomb friction holds it at rest.

        (coulomb_least - dry coulomb)/(-damping left) where more than all viscous damping is compensated; infinite where
        it is not.

        Parameters
        ----------
        viscous : float
            Fraction of the viscous damping that is compensated, >= 0.
        dry : float
            Fraction of the Coulomb friction that is compensated, >= 0.
        """
        self._free("a kick")
        if viscous <= self.viscous:
            return math.inf
        return max(self._excess(dry) / self.left(viscous), 0.0)

    def hunting(self, viscous: float, dry: float) -> float:
        """Return the amplitude [m] of the limit cycle about the hand's spring; 0 where the paddle comes to rest.

        g/k (1 + r)/(1 - r) with g = dry coulomb - coulomb_least the force left over: over half a period the handle
        swings about g/k and keeps the part r of its swing. Infinite where the damping left is not positive.

        Parameters
        ----------
        viscous : float
            Fraction of the viscous damping that is compensated, >= 0.
        dry : float
            Fraction of the Coulomb friction that is compensated, >= 0.
        """
        if not self.k:
            raise AnalysisError("no spring to hunt about: the hand has k = 0 N/m. Use speed(viscous, dry)")
        if dry <= self.hunts_from(viscous):
            return 0.0
        kept = self._kept(viscous)
        return self._excess(dry) / self.k * (1 + kept) / (1 - kept) if kept < 1 else math.inf

    def _excess(self, dry):
        """Return the force [N] that compensates more than there is."""
        return dry * self.coulomb - self.coulomb_least

    def _kept(self, viscous):
        """The ratio of two successive half swings."""
        if not self.k:
            return 1.0
        ratio = self.left(viscous) / (2 * math.sqrt(self.k * self.m))
        return 0.0 if ratio >= 1 else math.exp(-math.pi * ratio / math.sqrt(1 - ratio**2)) if ratio > -1 else math.inf

    def _free(self, what):
        if self.k:
            raise AnalysisError(f"{what} needs a free handle; the hand's k = {self.k:g} N/m holds it. Use hunting()")

    def __str__(self) -> str:
        at = f", turning at {self.frequency:.4g} Hz" if self.frequency else ", drifting off"
        lines = [
            f"damping compensation: m = {self.m:g} kg, b = {self.b:g} N s/m, k = {self.k:g} N/m, T = {self.T:g} s",
            f"  viscous    up to {self.viscous:.6g} of {self.b_device:g} N s/m{at}: exact linear stability of this plant",
        ]
        if self.coulomb:
            then = "hunts about the hand's spring" if self.k else "keeps moving after a push"
            lines.append(f"  dry        up to {self.dry:.6g} of {self.coulomb:g} N at viscous = 0; above that, it {then}")
        if self.b_least < self.b_device or self.coulomb_least < self.coulomb:
            friction = f", Coulomb friction from {self.coulomb_least:.6g} N" if self.coulomb else ""
            lines.append(f"  for every device with b from {self.b_least:.6g} N s/m{friction} up to these values")
        return "\n".join(lines)

    def plot(self) -> Figure:
        """Draw the behaviour of the paddle over the two fractions, or over the one that it has; return the figure."""
        if not self.coulomb:
            return self._plot_viscous()
        parts = np.linspace(0, self.viscous, 200)
        dry = np.array([self.hunts_from(part) for part in parts])
        wide, tall, middle = 1.35 * dry.max(), 1.25 * self.viscous, 0.5 * self.viscous
        with house_style():
            figure = new_figure(height=4.2)
            axes = figure.subplots()
            axes.fill_between([0, wide], self.viscous, tall, color="0.7", linewidth=0)
            axes.fill_betweenx(parts, dry, wide, color="0.88", linewidth=0)
            axes.axhline(self.viscous, color="black", label="a pole crosses the unit circle")
            axes.plot(dry, parts, color="black", linestyle="--", label="the remaining force keeps it moving")
            for place, words in (
                ((0.5 * wide, 1.125 * self.viscous), "runs away"),
                ((0.5 * self.hunts_from(middle), middle), "comes to rest"),
                (((self.hunts_from(middle) + wide) / 2, middle), "hunts" if self.k else "keeps moving\nafter a push"),
            ):
                axes.text(*place, words, ha="center", va="center")
            axes.set(xlim=(0, wide), ylim=(0, tall))
            axes.set_xlabel(f"fraction of the Coulomb friction compensated, of {self.coulomb:g} N")
            axes.set_ylabel(f"fraction of the damping compensated,\nof {self.b_device:g} N s/m")
            figure.legend(loc="outside upper center", ncols=2)
        return figure

    def _plot_viscous(self):
        """Draw the part of the damping that may be compensated, on a paddle without dry friction."""
        end = 1.25 * self.viscous
        with house_style():
            figure = new_figure(height=1.9)
            axes = figure.subplots()
            axes.axvspan(self.viscous, end, color="0.7", linewidth=0)
            axes.axvline(self.viscous, color="black", label=f"a pole crosses the unit circle: {self.viscous:.4g}")
            axes.text(self.viscous / 2, 0.5, "comes to rest", ha="center", va="center")
            axes.text((self.viscous + end) / 2, 0.5, "runs away", ha="center", va="center")
            axes.set(xlim=(0, end), ylim=(0, 1), yticks=[])
            axes.set_xlabel(f"fraction of the damping compensated, of {self.b_device:g} N s/m")
            figure.legend(loc="outside upper center")
        return figure


def compensation_limit(
    paddle: AnyDevice,
    *,
    velocity: VelocityEstimate | None = None,
    b_least: float | None = None,
    coulomb_least: float | None = None,
) -> CompensationLimit:
    """Largest part of a paddle's friction that :func:`~hapticlab.scene.laws.compensation.damping_compensation` may cancel.

    The viscous part is a pole on the unit circle of the sampled loop, with hand, delay and the lag of the velocity. A
    free handle drifts off at viscous = 1 + b_hand/b whatever the lag, for at constant speed every estimate is right;
    about a hand's spring it is thrown into an oscillation, where the lag counts. The dry part is of the exact motion
    between reversals, in the limit of a short period and a narrow ``speed``.

    Parameters
    ----------
    paddle : SimulatedPaddle or Device
        Its m, b > 0, T, delay, coulomb, hand and velocity are read.
    velocity : VelocityEstimate, optional
        A linear one; the paddle's own v(n) unless given.
    b_least, coulomb_least : float, optional
        What b [N s/m] and coulomb [N] may be in truth, at the least: the lower ends of the intervals that they were
        identified with. The parts found are of the paddle's b and coulomb, and safe from there up to these.

    Returns
    -------
    CompensationLimit

    Raises
    ------
    AnalysisError, SceneError
        Without damping, or where it may be zero, there is nothing to compensate; a window that adapts has no poles.

    Examples
    --------
    >>> import hapticlab as hl
    >>> paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, coulomb=0.02, delay=0.5e-3)
    >>> limit = hl.design.compensation(paddle)
    >>> print(limit)
    damping compensation: m = 0.05 kg, b = 0.1 N s/m, k = 0 N/m, T = 0.001 s
      viscous    up to 1 of 0.1 N s/m, drifting off: exact linear stability of this plant
      dry        up to 1 of 0.02 N at viscous = 0; above that, it keeps moving after a push
    >>> round(limit.speed(viscous=0.5, dry=1.5), 6)
    0.2

    Friction that is identified first, ``found = hl.identify.paddle(paddle)``, is known within an interval. With
    ``found.paddle()``, ``b_least=found["b"].low`` and ``coulomb_least=found["coulomb"].low`` the parts are those of
    ``hl.laws.damping_compensation(b=found["b"].value, coulomb=found["coulomb"].value, ...)`` that are safe whatever the
    friction is inside the intervals. For instance b = 0.1 N s/m, between 0.095 and 0.105:

    >>> safe = hl.design.compensation(hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3), b_least=0.095)
    >>> round(safe.viscous, 9)
    0.95
    """
    own, b, T, delay, coulomb, hand, source = known(paddle, "m", "b", "T", "delay", "coulomb", "hand", "velocity")
    b = number("b", b, "N s/m", above=0, why="without damping there is nothing to compensate")
    if velocity is not None:
        velocity.transfer(T)  # refuses, in words, what has no poles
    b_least, coulomb_least = _least(b, b_least, coulomb, coulomb_least)
    scene = damping_compensation(b=b, velocity=velocity)
    m, damping, k = (value + (getattr(hand, name) if hand else 0.0) for name, value in (("m", own), ("b", b), ("k", 0.0)))
    ends = []
    for true in {b_least, b}:
        plant = Device(m=own, b=true, T=T, delay=delay, hand=hand, velocity=source)
        if k:
            limit = stability_limit(plant, law=scene, parameter="viscous")
            ends.append((limit.K, limit.frequency or 0.0))
        else:
            ends.append(_of_a_free_handle(plant, scene, (damping - b + true) / b))
    return CompensationLimit(*min(ends), m, damping - b + b_least, k, b, coulomb, T, b_least, coulomb_least)


def _least(b, b_least, coulomb, coulomb_least):
    """Return the least damping and Coulomb friction that the device may have."""
    b_least = b if b_least is None else b_least
    coulomb_least = coulomb if coulomb_least is None else coulomb_least
    why = "no fraction of a damping that may be zero is safe to cancel. Identify the damping more precisely"
    b_least = number("b_least", b_least, "N s/m", above=0, most=b, why=why)
    return b_least, max(number("coulomb_least", coulomb_least, "N", most=coulomb, why="the paddle has no more than this"), 0.0)


def _of_a_free_handle(paddle, scene, drifting):
    """Return the limit and its frequency: ``drifting``, where a pole passes z = 1, or sooner where another one leaves."""
    loop = Loop.of(paddle, scene, parameter="viscous")
    for part, angle in crossings(loop):
        if part < drifting * (1 - NEAR) and loop.unstable(part * (1 + NEAR)):
            return part, angle / (2 * math.pi * loop.T)
    return drifting, 0.0
