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
    stiffness : expression or None
        Of a spring behind it, where that is what acts.
    """

    mover: str
    where: object
    names: frozenset
    side: int
    label: str
    stiffness: object = None


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
    for depth, acts in _acting(scene):
        for mover in (HANDLE, *lengths):
            place, side = _place(depth, mover, lengths)
            if side and {s.name for s in place.free_symbols} <= known:
                found.setdefault((mover.name, side, place), _stiffness(acts, mover))
    return tuple(Boundary(mover, *formula(at), side, _label(at), spring) for (mover, side, at), spring in found.items())


def _sides(eom):
    """Return the expressions of equations of motion, those of models as they were written."""
    return [part for entry in eom for part in (entry.written if hasattr(entry, "written") else entry.args)]


def depths(scene):
    """Return expressions, in plain symbols, that are positive where a case, a maximum or a contact of a scene acts."""
    return [depth for depth, _ in _acting(scene)]


def _acting(scene):
    """Return pairs of what is positive where something acts, and what acts there: 0 where that is not looked for."""
    found = []
    for expr in [scene.force, *_sides(scene.eom)]:
        for cases in expr.atoms(sp.Piecewise):
            for value, condition in cases.args[:-1]:
                if value != 0:
                    found += [(rel.gts - rel.lts, value) for rel in condition.atoms(sp.Ge, sp.Gt, sp.Le, sp.Lt)]
        for most in expr.atoms(sp.Max):
            found += [(part, sp.S.Zero) for part in most.args if part != 0] if sp.S.Zero in most.args else []
    gaps = [c.gap for entry in scene.eom for c in getattr(entry, "contacts", ()) if isinstance(c, Contact)]
    found += [(-gap, sp.S.Zero) for gap in gaps]
    return [(plain_symbols(depth), plain_symbols(sp.sympify(acts))) for depth, acts in found]


def _stiffness(acts, mover):
    """Return the slope of what acts, where that is one parameter; else None."""
    slope = sp.expand(acts.diff(mover))
    return slope if slope.is_Symbol else -slope if (-slope).is_Symbol else None


def _place(depth, mover, lengths):
    """Return where a depth grows from zero with a mover, and +1 or -1 for the side; side 0 where it does not."""
    slope = depth.diff(mover) if mover in depth.free_symbols else sp.S.Zero
    if slope not in (1, -1) or depth.free_symbols & ({HANDLE, *lengths} - {mover}):
        return depth, 0
    return sp.expand(mover - depth / slope), int(slope)


def _label(place):
    return place.name if place.is_Symbol else ""
