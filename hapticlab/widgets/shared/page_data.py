"""What a page needs to run a scene by itself, as plain data for JSON: programs, values, limits, words."""

import base64
import math
from dataclasses import replace

from ...analysis.pictures.touching import recorded_touching
from ...base.telemetry import UNITS
from ...compiler.engines.wasm_emit import emit
from ...compiler.ir.notes import why_of
from ...compiler.tick.live_limits import limits_apart
from ...device.simulated.closed_loop import link
from ...device.simulated.not_finite import culprits, likely_cause
from ...scene.notation.parameters import Parameter
from ..browser_view import about


def page_data(stage):
    """Return the data of a page.

    Parameters
    ----------
    stage : Stage
        Of a scene on a simulated paddle.

    Returns
    -------
    dict
        ``about``, as a view has it. ``programs``: of the loop with a hand on the handle, ``held``, and without, ``free``,
        the ``code`` of a module of the engine wasm in base64 and the names of its inputs, parameters, states and outputs.
        ``plant``: of both, the values of the parameters after the scene's. ``parameters``: of each of the scene's, its
        value, range and limits, and what is said of a value beyond its range. ``picture`` and ``touching``: the moving
        picture and the contact, recorded. ``noise``: standard deviations of the inputs that are noise; ``seed``. ``faults``:
        what may be not finite, in the order of the fault's numbers, and why.
    """
    program, paddle = stage.source.program, stage.source.paddle
    paddles = {"held": paddle, "free": replace(paddle, hand=None)}
    return {
        "about": about(stage),
        "scene": program.name,
        "T": paddle.T,
        "delay": paddle.delay,
        "sensor_delay": paddle.sensor_delay,
        "paddle": str(paddle),
        "units": {**UNITS, **program.units, "intent": "m"},
        "start": stage.source.place,
        "seed": int(paddle.seed),  # NumPy has integers that JSON has not
        "force_max": paddle.force_max,
        "watched": list(stage.motion.watched),
        "programs": {name: _module(link(program, one)) for name, one in paddles.items()},
        "plant": {name: list(one.plant_values()) for name, one in paddles.items()},
        "parameters": parameters_told(program),
        "picture": stage.picture.recording(),
        "touching": recorded_touching(stage.scene, stage.scene.watch),
        "noise": {"noise": paddle.noise, "hand.push_noise": paddle.hand.push_noise},
        "faults": {"names": culprits(program), "cause": likely_cause(program)},
    }


def _module(linked):
    names = {what: [c.name for c in getattr(linked, what)] for what in ("inputs", "parameters", "states", "outputs")}
    return {"code": base64.b64encode(emit(linked)).decode(), **names}


def parameters_told(program):
    """What a page must know of a program's parameters to refuse a value in words."""
    limits = limits_apart(program)
    return [
        {
            **{"name": c.name, "unit": c.unit, "value": value, "low": _finite(c.low), "high": _finite(c.high)},
            "limits": [_finite(end) for end in limits[c.name][::2]] if c.name in limits else None,
            **Parameter(c.name, c.unit, c.low, c.high).needs(),
            "why": why_of(program.notes, c.name),
        }
        for c, value in zip(program.parameters, program.values, strict=True)
    ]


def _finite(number):
    return float(number) if math.isfinite(number) else None
