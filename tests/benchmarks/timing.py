"""CPU time, the best of several rounds, everything that is compared taking turns."""

import time


def best_of(rounds, **calls):
    """Return the least CPU seconds of each call; a call that is None stays None."""
    best = {name: None for name in calls}
    for _ in range(rounds):
        for name, call in calls.items():
            if call is None:
                continue
            start = time.process_time()
            call()
            spent = time.process_time() - start
            best[name] = spent if best[name] is None else min(best[name], spent)
    return best


def row(name, seconds, *, against=None, target="", note=""):
    """Return one line of the table; ``against`` are the seconds the ratio is taken to."""
    ratio = seconds / against if seconds is not None and against else None
    return {"what": name, "seconds": seconds, "ratio": ratio, "target": target, "note": note}
