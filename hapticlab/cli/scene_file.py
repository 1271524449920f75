"""A scene file: plain Python that defines `scene`, and optionally `paddle` and `duration`. Load it, run it, report."""

import math
import runpy
import sys
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..analysis.records.chatter import chatter
from ..analysis.records.energy import energy
from ..base.missed_events import missed_words
from ..base.telemetry import Telemetry
from ..compiler.ir.program import Program
from ..device.hand.hand import Hand
from ..device.paddle import Paddle
from ..device.simulated.simulated_paddle import SimulatedPaddle
from ..errors import AnalysisError, MissedEventWarning, PaddleError, SceneError
from ..scene.scene import Scene


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

    It may import modules that lie beside it.

    Parameters
    ----------
    path : str or Path

    Raises
    ------
    SceneError
        Where it is no text, ends by sys.exit(), defines no scene, or a paddle or duration that is none.
    """
    names = _run_as_script(path)
    scene = names.get("scene")
    if not isinstance(scene, Scene):
        given = f"scene = {scene!r}" if "scene" in names else "no variable `scene`"
        raise SceneError(f"{path} has {given}; it needs scene = hl.Scene(force=...)")
    paddle = names.get("paddle", SimulatedPaddle.from_profile("eth", hand=Hand(push=2.0)))
    if not isinstance(paddle, Paddle):
        raise SceneError(f"{path} has paddle = {paddle!r}; it needs paddle = hl.SimulatedPaddle(...)")
    duration = names.get("duration", 2.0)
    try:
        paddle.ticks(duration)
    except PaddleError as problem:
        raise SceneError(f"{path}: {problem}") from None
    return SceneFile(scene, paddle, duration)


def held_alike(paddle, profile, **changes):
    """Return the simulated paddle of a profile, or of its name or file, in the hand that holds another paddle."""
    return SimulatedPaddle.from_profile(profile, hand=getattr(paddle, "hand", None), **changes)


def _run_as_script(path):
    """Return the names a Python file defines; its folder comes first where it imports, as for any script."""
    if b"\0" in Path(path).read_bytes():
        raise SceneError(f"{path} holds null bytes, which no Python source has; save it as plain text in UTF-8")
    before = sys.path[:]
    sys.path.insert(0, str(Path(path).resolve().parent))
    try:
        return runpy.run_path(str(path))
    except SystemExit as end:
        said = "" if end.code is None else repr(end.code)
        raise SceneError(f"{path} ended itself by sys.exit({said}); it needs to run to its end and define scene") from None
    finally:
        sys.path[:] = before


def run_scene(file, *, progress=True, **options):
    """Run a scene file's scene on its paddle; return the program and the Telemetry."""
    program = file.paddle.program(file.scene, **options)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", MissedEventWarning)  # the report says it
        return program, file.paddle.run(program, duration=file.duration, progress=progress)


def report_of(program: Program, log: Telemetry) -> dict[str, Any]:
    """The results of a run as a dictionary for JSON.

    A number's name ends in its unit; counts (samples, instructions, substeps, contacts) have none, and the units of the
    parameters stand beside them under ``units``. None is a number that does not exist, such as a rate without a swing,
    and an analysis that this record does not allow: ``left_open`` says why.
    """
    (found, no_chatter), (port, no_energy) = _judged(chatter, log), _judged(energy, log)
    return {
        "scene": log.scene,
        "parameters": log.parameters,
        "units": {c.name: c.unit for c in program.parameters},
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
            "rest_m": found.rest,
            "travel_m": found.travel,
            "locked": found.locked,
            "dither": found.dither,
            "words": str(found),
        },
        "energy": port and {
            "generated_J": finite(port.generated),
            "most_extracted_J": port.extracted,
            "contacts": port.contacts,
            "words": str(port),
        },
        "left_open": {name: why for name, why in (("chatter", no_chatter), ("energy", no_energy)) if why},
        "fault": log.fault,
        "missed": missed_words(log) or None,
    }  # fmt: skip


def _judged(question, log):
    """Return the answer of an analysis, and why this record does not allow one; neither of a run that failed."""
    try:
        return None if log.fault else question(log), None
    except AnalysisError as problem:
        return None, str(problem).removeprefix(f"{question.__name__}: ")


def finite(number):
    """Return a float, or None where there is no finite number: JSON has no other."""
    return float(number) if math.isfinite(number) else None


def describe(report):
    """Return the report of a run in words, one line each."""
    program, values = report["program"], report["parameters"]
    lines = [
        f"scene    {report['scene']}: " + (", ".join(f"{name} = {a:g}" for name, a in values.items()) or "no parameters"),
        f"program  {program['instructions']} instructions per tick, T = {program['T_s']:g} s"
        + "".join(f", {program[fact]}" for fact in ("method", "dtype") if fact in program),
        *(f"         left out: {note}" for note in program["left_out"]),
        f"run      {report['samples']} samples, {report['duration_s']:g} s",
    ]
    if report["fault"]:
        return "\n".join([*lines, f"fault    {report['fault']}"])
    lines += [f"missed   {report['missed']}"] if report["missed"] else []
    words = {name: report[name]["words"] if report[name] else report["left_open"][name] for name in ("chatter", "energy")}
    return "\n".join([
        *lines,
        f"chatter  {words['chatter']}",
        f"energy   {words['energy']}",
        f"force    at most {report['peak_force_N']:.4g} N",
    ])  # fmt: skip
