"""What comes back from a student's process is looked at before anything is done with it: plain values, bounded texts."""

import math
import re
from itertools import islice

from ...course.outcome import Outcome

#: characters kept of a student's own words in a report, and of why there is no value
TEXT, PROBLEM = 20_000, 400
#: what a value may have of lists and dicts, and of names in one dict, which cost the grader more than their bytes
LISTS, NAMES = 200_000, 1000
#: numbers of a whole reply
MOST_NUMBERS = 1_000_000
#: numbers kept of a list in a report, entries of a dict, and how deep both may nest
NUMBERS, ENTRIES, DEPTH = 2000, 50, 32
#: what moves a terminal's cursor, turns the reading direction, or cannot be written as UTF-8
UNPRINTABLE = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u200e\u200f\u2028-\u202e\u2066-\u2069\ufeff\ud800-\udfff]")


class Garbage(ValueError):
    """A reply is none: a student's code wrote it, or the session lost its mind."""


def outcomes_of(reply, count, printed):
    """Return the outcomes in a reply.

    Parameters
    ----------
    reply : dict
        ``{"outcomes": [{"value": ..., "problem": ..., "printed": ...}, ...]}``, of whatever wrote it.
    count : int
        How many cases were asked for.
    printed : int
        Characters kept of what was printed for each.

    Returns
    -------
    list of Outcome

    Raises
    ------
    Garbage

    Examples
    --------
    >>> outcomes_of({"outcomes": [{"value": [1, 2.5], "problem": "", "printed": ""}]}, 1, 100)
    [Outcome(value=[1.0, 2.5], problem='', printed='')]
    >>> outcomes_of({"outcomes": [{"right": True}]}, 1, 100)
    Traceback (most recent call last):
        ...
    hapticlab.grading.handed_in.replies.Garbage: ...
    """
    several = reply.get("outcomes")
    if not isinstance(several, list) or len(several) != count:
        raise Garbage("the number of outcomes differs from the number of cases")
    left = [0, MOST_NUMBERS]
    return [_outcome(one, printed, left) for one in several]


def _outcome(one, printed, left):
    if not isinstance(one, dict) or set(one) != {"value", "problem", "printed"}:
        raise Garbage("no outcome")
    left[0] = LISTS
    return Outcome(_value(one["value"], left), line_of(one["problem"], PROBLEM), text_of(one["printed"], printed))


def text_of(text, most=TEXT):
    """Return a text without characters that do more than be seen, cut where it is long.

    Examples
    --------
    >>> text_of("red \\x1b[31m, a tab", 12)
    'red [31m, a ...'
    """
    if not isinstance(text, str):
        raise Garbage("no text")
    kept = UNPRINTABLE.sub("", text[: 2 * most])
    return kept if len(kept) <= most and len(text) <= 2 * most else f"{kept[: most - 1]} ..."


def line_of(text, most=PROBLEM):
    """Return a text in one line, as :func:`text_of` does."""
    return " ".join(text_of(text, most).split())


def _value(value, left, depth=DEPTH):
    """Return a plain value anew: None, bools, floats, texts, lists of numbers, dicts by text.

    ``left`` are the lists and dicts that it may still have, and the numbers in lists that the whole reply may.
    """
    if value is None or isinstance(value, bool):
        return value
    if isinstance(value, str):
        return text_of(value)
    if isinstance(value, dict) and depth and len(value) <= NAMES:
        _count(left, 0)
        return {line_of(name): _value(part, left, depth - 1) for name, part in value.items()}
    return _numbers(value, left, depth)


def _numbers(value, left, depth):
    if isinstance(value, list) and depth:
        _count(left, len(value))
        return [_numbers(part, left, depth - 1) for part in value]
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise Garbage("not a plain value")
    try:
        return float(value)
    except OverflowError:
        raise Garbage("not a number that a float can represent") from None


def _count(left, numbers):
    left[0] -= 1
    left[1] -= numbers
    if min(left) < 0:
        raise Garbage("more lists or numbers than any answer has")


def rounded(value, most=NUMBERS):
    """Return a plain value as a report holds it: 12 digits, long lists and texts cut, NaN and infinity as texts.

    Examples
    --------
    >>> rounded({"F": [0.1 + 0.2, float("nan")], "far": float("-inf")})
    {'F': [0.3, 'nan'], 'far': '-inf'}
    """
    if isinstance(value, dict):
        return {line_of(str(name), 60): rounded(part, most) for name, part in islice(value.items(), ENTRIES)}
    if isinstance(value, list | tuple):
        within = max(1, most // max(1, len(value))) if any(isinstance(part, list | tuple) for part in value) else most
        return [rounded(part, within) for part in value[:most]]
    if isinstance(value, str):
        return text_of(value, NUMBERS)
    if value is None or isinstance(value, bool):
        return value
    number = float(f"{float(value):.12g}")
    return number if math.isfinite(number) else str(number)
