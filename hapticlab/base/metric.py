"""Units of everyday use in SI, read without pint: pint takes longer to read its definitions than SymPy takes to import."""

import math
import re
from collections import Counter
from fractions import Fraction
from functools import lru_cache

_LENGTH, _MASS, _TIME, _CURRENT = "[length]", "[mass]", "[time]", "[current]"
#: unit -> (size in SI units, exponents of the SI base); sizes are exact, so that kg is 1 and not a rounded 1000 * 0.001
UNITS = {
    "m": (Fraction(1), {_LENGTH: 1}),
    "g": (Fraction(1, 1000), {_MASS: 1}),
    "s": (Fraction(1), {_TIME: 1}),
    "A": (Fraction(1), {_CURRENT: 1}),
    "Hz": (Fraction(1), {_TIME: -1}),
    "N": (Fraction(1), {_MASS: 1, _LENGTH: 1, _TIME: -2}),
    "Pa": (Fraction(1), {_MASS: 1, _LENGTH: -1, _TIME: -2}),
    "J": (Fraction(1), {_MASS: 1, _LENGTH: 2, _TIME: -2}),
    "W": (Fraction(1), {_MASS: 1, _LENGTH: 2, _TIME: -3}),
    "V": (Fraction(1), {_MASS: 1, _LENGTH: 2, _TIME: -3, _CURRENT: -1}),
}
#: prefix -> power of ten; the two signs for micro are different characters that look alike
PREFIXES = {"": 0, "M": 6, "k": 3, "c": -2, "m": -3, "u": -6, "\u00b5": -6, "\u03bc": -6, "n": -9}
_SIZES: dict[str, tuple[Fraction, dict]] = {
    prefix + name: (size * Fraction(10) ** power, exponents)
    for name, (size, exponents) in UNITS.items()
    for prefix, power in PREFIXES.items()
} | {"1": (Fraction(1), {}), "rad": (Fraction(1), {}), "deg": (Fraction(math.pi / 180), {})}
#: a unit and its power, as m, m^2, s**-1 or m^1.5, and what joins two of them
_FACTOR = re.compile(r"([A-Za-z\u00b5\u03bc]+|1)(?:(?:\^|\*\*)(-?\d+(?:\.\d+)?))?")
_JOINED = re.compile(r"\s*((?<!\*)\*(?!\*)|/)\s*|\s+")


@lru_cache(maxsize=1024)
def metric(unit):
    """(Size in SI units, SI exponents) of a unit, or None for one that only pint knows.

    Parameters
    ----------
    unit : str
        Such as ``"N*s/m"``, ``"mm"`` or ``"m/s^2"``.

    Returns
    -------
    (float, tuple) or None
        The exponents as (name, Fraction), sorted by name.

    Examples
    --------
    >>> metric("N/mm")
    (1000.0, (('[mass]', Fraction(1, 1)), ('[time]', Fraction(-2, 1))))
    >>> metric("lbf") is None
    True
    """
    first, *others = _JOINED.split(unit.strip())
    size, total = Fraction(1), Counter()
    for joint, text in zip(["*", *others[::2]], [first, *others[1::2]], strict=True):
        written = _FACTOR.fullmatch(text)
        if not written or written[1] not in _SIZES:
            return None
        own, exponents = _SIZES[written[1]]
        power = Fraction(written[2] or 1) * (-1 if joint == "/" else 1)
        size *= own**power
        for name, exponent in exponents.items():
            total[name] += exponent * power
    return float(size), tuple(sorted((name, power) for name, power in total.items() if power))
