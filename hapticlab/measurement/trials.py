"""One wall tried on a paddle, simulated or real: what became of it, with the motor cut the moment it goes wrong."""

import math
from dataclasses import dataclass

import numpy as np

from ..analysis.chatter import chatter
from ..device.simulated import SimulatedPaddle
from ..errors import PaddleError
from ..scene.laws import wall
from ..scene.scene import Scene
from .guard import guarded

#: a spring and damper that lead a handle back, soft enough for any paddle [N/m], and how long they take [s]
LEADS_BACK, TAKES = 20.0, 0.5
#: of the natural frequency's critical damping
WELL_DAMPED = 0.7
#: standard errors by which a slow decay has to differ from none
SURE = 5.0
#: a handle that moves on by less than this part of its way, in the last quarter of a trial, rests
RESTS = 0.01
#: encoder counts in a period that a speed limit must leave room for
COUNTS = 3


@dataclass(frozen=True)
class Trial:
    """What one stiffness did.

    Attributes
    ----------
    K : float
        [N/m]
    stands : bool
        Whether the oscillation of the entry died out.
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
    """

    K: float
    stands: bool
    verdict: str
    amplitude: float
    frequency: float | None
    drawn: float
    duration: float

    def __str__(self):
        tone = "" if self.frequency is None else f" at {self.frequency:.4g} Hz"
        swing = f", {1e3 * self.amplitude:.3g} mm{tone}" if self.amplitude else ""
        return f"{self.K:10.5g} N/m  {'stands  ' if self.stands else 'chatters'}  {self.verdict}{swing}"


def try_wall(paddle, scene, *, K, place, duration, longest, buzz_max=0.05):
    """Try one stiffness, longer and longer until the record tells; a simulated handle starts at rest at ``place`` [m].

    A limit cycle and a decay too slow to see look alike. At ``longest`` [s] a decay has to be five times its own standard
    error; what then neither died out nor grew counts as chatter, so that near its limit a wall is called chattering
    sooner than sound. A handle that dithers over the edge of one encoder count stands where the force jumps by no more than
    ``buzz_max`` [N].
    """
    while True:
        log = run_from(paddle, scene, place, duration)
        trial = _judged(log, K, place, duration, buzz_max)
        if trial is not None:
            return trial
        if 2 * duration > longest * 1.001:
            return _judged(log, K, place, duration, buzz_max, last=True)
        duration *= 2


def _judged(log, K, place, duration, buzz_max, last=False):
    """Return the trial, or None where the record does not tell yet."""
    drawn = max(0.0, float(log.drawn.max(initial=0.0)))
    if log.fault:
        return Trial(K, False, f"the paddle stopped: {log.fault}", 0.0, None, drawn, duration)
    if log.tripped.any():
        at = log.t[log.tripped.argmax()]
        return Trial(K, False, f"the guard cut the motor after {at:.3g} s", 0.0, None, drawn, duration)
    found = chatter(log)
    x = log.channels.get("x_true", log.x)
    rests = found.state == "none" and found.travel < RESTS * max(abs(x - place).max(), 1e-9)
    if rests:
        return Trial(K, True, "it comes to rest", found.amplitude, found.frequency, drawn, duration)
    bounces = bool((x[len(x) // 2 :] < place).any())
    if found.dither:
        jump = float(np.ptp(log.F[len(x) // 2 :]))
        felt = "too little to feel" if jump <= buzz_max else "felt"
        verdict = f"it buzzes by one encoder count, {jump:.2g} N, {felt}"
        return Trial(K, jump <= buzz_max, verdict, found.amplitude, found.frequency, drawn, duration)
    # while it bounces, a small chatter may hide below; what stays inside is nearly linear, and dies out however slowly
    decays = found.state == "decaying" or (last and found.growth < -SURE * found.growth_error)
    if decays and not bounces:
        return Trial(K, True, "it dies out", found.amplitude, found.frequency, drawn, duration)
    if found.state in ("growing", "runaway"):
        return Trial(K, False, "it grows", found.amplitude, found.frequency, drawn, duration)
    if not last:
        return None
    verdict = "it lasts" if found.locked else f"it has not died out after {duration:g} s"
    return Trial(K, False, verdict, found.amplitude, found.frequency, drawn, duration)


def run_from(paddle, scene, place, duration):
    """Run a scene from rest at a place [m]; the motor of a board leads its handle there first, softly, and is off after."""
    if isinstance(paddle, SimulatedPaddle):
        return paddle.run(scene, duration=duration, x=place, progress=False)
    lead_back(paddle, place)
    return paddle.run(scene, duration=duration, progress=False)


def lead_back(paddle, place):
    """Lead the handle of a board to a place [m] with a soft spring, and let go of it at rest."""
    m = getattr(paddle.settings, "m", 0.0) or 0.05
    damper = 2 * WELL_DAMPED * math.sqrt(LEADS_BACK * m)
    spring = wall(unilateral=None)(k=LEADS_BACK, B=damper, x_o=place)
    log = paddle.run(
        guarded(spring, energy_max=0.1, speed_max=speed_limit(paddle, 2.0)), duration=TAKES, progress=False
    )
    if log.fault or log.tripped.any():
        raise PaddleError(
            f"the handle could not be led back to {1e3 * place:.3g} mm with {LEADS_BACK:g} N/m: "
            f"{(log.fault or 'it moved too fast').rstrip('.')}. Hold it there by hand, or check `hapticlab doctor`."
        )


def speed_limit(paddle, speed):
    """Return a speed limit [m/s] that leaves room for a jump of some encoder counts in one period."""
    if isinstance(paddle, SimulatedPaddle):
        count = 1 / paddle.counts_per_metre if paddle.counts_per_metre else 0.0
    else:
        count = abs(paddle.settings.metres_per_count)
    return max(speed, COUNTS * count / paddle.T)


def wall_of(law, parameter="k"):
    """Return the scene of a law by its name, or a scene of one's own that has the parameter."""
    scene = law if isinstance(law, Scene) else wall(law)
    if parameter not in scene.parameters:
        known = ", ".join(scene.parameters) or "none"
        raise PaddleError(
            f"{scene.name} has no parameter {parameter} to search; it has {known}. Name one: parameter=..."
        )
    return scene
