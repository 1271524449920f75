"""Values that no paddle has: one warning, with the value, its unit and what was likely meant."""

from __future__ import annotations

import sys
import warnings

from ..errors import UnusualValueWarning

#: of a scene's parameters: SI unit -> (largest usual size, what is said of more, the unit that was likely meant)
SCENE = {
    "m": (1.0, "a paddle reaches some 0.1 m", "mm"),
    "kg": (20.0, "a paddle moves some 0.1 kg", "g"),
    "s": (100.0, "a paddle is sampled every 0.001 s", "ms"),
    "N/m": (1e7, "the stiffest virtual walls have some 10000 N/m", "N/m"),
    "N*s/m": (1e5, "a paddle's own damping is some 0.1 N s/m", "N s/m"),
}
#: of a device, by the name of the number: the same three
DEVICE = {
    "m": (5.0, "a paddle's handle weighs some 0.05 kg", "g"),
    "T": (0.1, "a hand feels each sample of more than 0.1 s as a step", "ms"),
    "delay": (1.0, "a force comes some 0.001 s after its sample", "ms"),
    "b": (1e3, "a paddle's own damping is some 0.1 N s/m", "N s/m"),
    "duration": (3600.0, "a run takes some 2 s", "ms"),
}
#: of a hand, likewise
HAND = {
    "m": (10.0, "an arm on the handle weighs some 0.5 kg", "g"),
    "k": (1e5, "a firm grip has some 500 N/m", "N/m"),
}


def warn_of_unusual(name: str, value: float, unit: str, usual: tuple[float, str, str] | None) -> None:
    """Warn once, at the user's own line, where a value is larger than any paddle has.

    Examples
    --------
    >>> import warnings
    >>> with warnings.catch_warnings(record=True) as caught:
    ...     warnings.simplefilter("always")
    ...     warn_of_unusual("x_o", 10.0, "m", SCENE["m"])
    >>> print(caught[0].message)
    x_o = 10 m: a paddle reaches some 0.1 m. If you mean 10 mm, write x_o='10 mm'.
    """
    if usual is None or not abs(value) > usual[0]:
        return
    _, why, meant = usual
    cure = "" if meant in (unit, unit.replace("*", " ")) else f" If you mean {value:g} {meant}, write {name}='{value:g} {meant}'."
    warnings.warn(f"{name} = {value:g} {unit}: {why}.{cure}", UnusualValueWarning, stacklevel=outside())


def outside() -> int:
    """The stack level, for a warning of the function that asks, of the nearest caller that is not hapticlab's own."""
    level, frame = 2, sys._getframe(2)
    while frame.f_back is not None and frame.f_globals.get("__name__", "").startswith("hapticlab."):
        level, frame = level + 1, frame.f_back
    return level
