"""A profile as a JSON file: units in names, a version, and nothing about the computer that wrote it."""

from __future__ import annotations

import json
from difflib import get_close_matches
from pathlib import Path

from ...errors import HapticlabError, PaddleError
from .constants import CONSTANTS, unit_of
from .drive_train import from_data

FORMAT, VERSION = "hapticlab paddle profile", 1
SUFFIX = ".json"
#: bytes of a file, and letters of a text in it
LARGEST, LONGEST = 100_000, 1_000
_TEXTS = ("name", "source", "rounding", "wiring")
_KEYS = ("format", "version", "nominal", "constants", *_TEXTS)
_PARTS = ("value", "low", "high", "source")


def write_profile(profile, path):
    """Write a profile and return the path; what could not be read again is not written."""
    path = Path(path)
    path = path if path.suffix == SUFFIX else path.with_name(path.name + SUFFIX)
    text = as_text(profile)
    parsed(text, f"the profile {profile.name}")
    path.write_text(text, encoding="utf-8")
    return path


def read_profile(path):
    """Return the arguments of a PaddleProfile that a file holds; each of its ``estimates`` as the arguments of an Estimate."""
    named = Path(path).name
    try:
        with open(path, "rb") as file:
            data = file.read(LARGEST + 1)
    except FileNotFoundError:
        raise PaddleError(
            f"{named}: there is no such file. hapticlab looks in the folder of the notebook or program, unless the path names "
            "another one. Put the file there, or save a profile: profile.save() writes it, as at the end of lab 09."
        ) from None
    except (OSError, ValueError) as problem:  # the latter for a name that no file can have
        why = getattr(problem, "strerror", None) or problem
        raise PaddleError(
            f"{named}: the file cannot be read ({why}). Give the path of a file that profile.save() wrote."
        ) from None
    if len(data) > LARGEST:
        raise PaddleError(f"{named} has more than {LARGEST} bytes; a profile has fewer. Give a file that profile.save() wrote.")
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        raise PaddleError(f"{named} is not text in UTF-8. Give a file that profile.save() wrote.") from None
    return parsed(text, named)


def as_text(profile):
    """Return the text of the file that holds a profile, JSON with a unit in each name."""
    estimates = {one.name: one for one in profile.estimates}
    constants = {}
    for name in CONSTANTS:
        value = getattr(profile, name)
        if value is not None:
            one = estimates.get(name)
            told = {"low": one.low, "high": one.high, "source": one.source} if one else {}
            constants[f"{name} [{unit_of(name)}]"] = {"value": value, **told}
    about = {"format": FORMAT, "version": VERSION, "nominal": profile.nominal}
    texts = {name: getattr(profile, name) for name in _TEXTS}
    drive = {"drive": profile.drive.as_data()} if profile.drive else {}
    return json.dumps({**about, **texts, "constants": constants, **drive}, indent=1, ensure_ascii=False) + "\n"


def parsed(text, named):
    """Return the arguments of a profile in a text; ``named`` is what an error calls it."""
    held = _loaded(text, named)
    if not isinstance(held, dict) or held.get("format") != FORMAT:
        raise _refused(named, f'it does not begin with "format": "{FORMAT}"')
    if held.get("version") != VERSION or held["version"] is True:
        raise PaddleError(
            f"{named}: version {held.get('version')!r} of the format; this hapticlab reads version {VERSION}. Update hapticlab, "
            "or save the profile again."
        )
    _require_keys({key: part for key, part in held.items() if key != "drive"}, _KEYS, named, "the file")
    if not isinstance(held["nominal"], bool) or not isinstance(held["constants"], dict):
        raise _refused(named, '"nominal" must be true or false, and "constants" a list of constants by name')
    told = {name: _text(held[name], name, named) for name in _TEXTS}
    if not told["name"].strip():
        raise _refused(named, "its name is empty")
    values, estimates = {}, []
    for key, one in held["constants"].items():
        name, unit = _constant(key, named)
        part = _numbers(one, key, named)
        values[name] = part["value"]
        if "low" in part:
            source = _text(part["source"], f"source of {name}", named)
            estimates.append(
                {"name": name, "unit": unit, **{end: part[end] for end in ("value", "low", "high")}, "source": source}
            )
    if lacking := [name for name in ("m", "b", "T") if name not in values]:
        raise _refused(named, f"{lacking[0]} is missing")
    return {**told, "nominal": held["nominal"], **values, "estimates": estimates, "drive": _drive(held, named)}


def _drive(held, named):
    """The drive train of a file, None where it holds none; its source is a text as others are."""
    if "drive" not in held:
        return None
    try:
        drive = from_data(held["drive"])
    except PaddleError as problem:
        raise _refused(named, str(problem).rstrip(".")) from None
    _text(drive.source, "source of the drive", named)
    return drive


def _loaded(text, named):
    """The JSON of a text; numbers that are none, and a name that appears twice, are refused."""

    def once(pairs):
        names = [name for name, _ in pairs]
        if twice := next((name for name in names if names.count(name) > 1), None):
            raise _refused(named, f"{twice!r} appears twice")
        return dict(pairs)

    def no_number(word):
        raise _refused(named, f"{word} is not a number")

    try:
        return json.loads(text, parse_constant=no_number, object_pairs_hook=once)
    except HapticlabError:
        raise
    except (ValueError, RecursionError) as problem:
        raise _refused(named, f"it is damaged: {str(problem) or 'too deep'}") from None


def _constant(key, named):
    """The name and the unit of a constant, from a key such as "b [N s/m]"."""
    name, _, unit = key.partition(" [")
    if name not in CONSTANTS:
        near = get_close_matches(name, CONSTANTS, 1)
        meant = f"; did you mean {near[0]}?" if near else f"; the constants are {', '.join(CONSTANTS)}"
        raise PaddleError(f"{named}: {name!r} is not a constant of a paddle{meant}")
    needed = unit_of(name)
    if unit != f"{needed}]":
        raise PaddleError(f"{named}: {key!r}; the unit must be [{needed}]. Convert the value, and write {name} [{needed}].")
    return name, needed


def _numbers(one, key, named):
    """The parts of a constant: its value, or also both ends and a source."""
    if not isinstance(one, dict) or set(one) not in ({"value"}, set(_PARTS)):
        raise _refused(named, f"{key} needs a value, or all of {', '.join(_PARTS)}")
    for part in set(one) - {"source"}:
        if isinstance(one[part], bool) or not isinstance(one[part], (int, float)):
            raise _refused(named, f"{part} of {key} is not a number")
    return one


def _text(given, what, named):
    if not isinstance(given, str) or len(given) > LONGEST or not given.isprintable():
        raise _refused(named, f"the {what} must be a text of one line with at most {LONGEST} letters")
    return given


def _require_keys(held, keys, named, what):
    if unknown := sorted(set(held) - set(keys)):
        raise _refused(named, f"{unknown[0]!r} is not known in {what}")
    if lacking := [key for key in keys if key not in held]:
        raise _refused(named, f"{lacking[0]!r} is missing in {what}")


def _refused(named, why):
    return PaddleError(f"{named} is not a profile: {why}. Give a file that profile.save() wrote.")
