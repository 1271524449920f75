"""CPU time, the best of several rounds, everything that is compared taking turns; and the lines of the table."""

import operator
import time

#: what a second or a byte is in the units of the table
SCALE = {"s": 1, "ms": 1e3, "ns": 1e9, "MB": 1e-6, "B": 1}
COMPARE = {"<": operator.lt, "<=": operator.le, ">=": operator.ge}


def best_of(rounds, **calls):
    """Return the least CPU seconds of each call; a call that is None stays None."""
    best = dict.fromkeys(calls)
    for _ in range(rounds):
        for name, call in calls.items():
            if call is None:
                continue
            start = time.process_time()
            call()
            spent = time.process_time() - start
            best[name] = spent if best[name] is None else min(best[name], spent)
    return best


def row(what, value, unit="s", *, against=None, note="", target=()):
    """Return one line of the table: ``value`` in seconds or bytes, shown in ``unit``, and divided by ``against``.

    A target bounds the value, "< 60 ms", or the ratio, "<= 1.3 x"; ``met`` says for each whether it is met.
    """
    ratio = value / against if value is not None and against else None
    note = note or ("not installed" if value is None else "")
    met = [_met(bound, value, ratio) for bound in target]
    return {"what": what, "value": value, "unit": unit, "ratio": ratio, "target": [*target], "met": met, "note": note}


def _met(target, value, ratio):
    """Return whether the target is met, or None where there is nothing to judge."""
    sign, bound, unit = target.split()
    measured = ratio if unit == "x" else value and value * SCALE[unit]
    return None if measured is None else COMPARE[sign](measured, float(bound))


def imported(make):
    """Return what ``make`` makes, or None where it needs a package that is not installed."""
    try:
        return make()
    except ImportError:
        return None
