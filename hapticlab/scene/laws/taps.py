"""The spring laws of the chapter as weights on past positions, one record each, for scenes and for their limits.

The force of a law is ``F[n] = K*(taps[0]*x[n] + taps[1]*x[n-1] + ... + lead*T*v[n])``, penetration counted from x_o.
Every law has the gain K at rest; all but the plain one look half a period ahead, which is what the hold loses.
"""

from dataclasses import dataclass
from typing import Literal

LawName = Literal["zoh", "half_sample", "backward_difference", "ellis"]


@dataclass(frozen=True)
class SpringLaw:
    """Weights on x[n], x[n-1], x[n-2], the law in the words of a table, and the weight on T*v[n]."""

    taps: tuple[float, ...]
    says: str
    lead: float = 0.0


SPRING_LAWS: dict[LawName, SpringLaw] = {
    "zoh": SpringLaw((1.0,), "K p(n), Eq. (23.1)"),
    "half_sample": SpringLaw((1.0,), "velocity half a sample on, Eq. (23.3)", lead=0.5),
    "backward_difference": SpringLaw((1.5, -0.5), "Eq. (23.5)"),
    "ellis": SpringLaw((2.0, -1.5, 0.5), "predictor-corrector, Eq. (23.7)"),
}
TAPS = {name: law.taps for name, law in SPRING_LAWS.items()}
LEAD = {name: law.lead for name, law in SPRING_LAWS.items()}
