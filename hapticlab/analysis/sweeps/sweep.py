"""One metric over the product of many parameter values: a lane a point, a run for every period and structure."""

from __future__ import annotations

from contextlib import closing
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np

from ...base.arguments import choice, instance, number
from ...base.facts import Fact
from ...base.grid import frame, labelled
from ...base.guesses import Guessed
from ...base.shows_itself import ShowsItself
from ...base.units import in_si
from ...base.unusual import warn_at_own_line
from ...compiler.methods.chosen_method import chosen_method
from ...compiler.prune.constraint_lengths import held
from ...device.progress import progress_bar
from ...device.simulated.simulated_paddle import SimulatedPaddle
from ...errors import AnalysisError, MissedEventWarning
from ...scene.scene import Scene
from ..records.sweep_plot import plot_sweep
from .sweep_chunks import measured
from .sweep_file import Partial
from .sweep_grid import PADDLE_AXES, START_AXES, Grid
from .sweep_measures import METRICS
from .sweep_plan import Plan, identity
from .workers import number_of, spread

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from matplotlib.figure import Figure

    from ...base.annotations import Array, File, Number, PlantEngine
    from ...limits.limit import Limit

#: what a sweep may say about how its scene is compiled; a parameter of that name goes first
OPTIONS = ("method", "substeps", "hold", "force_at")


METRIC = "The metric at every point; nan where the program faulted or the run does not decide"


@dataclass(frozen=True, eq=False)
class Sweep(ShowsItself, Guessed):
    """A metric over a grid.

    Attributes
    ----------
    axes : dict of str to array
        The swept names, in the order given; SI units.
    values : array, one dimension an axis
        nan where the program faulted (a force that was not finite stops the motor), and where the run does not decide: of
        chatter and growth, for instance, where it ends too early.
    metric, unit : str
    units : dict of str to str
        Of the axes.
    duration : float
        Simulated time of every point [s].
    about : str
        The scene, the paddle and the values that were the same everywhere, in lines.
    """

    MEANT: ClassVar[dict[str, str]] = {"results": "values", "chatter": "values", "data": "values", "grid": "axes", "x": "axes"}

    axes: dict[str, Array]
    values: Array
    metric: str
    unit: str
    units: dict[str, str] = field(default_factory=dict)
    duration: float = 1.0
    about: str = ""

    def plot(self, *, limits: Limit | Sequence[Limit] | Mapping[str, Limit | Sequence[Limit]] | None = None) -> Figure:
        """Draw lines or a map; see :func:`hapticlab.analysis.records.sweep_plot.plot_sweep`."""
        return plot_sweep(self, limits=limits)

    _hidden = ("axes", "units", "unit", "metric")

    def _sentence(self):
        of = " and ".join(f"{name} ({len(values)} value{'s' * (len(values) != 1)})" for name, values in self.axes.items())
        unknown = np.count_nonzero(np.isnan(self.values))
        left = f"; {unknown} of {self.values.size} not known: faulted, or too short to decide" if unknown else ""
        return f"{self.metric} over {of}: {self.values.size} run{'s' * (self.values.size != 1)} of {self.duration:g} s{left}"

    def _facts(self):
        swept = [Fact(name, values, self.units.get(name, ""), "Swept") for name, values in self.axes.items()]
        return [*swept, *(f._replace(unit=self.unit, meaning=METRIC) if f.name == "values" else f for f in super()._facts())]

    def _is_open(self, fact):
        return fact.name in (*self.axes, "values")

    def to_pandas(self) -> Any:
        """A ``pandas.DataFrame`` with a line for each run: the swept values and the metric, SI; units in ``attrs["units"]``.

        Raises
        ------
        AnalysisError
            Where pandas, which is optional, is not installed.
        """
        points = np.meshgrid(*self.axes.values(), indexing="ij")
        columns = {name: one.ravel() for name, one in zip(self.axes, points, strict=True)} | {self.metric: self.values.ravel()}
        return frame(columns, self.units | {self.metric: self.unit}, about=self.about)

    def to_xarray(self) -> Any:
        """An ``xarray.Dataset`` of the metric over the swept names, SI; each has its unit in ``attrs["units"]``.

        Raises
        ------
        AnalysisError
            Where xarray, which is optional, is not installed.
        """
        variables = {self.metric: (tuple(self.axes), self.values)}
        return labelled(variables, self.axes, self.units | {self.metric: self.unit}, about=self.about)

    def __repr__(self) -> str:
        grid = " x ".join(f"{name} ({len(a)})" for name, a in self.axes.items())
        return f"Sweep({self.metric} [{self.unit}] over {grid}, {self.duration:g} s each)"


def sweep(
    scene: Scene,
    paddle: SimulatedPaddle,
    duration: Number = 1.0,
    *,
    metric: Literal["chatter", "growth", "contacts", "energy", "peak_force"] = "chatter",
    engine: PlantEngine = "auto",
    progress: bool = True,
    workers: int | Callable[..., Iterable[Any]] = 1,
    resume: File | None = None,
    **values: Any,
) -> Sweep:
    """Simulate every combination of the named values and compute a metric for each, without storing samples.

    Points that differ in values only are lanes of one program; every T, and every paddle of a different structure, is a
    separate run. The result of a point is the same as when it runs alone, bit for bit, for any number of workers on
    processors of one kind.

    Parameters
    ----------
    scene : Scene
    paddle : SimulatedPaddle
    duration : float or text
        [s]
    metric : {"chatter", "growth", "contacts", "energy", "peak_force"}
        ``chatter`` sustained or growing amplitude [m]: half the largest swing, from turning point to turning point, of
        the last quarter. 0 if the handle rests, within one encoder count or 20 nm, or if every swing of the last
        quarter is smaller than every one of the quarter before. nan if the run does not decide it: nothing moves the
        handle, a quarter has no whole swing, or bounces off the wall decay slowly, by less than two thirds in a
        quarter, so that they may end in a cycle. Lengthen ``duration``, or use :func:`hapticlab.chatter` on a single
        run. Driven motion (noise, a moving intent) is not distinguished from chatter. ``growth`` logarithm of the
        swing's ratio between these quarters [1/s]. ``contacts`` of the last half [1/s]. ``energy`` the most ever drawn
        from the environment [J]. ``peak_force`` [N].
    engine : {"auto", "llvm", "wasm", "interpreter"}
    progress : bool
        Show a bar when the sweep lasts longer than two seconds.
    workers : int or callable
        So many at once, -1 for one a processor: threads, which is all that machine code needs; processes on the
        interpreter (a script then needs ``if __name__ == "__main__":``). Or what maps a function over a sequence as
        ``map`` does: ``pool.imap_unordered`` of a multiprocessing pool, ``executor.map``, or a Dask cluster's
        ``client.get_executor().map``, where hapticlab must be installed too. It is called again and again, with 256
        chunks at most. A chunk carries a program, the axes' values that it takes, the paddle with its seed, and a range
        of points.
    resume : path, optional
        A file that stores finished points. The same call resumes from it after Ctrl-C, a crash or a reboot; workers may
        differ. A file of a different sweep, or of a different version of hapticlab, is rejected. Two calls at the same
        time on one file are safe, but do the work twice.
    method, substeps, hold, force_at : optional
        As :func:`hapticlab.compile` takes them, the same for every point; method="taylor" sweeps impacts and sticking
        friction. With method="exact", parameters of the scene that are not an axis are constants.
    **values : float or array of shape (n,)
        SI, or texts with a unit. An array is an axis, a single number only sets the value. Names: the scene's
        parameters; of the paddle T, m, b, delay, counts_per_metre, coulomb, force_max, noise, sensor_delay; x and v, where the
        handle starts.

    Returns
    -------
    Sweep

    Warns
    -----
    MissedEventWarning
        Runs left events unlocated; this is not known for points from a file to resume from.

    Raises
    ------
    AnalysisError
        For an unknown metric or name, a name that both the scene and the paddle have, values that are not finite, a
        file to resume from that is of another sweep, and workers that died.

    Examples
    --------
    >>> import hapticlab as hl
    >>> paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3)
    >>> grid = hl.sweep(hl.wall(), paddle, metric="energy", v=0.1, k=[100.0, 400.0], T=[5e-4, 1e-3])
    >>> grid
    Sweep(energy [J] over k (2) x T (2), 1 s each)
    >>> bool((np.diff(grid.values, axis=1) > 0).all())      # a longer hold generates more
    True
    >>> fine = {"k": np.linspace(100, 400, 50), "b": np.linspace(0.1, 0.5, 40)}
    >>> hl.sweep(hl.wall(), paddle, metric="energy", v=0.1, duration=0.1, workers=2, **fine)  # resume="walls.sweep" keeps it
    Sweep(energy [J] over k (50) x b (40), 0.1 s each)
    """
    choice("metric", metric, METRICS)
    duration = number("duration", duration, "s", "a sweep", above=0)
    workers = number_of(workers)
    own = scene.parameters if isinstance(scene, Scene) else ()
    options = {name: values.pop(name) for name in OPTIONS if name in values and name not in own}
    axes, fixed, units = _names(scene, paddle, values)
    scene = scene(**{name: a for name, a in fixed.items() if name in scene.parameters})
    for end in (np.min, np.max):  # the scene itself refuses what lies outside a parameter's range
        bound = scene(**{name: float(end(a)) for name, a in axes.items() if name in own})
    if chosen_method(options.get("method")).exact:
        options["live"] = [name for name in axes if name in own]
    instance("paddle", paddle, SimulatedPaddle, "an hl.SimulatedPaddle(...)", error=AnalysisError)
    paddle_here = replace(paddle, **{name: a for name, a in fixed.items() if name in PADDLE_AXES})
    starts = {name: fixed.get(name, 0.0) for name in START_AXES}
    grid = Grid(paddle_here, axes, held(scene))
    plan = Plan(bound, grid, starts, options, duration, metric, engine)
    result = _filled(plan, identity(plan, scene), workers, resume, progress)
    about = "\n".join([scene.name, str(paddle), *(f"{name} = {a:g}" for name, a in fixed.items())])
    return Sweep(axes, result.reshape(grid.shape), metric, METRICS[metric].unit, units, duration, about)


def _filled(plan, what, workers, resume, progress):
    """Return the metric at every point: what the file has, and what the workers measure."""
    points, done = plan.grid.points, 0
    result, known = np.full(points, np.nan), np.zeros(points, bool)
    with Partial(resume, what) as kept, progress_bar(points, progress, "point") as shown:
        for record in kept.records:
            done += plan.put(result, record, known)
        shown.update(done)
        before, chunks = done, plan.chunks(kept.records, workers)
        try:
            with closing(spread(measured, chunks, workers, threads=plan.machine_code)) as results:
                for given in results:
                    record = plan.taken(given)
                    kept.add(record)
                    more = plan.put(result, record, known)
                    done += more
                    shown.update(more)
        except BaseException as stop:
            if resume is not None and (done > before or isinstance(stop, KeyboardInterrupt)):
                stop.add_note(f"{done} of {points} points are in {str(resume)!r}; the same call continues from there")
            raise
    if plan.missed:
        warn_at_own_line(
            f"{plan.missed} of {points} points left an event unlocated, so their metric may be wrong. Locate more events "
            "per step, method=hl.methods.Taylor(events=8), or use a shorter T",
            MissedEventWarning,
        )
    if done != points:
        raise AnalysisError(f"the workers returned {done} of {points} points; needs a map that returns every result once")
    return result


def _names(scene, paddle, values):
    """Return the axes, the single values and the units of the axes; refuse names that mean nothing or two things."""
    if not isinstance(scene, Scene):
        what = getattr(scene, "name", repr(scene))
        swapped = "; the scene comes first: hl.sweep(scene, paddle, ...)" if isinstance(paddle, Scene) else ""
        raise AnalysisError(f"{what} is not a scene; a sweep compiles a scene for every T, so it needs a Scene{swapped}")
    own = {name: str(p.unit) for name, p in scene.parameters.items()}
    known = {**START_AXES, **PADDLE_AXES, **own}
    axes, fixed = {}, {}
    for name, given in values.items():
        if name not in known:
            listed = ", ".join(own) or "none"
            raise AnalysisError(
                f"{name} is not a quantity that can be swept. The scene's parameters: {listed}; the paddle's: "
                f"{', '.join(PADDLE_AXES)}; "
                f"the start: {', '.join(START_AXES)}"
            )
        if name in own and name in {**PADDLE_AXES, **START_AXES}:
            raise AnalysisError(f"{name} is a parameter of the scene and of the paddle; rename the scene's to sweep one of them")
        array = _in_si(given, known[name], name)
        if array.ndim > 1 or array.size == 0 or not np.isfinite(array).all():
            raise AnalysisError(f"{name} = {given}; an axis needs one or more finite numbers [{known[name]}]")
        (axes if array.ndim else fixed)[name] = array if array.ndim else float(array)
    return axes, fixed, {name: known[name] for name in axes}


def _in_si(given, unit, name):
    """Return numbers as an array in SI; a text carries its unit, as where a scene is bound."""
    numbers = isinstance(given, np.ndarray) and given.dtype.kind in "iuf"
    several = () if numbers else np.ravel(np.asarray(given, object))
    if any(isinstance(one, str) for one in several):
        numbers = np.array([in_si(one, unit, name) for one in several])
        return numbers.reshape(np.shape(given)) if not isinstance(given, str) else numbers[0]
    try:
        return np.asarray(given, float)
    except (TypeError, ValueError, OverflowError):
        raise AnalysisError(f"{name} = {given!r}; an axis needs one or more finite numbers [{unit}]") from None
