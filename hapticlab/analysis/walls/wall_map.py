"""Maps of a wall: where it is passive, stable, chatters or is unusable, theory and simulation on one picture."""

from __future__ import annotations

import inspect
import math
import time
from dataclasses import replace
from difflib import get_close_matches
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.arguments import number, what_is
from ...device.simulated.simulated_paddle import SimulatedPaddle
from ...errors import AnalysisError
from ...scene.laws.chapter_laws import wall
from ...scene.scene import Scene
from ..sweeps.lane_runs import LaneRuns
from .wall_limits import ChapterLimits, SceneLimits
from .wall_regions import WallMap, beyond, regions_of

if TYPE_CHECKING:
    from ...scene.laws.taps import LawName

#: what a map may be over beside K, and its unit
OTHERS = {
    "B": "N s/m", "T": "s", "delay": "s", "m": "kg", "b": "N s/m", "coulomb": "N", "counts_per_metre": "1/m",
    "hand_m": "kg", "hand_b": "N s/m", "sensor_delay": "s",
}  # fmt: skip
#: rows at which theory is computed, exactly; between them its lines are straight
ROWS = 41
#: and where each asks for a scene to be compiled
FEW_ROWS = 9


def wall_map(
    paddle: SimulatedPaddle, *, law: LawName | Scene = "zoh", over: tuple[str, str] = ("K", "B"), **given: Any
) -> WallMap:
    """Map of a virtual wall: passive, stable, chatters or unusable over two quantities.

    The lines are theory, exact: the passivity limit of Eq. (23.10) and its general form, and the linear stability of this
    handle in this hand. The regions are simulated contacts with all that the paddle has: hand, encoder, Coulomb friction,
    delay, force limit, the unilateral boundary.

    Parameters
    ----------
    paddle : SimulatedPaddle
        Its hand pushes, or has a spring: else the handle bounces off and is gone.
    law : {"zoh", "half_sample", "backward_difference", "ellis"} or Scene
        A scene of its own with its stiffness unbound and its boundary at 0 has regions, and no line of passivity; a name
        draws the theory too.
    over : ("K", other)
        other is one of B, T, delay, sensor_delay, m, b, coulomb, counts_per_metre, hand_m, hand_b.
    **given
        The axes by their names, arrays of SI values; without one a range of ``points`` = 100 values that shows the limits,
        or, of a scene without ``linear=``, where simulated contacts cease to come to rest.
        And, for every point of the map: B, duration, x, v, unusable, unilateral, clamp, workers, engine.

    Returns
    -------
    WallMap

    Raises
    ------
    AnalysisError
        For an axis that is none, and a hand that moves or noise where T is an axis.

    Examples
    --------
    >>> import hapticlab as hl
    >>> paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand(m=0.02, push=1.0))
    >>> found = wall_map(paddle, K=np.linspace(40, 590, 12), B=np.linspace(0, 0.2, 5))
    >>> found.regions[:, 0].tolist()
    [0, 0, 0, 0, 3, 3, 3, 3, 3, 3, 3, 3]
    """
    return WallMaps(paddle, law=law, over=over, **given).of(paddle)


class WallMaps:
    """Maps with the same axes for one paddle after the other: what was compiled for one serves the next.

    Parameters
    ----------
    paddle : SimulatedPaddle
        Its T is what the programs are compiled for; maps of another T come by similarity.
    law, over
        As for :func:`wall_map`.
    bounds : tuple of str
        Limits by name to draw beside, of "abbott_okamura", "diolaiti", "gil"; where a bound's assumptions fail it has no
        line.
    B : float
        Virtual damper [N s/m], where it is no axis.
    duration : float
        Of a contact [s].
    x, v : float
        Where a contact begins [m], [m/s]; the wall is at 0.
    unusable : float
        Half the swing [m] from which a wall is called unusable.
    points : int
        Values of an axis that is not given.
    unilateral, clamp
        As for :func:`hapticlab.wall`, of a law by name.
    linear : Scene, optional
        Where ``law`` is a scene: the same without its boundary, from which the line of exact stability comes.
    parameter : str
        Where ``law`` is a scene: the parameter that is K.
    workers : int
        Threads, -1 for one a processor.
    engine : {"auto", "llvm", "wasm", "interpreter"}
    **axes
        Arrays by name.
    """

    def __init__(
        self, paddle, *, law="zoh", over=("K", "B"), bounds=("gil",), B=0.0, duration=1.0, x=0.0, v=0.1, unusable=1e-3,
        points=100, unilateral="gate", clamp=False, linear=None, parameter="k", workers=-1, engine="auto", **axes,
    ):  # fmt: skip
        self._check(paddle, over, unusable)
        if not (isinstance(points, int) and points >= 2):
            raise AnalysisError(f"points = {points!r}; an axis of a map needs a whole number of points, 2 or more")
        self.over, self.T, self.start, self.unusable = tuple(over), paddle.T, _start(x, v), float(unusable)
        self.parameter = parameter if isinstance(law, Scene) else "k"
        if isinstance(law, Scene):
            self._check_scene(law)
            scene, self.limits = law, SceneLimits(law, linear, parameter)
        else:
            scene, self.limits = wall(law, unilateral=unilateral, clamp=clamp)(x_o=0.0), ChapterLimits(law, bounds)
        axes |= {"B": B} if over[1] == "B" and np.ndim(B) else {}
        self.B = 0.0 if np.ndim(B) else number("B", B, "N s/m")
        if self.B and over[1] == "B":
            raise AnalysisError(f'B = {self.B:g} N s/m; B is an axis: needs an array, or over=("K", other)')
        _check_names(axes, self.over)
        duration = number("duration", duration, "s", "a contact", above=0, what="a duration")
        self.runs = LaneRuns(scene(**{self.parameter: 1.0}), duration, workers=workers, engine=engine)
        other = self._axis(self.over[1], axes.get(over[1]), lambda: _range(paddle, self.over[1], points))
        K = self._axis("K", axes.get("K"), lambda: self._stiffnesses(paddle, other, points))
        self.axes, self.ranged = {"K": K, self.over[1]: other}, "K" not in axes
        most = FEW_ROWS if isinstance(law, Scene) and over[1] == "B" else ROWS
        rows = other[np.unique(np.linspace(0, len(other) - 1, min(len(other), most)).round().astype(int))]
        self.rows = np.union1d(rows, [0.0]) if other[0] < 0 < other[-1] else rows  # |B| has a corner at 0

    def of(self, paddle: SimulatedPaddle) -> WallMap:
        """Return the WallMap of a paddle."""
        self._check(paddle, self.over, self.unusable)
        if paddle.T != self.T and isinstance(self.limits, SceneLimits):
            raise AnalysisError(f"T = {paddle.T:g} s, but the maps of this scene are made for {self.T:g} s. Make new ones")
        begun = time.perf_counter()
        K, other = self.axes.values()
        limits = self._limits(paddle, self.rows)
        amplitude, last, fault = self._run(paddle, K, other)
        found = WallMap(
            axes=self.axes, regions=np.zeros(amplitude.shape, int), amplitude=amplitude, undecided=np.isnan(amplitude) & ~fault,
            rows=self.rows, limits=limits, unusable=self.unusable, duration=self.runs.duration,
            units={"K": "N/m", self.over[1]: OTHERS[self.over[1]]}, about=self._about(paddle),
        )  # fmt: skip
        # irregular swings of an unstable loop that happen to get smaller are no decay; friction stops small ones alone
        free = (other == 0 if self.over[1] == "coulomb" else paddle.coulomb == 0) | (last > self.unusable)
        found = replace(found, amplitude=np.where(beyond(found) & free, np.maximum(amplitude, last), amplitude))
        return replace(found, regions=regions_of(found, fault), seconds=time.perf_counter() - begun)

    def _run(self, paddle, K, other):
        """Return amplitude, last amplitude and fault of the contacts at every K and other, arrays of that shape."""
        points = {self.parameter: np.repeat(K, len(other)), "B": np.full(K.size * other.size, self.B)}
        points[self.over[1].replace("hand_", "hand.")] = np.tile(other, len(K))
        if "T" not in points and paddle.T != self.T:
            points["T"] = np.full(K.size * other.size, paddle.T)
        runs = self.runs.chatter(replace(paddle, T=self.T), points, self.start)
        return (a.reshape(len(K), len(other)) for a in runs)

    def _limits(self, paddle, rows):
        """Return the limits at values of the other quantity, by name."""
        found = []
        for value in rows.tolist():
            B = value if self.over[1] == "B" else self.B
            found.append(self.limits.at(changed(paddle, self.over[1], value), B))
        return {name: tuple(one[name] for one in found) for name in found[0]}

    def _stiffnesses(self, paddle, other, points):
        """Return a range of K that shows where most of the rows lose their stability."""
        rows = other[np.unique(np.linspace(0, len(other) - 1, 9).astype(int))]
        limits = np.array([one.K for one in self._limits(paddle, rows).get("stability", ())])
        ends = limits[(limits > 0) & np.isfinite(limits)]
        top = 1.5 * min(ends.max(), 4 * np.median(ends)) if len(ends) else 2 * self._softest(paddle, rows)
        return np.linspace(top / points, top, points)

    def _softest(self, paddle, rows):
        """Return, where no theory is known, about the softest wall that does not come to rest in the middle of the map."""
        K = np.geomspace(1e-4, 1.0, 41) * paddle.m / paddle.T**2
        amplitude, _, fault = self._run(paddle, K, rows[len(rows) // 2 :][:1])
        rests = (~fault & (amplitude == 0)).ravel()
        bad = ~rests & (np.arange(len(K)) > np.argmax(rests))  # softer than the softest that rests: too slow to tell
        return K[np.argmax(bad)] if bad.any() else K[-1]

    def _axis(self, name, given, default):
        try:
            array = np.asarray(default() if given is None else given, float)
        except (TypeError, ValueError):
            array = np.array([])
        if array.ndim != 1 or len(array) < 2 or not np.isfinite(array).all() or (np.diff(array) <= 0).any():
            raise AnalysisError(f"{name} = {given}; an axis of a map needs two or more finite numbers in rising order")
        if name == "K" and array[0] < 0:
            raise AnalysisError(f"K = {array[0]:g} N/m; a wall needs K >= 0")
        return array

    def _check(self, paddle, over, unusable):
        if not isinstance(paddle, SimulatedPaddle):
            raise AnalysisError(
                f"a map simulates thousands of contacts; needs a SimulatedPaddle, not {what_is(paddle)}. "
                "hl.SimulatedPaddle.from_profile(...) makes one of a profile or its file"
            )
        if len(over) != 2 or over[0] != "K" or over[1] not in OTHERS:
            raise AnalysisError(f'over = {over}; needs ("K", other) with other one of {", ".join(OTHERS)}')
        if over[1].startswith("hand_") and paddle.hand is None:
            raise AnalysisError(f"over = {over}; the paddle has no hand. Give it one: hand=hl.Hand(push=1.0)")
        if over[1] == "counts_per_metre" and paddle.counts_per_metre is None:
            raise AnalysisError(f"over = {over}; the paddle has no encoder. Give it one: counts_per_metre=2e4")
        number("unusable", unusable, "m", above=0, what="an amplitude")

    def _check_scene(self, scene):
        """Refuse a scene that cannot be mapped: without the parameters of the axes, or over T, on which its times depend."""
        if self.over[1] == "T":
            raise AnalysisError(
                f'over = {self.over}; a map over T needs a law by name, such as law="ellis". For a scene use hl.sweep'
            )
        if self.over[1] != "B" and self.over[1] in scene.parameters:
            raise AnalysisError(f"{self.over[1]} is a parameter of {scene.name} and of the paddle; rename the scene's")
        for name in (self.parameter, *(["B"] if self.over[1] == "B" else [])):
            if name not in scene.parameters:
                known = ", ".join(scene.parameters) or "none"
                raise AnalysisError(f"{scene.name} has no parameter {name}; it has {known}. Name its stiffness with parameter=")
            if name in scene.values and math.isnan(scene.parameters[name].value):
                raise AnalysisError(
                    f"{scene.name} has {name} = {scene.values[name]:g}, but the map is over {name}. Leave it unbound"
                )

    def _about(self, paddle):
        B = f", B = {self.B:g} N s/m" if self.B else ""
        x, v = self.start
        ends = ""
        if self.ranged and getattr(self.limits, "linear", True) is None:
            ends = "\nK ends at twice the softest wall found that does not come to rest; give K=... for a different range"
        return f"{self.limits.name}{B}; a contact begins at {1e3 * x:g} mm with {v:g} m/s{ends}\n{paddle}"


def _start(x, v):
    """Return where a contact begins."""
    return tuple(
        number(name, value, unit, why="a contact begins at a finite one")
        for name, value, unit in (("x", x, "m"), ("v", v, "m/s"))
    )


def _check_names(axes, over):
    """Refuse what is no axis of the map, and say what it may be."""
    for name in (name for name in axes if name not in over):
        if name in OTHERS or name == "K":
            raise AnalysisError(f"{name}: the map is over {' and '.join(over)}; set it on the paddle, or map over it")
        options = [option for option in inspect.signature(WallMaps).parameters if option not in ("paddle", "axes")]
        near = get_close_matches(name, [*over, *options], 1) or [one for one in over if one.lower() == name.lower()]
        mean = f"; did you mean {near[0]}?" if near else ""
        raise AnalysisError(
            f"{name} is neither one of the axes {', '.join(over)} nor one of the options {', '.join(options)}{mean}"
        )


def changed(paddle, name, value):
    """Return a paddle with one quantity of its own, or of its hand, changed; B is none of them."""
    if name == "B":
        return paddle
    if name.startswith("hand_"):
        return replace(paddle, hand=replace(paddle.hand, **{name.removeprefix("hand_"): value}))
    return replace(paddle, **{name: value})


def _range(paddle, name, points):
    """Return values of a quantity around what the paddle has."""
    hand, b = paddle.hand, paddle.b or 0.1
    spans = {
        "B": lambda: np.linspace(-1.5 * b, 3 * b, points),
        "T": lambda: np.geomspace(paddle.T / 4, paddle.T * 4, points),
        "delay": lambda: np.linspace(0, 3 * paddle.T, points),
        "sensor_delay": lambda: np.linspace(0, 3 * paddle.T, points),
        "m": lambda: np.geomspace(paddle.m / 4, paddle.m * 4, points),
        "b": lambda: np.linspace(0, 4 * b, points),
        "coulomb": lambda: np.linspace(0, 2 * paddle.coulomb or 0.2, points),
        "counts_per_metre": lambda: np.geomspace(paddle.counts_per_metre / 10, paddle.counts_per_metre * 10, points),
        "hand_m": lambda: np.linspace(0, 3 * hand.m or 0.2, points),
        "hand_b": lambda: np.linspace(0, 3 * hand.b or 5.0, points),
    }
    return spans[name]()
