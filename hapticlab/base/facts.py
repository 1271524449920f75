"""The facts of a record: each documented attribute with its value, its unit and its meaning.

A public class documents its attributes with units in brackets, for who reads its page. What a notebook shows of an object
comes from the same lines, so that no unit is written twice.
"""

from __future__ import annotations

import inspect
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import fields, is_dataclass
from functools import cache
from textwrap import shorten
from typing import Any, NamedTuple

from ..errors import HapticlabError

#: SI unit -> (below which size, factor, what is shown), the smallest first
_PREFIXED = {
    "m": ((1e-4, 1e6, "µm"), (1.0, 1e3, "mm")),
    "s": ((1e-4, 1e6, "µs"), (1.0, 1e3, "ms")),
    "J": ((1e-4, 1e6, "µJ"), (1.0, 1e3, "mJ")),
}
_UNIT = re.compile(r"\[((?:1|m|s|kg|N|J|W|Hz|rad|mm|um|ms|bytes?|bit|deg|V|A|[-^/*(). 0-9,])+)\]")
_SECTION = re.compile(r"^(?:Parameters|Attributes)\n-+\n((?:.*\n?)*?)(?=^\w[^\n]*\n-{3,}|\Z)", re.MULTILINE)
_ENTRY = re.compile(r"^(\w[\w, ]*?)( : .*)?\n((?:[ \t]+.*\n|\n)*)", re.MULTILINE)
_ABSENT = object()
_MARKUP = ((r":\w+:`~?(?:[\w.]*\.)?([^`]*)`", r"\1"), (r"`+([^`]*)`+", r"\1"), (r"\\+(.)", r"\1"))


class Fact(NamedTuple):
    """An attribute of a record: its name, its value in SI, its unit ("" without one) and what it means."""

    name: str
    value: Any
    unit: str
    meaning: str


@cache
def documented(kind: type) -> dict[str, tuple[str, str]]:
    """Attribute -> (unit, meaning), from the sections Parameters and Attributes of a class and of its bases.

    Examples
    --------
    >>> class Spring:
    ...     '''A spring.
    ...
    ...     Attributes
    ...     ----------
    ...     K, x_o : float
    ...         Stiffness [N/m] and boundary [m] of the wall.
    ...     name : str
    ...     '''
    >>> documented(Spring)
    {'K': ('N/m', 'Stiffness'), 'x_o': ('m', 'Boundary'), 'name': ('', '')}
    """
    found: dict[str, tuple[str, str]] = {}
    for base in reversed(kind.__mro__):
        text = inspect.cleandoc(base.__doc__ or "") if base.__module__ != "builtins" else ""
        for section in _SECTION.findall(text):
            for names, of_type, said in _ENTRY.findall(section + "\n"):
                found.update(_entry(names.split(", "), of_type, " ".join(said.split())))
    return found


def _entry(names, of_type, said):
    """What an entry of a docstring says of each of its names."""
    groups = _UNIT.findall(said)
    units = [unit.strip() for group in groups for unit in group.split(",")]
    meanings = _meanings(names, said)
    if len(names) == len(groups) == len(units) > 1:  # each after what it measures: Mass [kg], damping [N s/m] and stiffness [N/m]
        meanings = [_short(re.split(r"(?<!Fig)(?<!Eq)[.;:,]\s", part.strip(" ,;"))[-1]) for part in _UNIT.split(said)[0:-1:2]]
        meanings = [meaning or meanings[0] for meaning in meanings]
    elif len(units) < len(names):
        units = units[:1] * len(names) if units and ";" not in said.split("[")[0] else []
    units = units or _UNIT.findall(of_type)[:1] * len(names) or [""] * len(names)
    return {n: ("" if u == "1" else u, m) for n, u, m in zip(names, units, meanings, strict=False)}


def _meanings(names, said):
    """What each name means: what follows ``name``, or its part of "period and step", or else what is said of all."""
    if said.startswith("``"):
        own = dict(re.findall(r"(?:^|[;.] )``(\w+)`` ([^;.]+)", said))
        return [_short(own.get(name, "")) for name in names]
    parts = re.split(r",? and |, ", _short(said)) if len(names) > 2 else re.split(r",? and ", _short(said))
    return [_short(part) for part in parts] if len(parts) == len(names) else [_short(said)] * len(names)


def _short(said):
    """The first clause of a description, without markup and units."""
    for pattern, plain in _MARKUP:
        said = re.sub(pattern, plain, said)
    said = re.sub(r"^(?:[\s,;.]|[<>]=? *\d+|and\b|or\b)+", "", _UNIT.sub("", said))
    first = re.split(r"(?<!e\.g)(?<!Eq)(?<!Eqs)(?<!Fig)[.;:](?:\s|$)", said)[0]
    first = re.sub(r"\s+([,.;:])", r"\1", " ".join(first.split())).strip(" ,")
    return first[:1].upper() + first[1:] if re.match("([a-z]{3,}|as|at|is|of|up)( |$)", first) else first


def facts(record: Any) -> list[Fact]:
    """Every documented attribute of a record, or every field of a dataclass that documents none."""
    known = documented(record.__class__)
    names = [name for name in known if not name.startswith("_")]
    if is_dataclass(record):
        names += [f.name for f in fields(record) if f.name not in known and f.repr and not f.name.startswith("_")]
    held = {name: value for name in names if (value := _held(record, name)) is not _ABSENT}
    return [Fact(name, value, *known.get(name, ("", ""))) for name, value in held.items()]


def _held(record, name):
    """An attribute; one that a record does not have, or that it refuses, is no fact of it."""
    try:
        return getattr(record, name)
    except (AttributeError, HapticlabError):
        return _ABSENT


def shown_unit(values: Any, unit: str) -> tuple[float, str]:
    """The factor of SI values, and the unit in which their largest reads best.

    Examples
    --------
    >>> shown_unit([0.0, 0.002], "m")
    (1000.0, 'mm')
    """
    if hasattr(values, "ravel"):
        values = values.ravel().tolist()
    largest = max((abs(value) for value in values if math.isfinite(value)), default=0.0)
    if largest > 0:
        for below, factor, name in _PREFIXED.get(unit, ()):
            if largest < below:
                return factor, name
    return 1.0, plain_unit(unit)


def plain_unit(unit: str) -> str:
    """A unit as it is read, N s/m for N*s/m; nothing for the unit of a number without one."""
    return "" if unit == "1" else unit.replace("*", " ")


def short(number: float) -> str:
    """A number in four digits or so, without a power of ten where none is needed.

    Examples
    --------
    >>> short(799107.4), short(0.000123456), short(3.0), short(9999.6), short(-0.0)
    ('799107', '0.0001235', '3', '10000', '0')
    """
    rounded = float(f"{number:.4g}") + 0.0  # which turns -0.0 into 0.0
    return f"{number:.0f}" if 1e4 <= abs(rounded) < 1e7 else f"{rounded:.4g}"


def in_words(value: Any, unit: str = "") -> tuple[str, str]:
    """A value as a short text, and the unit that is shown with it; an empty text for what no line can say.

    Examples
    --------
    >>> in_words(0.0123, "m"), in_words(True), in_words([0.0, 0.5, 2.0], "N")
    (('12.3', 'mm'), ('yes', ''), ('0, 0.5, 2', 'N'))
    """
    if hasattr(value, "dtype"):
        if value.shape:
            return _of_array(value, unit)
        value = value.item()
    if isinstance(value, bool):
        return "yes" if value else "no", ""
    if isinstance(value, int) and not unit:
        return str(value), ""
    if isinstance(value, (int, float)):
        factor, unit = shown_unit([value], unit)
        return ("not known", "") if value != value else (short(value * factor), unit)
    if isinstance(value, str):
        return str(value), ""
    if isinstance(value, Mapping):
        parts = [f"{name}: {_joined(in_words(one))}" for name, one in value.items()]
        return ("; ".join(parts), "") if all(not part.endswith(": ") for part in parts) else ("", "")
    if isinstance(value, Sequence):
        return _of_sequence(value, unit)
    return ("", "") if value is None or callable(value) else (shorten(str(value).split("\n")[0], 120, placeholder=" ..."), "")


def _joined(words):
    return " ".join(filter(None, words))


def _of_array(array, unit):
    if not array.size:
        return "none", ""
    if array.dtype.kind not in "fiub":
        return f"{array.size} complex values" if array.dtype.kind == "c" else f"array of shape {array.shape}", unit
    if array.dtype.kind == "b":
        return f"{array.sum()} of {array.size}", ""
    known = array[abs(array) < math.inf]
    ends = (known.min().item(), known.max().item()) if len(known) else ()
    unknown = int((array != array).sum())
    return _span(" x ".join(map(str, array.shape)), ends, unknown, array.size - len(known) - unknown, unit)


def _span(shape, ends, unknown, infinite, unit):
    """Many numbers by their ends; what is not known or infinite is counted apart, so that no end stands for it."""
    counted = f"{shape} value{'s' * (shape != '1')}"
    apart = ", ".join(f"{count} {what}" for count, what in ((unknown, "not known"), (infinite, "infinite")) if count)
    if not ends:
        return f"{counted}, {apart if infinite else 'not known anywhere'}", ""
    factor, unit = shown_unit(ends, unit)
    return f"{counted}{f' ({apart})' * bool(apart)}, {short(ends[0] * factor)} to {short(ends[1] * factor)}", unit


def _of_sequence(parts, unit):
    if parts and all(isinstance(part, (int, float)) and not isinstance(part, bool) for part in parts):
        if len(parts) > 6:
            known, unknown = [part for part in parts if math.isfinite(part)], sum(part != part for part in parts)
            ends = (min(known), max(known)) if known else ()
            return _span(str(len(parts)), ends, unknown, len(parts) - len(known) - unknown, unit)
        factor, unit = shown_unit(parts, unit)
        return ", ".join("not known" if part != part else short(part * factor) for part in parts), unit
    if len(parts) > 6 or any(is_dataclass(part) for part in parts):
        return f"{len(parts)} of them", ""
    return "; ".join(filter(None, (_joined(in_words(part)) for part in parts))), ""


def are_records(given: Any) -> bool:
    """Whether these are records of one class, in a row or by name, which a table shows with a line for each."""
    parts = given.values() if isinstance(given, Mapping) else given
    if isinstance(given, str) or not isinstance(given, (Mapping, Sequence)) or not given:
        return False
    kinds = {type(one) for one in parts}
    return len(kinds) == 1 and is_dataclass(next(iter(kinds)))


def card(head: str, rows: Mapping[str, str]) -> str:
    """The text of a record; facts that are empty are left out.

    Examples
    --------
    >>> print(card("wall: a spring", {"order": "1", "cost": "", "source": "Eq. (23.1)"}))
    wall: a spring
      order   1
      source  Eq. (23.1)
    """
    told = {name: text for name, text in rows.items() if text}
    width = max(map(len, told), default=0)
    return "\n".join([head, *(f"  {name:<{width}}  {text}" for name, text in told.items())])
