"""The signals that a live view shows: their names, units and scales, and which traces are open from the beginning."""

from sympy import Symbol, latex

from .frame import COLUMNS, columns
from .plain.plain_letters import plain
from .spans import shown_unit

#: signals that would tell the force
HIDING_FORCE = frozenset({"F", "F_applied", "E", "intent"})
LABELS = {"x": "x", "F": "F", "E": "E drawn"}
UNITS = {"x": "m", "F": "N", "E": "J"}
#: traces that are open from the beginning: more would be flat
OPEN = 3


def signals(scene, hidden=frozenset()):
    """Return the signals of a scene that may be shown: a list of {name, label, unit_shown, scale}.

    Parameters
    ----------
    scene : Scene
        What it watches is shown beside position, force and the energy drawn from the environment.
    hidden : collection of str
        Names of signals that are left out.

    Examples
    --------
    >>> import hapticlab as hl
    >>> [(one["label"], one["unit_shown"]) for one in signals(hl.library.cart_pole())]
    [('x', 'mm'), ('F', 'N'), ('E drawn', 'mJ'), ('z', 'mm'), ('θ', 'rad')]
    """
    own = [(name, UNITS[name], LABELS[name]) for name in UNITS if name not in hidden]
    watched = [name for name in scene.watch if name not in hidden]
    labels = [plain(f"${latex(Symbol(name))}$") for name in watched]
    units = [scene.watch_units[name] for name in watched]
    found = []
    for name, unit, label in (*own, *zip(columns(watched)[len(COLUMNS) :], units, labels, strict=True)):
        scale, shown = shown_unit(unit)
        found.append({"name": name, "label": label, "unit_shown": shown, "scale": scale})
    return found


def open_traces(found):
    """Return signals with ``open``: position, force, and what is watched, or the energy where nothing is."""
    first = [name for name in ("x", "F") if any(one["name"] == name for one in found)]
    others = [one["name"] for one in found if one["name"] not in UNITS] or [one["name"] for one in found if one["name"] == "E"]
    opened = [*first, *others][:OPEN]
    return [{**one, "open": one["name"] in opened} for one in found]
