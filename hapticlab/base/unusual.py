"""Values that no paddle has: one warning, with the value, its unit and what was likely meant."""

from __future__ import annotations

import warnings
from pathlib import Path

from ..errors import UnusualValueWarning
from ..slips.own_line import of_call

#: of a scene's parameters: SI unit -> (largest usual size, what is said of more, the unit that was likely meant)
SCENE = {
    "m": (1.0, "a paddle reaches about 0.1 m", "mm"),
    "kg": (20.0, "a paddle moves about 0.1 kg", "g"),
    "s": (100.0, "a paddle is sampled about every 0.001 s", "ms"),
    "N/m": (1e7, "the stiffest virtual walls have about 10000 N/m", "N/m"),
    "N*s/m": (1e5, "a paddle's own damping is about 0.1 N s/m", "N s/m"),
    "rad": (7.0, "a full turn has 6.28 rad", "deg"),
}
#: of a device, by the name of the number: the same three
DEVICE = {
    "m": (5.0, "the handle of a paddle has a mass of about 0.05 kg", "g"),
    "T": (0.1, "a hand feels each sample of more than 0.1 s as a step", "ms"),
    "delay": (1.0, "a force comes about 0.001 s after its sample", "ms"),
    "sensor_delay": (1.0, "a sensor lags by less than 0.002 s", "ms"),
    "b": (1e3, "a paddle's own damping is about 0.1 N s/m", "N s/m"),
    "duration": (3600.0, "a run takes about 2 s", "ms"),
}
#: of a hand, likewise
HAND = {
    "m": (10.0, "an arm on the handle has a mass of about 0.5 kg", "g"),
    "k": (1e5, "a firm grip has about 500 N/m", "N/m"),
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
    x_o = 10 m: a paddle reaches about 0.1 m. If you mean 10 mm, write x_o='10 mm'.
    """
    if usual is None or not abs(value) > usual[0]:
        return
    _, why, meant = usual
    cure = "" if meant in (unit, unit.replace("*", " ")) else f" If you mean {value:g} {meant}, write {name}='{value:g} {meant}'."
    warn_at_own_line(f"{name} = {value:g} {unit}: {why}.{cure}")


def warn_at_own_line(words: str, category: type[Warning] = UnusualValueWarning) -> None:
    """Warn with the place in the user's own code, which a notebook names by its cell."""
    own = of_call()
    if own is None:
        warnings.warn(words, category, stacklevel=2)
    else:
        heard = own.frame.f_globals.setdefault("__warningregistry__", {})
        file = own.place if own.place != Path(own.file).name else own.file
        warnings.warn_explicit(words, category, file, own.line, registry=heard)
