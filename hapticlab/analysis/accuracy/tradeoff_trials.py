"""Trials of a trade-off: a setting compiled, run on the handle's motions, and its force compared with the reference."""

import functools
import math
import time
from dataclasses import dataclass, field, replace

import numpy as np

from ...compiler.boards.cost import costs
from ...compiler.engines.engine import load
from ...compiler.engines.table import ENGINES
from ...compiler.tick.compile_scene import compile
from ...errors import HapticlabError, ProgramLimitError
from .port_error import WILD, compared, counted
from .tradeoff_rows import OK, REFUSED, Status

#: runs of one motion of which the shortest time counts
TIMED = 3


@dataclass(frozen=True)
class Setting:
    """What a scene is compiled with."""

    method: str
    T: float
    substeps: int
    hold: str
    force_at: str
    precision: str


@dataclass(frozen=True)
class Trial:
    """What one setting was found to do.

    ``error`` holds the most, the root of the mean square and the most of the held force, as parts of the greatest force;
    ``seconds`` is a tick's time on this computer, ``estimated`` where it was not run on the engine that would run it;
    ``costs`` for each board a Cost, or why there is none.
    """

    setting: Setting
    status: Status = OK
    why: str = ""
    error: tuple = (math.nan, math.nan, math.nan)
    seconds: float = math.nan
    estimated: bool = False
    costs: dict = field(default_factory=dict)
    b_req: float | None = None
    b_where: str = ""
    margin: float | None = None
    steps_per_contact: float | None = None
    order: float | None = None

    @property
    def ran(self):
        """Whether it ran to the end."""
        return self.status == OK


def tried(bench, settings, again=False):
    """Return the Trials of settings that differ in the hold: those that compile to the same instructions are run once."""
    trials, programs = [], []
    for setting in settings:
        twin = next((trial for trial, _ in programs if _pair(trial.setting, setting) in bench.same), None)
        try:
            if not twin:
                program = compile(bench.scene, **bench.options(setting))
                twin = next((trial for trial, other in programs if other == (program.init, program.tick)), None)
            trial = _with_order(bench, twin, setting) if twin else _tried(bench, setting, program, again)
        except HapticlabError as refusal:
            trials.append(Trial(setting, REFUSED, str(refusal)))
            continue
        if twin:
            bench.same.add(_pair(twin.setting, setting))
        else:
            programs.append((trial, (program.init, program.tick)))
        trials.append(trial)
    return trials


def _pair(one, other):
    """A function that tells whether two settings that differ in the hold are one program, for every period."""
    return one.method, one.substeps, one.force_at, one.precision, one.hold, other.hold


def _with_order(bench, trial, setting):
    """Return a trial as that of a setting, with the order that is claimed for it."""
    claimed = bench.limits.order(setting.method, setting.hold, setting.force_at, bench.velocity) if trial.ran else None
    return replace(trial, setting=setting, order=claimed)


def _tried(bench, setting, program, again):
    """Return the Trial of a program: run, compared, timed, and costed for the boards."""
    loaded = load(program, _engine(program))
    trial = Trial(setting, costs=_costs(program, bench) if setting.precision == "float32" else {})
    errors = []
    for samples, known in zip(bench.samples(setting.T), bench.runs, strict=True):
        samples = of_program(program, samples)
        F = loaded.run(len(samples), samples).outputs[:, 0, 0]
        error = compared(F, known, setting.T, bench.delay)
        if error.unstable_at == error.unstable_at:
            why = f"during {known.motion.name} its force exceeds a hundred times the greatest, {known.peak:.3g} N"
            return replace(trial, status=Status("unstable", f"at t={error.unstable_at:.3g} s"), why=why)
        errors.append((error.max, error.rms, error.hold))
    most, rms, hold = np.transpose(errors) / bench.peak
    error = float(most.max()), float(np.sqrt(np.mean(rms**2))), float(hold.max())
    trial = replace(trial, error=error, seconds=_seconds(loaded, samples), estimated=loaded.name == "vm")
    if again:
        return trial
    margin, in_contact = bench.limits.steps(setting)
    b_req, where = bench.limits.damping(setting, program)
    trial = replace(trial, margin=margin, steps_per_contact=in_contact, b_req=b_req, b_where=where)
    return _with_order(bench, trial, setting)


def tried_again(bench, settings):
    """Return the Trials of settings that were tried with another precision: without what is the same in both."""
    return tried(bench, settings, again=True)


def timed(bench, settings):
    """Return Trials that hold the time of a tick on the engine that would run it here, that of the first for all."""
    program = compile(bench.scene, **bench.options(settings[0]))
    seconds = _seconds(load(program), of_program(program, bench.samples(settings[0].T)[-1]))
    return [Trial(setting, seconds=seconds) for setting in settings]


def of_program(program, samples):
    """Return of samples of (x, v) those that a program takes."""
    return samples[:, [0 if c.name == "x" else 1 for c in program.inputs]]


def sensor_floor(bench, key):
    """The error that an encoder alone makes, as a part of the greatest force, with a period and a hold.

    It is the difference of two runs of one program without error of its own steps, on true positions and on counted
    ones; nan where such a program is refused, or goes wild.
    """
    T, hold = key
    counts = getattr(bench.paddle, "counts_per_metre", None)
    if not counts:
        return math.nan
    options = {"T": T, "hold": hold, "velocity": bench.velocity, "live": ()}
    program = _first(bench.scene, ("exact", "taylor") if bench.scene.coordinates else ("rk4",), options)
    if program is None:
        return math.nan
    loaded, most = load(program, _engine(program)), 0.0
    for samples in bench.samples(T):
        seen = np.column_stack([counted(samples[:, 0], counts, bench.paddle.rounding), samples[:, 1]])
        both = [loaded.run(len(rows), of_program(program, rows)).outputs[:, 0, 0] for rows in (samples, seen)]
        if not np.abs(both).max() <= WILD * bench.peak:
            return math.nan
        most = max(most, float(np.abs(both[1] - both[0]).max()))
    return most / bench.peak


def _first(scene, methods, options):
    """Return the program by the first of some methods that takes the scene, None where none does."""
    for method in methods:
        try:
            return compile(scene, method, **options)
        except HapticlabError:
            continue
    return None


def _engine(program):
    """Return the engine of a program: for float32 the boards' own machine, which needs no time to compile."""
    return "vm" if program.outputs[0].type == "f32" and machine_is_here() else "auto"


@functools.cache
def machine_is_here():
    """Tell whether the boards' machine runs on this computer."""
    return ENGINES["vm"].is_here()


def _costs(program, bench):
    """Return for each board the cost, or in words why it takes no such program."""
    try:
        found = costs(program, bench.boards, every=bench.every)
    except ProgramLimitError as refusal:
        return dict.fromkeys(bench.boards, str(refusal))
    return {board: replace(one, program=None) for board, one in zip(bench.boards, found, strict=True)}


def _seconds(loaded, inputs):
    """Return the time of a tick on this computer [s], the shortest of some runs."""
    times = []
    for _ in range(TIMED):
        start = time.perf_counter()
        loaded.run(len(inputs), inputs)
        times.append(time.perf_counter() - start)
    return min(times) / len(inputs)
