"""Plain values: what an answer gave, in floats, bools, texts, lists and dicts of Python itself."""

from collections.abc import Mapping

import numpy as np

from ..errors import HapticlabError

#: more numbers than any exercise asks for
MOST_NUMBERS = 1_000_000


class NotPlain(HapticlabError):
    """Why an answer is not a plain value; said to the student as it is."""


def plain(value):
    """Return a value in floats, bools, texts, lists and dicts of Python itself; a quantity of pint in SI.

    Examples
    --------
    >>> plain(np.array([1, 2])), plain({"F": np.float32(0.5)}), plain(np.True_)
    ([1.0, 2.0], {'F': 0.5}, True)
    """
    value = in_base_units(value)
    if isinstance(value, bool | np.bool_):
        return bool(value)
    if isinstance(value, str):
        return str.__str__(value)
    if isinstance(value, Mapping):
        return {str(name): plain(part) for name, part in value.items()}
    if isinstance(value, np.ndarray | list | tuple):
        return numbers(value)
    if isinstance(value, complex | np.complexfloating):
        raise NotPlain(f"{complex(value):g} is a complex number; needs a real one")
    try:
        return float.__float__(float(value))
    except (TypeError, ValueError, OverflowError):
        raise NotPlain(f"{a(value)} is not a number; needs a number, or an array of numbers{_symbols(value)}") from None


def in_base_units(value):
    """Return the number, in SI, of a quantity of pint; anything else as it is.

    Examples
    --------
    >>> import pint
    >>> in_base_units(pint.UnitRegistry().Quantity(5.0, "N/mm"))
    5000.0
    """
    if not (hasattr(type(value), "to_base_units") and hasattr(type(value), "magnitude")):
        return value
    return value.to_base_units().magnitude


def numbers(value):
    """Return an array as nested lists of floats."""
    try:
        array = value.astype(float).filled(np.nan) if isinstance(value, np.ma.MaskedArray) else np.array(value)
        if array.dtype.kind == "O":
            array = np.array([in_base_units(part) for part in array.flat], float).reshape(array.shape)
    except (TypeError, ValueError):
        raise NotPlain("its parts are not all numbers, or its rows have different lengths; needs an array of numbers") from None
    if array.dtype.kind not in "biuf":
        raise NotPlain(f"it is an array of {array.dtype.name}; needs an array of real numbers")
    if array.size > MOST_NUMBERS:
        raise NotPlain(f"it has {array.size} numbers, more than {MOST_NUMBERS}")
    return array.astype(float).tolist()


def a(value):
    """Return the name of a value's type with its article."""
    name = type(value).__name__
    return f"{'an' if name[:1] in 'aeiou' else 'a'} {name}"


def _symbols(value):
    names = sorted(map(str, getattr(value, "free_symbols", ())))
    return f"; it still contains {', '.join(names)}: substitute numbers" if names else ""
