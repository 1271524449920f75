"""Reaching by anticipation and by feedback: what a hand can follow when it knows its load, and when it only looks.

Section 23.3.3: an open loop needs a model of hand, handle and load; a closed one waits for a reaction time.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Literal, Protocol, get_args

import numpy as np

from ..base.arguments import choice, instance, number, numbers
from ..base.drawing import house_style, new_figure, style_of
from ..base.shows_itself import ShowsItself
from ..base.telemetry import Telemetry
from ..device.hand.hand import UNITS
from ..device.hand.intents import Intent, MinimumJerk
from ..device.hand.reacting_hand import REACTION, Reacting
from ..errors import PaddleError
from .arm import Arm
from .paddle_needs import check_held

if TYPE_CHECKING:
    from collections.abc import Callable

    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike

    from ..base.annotations import Array
    from ..compiler.ir.program import Program
    from ..device.simulated.simulated_paddle import SimulatedPaddle
    from ..scene.scene import Scene

How = Literal["anticipatory", "feedback", "both"]
HOW: tuple[How, ...] = get_args(How)
#: of the distance: so near, a reach has arrived
ARRIVED = 0.05


class Path(Protocol):
    """A path of time: (position [m], velocity [m/s], acceleration [m/s^2]) at times [s]."""

    def at(self, times: Any, /) -> Any: ...


@dataclass(frozen=True, kw_only=True)
class Load(ShowsItself):
    """The load that a person expects, in addition to their own hand.

    Parameters
    ----------
    m : float
        Mass [kg], >= 0.
    b : float
        Damping [N s/m], >= 0.
    k : float
        Stiffness [N/m] of a spring from x = 0, >= 0.

    Examples
    --------
    >>> from hapticlab.experiments.reaching import Load
    >>> Load(m=0.5)
    Load(m=0.5, b=0.0, k=0.0)
    """

    m: float = 0.0
    b: float = 0.0
    k: float = 0.0

    def __post_init__(self) -> None:
        for name in ("m", "b", "k"):
            object.__setattr__(self, name, number(name, getattr(self, name), UNITS[name], "a load", least=0, error=PaddleError))


@dataclass(frozen=True, kw_only=True)
class Control(ShowsItself):
    """The control by which a person moves a handle: by knowing the load, by feedback, or by both.

    Parameters
    ----------
    how : {"anticipatory", "feedback", "both"}
    expects : Load, optional
        What the person believes to move; by default the paddle alone, with nothing rendered.
    gain : float or text, optional
        [1/s]; by default 1/(e (reaction + 10 ms)), the fastest without overshoot for a handle that follows its intent
        at once. Such a loop is unstable from about pi/(2 reaction) on, 8.3 1/s with the chapter's 180 ms.
    reaction : float or text
        Time [s] until what is seen changes what is done.
    tremor : callable, optional
        Beside whatever is intended, of times [s], in metres: ``hl.people.Tremor(rms=1e-4)``.

    Examples
    --------
    >>> import hapticlab as hl
    >>> hl.people.Control(how="feedback", reaction="200 ms").reaction
    0.2
    """

    how: How = "anticipatory"
    expects: Load | None = None
    gain: float | None = None
    reaction: float = REACTION
    tremor: Callable[[Array], ArrayLike] | None = None

    def __post_init__(self) -> None:
        choice("how", self.how, HOW, error=PaddleError)
        need = "the load that the person expects, such as hl.people.Load(m=0.5), in kg."
        instance("expects", self.expects, Load | None, need, error=PaddleError)
        gain, reaction = {"unit": "1/s", "least": 0}, {"unit": "s", "least": 0}
        numbers(self, "a person", error=PaddleError, gain=gain, reaction=reaction)


CONTROL = Control()


@dataclass(frozen=True, eq=False)
class Reach(ShowsItself):
    """How a reach went.

    Attributes
    ----------
    how : {"anticipatory", "feedback", "both"}
    log : Telemetry
    wanted : array, shape (N,)
        Where the handle was meant to be at the samples [m].
    settled : float or None
        After the beginning of the reach, from when on the handle stayed within 5 % of the distance [s].
    overshoot : float
        The largest way beyond the target, as a part of the distance.
    error : float
        Root mean square of x - wanted, over the whole record [m].
    """

    how: How
    log: Telemetry
    wanted: Array
    settled: float | None
    overshoot: float
    error: float

    def __str__(self) -> str:
        there = "never stayed near the target" if self.settled is None else f"there after {self.settled:.3g} s"
        return f"{self.how}: {there}, overshoot {100 * self.overshoot:.3g} %, rms error {1e3 * self.error:.3g} mm"

    def plot(self) -> Figure:
        """Draw handle and wanted path against time; return the figure."""
        with house_style():
            figure = new_figure(height=3.2)
            axes = figure.subplots()
            axes.plot(self.log.t, 1e3 * self.wanted, **style_of(5), label="meant")
            axes.plot(self.log.t, 1e3 * handle(self.log), **style_of(0), label=f"handle, {self.how}")
            axes.set(xlabel="time [s]", ylabel="handle position x [mm]")
            axes.legend()
        return figure


def handle(log: Telemetry) -> Array:
    """Position of the handle [m], also where an encoder hid it."""
    return np.asarray(log.channels.get("x_true", log.x), float)


def reach(
    paddle: SimulatedPaddle,
    scene: Scene | Program,
    *,
    end: float,
    duration: float = 0.4,
    begin: float = 0.1,
    record: float = 2.0,
    control: Control = CONTROL,
    **options: Any,
) -> Reach:
    """Let the hand of a simulated paddle reach for a target, smoothly, from x = 0.

    "anticipatory" sends the intent that would move hand and expected load along a path of minimum jerk, and looks at
    nothing: exact where the expectation is right, too far where the suitcase was empty. "feedback" sees path and handle
    a reaction time late and moves the intent by a ``gain`` times their distance, per second. "both" does the first, and
    corrects by the second.

    Parameters
    ----------
    paddle : SimulatedPaddle
        With a hand that has k > 0; its intent is replaced.
    scene : Scene or Program
    end, duration, begin : float
        Target [m], length [s] and start [s] of the reach.
    record : float
        Length of the record [s].
    control : Control
        By what the person moves: ``hl.people.Control(how=, expects=, gain=, reaction=, tremor=)``.
    **options
        Of hapticlab.compile.

    Returns
    -------
    Reach

    Raises
    ------
    PaddleError
        Without a hand that can hold the handle.

    Examples
    --------
    >>> import hapticlab as hl
    >>> from hapticlab.experiments.reaching import reach
    >>> paddle = hl.SimulatedPaddle(m=0.03, b=0.1, T=1e-3, hand=hl.Hand("grip"))
    >>> free = hl.wall()(k=0, x_o=1)
    >>> known = reach(paddle, free, end=0.02)
    >>> round(known.settled, 3), known.error < 1e-6
    (0.325, True)
    >>> print(reach(paddle, free, end=0.02, control=hl.people.Control(how="feedback")))
    feedback: there after 1.26 s, overshoot 0 %, rms error 8.03 mm
    """
    end = number("end", end, "m", "a reach", error=PaddleError)
    if end == 0:
        raise PaddleError("end = 0 m; a reach goes from x = 0 to a different position")
    path = MinimumJerk(end=end, duration=duration, begin=begin)
    log, wanted = follow(paddle, scene, path, record=record, control=control, **options)
    x, distance = handle(log), abs(end)
    near = abs(x - end) <= ARRIVED * distance
    away = np.flatnonzero(~near)
    settled = None if not near[-1] else max(float(log.t[away[-1]] + log.T - begin) if len(away) else 0.0, 0.0)
    beyond = float(np.max((x - end) * math.copysign(1, end))) / distance
    return Reach(control.how, log, wanted, settled, max(beyond, 0.0), float(np.sqrt(np.mean((x - wanted) ** 2))))


def follow(
    paddle: SimulatedPaddle,
    scene: Scene | Program,
    path: Path,
    *,
    record: float = 2.0,
    control: Control = CONTROL,
    **options: Any,
) -> tuple[Telemetry, Array]:
    """Let the hand of a simulated paddle follow a path; return (Telemetry, target position of the handle [m]).

    Parameters
    ----------
    paddle : SimulatedPaddle
        With a hand that has a spring; its target position is replaced.
    scene : Scene or Program
        A scene with every parameter bound, or the program that was compiled from one.
    record : float
        How long the record is [s], > 0.
    control : Control
        How the hand controls the motion; as for :func:`reach`.
    path : object with ``at(t)`` that returns position [m], velocity [m/s], acceleration [m/s^2]
        ``hl.people.MinimumJerk`` or an :class:`~hapticlab.analysis.accuracy.handle_motions.HandleMotion`. The others
        are those of :func:`reach`.
    **options
        As for ``paddle.run``.
    """
    hand = check_held(paddle, "reach")
    check_path(path)
    how, reaction, tremor = control.how, control.reaction, control.tremor
    every = max(round(0.01 / paddle.T), 1) * paddle.T
    gain = 1 / (math.e * (reaction + every)) if control.gain is None else control.gain
    known = control.expects or Load(m=paddle.m, b=paddle.b)
    times = np.arange(paddle.ticks(record) + 1) * paddle.T
    ahead = Anticipated(times, inverse_dynamics(hand, known, path, times))

    def plan(t, seen, intent):
        """Correct the intent by what was seen; for "both" against where the handle should have been then."""
        then, now = (seen.t[-1], seen.x[-1]) if len(seen) else (0.0, float(path.at([0.0])[0][0]))
        error = float(path.at([then])[0][0]) - now
        moved = float(ahead(t) - ahead(t - every)) if how == "both" else 0.0
        return intent + moved + gain * every * error

    intent = ahead if how == "anticipatory" else Reacting(plan=plan, reaction=reaction, interval=every)
    intent = intent if tremor is None else intent + tremor
    log = replace(paddle, hand=replace(hand, intent=intent)).run(scene, duration=record, progress=False, **options)
    return log, path.at(log.t)[0]


@dataclass(frozen=True, eq=False)
class Anticipated(Intent):
    """An intent computed beforehand, at so many times, linear in between."""

    times: np.ndarray
    places: np.ndarray

    def __call__(self, t: ArrayLike) -> Array:
        return np.interp(np.asarray(t, float), self.times, self.places)


def check_path(path: object) -> None:
    """Refuse what is no path, or whose ``at`` does not return positions, velocities and accelerations."""
    if isinstance(path, type) or not hasattr(path, "at"):
        raise PaddleError(f"path = {path!r}; needs a path of time, such as hl.people.MinimumJerk(end=0.02, duration=0.4).")
    times, cause = np.array([0.0, 1e-3]), None
    try:
        found = [np.asarray(part, float) for part in path.at(times)]
        gave = f"{len(found)} parts of shapes {', '.join(str(part.shape) for part in found)}"
    except (TypeError, ValueError) as problem:
        found, cause, gave = [], problem, f"{type(problem).__name__}: {problem}"
    if len(found) != 3 or any(part.shape != times.shape for part in found):
        raise PaddleError(
            f"path = {path!r}: path.at(times) at two times gave {gave}. It needs three arrays with one value for each time: "
            "position [m], velocity [m/s] and acceleration [m/s^2]. hl.people.MinimumJerk(end=0.02, duration=0.4) is such a path."
        ) from cause


def inverse_dynamics(hand, load, path, times):
    """The intent [m] at the times [s] that moves hand and load along a path: k i + b i' = M a + (b + b_l) v + (k + k_l) x.

    Where the hand has a damper the intent solves that first-order equation, its right side linear between times.
    """
    x, v, a = (np.asarray(part, float) for part in path.at(times))
    arm = Arm(m=hand.m + load.m, b=load.b, b_hand=hand.b, k=hand.k)
    lasting = arm.force(x, v, a) + load.k / hand.k * x
    if hand.b == 0:
        return lasting
    found = [x[0]]
    for now, following in zip(lasting[:-1], lasting[1:], strict=True):
        found.append(arm.intent(found[-1], now, following, times[1] - times[0]))
    return np.array(found)
