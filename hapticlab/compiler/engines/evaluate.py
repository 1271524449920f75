"""A compiled program over a motion of the handle that is given, without a paddle: what it computes, sample by sample."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...base.missed_events import warn_of_missed
from ...base.telemetry import Telemetry
from ...errors import ParameterError, ProgramError
from ...scene.notation.parameters import Parameter
from .engine import load

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...base.annotations import Array, Engine
    from ..ir.program import Program


def evaluate(
    program: Program,
    *,
    x: Sequence[float] | Array,
    v: Sequence[float] | Array | None = None,
    engine: Engine = "auto",
    **values: float | str,
) -> Telemetry:
    """Run a compiled program over given samples of the handle and return the force and the channels.

    Nothing pushes the handle back: it moves as it is told. ``paddle.run(scene, duration=...)`` closes the loop.

    Parameters
    ----------
    program : Program
        Of :func:`hapticlab.compile`.
    x : sequence of float
        Handle position [m], one a sample.
    v : sequence of float, optional
        Handle velocity [m/s], for a program that was compiled with ``velocity="measured"``; others estimate it.
    engine : {"auto", "llvm", "wasm", "interpreter", "vm"}
    **values : float or str
        Parameters by name, SI or texts with a unit; the program's own values unless given.

    Returns
    -------
    Telemetry
        ``t``, ``x``, ``v`` (a backward difference where none was given), ``F``, and each channel by its name.

    Raises
    ------
    ProgramError, ParameterError

    Examples
    --------
    >>> import hapticlab as hl
    >>> program = hl.compile(hl.wall()(k=150), T="1 ms", dtype="float64")
    >>> hl.records.evaluate(program, x=[0.0, 0.005, 0.012], x_o="10 mm").F.round(12)
    array([0. , 0. , 0.3])
    """
    given = {"x": _column("x", x)} | ({} if v is None else {"v": _column("v", v)})
    T, position = program.T, given["x"]
    wanted = [c.name for c in program.inputs]
    if "v" in wanted and v is None:
        raise ProgramError(f"{program.name} was compiled with velocity='measured'; give v=, one value per sample")
    if v is not None and (len(given["v"]) != len(position) or "v" not in wanted):
        cure = "give as many values as x has" if "v" in wanted else "the program estimates v from x. Leave out v, or watch it"
        raise ProgramError(f"{program.name}: v has {len(given['v'])} values, x {len(position)}; {cure}")
    rows = np.column_stack([given[name] for name in wanted]) if wanted else None
    numbers = _values(program, values)
    outputs = load(program, engine).run(len(position), rows, [*numbers.values()]).outputs[:, :, 0]
    found = dict(zip((c.name for c in program.outputs), outputs.T, strict=True))
    log = Telemetry(
        t=T * np.arange(len(position)), x=position, v=given.get("v", np.diff(position, prepend=position[:1]) / T),
        F=found.pop("F"), T=T, channels=found, units=program.units,
        paddle="a handle that moves as it is told", scene=program.name, parameters=numbers,
    )  # fmt: skip
    return warn_of_missed(log)


def _column(name, given):
    array = np.asarray(given)
    if array.dtype.kind not in "iuf" or array.ndim != 1 or not array.size or not np.isfinite(array).all():
        raise ProgramError(f"{name} has shape {array.shape}; needs one finite number per sample, x=[0, 0.001, 0.002]")
    return array.astype(float)


def _values(program, given):
    """name -> value of every parameter of the program, those that are given checked as its scene would."""
    declared = {c.name: Parameter(c.name, c.unit, c.low, c.high) for c in program.parameters}
    if unknown := sorted(given.keys() - declared.keys()):
        known = ", ".join(declared) or "none"
        raise ParameterError(f"{unknown[0]} is not a live parameter of {program.name}. It has {known}")
    values = dict(zip(declared, program.values, strict=True))
    return values | {name: declared[name].check(value) for name, value in given.items()}
