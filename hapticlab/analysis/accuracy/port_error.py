"""How wrong the force of a program is at the handle: at the samples, held between them, and by what an encoder takes away."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from ...base.shows_itself import ShowsItself
from ...compiler.engines.engine import load
from ...compiler.events.taylor_method import Taylor
from ...compiler.ir.program import Program
from ...compiler.tick.compile_scene import compile
from ...errors import AnalysisError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ...base.annotations import Engine
    from ...scene.scene import Scene
    from .reference import Reference

#: of the Taylor series that a sensor floor is measured with
ORDER = 8
#: a force so many times the peak of the reference is no answer
WILD = 100


@dataclass(frozen=True)
class ForceError(ShowsItself):
    """Errors of a force, in N, and the size of what it was compared with.

    Attributes
    ----------
    max, rms : float
        Of F(n) against F(n T) [N]: what the method, the hold and the estimates got wrong.
    hold, hold_rms : float
        Of the held force against F(t) between the samples too [N]: what the hand feels.
    peak : float
        Largest \\|F(t)\\| [N].
    unstable_at : float
        When the force stopped being a number, or left a hundred times the peak [s]; nan where it did not.
    certified : bool
        Two solvers of the reference agree to a tenth of ``max``.
    """

    max: float
    rms: float
    hold: float
    hold_rms: float
    peak: float
    unstable_at: float = math.nan
    certified: bool = True

    @property
    def relative(self) -> float:
        """``max`` as a part of the peak; likewise :attr:`relative_hold`."""
        return self.max / self.peak if self.peak else math.inf if self.max else 0.0

    @property
    def relative_hold(self) -> float:
        """``hold`` as a part of the peak."""
        return self.hold / self.peak if self.peak else math.inf if self.hold else 0.0

    def __str__(self) -> str:
        text = f"{self.max:.3g} N at the samples ({self.relative:.2%} of {self.peak:.3g} N), rms {self.rms:.3g} N, "
        text += f"{self.hold:.3g} N with the hold"
        text += "" if math.isnan(self.unstable_at) else f"; unstable at t = {self.unstable_at:.3g} s"
        return text + ("" if self.certified else "; uncertified")


def force_error(
    program: Program | ArrayLike,
    reference: Reference,
    T: float | None = None,
    *,
    delay: float = 0.0,
    engine: Engine = "auto",
) -> ForceError:
    """Compare the force of a program with a reference, under the reference's motion of the handle.

    Parameters
    ----------
    program : Program, or array of forces [N]
        A program is run on the samples x(n T), and v(n T) where it takes them; forces are F(0), F(1), ..., one a period.
    reference : Reference
    T : float
        Sampling period [s], of forces; a program has its own.
    delay : float
        After which a force is felt [s], for the held error.
    engine : {"auto", "llvm", "wasm", "interpreter", "vm"}

    Returns
    -------
    ForceError

    Raises
    ------
    AnalysisError
        T is no whole number of the reference's step.

    Examples
    --------
    >>> import hapticlab as hl
    >>> from hapticlab.analysis.accuracy.handle_motions import handle_motions
    >>> from hapticlab.analysis.accuracy.reference import reference
    >>> scene, motion = hl.library.mass_spring_damper(), handle_motions()[1]
    >>> good, poor = (hl.compile(scene, T=1e-3, hold=hold) for hold in ("soh", "zoh"))
    >>> truth = reference(scene, motion)
    >>> force_error(good, truth).max < 0.02 * force_error(poor, truth).max
    True
    """
    if isinstance(program, Program):
        F, T = recorded(program, reference.motion, engine=engine), program.T
    else:
        F = np.asarray(program, float)
        if T is None:
            raise AnalysisError("an array of forces does not contain its period. Give T, such as force_error(F, reference, 1e-3)")
    return compared(F, reference, T, delay)


def recorded(program, motion, *, engine="auto", counts_per_metre=None, rounding="floor"):
    """Return F(n) of a program on the samples of a motion, which an encoder counts where one is given."""
    times = program.T * np.arange(math.floor(motion.duration / program.T * (1 + 1e-12)) + 1)
    position, velocity, _ = motion.at(times)
    if counts_per_metre:
        position = counted(position, counts_per_metre, rounding)
    columns = {"x": position, "v": velocity}
    if {c.name for c in program.inputs} - set(columns):
        raise AnalysisError(f"{program.name} needs {program.inputs[-1].name}; a motion of the handle has only x and v")
    inputs = np.column_stack([columns[c.name] for c in program.inputs]) if program.inputs else None
    return load(program, engine).run(len(times), inputs).outputs[:, 0, 0]


def counted(x, counts_per_metre, rounding="floor"):
    """Return positions as an encoder counts them: floor(x c)/c, or floor(x c + 1/2)/c for "nearest"."""
    return np.floor(x * counts_per_metre + (0.5 if rounding == "nearest" else 0.0)) / counts_per_metre


def compared(F, reference, T, delay=0.0):
    """Return the :class:`ForceError` of forces F(n), one a period T."""
    step = reference.step
    per = round(T / step)
    if per < 1 or abs(per * step - T) > 1e-9 * T:
        raise AnalysisError(
            f"T = {T:g} s, but the reference is known every {step:g} s. Give a step that divides T, "
            f"reference(scene, motion, step={T / 8:g})"
        )
    ticks = min(len(F), (len(reference.t) - 1) // per + 1, math.floor(reference.horizon / T * (1 + 1e-12)) + 1)
    if ticks < 2:
        raise AnalysisError(f"the reference is known up to {reference.horizon:g} s only; T = {T:g} s is too long for it")
    F, peak = F[:ticks], reference.peak
    wild = np.flatnonzero(~(np.abs(F) <= WILD * peak)) if peak else np.flatnonzero(~np.isfinite(F))
    unstable = T * float(wild[0]) if len(wild) else math.nan
    true = reference.F[: ticks * per : per][:ticks]
    with np.errstate(invalid="ignore", over="ignore"):
        at_samples = F - true
        held, felt = np.repeat(F, per), _felt(reference, ticks * per + 1, delay)
        begins, ends = held - felt[:-1], held - felt[1:]
        steps = max(math.floor((reference.horizon - delay) / step + 1e-9), 0)
        begins, ends = begins[: max(steps, 1)], ends[: max(steps, 1)]
        size, hold = np.abs(at_samples), np.maximum(np.abs(begins), np.abs(ends))  # the end: just before the next force
        square = np.mean(begins**2 + begins * ends + ends**2) / 3  # of a line from one to the other
        errors = size.max(), np.sqrt(np.mean(size**2)), hold.max(), np.sqrt(square)
    errors = [float(e) if math.isfinite(e) else math.inf for e in errors]
    return ForceError(*errors, peak, unstable, reference.certifies(errors[0]))


def _felt(reference, count, delay):
    """Return F at the times at which held forces are felt, between two values of it along a line; the last one past its end."""
    late = delay / reference.step
    late = round(late) if abs(late - round(late)) < 1e-9 else late
    return np.interp(np.arange(count) + late, np.arange(len(reference.F)), reference.F)


@dataclass(frozen=True)
class SensorFloor(ShowsItself):
    """Error of the force that an encoder alone causes [N], whatever the method, and the peak that it is a part of."""

    max: float
    rms: float
    peak: float

    @property
    def relative(self) -> float:
        """``max`` as a part of the peak."""
        return self.max / self.peak if self.peak else math.inf if self.max else 0.0

    def __str__(self) -> str:
        return f"{self.max:.3g} N ({self.relative:.2%} of {self.peak:.3g} N), rms {self.rms:.3g} N"


def sensor_floor(
    scene: Scene | Program,
    reference: Reference,
    counts_per_metre: float,
    T: float,
    *,
    rounding: Literal["floor", "nearest"] = "floor",
    **options: Any,
) -> SensorFloor:
    """Error that an encoder alone causes: the force of counted positions against that of true ones, by one program.

    Its own error is in both forces and cancels; what is left no method takes away. Velocities are backward differences in
    both, so one count also is 1/(c T) of velocity.

    Parameters
    ----------
    scene : Scene or Program
        A program has its own T.
    reference : Reference
        For its motion, its horizon and its peak.
    counts_per_metre : float
        [1/m]
    T : float
        Sampling period [s].
    rounding : {"floor", "nearest"}
    **options
        Of :func:`hapticlab.compile`. Without them "taylor" of float64, located and of high order.

    Returns
    -------
    SensorFloor

    Examples
    --------
    >>> import hapticlab as hl
    >>> from hapticlab.analysis.accuracy.handle_motions import handle_motions
    >>> from hapticlab.analysis.accuracy.reference import reference
    >>> wall = hl.Scene(force=hl.parameters("k", units="N/m", values=500) * hl.x(hl.n))
    >>> floor = sensor_floor(wall, reference(wall, handle_motions()[0]), 1e5, 1e-3)
    >>> 0.9 < floor.max / (500 * 1e-5) <= 1        # a count of 10 um
    True
    """
    if not (math.isfinite(counts_per_metre) and counts_per_metre > 0):
        raise AnalysisError(f"counts_per_metre = {counts_per_metre}; needs a finite number > 0 of counts per metre")
    taken: dict[str, Any] = {"method": Taylor(order=ORDER), "dtype": "float64"} | options
    program = scene if isinstance(scene, Program) else compile(scene, T=T, live=(), **taken)
    true = recorded(program, reference.motion)
    counted_ = recorded(program, reference.motion, counts_per_metre=counts_per_metre, rounding=rounding)
    error = np.abs(counted_ - true)[: math.floor(reference.horizon / program.T * (1 + 1e-12)) + 1]
    return SensorFloor(float(error.max()), float(np.sqrt(np.mean(error**2))), reference.peak)
