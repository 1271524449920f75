"""Signed distance of two convex polygons, exact and without iterations: the face that separates them most decides.

Take the edge, of either polygon, whose outward normal sees the other polygon furthest away (in overlap: least deep).
In the plane this edge, or one of its ends, holds the closest point: at a corner whose two edges have the normals n1 and
n2, the direction to the other body lies between n1 and n2, so one of the two sees it further than any other edge does.
The same edge gives the depth in overlap: the Minkowski difference of convex polygons has no normals but theirs
(separating axes). What is left is the corner of the other polygon that this edge sees first, and, where two edges are
parallel to rounding, that corner's neighbour.

The arithmetic is plain: floats, arrays of placements and traced values. Features are chosen by comparisons among
constants of each body; coordinates enter only where the distance of the chosen two is taken. So its derivative is
normal . d(witness)/dq, with the place of the witness on each body held (the envelope theorem), at the cost of one point.
"""

from dataclasses import dataclass

from ...scene.shapes.plane import dot, less, minus
from ..ir.trace import clip, maximum, select, sqrt

#: square of the distance [m^2] below which two corners are one, and have no direction from each other
SAME_POINT = 1e-30


@dataclass(frozen=True)
class Core:
    """A convex polygon in its place.

    Attributes
    ----------
    corners : list of (u, v) [m]
        Counter-clockwise in the body's own frame; edge k runs from corner k to corner k + 1.
    normals, lengths : list of (u, v), list [m]
        Of the edges, outward; none for a single point.
    seen : list of (u, v)
        What stands for the corners when the nearest one is looked for. A segment has two corners at each end, with
        the two ends as edges of no length; a rectangle in its place tells them apart.
    x, y, c, s : float, array or Value
        Origin [m], and cosine and sine of the angle.
    """

    corners: list
    normals: list
    lengths: list
    seen: list
    x: object
    y: object
    c: object
    s: object


def core(corners, x, y, c, s):
    """Return the :class:`Core` of one, two or more corners, counter-clockwise."""
    if len(corners) == 1:
        return Core(corners, [], [], corners, x, y, c, s)
    if len(corners) == 2:
        p, q = corners
        (n,), (l,) = _edges([p, q], 1)
        t = (-n[1], n[0])
        seen = [(e[0] + side * l * n[0], e[1] + side * l * n[1]) for e, side in ((p, 1), (q, 1), (q, -1), (p, -1))]
        return Core([p, q, q, p], [n, t, minus(n), minus(t)], [l, 0.0, l, 0.0], seen, x, y, c, s)
    normals, lengths = _edges(corners, len(corners))
    return Core(corners, normals, lengths, corners, x, y, c, s)


def _edges(corners, count):
    normals, lengths = [], []
    for (u, v), (p, q) in zip(corners[:count], (corners[1:] + corners[:1])[:count], strict=True):
        l = sqrt((p - u) * (p - u) + (q - v) * (q - v))
        normals.append(((q - v) / l, (u - p) / l))
        lengths.append(l)
    return normals, lengths


def closest(A, B, chosen=None, radius=None):
    """The signed distance of two cores, which must not both be points, with its normal and closest point.

    Parameters
    ----------
    A, B : Core
    chosen : (Core, Core), optional
        The same two where their closest features are chosen, such as at the sample before; here and now unless given.
    radius : Value or float [m], optional
        With ``chosen``: how far apart the cores are when the bodies touch; none unless given.

    Returns
    -------
    distance [m]
        Negative where they overlap: the way to push them apart.
    normal : (x, y)
        Unit vector from A to B, along the axes of the plane.
    point : (x, y) [m]
        Of B, where it is closest to A.
    """
    A0, B0 = chosen or (A, B)
    one = _features(A0, B0) if A.normals else None
    two = _features(B0, A0) if B.normals else None
    held = None if chosen is None else (radius,)
    if two is None:
        return _measured(A, B, one, held)
    gap, (n_x, n_y), (p_x, p_y) = _measured(B, A, two, held)
    # seen from the other side
    other = gap, (-n_x, -n_y), (p_x - gap * n_x, p_y - gap * n_y)
    return pick(one.separation >= two.separation, _measured(A, B, one, held), other) if one else other


@dataclass(frozen=True)
class _Features:
    """An edge of A and a corner of B, in the frame of each: what is closest, and which of them says how far."""

    separation: object
    edge: tuple  # start, normal, length
    corner: tuple
    on_face: object  # the corner faces the edge
    end: tuple  # of A's edge, nearest to the corner
    beside: tuple  # normal, and direction away from the corner, of B's edge on the side of that end; or None
    on_other: object  # the end faces that edge
    along: object  # how far from the corner [m], when it does not
    apart: tuple  # from there to the end, in B's frame


def _features(A, B):
    """Choose the features as the most separating edge of A has them."""
    pose, back = relative(A, B), relative(B, A)
    separation, a, n, l = _most_separating(A, [moved(pose, p) for p in distinct(B)])
    v, *around = _first_seen([dot(n, moved(pose, p)) for p in B.seen], _around(B))
    t = (-n[1], n[0])
    along = dot(t, less(moved(pose, v), a))
    # in overlap the corner is inside, wherever it lies along the edge
    on_face = ((0.0 <= along) & (along <= l)) | (separation <= 0.0)
    beyond = along > 0.5 * l
    end = pick(beyond, (a[0] + l * t[0], a[1] + l * t[1]), a)
    apart = less(moved(back, end), v)
    if not around:
        return _Features(separation, (a, n), v, on_face, end, None, None, None, apart)
    # the edge of B beside the corner on which the end of A's edge lies, if the two edges are parallel
    m, l_B, tau = pick(beyond, *around)
    s = dot(tau, apart)
    on_other, s = (0.0 <= s) & (s <= l_B), clip(s, 0.0, l_B)
    apart = apart[0] - s * tau[0], apart[1] - s * tau[1]
    return _Features(separation, (a, n), v, on_face, end, (m, tau), on_other, s, apart)


def _measured(A, B, f, held):
    """Return (distance, normal, point of B) of the features, where the bodies are now."""
    pose, back = relative(A, B), relative(B, A)
    (a, n), v = f.edge, f.corner
    height = dot(n, less(moved(pose, v), a))
    r = less(moved(back, f.end), v)
    n_B = back[2] * n[0] - back[3] * n[1], back[3] * n[0] + back[2] * n[1]
    point = v
    if f.beside:
        (m, tau), s = f.beside, f.along
        facing = dot(m, r)
        along = select(f.on_other, dot(tau, r), s)
        r = r[0] - s * tau[0], r[1] - s * tau[1]
        along = select(f.on_face, 0.0, along)
        point = v[0] + along * tau[0], v[1] + along * tau[1]
    distance, u = _between(r, f.apart, held)
    gap, normal = distance, minus(u)
    if f.beside:
        gap, normal = select(f.on_other, facing, gap), pick(f.on_other, minus(m), normal)
    gap, normal = select(f.on_face, height, gap), pick(f.on_face, n_B, normal)
    return gap, turned(B, normal), moved((B.x, B.y, B.c, B.s), point)


def _between(r, before, held):
    """Return the length of r and its direction; held, to second order in what has changed since ``before``.

    A length has no sign, and two corners that fly through each other stay apart: the direction of before has one.
    """
    if held is None:
        length = sqrt(maximum(dot(r, r), SAME_POINT))
        return length, (r[0] / length, r[1] / length)
    length = sqrt(maximum(dot(before, before), SAME_POINT))
    u = before[0] / length, before[1] / length
    (radius,) = held
    across = u[0] * r[1] - u[1] * r[0]
    bent = across * across / (2.0 * maximum(length, radius)) if radius is not None else 0.0
    return dot(u, r) + bent, u


def _most_separating(A, others):
    """Return (separation, start, normal, length) of the edge of A that sees the other corners furthest away."""
    best = None
    for start, normal, length in zip(A.corners, A.normals, A.lengths, strict=True):
        low, *rest = [dot(normal, p) for p in others]
        for height in rest:
            low = select(height < low, height, low)
        edge = (low - dot(normal, start), start, normal, length)
        best = edge if best is None else pick(best[0] < edge[0], edge, best)
    return best


def _around(B):
    """Return, for each corner, itself and the (normal, length, direction away) of the edges after and before it."""
    found = []
    for k, corner in enumerate(B.corners):
        edges = [(B.normals[i], B.lengths[i], sign) for i, sign in ((k, 1), (k - 1, -1)) if B.normals]
        found.append((corner, *((n, l, (-sign * n[1], sign * n[0])) for n, l, sign in edges)))
    return found


def _first_seen(heights, data):
    low, first = heights[0], data[0]
    for height, other in zip(heights[1:], data[1:], strict=True):
        lower = height < low
        low, first = select(lower, height, low), pick(lower, other, first)
    return first


def distinct(A):
    """Return the corners, those of a segment once."""
    return list({id(p): p for p in A.corners}.values())


def relative(A, B):
    """Return the pose (x, y, c, s) of B in the frame of A."""
    x, y = B.x - A.x, B.y - A.y
    return A.c * x + A.s * y, A.c * y - A.s * x, A.c * B.c + A.s * B.s, A.c * B.s - A.s * B.c


def moved(pose, p):
    """Return a point of a placed frame in the frame it is placed in."""
    x, y, c, s = pose
    return x + c * p[0] - s * p[1], y + s * p[0] + c * p[1]


def turned(B, n):
    """Return a vector of B's frame along the axes of the plane."""
    return B.c * n[0] - B.s * n[1], B.s * n[0] + B.c * n[1]


def pick(condition, a, b):
    """Select between two nested tuples of values."""
    if isinstance(a, tuple):
        return tuple(pick(condition, one, other) for one, other in zip(a, b, strict=True))
    return a if a is b else select(condition, a, b)
