"""What is to be told apart: stiffness, damping or texture, how a hand explores it, and what it feels of it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.arguments import number
from ..base.shows_itself import ShowsItself
from ..device.hand.hand import Hand
from ..device.hand.reacting_hand import Reacting
from ..device.simulated.closed_loop import link, load_linked
from ..device.simulated.simulated_paddle import SimulatedPaddle
from ..errors import AnalysisError
from ..library.surfaces import texture
from ..scene.laws.chapter_laws import virtual_damper, wall
from ..scene.scene import Scene

if TYPE_CHECKING:
    from ..base.telemetry import Telemetry
    from ..device.board.serial_paddle import SerialPaddle


@dataclass(frozen=True, kw_only=True)
class Task(ShowsItself):
    """A property of a scene that differs between two presentations.

    Attributes
    ----------
    name, question : str
    scene : Scene
        All but ``parameter`` bound.
    parameter, unit : str
    standard : float
        What the comparison is told apart from, SI.
    felt : callable
        Of a Telemetry; what a hand makes of it, larger where the answer should be "stronger". It sees only what was
        recorded at the handle, never the parameter.
    hand : Hand
        How a simulated hand explores it; periodic, so that it does not matter when a presentation begins.
    duration : float
        Of one presentation [s].
    weber : float
        What people are said to need: the difference at d' = 1, as a part of the standard.
    source : str
        Of ``weber``.
    """

    name: str
    question: str
    scene: Scene
    parameter: str
    unit: str
    standard: float
    felt: Callable[[Telemetry], float]
    hand: Hand
    duration: float
    weber: float
    source: str

    def __str__(self) -> str:
        return f"{self.name}: {self.question} The standard is {self.parameter} = {self.standard:g} {self.unit}"

    def on(self, paddle: SimulatedPaddle | SerialPaddle) -> SimulatedPaddle | SerialPaddle:
        """A simulated paddle with the exploring hand on it, unless it has a hand already; a board as it is.

        Parameters
        ----------
        paddle : SimulatedPaddle or SerialPaddle
            Where the task is to be presented.
        """
        if isinstance(paddle, SimulatedPaddle) and paddle.hand is None:
            return replace(paddle, hand=self.hand)
        return paddle

    def present(self, paddle: SimulatedPaddle | SerialPaddle, value: float, **options: Any) -> Telemetry:
        """Render the scene with this value for one presentation and return the record; the motor is off after it.

        Parameters
        ----------
        paddle : SimulatedPaddle or SerialPaddle
            Where the scene runs.
        value : float
            Of the parameter that the task varies, in its SI unit.
        **options
            As for ``paddle.run``.
        """
        return paddle.run(self.scene(**{self.parameter: value}), duration=self.duration, progress=False, **options)

    def presenter(self, paddle: SimulatedPaddle | SerialPaddle, **options: Any) -> Callable[[float], Telemetry]:
        """A function that presents a value and returns the record; a simulated paddle's program is compiled once for all.

        Parameters
        ----------
        paddle : SimulatedPaddle or SerialPaddle
            Where the scene runs.
        **options
            As for ``paddle.run``.
        """
        if not isinstance(paddle, SimulatedPaddle) or isinstance(getattr(paddle.hand, "intent", None), Reacting):
            return lambda value: self.present(paddle, value, **options)
        engine = options.pop("engine", "auto")
        program = paddle.program(self.scene(**{self.parameter: self.standard}), **options)
        linked, inputs, start = link(program, paddle), paddle.inputs(paddle.ticks(self.duration)), paddle.plant_values()
        loaded, declared = load_linked(linked, engine), self.scene.parameters[self.parameter]

        def show(value):
            bound = dict(zip((c.name for c in program.parameters), program.values, strict=True))
            bound[self.parameter] = declared.check(value)
            outputs, _ = loaded.run(len(inputs), inputs, (*bound.values(), *start))
            return paddle._telemetry(replace(program, values=tuple(bound.values())), linked, outputs[:, :, 0])

        return show


def stiffness_task(*, standard: float = 200.0, press: float = 0.015) -> Task:
    """Distinguish two walls by their stiffness, pressed twice per second.

    Parameters
    ----------
    standard : float
        [N/m], > 0.
    press : float
        How far the hand means to press [m].

    Examples
    --------
    >>> print(stiffness_task().question)
    Which wall was stiffer?
    """
    hand = _explores(lambda t: press * (1 - np.cos(2 * math.pi * 2 * t)) / 2)
    return Task(
        name="stiffness", question="Which wall was stiffer?", scene=wall(), parameter="k", unit="N/m",
        standard=_positive("standard", standard, "N/m"), felt=felt_stiffness, hand=hand, duration=1.0, weber=0.23,
        source="L. A. Jones and I. W. Hunter, Exp. Brain Res. 79 (1990) 150",
    )  # fmt: skip


def damping_task(*, standard: float = 5.0, stroke: float = 0.02) -> Task:
    """Distinguish two viscous media by moving back and forth.

    Parameters
    ----------
    standard : float
        [N s/m], > 0.
    stroke : float
        Amplitude that the hand means to move with [m].
    """
    hand = _explores(lambda t: stroke * np.sin(2 * math.pi * 2 * t))
    return Task(
        name="damping", question="Which one was thicker?", scene=virtual_damper(), parameter="B", unit="N s/m",
        standard=_positive("standard", standard, "N s/m"), felt=felt_damping, hand=hand, duration=1.0, weber=0.25,
        source="L. Jones, I. Hunter and S. Lafontaine, Perception 26 (1997) 1571: 19 % at 71 % right, 25 % at d' = 1",
    )  # fmt: skip


def texture_task(*, standard: float = 0.15, pitch: float = 0.003, stroke: float = 0.02) -> Task:
    """Distinguish two gratings by their roughness, stroked back and forth.

    Parameters
    ----------
    standard : float
        Amplitude of the lateral force [N], > 0.
    pitch : float
        [m].
    stroke : float
        Amplitude of the stroke [m].
    """
    hand = _explores(lambda t: stroke * (1 - np.cos(2 * math.pi * t)))
    return Task(
        name="texture", question="Which one was rougher?", scene=texture()(p_1=pitch, p_2=pitch), parameter="A", unit="N",
        standard=_positive("standard", standard, "N"), felt=felt_roughness, hand=hand, duration=1.0, weber=0.16,
        source="illustrative",
    )  # fmt: skip


def felt_stiffness(log: Telemetry) -> float:
    """The slope of force over penetration while there is contact, by least squares [N/m].

    Examples
    --------
    >>> from hapticlab.base.telemetry import Telemetry
    >>> x = 1e-3 * np.sin(np.linspace(0, 6, 60))
    >>> log = Telemetry(t=np.arange(60) * 1e-3, x=x, v=0 * x, F=np.maximum(150 * x, 0), T=1e-3)
    >>> round(felt_stiffness(log), 9)
    150.0
    """
    x, F = _handle(log), _applied(log)
    touching = F != 0
    return _slope(x[touching], F[touching], "the hand never touched the wall")


def felt_damping(log: Telemetry) -> float:
    """The damping [N s/m] that takes as much work as was done on the environment: int F dx over int v^2 dt.

    A difference over a hundredth of a second stands for the velocity, as an encoder's single steps say little.
    """
    x, F = _handle(log), _applied(log)
    over = max(1, round(0.01 / log.T))
    v = (x[over:] - x[:-over]) / (over * log.T)
    mean = np.convolve(F, np.ones(over) / over, "valid")[: len(v)]
    return _slope(v, mean, "the hand did not move")


def felt_roughness(log: Telemetry) -> float:
    """The force's quick part, root mean square over the presentation [N].

    Quick is what is left beside a mean over a tenth of a second.
    """
    F = _applied(log)
    over = max(3, round(0.1 / log.T))
    slow = np.convolve(F, np.ones(over) / over, "same")
    inside = slice(over, len(F) - over)
    return float(np.sqrt(np.mean((F - slow)[inside] ** 2)))


def _explores(intent):
    """A hand that moves; 100 g, 5 N s/m and 500 N/m are illustrative of a grip."""
    return Hand(m=0.10, b=5.0, k=500.0, intent=intent)


def _handle(log):
    return np.asarray(log.channels.get("x_true", log.x))


def _applied(log):
    return np.asarray(log.channels.get("F_applied", log.F))


def _slope(x, y, otherwise):
    x = x - x.mean() if len(x) else x
    if len(x) < 3 or not (x @ x) > 0:
        raise AnalysisError(f"nothing was felt, because {otherwise}; explore further, or for longer")
    return float(x @ (y - y.mean()) / (x @ x))


def _positive(name, value, unit):
    why = f"so that a difference can be a fraction of {name}"
    return number(name, value, unit, "a task", above=0, why=why)
