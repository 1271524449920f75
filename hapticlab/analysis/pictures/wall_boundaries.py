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
    for depth, acts in [(depth, acts) for region, acts in _acting(scene) for depth in region]:
        for mover in (HANDLE, *lengths):
            place, side = _place(depth, mover, lengths)
            if side and {s.name for s in place.free_symbols} <= known:
                found.setdefault((mover.name, side, place), _stiffness(acts, mover))
    return tuple(Boundary(mover, *formula(at), side, _label(at), spring) for (mover, side, at), spring in found.items())


def _sides(eom):
    """Return the expressions of equations of motion, those of models as they were written."""
    return [part for entry in eom for part in (entry.written if hasattr(entry, "written") else entry.args)]


def regions(scene):
    """Return where cases, maxima and contacts of a scene act: expressions in plain symbols that are positive together there.

    Examples
    --------
    >>> import hapticlab as hl
    >>> regions(hl.wall())
    [(x - x_o,)]
    """
    return list(dict.fromkeys(region for region, _ in _acting(scene)))


def walls_in(expr):
    """Return the parts of an expression that are 0 to one side of a place, whatever they are to the other.

    Examples
    --------
    >>> x, x_o = sp.symbols("x x_o", real=True)
    >>> walls_in(sp.Piecewise(((x - x_o) ** 2, x > x_o), (0, True)) + sp.Piecewise((sp.sin(x), abs(x) < x_o), (0, True)))
    [Piecewise(((x - x_o)**2, x > x_o), (0, True))]
    """
    found = []
    for part in expr.atoms(sp.Piecewise, sp.Max, sp.Min):
        if sp.S.Zero in (part.args if not part.is_Piecewise else [value for value, _ in part.args]):
            acting = _acting_cases(part) if part.is_Piecewise else [((other,), None) for other in part.args if other != 0]
            if all(len(region) == 1 and _is_straight(plain_symbols(region[0])) for region, _ in acting):
                found.append(part)
    return found


def _is_straight(depth):
    slope = sp.expand(depth).diff(HANDLE)
    return slope != 0 and not slope.has(HANDLE)


def _acting(scene):
    """Return pairs of a region and what acts there: 0 where that is not looked for."""
    found = []
    for expr in [scene.force, *_sides(scene.eom)]:
        for cases in expr.atoms(sp.Piecewise):
            found += _acting_cases(cases)
        for kind, sign in ((sp.Max, 1), (sp.Min, -1)):
            for extreme in expr.atoms(kind):
                found += [((sign * part,), sp.S.Zero) for part in extreme.args if part != 0 and sp.S.Zero in extreme.args]
    gaps = [c.gap for entry in scene.eom for c in getattr(entry, "contacts", ()) if isinstance(c, Contact)]
    found += [((-gap,), sp.S.Zero) for gap in gaps]
    return [(tuple(map(plain_symbols, region)), plain_symbols(sp.sympify(acts))) for region, acts in found]


def _acting_cases(cases):
    """Return a pair for each region in which one of some cases acts, and not the one that leaves the handle free."""
    free = [value == 0 for value, _ in cases.args]
    if not any(free):  # a wall in a viscous fluid: outside it nothing acts at rest
        free = [plain_symbols(value) == 0 for value, _ in cases.args]
    if all(free) or not any(free):
        free = [False] * (len(free) - 1) + [True]
    found, outside = [], sp.S.true
    for (value, condition), is_free in zip(cases.args, free, strict=True):
        if is_free:
            outside = sp.And(outside, sp.Not(condition))
        else:
            found += [(region, value) for region in _alternatives(sp.And(condition, outside))]
    return found


def _alternatives(condition):
    """Return alternatives of a condition, each a tuple of what is positive together; what is no inequality is left out."""
    for part in sp.Or.make_args(sp.to_dnf(condition)):
        if region := tuple(rel.gts - rel.lts for rel in sp.And.make_args(part) if isinstance(rel, (sp.Ge, sp.Gt, sp.Le, sp.Lt))):
            yield region


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
