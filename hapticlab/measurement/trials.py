"""One wall tried on a paddle, simulated or real: what became of it, with the motor cut the moment it goes wrong."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from ..analysis.records.chatter import chatter
from ..base.shows_itself import ShowsItself
from ..device.simulated.simulated_paddle import SimulatedPaddle
from ..errors import PaddleError
from ..scene.laws.chapter_laws import wall
from ..scene.scene import Scene
from .buzz import ripple
from .guard import guarded

if TYPE_CHECKING:
    from ..scene.laws.taps import LawName

#: a spring and damper that lead a handle back, soft enough for any paddle [N/m], and how long they take [s]
LEADS_BACK, TAKES = 20.0, 0.5
#: of the natural frequency's critical damping
WELL_DAMPED = 0.7
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
#: a swing over so many encoder counts is the encoder's: it is no instability, and may be a buzz; fewer if it leaves the wall
COUNTS, COUNTS_OUTSIDE = 4, 2
#: encoder counts of the largest cycle that an encoder was seen to feed where a wall without one comes to rest, near its border
FED = 60
#: a wall that throws out a handle which a hand held deeper in it than this shows nothing [m]
FARTHEST = 1e-3
#: encoder counts in a period that a speed limit must leave room for
JUMP = 3


@dataclass(frozen=True)
class Trial(ShowsItself):
    """Outcome of one stiffness from one start.

    Attributes
    ----------
    K : float
        [N/m]
    rests : bool or None
        Whether the swing of the entry died out, down to the encoder's counts; None where the trial could not tell.
    quiet : bool or None
        Whether the hand feels no buzz then: false too where the swing did not die out.
    verdict : str
        Why, in words.
    buzz : float
        Amplitude of the force's ripple without the swing [N]; nan where it could not be told.
    amplitude : float
        Of what oscillated at the end [m].
    frequency : float or None
        [Hz]
    drawn : float
        The most energy the wall had given at any time, more than it took and than the guard forgot [J].
    duration : float
        Of the trial [s].
    scatter : float
        What a board's sensor scatters by at most [m], from the second differences of its samples; of a simulated one 0.
    start : str
        From which it began.
    """

    K: float
    rests: bool | None
    quiet: bool | None
    verdict: str
    buzz: float = math.nan
    amplitude: float = 0.0
    frequency: float | None = None
    drawn: float = 0.0
    duration: float = 0.0
    scatter: float = 0.0
    start: str = ""

    def __str__(self) -> str:
        tone = "" if self.frequency is None else f" at {self.frequency:.4g} Hz"
        swing = f", {1e3 * self.amplitude:.3g} mm{tone}" if self.amplitude else ""
        buzz = "" if math.isnan(self.buzz) else f", ripple {self.buzz:.2g} N"
        start = f" ({self.start})" if self.start else ""
        return f"{self.K:10.5g} N/m  {self.outcome:<9} {self.verdict}{swing}{buzz}{start}"

    @property
    def outcome(self) -> str:
        """In a word: "quiet", "buzzes", "unstable", or "undecided" where either question is open."""
        if self.rests is False:
            return "unstable"
        return "undecided" if self.rests is None or self.quiet is None else "quiet" if self.quiet else "buzzes"


def try_wall(paddle, scene, start, *, K, place, duration, longest, buzz_max=0.05, noise=0.0):
    """Try one stiffness from a ``start``, longer and longer until the record tells whether the swing dies out, and how it buzzes.

    The ripple is judged beside a swing that still lives. An oscillation over four encoder counts or fewer is the encoder's,
    or over two where it leaves the wall; the wall is quiet where the amplitude of its force is ``buzz_max`` [N] at most. A
    motion that follows a simulated hand's moving intent is no chatter; nor is what stays within six standard deviations
    ``noise`` of the sensor [m], which the loop colours.
    """
    needs = ENOUGH * period_on(paddle, K)
    if needs > longest * 1.001:
        untried = f"not tried: three oscillations take {needs:.3g} s; needs Judgement(longest={needs:.2g})"
        return Trial(K, None, None, untried, start=str(start))
    duration = max(duration, min(needs, longest))
    while True:
        log = run_from(paddle, scene, place + start.depth, duration)
        last = 2 * duration > longest * 1.001
        outcome = _judged(paddle, log, K, place, start, last, noise, buzz_max)
        if outcome is not None:
            rests, verdict, buzz, found = outcome
            quiet = buzz <= buzz_max if rests and not math.isnan(buzz) else None
            quiet = False if rests is False or buzz > buzz_max else quiet
            drawn = max(0.0, float(log.drawn.max(initial=0.0)))
            seen = (found.amplitude, found.frequency) if found else (0.0, None)
            scatter = 0.0 if isinstance(paddle, SimulatedPaddle) else float(np.std(np.diff(log.x, 2))) / math.sqrt(6)
            return Trial(K, rests, quiet, verdict, buzz, *seen, drawn, duration, scatter, str(start))
        duration *= 2


def _judged(paddle, log, K, place, start, last, noise, buzz_max):
    """(rests, verdict, ripple of the force, chatter found), or None where a longer record may tell."""
    stopped = _stopped(log, place + start.depth)
    if stopped:
        return *stopped, math.nan, None
    log = _of_the_wall(log, start.push)
    hand = getattr(paddle, "hand", None)
    driven = hand if hand is not None and hand.moves else None
    found = chatter(log, driven=driven)
    x, count = log.channels.get("x_true", log.x), count_of(paddle)
    way = float(abs(x - place).max())
    if way < MOVED and start.run_up is not None:
        return None, "the push did not move the handle, because friction holds it; push harder", math.nan, found
    felt, grows = ripple(log, driven=driven), found.state in ("growing", "runaway")
    leaves = bool(np.any(log.F[len(log.F) // 2 :] == 0))
    counted = 0 < 2 * found.amplitude <= (COUNTS_OUTSIDE if leaves else COUNTS) * count
    rests = None
    if found.scatter or (found.state == "none" and found.travel < RESTS * way):
        rests = "it comes to rest"
    elif found.state == "driven":
        rests = "it only follows the hand"
    elif 0 < found.amplitude < SCATTER * noise:
        rests = "it rests, apart from the noise of its sensor"
    elif last or not grows:
        if counted:
            rests = "it buzzes by encoder counts"
        elif count and felt <= buzz_max:
            rests = "it oscillates by less than is felt"
    if rests:
        return True, rests, felt, found
    if found.state == "growing" and (last or not count or (felt > buzz_max and not counted)):
        return False, "it grows", math.nan, found
    ripples = math.nan
    if found.state == "decaying" and not found.levels_off:
        ripples = ripple(log, (found.frequency, found.growth), driven)
        fed = K * FED * count / 2 > buzz_max  # onto a cycle of the encoder's that is felt: the decay has to be waited out
        if not math.isnan(ripples) and not fed:  # where it bounces still, an unstable wall may let it grow again once it does not
            return True, "it dies out", ripples, found
    if not last:
        return None
    seconds = f"{log.t[-1]:.3g} s"
    if found.state in ("chatter", "runaway"):
        return False, "it lasts" if found.state == "chatter" else "it runs away", math.nan, found
    ends = "it decays, perhaps to a cycle" if found.state == "decaying" else "neither rest nor a cycle is in sight"
    return None, f"{ends} after {seconds}", ripples, found


def _of_the_wall(log, push):
    """The record with the force of the wall alone, without the motor's push: it is zero where the handle is outside."""
    F = np.asarray(log.F, float)
    return replace(log, F=np.where(np.isclose(F, -push, rtol=1e-6, atol=0.0), 0.0, F + push)) if push else log


def _stopped(log, x):
    """(rests, why) of a trial that was cut short, or None."""
    if log.fault:  # a wall too soft for its push lets the handle through its travel as a wall that throws it does
        return (None if "OVER_TRAVEL" in log.fault else False), f"the paddle stopped: {log.fault}"
    if log.tripped.any() and log.x[0] - x > FARTHEST:
        deep = f"the handle started {1e3 * (log.x[0] - x):.2g} mm too deep, and the guard switched off the motor"
        return None, f"{deep}. Hold the handle loosely while the motor moves it back"
    if log.tripped.any():
        return False, f"the guard switched off the motor after {log.t[log.tripped.argmax()]:.3g} s"
    return None


def period_on(paddle, K):
    """The period of handle and hand on a spring of K [s]."""
    hand = getattr(paddle, "hand", None)
    m = mass_of(paddle)
    return 2 * math.pi * math.sqrt((m + (hand.m if hand else 0.0)) / (K + (hand.k if hand else 0.0)))


def mass_of(paddle):
    """The mass of a handle [kg], or 50 g where a board does not say it."""
    return paddle.m if isinstance(paddle, SimulatedPaddle) else getattr(paddle.settings, "m", 0.0) or A_HANDLE


def count_of(paddle):
    """One encoder count [m]; 0 where there is no encoder."""
    if isinstance(paddle, SimulatedPaddle):
        return 1 / paddle.counts_per_metre if paddle.counts_per_metre else 0.0
    return abs(paddle.settings.metres_per_count)


def run_from(paddle, scene, x, duration):
    """Run a scene from rest at x [m]; the motor of a board leads its handle there first, softly, and is off after."""
    if isinstance(paddle, SimulatedPaddle):
        return paddle.run(scene, duration=duration, x=x, progress=False)
    lead_back(paddle, x)
    return paddle.run(scene, duration=duration, progress=False)


def lead_back(paddle, place, force_max=math.inf):
    """Lead the handle of a board to a place [m] with a soft spring of at most so much force [N]; let go of it at rest."""
    damper = 2 * WELL_DAMPED * math.sqrt(LEADS_BACK * mass_of(paddle))
    spring = wall(unilateral=None)(k=LEADS_BACK, B=damper, x_o=place)
    safe = guarded(spring, energy_max=0.1, speed_max=speed_limit(paddle, 2.0))
    log = paddle.run(safe, duration=TAKES, force_max=force_max, progress=False)
    if log.fault or log.tripped.any():
        raise PaddleError(
            f"the handle could not be moved back to {1e3 * place:.3g} mm with {LEADS_BACK:g} N/m: "
            f"{(log.fault or 'it moved too fast').rstrip('.')}. Hold it there by hand, or check `hapticlab doctor`."
        )


def speed_limit(paddle, speed):
    """A speed limit [m/s] that leaves room for a jump of some encoder counts in one period."""
    return max(speed, JUMP * count_of(paddle) / paddle.T)


def wall_of(law: LawName | Scene, parameter: str = "k") -> Scene:
    """The scene of a law by its name, or a scene of one's own that has the parameter."""
    scene = law if isinstance(law, Scene) else wall(law)
    if parameter not in scene.parameters:
        known = ", ".join(scene.parameters) or "none"
        raise PaddleError(
            f"{scene.name} has no parameter {parameter} to search; it has {known}. Give one of these: parameter=..."
        )
    return scene
