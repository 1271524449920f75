"""Which pairs of bodies can meet: the broad phase of chapter section 23.5.1.1, done once, when a scene is compiled.

Every coordinate declares its range; interval arithmetic turns the ranges into a box along the axes that no point of a
body ever leaves. The boxes are swept along x (Baraff 1992; Cohen et al. 1995), and pairs whose boxes never meet are left
out, with the reason. What is left out stays out only while coordinates keep to their ranges, so ``Contacts.ranges`` says
on which ones that rests: a program must fault where one of them leaves its range.
"""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import sympy as sp

from ...base.shows_itself import ShowsItself
from ...errors import SceneError
from ...scene.contact.contact import Contact
from ...scene.notation.amount import number_of
from ...scene.notation.checks import applied
from ...scene.notation.parameters import Parameter
from ...scene.notation.symbols import t, x
from ...scene.shapes.gaps import check_placed, closest
from ...scene.shapes.gaps import corners as corners_of
from ...scene.shapes.shapes import HalfPlane
from ..algebra.first_sample import numbers
from ..algebra.ranges import Ranges

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

#: why a pair is left out whatever the ranges are
WHATEVER = ("ignored", "neither of them moves")
#: how deep [m] bodies may start in each other: a rounding of where they were put
TOUCHING = 1e-9


@dataclass(frozen=True)
class Dropped:
    """A pair that has no contact, and why."""

    first: str
    second: str
    why: str


@dataclass(frozen=True)
class Pairs:
    """The pairs of bodies that can meet, and those that cannot."""

    kept: tuple
    dropped: tuple
    ranges: dict = field(hash=False)


class Contacts(ShowsItself, tuple):
    """Contacts between bodies; a tuple, with what was left out.

    Attributes
    ----------
    dropped : tuple of Dropped
    ranges : dict coordinate, or x(t) -> (low, high)
        What the pruning rests on.
    thickness : dict name -> expression [m]
        Of a contact: both bodies' together.
    places : dict name -> Closest
        Normal, point and slip of a contact: for friction beside a law that has none, and for replacements.
    values : dict name -> number
        Of parameters, with which it was looked where the bodies start.
    """

    def __new__(cls, contacts, dropped=(), ranges=None, thickness=None, places=None, values=None):
        self = super().__new__(cls, contacts)
        self.dropped, self.ranges, self.values = tuple(dropped), dict(ranges or {}), dict(values or {})
        self.thickness, self.places = dict(thickness or {}), dict(places or {})
        return self

    def __add__(self, others):
        return Contacts((*self, *others), self.dropped, self.ranges, self.thickness, self.places, self.values)

    def check(self, values):
        """Refuse bodies that start in each other with other values of parameters than when the contacts were made."""
        bodies = [c for c in self if isinstance(c, Contact)]
        starts = [type(q).initial for c in bodies for q in applied([c.gap], "coordinate")]
        known = {p for e in (*starts, *(c.gap for c in bodies)) for p in e.atoms(Parameter)}
        if any(values.get(p.name, p.value) != self.values.get(p.name, p.value) for p in known):
            check_apart(bodies, values)

    def speeds(self, T):
        """name -> speed [m/s] past which two bodies may pass through each other between two samples T [s] apart.

        A method that locates the touch inside the step has no such limit.
        """
        return {name: number_of(d) / T for name, d in self.thickness.items()}

    _hidden = ("thickness", "places", "values")

    def __str__(self):
        lines = [f"{len(self)} contacts: {', '.join(c.name for c in self) or 'none'}"]
        lines += [f"left out {d.first} and {d.second}: {d.why}" for d in self.dropped]
        lines += [f"while {q} stays between {low:g} and {high:g}" for q, (low, high) in self.ranges.items()]
        return "\n".join(lines)


def contacts_between(
    bodies: Iterable[Any],
    *,
    contact_law: Any,
    ignore: Iterable[Any] = (),
    handle: tuple[float, float] = (-math.inf, math.inf),
    corners: bool = False,
    method: str = "sample",
    values: Mapping[str, float] | None = None,
) -> Contacts:
    """A contact for each pair of bodies that can meet.

    Parameters
    ----------
    bodies : sequence of Placed
        Each with a name of its own.
    contact_law : contact law, or callable (first, second) -> contact law
    ignore : sequence of names, or of pairs of names
        Bodies that nothing touches, and pairs that pass through each other.
    handle : (low, high) [m]
        Where x(t) can be.
    corners : bool
        Give each corner above a half-plane a contact of its own: what holds a box that lies flat, for a law without a
        place. Its stiffness then counts once a corner.
    method : {"sample", "faces", "gjk"}
        How often the closest edges and corners are looked for: see :func:`hapticlab.scene.shapes.gaps.gap`. Once a sample unless
        asked otherwise.
    values : dict name -> number, optional
        Parameters, for looking where the bodies start; their declared values unless given.

    Returns
    -------
    Contacts

    Raises
    ------
    SceneError
        Two bodies of one name, or bodies that start in each other.

    Examples
    --------
    >>> import hapticlab as hl
    >>> z = hl.coordinate("z", unit="m", initial=1)
    >>> balls = [hl.shapes.Circle(0.1).at(x=k, y=z, name=f"ball{k}") for k in range(2)]
    >>> print(hl.contact.between([hl.shapes.ground(), *balls], contact_law=hl.contact.rigid()))
    2 contacts: ground_ball0, ground_ball1
    left out ball0 and ball1: ball0 stays within -0.1 <= x <= 0.1 m, ball1 within 0.9 <= x <= 1.1 m
    """
    bodies = _checked(bodies)
    pairs = possible_pairs(bodies, ignore=ignore, handle=handle)
    made, thickness, places = [], {}, {}
    for a, b in pairs.kept:
        law_here = contact_law(a, b) if callable(contact_law) else contact_law
        a, b = (b, a) if isinstance(b.shape, HalfPlane) else (a, b)
        each = corners and isinstance(a.shape, HalfPlane)
        found = corners_of(a, b) if each else (closest(a, b, method=method),)
        for k, c in enumerate(found, 1):
            name = f"{a.name}_{b.name}" + (f"_{k}" if len(found) > 1 else "")
            slip = c.slip if getattr(law_here, "mu", 0) != 0 else sp.S.Zero
            made.append(Contact(c.gap, law_here, name=name, slip=slip))
            places[name] = c
            thickness[name] = a.shape.thickness + b.shape.thickness
            if thickness[name] == 0:
                warnings.warn(
                    f"{a.name} and {b.name} have no thickness, so they can pass through each other between two samples at "
                    "any speed. Give one of them a radius, such as hl.shapes.Capsule",
                    stacklevel=2,
                )
    check_apart(made, values or {})
    return Contacts(made, pairs.dropped, pairs.ranges, thickness, places, values)


def possible_pairs(bodies, *, ignore=(), handle=(-math.inf, math.inf)):
    """The :class:`Pairs` of bodies whose boxes can meet over the declared ranges.

    Examples
    --------
    >>> import hapticlab as hl
    >>> z = hl.coordinate("z", unit="m")
    >>> two = [hl.shapes.Box(1, 1).at(name="left"), hl.shapes.Box(1, 1).at(x=3, y=z, name="right")]
    >>> possible_pairs(two).dropped[0].why
    'left stays within -0.5 <= x <= 0.5 m, right within 2.5 <= x <= 3.5 m'
    """
    ignored = {frozenset([name] if isinstance(name, str) else name) for name in ignore}
    strangers = set().union(*ignored) - {b.name for b in bodies} if ignored else set()
    if strangers:
        raise SceneError(f"ignore: {', '.join(sorted(map(str, strangers)))}: no such body")
    ranges = _Ranges(handle)
    boxes = {b: box(b, ranges) for b in bodies}
    close, kept, dropped, resting = _sweep(boxes), [], [], []
    for k, a in enumerate(bodies):
        for b in bodies[k + 1 :]:
            why = _reason(a, b, boxes, close, ignored, ranges)
            if why:
                dropped.append(Dropped(a.name, b.name, why))
                resting += [] if why in WHATEVER else [a, b]
            else:
                kept.append((a, b))
    used = applied([pose for b in resting for pose in (b.x, b.y, b.angle)], "coordinate", "handle")
    limits = {q: ranges(q) for q in used}
    return Pairs(tuple(kept), tuple(dropped), {q: r for q, r in limits.items() if not all(map(math.isinf, r))})


def box(body, ranges):
    """((low, high) of x, (low, high) of y) [m] that hold a body wherever its coordinates are in their ranges."""
    if isinstance(body.shape, HalfPlane):
        everywhere, (_, top) = (-math.inf, math.inf), ranges(number_of(body.y))
        return (everywhere, (-math.inf, top)) if body.angle == 0 else (everywhere, everywhere)
    corners = [body.point(*p) for core in body.shape.cores for p in core]
    _, r = ranges(number_of(body.shape.radius))
    sides = []
    for k in (0, 1):
        reach = [ranges(number_of(corner[k])) for corner in corners]
        low, high = min(low for low, _ in reach) - r, max(high for _, high in reach) + r
        sides.append((math.nextafter(low, -math.inf), math.nextafter(high, math.inf)))
    return tuple(sides)


def _sweep(boxes):
    """The pairs whose boxes overlap, as a set of frozensets; sorted along x, each is compared with the open ones."""
    close, open_ = set(), []
    for body, (along, up) in sorted(boxes.items(), key=lambda item: item[1][0][0]):
        open_ = [other for other in open_ if boxes[other][0][1] >= along[0]]
        for other in open_:
            low, high = boxes[other][1]
            if low <= up[1] and up[0] <= high:
                close.add(frozenset((body, other)))
        open_.append(body)
    return close


def _reason(a, b, boxes, close, ignored, ranges):
    """Why two bodies never meet, or None."""
    if {frozenset([a.name]), frozenset([b.name]), frozenset([a.name, b.name])} & ignored:
        return WHATEVER[0]
    if not any(pose.has(t) for body in (a, b) for pose in (body.x, body.y, body.angle)):
        return WHATEVER[1]
    if frozenset((a, b)) not in close:
        axis = next(k for k in (0, 1) if _apart(boxes[a][k], boxes[b][k]))
        return f"{a.name} stays within {_shown(*boxes[a][axis], axis)}, {b.name} within {_shown(*boxes[b][axis], axis)}"
    if HalfPlane in (type(a.shape), type(b.shape)):
        low, _ = ranges(number_of(closest(a, b).gap))
        return f"their gap stays above {low:.6g} m" if low > 0 else None
    # what two bodies have in common, such as a cart both ride on, is no part of their difference
    apart, _ = ranges(number_of(sp.expand(b.x - a.x) ** 2 + sp.expand(b.y - a.y) ** 2))
    reach = _reach(a, ranges) + _reach(b, ranges)
    if math.sqrt(max(apart, 0.0)) > reach:
        return f"their origins stay at least {math.sqrt(apart):.6g} m apart, and their radii add up to {reach:.6g} m"
    return None


def _shown(low, high, axis):
    below = f" <= {high:.6g} m" if high < math.inf else " m"
    return f"{f'{low:.6g} <= ' if low > -math.inf else ''}{'xy'[axis]}{below}"


def _apart(one, other):
    return one[1] < other[0] or other[1] < one[0]


def _reach(body, ranges):
    """The distance [m] from a body's origin to its furthest point."""
    squares = [ranges(number_of(u**2 + v**2))[1] for core in body.shape.cores for u, v in core]
    return math.sqrt(max(squares)) + ranges(number_of(body.shape.radius))[1]


def _checked(bodies):
    bodies = tuple(bodies)
    for body in bodies:
        check_placed(body)
    names = [b.name for b in bodies]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice:
        raise SceneError(f"two bodies have the name {twice}; give each a name of its own, shape.at(..., name='{twice}_2')")
    return bodies


def check_apart(contacts, values):
    """Refuse contacts whose bodies start in each other; a parameter without a value leaves it open.

    Parameters
    ----------
    contacts : sequence of Contact
    values : dict name -> number
        Parameters; else their declared values.
    """
    for contact in contacts:
        depth = -(numbers([contact.gap], values) or [0.0])[0]
        if depth > TOUCHING:
            raise SceneError(
                f"{contact.name}: at the start the bodies overlap by {depth:.4g} m; start them apart (initial=), or leave "
                "out the pair: ignore=[(one, other)]"
            )


class _Ranges(Ranges):
    """Ranges where the handle has one too."""

    def __init__(self, handle):
        super().__init__()
        self.handle = handle

    def _of(self, expr):
        return self.handle if expr == x(t) else super()._of(expr)
