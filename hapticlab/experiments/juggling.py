"""Juggling a ball on the paddle, with and without felt feedback, Section 23.3.1."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from ..base.arguments import choice, number, numbers
from ..base.drawing import house_style, new_figure, style_of
from ..base.shows_itself import ShowsItself
from ..base.telemetry import Telemetry
from ..device.hand.reacting_hand import REACTION, Reacting
from ..library.contacts import ball_on_the_paddle
from .arm import Arm
from .juggler import SENSES, Juggler, Senses
from .paddle_needs import check_held

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from ..base.annotations import Array
    from ..device.simulated.simulated_paddle import SimulatedPaddle

WORDS = {"vision": "sight", "touch": "touch", "both": "sight and touch", "none": "neither sight nor touch"}


@dataclass(frozen=True, eq=False)
class Juggle(ShowsItself):
    """How a ball was kept up.

    Attributes
    ----------
    senses : {"vision", "touch", "both", "none"}
    height : float
        Aimed at, above where the ball was struck [m].
    impacts : array, shape (N,)
        Times [s].
    heights : array, shape (N - 1,)
        How high the ball rose above the place it was struck at, flight by flight [m].
    log : Telemetry
    """

    senses: Senses
    height: float
    impacts: Array
    heights: Array
    log: Telemetry

    @property
    def error(self) -> float:
        """Root mean square of the heights' error, as a part of the height aimed at; the first three flights left out."""
        return float(np.sqrt(np.mean((self.heights[3:] / self.height - 1) ** 2)))

    @property
    def irregularity(self) -> float:
        """Standard deviation of the time between impacts over its mean."""
        between = np.diff(self.impacts)[3:]
        return float(between.std(ddof=1) / between.mean())

    @property
    def growth(self) -> float:
        """What is left of a height's error one flight later: its correlation with the next; below 1 errors die out."""
        e = self.heights[3:] - self.heights[3:].mean()
        return float(e[1:] @ e[:-1] / (e[:-1] @ e[:-1]))

    def __str__(self) -> str:
        head = f"by {WORDS[self.senses]}: {len(self.impacts)} impacts in {self.log.t[-1]:.3g} s"
        if len(self.heights) < 6:
            return f"{head}; the ball was lost"
        return (
            f"{head}, heights off by {100 * self.error:.3g} % rms, time between impacts irregular by "
            f"{100 * self.irregularity:.3g} %, {self.growth:+.2f} of an error remains one flight later"
        )

    def plot(self) -> Figure:
        """Draw ball and handle against time."""
        with house_style():
            figure = new_figure(height=3.4)
            axes = figure.subplots()
            axes.plot(self.log.t, 1e3 * self.log.y, **style_of(0), label="ball")
            axes.plot(self.log.t, 1e3 * self.log.x, **style_of(1), label="handle")
            axes.axhline(1e3 * self.height, color="#8a8a8a", linestyle=":", label="height aimed at")
            axes.set(xlabel="time [s]", ylabel="height [mm]")
            figure.legend(loc="outside upper center", ncols=3, title=f"juggled by {WORDS[self.senses]}")
        return figure


@dataclass(frozen=True, kw_only=True)
class Perception(ShowsItself):
    """The precision and the delay of a person's sight and touch.

    Parameters
    ----------
    vision : float or text
        Standard deviation of each sight of the ball [m].
    touch : float
        Weber fraction of a felt impulse.
    reaction : float or text
        Time [s] until what is perceived changes what is done.

    Examples
    --------
    >>> import hapticlab as hl
    >>> hl.people.Perception(vision="5 mm").vision
    0.005
    """

    vision: float = 0.02
    touch: float = 0.07
    reaction: float = REACTION

    def __post_init__(self) -> None:
        place, weber, time = ({"unit": unit, "least": 0} for unit in ("m", "1", "s"))
        numbers(self, "perception", vision=place, touch=weber, reaction=time)


PERCEPTION = Perception()


def juggle(
    paddle: SimulatedPaddle,
    *,
    senses: Senses = "both",
    height: float = 0.2,
    duration: float = 12.0,
    acceleration: float = -5.0,
    perception: Perception = PERCEPTION,
    seed: int = 0,
    **values: float,
) -> Juggle:
    """Let a simulated juggler keep a ball up on a simulated paddle, by sight, by touch, by both, or by neither.

    The juggler strikes once a flight, slowing down at impact, and plans each stroke from where and when the ball will
    come down; nothing is known before a reaction time has gone by. Sight gives the ball's place 60 times a second,
    blurred. Touch gives the instant of the felt impact, where the handle was, and the impulse, within a Weber fraction:
    by touch alone the eyes are closed. By sight alone the motor is off: the ball bounces on the screen and is not felt.

    S. Schaal, D. Sternad and C. G. Atkeson, *J. Motor Behavior* 28 (1996) 165, on people: touch alone is much better
    than sight alone, and almost as good as both. What holds for this juggler depends on the ``perception``, whose
    numbers are illustrative. With them and a slowing stroke each sense keeps the ball, and so does neither. With a
    stroke that speeds up by 2 m/s^2 at impact, at 0.2 m and with 0.5 N of noise in the hand, sight alone loses it,
    touch alone keeps it in one run of two, both keep it within 7 % rms (tests/benchmarks/experiments.py).

    Without looking, a stroke that speeds up at impact does not lose the ball either, though the linearised map of the juggle
    calls that impact unstable: the impacts leave it, within some ten flights, for the later moment at which the same stroke
    passes the same speed while it slows down, and stay there (for 2 m/s^2: 38 ms late, 13 mm higher, at -1.7 m/s^2).
    One stroke a flight has two such moments, one unstable and one stable. The heights, taken from where the ball is
    struck, are the same.

    Parameters
    ----------
    paddle : SimulatedPaddle
        With a hand that has k > 0; its intent is replaced.
    senses : {"vision", "touch", "both", "none"}
        "none" plays the stroke of a ball that never errs, in time with nothing.
    height : float
        Aimed at [m].
    duration : float
        [s]
    acceleration : float
        Of the plate at impact that strokes aim at [m/s^2]; the linearised map of the juggle says for which a juggle is stable
        without looking.
    perception : Perception
        How sharp the senses are, and how late: ``hl.people.Perception(vision=, touch=, reaction=)``.
    seed : int
        Of what is seen and felt.
    **values
        Of the scene :func:`hapticlab.library.ball_on_the_paddle`.

    Returns
    -------
    Juggle

    Raises
    ------
    PaddleError
        Without a hand that holds the handle.

    Examples
    --------
    >>> import hapticlab as hl
    >>> paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand("grip"))
    >>> found = hl.people.juggle(paddle, senses="none", duration=1.0)
    >>> len(found.impacts)
    2
    """
    hand = check_held(paddle, "juggle")
    choice("senses", senses, SENSES)
    height = number("height", height, "m", "a juggler", above=0)
    scene = ball_on_the_paddle()(**{"m": 0.005, "M": 0.1, "K": 1000.0, "b_c": 10.0, "h": height, **values})
    if senses == "vision":
        scene = replace(scene, force=0 * scene.force, values=scene.values, name="ball that is not felt")
    values = dict(scene.values)
    carried = paddle.m + hand.m + (values["M"] if senses != "vision" else 0.0)
    arm = Arm(m=carried, b=paddle.b, b_hand=hand.b, k=hand.k)
    juggler = Juggler(senses, height, values, arm, perception.vision, perception.touch, acceleration, seed)
    held = replace(paddle, hand=replace(hand, intent=Reacting(plan=juggler.plan, reaction=perception.reaction)))
    log = held.run(scene, duration=duration, progress=False, method="taylor")
    impacts, heights = bounces(log)
    return Juggle(senses, height, impacts, heights, log)


def bounces(log: Telemetry) -> tuple[Array, Array]:
    """Times at which the ball was struck [s], and the heights to which it rose above those places in between [m]."""
    y, t = log.y, log.t
    low = np.flatnonzero((y[1:-1] < y[:-2]) & (y[1:-1] <= y[2:])) + 1
    heights = [float(y[a : b + 1].max() - y[a]) for a, b in zip(low[:-1], low[1:], strict=True)]
    return t[low], np.array(heights)


def multipliers(acceleration: float, *, e: float, g: float = 9.81, m: float = 0.0, M: float = math.inf) -> NDArray[np.complex128]:
    """Factors by which a small error grows from one flight to the next if the stroke takes no notice of it.

    The eigenvalues of the map from one impact to the next, for a plate that passes the place of impact each period with
    this acceleration. Below one in magnitude, the juggle is stable without looking: for -2 g (1 + e^2)/(1 + e)^2 <
    acceleration < 0; S. Schaal, D. Sternad and C. G. Atkeson, *J. Motor Behavior* 28 (1996) 165. It is about this
    impact alone: a juggle that leaves it may settle where the same plate slows down.

    Parameters
    ----------
    acceleration : float
        Of the plate at impact, upwards [m/s^2].
    e : float
        Restitution.
    g : float
        [m/s^2]
    m, M : float
        Masses of ball and plate [kg]; a plate of finite mass, free on its coupler, gives like one of restitution
        (1 + e) M/(m + M) - 1.

    Returns
    -------
    array of complex, shape (2,)

    Examples
    --------
    >>> [round(float(abs(z)), 3) for z in multipliers(-4.0, e=0.8)]
    [0.8, 0.8]
    """
    e = (1 + e) / (1 + m / M) - 1
    lead = (1 + e) ** 2 * acceleration / g
    return np.linalg.eigvals([[1, (1 + e) / g], [(1 + e) * acceleration, lead + e * e]]).astype(complex)
