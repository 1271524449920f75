"""The constants of a paddle: the SI unit of each, and its range."""

from __future__ import annotations

from typing import Any

from ...errors import PaddleError
from ..arguments import number

#: part of full duty that a dead band may take
MOST_DEAD = 0.5
_SOME, _NO_LESS, _DUTY = {"above": 0.0}, {"least": 0.0}, {"above": 0.0, "most": 1.0}
#: constant -> its unit, "1" without one, and the range of its values
CONSTANTS: dict[str, tuple[str, dict[str, Any]]] = {
    "m": ("kg", _SOME),
    "b": ("N s/m", _NO_LESS),
    "coulomb": ("N", _NO_LESS),
    "delay": ("s", _NO_LESS),
    "T": ("s", _SOME),
    "counts_per_metre": ("1/m", _SOME),
    "sensor_delay": ("s", _NO_LESS),
    "sensor_noise": ("m", _NO_LESS),
    "sensor_flight": ("s", _NO_LESS),
    "force_max": ("N", _SOME),
    "force_full": ("N", _SOME),
    "duty_dead": ("1", {"least": 0.0, "most": MOST_DEAD}),
    "duty_25": ("1", _DUTY),
    "duty_50": ("1", _DUTY),
    "duty_75": ("1", _DUTY),
    "carrier": ("Hz", _SOME),
}
#: ways to turn a position into a count
ROUNDINGS = ("floor", "nearest")


def unit_of(name: str) -> str:
    """Return the SI unit of a constant, "1" where it has none.

    Examples
    --------
    >>> unit_of("b"), unit_of("duty_dead")
    ('N s/m', '1')
    """
    return CONSTANTS[name][0]


def in_range(name: str, given: Any, owner: str) -> float:
    """Return a constant as a number in SI, or refuse it in words; a text may carry its unit.

    Examples
    --------
    >>> in_range("m", "30 g", "a paddle")
    0.03
    """
    unit, limits = CONSTANTS[name]
    return number(name, given, unit, owner, error=PaddleError, **limits)


def check_duties(kind, error):
    """Refuse a dead band and a curve that no motor has; ``error`` is the class of the refusal."""
    dead, curve = kind.duty_dead, (kind.duty_25, kind.duty_50, kind.duty_75)
    if not 0 <= dead <= MOST_DEAD:
        raise error(f"duty_dead = {dead!r}; needs a part of full duty from 0 to {MOST_DEAD:g}.")
    given = [duty for duty in curve if duty is not None]
    rising = (dead, *given, 1.0)
    if len(given) not in (0, 3) or not all(low < high for low, high in zip(rising, rising[1:], strict=False)):
        raise error(
            f"duty_dead, duty_25, duty_50, duty_75 = {dead:g}, {', '.join(map(str, curve))}; needs three duties that rise "
            "from the dead band to 1, or none of the three."
        )
