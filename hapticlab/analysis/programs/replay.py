"""What only feeds a view, run after the fact: a scene over the recorded motion of the handle, at a rate of its own."""

from __future__ import annotations

import operator
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.drawing import STYLES, axis_label, house_style, new_figure
from ...base.shows_itself import ShowsItself
from ...base.telemetry import Telemetry, check_record
from ...compiler.engines.engine import load
from ...compiler.prune.constant_coefficients import leaves
from ...compiler.tick.compile_scene import compile
from ...errors import AnalysisError, ProgramError
from ...scene.notation.symbols import T, delay, lag_of, n
from ...scene.notation.written import no_scene
from ...scene.scene import Scene

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ...base.annotations import PlantEngine


@dataclass(frozen=True)
class Replay(ShowsItself):
    """A record with the channels of a view beside it.

    Attributes
    ----------
    log : Telemetry
        The record, the view's channels added at every row: cubic between the rows where the view was computed.
    every : int
        Rows of the record a tick of the view.
    error : dict of str to float
        Largest difference from the same view computed at every row, in the channel's unit.
    size : dict of str to float
        Largest magnitude of each channel.
    instructions : int
        Of the view, a tick.
    """

    log: Telemetry
    every: int
    error: dict[str, float]
    size: dict[str, float]
    instructions: int
    units: dict[str, str] = field(repr=False, default_factory=dict)

    def plot(self) -> Figure:
        """A figure: each channel of the view over time."""
        with house_style():
            figure = new_figure(height=1.2 + 1.7 * len(self.error))
            rows = figure.subplots(len(self.error), 1, sharex=True, squeeze=False)[:, 0]
            for axes, (name, error) in zip(rows, self.error.items(), strict=True):
                scale, label = axis_label(name, self.units[name])
                axes.plot(self.log.t, scale * self.log.channels[name], **STYLES[0])
                axes.set(ylabel=label)
                axes.set_title(f"computed every {self.every} rows, error {error:.2g} {self.units[name]}", fontsize="small")
            rows[-1].set_xlabel("time t [s]")
        return figure

    def __str__(self) -> str:
        lines = [f"{self.instructions} instructions every {self.every} rows; largest difference from every row:"]
        for name, error in self.error.items():
            part = f" ({error / self.size[name]:.2g} of the largest)" if self.size[name] else ""
            lines.append(f"  {name:<12} {error:.3g} {self.units[name]}{part}")
        return "\n".join(lines)


def replay(view: Scene, log: Telemetry, *, every: int = 10, engine: PlantEngine = "auto", **options: Any) -> Replay:
    """Run a view over the recorded motion of the handle, at a slower rate than the record's.

    Parameters
    ----------
    view : Scene
        What is to be shown, such as ``hl.mechanics.requires(scene).view``; its force is not used.
    log : Telemetry
        x and v as the controller saw them move the view; parameters the record holds take its values and changes.
    every : int
        Rows of the record a tick of the view, >= 1. A view with memory of samples (a signal, a delay, x(n-1)) means
        something else at another rate, and needs 1.
    engine : {"auto", "llvm", "wasm", "interpreter"}
    **options
        Of hapticlab.compile: method, substeps, hold, dtype.

    Returns
    -------
    Replay

    Raises
    ------
    AnalysisError, ProgramError, ParameterError

    Examples
    --------
    >>> import sympy as sp, hapticlab as hl
    >>> y, r = hl.coordinate("y", unit="m"), hl.parameters("r", units="1/s", values=5.0)
    >>> shown = hl.Scene(force=0, eom=[sp.Eq(y.diff(hl.t), r * (hl.x(hl.t) - y))], watch=[y])
    >>> log = hl.SimulatedPaddle(m=0.05, b=1.0, T=1e-3, hand=hl.Hand(push=1.0)).run(hl.wall()(k=100, x_o=0), duration=0.1)
    >>> result = replay(shown, log, every=10)
    >>> len(result.log.y), result.error["y"] < 0.01 * result.size["y"]
    (100, True)
    """
    check_record(log, "replay")
    if not isinstance(view, Scene):
        raise AnalysisError(no_scene(view, "needs a scene that watches something, such as hl.mechanics.requires(scene).view"))
    if not view.watch:
        raise AnalysisError(f"{view.name} watches nothing; give it hl.Scene(..., watch=[...])")
    every = _rows(every, view, len(log))
    given = {name: value for name, value in log.parameters.items() if name in view.parameters}
    view = view(**{**view.values, **given})
    options = {"velocity": "measured", **options}
    program, slow = _run(view, log, every, engine, options)
    full = slow if every == 1 else _run(view, log, 1, engine, options)[1]
    names = [c.name for c in program.outputs[1:]]
    units = {c.name: getattr(type(view.watch.get(c.name)), "unit", c.unit) for c in program.outputs[1:]}  # rad is no 1
    shown = {name: _between(slow[:, j], every, len(log)) for j, name in enumerate(names)}
    exact = {name: full[: len(log), j] for j, name in enumerate(names)}
    return Replay(
        replace(log, channels={**log.channels, **shown}, units={**log.units, **units}),
        every,
        {name: float(np.abs(shown[name] - exact[name]).max()) for name in names},
        {name: float(np.abs(exact[name]).max()) for name in names},
        len(program),
        units,
    )


def _rows(every, view, rows):
    try:
        count = 0 if isinstance(every, bool) else operator.index(every)
    except TypeError:
        count = 0
    if not 1 <= count <= max(1, rows - 1):
        raise ProgramError(f"every = {every!r}; needs a whole number of rows, from 1 to {max(1, rows - 1)} for this record")
    if count > 1:
        for expr in (*view.watch.values(), *(part for e in view.eom for part in getattr(e, "written", None) or e.args)):
            memory = _memory(expr)
            if memory is not None:
                raise ProgramError(
                    f"every = {count}: {memory} depends on the sampling period, so at a slower rate {view.name} would have "
                    "a different meaning. Replay it with every=1"
                )
    return count


def _memory(expr):
    """A part of an expression that belongs to the samples of one rate, or None."""
    for leaf in sorted(leaves(expr), key=str):
        role = getattr(type(leaf), "role", None)
        if leaf in (T, n) or isinstance(leaf, delay) or role == "signal" or (role == "handle" and lag_of(leaf)):
            return leaf
    return None


def _run(view, log, every, engine, options):
    """The program and its watched channels at every so many rows, one tick past the record's end."""
    program = compile(view, T=log.T * every, **options)
    at = np.arange(0, len(log) - 1 + every, every)
    over = np.maximum(at - (len(log) - 1), 0) * log.T  # the last tick may lie past the end: the handle goes on as it was
    rows = np.minimum(at, len(log) - 1)
    inputs = np.column_stack([log.x[rows] + over * log.v[rows], log.v[rows]])[:, : len(program.inputs)]
    loaded, values, states, done = load(program, engine), list(program.values), None, []
    starts = [0, *(int(np.searchsorted(log.t[rows], when - log.T / 2)) for when, _ in log.changes)]
    settings = [{}, *(set_ for _, set_ in log.changes)]
    for first, last, set_ in zip(starts, [*starts[1:], len(at)], settings, strict=True):
        values = [set_.get(c.name, value) for c, value in zip(program.parameters, values, strict=True)]
        if last > first:
            run = loaded.run(last - first, inputs[first:last], values, states)
            states = run.states
            done.append(run.outputs[:, 1:, 0])
    return program, np.concatenate(done)


def _between(values, every, rows):
    """A channel at every row, by the cubic through the four nearest ticks."""
    if every == 1 or len(values) < 4:
        return np.interp(np.arange(rows) / every, np.arange(len(values)), values)
    place = np.arange(rows) / every
    first = np.clip(place.astype(int) - 1, 0, len(values) - 4)
    s = place - first
    weights = (
        -(s - 1) * (s - 2) * (s - 3) / 6, s * (s - 2) * (s - 3) / 2, -s * (s - 1) * (s - 3) / 2, s * (s - 1) * (s - 2) / 6,
    )  # fmt: skip
    return sum(w * values[first + k] for k, w in enumerate(weights))
