"""How a search of walls begins: how long a trial lasts, how hard the push, how soft the first, and is there hope at all."""

import math
from dataclasses import dataclass, replace

import numpy as np

from ..device.paddle import Paddle
from ..device.simulated.simulated_paddle import SimulatedPaddle
from ..errors import AnalysisError
from .trials import ENOUGH, PERIODS, count_of, period_on

#: how deep the push presses the handle into the first, softest wall [m]
DEEPEST = 0.01
#: samples of a trial by default, and of one that is asked for
SHORTEST, FEWEST = 500, 128
#: times as long as it begins, the trial that is the answer is repeated; and any may become, by default, while it does not tell
AGAIN, LONGER = 4, 16
#: the motor's push by default [N], and the part of the paddle's force limit that it may be
PUSH, OF_LIMIT = 0.2, 0.25


def durations_of(paddle, duration, longest):
    """A function of K that gives (how long a trial begins, how long its repetition, how long it may become) [s]."""
    for name, value in (("duration", duration), ("longest", longest)):
        if value is not None and not FEWEST * paddle.T <= value < math.inf:
            raise AnalysisError(
                f"{name} = {value:g} s; a trial needs at least {FEWEST} samples, so {name} needs to be "
                f"{FEWEST * paddle.T:g} s or more, and finite"
            )

    def durations(K):
        periods = PERIODS * period_on(paddle, K)
        begin = max(1.0, SHORTEST * paddle.T, periods) if duration is None else duration
        full = LONGER * max(begin, periods) if longest is None else max(longest, duration or 0.0)
        return min(begin, full), min(AGAIN * begin, full), full

    return durations


@dataclass(frozen=True)
class Start:
    """One start: a paddle with its hand, the motor's push and the hand's lean [N], and where the handle is let go [m].

    That is so far before the wall; or, where ``run_up`` is None, at a depth in the wall where the push and a part of an
    encoder count hold it at rest. From there a buzz is seen that a slow swing would hide.
    """

    paddle: Paddle
    push: float
    leaning: float
    run_up: float | None
    part: float = 0.0
    depth: float = 0.0

    def at(self, K, first):
        """The start at a wall of K [N/m]; in one softer than the ``first`` the push would sink it in, so there it is less."""
        step = min(self.part * K * count_of(self.paddle), OF_LIMIT * _force_max(self.paddle))
        push, hand = (self.push + step) * min(1.0, K / first), getattr(self.paddle, "hand", None)
        resting = (push + self.leaning) / (K + (hand.k if hand else 0.0))
        return replace(self, push=push, depth=resting if self.run_up is None else -self.run_up)

    def __str__(self):
        way = "at rest in it" if self.run_up is None else f"from {1e3 * self.run_up:g} mm before it"
        return f"{self.push + self.leaning:.3g} N, {way}"


def starts_of(paddle, asked, place, seconds):
    """Every start that is asked for: hands and pushes, with each run-up and, where it is sensed in steps, at rest in the wall."""
    if asked.hands and not isinstance(paddle, SimulatedPaddle):
        raise AnalysisError("hands are simulated; on a board, hold the handle in another way and measure again")
    held = [replace(paddle, hand=hand) for hand in asked.hands] or [paddle]
    pressed = [(p, *_pushes(p, push, place, seconds)) for p in held for push in asked.pushes or (None,)]
    entries = [(way, 0.0) for way in asked.run_ups]
    resting = [(None, j / asked.within_count) for j in range(asked.within_count)] if count_of(paddle) else []
    return [Start(*each, *way) for each in pressed for way in entries + resting]


def _pushes(paddle, push, place, seconds):
    """The motor's push and the force with which a simulated hand leans on the wall [N]; a moving hand's in the mean."""
    hand, most = getattr(paddle, "hand", None), _force_max(paddle)
    leaning = 0.0
    if hand is not None:
        if hand.push_noise:
            raise AnalysisError(
                f"the hand's force has noise of {hand.push_noise:g} N, so the handle never rests. Search with Hand(noise=0)"
            )
        ticks = max(1, round(seconds / paddle.T))
        at = float(np.mean(hand.samples(ticks, paddle.T))) if hand.moves else hand.intent or 0.0
        leaning = hand.push + hand.k * (at - place)
    push = (0.0 if leaning else min(PUSH, OF_LIMIT * most)) if push is None else float(push)
    if push + leaning <= 0:
        who = "the hand pulls" if leaning else "the push pulls"
        raise AnalysisError(
            f"{who} the handle off the wall with {-push - leaning:g} N; needs a push: Starts(pushes={PUSH - leaning:.3g})"
        )
    if push + leaning >= most:
        raise AnalysisError(
            f"a push of {push + leaning:g} N on a paddle whose motor gives at most {most:g} N: no wall can resist this "
            f"push. Give a smaller one, such as Starts(pushes={OF_LIMIT * most - leaning:.3g})"
        )
    return push, leaning


def _force_max(paddle):
    most = paddle.force_max if isinstance(paddle, SimulatedPaddle) else paddle.settings.force_max
    return most or math.inf


def first_of(paddle, pressing, longest):
    """The softest wall to begin with [N/m]: not too deep, and with three periods in the longest trial."""
    soft = (pressing or PUSH) / DEEPEST
    needs = 0.0 if longest is None else ENOUGH * period_on(paddle, soft) / longest
    return soft * max(1.0, needs**2)


def hopeless(paddle, theory):
    """Whether theory predicts instability at every stiffness and the paddle has no Coulomb friction to prevent it."""
    limit = theory.get("stability")
    known = limit is not None and limit.K == 0 and "stable again" not in limit.reason
    return known and not getattr(paddle, "coulomb", 0.0)
