"""The units that a page reads: those that ``--set`` reads without pint, as numbers for a script."""

import math

from ...base.metric import PREFIXES, UNITS

_BASE = ("[length]", "[mass]", "[time]", "[current]")


def units():
    """Return {"units": name -> [power of ten, exponents of m, kg, s and A], "prefixes": prefix -> power of ten}.

    Examples
    --------
    >>> units()["units"]["N"], units()["prefixes"]["k"]
    ([0, [1, 1, -2, 0]], 3)
    """
    sizes = {name: [round(math.log10(size)), [made.get(one, 0) for one in _BASE]] for name, (size, made) in UNITS.items()}
    return {"units": sizes, "prefixes": PREFIXES}
