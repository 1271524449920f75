"""What designs are measured on: a scene and its ideal, a motion of the handle, a paddle and a board."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from ...base.profile.paddle_profile import PaddleProfile
from ...base.shows_itself import ShowsItself
from ...compiler.boards.board_records import BOARDS
from ...compiler.ir.options import choice
from ...device.device import total_delay
from ...scene.scene import Scene
from ..accuracy.handle_motions import HandleMotion, handle_motions
from ..accuracy.port_error import counted
from ..accuracy.reference import STEP, Reference, reference
from ..stability.operating_points import TRAVEL
from ..stability.trial_limits import Limits

if TYPE_CHECKING:
    from .design import Design

#: a paddle of round numbers, for tasks whose figures must not depend on the paddle in use
TEXTBOOK = PaddleProfile("textbook", m=0.05, b=1.0, counts_per_metre=50_000, force_max=8.0, source="round numbers, not measured")
#: the periods are whole numbers of it [s]
PERIOD_STEP = STEP
#: what a design of a scene with motion chooses, and one of a law of samples
OF_MOTION, OF_LAW = ("method", "T", "substeps", "hold"), ("T", "law", "velocity", "tau")


@dataclass(frozen=True, eq=False)
class Task(ShowsItself):
    """A scene that designs render, with what they are measured on.

    Parameters
    ----------
    name : str
    ideal : Scene
        Every parameter bound; the force that is wanted, without samples.
    motion : HandleMotion, optional
        What the hand does; a mixture of frequencies unless given.
    rendered : callable, optional
        Of a Design and the paddle: the scene that renders the ideal; the ideal itself unless given.
    takes : sequence of str
        The names that a design of this task gives.
    paddle : PaddleProfile
        Its damping, its encoder, its delay and its largest force.
    board : {"uno", "pico", "cortex-m4f"}

    Examples
    --------
    >>> import hapticlab as hl
    >>> print(hl.design.Task("mine", hl.library.mass_spring_damper()))
    mine, moved by hand, on uno and the paddle textbook; a design gives method, T, substeps, hold
    """

    name: str
    ideal: Scene
    motion: HandleMotion = handle_motions()[4]
    rendered: Callable[[Design, PaddleProfile], Scene] | None = None
    takes: tuple[str, ...] = OF_MOTION
    paddle: PaddleProfile = TEXTBOOK
    board: Literal["uno", "pico", "cortex-m4f"] = "uno"

    def __post_init__(self) -> None:
        choice("board", self.board, [name for name in BOARDS if BOARDS[name].hz])

    @functools.cached_property
    def reference(self) -> Reference:
        """The force F(t) of the ideal during the motion."""
        return reference(self.ideal, self.motion, step=PERIOD_STEP)

    @functools.lru_cache(maxsize=256)  # noqa: B019  it lives as long as its task
    def limits(self, scene: Scene) -> Limits:
        """Of stability and passivity, of a scene that renders this task.

        Parameters
        ----------
        scene : Scene
            One that :meth:`scene` returned.
        """
        return Limits(scene, TRAVEL, float(total_delay(self.paddle)))

    @functools.lru_cache(maxsize=64)  # noqa: B019  it lives as long as its task
    def positions(self, T: float) -> tuple[np.ndarray, np.ndarray]:
        """Return the positions that are sampled [m], late by the sensor, and what the encoder makes of them.

        Parameters
        ----------
        T : float
            Sampling period [s], > 0.
        """
        times = T * np.arange(round(self.reference.horizon / T)) - self.paddle.sensor_delay
        x = self.motion.at(np.maximum(times, 0.0))[0]
        counts = self.paddle.counts_per_metre
        return x, counted(x, counts, self.paddle.rounding) if counts else x

    def scene(self, design: Design) -> Scene:
        """Return the scene that a design compiles.

        Parameters
        ----------
        design : Design
            Law, method, period and the other choices of a design.
        """
        return self.rendered(design, self.paddle) if self.rendered else self.ideal

    def __str__(self) -> str:
        given = ", ".join(self.takes)
        kit = f"{self.board} and the paddle {self.paddle.name}"
        return f"{self.name}, moved by {self.motion.name}, on {kit}; a design gives {given}"
