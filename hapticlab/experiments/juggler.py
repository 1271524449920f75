"""What a simulated juggler knows of the ball, and the strokes it plans from it."""

import math
from typing import Literal, get_args

import numpy as np

from .arm import along, quintic

Senses = Literal["vision", "touch", "both", "none"]
SENSES: tuple[Senses, ...] = get_args(Senses)
#: sights a second
FRAME_RATE = 60.0
#: a felt impulse is taken from the force over so long [s]
PULSE = 0.06
#: standard deviations of where the handle is felt to be, and of where an unseen ball is expected at impact [m]
PLACE, ANYWHERE = 0.003, 0.05
#: what the sum of sampled forces leaves out of an impulse whose first instant lies between samples, as a part of it
MODEL = 0.05
#: least standard deviation of a felt launch [m/s]
FAINT = 0.02
#: what is expected of a launch before it is seen or felt, as a part of the speed aimed at
SURPRISE = 0.1
#: a stroke is not changed in its last part [s]
BALLISTIC = 0.1
#: impacts that one juggler can feel and frames that it can see, so that noise is drawn once
MOST = 100_000


class Juggler:
    """A plan for :class:`~hapticlab.device.hand.reacting_hand.Reacting`. One juggler, one run: it remembers its stroke.

    The ball is to be struck at x = 0. In flight it is known by place and velocity at its last impact, with a covariance:
    by expectation first, then by touch, then by every sight of it, weighed by their certainties.

    Parameters
    ----------
    senses : {"vision", "touch", "both", "none"}
    height : float
        Aimed at [m].
    values : dict
        Of the scene: m, M, K, e, g, and h, from where the ball falls first.
    arm : Arm
    vision, touch : float
        Standard deviation of a sight [m], Weber fraction of a felt impulse.
    acceleration : float
        Of the plate that each stroke aims at, at impact [m/s^2].
    seed : int
    """

    def __init__(self, senses, height, values, arm, vision, touch, acceleration, seed):
        self.sees, self.feels = senses in ("vision", "both"), senses in ("touch", "both")
        self.m, self.M, self.K, self.e, self.g = (values[name] for name in ("m", "M", "K", "e", "g"))
        self.kappa = (1 + self.e) * self.M / (self.m + self.M)  # ball afterwards: (1 - kappa) ball + kappa plate
        self.arm, self.vision, self.touch, self.acceleration = arm, vision, touch, acceleration
        self.sight_noise, self.touch_noise = (np.random.default_rng([seed, sense]).standard_normal(MOST) for sense in (0, 1))
        self.speed = math.sqrt(2 * self.g * height)
        self.now = 0.0
        self._aim(0.0, values["h"], 0.0)
        self.path = quintic((0.0, 0.0, 0.0), self.goal, self.hit)
        self.begun = 0.0

    def plan(self, t, seen, intent):
        """The intent at t [m]: along the stroke towards the next impact, ahead of it by what the arm weighs."""
        flight = self._look(seen) if self.sees or self.feels else None
        if flight is not None and self._falls(*flight)[0] > self.now + BALLISTIC:
            self._aim(*flight)  # it is the flight of now, and there is time to change the stroke
            self._restroke()
        elif self.now >= self.hit:
            self._aim(self.hit, 0.0, self.speed)
            self._restroke()
        before, after = (self.arm.force(*along(self.path, at - self.begun)) for at in (self.now, t))
        intent = self.arm.intent(intent, before, after, t - self.now)
        self.now = t
        return intent

    def _restroke(self):
        """Plan from where the hand means to be now to the impact that is expected."""
        here = along(self.path, self.now - self.begun)
        self.path, self.begun = quintic(here, self.goal, max(self.hit - self.now, BALLISTIC)), self.now

    def _falls(self, t, y, v):
        """Time at which a ball that is at y with v at t comes down to x = 0, and its velocity then."""
        speed = math.sqrt(max(v * v + 2 * self.g * y, 0.0))
        return t + (v + speed) / self.g, -speed

    def _aim(self, t, y, v):
        """Expect a ball that is at y with v at t, and mean to strike it so that it rises to the height aimed at."""
        self.hit, incoming = self._falls(t, y, v)
        strike = (self.speed - (1 - self.kappa) * incoming) / self.kappa
        nominal = self.speed * (2 - self.kappa) / self.kappa
        self.goal = 0.0, min(max(strike, 0.0), 3 * nominal), self.acceleration

    def _look(self, seen):
        """Time, place and velocity of the last launch that was seen or felt, or None."""
        if len(seen) < 3:
            return None
        low = np.flatnonzero((seen.y[1:-1] < seen.y[:-2]) & (seen.y[1:-1] <= seen.y[2:])) + 1
        if not len(low):
            return None
        begun = int(low[-1])
        weight = np.diag([ANYWHERE**-2, (SURPRISE * self.speed) ** -2])
        known = weight @ [0.0, self.speed]
        for row, value, deviation in (*self._felt(seen, begun, len(low)), *self._sights(seen, begun)):
            weight = weight + np.outer(row, row) / deviation**2
            known = known + np.array(row) * value / deviation**2
        y, v = np.linalg.solve(weight, known)
        return seen.t[begun], y, v

    def _felt(self, seen, begun, impact):
        """Give place and velocity of the ball at its last impact, from the handle and the impulse that was felt there."""
        T = seen.t[1] - seen.t[0]
        last = begun + round(PULSE / T)
        if not self.feels or last >= len(seen):
            return
        before = begun - 2
        # the plate moves as the handle does, but for what its coupler gives way: F' = K (v - z') away from an impact
        wide = max(2, round(0.01 / T))
        if before < wide:
            return
        plate, after = (
            np.mean(seen.v[k - wide : k]) - (seen.F[k] - seen.F[k - wide]) / (wide * T * self.K) for k in (before, last)
        )
        half = wide // 2  # both velocities are those of the middle of their spans
        impulse = max(seen.F[before - half : last - half].sum() * T - self.M * (after - plate), 0.0)
        gain = 1 / self.m - (self.m + self.M) / ((1 + self.e) * self.m * self.M)  # impulse -> launch beyond the plate's
        slip = 1 + self.touch * self.touch_noise[impact % MOST]
        yield (1.0, 0.0), seen.x[begun], PLACE
        yield (0.0, 1.0), plate + gain * impulse * slip, max(math.hypot(self.touch, MODEL) * gain * impulse, FAINT)

    def _sights(self, seen, begun):
        """Give what each sight of the ball since its last impact says of that impact."""
        if not self.sees:
            return
        first, last = math.ceil(seen.t[begun] * FRAME_RATE), int(seen.t[-1] * FRAME_RATE)
        for frame in range(first, last + 1):
            at = min(round(frame / FRAME_RATE / (seen.t[1] - seen.t[0])), len(seen) - 1)
            since = seen.t[at] - seen.t[begun]
            sight = seen.y[at] + self.vision * self.sight_noise[frame % MOST]
            yield (1.0, since), sight + self.g * since**2 / 2, self.vision
