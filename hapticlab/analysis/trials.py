"""Trials of a trade-off: a setting compiled, run on the handle's motions, and its force compared with the reference."""

import functools
import math
import time
from dataclasses import dataclass, field, replace

import numpy as np

from ..compiler.cost import cost
from ..compiler.engine import load
from ..compiler.lower import compile
from ..compiler.vm import machine
from ..errors import EngineMissingError, HapticlabError, ProgramLimitError
from .port_error import compared, counted
from .tradeoff_rows import OK
from .trial_limits import Limits

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
    ``costs`` for each board a Cost, or why there is none.
    """

    setting: Setting
    status: str = OK
    why: str = ""
    error: tuple = (math.nan, math.nan, math.nan)
    seconds: float = math.nan
    costs: dict = field(default_factory=dict)
    b_req: float | None = None
    margin: float | None = None
    steps_per_contact: float | None = None
    order: float | None = None


@dataclass(frozen=True, eq=False)
class Bench:
    """What all settings of a scene are tried on.

    Attributes
    ----------
    scene, paddle
    runs : tuple of Reference
        Each with its motion.
    boards : tuple of str
    every, velocity, live
        As of :func:`~hapticlab.analysis.tradeoff.tradeoff`.
    """

    scene: object
    paddle: object
    runs: tuple
    boards: tuple
    every: int
    velocity: str
    live: object = ()

    @functools.cached_property
    def peak(self):
        """Greatest force of the reference [N]."""
        return max(known.peak for known in self.runs)

    @property
    def doubt(self):
        """By which part of the greatest force the solvers of the reference differ."""
        return max(known.agreement for known in self.runs) / self.peak

    @property
    def chaotic(self):
        """From when on rounding decides the motion [s]; None where it does not."""
        return min((known.horizon for known in self.runs if known.chaotic), default=None)

    @functools.cached_property
    def limits(self):
        """Of stability and passivity, for all settings."""
        return Limits(self.scene)

    def options(self, setting):
        """Return the options of :func:`hapticlab.compile` of a setting or a row."""
        made = {name: getattr(setting, name) for name in ("method", "T", "substeps", "hold", "force_at")}
        return made | {"dtype": setting.precision, "velocity": self.velocity, "live": self.live}

    @functools.lru_cache(maxsize=8)  # noqa: B019  it lives as long as its worker
    def samples(self, T):
        """Return the samples x, v of each motion, arrays of shape (ticks, 2)."""
        counts = [round(known.horizon / T) for known in self.runs]
        return [np.stack(known.motion.at(T * np.arange(n))[:2], 1) for n, known in zip(counts, self.runs, strict=True)]


def tried(bench, setting, again=False):
    """Return the Trial of a setting: compiled, run, compared, timed, and costed for the boards."""
    try:
        program = compile(bench.scene, **bench.options(setting))
        loaded = load(program, _engine(program))
    except HapticlabError as refusal:
        return Trial(setting, "refused", str(refusal))
    boards = bench.boards if setting.precision == "float32" else ()
    trial = Trial(setting, costs={board: _cost(program, board, bench.every) for board in boards})
    columns, errors = [0 if c.name == "x" else 1 for c in program.inputs], []
    for samples, known in zip(bench.samples(setting.T), bench.runs, strict=True):
        F = loaded.run(len(samples), samples[:, columns]).outputs[:, 0, 0]
        error = compared(F, known, setting.T)
        if error.unstable_at == error.unstable_at:
            why = f"during {known.motion.name} its force passes a hundred times the greatest, {known.peak:.3g} N"
            return replace(trial, status=f"unstable at t={error.unstable_at:.3g} s", why=why)
        errors.append((error.max, error.rms, error.hold))
    most, rms, hold = np.transpose(errors) / bench.peak
    error = float(most.max()), float(np.sqrt(np.mean(rms**2))), float(hold.max())
    trial = replace(trial, error=error, seconds=_seconds(loaded, samples[:, columns]))
    if again:
        return trial
    margin, in_contact = bench.limits.steps(setting)
    order = bench.limits.order(setting.method, setting.hold, setting.force_at, bench.velocity)
    b_req = bench.limits.damping(setting, program)
    return replace(trial, margin=margin, steps_per_contact=in_contact, b_req=b_req, order=order)


def tried_again(bench, setting):
    """Return the Trial of a setting that was tried with another precision: without what is the same in both."""
    return tried(bench, setting, again=True)


def sensor_floor(bench, key):
    """Return which part of the greatest force an encoder alone makes of error, with a period and a hold.

    It is the difference of two runs of one program, on true positions and on counted ones.
    """
    T, hold = key
    counts = getattr(bench.paddle, "counts_per_metre", None)
    if not counts:
        return math.nan
    options = {"T": T, "hold": hold, "velocity": "backward_difference", "live": ()}
    try:
        program = compile(bench.scene, "rk4", **options)
    except HapticlabError:
        program = compile(bench.scene, "taylor", **options)
    loaded = load(program, _engine(program))
    most = 0.0
    for samples in bench.samples(T):
        x = samples[:, :1]
        true, seen = (loaded.run(len(x), rows).outputs[:, 0, 0] for rows in (x, counted(x, counts, bench.paddle.rounding)))
        most = max(most, float(np.abs(seen - true).max()))
    return most / bench.peak


def _engine(program):
    """Return the engine of a program: for float32 the boards' own machine, which needs no time to compile."""
    return "vm" if program.outputs[0].type == "f32" and machine_is_here() else "auto"


@functools.cache
def machine_is_here():
    """Tell whether the boards' machine runs on this computer."""
    try:
        machine(16)
    except EngineMissingError:
        return False
    return True


def _cost(program, board, every):
    try:
        return replace(cost(program, board, every=every), program=None)
    except ProgramLimitError as refusal:
        return str(refusal)


def _seconds(loaded, inputs):
    """Return the time of a tick on this computer [s], the shortest of some runs."""
    times = []
    for _ in range(TIMED):
        start = time.perf_counter()
        loaded.run(len(inputs), inputs)
        times.append(time.perf_counter() - start)
    return min(times) / len(inputs)
