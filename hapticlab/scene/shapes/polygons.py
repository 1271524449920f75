"""Outlines of polygons: checked, and split into convex parts. Points are floats [m], shape (N, 2).

Ears are clipped off first (Meisters 1975), then diagonals that leave both sides convex are taken out again (Hertel and
Mehlhorn 1983): at most four times the fewest convex parts there can be.
"""

import math

from ...errors import SceneError

#: corners that turn less than this [rad], and points closer than this part of the size, are left out
NEARLY = 1e-9


def outline(points):
    """The corners of a polygon counter-clockwise, without repeated and collinear points.

    Parameters
    ----------
    points : sequence of (x, y) [m], in order around the polygon, either way; the last may repeat the first

    Raises
    ------
    SceneError
        Fewer than three corners, no area, or edges that cross or touch each other.

    Examples
    --------
    >>> outline([(0, 0), (0, 1), (1, 1), (1, 0.5), (1, 0), (0, 0)])
    ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0))
    """
    points = [(float(u), float(v)) for u, v in points]
    size = max(math.dist(p, q) for p in points for q in points) if len(points) > 1 else 0.0
    corners = [p for k, p in enumerate(points) if math.dist(p, points[k - 1]) > NEARLY * size]
    if len(corners) < 3:
        raise SceneError(f"a polygon of {len(corners)} different points has no area; needs at least three corners")
    _check_simple(corners)
    corners = _without_collinear(corners)
    if len(corners) < 3:
        raise SceneError(
            f"the {len(points)} points of the polygon lie on one line; a thin bar is hl.shapes.Segment or hl.shapes.Capsule"
        )
    if _area(corners) < 0:
        corners.reverse()
    first = corners.index(min(corners))
    return tuple(corners[first:] + corners[:first])


def convex_parts(corners):
    """Split a simple polygon, counter-clockwise, into convex ones.

    Examples
    --------
    >>> len(convex_parts([(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)]))
    2
    """
    if all(_cross(*three) > 0 for three in _threes(corners)):
        return (tuple(corners),)
    parts = _triangles(list(range(len(corners))), corners)
    merged = True
    while merged:
        merged = _merge_two(parts, corners)
    return tuple(tuple(corners[k] for k in part) for part in parts)


def width(corners):
    """Least width [m] of a convex polygon: between an edge and the corner furthest from it."""
    edges = zip(corners, corners[1:] + corners[:1], strict=True)
    return min(max(_cross(a, b, p) for p in corners) / math.dist(a, b) for a, b in edges)


def _cross(a, b, c):
    """Twice the area of the triangle a, b, c; positive for a turn to the left."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _area(corners):
    return 0.5 * sum(p[0] * q[1] - q[0] * p[1] for p, q in zip(corners, corners[1:] + corners[:1], strict=True))


def _threes(corners):
    return [(corners[k - 2], corners[k - 1], corners[k]) for k in range(len(corners))]


def _without_collinear(corners):
    kept = list(corners)
    k = 0
    while len(kept) > 2 and k < len(kept):
        a, b, c = kept[k - 1], kept[k], kept[(k + 1) % len(kept)]
        if abs(_cross(a, b, c)) <= NEARLY * math.dist(a, b) * math.dist(b, c):
            del kept[k]
            k = max(k - 1, 0)
        else:
            k += 1
    return kept


def _check_simple(corners):
    N = len(corners)
    edges = [(corners[k], corners[(k + 1) % N]) for k in range(N)]
    for i in range(N):
        for j in range(i + 2, N):
            if (i, j) != (0, N - 1) and _touch(*edges[i], *edges[j]):
                raise SceneError(
                    f"the polygon's edges {_named(edges[i])} and {_named(edges[j])} cross or touch; list its corners "
                    "in order around it, or make it of two polygons"
                )


def _named(edge):
    return " to ".join(f"({p[0]:g}, {p[1]:g})" for p in edge)


def _touch(a, b, c, d):
    """Whether two segments share a point."""
    sides = _cross(a, b, c), _cross(a, b, d), _cross(c, d, a), _cross(c, d, b)
    if sides[0] * sides[1] < 0 and sides[2] * sides[3] < 0:
        return True
    ends = ((sides[0], c, a, b), (sides[1], d, a, b), (sides[2], a, c, d), (sides[3], b, c, d))
    return any(side == 0 and _between(p, q, r) for side, p, q, r in ends)


def _between(p, a, b):
    """Whether p, on the line through a and b, lies between them."""
    return all(min(a[k], b[k]) <= p[k] <= max(a[k], b[k]) for k in (0, 1))


def _triangles(left, corners):
    """Cut ears off a polygon of corner numbers until triangles are left."""
    made = []
    while len(left) > 3:
        ear = next(k for k in range(len(left)) if _is_ear(left, k, corners))
        made.append([left[ear - 1], left[ear], left[(ear + 1) % len(left)]])
        del left[ear]
    return [*made, left]


def _is_ear(left, k, corners):
    i, j, l = left[k - 1], left[k], left[(k + 1) % len(left)]
    a, b, c = corners[i], corners[j], corners[l]
    if _cross(a, b, c) <= 0:
        return False
    others = (corners[m] for m in left if m not in (i, j, l))
    return not any(_cross(a, b, p) >= 0 and _cross(b, c, p) >= 0 and _cross(c, a, p) >= 0 for p in others)


def _merge_two(parts, corners):
    """Join the first two parts that stay convex without their common edge; False where there are none."""
    for i, one in enumerate(parts):
        for j in range(i + 1, len(parts)):
            joined = _joined(one, parts[j])
            if joined and all(_cross(*three) > 0 for three in _threes([corners[k] for k in joined])):
                parts[i] = joined
                del parts[j]
                return True
    return False


def _joined(one, other):
    """Two parts joined without their common edge, or None where they have none."""
    for k, a in enumerate(one):
        b = one[(k + 1) % len(one)]
        if a in other and b in other and other[(other.index(b) + 1) % len(other)] == a:
            m = other.index(a)
            around = other[m:] + other[:m]  # a ... b
            return one[: k + 1] + around[1:-1] + one[k + 1 :]
    return None
