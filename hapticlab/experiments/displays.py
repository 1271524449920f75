"""Impedance against admittance display, one hand and one wall: which renders what. Simulated: a paddle measures no force."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Literal

import numpy as np

from ..base.arguments import number
from ..base.drawing import house_style, new_figure, scale_axis, style_of
from ..base.shows_itself import ShowsItself, Tabular
from ..device.hand.hand import Hand
from ..errors import AnalysisError
from .display_laws import Admittance, Impedance, display_motion, largest_stiffness
from .paddle_needs import check_simulated

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from matplotlib.figure import Figure

    from ..base.annotations import Array
    from ..device.simulated.simulated_paddle import SimulatedPaddle

#: the hand moves freely, presses, and holds until [s]
FREE, PRESSED, HELD = 1.0, 1.4, 2.0
#: [m]; whatever still moves by more while the hand holds has not come to rest
REST = 1e-4


@dataclass(frozen=True, eq=False)
class Rendered(ShowsItself):
    """One task on one display.

    Attributes
    ----------
    display : str
    k, mass, damping, friction : float
        Stiffness [N/m], mass [kg], damping [N s/m] and Coulomb friction [N]: what the hand felt, by the force sensor's
        record. Mass, damping and friction moving freely, by least squares; k holding still in the wall, or by least
        squares where it still moves.
    misfit : float
        What mass, damping and friction leave of the force felt moving freely, root mean square [N]: friction below it says
        nothing.
    wanted : float
        The wall's stiffness [N/m].
    state : {"at rest", "moving", "unstable"}
        How the press ended; "moving" swings ever less.
    t, x, f_h : array
        Time [s], handle [m], force of the hand on the handle [N].
    """

    display: str
    k: float
    mass: float
    damping: float
    friction: float
    misfit: float
    wanted: float
    state: Literal["at rest", "moving", "unstable"]
    t: Array = field(repr=False)
    x: Array = field(repr=False)
    f_h: Array = field(repr=False)

    def __str__(self) -> str:
        if self.state == "unstable":
            return f"{self.display:<11} {self.wanted:8.4g} N/m: unstable"
        ringing = " while it rings" if self.state == "moving" else ""
        rubs = f"{self.friction:.3g} N friction" if self.friction > self.misfit else f"friction below {self.misfit:.2g} N"
        return (
            f"{self.display:<11} {self.wanted:8.4g} N/m: felt {self.k:.4g} N/m{ringing}; free: {1e3 * self.mass:.4g} g, "
            f"{self.damping:.3g} N s/m{' (it drives the hand)' if self.damping < 0 else ''}, {rubs}; fit to {self.misfit:.2g} N"
        )


def render(paddle, display, *, sensor_delay=0):
    """Move freely in front of a wall, press it and hold; return what the hand felt.

    Parameters
    ----------
    paddle : SimulatedPaddle
        Its hand's m, b and k are kept; it gets the task's intent.
    display : Impedance or Admittance
    sensor_delay : int
        Samples.

    Returns
    -------
    Rendered
    """
    hand = replace(paddle.hand, intent=_task, push_noise=0.0, push=0.0)
    held = replace(paddle, hand=hand)
    t, x, v, f_h = display_motion(held, display, duration=HELD, sensor_delay=sensor_delay)
    whole = len(t) == held.ticks(HELD)
    swing = [float(np.ptp(x[(t >= a) & (t < b)])) for a, b in ((PRESSED, 1.7), (1.7, HELD))] if whole else [0.0, math.inf]
    if swing[1] > max(REST, swing[0]):
        nothing = [math.nan] * 5
        return Rendered(display.name, *nothing, display.k, "unstable", t, x, f_h)
    mean = (v + np.r_[v[0], v[:-1]]) / 2  # over the period before, as the sensor's reading and this acceleration are
    motion = np.column_stack([np.diff(v, prepend=v[0]) / held.T, mean, np.sign(mean)])
    free, contact = (t > 0.15 * FREE) & (t < 0.95 * FREE), (t > FREE) & (x > 0)
    mass, damping, friction = (float(c) for c in np.linalg.lstsq(motion[free], f_h[free], rcond=None)[0])
    misfit = float(np.sqrt(np.mean((f_h[free] - motion[free] @ [mass, damping, friction]) ** 2)))
    state = "at rest" if swing[1] < REST else "moving"
    if state == "at rest":
        k = float(f_h[t >= 1.7].mean() / x[t >= 1.7].mean())
    else:
        k = float(np.linalg.lstsq(np.column_stack([x, motion])[contact], f_h[contact], rcond=None)[0][0])
    return Rendered(display.name, k, mass, damping, friction, misfit, display.k, state, t, x, f_h)


def _task(t):
    """To and fro in front of the wall, then a smooth press to 20 mm inside, which is held."""
    t = np.asarray(t, float)
    start, s = np.clip(t / (0.1 * FREE), 0, 1), np.clip((t - FREE) / (PRESSED - FREE), 0, 1)
    free = -0.02 + 0.01 * np.cos(2 * np.pi * 3 * t / FREE)
    press = -0.01 + 0.03 * s**3 * (10 - 15 * s + 6 * s * s)
    return np.where(t < FREE, free * start**3 * (10 - 15 * start + 6 * start * start), press)


@dataclass(frozen=True, eq=False)
class Displays(Tabular):
    """Both displays over several stiffnesses.

    Attributes
    ----------
    rows : tuple of Rendered
    limits : dict of str to float
        The largest stable stiffness of each display, in contact, by its eigenvalues without friction [N/m].
    """

    rows: tuple[Rendered, ...]
    limits: dict[str, float]

    def _sentence(self):
        asked = ", ".join(f"{k:g}" for k in dict.fromkeys(row.wanted for row in self.rows))
        unstable = sum(row.state == "unstable" for row in self.rows)
        return f"walls of {asked} N/m on both displays, {unstable} of {len(self.rows)} unstable"

    def __str__(self) -> str:
        limits = ", ".join(f"{name} {limit:.4g} N/m" for name, limit in self.limits.items())
        return "\n".join([*map(str, self.rows), f"largest stable stiffness in contact: {limits}"])

    def plot(self) -> Figure:
        """Draw felt over wanted stiffness for both displays, and where each becomes unstable; return the figure."""
        with house_style():
            figure = new_figure(height=3.8)
            axes = figure.subplots()
            for number, (name, limit) in enumerate(self.limits.items()):
                rows = [row for row in self.rows if row.display == name and row.state != "unstable"]
                style = style_of(number)
                axes.plot([row.wanted for row in rows], [row.k / row.wanted for row in rows], marker="os"[number], **style,
                          label=name, markersize=(5, 9)[number], markerfacecolor=(style["color"], "none")[number])  # fmt: skip
                if 0 < limit < math.inf:
                    edge = {"color": style["color"], "linestyle": (":", "-.")[number], "linewidth": 1.2}
                    axes.axvline(limit, label=f"{name}: stable below", **edge)
            span = [row.wanted for row in self.rows]
            scale_axis(axes, "x", np.geomspace(min(span), max(*span, 10 * min(span)), 3))
            axes.set(xlabel="stiffness of the wall k [N/m]", ylabel="felt stiffness / k [1]", ylim=(0, 1.3))
            figure.legend(loc="outside upper center", ncols=2)
        return figure


def compare_displays(
    paddle: SimulatedPaddle,
    stiffnesses: Iterable[float],
    *,
    m_v: float = 0.2,
    b: float = 0.0,
    k_p: float | None = None,
    k_d: float | None = None,
    ahead: float = 1.0,
    sensor_delay: int = 0,
) -> Displays:
    """Render the same walls to the same hand by impedance and by admittance display, Section 23.4.

    An impedance display lets device mass and friction be felt, and has a largest stiffness that its damping sets. An
    admittance display hides them, holds a stiff wall, and has a least virtual mass. R. J. Adams and B. Hannaford, *IEEE
    Trans. Robotics and Automation* 15 (1999) 465. Its body is late by half a period, so that free motion at the frequency w
    is felt with a damping of about b - m_v w^2 T/2: below zero where b is 0, it drives the hand. Simulated alone: a paddle
    has no force sensor.

    Parameters
    ----------
    paddle : SimulatedPaddle
        Its hand's m, b and k are kept; ``hl.Hand("grip")`` if it has none.
    stiffnesses : sequence of float
        [N/m]
    m_v, b : float
        Virtual mass [kg] of the admittance display; virtual damping of both [N s/m].
    k_p, k_d : float, optional
        Position controller; by default 0.03 m/T^2 and critical damping.
    ahead : float
        Part of the measured force that the motor takes off, 0 to 1.
    sensor_delay : int
        Samples by which the force sensor is late; the limits leave it out.

    Returns
    -------
    Displays

    Examples
    --------
    >>> import hapticlab as hl
    >>> found = hl.people.compare_displays(hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3), [300])
    >>> [(row.display, round(row.k), round(row.mass, 2)) for row in found.rows]
    [('impedance', 300, 0.05), ('admittance', 300, 0.2)]
    """
    check_simulated(paddle, "compare_displays")
    m_v = number("m_v", m_v, "kg", "an admittance display", why="It divides the force.", above=0)
    stiffnesses = [float(k) for k in stiffnesses]
    if not stiffnesses or not all(0 < k < math.inf for k in stiffnesses):
        raise AnalysisError(f"stiffnesses = {stiffnesses}; needs some k > 0 N/m, each a finite number")
    paddle = replace(paddle, hand=paddle.hand or Hand("grip"))
    k_p = 0.03 * paddle.m / paddle.T**2 if k_p is None else k_p
    k_d = 2 * math.sqrt(k_p * paddle.m) if k_d is None else k_d
    makes: dict[str, Callable[[float], Impedance | Admittance]] = {
        "impedance": lambda k: Impedance(k=k, b=b),
        "admittance": lambda k: Admittance(k=k, b=b, m_v=m_v, k_p=k_p, k_d=k_d, ahead=ahead),
    }
    rows = [render(paddle, make(k), sensor_delay=sensor_delay) for make in makes.values() for k in stiffnesses]
    return Displays(tuple(rows), {name: largest_stiffness(paddle, make) for name, make in makes.items()})
