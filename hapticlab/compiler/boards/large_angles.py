"""How often the angles of a program's sines lie beyond an eighth of a turn, where a board takes longer over them."""

import math
from dataclasses import replace

import numpy as np

from ...errors import EngineMissingError
from ..engines.engine import load
from ..ir.program import Channel


def reference_motion(ticks, T):
    """Return a smooth motion of the handle, five sines of 4 mm each [m]; what a program's angles are looked at with."""
    at = np.arange(ticks) * T
    return 4e-3 * sum(np.sin(w * at + phase) for w, phase in ((3, 3.1), (7, 5.7), (11, 0.9), (17, 5.7), (29, 1.9)))


def far_angles(program):
    """Return (operation, part of the ticks) of each sine and cosine: how often its angle is beyond an eighth of a turn.

    The machine of this computer runs the program for a second. Where it cannot, or a parameter has no value, there is none.
    """
    turned = [i for i in program.tick.instructions if i.op in ("sin", "cos")]
    if not turned or len(program.inputs) != 1 or any(v != v for v in program.values):
        return []
    outputs = tuple(Channel(f"angle{k}") for k in range(len(turned)))
    tick = replace(program.tick, outputs=tuple(i.args[0] for i in turned))
    try:
        machine = load(replace(program, tick=tick, outputs=outputs), "vm")
    except EngineMissingError:
        return []
    ticks = max(10, round(1 / program.T))
    angles = machine.run(ticks, reference_motion(ticks, program.T)[:, None]).outputs[..., 0]
    far = (np.abs(angles) > math.pi / 4).mean(axis=0)
    return [(i.op, float(part)) for i, part in zip(turned, far, strict=True)]
