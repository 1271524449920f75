"""The force that a scene would give without samples: two solvers that share no step, and how far they agree."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...base.shows_itself import ShowsItself
from ...compiler.algebra.graph import Graph
from ...compiler.algebra.graph import driven as turning
from ...compiler.engines.engine import load
from ...errors import AnalysisError, LongStepError, ProgramError
from ...scene.notation.symbols import acceleration, n, t, v, x
from .accelerations_at import instant
from .continuous_handle import DEGREE, coefficients, driven, without_samples
from .handle_motions import HandleMotion
from .hybrid_solver import Field, Hybrid
from .reference_plot import plot_reference

if TYPE_CHECKING:
    from collections.abc import Iterable

    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike

    from ...base.annotations import Array
    from ...compiler.ir.program import Program
    from ...scene.scene import Scene

#: between two values of F [s]: 2 ms, 1 ms and 0.5 ms are whole numbers of it, and so are their quarters
STEP = 1.25e-4
#: of the Taylor series; at most one radian of the fastest part is in a substep
ORDER = 10
#: part of the peak force to which two solvers must agree to certify each other
TOLERANCE = 1e-6
#: part of the peak force by which two solvers that agreed at first differ where rounding decides: chaos
APART = 1e-3
#: into which a step is divided where the motion is fast
MOST_PARTS = 256
#: of the values of F, those at which the second solver is asked
EVERY = 16


@dataclass(frozen=True, eq=False)
class Reference(ShowsItself):
    """F(t) of a scene whose handle moves as given, without sampling, hold and method.

    Attributes
    ----------
    motion : HandleMotion
    t, F : arrays
        Time [s], every ``step``, and force [N].
    agreement : float
        Largest difference between the two solvers up to the horizon [N]; inf where there is one only.
    how : str
        The solvers, or why there is but one.
    horizon : float
        Until when F is known [s]: from there on two solvers separate, or the scene faults.
    chaotic : bool
        They agreed first and separated later: rounding decides what comes after the horizon.
    step : float
        [s]
    allowed : float
        Difference of the solvers up to which ``certified`` is true [N].
    """

    motion: HandleMotion
    t: Array
    F: Array
    agreement: float
    how: str
    horizon: float
    chaotic: bool = False
    step: float = STEP
    allowed: float = 0.0

    @property
    def peak(self) -> float:
        """Largest force up to the horizon [N]."""
        return float(np.abs(self.F[self.t <= self.horizon]).max(initial=0.0))

    @property
    def faulted(self) -> bool:
        """Whether the force stops being a number before the motion ends."""
        return not np.isfinite(self.F).all()

    @property
    def certified(self) -> bool:
        """Whether two solvers agree to the tolerance, as a part of the largest force of all motions asked for."""
        return self.agreement <= self.allowed

    def certifies(self, error: float) -> bool:
        """Tell whether the solvers agree ten times better than an error [N] that is to be reported."""
        return self.agreement <= 0.1 * error

    def at(self, times: ArrayLike) -> Array:
        """Return F [N] at times [s] that are whole numbers of the step, nan past the horizon."""
        times = np.asarray(times, float)
        k = np.rint(times / self.step)
        if np.any(np.abs(times - k * self.step) > 1e-9) or np.any((k < 0) | (k >= len(self.t))):
            raise AnalysisError(
                f"F is known every {self.step:g} s up to {self.t[-1]:g} s. Use times that are multiples of that step, or "
                "give reference(..., step=...) a step that divides your sampling period"
            )
        return np.where(times <= self.horizon + 1e-9, self.F[k.astype(int)], np.nan)

    def plot(self, *programs: Program) -> Figure:
        """Return a figure: motion and force; with compiled programs, the forces that these hold and their errors."""
        return plot_reference(self, programs)

    def __str__(self) -> str:
        verdict = "certified" if self.certified else "uncertified"
        until = f", chaotic after {self.horizon:.3g} s" if self.chaotic else ""
        until += f", not finite after {self.horizon:.3g} s, where the scene faults" if self.faulted else ""
        agreed = f"two solvers agree to {self.agreement:.2g} N of {self.peak:.3g} N"
        agreed = agreed if np.isfinite(self.agreement) else f"one solver, whose force is at most {self.peak:.3g} N"
        return f"{self.motion.name}: {verdict}, {agreed}{until} ({self.how})"


def reference(scene: Scene, motion: HandleMotion, *, step: float = STEP, tolerance: float = TOLERANCE) -> Reference:
    """Return the force of a scene as its equations have it, under one motion of the handle.

    Parameters
    ----------
    scene : Scene
        With every parameter bound.
    motion : HandleMotion
        Motion of the handle.
    step : float
        Largest step of the solver [s], > 0.
    tolerance : float
        Relative tolerance of the solver, > 0.
    """
    return references(scene, [motion], step=step, tolerance=tolerance)[0]


def references(
    scene: Scene, motions: Iterable[HandleMotion], *, step: float = STEP, tolerance: float = TOLERANCE
) -> list[Reference]:
    """The force of a scene as its equations have it, for each of some motions of the handle: a list of :class:`Reference`.

    First solver: the Taylor series of the motion, events located, the handle a polynomial of degree 6 over each step.
    Second: scipy's DOP853, or LSODA where that is too stiff for it, on the accelerations compiled by themselves, events
    found on its dense output.

    Parameters
    ----------
    scene : Scene
        Every parameter bound. It must have a meaning between the samples: past samples and T become what they are
        for T towards zero, so that past samples and delayed forces are those of now; signals have no meaning.
    motions : sequence of HandleMotion
    step : float
        Between two values of F [s]; the sampling periods it is compared with are whole numbers of it.
    tolerance : float
        Part of the peak force to which the two must agree.

    Raises
    ------
    AnalysisError
        The scene lives at the samples alone.

    Examples
    --------
    >>> import hapticlab as hl
    >>> from hapticlab.analysis.accuracy.handle_motions import handle_motions
    >>> found = reference(hl.library.mass_spring_damper(), handle_motions()[1])
    >>> found.certified
    True
    """
    return _References(scene, step, tolerance).all(motions)


class _References:
    """The programs of one scene, compiled once for all its motions."""

    def __init__(self, scene, step, tolerance):
        self.scene, self.step, self.tolerance = scene, step, tolerance
        try:
            self.program, self.parts = _slow_enough(scene, step)
        except ProgramError as error:
            raise AnalysisError(f"{scene.name} has no reference: {error}") from error
        self.first = load(self.program)
        self.fine, self.second = step / self.parts, None

    def all(self, motions):
        """Return the reference of each motion."""
        found = [self._solved(motion) for motion in motions]
        peak = float(max((np.nanmax(np.abs(F), initial=0.0) for _, _, F, *_ in found), default=0.0))
        return [self._reference(*one, self.tolerance * peak) for one in found]

    def _solved(self, motion):
        """Return (motion, times, F, F of the second solver every EVERY values or None, how)."""
        fine, parts = self.fine, self.parts
        times = fine * np.arange(parts * round(motion.duration / self.step) + 1)
        rows = coefficients(motion.derivatives(times + fine / 2, DEGREE), fine)
        at = np.array(motion.at(times))
        inputs = np.column_stack([at.T, rows])[:, : len(self.program.inputs)]
        F = self.first.run(len(times), inputs).outputs[::parts, 0, 0]
        times, at = times[::parts], at[:, ::parts]
        try:
            return motion, times, F, *self._other(motion, times[::EVERY], rows, at)
        except (AnalysisError, ProgramError) as error:
            return motion, times, F, None, f"one solver: {error}"

    def _other(self, motion, times, rows, at):
        """Return (F at times, how) by the second solver."""
        form = self.scene.explicit()
        if not form.coordinates:
            bound = {p: self.scene.values[name] for name, p in self.scene.parameters.items()}
            held = {x(n): at[0], v(n): at[1], x(t): at[0], v(t): at[1], acceleration(t): at[2]}
            graph, wanted = Graph(), [without_samples(form.force)]
            whole = self.step * np.arange(at.shape[1])
            angles = {
                u: 2 * np.pi * float(u.args[0].subs(bound)) * whole
                for u in graph.variables_of(wanted) if isinstance(u, turning)
            }  # fmt: skip
            (found,) = graph.evaluate(wanted, bound | held | {t: whole} | angles)
            return np.broadcast_to(found, at.shape[1:])[::EVERY], "force of the handle alone, evaluated by two routes"
        if self.second is None:
            self.second = instant(self.scene, T=self.fine)
            self.once = load(self.second.program).once()
        field_ = Field(self.second, rows, self.fine, self.once)
        solver = Hybrid(field_)
        F = solver.run(self.second.start(at[0, 0], at[1, 0]), times, motion.breaks)
        return F, f"Taylor series with located events, and scipy's {'LSODA' if solver.stiff else 'DOP853'}"

    def _reference(self, motion, times, F, other, how, allowed):
        """Return the Reference of what was found; ``allowed`` is the difference that counts as agreement [N]."""
        horizon, chaotic, agreement, coarse = _finite_until(times, F), False, np.inf, times[::EVERY]
        if other is not None:
            apart = np.abs(F[::EVERY] - other)[coarse <= horizon]
            most = np.maximum.accumulate(np.where(np.isfinite(apart), apart, np.inf))
            within = int(np.searchsorted(most, allowed, "right"))  # how many agree before the first that do not
            chaotic = len(most) // 10 < within < len(most) and most[-1] > APART / self.tolerance * allowed
            horizon, agreement = (float(coarse[within - 1]), most[within - 1]) if chaotic else (horizon, most[-1])
        return Reference(motion, times, F, float(agreement), how, horizon, chaotic, self.step, allowed)


def _slow_enough(scene, step):
    """Return (driven program, parts): its period is so many parts of the step that its fastest part is slow in it."""
    parts = 1
    while True:
        try:
            return driven(scene, T=step / parts, order=ORDER), parts
        except LongStepError as error:
            if not error.substeps or parts >= MOST_PARTS:
                raise
            parts *= max(error.substeps, 2)


def _finite_until(times, F):
    """Return the last time before F is no number."""
    wrong = np.flatnonzero(~np.isfinite(F))
    return float(times[-1] if not len(wrong) else times[max(wrong[0] - 1, 0)])
