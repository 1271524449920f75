"""The distance of two convex cores by Gilbert, Johnson and Keerthi (1988), with a fixed number of iterations.

Each iteration looks for the corner of the Minkowski difference B - A that lies furthest towards the origin, and keeps
the nearer of the two edges it makes with the corners known; in the plane two corners are enough. After the first two,
every new corner lies on the chain between them, so :func:`enough` iterations always do, and usually far fewer.

The distance is never negative: in overlap it means nothing. :mod:`~hapticlab.compiler.algebra.polygon_distance` gives the
depth too, and costs less up to 16 corners each: 393 instructions against 1106 for a box on a box, 3613 against 3646 for
16 corners, 12 221 against 7171 for 32. (Every corner against every edge: 863, 12 767 and 50 111.) So this is for cores of many
corners that a radius widens.
"""

import math

import sympy as sp
from sympy.core.symbol import Str

from ...scene.notation.symbols import t
from ...scene.shapes.closest_points import PARTS, ClosestPoints, sampled
from ...scene.shapes.plane import dot, less, minus
from ..ir.trace import clip, maximum, select, sqrt
from .polygon_distance import SAME_POINT, closest, core, distinct, moved, pick, relative, turned


def enough(A, B):
    """Return a number of iterations after which two cores, wherever they are, are at their distance.

    The proof asks for one iteration a corner. The worst of a million random placements of polygons round, flat and
    thin took 5 iterations for 4 corners each, 8 for 8 and 16, and 10 for 32, which grows as the logarithm; this is at
    least one more. Were it too few, the result would be the distance of two points of the bodies: never too small.
    """
    corners = len(distinct(A)) + len(distinct(B))
    return min(corners, 4 + corners.bit_length())


def distance(A, B, iterations=None):
    """Return (distance, normal, point of B) of two cores apart, as ``polygon_distance.closest`` does.

    Parameters
    ----------
    A, B : Core
    iterations : int, optional
        :func:`enough` unless given.
    """
    pose = relative(A, B)
    placed = [(p, moved(pose, p)) for p in distinct(B)]
    w = _support(A, placed, (pose[0], pose[1]))
    one, two, p = w, w, w[0]
    for _ in range(iterations or enough(A, B)):
        w = _support(A, placed, p)
        # a corner no nearer to the origin along p than p itself: p is the closest point
        further = dot(p, w[0]) < dot(p, p)
        (q, d_q), (r, d_r) = _nearest(one[0], w[0]), _nearest(two[0], w[0])
        first = d_q < d_r
        closer = further & (select(first, d_q, d_r) < dot(p, p))
        one = pick(closer, pick(first, one, two), one)
        two = pick(closer, w, two)
        p = pick(closer, pick(first, q, r), p)
    return _measured(A, B, one, two)


def _support(A, placed, towards):
    """Return (B - A, corner of A, corner of B) furthest against a direction; corners in their own frames."""
    (a, *others), b = distinct(A), placed[0]
    most, least = dot(towards, a), dot(towards, b[1])
    for p in others:
        height = dot(towards, p)
        higher = most < height
        most, a = select(higher, height, most), pick(higher, p, a)
    for p in placed[1:]:
        height = dot(towards, p[1])
        lower = height < least
        least, b = select(lower, height, least), pick(lower, p, b)
    return less(b[1], a), a, b[0]


def _nearest(p, q):
    """Return the point of the segment from p to q that is closest to the origin, and the square of its distance."""
    along = less(q, p)
    part = clip(-dot(p, along) / maximum(dot(along, along), SAME_POINT), 0.0, 1.0)
    point = p[0] + part * along[0], p[1] + part * along[1]
    return point, dot(point, point)


def _measured(A, B, one, two):
    """Take the distance of the chosen corners again, so that only it depends on where the bodies are."""
    pose = relative(A, B)
    p, q = (less(moved(pose, w[2]), w[1]) for w in (one, two))
    along = less(q, p)
    length = maximum(dot(along, along), SAME_POINT)
    part = -dot(p, along) / length
    corner = (part <= 0.0) | (1.0 <= part)
    part = clip(part, 0.0, 1.0)
    end = pick(1.0 <= part, q, p)
    square = sqrt(length)
    across = (along[1] / square, -along[0] / square)
    height = dot(across, p)
    # the normal of an edge of B - A points from A to B where the edge is
    across = pick(height < 0.0, minus(across), across)
    far = sqrt(maximum(dot(end, end), SAME_POINT))
    gap = select(corner, far, abs(height))
    normal = pick(corner, (end[0] / far, end[1] / far), across)
    b = one[2][0] + part * (two[2][0] - one[2][0]), one[2][1] + part * (two[2][1] - one[2][1])
    return gap, turned(A, normal), moved((B.x, B.y, B.c, B.s), b)


def trace(translator, node):
    """Return the value of a :class:`~hapticlab.scene.shapes.closest_points.ClosestPoints`; its other parts are known then."""
    first, second, method, label, _ = node.args
    found = _pairs(translator, first, second, method.name)
    if method.name == "sample" and len(found) > 1:
        chosen = _pairs(_at_sample(translator), first, second, "faces")
    else:
        chosen = found
    (least, gap), *others = [(by[0], result) for by, result in zip(chosen, found, strict=True)]
    for by, result in others:
        least, gap = pick(by < least, (by, result), (least, gap))
    distance, normal, point = gap
    for part, value in zip(PARTS, (distance, *normal, *point), strict=True):
        translator.known[ClosestPoints(first, second, method, label, Str(part))] = value
    return translator.known[node]


def near(translator, condition):
    """Whether two bodies are so near that a condition ``gap <= 0`` of theirs may hold; None where nothing cheap tells.

    No point of a body is further from its origin than its reach, so where the origins are further apart along an axis
    than both reaches, and rounding, the gap is open. What is looked for once a sample must do for a period: there it is
    twice the reaches, which no body travels in a period unless it may pass through others between two samples as well.
    """
    nodes = [part for part in sp.Add.make_args(condition.lhs) if isinstance(part, ClosestPoints) and part.part == "distance"]
    if condition.rel_op != "<=" or condition.rhs != 0 or len(nodes) != 1:
        return None
    first, second, method, *_ = nodes[0].args
    if not first[0] or condition.lhs - nodes[0] != -(first[4] + second[4]):
        return None
    translate, slack = (_at_sample(translator), 2.0) if method.name == "sample" else (translator, 1.001)
    corners = [[[translator(u).constant for u in p] for core in body[0] for p in core] for body in (first, second)]
    radii = [translator(body[4]).constant for body in (first, second)]
    if None in (*radii, *(u for body in corners for p in body for u in p)):
        return None
    reach = slack * (sum(radii) + sum(max(math.hypot(*p) for p in body) for body in corners))
    x, y = (abs(translate(second[k]) - translate(first[k])) for k in (1, 2))
    found = (x <= reach) & (y <= reach)
    translator.builder.implied.add(found.id)
    return found


def _pairs(translate, first, second, method):
    """Return (distance, normal, point) of each core of one body and each of the other, or of each corner."""
    A, B = _cores(translate, first), _cores(translate, second)
    if not A:
        return _above(translate, first, B)
    if method == "gjk":
        return [distance(a, b) for a in A for b in B]
    if method == "faces":
        return [closest(a, b) for a in A for b in B]
    A0, B0 = (_cores(_at_sample(translate), body) for body in (first, second))
    radii = first[4] + second[4]
    radius = translate(radii) if radii != 0 else None
    return [closest(a, b, (a0, b0), radius) for a, a0 in zip(A, A0, strict=True) for b, b0 in zip(B, B0, strict=True)]


def _at_sample(translate):
    return lambda expr: translate(sampled(expr) if expr.has(t) else expr)


def _cores(translate, body):
    cores, x, y, angle, _ = body
    placed = [translate(expr) for expr in (x, y, sp.cos(angle), sp.sin(angle))]
    return [core([tuple(map(translate, p)) for p in corners], *placed) for corners in cores]


def _above(translate, plane, cores):
    """Return (height, normal, point) of each corner above a half-plane."""
    _, x, y, angle, _ = plane
    x, y, c, s = (translate(expr) for expr in (x, y, sp.cos(angle), sp.sin(angle)))
    points = [moved((B.x, B.y, B.c, B.s), p) for B in cores for p in distinct(B)]
    return [(dot((-s, c), less(p, (x, y))), (-s, c), p) for p in points]
