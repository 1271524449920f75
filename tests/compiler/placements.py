"""Shapes at many random placements at once, in this package and in shapely."""

import numpy as np
import shapely

from hapticlab.compiler.algebra.expressions import Translator
from hapticlab.compiler.engines.interpreter import evaluate
from hapticlab.compiler.ir.program import Block, Program
from hapticlab.compiler.ir.trace import Builder, expand

BOX = [(-0.5, -0.3), (0.5, -0.3), (0.5, 0.3), (-0.5, 0.3)]
BAR = [(-0.5, 0.0), (0.5, 0.0)]
POINT = [(0.0, 0.0)]


def convex(generator, corners, flat=0.6):
    """Return a random convex polygon, on an ellipse around its origin."""
    while True:
        angles = np.sort(generator.uniform(0, 2 * np.pi, corners))
        steps = np.diff(np.append(angles, angles[0] + 2 * np.pi))
        if 1e-3 < steps.min() and steps.max() < 0.97 * np.pi:
            return [(float(np.cos(a)), float(flat * np.sin(a))) for a in angles]


def poses(generator, count, far=1.2):
    """Return x, y, angle."""
    return generator.uniform(-far, far, (3, count)) * [[1], [1], [np.pi / far]]


def aligned(generator, count):
    """Return two poses whose bodies lie edge along edge: quarter turns, and places on a grid, all turned together."""
    together = generator.uniform(-3, 3, count)
    x, y, turn = generator.integers(-4, 5, (3, 2, count)) / 4
    return [(x[k], y[k], turn[k] * 2 * np.pi + together) for k in (0, 1)]


def outlines(corners, pose):
    """Return shapely's geometries of a core at many placements."""
    x, y, angle = (np.asarray(p)[:, None] for p in pose)
    u, v = np.array(corners).T
    c, s = np.cos(angle), np.sin(angle)
    points = np.stack([x + c * u - s * v, y + s * u + c * v], -1)
    return {1: lambda p: shapely.points(p[:, 0]), 2: shapely.linestrings}.get(len(corners), shapely.polygons)(points)


def signed_distance(one, other):
    """Return the signed distance of convex geometries: of the origin from their Minkowski difference."""
    distance = shapely.distance(one, other)
    for k in np.flatnonzero(distance == 0):
        a, b = (shapely.get_coordinates(g[k]) for g in (one, other))
        difference = shapely.convex_hull(shapely.multipoints((b[:, None] - a[None]).reshape(-1, 2)))
        distance[k] = -shapely.distance(difference.boundary, shapely.Point(0, 0))
    return distance


def values(expressions, at, real="f64"):
    """Return expressions as arrays, for ``at``: leaf -> float or array."""
    builder, leaves = Builder(real), []

    def leaf(expr):
        leaves.append(np.asarray(at[expr], {"f32": np.float32, "f64": np.float64}[real]))
        return builder.leaf("input", len(leaves) - 1, real)

    outputs = list(map(Translator(builder, leaf), expressions))
    program = Program("values", (), (), (), (), Block(), builder.block(outputs), 1.0)
    with np.errstate(all="ignore"):
        return evaluate(expand(program).tick, input=leaves)[0]
