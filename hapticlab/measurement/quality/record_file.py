"""The quality of a paddle as a JSON file: units in names, a version, and nothing about the computer that wrote it."""

from __future__ import annotations

import json
import math
from dataclasses import fields
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...base.profile.profile_file import as_text
from ...errors import AnalysisError

if TYPE_CHECKING:
    from ...base.annotations import File
    from .record import PaddleQuality

FORMAT, VERSION, SUFFIX = "hapticlab paddle quality", 1, ".json"
#: bytes of a file, letters of a text, rows of a table, numbers of a row, and the largest of them
LARGEST, LETTERS, ROWS, LONGEST, HUGE = 300_000, 100, 12, 200, 1e12
#: borders that trials may leave undecided, null in a file
UNDECIDED = ("K [N/m]", "rest [N/m]", "quiet [N/m]")
TEXTS = ("name", "date", "on", "held")
GIVE = "Give a file that quality.save() wrote."


def write_quality(quality: PaddleQuality, path: File) -> Path:
    """Write a record to a file and return its path."""
    path = Path(path)
    path = path if path.suffix == SUFFIX else path.with_name(path.name + SUFFIX)
    held = {
        "format": FORMAT,
        "version": VERSION,
        **{name: getattr(quality, name) for name in TEXTS},
        "profile": json.loads(as_text(quality.profile)),
        "widths": [_as_dict(one) for one in quality.widths],
        "rendered": None if quality.rendered is None else _as_dict(quality.rendered),
        "velocities": [_as_dict(one) for one in quality.velocities],
    }
    path.write_text(json.dumps(held, indent=1, ensure_ascii=False, allow_nan=False) + "\n", encoding="utf-8")
    return path


def _key(f):
    unit = f.metadata.get("unit")
    return f"{f.name} [{unit}]" if unit else f.name


def _as_dict(record):
    return {_key(f): _plain(getattr(record, f.name)) for f in fields(record)}


def _plain(value):
    if isinstance(value, tuple):
        return [_plain(one) for one in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def loaded(path: File) -> dict:
    """Return what a file holds, checked up to its parts; an error names the file and not its folder."""
    named = Path(path).name
    try:
        with open(path, "rb") as file:
            data = file.read(LARGEST + 1)
    except (OSError, ValueError) as problem:
        why = getattr(problem, "strerror", None) or problem
        raise AnalysisError(f"{named}: the file cannot be read ({why}). {GIVE}") from None
    if len(data) > LARGEST:
        raise refused(named, f"it has more than {LARGEST} bytes")
    try:
        held = json.loads(data.decode("utf-8-sig"), parse_constant=_no_number)
    except (ValueError, RecursionError):
        raise refused(named, "it is damaged, or no JSON") from None
    if not isinstance(held, dict) or held.get("format") != FORMAT:
        raise refused(named, f'it does not begin with "format": "{FORMAT}"')
    if held.get("version") != VERSION or held["version"] is True:
        raise AnalysisError(f"{named}: this hapticlab reads version {VERSION} of the format. Update hapticlab, or save it again.")
    needed = {"format", "version", "profile", "widths", "rendered", "velocities", *TEXTS}
    if set(held) != needed:
        odd = sorted(set(held) ^ needed)[0]
        raise refused(named, f"{odd!r} is {'missing' if odd in needed else 'not known'}")
    return held


def _no_number(word):
    raise ValueError(word)


def rows_of(kind: type, given: object, what: str, named: str) -> tuple:
    """Return the records of a class that a list holds."""
    if not isinstance(given, list) or len(given) > ROWS:
        raise refused(named, f"{what} must be a list of at most {ROWS} parts")
    return tuple(row_of(kind, one, what, named) for one in given)


def row_of(kind: type, given: object, what: str, named: str) -> Any:
    """Return one record of a class from a dict, each part of it checked."""
    known = {_key(f): f for f in fields(kind)}
    if not isinstance(given, dict) or set(given) != set(known):
        raise refused(named, f"a part of {what} needs {', '.join(known)}")
    values = {f.name: _checked(given[key], f.type, key, named) for key, f in known.items()}
    if len({len(one) for one in values.values() if isinstance(one, tuple)}) > 1:
        raise refused(named, f"the lists of one part of {what} differ in length")
    return kind(**values)


def is_line(given: object) -> bool:
    """Whether a name, a day or a word is a text of one line that a page can show."""
    return isinstance(given, str) and bool(given.strip()) and len(given) <= LETTERS and given.isprintable()


def text_of(given: object, what: str, named: str) -> str:
    """Return a text of one line, or refuse it."""
    if not isinstance(given, str) or not is_line(given):
        raise refused(named, f"{what} must be a text of one line with 1 to {LETTERS} letters")
    return given


def _checked(given, kind, key, named):
    """A value of the kind that a record's field names."""
    if kind == "str":
        return text_of(given, key, named)
    if kind == "bool":
        if not isinstance(given, bool):
            raise refused(named, f"{key} must be true or false")
        return given
    if kind == "tuple[float, ...]":
        if not isinstance(given, list) or not 0 < len(given) <= LONGEST:
            raise refused(named, f"{key} must be a list of 1 to {LONGEST} numbers")
        numbers = tuple(math.nan if one is None and key in UNDECIDED else _number(one, key, named) for one in given)
        if key.startswith("frequency") and any(a >= b for a, b in pairwise(numbers)):
            raise refused(named, "the frequencies must rise")
        return numbers
    value = _number(given, key, named)
    return int(value) if kind == "int" else value


def _number(given, key, named):
    if isinstance(given, bool) or not isinstance(given, int | float) or abs(given) > HUGE:
        raise refused(named, f"{key} must hold numbers below {HUGE:g} in magnitude")
    if key.startswith("frequency") and given <= 0:
        raise refused(named, "a frequency must be above 0 Hz")
    return float(given)


def refused(named: str, why: str) -> AnalysisError:
    """Return the error of a file that holds no such record."""
    return AnalysisError(f"{named} is not the quality of a paddle: {why}. {GIVE}")
