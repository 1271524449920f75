"""A scene file: plain Python that defines `scene`, and optionally `paddle` and `duration`. Load it, run it, report."""

import math
import runpy
from dataclasses import dataclass

import numpy as np

from .analysis.chatter import chatter
from .analysis.energy import energy
from .compiler.ir import Program
from .device.hand import Hand
from .device.paddle import Paddle
from .device.simulated import SimulatedPaddle
from .errors import SceneError
from .scene.scene import Scene


@dataclass(frozen=True)
class SceneFile:
    """What a scene file defines.

    Attributes
    ----------
    scene : Scene
    paddle : Paddle
        The eth profile pushed by 2 N where the file names none.
    duration : float
        [s]; 2 s where the file names none.
    """

    scene: Scene
    paddle: Paddle
    duration: float


def load_scene(path):
    """Run a scene file as a script and return what it defines; its own errors pass through.

    Parameters
    ----------
    path : str or Path

    Raises
    ------
    SceneError
        Where it defines no scene.
    """
    names = runpy.run_path(str(path))
    scene = names.get("scene")
    if not isinstance(scene, Scene):
        given = f"scene = {scene!r}" if "scene" in names else "no variable `scene`"
        raise SceneError(f"{path} has {given}; it needs scene = hl.Scene(force=...)")
    paddle = names.get("paddle", SimulatedPaddle.from_profile("eth", hand=Hand(push=2.0)))
    if not isinstance(paddle, Paddle):
        raise SceneError(f"{path} has paddle = {paddle!r}; it needs paddle = hl.SimulatedPaddle(...)")
    return SceneFile(scene, paddle, names.get("duration", 2.0))


def run_scene(file, *, progress=True, **options):
    """Run a scene file's scene on its paddle; return the program and the Telemetry."""
    program = file.paddle.program(file.scene, **options)
    return program, file.paddle.run(program, duration=file.duration, progress=progress)


def report_of(program: Program, log):
    """Return what a run showed as a dictionary of plain numbers, each name ending in its unit."""
    found, port = chatter(log) if len(log) >= 32 and not log.fault else None, energy(log) if not log.fault else None
    return {
        "scene": log.scene,
        "parameters": log.parameters,
        "paddle": log.paddle,
        "program": {"instructions": len(program), "T_s": program.T, **program.facts, "left_out": list(program.notes)},
        "samples": len(log),
        "duration_s": len(log) * log.T,
        "peak_force_N": finite(np.abs(log.F).max()),
        "chatter": found and {
            "state": found.state,
            "amplitude_m": found.amplitude,
            "frequency_Hz": found.frequency,
            "contacts_per_s": found.contacts_per_second,
            "growth_per_s": finite(found.growth),
            "words": str(found),
        },
        "energy": port and {
            "generated_J": finite(port.generated),
            "most_extracted_J": port.extracted,
            "contacts": port.contacts,
            "words": str(port),
        },
        "fault": log.fault,
    }  # fmt: skip


def finite(number):
    """Return a float, or None where there is no finite number: JSON has no other."""
    return float(number) if math.isfinite(number) else None


def describe(report):
    """Return the report of a run in words, one line each."""
    program, values = report["program"], report["parameters"]
    lines = [
        f"scene    {report['scene']}: " + (", ".join(f"{name} = {a:g}" for name, a in values.items()) or "no parameters"),
        f"program  {program['instructions']} instructions a tick, T = {program['T_s']:g} s"
        + "".join(f", {program[fact]}" for fact in ("method", "dtype") if fact in program),
        *(f"         left out: {note}" for note in program["left_out"]),
        f"run      {report['samples']} samples, {report['duration_s']:g} s",
    ]
    if report["fault"]:
        return "\n".join([*lines, f"fault    {report['fault']}"])
    chatter_words = report["chatter"]["words"] if report["chatter"] else "the run is too short to tell; 32 samples at least"
    return "\n".join([
        *lines,
        f"chatter  {chatter_words}",
        f"energy   {report['energy']['words']}",
        f"force    at most {report['peak_force_N']:.4g} N",
    ])  # fmt: skip
