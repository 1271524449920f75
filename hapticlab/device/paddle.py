"""The contract of a paddle: a scene runs on it for a while, and what happened comes back."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Any

from ..base.arguments import number
from ..base.shows_itself import ShowsItself
from ..base.unusual import DEVICE, warn_of_unusual
from ..compiler.ir.program import Program
from ..compiler.tick.compile_scene import compile
from ..errors import PaddleError, ParameterError
from ..scene.notation.written import no_scene
from ..scene.scene import Scene
from .port_mass_check import check_port_mass

if TYPE_CHECKING:
    from ..base.annotations import Number
    from ..base.telemetry import Telemetry


class Paddle(ShowsItself, ABC):
    """A one-axis haptic device, simulated or real.

    A paddle samples its handle every T seconds, runs the scene's program on the sample, and applies the force until the
    next force is ready. One line changes between a simulated paddle and a board.

    Attributes
    ----------
    T : float
        Sampling period [s].
    velocity : {"measured", "backward_difference"}
        Where v(n) comes from; "measured" is exact and exists in simulation only.
    """

    _hidden = ("board", "settings")
    T: float

    @property
    @abstractmethod
    def velocity(self) -> str:
        """Say where v(n) comes from."""

    @abstractmethod
    def run(self, scene: Scene | Program, duration: Number, **options: Any) -> Telemetry:
        """Run a scene or a program for a duration [s] and return its Telemetry.

        Parameters
        ----------
        scene : Scene or Program
            A scene with every parameter bound, or the program that was compiled from one.
        duration : float or text
            How long to run [s], > 0, or a text with its unit, "2 s".
        **options
            As for :func:`hapticlab.compile`: method, substeps, hold, dtype, live ...
        """

    @abstractmethod
    def __str__(self) -> str:
        """Say what the paddle is and where its constants come from."""

    def ticks(self, duration: Number | None) -> int:
        """Return the number of samples in a duration [s].

        Parameters
        ----------
        duration : float or text
            [s], > 0, rounded to a whole number of periods.
        """
        duration = number("duration", duration, "s", "a run", above=0, error=PaddleError)
        warn_of_unusual("duration", duration, "s", DEVICE["duration"])
        if not math.isfinite(duration / self.T):
            raise PaddleError(f"duration = {duration:g} s has too many samples to count; run for a shorter time.")
        ticks = math.floor(duration / self.T + 0.5)
        if ticks < 1:
            raise PaddleError(f"duration = {duration:g} s; needs at least one period T = {self.T:g} s.")
        return ticks

    def program(self, scene: Scene | Program, **options: Any) -> Program:
        """Return the program of a scene for this paddle: T and the velocity's source are the paddle's.

        Parameters
        ----------
        scene : Scene or Program
            A scene with every parameter bound, or the program that was compiled from one.
        **options
            As for :func:`hapticlab.compile`: method, substeps, hold, dtype, live ...

        Raises
        ------
        ParameterError
            Naming the parameters that have no value yet.
        """
        if not isinstance(scene, (Scene, Program)):
            raise PaddleError(no_scene(scene, "a paddle runs a Scene or a compiled Program."))
        if isinstance(scene, Program):
            if options:
                given = ", ".join(options)
                raise PaddleError(f"{given}: a program is already compiled; give compile options with a scene only.")
            program = scene
        else:
            if "T" in options:
                raise PaddleError(f"T is that of the paddle, {self.T:g} s. For a different T make a new paddle.")
            program = compile(scene, **{"T": self.T, "velocity": self.velocity, **options})
        missing = [c for c, value in zip(program.parameters, program.values, strict=True) if math.isnan(value)]
        if missing:
            wanted = ", ".join(f"{c.name} [{c.unit}]" for c in missing)
            cure = ", ".join(f"{c.name}=..." for c in missing)
            raise ParameterError(f"{program.name}: no value for {wanted}; bind them before the run: scene({cure})")
        return self.accept(program)

    def accept(self, program: Program) -> Program:
        """Return the program if this paddle can run it, else raise PaddleError.

        Parameters
        ----------
        program : Program
            Of :func:`hapticlab.compile`, for the period of this paddle.
        """
        name = program.name
        if not math.isclose(program.T, self.T, rel_tol=1e-9):
            raise PaddleError(
                f"{name} was compiled for T = {program.T:g} s; this paddle samples every {self.T:g} s. "
                f"Compile with T={self.T:g} or run the scene itself."
            )
        wanted = [c.name for c in program.inputs]
        unknown = sorted(set(wanted) - {"x", "v"})
        if unknown:
            raise PaddleError(f"{name} needs the input {unknown[0]}; a paddle gives x [m] and v [m/s] only.")
        if "v" in wanted and self.velocity != "measured":
            raise PaddleError(
                f"{name} needs a measured v; this paddle has only its {self.velocity.replace('_', ' ')}. "
                "Compile with velocity='backward_difference'."
            )
        if not program.outputs or program.outputs[0].name != "F":
            raise PaddleError(f"{name} has no force: the first output of a paddle's program is F [N].")
        check_port_mass(program, self)
        return program
