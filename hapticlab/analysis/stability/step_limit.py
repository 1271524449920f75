"""The longest step that a method takes stably on a scene, predicted from its equations of motion before it runs."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import sympy as sp

from ...base.shows_itself import ShowsItself, Tabular
from ...compiler.algebra.matrix_exponential import exponential
from ...compiler.contacts.contact_steps import STEPS_PER_CONTACT
from ...compiler.ir.options import period, steps
from ...compiler.methods.chosen_method import chosen_method
from ...compiler.methods.step_matrix import GRID, GROWS, longest_step, rising, step_matrix
from ...errors import AnalysisError
from ...scene.notation.symbols import delay
from ...scene.notation.written import no_scene
from ...scene.scene import Scene
from .condition_switches import switched
from .limit_plots import plot_step_limit
from .linearization import motion_at, slopes_of, tick_at
from .operating_points import FAR, TRAVEL, WORTH, kind_of, operating_points, probes_of, telling

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from ...base.annotations import Array
    from ...compiler.methods.chosen_method import AnyMethod
    from ...compiler.tick.handle_samples import Hold

#: states past which eigenvalues take their time
MANY = 12
#: kind of scene -> h_max/h at and above which it needs no further test; below 1 it is refused
AMPLE = {"linear": 1.0, "piecewise linear": 1.5, "small-signal": 2.0}


@dataclass(frozen=True, eq=False)
class ModeLimit(ShowsItself):
    """One operating point in one mode.

    Attributes
    ----------
    mode, point : str
        The conditions that hold, and where that was looked at.
    eigenvalues : complex array
        Of the equations of motion [1/s].
    h_max : float
        Longest stable step [s]; inf without a limit, 0 where no step is stable.
    margin : float
        h_max/h.
    energy_gain : float
        Part by which the energy of the least damped oscillation grows in a step, beyond what it does in truth; negative
        where the method damps. 0 without an oscillation.
    steps_per_contact : float
        Steps in half a period of the fastest oscillation, which is how long a contact lasts; inf without one.
    step : callable ``h -> step matrices``
        For an array of steps [s].
    """

    mode: str
    point: str
    eigenvalues: NDArray[np.complex128]
    h_max: float
    margin: float
    energy_gain: float
    steps_per_contact: float
    step: Callable[[Array], Array] = field(repr=False)

    def __str__(self) -> str:
        return f"{self.mode}; {self.point}: h_max = {1e3 * self.h_max:.4g} ms, margin {self.margin:.3g}"


@dataclass(frozen=True, eq=False)
class StepLimit(Tabular):
    """The longest stable step of a method on a scene, over all modes looked at; printing it shows them.

    Attributes
    ----------
    scene, method : str
    T, h : float
        Period and step [s].
    modes : tuple of ModeLimit
    kind : {"linear", "piecewise linear", "small-signal"}
        What the prediction is worth: exact; exact within each mode; of small motions about the operating points.
    given : bool
        Whether the operating points were given.
    held : float or None
        Where what is held from sample to sample, as a delay or a signal, moves the bodies: by how much a tick of T makes
        the fastest growing motion larger that does not grow by itself. The equations of motion, and h_max, do not see it.
    """

    scene: str
    method: str
    T: float
    h: float
    modes: tuple[ModeLimit, ...]
    kind: Literal["linear", "piecewise linear", "small-signal"]
    given: bool = False
    held: float | None = None

    @property
    def small_signal(self) -> bool:
        """Whether this is about small motions about the operating points alone."""
        return self.kind == "small-signal"

    @property
    def worst(self) -> ModeLimit:
        """The mode that decides."""
        return min(self.modes, key=lambda m: m.margin)

    @property
    def h_max(self) -> float:
        """Longest stable step [s]."""
        return self.worst.h_max

    @property
    def margin(self) -> float:
        """h_max/h: below 1 unstable."""
        return self.worst.margin

    @property
    def energy_gain(self) -> float:
        """The largest gain of energy per step."""
        return max(m.energy_gain for m in self.modes)

    @property
    def steps_per_contact(self) -> float:
        """The fewest, over the modes in which something holds that does not at the start."""
        return min((m.steps_per_contact for m in self.modes[1:] if m.mode != self.modes[0].mode), default=np.inf)

    @property
    def verdict(self) -> Literal["unstable", "close", "stable"]:
        """``"unstable"``, ``"close"`` or ``"stable"``.

        Close is a margin under 2 where motions are not linear, under 1.5 where only modes are (switching between them pumps
        energy), or fewer than ten steps in a contact.
        """
        if self.margin < 1 or (self.held or 0.0) > 1 + GROWS:
            return "unstable"
        close = self.margin < AMPLE[self.kind] or self.steps_per_contact < STEPS_PER_CONTACT
        return "close" if close else "stable"

    def __float__(self) -> float:
        return float(self.h_max)

    def __str__(self) -> str:
        head = f"{self.scene}, {self.method} in steps of {1e3 * self.h:g} ms: {self.verdict}, h_max = {1e3 * self.h_max:.4g} ms"
        looked = "" if self.given else f"; handle and positions without a range within {1e3 * TRAVEL:g} mm, {FAR['rad']:.4g} rad"
        worth = WORTH[self.kind] if self.held is None else "of the equations of motion"
        lines = [f"{head}, margin {self.margin:.3g} ({worth}{looked if self.small_signal else ''})"]
        if self.held is not None:
            grows = "grows" if self.held > 1 + GROWS else "does not grow"
            lines.append(
                "  h_max does not account for values that are held from sample to sample; a tick of T = "
                f"{1e3 * self.T:g} ms {grows}"
            )
        lines.append(f"  {'h_max [ms]':>10} {'margin':>8} {'gain/step':>10} {'steps/contact':>13}  mode; where")
        for m in self.modes:
            where = m.mode if m.point in m.mode else f"{m.mode}; {m.point}"
            lines.append(f"  {1e3 * m.h_max:10.4g} {m.margin:8.3g} {m.energy_gain:10.2g} {m.steps_per_contact:13.3g}  {where}")
        return "\n".join(lines)

    def plot(self) -> Figure:
        """Draw the largest |eigenvalue| of a step against its length, in every mode."""
        return plot_step_limit(self)


def step_limit(
    scene: Scene,
    method: AnyMethod | None = None,
    *,
    T: float,
    substeps: int = 1,
    hold: str | Hold = "soh",
    at: Mapping[str, float] | Sequence[Mapping[str, float]] | None = None,
    **options: Any,
) -> StepLimit:
    """Longest stable step h_max [s] of a method on a scene, in every mode of its contacts and cases.

    In each mode the method takes one step from every basis vector of the linearised motion. The longest step is the
    shortest one whose matrix has more eigenvalues outside the unit circle than the motion has in the right half plane.
    "exact" has no longest step; that of "taylor" is a radian of the fastest part, past which hl.compile refuses it.

    Parameters
    ----------
    scene : Scene
        Every parameter bound.
    method : str, Method, Taylor or Exact, optional
        By default the one that the scene needs, as of :func:`hapticlab.compile`.
    T : float
        Sampling period [s], > 0.
    substeps : int
    hold : str
        Changes what drives the motion, not whether it is stable; taken so that options of hl.compile can be passed on.
    at : dict name -> float, or sequence of them, optional
        Operating points: handle x and v, coordinates and rates by name. By default the start with the handle at x = 0 and
        within 50 mm, rest, places within declared ranges, else within 50 mm or half a turn, and one place in every mode that
        can be reached.
    **options
        Others of :func:`hapticlab.compile`, which do not change the step.

    Returns
    -------
    StepLimit

    Examples
    --------
    >>> import hapticlab as hl, sympy as sp
    >>> k, m = hl.parameters("k m", units="N/m kg", values=(500, 0.05))
    >>> z = hl.coordinate("z", unit="m")
    >>> F = k * (hl.x(hl.t) - z)
    >>> scene = hl.Scene(force=F, eom=[sp.Eq(m * z.diff(hl.t, 2), F)])
    >>> round(hl.stability.step_limit(scene, "semi_implicit_euler", T=1e-3).margin, 3)
    20.0
    """
    if not isinstance(scene, Scene):
        raise AnalysisError(no_scene(scene, "needs hl.stability.step_limit(hl.Scene(force=...), T=1e-3)"))
    T, h = period(T), period(T) / steps(substeps)
    chosen = chosen_method(method, scene.explicit())
    known = switched(scene)
    points = operating_points(known, at, T, TRAVEL, far=True)
    probes = probes_of(points)
    J, seconds = motion_at(known, [*points, *probes], T)
    closer = telling(points, J[: len(points)])
    kind = kind_of(known, [*(points[k] for k in closer), *probes], [], [*(J[k] for k in closer), *J[len(points) :]])
    found = {}
    for k in closer:
        p = points[k]
        step = _step_at(known, p, chosen, T, J[k], seconds)
        found[k] = _mode_limit(chosen, J[k], step, h, known.named(p.mode), p.words, p.sampled)
    held = _held(known, [points[k] for k in closer], J[closer], T, method, substeps, hold)
    modes = tuple(found[k] for k in _told(points, found))
    return StepLimit(scene.name, str(chosen), T, h, modes, kind, at is not None, held)


def _told(points, found):
    """Return the numbers of points that were asked for, and of the sampled ones of a mode that of the shortest step."""
    many = [k for k in found if points[k].sampled]
    told = [k for k in found if not points[k].sampled]
    for mode in dict.fromkeys(points[k].mode for k in many):
        worst = min((k for k in many if points[k].mode == mode), key=lambda k: found[k].margin)
        others = [found[k].margin for k in told if points[k].mode == mode]
        told += [worst] if found[worst].margin < min(others, default=np.inf) or not others else []
    return told


def _held(scene, points, J, T, method, substeps, hold):
    """Return the largest |eigenvalue| of ticks, besides as many as grow by themselves; None where nothing held is felt."""
    form = scene.form
    leaves = {a for e in (*form.f, *(one for row in form.M for one in row)) for a in e.atoms(sp.Function)}
    if not any(isinstance(a, delay) or getattr(type(a), "role", None) == "signal" for a in leaves):
        return None
    ticks, _ = tick_at(scene, points, T, method=method, substeps=substeps, hold=hold)
    sizes = [np.sort(np.abs(np.linalg.eigvals(tick[0])))[::-1] for tick in ticks]
    return max(float(one[int(rising(slopes)) :].max(initial=0.0)) for one, slopes in zip(sizes, J, strict=True))


def _step_at(scene, point, method, T, J, seconds):
    """``h -> step matrices`` of a method at a point; of what is exact, none."""
    if method.locates:
        return partial(_exponentials, J)
    if method.exact:  # what is not linear is driven by what is, and drives nothing of it
        rest = slopes_of(scene.set(point.mode), T, exact=True)
        J, seconds = rest.jacobian(point.values)[0], rest.seconds
    known = method.rest
    if not known.implicit_damping:
        return partial(step_matrix, known, J, seconds)
    return _DampedSteps(scene, point, known, T, seconds)


def _exponentials(J, h):
    return np.array([exponential(J * one) for one in h])


@dataclass(frozen=True, eq=False)
class _DampedSteps:
    """Step matrices of a method whose rates damp implicitly; a copy in another process traces its slopes again."""

    scene: Any
    point: Any
    method: Any
    T: float
    seconds: int

    @cached_property
    def slopes(self):
        return slopes_of(self.scene, self.T, damped=True)

    def __call__(self, h):
        switches = self.scene.values_of(self.point.mode)
        explicit = replace(self.method, implicit_damping=False)  # the rates have it already
        return step_matrix(explicit, self.slopes.jacobian(self.point.values, h, len(h), **switches), self.seconds, h)

    def __getstate__(self):
        return {name: value for name, value in self.__dict__.items() if name != "slopes"}


def _mode_limit(method, J, step, h, mode, point, quick=False):
    """Return the :class:`ModeLimit` of one point, from its step matrices; ``quick``, to a thousandth."""
    if not np.isfinite(J).all():
        raise AnalysisError(f"the motion has no finite slope at {point}, {mode}. Give positions where it has one, at={{...}}")
    values = np.linalg.eigvals(J)
    largest, fastest = np.abs(values).max(initial=0.0), np.abs(values.imag).max(initial=0.0)
    if method.locates and method.rest:
        h_max = 1.0 / largest if largest else np.inf
    else:
        few = (GRID[::3], (17, 17)) if quick or len(J) > MANY else ()
        h_max = np.inf if method.locates else longest_step(step, J, *few)
    gain = energy_gain(values, np.linalg.eigvals(step(np.array([h]))[0]), h)
    per_contact = np.pi / (fastest * h) if fastest else np.inf
    return ModeLimit(mode, point, values, float(h_max), float(h_max / h), gain, float(per_contact), step)


def energy_gain(values, multipliers, h):
    """Return by how much more energy an oscillation gains in a step than in truth, the largest over the oscillations.

    Parameters
    ----------
    values : complex array
        Eigenvalues of the motion [1/s].
    multipliers : complex array
        Of the step matrix.
    h : float
    """
    gains = []
    for value in values:
        if value.imag > abs(value.real):
            true = np.exp(value * h)
            nearest = multipliers[np.abs(multipliers - true).argmin()] if len(multipliers) else true
            gains.append(float(abs(nearest / true) ** 2 - 1.0))
    return max(gains, default=0.0)
