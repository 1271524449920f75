"""The model that a law of Section 23.4.1 predicts with: handle, hand and wall as one switched second-order system.

    M x'' = push - b x' - k x - F        F = K p + B x' where p = x - x_o >= 0, else 0

with M, b, k of handle and hand together, and push the constant force of the hand. The laws count time in periods and
force in metres of the wall's spring: ``w = T v`` and ``f = F/K`` are lengths like p, and every coefficient is a number.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..base.arguments import number
from ..base.shows_itself import ShowsItself
from ..device.device import known
from ..device.hand.hand import Hand
from ..device.simulated.transition import transition
from ..errors import AnalysisError
from ..limits.limit import MOST_PERIODS, whole_and_fraction

if TYPE_CHECKING:
    from ..base.annotations import Array
    from ..device.device import AnyDevice


@dataclass(frozen=True, kw_only=True)
class WallModel(ShowsItself):
    """Handle, hand and target wall in numbers.

    Attributes
    ----------
    M, b, k : float
        Mass [kg], damping [N s/m] and stiffness [N/m] of handle and hand.
    push : float
        The hand's constant force at x = 0 [N], its spring's included.
    K, B : float
        The wall that is meant: stiffness [N/m] > 0 and damping [N s/m].
    T, delay : float
        Sampling period and computational delay [s].

    Examples
    --------
    >>> import hapticlab as hl
    >>> paddle = hl.SimulatedPaddle(m=0.35, b=0, T=0.01, hand=hl.Hand(m=0.006, k=500, intent=0.01))
    >>> print(WallModel.of(paddle, K=5000))
    M = 0.356 kg, b = 0 N s/m, k = 500 N/m, push = 5 N; wall K = 5000 N/m, B = 0 N s/m, T = 0.01 s, delay = 0 s
    """

    M: float
    b: float
    k: float
    push: float
    K: float
    B: float
    T: float
    delay: float

    @classmethod
    def of(cls, paddle: AnyDevice, *, K: float, B: float = 0.0, hand: Hand | None = None) -> WallModel:
        """Return the model of a paddle in a hand; without one, of the hand the paddle has."""
        m, b, T, delay, held_by = known(paddle, "m", "b", "T", "delay", "hand")
        if hand is not None and not isinstance(hand, Hand):
            raise AnalysisError(f'hand = {hand!r}; needs a Hand, such as hl.Hand("pinch") or hl.Hand(m=0.02, b=1, k=200)')
        hand = held_by if hand is None else hand
        of_hand = dict.fromkeys(("m", "b", "k", "push"), 0.0)
        if hand is not None:
            of_hand = {name: getattr(hand, name) for name in of_hand}
            if hand.moves:
                raise AnalysisError(
                    "the intent of the hand moves, but a law predicts with a hand whose target position is fixed. Give "
                    "hand=hl.Hand(..., intent=position), and bind push to its force"
                )
        intent = getattr(hand, "intent", None) or 0.0
        return cls(
            M=number("m", m + of_hand["m"], "kg", "the handle", above=0, what="a mass m"),
            b=number("b", b + of_hand["b"], "N s/m", "a handle with its hand", least=0),
            k=number("hand k", of_hand["k"], "N/m", least=0, what="k"),
            push=of_hand["push"] + of_hand["k"] * intent,
            K=number("K", K, "N/m", "a wall", above=0),
            B=number("B", B, "N s/m", "the wall that is meant", least=0),
            T=T,
            delay=delay,
        )

    @property
    def lag(self) -> tuple[int, float]:
        """Whole periods of the delay and the fraction that is left."""
        return whole_and_fraction(self.delay, self.T, most=MOST_PERIODS)

    def flow(self, periods: float, wall: bool = False) -> tuple[Array, Array]:
        """Return the exact motion over a time in periods, inside the wall or outside.

        Returns
        -------
        Phi : array, shape (2, 2)
            On (p, w), both in metres.
        gamma : array, shape (2,)
            What a constant force of one metre of the spring adds.
        """
        T, K = self.T, self.K
        phi = transition(self.M, self.b + wall * self.B, self.k + wall * K, periods * T)
        phi = {name: float(value) for name, value in phi.items()}
        Phi = np.array([[phi["xx"], phi["xv"] / T], [phi["vx"] * T, phi["vv"]]])
        return Phi, np.array([phi["xu"] * K, phi["vu"] * K * T])

    def rates(self, wall: bool) -> tuple[float, float, float]:
        """Return beta, kappa and mu of p'' = -beta p' - kappa p + mu f, time in periods."""
        T, M = self.T, self.M
        return (self.b + wall * self.B) * T / M, (self.k + wall * self.K) * T**2 / M, self.K * T**2 / M

    @property
    def rest(self) -> float:
        """What a push of one metre of the spring makes the handle rest at, inside the wall [m]."""
        return self.K / (self.K + self.k)

    def __str__(self) -> str:
        return (
            f"M = {self.M:g} kg, b = {self.b:g} N s/m, k = {self.k:g} N/m, push = {self.push:g} N; wall K = {self.K:g} N/m, "
            f"B = {self.B:g} N s/m, T = {self.T:g} s, delay = {self.delay:g} s"
        )
