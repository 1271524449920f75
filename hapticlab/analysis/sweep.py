"""One metric over the product of many parameter values: a lane a point, a run for every period and structure."""

import itertools
from dataclasses import dataclass, field, replace

import numpy as np

from ..compiler.exact import exact_and_rest
from ..compiler.held import held
from ..device.link import link, load_linked
from ..device.progress import progress_bar
from ..errors import AnalysisError
from ..scene.parameters import Parameter
from ..scene.scene import Scene
from ..scene.units import in_si
from .chatter import SHORTEST
from .measures import METRICS, WithFault
from .plots import plot_sweep

#: what a sweep may change about a simulated paddle, and its unit
PADDLE_AXES = {
    "T": "s", "m": "kg", "b": "N*s/m", "delay": "s", "counts_per_metre": "1/m", "coulomb": "N", "force_max": "N", "noise": "m",
}  # fmt: skip
START_AXES = {"x": "m", "v": "m/s"}
#: what a sweep may say about how its scene is compiled; a parameter of that name goes first
OPTIONS = ("method", "substeps", "hold")
#: lanes and ticks of one call of the engine, between two looks at the progress bar
LANES, TICKS = 2048, 2000


@dataclass(frozen=True, eq=False)
class Sweep:
    """A metric over a grid.

    Attributes
    ----------
    axes : dict of str to array
        The swept names, in the order given; SI units.
    values : array, one dimension an axis
        nan where the program faulted (a force that was not finite stops the motor).
    metric, unit : str
    units : dict of str to str
        Of the axes.
    duration : float
        Simulated time of every point [s].
    about : str
        The scene, the paddle and the values that were the same everywhere, in lines.
    """

    axes: dict
    values: np.ndarray
    metric: str
    unit: str
    units: dict = field(default_factory=dict)
    duration: float = 1.0
    about: str = ""

    def plot(self, *, limits=None):
        """Draw lines or a map; see :func:`hapticlab.analysis.plots.plot_sweep`."""
        return plot_sweep(self, limits=limits)

    def __repr__(self):
        grid = " x ".join(f"{name} ({len(a)})" for name, a in self.axes.items())
        return f"Sweep({self.metric} [{self.unit}] over {grid}, {self.duration:g} s each)"


def sweep(scene, paddle, *, duration=1.0, metric="chatter", engine="auto", progress=True, **values):
    """Simulate every combination of the named values and measure each, without storing a trace.

    Points that differ in values only are lanes of one program; every T, and every paddle of another structure, is a run
    of its own. A point's result is the same as when it runs alone.

    Parameters
    ----------
    scene : Scene
    paddle : SimulatedPaddle
    duration : float
        [s]
    metric : {"chatter", "growth", "contacts", "energy", "peak_force"}
        ``chatter`` sustained or growing amplitude [m]: half the largest swing, from turning point to turning point, of the
        last quarter. 0 where the handle rests, where every swing of the last quarter is smaller than every one of the
        quarter before, and within one encoder count or 20 nm. nan where the run cannot tell: nothing moves the handle, or
        a quarter has no whole swing; lengthen ``duration``. Driven motion (noise, a moving intent) is not told apart.
        ``growth`` logarithm of the
        swing's ratio between these quarters [1/s].
        ``contacts`` of the last half [1/s]. ``energy`` the most ever drawn from the environment [J]. ``peak_force`` [N].
    engine : {"auto", "llvm", "interpreter"}
    progress : bool
        Show a bar when the sweep lasts longer than two seconds.
    method, substeps, hold : optional
        As :func:`hapticlab.compile` takes them, the same for every point; method="taylor" sweeps impacts and sticking
        friction. With method="exact" parameters of the scene that are no axis are constants.
    **values : float or array of shape (n,)
        SI, or texts with a unit. An array is an axis, a single number only sets the value. Names: the scene's
        parameters; of the paddle T, m, b, delay, counts_per_metre, coulomb, force_max, noise; x and v, where the handle starts.

    Returns
    -------
    Sweep

    Raises
    ------
    AnalysisError
        For an unknown metric or name, a name that both the scene and the paddle have, and values that are not finite.

    Examples
    --------
    >>> import hapticlab as hl
    >>> paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3)
    >>> grid = hl.sweep(hl.wall(), paddle, metric="energy", v=0.1, k=[100.0, 400.0], T=[5e-4, 1e-3])
    >>> grid
    Sweep(energy [J] over k (2) x T (2), 1 s each)
    >>> bool((np.diff(grid.values, axis=1) > 0).all())      # a longer hold generates more
    True
    """
    if metric not in METRICS:
        raise AnalysisError(f"metric = {metric!r}; needs one of {', '.join(METRICS)}")
    own = scene.parameters if isinstance(scene, Scene) else ()
    options = {name: values.pop(name) for name in OPTIONS if name in values and name not in own}
    axes, fixed, units = _names(scene, values)
    scene = scene(**{name: a for name, a in fixed.items() if name in scene.parameters})
    for end in (np.min, np.max):  # the scene itself refuses what lies outside a parameter's range
        bound = scene(**{name: float(end(a)) for name, a in axes.items() if name in scene.parameters})
    if exact_and_rest(options.get("method"))[0]:
        options["live"] = [name for name in axes if name in own]
    grid = _Grid(bound, paddle, axes, fixed, options)
    result = np.empty(grid.points)
    for settings in grid.groups():
        cells, found = _measure(grid, settings, duration, metric, engine, progress)
        result[cells] = found
    about = "\n".join([scene.name, str(paddle), *(f"{name} = {a:g}" for name, a in fixed.items())])
    return Sweep(axes, result.reshape(grid.shape), metric, METRICS[metric].unit, units, duration, about)


def _names(scene, values):
    """Return the axes, the single values and the units of the axes; refuse names that mean nothing or two things."""
    if not isinstance(scene, Scene):
        what = getattr(scene, "name", repr(scene))
        raise AnalysisError(f"{what} is no scene; a sweep compiles one for every T and needs a Scene")
    own = {name: str(p.unit) for name, p in scene.parameters.items()}
    known = {**START_AXES, **PADDLE_AXES, **own}
    axes, fixed = {}, {}
    for name, given in values.items():
        if name not in known:
            listed = ", ".join(own) or "none"
            raise AnalysisError(
                f"{name}: nothing has that name. The scene's parameters: {listed}; the paddle's: {', '.join(PADDLE_AXES)}; "
                f"the start: {', '.join(START_AXES)}"
            )
        if name in own and name in {**PADDLE_AXES, **START_AXES}:
            raise AnalysisError(
                f"{name} is a parameter of the scene and of the paddle; rename the scene's to sweep one of them"
            )
        array = _in_si(given, known[name], name)
        if array.ndim > 1 or array.size == 0 or not np.isfinite(array).all():
            raise AnalysisError(f"{name} = {given}; an axis needs one or more finite numbers [{known[name]}]")
        (axes if array.ndim else fixed)[name] = array if array.ndim else float(array)
    return axes, fixed, {name: known[name] for name in axes}


def _in_si(given, unit, name):
    """Return numbers as an array in SI; a text carries its unit, as where a scene is bound."""
    several = np.ravel(np.asarray(given, object))
    if any(isinstance(one, str) for one in several):
        numbers = np.array([in_si(one, unit, name) for one in several])
        return numbers.reshape(np.shape(given)) if not isinstance(given, str) else numbers[0]
    try:
        return np.asarray(given, float)
    except (TypeError, ValueError):
        raise AnalysisError(f"{name} = {given!r}; an axis needs one or more finite numbers [{unit}]") from None


class _Grid:
    """The points of a sweep: each is the scene's values and a setting, which is a paddle and where its handle starts."""

    def __init__(self, scene, paddle, axes, fixed, options):
        self.scene, self.axes, self.options = scene, axes, options
        self.shape = tuple(len(a) for a in axes.values())
        self.points = int(np.prod(self.shape))
        self.index = dict(zip(axes, np.indices(self.shape).reshape(len(axes), self.points), strict=True))
        paddle = replace(paddle, **{name: a for name, a in fixed.items() if name in PADDLE_AXES})
        start = {name: fixed.get(name, 0.0) for name in START_AXES}
        holding = held(scene)  # a program has these as constants
        lengths = [name for name in axes if name in holding]
        changed = [name for name in axes if name in PADDLE_AXES or name in START_AXES or name in lengths]
        self.setting = np.zeros(self.points, int)
        for name in changed:
            self.setting = self.setting * len(axes[name]) + self.index[name]
        self.paddles, self.starts, self.lengths = [], [], []
        for values in itertools.product(*(axes[name].tolist() for name in changed)):
            here = dict(zip(changed, values, strict=True))
            self.paddles.append(replace(paddle, **{name: a for name, a in here.items() if name in PADDLE_AXES}))
            self.starts.append({name: here.get(name, a) for name, a in start.items()})
            self.lengths.append(tuple((name, here[name]) for name in lengths))

    def groups(self):
        """Return the settings that can share one program and its inputs, as lists of their numbers."""
        found = {}
        for number, paddle in enumerate(self.paddles):
            found.setdefault((paddle.T, paddle.structure, paddle.noise, self.lengths[number]), []).append(number)
        return list(found.values())

    def parameters(self, program, settings, cells):
        """Return the linked program's parameters for some points, shape (parameters, points)."""
        scene = np.repeat(np.array(program.values, float)[:, None], len(cells), axis=1)
        for row, channel in enumerate(program.parameters):
            if channel.name in self.axes:
                swept = Parameter(channel.name, channel.unit, channel.low, channel.high)  # a program may take less than a scene
                for end in (np.min, np.max):
                    swept.check(float(end(self.axes[channel.name])))
                scene[row] = self.axes[channel.name][self.index[channel.name][cells]]
        plants = np.array([self.paddles[s].plant_values(**self.starts[s]) for s in settings]).T
        return np.concatenate([scene, plants[:, np.searchsorted(settings, self.setting[cells])]])


def _measure(grid, settings, duration, metric, engine, progress):
    """Return the points of settings that share a program, and the metric there."""
    paddle = grid.paddles[settings[0]]
    cells = np.flatnonzero(np.isin(grid.setting, settings))
    ticks = paddle.ticks(duration)
    program = paddle.program(grid.scene(**dict(grid.lengths[settings[0]])), **grid.options)
    if ticks < SHORTEST:
        raise AnalysisError(f"duration = {duration:g} s is {ticks} samples of T = {paddle.T:g} s; needs at least {SHORTEST}")
    measure = METRICS[metric](ticks, paddle.T)
    loaded = load_linked(link(program, paddle, WithFault(measure)), engine)
    inputs, parameters = paddle.inputs(ticks), grid.parameters(program, settings, cells)
    last = []
    with progress_bar(ticks * len(cells), progress) as shown:
        for lanes in np.array_split(parameters, range(LANES, len(cells), LANES), axis=1):
            states = None
            for start in range(0, ticks, TICKS):
                rows = inputs[start : start + TICKS]
                outputs, states = loaded.run(len(rows), rows, lanes, states, every=len(rows))
                shown.update(len(rows) * lanes.shape[1])
            last.append(outputs[-1])
    *numbers, fault = np.concatenate(last, axis=1)
    counts = np.array([1 / p.counts_per_metre if p.counts_per_metre else 0.0 for p in grid.paddles])
    found = measure.value(numbers, count=counts[grid.setting[cells]], quarter=ticks // 4 * paddle.T)
    return cells, np.where(fault > 0, np.nan, found)
