"""The walls of a scene, read off its equations: the places at which a case, a maximum or a contact begins to act."""

from dataclasses import dataclass

import sympy as sp

from ...scene.contact.contact import Contact
from .plain_formulas import HANDLE, formula, plain_symbols


@dataclass(frozen=True)
class Boundary:
    """A place at which something begins.

    Attributes
    ----------
    mover : str
        What meets it: x, or a coordinate.
    where : callable of a dict of numbers -> [float]
        Its place [m].
    names : frozenset of str
        What the place depends on.
    side : int
        +1 where it acts to the right of its place, -1 to the left.
    label : str
        Name of the parameter that says where it is, if one does.
    """

    mover: str
    where: object
    names: frozenset
    side: int
    label: str


def boundaries(scene):
    """Return the boundaries that the handle and the coordinates in metres meet.

    Examples
    --------
    >>> import hapticlab as hl
    >>> [(one.mover, one.side, one.label) for one in boundaries(hl.wall())]
    [('x', 1, 'x_o')]
    """
    lengths = [sp.Symbol(type(q).__name__, real=True) for q in scene.coordinates if type(q).unit == "m"]
    known = {type(q).__name__ for q in scene.coordinates} | set(scene.parameters) | {"t", "T"}
    found = {}
    for depth in depths(scene):
        for mover in (HANDLE, *lengths):
            place, side = _place(depth, mover, lengths)
            if side and {s.name for s in place.free_symbols} <= known:
                found[mover.name, side, place] = None
    return tuple(Boundary(mover, *formula(place), side, _label(place)) for mover, side, place in found)


def _sides(eom):
    """Return the expressions of equations of motion, those of models as they were written."""
    return [part for entry in eom for part in (entry.written if hasattr(entry, "written") else entry.args)]


def depths(scene):
    """Return expressions, in plain symbols, that are positive where a case, a maximum or a contact of a scene acts."""
    found = []
    for expr in [scene.force, *_sides(scene.eom)]:
        for cases in expr.atoms(sp.Piecewise):
            for value, condition in cases.args[:-1]:
                if value != 0:
                    found += [rel.gts - rel.lts for rel in condition.atoms(sp.Ge, sp.Gt, sp.Le, sp.Lt)]
        for most in expr.atoms(sp.Max):
            found += [part for part in most.args if part != 0] if sp.S.Zero in most.args else []
    gaps = [c.gap for entry in scene.eom for c in getattr(entry, "contacts", ()) if isinstance(c, Contact)]
    return [plain_symbols(depth) for depth in (*found, *(-gap for gap in gaps))]


def _place(depth, mover, lengths):
    """Return where a depth grows from zero with a mover, and +1 or -1 for the side; side 0 where it does not."""
    slope = depth.diff(mover) if mover in depth.free_symbols else sp.S.Zero
    if slope not in (1, -1) or depth.free_symbols & ({HANDLE, *lengths} - {mover}):
        return depth, 0
    return sp.expand(mover - depth / slope), int(slope)


def _label(place):
    return place.name if place.is_Symbol else ""
