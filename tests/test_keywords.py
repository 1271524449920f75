"""One keyword, one quantity: the units that the docstrings of public callables give to their keywords."""

import inspect
import re
from collections import defaultdict

from hapticlab.vocabulary import public

UNIT = re.compile(r"(?<!=)\[([^\[\]\d,'\"]{1,8}(?:\^[\dn])?)\]")
#: keywords that have more than one unit, and why
EXCEPTIONS = {
    "height": "of a figure in inches, as matplotlib has it; of what is felt in metres",
    "k": "a spring's stiffness; of Hunt and Crossley's contact in N/m^n, for a gap to the power n",
    "standard": "the stimulus that is compared with: each task has its own quantity",
}


def units():
    """Keyword -> unit -> public callables whose docstring gives it; keywords that are described together are left out."""
    found = defaultdict(lambda: defaultdict(list))
    for path, value in public().items():
        doc = re.search(r"^Parameters\n-+\n(.*?)(?=^\w[^\n]*\n-{3,}|\Z)", inspect.getdoc(value) or "", re.S | re.M)
        for name, kind, words in re.findall(r"^(\w+) : (.*)\n((?:    .*\n?|\n)*)", doc[1] + "\n" if doc else "", re.M):
            given = None if kind == "Telemetry" else UNIT.search(f"{kind} {words}".split(". ")[0])
            if given:
                found[name][given[1]].append(path)
    return found


def test_a_keyword_has_one_unit():
    several = {name: dict(by) for name, by in units().items() if len(by) > 1 and name not in EXCEPTIONS}
    assert not several, f"rename one, or say in its docstring which unit it has: {several}"


def test_no_exception_is_out_of_date():
    assert {name for name, by in units().items() if len(by) > 1} == set(EXCEPTIONS)


def test_units_are_found_at_all():
    found = units()
    assert len(found) > 60 and {"T", "b", "m", "duration"} <= set(found) and len(found["T"]["s"]) > 3


def test_a_law_is_that_of_a_wall():
    """A contact has a ``contact_law``."""
    taking = [path for path, value in public().items() if callable(value) and "law" in _parameters(value)]
    assert len(taking) > 10 and not [path for path in taking if path.startswith(("hl.contact", "hl.library"))]


def _parameters(value):
    try:
        return inspect.signature(value).parameters
    except (TypeError, ValueError):
        return ()
