"""What a recording gives, by NumPy: a second reading of the data that ``browser/page/drawing.js`` reads."""

import numpy as np


def values_of(recording, given):
    """Return the numbers of every node, and what the recording gives."""
    known = [np.array([float(given.get(name, start))]) for name, start in recording["inputs"]]
    with np.errstate(all="ignore"):
        for node in recording["nodes"]:
            known.append(np.atleast_1d(_numbers(node, known)).astype(float))
    found = recording["gives"]
    while isinstance(found, dict):
        found = found["then" if known[found["if"]][0] else "else"]
    return known, found


def value_of(recording, given):
    """Return what a recorded function gives."""
    known, found = values_of(recording, given)
    return known[found]


def items_of(recording, given):
    """Return the items of a recorded picture."""
    known, found = values_of(recording, given)
    items = []
    for kind, points, stays, moves in (recording["items"][item] for item in found):
        moving = {key: known[one[0]].tolist() if isinstance(one, list) else known[one][0] for key, one in moves.items()}
        if np.isfinite(known[points]).all():
            items.append((kind, known[points].reshape(-1, 2), {**stays, **moving}))
    return items


def _numbers(node, known):
    if not isinstance(node, list):
        return float(node)
    kind, *rest = node
    if kind == "numbers":
        return np.array(rest[0], float)
    if kind == "linspace":
        return np.linspace(float(rest[0]), float(rest[1]), rest[2])
    if kind == "join":
        return np.concatenate([known[one] for one in rest])
    if kind in ("slice", "take"):
        line = np.concatenate([known[one] for one in rest[0]])
        return line[rest[1] if kind == "take" else rest[1] + rest[2] * np.arange(rest[3])]
    if kind in ("reduce", "accumulate"):
        rows = known[rest[2]].reshape(-1, rest[1])
        return getattr(getattr(np, rest[0]), kind)(rows, axis=1).ravel()
    return getattr(np, kind)(*(known[one] for one in rest))
