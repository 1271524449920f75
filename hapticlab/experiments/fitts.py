"""Fitts' targets: how fast a hand reaches targets of several distances and widths, with any scene on the handle."""

from __future__ import annotations

import csv
import math
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ..base.drawing import FRAME, house_style, new_figure, style_of
from ..base.shows_itself import ShowsItself, Tabular
from ..device.hand.intents import Intent
from ..device.hand.reacting_hand import REACTION, Reacting
from ..errors import AnalysisError
from ..scene.notation.symbols import n, parameters, x
from ..scene.scene import Scene
from .arm import Arm, along, quintic
from .paddle_needs import check_held
from .submovements import Submovements

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from matplotlib.figure import Figure

    from ..base.annotations import Array, File
    from ..device.simulated.simulated_paddle import SimulatedPaddle

#: in the target for so long, it is selected [s]
DWELL = 0.1
#: of the fastest: slower, a movement has not begun
ONSET = 0.05
#: sqrt(2 pi e): the width that holds 96 % of normal ends and as much information as their scatter
EFFECTIVE = math.sqrt(2 * math.pi * math.e)


@dataclass(frozen=True)
class Targets(ShowsItself):
    """Movements between two targets of one width.

    Attributes
    ----------
    distance, width : float
        As shown [m].
    times : tuple of float
        From setting out to being in the next target for good [s].
    ends : tuple of float
        Where each ended, along the movement, beside the centre of its target [m].
    """

    distance: float
    width: float
    times: tuple[float, ...]
    ends: tuple[float, ...]

    @property
    def time(self) -> float:
        """Mean movement time [s]."""
        return float(np.mean(self.times))

    @property
    def difficulty(self) -> float:
        """Index of difficulty, log2(distance/width + 1) [bit]."""
        return math.log2(self.distance / self.width + 1)

    @property
    def effective_difficulty(self) -> float:
        """The same of the mean distance moved and of 4.133 standard deviations of the ends [bit]."""
        return math.log2((self.distance + float(np.mean(self.ends))) / (EFFECTIVE * float(np.std(self.ends, ddof=1))) + 1)

    @property
    def throughput(self) -> float:
        """Effective difficulty over movement time [bit/s]."""
        return self.effective_difficulty / self.time


@dataclass(frozen=True)
class Fitts(Tabular):
    """Movement times over several targets.

    Attributes
    ----------
    targets : tuple of Targets
    scene : str
    """

    targets: tuple[Targets, ...]
    scene: str = ""

    @property
    def law(self) -> tuple[float, float, float]:
        """Intercept [s], slope [s/bit] and squared correlation of mean time over index of difficulty."""
        difficulty, time = np.array([(a.difficulty, a.time) for a in self.targets]).T
        slope, intercept = np.polyfit(difficulty, time, 1)
        return float(intercept), float(slope), float(np.corrcoef(difficulty, time)[0, 1] ** 2)

    @property
    def throughput(self) -> float:
        """Mean over the targets [bit/s], as ISO 9241-411 has it."""
        return float(np.mean([a.throughput for a in self.targets]))

    def __str__(self) -> str:
        intercept, slope, fit = self.law
        rows = [
            f"  {1e3 * a.distance:8.4g} mm {1e3 * a.width:8.4g} mm {a.difficulty:7.2f} bit {1e3 * a.time:8.4g} ms "
            f"{a.effective_difficulty:7.2f} bit {a.throughput:7.2f} bit/s"
            for a in self.targets
        ]
        head = f"{self.scene or 'targets'}: {1e3 * intercept:.3g} ms + {1e3 * slope:.3g} ms/bit (r^2 = {fit:.3f})"
        return "\n".join([f"{head}, throughput {self.throughput:.2f} bit/s",
                          "  distance    width       index        time       effective   throughput", *rows])  # fmt: skip

    def to_csv(self, path: File) -> Path:
        """Write one row a movement and return the path."""
        with open(path, "w", newline="", encoding="utf-8") as file:
            table = csv.writer(file, lineterminator="\n")
            table.writerow(["distance [m]", "width [m]", "time [s]", "end [m]"])
            for a in self.targets:
                table.writerows((a.distance, a.width, time, end) for time, end in zip(a.times, a.ends, strict=True))
        return Path(path)

    def plot(self) -> Figure:
        """Draw mean movement time over index of difficulty, with the line through it."""
        with house_style():
            figure = new_figure(height=3.6)
            axes = figure.subplots()
            intercept, slope, _ = self.law
            difficulty = np.array([a.difficulty for a in self.targets])
            axes.plot(difficulty, [1e3 * a.time for a in self.targets], "o", color="#000000", label=self.scene or "movements")
            span = np.array([0.9 * difficulty.min(), 1.05 * difficulty.max()])
            line = f"{1e3 * intercept:.3g} ms + {1e3 * slope:.3g} ms/bit"
            axes.plot(span, 1e3 * (intercept + slope * span), **style_of(1), label=line)
            axes.set(xlabel="index of difficulty [bit]", ylabel="movement time [ms]", ylim=(0, None))
            axes.legend(loc="lower right", **FRAME)
        return figure


def fitts(
    paddle: SimulatedPaddle,
    scene: Scene | Callable[[float, float], Scene] | None = None,
    *,
    distances: Iterable[float] = (0.02, 0.04, 0.08),
    widths: Sequence[float] | Array = (0.004, 0.008),
    movements: int = 16,
    scatter: float = 0.04,
    reaction: float = REACTION,
    seed: int = 0,
) -> Fitts:
    """Let a simulated hand move back and forth between targets at x = 0 and x = distance, with a scene on the handle.

    The hand makes submovements: it aims, sees a reaction time later where
    it is, and corrects where it missed. It expects an empty handle: what a scene adds is met by correction.

    Parameters
    ----------
    paddle : SimulatedPaddle
        With a hand that has k > 0; its intent is replaced.
    scene : Scene or callable, optional
        What is felt; a callable gets distance and width [m] and returns a scene. None: nothing.
    distances, widths : sequence of float
        [m]; every pair with distance > width.
    movements : int
        For each pair.
    scatter : float
        Standard deviation of a submovement's end over its mean speed [s], illustrative.
    reaction : float
        [s]
    seed : int

    Returns
    -------
    Fitts

    Raises
    ------
    PaddleError, AnalysisError
        Without a hand; where a target was not reached.

    Examples
    --------
    >>> import hapticlab as hl
    >>> paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand("grip"))
    >>> found = hl.people.fitts(paddle, distances=[0.03], widths=[0.005, 0.01], movements=3)
    >>> [round(a.difficulty, 2) for a in found.targets]
    [2.81, 2.0]
    """
    check_held(paddle, "fitts")
    pairs = [(float(d), float(w)) for d in distances for w in widths if d > w > 0]
    if len(pairs) < 2 or movements < 3:
        raise AnalysisError(f"{len(pairs)} pairs with distance > width > 0, {movements} movements; needs at least 2 and 3")
    empty = Scene(parameters("k_0", units="N/m", values=0) * x(n), name="empty handle")
    done = []
    for number, (distance, width) in enumerate(pairs):
        felt = (scene(distance, width) if callable(scene) and not isinstance(scene, Scene) else scene) or empty
        done.append(_between(paddle, felt, distance, width, movements, scatter, reaction, [seed, number]))
    return Fitts(tuple(done), felt.name)


def _between(paddle, scene, distance, width, movements, scatter, reaction, seed):
    aim = Aiming(paddle, distance, Submovements(width, scatter=scatter, pause=reaction + DWELL, furthest=4 * distance), seed)
    hand = replace(paddle.hand, intent=Reacting(plan=aim.plan, reaction=reaction))
    mean = aim.submovements.time(distance) + reaction + 2 * DWELL
    log = replace(paddle, hand=hand).run(scene, duration=(movements + 4) * 1.4 * mean, progress=False)
    x = np.asarray(log.channels.get("x_true", log.x))
    found = selections(log.t, x, distance, width)
    if len(found) < movements + 1:
        raise AnalysisError(
            f"{len(found) - 1} of {movements} movements over {1e3 * distance:g} mm to {1e3 * width:g} mm in {log.t[-1]:.3g} "
            "s, because the target was missed repeatedly. Give a wider target, a smaller scatter, or a scene that pushes "
            f"less than {scene.name}"
        )
    found = found[: movements + 1]
    times = tuple(entered - left for (_, left, _), (entered, _, _) in zip(found[:-1], found[1:], strict=True))
    return Targets(distance, width, times, tuple(end for _, _, end in found[1:]))


def selections(t, x, distance, width):
    """(time entered for good, time set out, end beside the centre along the movement) of targets reached in turn.

    The first is the target at x = 0, then that at x = distance, and so on. A target is selected once the handle has
    been in it for :data:`DWELL`; the end is the mean place over that time. The handle sets out from it where it last
    was slower than :data:`ONSET` of its fastest on the way to leave.
    """
    found, at, side, dwell = [], 0, 0, round(DWELL / (t[1] - t[0]))
    speed = np.abs(np.gradient(x, t[1] - t[0]))
    while True:
        inside = np.abs(x - side * distance) <= width / 2
        run = np.convolve(inside[at:], np.ones(dwell), "valid")
        held = np.flatnonzero(run > dwell - 0.5)
        if not len(held):
            return found
        entered = at + int(held[0])
        outside = np.flatnonzero(~inside[entered:])
        if not len(outside):
            return found
        left = entered + int(outside[0])
        end = (float(x[entered : entered + dwell].mean()) - side * distance) * (1 if side else -1)
        fastest = speed[left : left + dwell].max()
        slow = np.flatnonzero(speed[entered:left] < ONSET * fastest)
        found.append((float(t[entered]), float(t[entered + (slow[-1] if len(slow) else 0)]), end))
        at, side = left, 1 - side


class Aiming(Intent):
    """The plan of a hand that goes to and fro between x = 0 and x = distance in submovements. One hand, one run."""

    def __init__(self, paddle, distance, submovements, seed):
        hand = paddle.hand
        self.arm = Arm(m=paddle.m + hand.m, b=paddle.b, b_hand=hand.b, k=hand.k)
        self.distance, self.submovements = distance, submovements
        self.rng = np.random.default_rng(seed)
        self.side, self.now, self.begun, self.ends = 0, 0.0, 0.0, 0.0
        self.path = quintic((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), 1.0)

    def plan(self, t, seen, intent):
        """Return the intent at t; decide on the next submovement once the last has been seen to end."""
        if len(seen) and seen.t[-1] >= self.ends + DWELL:
            self._next(float(seen.x[-1]))
        before, after = (self.arm.force(*self._at(at)) for at in (self.now, t))
        intent = self.arm.intent(intent, before, after, t - self.now)
        self.now = t
        return intent

    def _at(self, t):
        return along(self.path, min(max(t, self.begun), self.ends) - self.begun)

    def _next(self, x):
        """Correct a miss, or set out for the other target, from where the hand is meant to be by what was seen to be left."""
        left = self.side * self.distance - x
        if abs(left) <= self.submovements.width / 2:
            self.side = 1 - self.side
            left = self.side * self.distance - x
        duration = self.submovements.duration(abs(left))
        miss = self.submovements.scatter * abs(left) / duration * self.rng.standard_normal()
        here = self._at(self.now)[0]
        self.path = quintic((here, 0.0, 0.0), (here + left + miss, 0.0, 0.0), duration)
        self.begun, self.ends = self.now, self.now + duration
