"""What an argument must be: a number in a range, a whole number, one of several names, of one class.

Each function takes the argument's name and what was given, and returns it as it is used from there on. A refusal says
what was given, who needs what, and why: ``b = -1 N s/m; a device needs b >= 0: its damping pays for the hold``.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Iterable
from dataclasses import fields
from types import UnionType
from typing import Any

from ..errors import AnalysisError, HapticlabError, UnitsError
from .units import in_si


def what_is(given: Any) -> str:
    """What was given, by its class with an article.

    Examples
    --------
    >>> what_is(3), what_is([])
    ('an int', 'a list')
    """
    kind = type(given).__name__
    return f"a{'n' * (kind[0] in 'aeioAEIO')} {kind}"


def number(
    name: str,
    given: Any,
    unit: str = "",
    owner: str = "",
    *,
    least: float | None = None,
    above: float | None = None,
    most: float | None = None,
    below: float | None = None,
    what: str | None = None,
    why: str = "",
    error: type[HapticlabError] = AnalysisError,
) -> float:
    """The finite number given, as a float in SI: ``least`` or more, ``above`` a limit, ``most`` or less, ``below`` a limit.

    A quantity with a unit may be a text, such as "1 ms".

    ``what`` is what an error calls the number besides its name, and ``why`` gives the reason for its limits.

    Examples
    --------
    >>> from hapticlab.base.arguments import number
    >>> number("b", 1, "N s/m", "a device", least=0)
    1.0
    >>> number("b", -1, "N s/m", "a device", least=0, why="its damping pays for the hold")
    Traceback (most recent call last):
    hapticlab.errors.AnalysisError: b = -1 N s/m; a device needs b >= 0: its damping pays for the hold
    >>> number("T", "1 ms", "s")
    0.001
    """
    has_unit = unit not in ("", "1")
    if isinstance(given, str) and has_unit:
        given = _quantity(name, given, unit, error)
    try:
        value = None if isinstance(given, bool | str) else float(given)
    except (TypeError, ValueError, OverflowError):
        value = None
    finite = value is None or math.isfinite(value)
    if value is not None and finite and _within(value, least, above, most, below):
        return value
    need = _needs(owner, _range(what or name, least, above, most, below, finite))
    if value is None:
        reason = f": {why}" if why and not why.endswith(".") else ""
        form = f"a number in {unit}, or a text with its unit, such as '2 {unit}'" if has_unit else "a number"
        raise error(f"{name} = {given!r}; {need}{reason}. Give {form}")
    why = why if finite else ""
    reason = why and (f". {why}" if why[0].isupper() else f": {why}")
    raise error(f"{name} = {value:.12g}{f' {unit}' if has_unit else ''}; {need}{reason}")


def numbers(record: Any, owner: str, *, error: type[HapticlabError] = AnalysisError, **rules: Any) -> None:
    """Make fields of a frozen record floats in SI, each by the rules of :func:`number`; where None is the default, it may stay.

    Examples
    --------
    >>> from dataclasses import dataclass
    >>> from hapticlab.base.arguments import numbers
    >>> @dataclass(frozen=True)
    ... class Rest:
    ...     settle: float
    ...     def __post_init__(self):
    ...         numbers(self, "a rest", settle={"unit": "s", "least": 0})
    >>> Rest("20 ms")
    Rest(settle=0.02)
    """
    for field in fields(record):
        given = getattr(record, field.name)
        if field.name in rules and not (given is None and field.default is None):
            object.__setattr__(record, field.name, number(field.name, given, owner=owner, error=error, **rules[field.name]))


def _quantity(name, text, unit, error):
    """The number in SI of a text such as "10 mm"; a text without any digit stays what it is, and is refused as no number."""
    if not any(letter.isdigit() for letter in text):
        return text
    try:
        return in_si(text, unit, name)
    except UnitsError as refusal:
        raise error(str(refusal)) from None


def _within(value: float, least: float | None, above: float | None, most: float | None, below: float | None) -> bool:
    is_low = (least is not None and value < least) or (above is not None and value <= above)
    return not (is_low or (most is not None and value > most) or (below is not None and value >= below))


def period(T: Any, error: type[HapticlabError] = AnalysisError) -> float:
    """A sampling period [s] as a float."""
    return number("T", T, "s", "a sampling period", above=0, error=error)


def count(
    name: str,
    given: Any,
    owner: str = "",
    *,
    least: int = 1,
    most: int | None = None,
    of: str = "",
    error: type[HapticlabError] = AnalysisError,
) -> int:
    """The whole number given, of any library, as an int.

    Examples
    --------
    >>> from hapticlab.base.arguments import count
    >>> count("periods", 2.5, "a pulse", most=9, of="periods")
    Traceback (most recent call last):
    hapticlab.errors.AnalysisError: periods = 2.5; a pulse needs a whole number of periods, 1 to 9
    """
    try:
        value = None if isinstance(given, bool) else operator.index(given)
    except TypeError:
        value = None
    if value is not None and least <= value and (most is None or value <= most):
        return value
    span = f" >= {least}" if most is None else f", {least} to {most}"
    raise error(f"{name} = {given!r}; {_needs(owner, 'a whole number')}{of and f' of {of}'}{span}")


def choice(
    name: str, given: Any, known: Iterable, *, need: str | None = None, error: type[HapticlabError] = AnalysisError
) -> Any:
    """The name given, one of those known; ``need`` tells them apart where names alone do not."""
    if isinstance(given, str | None) and given in known:
        return given
    need = need or f"one of {', '.join(known)}"
    raise error(f"{name} = {given!r}; needs {need}")


def instance(
    name: str, given: Any, kind: type | tuple[type, ...] | UnionType, need: str, *, error: type[HapticlabError] = AnalysisError
) -> Any:
    """The object given, of a class or of one of several; ``need`` says how to make one."""
    if isinstance(given, kind):
        return given
    raise error(f"{name} = {given!r}; needs {need}")


def having(given: Any, need: str, *names: str, error: type[HapticlabError] = AnalysisError) -> Any:
    """The object given, which has these attributes; none of them may be None, which says that a number is not known."""
    lacking = [name for name in names if not hasattr(given, name)]
    if lacking:
        raise error(f"{what_is(given)} has no {lacking[0]}; needs {need}")
    unknown = [name for name in names if getattr(given, name) is None]
    if unknown:
        raise error(f"the device has no {unknown[0]}; needs hl.Device({unknown[0]}=..., ...)")
    return given


def _needs(owner, what):
    return f"{owner} needs {what}" if owner else f"needs {what}"


def _range(name, least, above, most, below, finite):
    given = {">=": least, ">": above, "<=": most, "<": below}
    limits = [f"{sign} {limit:g}" for sign, limit in given.items() if limit is not None]
    return f"{name} {' and '.join(limits + ['finite'] * (not finite))}" if limits else f"a finite {name}"
