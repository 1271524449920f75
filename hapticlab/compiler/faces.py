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

from .trace import clip, maximum, select, sqrt

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


def closest(A, B):
    """Return what two cores are to each other; they must not both be points.

    Returns
    -------
    distance [m]
        Negative where they overlap: the way to push them apart.
    normal : (x, y)
        Unit vector from A to B, along the axes of the plane.
    point : (x, y) [m]
        Of B, where it is closest to A.
    """
    one = _against(A, B) if A.normals else None
    two = _against(B, A) if B.normals else None
    if two is not None:
        gap, (n_x, n_y), (p_x, p_y), separation = two
        # seen from the other side
        two = gap, (-n_x, -n_y), (p_x - gap * n_x, p_y - gap * n_y), separation
    if one is None or two is None:
        return (one or two)[:3]
    first = one[3] >= two[3]
    return pick(first, one[:3], two[:3])


def _against(A, B):
    """Return (distance, normal, point of B, separation) as the most separating edge of A has it."""
    pose, back = relative(A, B), relative(B, A)
    separation, a, n, l = _most_separating(A, [moved(pose, p) for p in distinct(B)])
    seen = [dot(n, moved(pose, p)) for p in B.seen]
    v, *around = _first_seen(seen, _around(B))
    offset = less(moved(pose, v), a)
    t = (-n[1], n[0])
    along, height = dot(t, offset), dot(n, offset)
    # in overlap the corner is inside, wherever it lies along the edge
    on_face = ((0.0 <= along) & (along <= l)) | (separation <= 0.0)
    beyond = along > 0.5 * l
    end = less(moved(back, pick(beyond, (a[0] + l * t[0], a[1] + l * t[1]), a)), v)
    n_B = back[2] * n[0] - back[3] * n[1], back[3] * n[0] + back[2] * n[1]
    if not around:
        distance = sqrt(maximum(dot(end, end), SAME_POINT))
        gap = select(on_face, height, distance)
        normal = pick(on_face, n_B, (-end[0] / distance, -end[1] / distance))
        return gap, turned(B, normal), moved((B.x, B.y, B.c, B.s), v), separation
    # the edge of B beside the corner on which the end of A's edge lies, if the two edges are parallel
    m, l_B, tau = pick(beyond, *around)
    s = dot(tau, end)
    on_other, s = (0.0 <= s) & (s <= l_B), clip(s, 0.0, l_B)
    r = end[0] - s * tau[0], end[1] - s * tau[1]
    distance = sqrt(maximum(dot(r, r), SAME_POINT))
    gap = select(on_face, height, select(on_other, dot(m, end), distance))
    normal = pick(on_face, n_B, pick(on_other, minus(m), (-r[0] / distance, -r[1] / distance)))
    s = select(on_face, 0.0 * s, s)
    point = v[0] + s * tau[0], v[1] + s * tau[1]
    return gap, turned(B, normal), moved((B.x, B.y, B.c, B.s), point), separation


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


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1]


def less(a, b):
    return a[0] - b[0], a[1] - b[1]


def minus(a):
    return -a[0], -a[1]
