"""One wall tried on a paddle, simulated or real: what became of it, with the motor cut the moment it goes wrong."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..analysis.records.chatter import chatter
from ..device.simulated.simulated_paddle import SimulatedPaddle
from ..errors import PaddleError
from ..scene.laws.chapter_laws import wall
from ..scene.scene import Scene
from .guard import guarded

if TYPE_CHECKING:
    from ..scene.laws.taps import LawName

    pass

#: a spring and damper that lead a handle back, soft enough for any paddle [N/m], and how long they take [s]
LEADS_BACK, TAKES = 20.0, 0.5
#: of the natural frequency's critical damping
WELL_DAMPED = 0.7
#: standard errors by which a slow decay has to differ from none
SURE = 5.0
#: seconds of a trial, in periods of handle and hand on the wall's spring: what it begins with, and what it takes at least
PERIODS, ENOUGH = 10.0, 3.0
#: mass of a handle that does not say its own [kg]
A_HANDLE = 0.05
#: a push that moves the handle by less [m] has not tried the wall
MOVED = 1e-7
#: a handle that moves on by less than this part of its way, in the last quarter of a trial, rests
RESTS = 0.01
#: standard deviations of the sensor's noise that a resting handle may swing by
SCATTER = 6.0
#: encoder counts in a period that a speed limit must leave room for
COUNTS = 3


@dataclass(frozen=True)
class Trial:
    """Outcome of one stiffness.

    Attributes
    ----------
    K : float
        [N/m]
    stands : bool or None
        Whether the oscillation of the entry died out; None where the trial could not tell.
    verdict : str
        Why, in words.
    amplitude : float
        Of what oscillated at the end [m].
    frequency : float or None
        [Hz]
    drawn : float
        The most energy the wall had given at any time, more than it took [J].
    duration : float
        Of the trial [s].
    scatter : float
        Standard deviation of the sensor's noise [m], where a handle at rest shows nothing else; else 0.
    """

    K: float
    stands: bool | None
    verdict: str
    amplitude: float
    frequency: float | None
    drawn: float
    duration: float
    scatter: float = 0.0

    def __str__(self) -> str:
        tone = "" if self.frequency is None else f" at {self.frequency:.4g} Hz"
        swing = f", {1e3 * self.amplitude:.3g} mm{tone}" if self.amplitude else ""
        outcome = {True: "stands   ", False: "chatters ", None: "undecided"}[self.stands]
        return f"{self.K:10.5g} N/m  {outcome} {self.verdict}{swing}"


def try_wall(paddle, scene, *, K, place, duration, longest, buzz_max=0.05, noise=0.0):
    """Try one stiffness, longer and longer until the record tells; a simulated handle starts at rest at ``place`` [m].

    A limit cycle and a decay too slow to see look alike. At ``longest`` [s] a decay has to be five times its own standard
    error; what then lasts counts as chatter, and what neither lasts nor dies out is undecided. A handle that dithers over
    the edge of one encoder count stands where the force jumps by no more than ``buzz_max`` [N]. A motion that follows a
    simulated hand's moving intent is no chatter; nor is what stays within six standard deviations ``noise`` of the sensor [m],
    which the loop colours.
    """
    needs = ENOUGH * period_on(paddle, K)
    if needs > longest * 1.001:
        return Trial(
            K, None, f"not tried: three swings take {needs:.3g} s; needs Judgement(longest={needs:.2g})", 0.0, None, 0.0, 0.0
        )
    duration = max(duration, min(needs, longest))
    while True:
        log = run_from(paddle, scene, place, duration)
        last = 2 * duration > longest * 1.001
        outcome = _judged(paddle, log, place, buzz_max, last, noise)
        if outcome is not None:
            stands, verdict, amplitude, frequency, *scatter = outcome
            drawn = max(0.0, float(log.drawn.max(initial=0.0)))
            return Trial(K, stands, verdict, amplitude, frequency, drawn, duration, *scatter)
        duration *= 2


def _judged(paddle, log, place, buzz_max, last, noise):
    """(stands, verdict, amplitude, frequency, scatter where it rests), or None where a longer record may tell."""
    stopped = _stopped(log)
    if stopped:
        return *stopped, 0.0, None
    hand = getattr(paddle, "hand", None)
    found = chatter(log, driven=hand if hand is not None and hand.moves else None)
    swing, x = (found.amplitude, found.frequency), log.channels.get("x_true", log.x)
    way, half = float(abs(x - place).max()), len(x) // 2
    if way < MOVED:
        return None, "the push did not move the handle: friction holds it; push harder", *swing
    if found.scatter or (found.state == "none" and found.travel < RESTS * way):
        return True, "it comes to rest", *swing, found.scatter
    if found.state == "driven":
        return True, "it only follows the hand", *swing
    if found.dither or ("x_true" not in log.channels and 0 < found.amplitude < 1.01 * count_of(paddle)):
        jump = float(np.ptp(log.F[half:]))
        felt = "too little to feel" if jump <= buzz_max else "felt"
        return jump <= buzz_max, f"it buzzes by {_counts(found)}, {jump:.2g} N, {felt}", *swing
    if 0 < found.amplitude < SCATTER * noise:
        return True, "it rests but for the noise of its sensor", *swing
    # what bounces or is clipped may decay onto a small chatter; what stays inside is nearly linear: it dies out
    clipped = log.saturated is not None and bool(np.any(log.saturated[half:]))
    nonlinear = clipped or found.levels_off or bool((x[half:] < place).any())
    decays = found.state == "decaying" or (found.state != "chatter" and last and found.growth < -SURE * found.growth_error)
    if decays and not nonlinear:
        return True, "it dies out", *swing
    if found.state == "growing" or (last and found.state == "runaway"):
        return False, "it grows", *swing
    if not last:
        return None
    seconds = f"{log.t[-1]:.3g} s"
    if found.state == "chatter":
        return False, "it lasts", *swing
    ends = f"it decays, onto a cycle perhaps; still moving after {seconds}" if decays else f"no rest and no cycle in {seconds}"
    return None, ends, *swing


def _stopped(log):
    """(stands, why) of a trial that was cut short, or None."""
    if log.fault:  # a wall too soft for its push lets the handle through its travel as a wall that throws it does
        return (None if "OVER_TRAVEL" in log.fault else False), f"the paddle stopped: {log.fault}"
    if log.tripped.any():
        return False, f"the guard cut the motor after {log.t[log.tripped.argmax()]:.3g} s"
    return None


def _counts(found):
    return "one encoder count" if found.dither else "an encoder count or two"


def period_on(paddle, K):
    """The period of handle and hand on a spring of K [s]."""
    hand = getattr(paddle, "hand", None)
    m = paddle.m if isinstance(paddle, SimulatedPaddle) else getattr(paddle.settings, "m", 0.0) or A_HANDLE
    return 2 * math.pi * math.sqrt((m + (hand.m if hand else 0.0)) / (K + (hand.k if hand else 0.0)))


def count_of(paddle):
    """One encoder count [m]; 0 where there is no encoder."""
    if isinstance(paddle, SimulatedPaddle):
        return 1 / paddle.counts_per_metre if paddle.counts_per_metre else 0.0
    return abs(paddle.settings.metres_per_count)


def run_from(paddle, scene, place, duration):
    """Run a scene from rest at a place [m]; the motor of a board leads its handle there first, softly, and is off after."""
    if isinstance(paddle, SimulatedPaddle):
        return paddle.run(scene, duration=duration, x=place, progress=False)
    lead_back(paddle, place)
    return paddle.run(scene, duration=duration, progress=False)


def lead_back(paddle, place, force_max=math.inf):
    """Lead the handle of a board to a place [m] with a soft spring of at most so much force [N]; let go of it at rest."""
    m = getattr(paddle.settings, "m", 0.0) or A_HANDLE
    damper = 2 * WELL_DAMPED * math.sqrt(LEADS_BACK * m)
    spring = wall(unilateral=None)(k=LEADS_BACK, B=damper, x_o=place)
    safe = guarded(spring, energy_max=0.1, speed_max=speed_limit(paddle, 2.0))
    log = paddle.run(safe, duration=TAKES, force_max=force_max, progress=False)
    if log.fault or log.tripped.any():
        raise PaddleError(
            f"the handle could not be led back to {1e3 * place:.3g} mm with {LEADS_BACK:g} N/m: "
            f"{(log.fault or 'it moved too fast').rstrip('.')}. Hold it there by hand, or check `hapticlab doctor`."
        )


def speed_limit(paddle, speed):
    """A speed limit [m/s] that leaves room for a jump of some encoder counts in one period."""
    return max(speed, COUNTS * count_of(paddle) / paddle.T)


def wall_of(law: LawName | Scene, parameter: str = "k") -> Scene:
    """The scene of a law by its name, or a scene of one's own that has the parameter."""
    scene = law if isinstance(law, Scene) else wall(law)
    if parameter not in scene.parameters:
        known = ", ".join(scene.parameters) or "none"
        raise PaddleError(f"{scene.name} has no parameter {parameter} to search; it has {known}. Name one: parameter=...")
    return scene
