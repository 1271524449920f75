"""The oscillation of an over-compensated paddle about its hand's spring, by describing functions of what is not linear."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from ..base.arguments import choice, number
from ..base.roots import root
from ..base.shows_itself import ShowsItself
from ..base.units import in_si
from ..device.device import known
from ..errors import AnalysisError
from ..scene.laws.compensation import SHAPES
from ..scene.laws.estimators import backward_velocity

if TYPE_CHECKING:
    from ..device.device import AnyDevice
    from ..scene.laws.estimators import VelocityEstimate

#: amplitudes of the velocity that are searched: of the width of the sign, and of the speed that the friction alone would give
SMALLEST, LARGEST, POINTS = 0.2, 1e3, 400
#: of a quarter of a cycle, for the mean of the smooth sign
SAMPLES = 1000
#: the frequency is found to this part, in at most so many rounds
CLOSE, ROUNDS = 1e-12, 200


@dataclass(frozen=True)
class LimitCycle(ShowsItself):
    """The oscillation that an over-compensated paddle tends to; ``print`` shows it in words.

    Attributes
    ----------
    amplitude : float
        Of the position [m]; 0 where the handle comes to rest from everywhere, infinite where it grows without bound.
    frequency : float
        [Hz]; 0 where the amplitude is 0 or infinite.
    threshold : float
        A handle that turns nearer than this to the target [m] comes to rest; infinite where it does so from everywhere.
    """

    amplitude: float
    frequency: float
    threshold: float

    def __str__(self) -> str:
        if not self.amplitude:
            return "limit cycle: none, the handle comes to rest"
        first = f"a swing of less than {1e3 * self.threshold:.4g} mm dies out"
        if math.isinf(self.amplitude):
            return f"limit cycle: none, {first} and a larger one grows without bound"
        return f"limit cycle: {1e3 * self.amplitude:.4g} mm at {self.frequency:.4g} Hz; {first}"


def limit_cycle(
    paddle: AnyDevice,
    *,
    viscous: float,
    dry: float,
    speed: float | str,
    sign: Literal["smooth", "dead_zone"] = "dead_zone",
    velocity: VelocityEstimate | None = None,
) -> LimitCycle:
    """Predict amplitude and frequency at which over-compensated friction keeps a held handle moving.

    Harmonic balance (Gelb and Vander Velde 1968); Putra, van de Wouw and Nijmeijer (2007, not at hand) study them. In x' = V
    cos(w t) the friction is 4 coulomb/pi in phase with the velocity, and the compensation viscous b V' + dry coulomb N V'
    acts on the estimated velocity V', later by its lag, the delay and half a period of hold; of the dead zone N V' = (4/pi)
    sqrt(1 - (speed/V')^2). Real and imaginary parts of j (M w - k/w) V + b V + 4 coulomb/pi = (what the compensation gives)
    are two equations for V and w. In addition, the spring must break the handle away at each turn: k V/w > coulomb.
    Harmonics, the encoder and a limit of the force are left out: of 100 random paddles in light hands (0.5 to 2 ms, late by
    up to 15 ms in all, half of them with counts of 12.8 um, at 1.3 to 1.8 times the onset) the amplitude was off by 0.6 %
    in the median and 5.7 % at most, the frequency by 0.1 % and 2.5 %. Nearer to the onset the handle sticks at each turn,
    and the cycle is slower and less certain.

    Parameters
    ----------
    paddle : SimulatedPaddle, Device or PaddleProfile
        With a hand of k > 0 and coulomb > 0.
    viscous, dry : float
        Parts of the paddle's b and coulomb that are compensated, >= 0.
    speed, sign, velocity
        Of :func:`~hapticlab.scene.laws.compensation.damping_compensation`; a linear estimate, the backward difference
        unless given.

    Returns
    -------
    LimitCycle

    Raises
    ------
    AnalysisError, SceneError
        No spring, no dry friction, or an estimate that is not linear.

    Examples
    --------
    >>> import hapticlab as hl
    >>> paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, coulomb=0.02, hand=hl.Hand(k=20))
    >>> print(hl.design.limit_cycle(paddle, viscous=0, dry=1.4, speed="2 mm/s"))
    limit cycle: 5.103 mm at 3.172 Hz; a swing of less than 1 mm dies out
    """
    return _Balance.of(paddle, viscous, dry, speed, sign, velocity).cycle()


@dataclass(frozen=True)
class _Balance:
    """The balance of forces of the first harmonic, in phase with the velocity and a quarter of a cycle beside it."""

    m: float
    b: float
    k: float
    friction: float
    late: float
    T: float
    viscous: float
    dry: float
    speed: float
    sign: str
    transfer: tuple[list[float], list[float]]

    @classmethod
    def of(cls, paddle, viscous, dry, speed, sign, velocity):
        names = "m", "b", "T", "delay", "sensor_delay", "coulomb", "hand"
        m, b, T, delay, sensor_delay, coulomb, hand = known(paddle, *names)
        if hand is None or not hand.k:
            raise AnalysisError("a limit cycle needs a spring to swing about; give the paddle a hand, hl.Hand(k=...)")
        coulomb = number("coulomb", coulomb, "N", above=0, why="without dry friction nothing stops the growth at a finite swing")
        viscous, dry = (number(name, part, "", "a fraction", least=0) for name, part in (("viscous", viscous), ("dry", dry)))
        width = number("speed", in_si(speed, "m/s", "speed"), "m/s", "the sign", above=0)
        choice("sign", sign, SHAPES)
        transfer = (velocity or backward_velocity()).transfer(T)
        return cls(
            m + hand.m, b + hand.b, hand.k, coulomb, delay + sensor_delay, T, viscous * b, dry * coulomb, width, sign, transfer
        )

    def cycle(self):
        """The stable swing, and the one from which it grows."""
        w = math.sqrt(self.k / self.m)
        fastest = LARGEST * max(self.dry / max(self.b, 1e-3 * self.m * w), self.speed)
        V = np.geomspace(SMALLEST * self.speed, fastest, POINTS)
        gain = self.surplus(V)
        roots = [(root(self.surplus, V[i], V[i + 1]), gain[i] < 0) for i in np.flatnonzero(np.diff(np.sign(gain)))]
        swings = [(one / float(self.frequency(one)), one, grows) for one, grows in roots]
        breaks_away = self.friction / self.k
        stable = next(((A, one) for A, one, grows in reversed(swings) if not grows), None)
        if gain[-1] > 0:
            threshold = max([breaks_away, *(A for A, _, grows in swings if grows)])
            return LimitCycle(math.inf, 0.0, threshold)
        if stable is None or stable[0] <= breaks_away:
            return LimitCycle(0.0, 0.0, math.inf)
        least = [A for A, _, grows in swings if grows and A < stable[0]]
        return LimitCycle(stable[0], stable[1] / stable[0] / (2 * math.pi), max([breaks_away, *least]))

    def surplus(self, V):
        """Force in phase with velocities of amplitudes V that remains [N]: positive where the swing grows."""
        return self.compensation(V, self.frequency(V)).real - self.b * V - 4 * self.friction / math.pi

    def frequency(self, V):
        """The frequencies [rad/s] at which the forces beside the velocity's phase balance."""
        w = np.full(np.shape(V), math.sqrt(self.k / self.m))
        for _ in range(ROUNDS):
            beside = self.compensation(V, w).imag / V  # M w - k/w
            last, w = w, (beside + np.sqrt(beside**2 + 4 * self.k * self.m)) / (2 * self.m)
            if np.all(abs(w - last) <= CLOSE * last):
                break
        return w

    def compensation(self, V, w):
        """First harmonics of the compensating force on the handle [N], complex numbers; the velocity is V."""
        over, under = (np.polyval(part[::-1], np.exp(-1j * w * self.T)) for part in self.transfer)
        seen = over / under / (1j * w) * V  # the estimate, of a position V/(j w)
        size, hold = abs(seen), 0.5 * w * self.T
        held = np.sin(hold) / hold * np.exp(-1j * (hold + w * self.late))
        return (self.viscous * size + self.dry * self.first_harmonic(size)) * seen / size * held

    def first_harmonic(self, size):
        """Of s(V' cos), whose largest value is 1."""
        if self.sign == "dead_zone":
            return 4 / math.pi * np.sqrt(np.maximum(1 - (self.speed / size) ** 2, 0.0))
        cosine = np.cos((np.arange(SAMPLES) + 0.5) * math.pi / 2 / SAMPLES)  # a quarter of a cycle
        swing = np.multiply.outer(size, cosine)
        return 2 * np.mean(swing * cosine / np.hypot(swing, self.speed), axis=-1)
