"""The three figures of one design: error at the handle, load of the board, passivity margin; or why it is not feasible."""

from __future__ import annotations

import functools
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.arguments import having
from ...base.shows_itself import ShowsItself
from ...compiler.boards.cost import cost
from ...compiler.engines.engine import load
from ...compiler.tick.compile_scene import compile
from ...errors import HapticlabError
from ..accuracy.port_error import WILD, compared
from ..accuracy.tradeoff_trials import Setting, machine_is_here
from .design import NoDesign, design_of

if TYPE_CHECKING:
    from .task import Task

#: digits of error and load, and decimals of the margin: more than a hand notices, far fewer than a platform changes
DIGITS = 3
#: ticks for each sample of telemetry, part of the load
EVERY = 10
#: characters of a reason
REASON = 300


@dataclass(frozen=True)
class MeasuredDesign(ShowsItself):
    """What one design was measured to do on a task; nan for figures that a design that is not feasible does not have.

    Attributes
    ----------
    design : dict
    error : float
        Root mean square of the held force minus the ideal force during the motion [% of the greatest ideal force].
    sensor_floor : float
        The part of the error that the encoder causes [% of the greatest ideal force].
    load : float
        Cycles of a tick over the cycles of a period [%].
    margin : float
        Damping of the paddle minus the damping that passivity requires [N s/m]. Of a scene that is not linear the
        requirement is that of small motions.
    why : str
        Why the design is not feasible; empty where it is.
    """

    design: Mapping[str, Any]
    error: float = math.nan
    sensor_floor: float = math.nan
    load: float = math.nan
    margin: float = math.nan
    why: str = ""

    @property
    def feasible(self) -> bool:
        """Whether the design has figures."""
        return not self.why

    @property
    def figures(self) -> tuple[float, float, float]:
        """(error [%], load [%], margin [N s/m])."""
        return self.error, self.load, self.margin

    def dominates(self, other: MeasuredDesign) -> bool:
        """Whether no figure is worse than the other's, and one is better."""
        mine, others = ((one.error, one.load, -one.margin) for one in (self, other))
        no_worse = mine != others and all(a <= b for a, b in zip(mine, others, strict=True))
        return self.feasible and (not other.feasible or no_worse)

    def __str__(self) -> str:
        if self.why:
            return f"not feasible: {self.why}"
        return (
            f"error {self.error:.3g} % (of which the encoder {self.sensor_floor:.3g} %), load {self.load:.3g} %, "
            f"passivity margin {self.margin:.3g} N s/m"
        )


def measured(task: Task, design: Mapping[str, Any]) -> MeasuredDesign:
    """Measure one design of a task: error at the handle, load of the board, passivity margin.

    The program runs on the positions that the encoder counts during the task's motion, as on the board, in float32. Error
    and load are rounded to 3 digits and the margin to 0.001 N s/m; two platforms may differ by one unit of the last digit.

    Parameters
    ----------
    task : Task
    design : dict
        The names that ``task.takes`` lists: ``method``, ``T`` [s], ``substeps``, ``hold`` for a scene with motion, ``law``,
        ``velocity``, ``tau`` [s] for a wall.

    Returns
    -------
    MeasuredDesign
        No error is raised for a design that is not feasible: ``why`` says exactly what is wrong with it.

    Raises
    ------
    AnalysisError
        For what is no task.

    Examples
    --------
    >>> import hapticlab as hl
    >>> mass = hl.design.task("mass")
    >>> hl.design.measured(mass, {"method": "rk4", "hold": "soh", "T": 1e-3}).why[:26]
    'it does not fit the board:'
    """
    having(task, "a task, such as hl.design.task('wall')", "takes")
    try:
        chosen = design_of(task, design)
    except NoDesign as problem:
        return MeasuredDesign(dict(design) if isinstance(design, Mapping) else {}, why=f"{problem}")
    return _measured(task, chosen, tuple(design))


@functools.lru_cache(maxsize=4096)
def _measured(task, chosen, names):
    design = {name: getattr(chosen, name) for name in names}
    try:
        error, floor, taken, margin, why = _figures(task, chosen)
    except HapticlabError as problem:
        return MeasuredDesign(design, why=" ".join(str(problem).split())[:REASON])
    parts = (float(f"{100 * one:.{DIGITS}g}") for one in (error, floor, taken))
    return MeasuredDesign(design, *parts, round(margin, DIGITS) + 0.0, why)  # no sign on a zero


def _figures(task, design):
    """Return (error, sensor floor, load, margin, why not)."""
    scene = task.scene(design)
    program, limits = compile(scene, T=design.T, live=(), **_options(design)), task.limits(scene)
    taken = cost(program, task.board, every=EVERY)
    nothing = math.nan, math.nan, taken.share, math.nan
    if not taken.fits:
        return *nothing, f"it does not fit the board: {taken.memory_problem or taken.in_words()}"
    setting = Setting(design.method, design.T, design.substeps, design.hold, "before", "float32")
    ratio, _ = limits.steps(setting)
    if ratio is not None and ratio < 1:
        step = 1e3 * design.T / design.substeps
        stable = f"{design.method} is stable up to a step of {ratio * step:.3g} ms"
        return *nothing, f"it is unstable: {stable}, and this step is {step:.3g} ms"
    loaded = load(program, "vm" if machine_is_here() else "auto")  # which needs no time to compile
    true, seen = (_forces(task, loaded, program, positions) for positions in task.positions(design.T))
    found = compared(seen, task.reference, design.T, task.paddle.delay)
    if not math.isnan(found.unstable_at) or not np.isfinite(true).all():
        wild = f"its force exceeds {WILD} times the greatest ideal force at t = {found.unstable_at:.3g} s"
        return *nothing, f"it is unstable: {wild}"
    required, _ = limits.damping(setting, program)
    if required is None or not math.isfinite(required):
        return *nothing, "it is not passive with any damping of the paddle"
    floor = float(np.sqrt(np.mean((seen - true) ** 2))) / found.peak
    return found.hold_rms / found.peak, floor, taken.share, task.paddle.b - required, ""


def _options(design):
    return {"method": design.method, "hold": design.hold, "substeps": design.substeps}


def _forces(task, loaded, program, positions):
    """Return the force at the samples that the motor gives [N]."""
    F = loaded.run(len(positions), positions[:, None][:, : len(program.inputs)]).outputs[:, 0, 0]
    most = task.paddle.force_max
    return np.clip(F, -most, most) if most else F
