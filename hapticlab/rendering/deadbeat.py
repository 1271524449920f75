"""Two held forces that bring the handle, after a crossing of the boundary, where handle, hand and wall would be by themselves."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np
import sympy as sp

from ..base.shows_itself import ShowsItself
from ..errors import SceneError
from ..scene.notation.symbols import delay, n, signal, when
from .digital import digital_force, motor_limit
from .flight import Flight
from .model import WallModel
from .predictive import half_sample_force
from .scene_lines import Lines, number

if TYPE_CHECKING:
    from ..device.device import AnyDevice
    from ..device.hand.hand import Hand
    from ..scene.laws.estimators import VelocityEstimate
    from ..scene.scene import Scene

#: when the pair of forces begins
BEGINS = ("predictive", "reactive")
#: the force inside the wall while no pair acts
BETWEEN = {"pairs": None, "half_sample": half_sample_force, "digital": digital_force}


@dataclass(frozen=True, kw_only=True)
class Pairs(ShowsItself):
    """The pairs of held forces of a dead-beat wall.

    Parameters
    ----------
    begins : {"predictive", "reactive"}
        ``"predictive"``: in the period in which the model foresees a crossing. ``"reactive"``: at the sample that finds the
        boundary crossed, with the goal that the handle of the sample before should have reached.
    between : {"pairs", "half_sample", "digital"}
        ``"pairs"``: every second sample lies on the motion of handle, hand and wall. ``"half_sample"`` as
        :func:`predictive_wall`, ``"digital"`` as :func:`digital_wall`: they ask less of the sensor and keep energy on
        the whole of a long contact only; of one that lasts a few periods they leave more or less, as its phase has it.
    crossings : {1, 2}
        Crossings the two periods of a pair may hold. 1 is cheaper: a crossing in the second of them is left until the pair
        is over, which a handle that touches and leaves within two periods shows, and so does ``between="pairs"``.
    accuracy : float
        Of the motion and the crossing times, relative to what moves; a rougher one is cheaper.

    Examples
    --------
    >>> import hapticlab as hl
    >>> hl.laws.Pairs(begins="reactive")
    Pairs(begins='reactive', between='pairs', crossings=2, accuracy=1e-10)
    """

    begins: Literal["predictive", "reactive"] = "predictive"
    between: Literal["pairs", "half_sample", "digital"] = "pairs"
    crossings: Literal[1, 2] = 2
    accuracy: float = 1e-10

    def __post_init__(self) -> None:
        if self.begins not in BEGINS or self.between not in BETWEEN or self.crossings not in (1, 2):
            raise SceneError(
                f"begins = {self.begins!r}, between = {self.between!r}, crossings = {self.crossings!r}; needs begins to be "
                f"one of {', '.join(BEGINS)}, between one of {', '.join(BETWEEN)}, and crossings 1 or 2"
            )


PAIRS = Pairs()


def deadbeat_wall(
    paddle: AnyDevice,
    *,
    K: float,
    B: float = 0.0,
    hand: Hand | None = None,
    velocity: Literal["model"] | VelocityEstimate | None = None,
    force_max: float | None = None,
    pairs: Pairs = PAIRS,
) -> Scene:
    """Virtual wall that emulates handle, hand and wall across its boundary (Section 23.4.1): dead-beat in two steps.

    Where the boundary is crossed the law computes the state that handle, hand and wall would have two periods on, crossing
    located, and then the only two held forces that take the sampled handle there. Inside the wall it goes on so, pair
    after pair, or takes one of the laws that look at one period.

    Parameters
    ----------
    paddle, K, B, hand
        As in :func:`digital_gains`.
    velocity, force_max
        As in :func:`digital_wall`. Without a limit the forces are what the goal asks: an error e of the sensed position
        changes them by some M e/T^2 (:func:`deadbeat_gains`).
    pairs : Pairs
        When a pair of forces begins, what acts between pairs and how exact they are:
        ``hl.laws.Pairs(begins=, between=, crossings=, accuracy=)``.

    Returns
    -------
    Scene
        It watches ``pair`` (0, or the number of the force of a pair) and ``limited`` (1 where the motor's limit cut a
        force, from where on the goal is missed).

    Examples
    --------
    >>> import hapticlab as hl
    >>> paddle = hl.SimulatedPaddle(m=0.35, b=0, T=0.01, hand=hl.Hand(m=0.006, k=500, intent=0.01))
    >>> log = paddle.run(hl.laws.deadbeat_wall(paddle, K=5000), duration=0.2, x=-0.02, progress=False)
    >>> log.pair[:10].astype(int).tolist()
    [0, 0, 0, 1, 2, 1, 2, 0, 0, 0]
    """
    lines = Lines(WallModel.of(paddle, K=K, B=B, hand=hand))
    p, w = lines.at_switch(velocity)
    due, second = signal("due", unit="1"), signal("second", unit="m")
    flight = Flight(lines, pairs.accuracy)
    now = (p, w, lines.let("side", when(p >= 0, 1, -1), "1"))
    if pairs.begins == "reactive":
        begin, *start = _crossed_before(lines, flight, now)
        begin = sp.And(begin, due(n - 2) < 0.5)  # a pair has dealt with what was crossed under it
    else:
        start = now
    *after, crossing = flight.period(1, *start)
    goal = flight.period(2, *after)[:2] if pairs.crossings == 2 else flight.same(2, *after)
    if pairs.begins == "predictive":
        begin = crossing
    if pairs.between == "pairs":
        begin = sp.Or(begin, p >= 0)
    lines.let(due, when(due(n - 1) > 0.5, 0, when(begin, 1, 0)))
    one, two = pair_forces(lines, p, w, goal)
    lines.let(second, two)
    inside = BETWEEN[pairs.between]
    alone = when(p >= 0, inside(lines, p, w), 0) if inside else 0
    force = when(due(n - 1) > 0.5, second(n - 1), when(due(n) > 0.5, one, alone))
    watch = {"pair": when(due(n - 1) > 0.5, 2, due(n))}
    return lines.scene(force, f"{pairs.begins} dead-beat wall", watch, motor_limit(paddle, force_max))


def _crossed_before(lines, flight, now):
    """Return whether the boundary was crossed since the sample before, and where the handle should be by now."""
    before = lines.let("p_before", delay(now[0])), lines.let("w_before", delay(now[1]))
    side = lines.let("side_before", when(before[0] >= 0, 1, -1), "1")
    crossed = lines.let("changed", side * now[2], "1") < 0
    meant = flight.period(0, *before, side)[:3]
    names = zip(("p_start", "w_start", "side_start"), ("m", "m", "1"), meant, now, strict=True)
    return crossed, *(lines.let(name, when(crossed, a, b), unit) for name, unit, a, b in names)


def pair_forces(lines, p, w, goal):
    """Return the two forces, in metres of the spring, that take (p, w) to the goal in two periods."""
    (Phi, gamma), (two, _) = lines.model.flow(1.0), lines.model.flow(2.0)
    pushed = Phi @ gamma + gamma
    missed = [number(two[i, 0]) * p + number(two[i, 1]) * w + number(pushed[i]) * lines.outer - goal[i] for i in (0, 1)]
    missed = [lines.let(name, each) for name, each in zip(("missed_p", "missed_w"), missed, strict=True)]
    return [number(row[0]) * missed[0] + number(row[1]) * missed[1] for row in _inverse(lines.model)]


def _inverse(model):
    """Return the inverse of what the two forces of a pair do to the state."""
    Phi, gamma = model.flow(1.0)
    return np.linalg.inv(np.column_stack([Phi @ gamma, gamma]))


@dataclass(frozen=True)
class DeadbeatGains(ShowsItself):
    """What an error of the sensed state changes the two forces of a pair by.

    Attributes
    ----------
    position : tuple of float
        [N/m], of the first force and of the second.
    velocity : tuple of float
        [N s/m].
    count : float or None
        The larger change of a force that one encoder count of position makes, velocity by backward difference [N]; None
        without an encoder.
    force_max : float or None
        [N]
    """

    position: tuple[float, float]
    velocity: tuple[float, float]
    count: float | None
    force_max: float | None

    def __str__(self) -> str:
        text = (
            f"the pair's forces change by {self.position[0]:.4g} and {self.position[1]:.4g} N per metre, "
            f"{self.velocity[0]:.4g} and {self.velocity[1]:.4g} N per m/s"
        )
        if self.count is None:
            return text
        most = "" if self.force_max is None else f" of the {self.force_max:g} N the motor has"
        return f"{text};\none encoder count changes them by {self.count:.3g} N{most}"


def deadbeat_gains(paddle: AnyDevice, *, hand: Hand | None = None) -> DeadbeatGains:
    """Gains from the sensed state to the two forces of a dead-beat pair: some M/T^2, so they blow up as T goes to 0.

    The error of a crossing that is located shrinks as T^3, faster than the gains grow; the errors of an encoder and of
    the model do not.

    Parameters
    ----------
    paddle : Device or paddle
        Its m, b, T and delay are read, and its counts_per_metre and force_max if it has them.
    hand : Hand, optional
        Its spring, damper and mass are part of the model; by default that of the paddle.

    Examples
    --------
    >>> import hapticlab as hl
    >>> print(hl.design.deadbeat_gains(hl.SimulatedPaddle(m=0.05, b=0, T=1e-3, counts_per_metre=1e5, force_max=5)))
    the pair's forces change by 5e+04 and -5e+04 N per metre, 75 and -25 N per m/s;
    one encoder count changes them by 1.25 N of the 5 N the motor has
    """
    model = WallModel.of(paddle, K=1.0, hand=hand)
    two = model.flow(2.0)[0]
    rows = _inverse(model) @ two
    count, T = getattr(paddle, "counts_per_metre", None), model.T
    change = None if count is None else float(abs(rows.sum(axis=1)).max() / count)
    (p0, v0), (p1, v1) = (rows * (1.0, T)).tolist()
    return DeadbeatGains((p0, p1), (v0, v1), change, getattr(paddle, "force_max", None))
