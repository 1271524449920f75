"""The spring laws of the chapter as weights on past positions, one record each, for scenes and for their limits.

The force of a law is ``F[n] = K*(taps[0]*x[n] + taps[1]*x[n-1] + ... + lead*T*v[n])``, penetration counted from x_o.
Every law has the gain K at rest; all but the plain one look half a period ahead, which is what the hold loses.
"""

from __future__ import annotations

from typing import Literal

from ...base.facts import card
from ...base.shows_itself import ShowsItself


class SpringLaw(ShowsItself, str):
    """A spring law by name, for ``law=``, with its properties, which ``print`` shows.

    Attributes
    ----------
    name : str
        The text that stands for it, ``law="ellis"``.
    taps : tuple of float
        Weights on x[n], x[n-1], x[n-2].
    says : str
        The law in the words of a table, with its equation.
    lead : float
        Weight on T v[n].
    confused_with : str
        A law with which it is confused, and the difference.

    Examples
    --------
    >>> import hapticlab as hl
    >>> hl.laws.EllisSpring == "ellis", hl.wall(law=hl.laws.EllisSpring) == hl.wall(law="ellis")
    (True, True)
    >>> print(hl.laws.EllisSpring)
    ellis: predictor-corrector, Eq. (23.7)
      force                    K (2 x[n] - 1.5 x[n-1] + 0.5 x[n-2])
      order                    predicts half a period ahead
      cost                     2 past positions to remember
      source                   R. B. Gillespie, Haptic Interface to Virtual Environments, ch. 23
      not to be confused with  its closed form under a force filter: Eq. (23.8) around Eq. (23.1) is the same law
    """

    taps: tuple[float, ...]
    says: str
    confused_with: str
    lead: float

    def __new__(cls, name: str, taps: tuple[float, ...], says: str, confused_with: str, lead: float = 0.0) -> SpringLaw:
        self = super().__new__(cls, name)
        self.taps, self.says, self.confused_with, self.lead = taps, says, confused_with, lead
        self.__doc__ = f"The spring law {name!r}: {says}."  # what help and hl.find read
        return self

    def __reduce__(self) -> tuple[object, ...]:
        return law_named, (str.__str__(self),)

    def __format__(self, form: str) -> str:
        return format(str.__str__(self), form)

    def __str__(self) -> str:
        past = len(self.taps) - 1
        facts = {
            "force": f"K ({self._sum()})",
            "order": "predicts half a period ahead" if past or self.lead else "uses the sample alone",
            "cost": f"{past} past position{'s' * (past > 1)} to remember" if past else "nothing to remember",
            "source": "R. B. Gillespie, Haptic Interface to Virtual Environments, ch. 23",
        }
        return card(f"{self:s}: {self.says}", {**facts, "not to be confused with": self.confused_with})

    def _sum(self):
        terms = [(tap, f"x[n-{lag}]" if lag else "x[n]") for lag, tap in enumerate(self.taps)]
        terms += [(self.lead, "T v[n]")] * bool(self.lead)
        parts = [f"{'-' if tap < 0 else '+'} {'' if abs(tap) == 1 else f'{abs(tap):g} '}{what}" for tap, what in terms]
        return " ".join(parts).removeprefix("+ ")


LawName = Literal["zoh", "half_sample", "backward_difference", "ellis"] | SpringLaw

SPRING_LAWS: dict[str, SpringLaw] = {
    f"{law:s}": law
    for law in (
        SpringLaw("zoh", (1.0,), "K p(n), Eq. (23.1)", "hold='zoh', how equations of motion see the handle between samples"),
        SpringLaw(
            "half_sample", (1.0,), "velocity half a sample later, Eq. (23.3)",
            "backward_difference, which it is where the velocity is the backward difference of the position", lead=0.5,
        ),
        SpringLaw(
            "backward_difference", (1.5, -0.5), "Eq. (23.5)",
            "velocity='backward_difference', where v(n) comes from; a backward (implicit) Euler step",
        ),
        SpringLaw(
            "ellis", (2.0, -1.5, 0.5), "predictor-corrector, Eq. (23.7)",
            "its closed form under a force filter: Eq. (23.8) around Eq. (23.1) is the same law",
        ),
    )
}  # fmt: skip
TAPS = {name: law.taps for name, law in SPRING_LAWS.items()}
LEAD = {name: law.lead for name, law in SPRING_LAWS.items()}


def law_named(name: str) -> SpringLaw:
    """The spring law of this name."""
    return SPRING_LAWS[name]
