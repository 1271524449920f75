"""Why a simulated run stopped: what was not finite, when, and what to look for."""

from ...compiler.ir.elementary import TABLES
from ...compiler.ir.notes import UndefinedForceNote


def not_finite(program, code, tick, T):
    """Return in words what stopped a linked program.

    Parameters
    ----------
    program : Program
        The scene's.
    code : float
        The linked program's output ``fault``, not 0: see :func:`hapticlab.device.simulated.closed_loop.link`.
    tick : int
        Where it was raised.
    T : float
        Sampling period [s].
    """
    culprit = f"{culprits(program)[int(code) - 1]} of {program.name}"
    when = f"tick {tick} (t = {tick * T:g} s)"
    return f"{when}: {culprit} was not finite; the motor is off from then on{likely_cause(program)}"


def culprits(program):
    """Return what may be not finite in words, in the order of the numbers of ``fault``, 1 first."""
    watched = (f"the watched {c.name}" for c in program.outputs[1:])
    return ["the force F", *watched, *(f"the state {c.name}" for c in program.states)]


def likely_cause(program):
    """The likely cause of a program's stop: what its notes say, an angle past all sines; else nothing."""
    left = [note.where for note in program.notes if isinstance(note, UndefinedForceNote)]
    likely = f". Most likely {' or '.join(left)}" if left else ""
    if not any(i.op in ("sin", "cos") for i in program.tick.instructions):
        return likely
    real = program.outputs[0].type
    dtype = "float32" if real == "f32" else "float64"
    longer = f"use dtype='float64' (sines up to {TABLES['f64'].angle_limit:g} rad), or " if real == "f32" else ""
    return (
        f"{likely}. Look for an angle beyond {TABLES[real].angle_limit:g} rad, which has no sine in {dtype}: {longer}keep the "
        "angle within a turn by a signal, sp.Eq(turn(n), (turn(n-1) + w*T) % (2*sp.pi))"
    )
