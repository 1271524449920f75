"""CPU time, the best of several rounds, everything that is compared taking turns."""

import time


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


def row(what, value, unit="s", *, against=None, note=""):
    """Return one line of the table: ``value`` in seconds or bytes, shown in ``unit``, and divided by ``against``."""
    ratio = value / against if value is not None and against else None
    note = note or ("not installed" if value is None else "")
    return {"what": what, "value": value, "unit": unit, "ratio": ratio, "note": note}


def imported(make):
    """Return what ``make`` makes, or None where it needs a package that is not installed."""
    try:
        return make()
    except ImportError:
        return None
