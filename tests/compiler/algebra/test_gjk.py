"""Distances of convex polygons: exact wherever they are, and what they cost."""

import numpy as np
import pytest
import shapely
from placements import BAR, BOX, POINT, aligned, convex, outlines, poses, signed_distance

from hapticlab.compiler.algebra import gjk
from hapticlab.compiler.algebra.polygon_distance import closest, core
from hapticlab.compiler.ir.trace import Builder, clip, maximum, minimum, select, sqrt

N = 1000
#: coordinates are up to 3 m: a few roundings of them
ROUNDING = 4e-15
FIXED = np.random.default_rng(7)
CORES = {
    "box, box": (BOX, BOX),
    "triangle, pentagon": (convex(FIXED, 3), convex(FIXED, 5)),
    "octagon, thin": (convex(FIXED, 8), convex(FIXED, 6, 0.02)),
    "bar, box": (BAR, BOX),
    "box, bar": (BOX, BAR),
    "bar, bar": (BAR, [(-0.3, 0.0), (0.4, 0.0)]),
    "point, hexagon": (POINT, convex(FIXED, 6)),
    "bar, point": (BAR, POINT),
}


def placed(corners, pose):
    x, y, angle = pose
    return core(corners, x, y, np.cos(angle), np.sin(angle))


def measured(method, A, B, *poses):
    with np.errstate(all="ignore"):
        return method(placed(A, poses[0]), placed(B, poses[1]))


@pytest.mark.parametrize("name", CORES)
@pytest.mark.parametrize("how", ["anywhere", "edge along edge"])
def test_faces_give_the_signed_distance(name, how):
    generator = np.random.default_rng(11)
    A, B = CORES[name]
    at = aligned(generator, N) if how == "edge along edge" else (poses(generator, N), poses(generator, N))
    gap, normal, point = measured(closest, A, B, *at)
    one, other = outlines(A, at[0]), outlines(B, at[1])
    thin = len(A) + len(B) < 4  # the Minkowski difference of a bar and a point has no inside
    assert np.abs(gap - (shapely.distance(one, other) if thin else signed_distance(one, other))).max() < ROUNDING
    assert (gap > 0).mean() > 0.3 and (thin or (gap < 0).mean() > 0.03)
    clear = gap > 1e-6
    assert np.abs(np.hypot(*normal) - 1)[clear].max() < 1e-12
    back = np.stack([p - gap * n for p, n in zip(point, normal, strict=True)], -1)
    assert shapely.distance(shapely.points(np.stack(point, -1)), other)[clear].max() < ROUNDING
    assert shapely.distance(shapely.points(back), one)[clear].max() < ROUNDING


@pytest.mark.parametrize("name", ["box, box", "octagon, thin", "bar, box", "bar, bar"])
def test_pushing_along_the_normal_parts_them(name):
    generator = np.random.default_rng(12)
    A, B = CORES[name]
    a, b = poses(generator, N, 0.4), poses(generator, N, 0.4)
    gap, normal, _ = measured(closest, A, B, a, b)
    deep = gap < -1e-3
    moved = np.array([b[0] - gap * normal[0], b[1] - gap * normal[1], b[2]])
    assert deep.mean() > 0.1
    assert np.abs(measured(closest, A, B, a, moved)[0][deep]).max() < ROUNDING


def test_corner_on_corner_edge_on_edge_and_in_one_line():
    boxes = placed(BOX, (np.zeros(4), np.zeros(4), np.zeros(4)))
    x, y = np.array([1.0, 1.0, 0.2, 0.0]), np.array([0.6, 0.0, 0.6, 0.0])
    gap, normal, _ = closest(boxes, placed(BOX, (x, y, 0 * x)))
    assert np.allclose(gap, [0, 0, 0, -0.6], rtol=0, atol=1e-15)
    assert np.allclose(np.abs(normal), [[1, 1, 0, 0], [0, 0, 1, 1]]) or np.allclose(np.abs(normal[1][2:]), 1)
    bars = measured(closest, BAR, BAR, np.zeros((3, 1)), np.array([[1.3], [0.0], [0.0]]))
    assert bars[0] == pytest.approx(0.3, abs=1e-15) and bars[1][0] == 1.0


def test_float32_loses_only_its_rounding():
    generator = np.random.default_rng(13)
    for how in ("anywhere", "aligned"):
        at = aligned(generator, N) if how == "aligned" else (poses(generator, N), poses(generator, N))
        short = [tuple(np.float32(p) for p in pose) for pose in at]
        exact = measured(closest, BOX, BOX, *([p.astype(float) for p in pose] for pose in short))
        A, B = (core([tuple(map(np.float32, p)) for p in BOX], x, y, np.cos(a), np.sin(a)) for x, y, a in short)
        gap = closest(A, B)[0]
        assert gap.dtype == np.float32
        assert np.abs(gap - exact[0]).max() < 3e-6


def worst(A, B, generator, count):
    """Return the number of iterations after which every placement is at its distance, and what :func:`enough` says."""
    a, b = poses(generator, count), poses(generator, count)
    exact = shapely.distance(outlines(A, a), outlines(B, b))
    apart = exact > 1e-9
    for k in range(1, 30):
        gap = measured(lambda one, other, k=k: gjk.distance(one, other, k), A, B, a, b)[0]
        if np.abs(gap - exact)[apart].max() < 1e-14:
            return k, gjk.enough(placed(A, a), placed(B, b))
    raise AssertionError("no number of iterations is enough")


#: corners of each -> iterations needed at worst in a million placements of polygons round, flat and thin
NEEDED = {2: 3, 3: 4, 4: 5, 8: 8, 16: 8, 32: 10}


@pytest.mark.parametrize("corners", NEEDED)
@pytest.mark.always("[2348]")
def test_iterations_of_gjk(corners):
    generator = np.random.default_rng(corners)
    for flat in (1.0, 0.02):
        A, B = [BAR, BAR] if corners == 2 else [convex(generator, corners, flat) for _ in "AB"]
        needed, enough = worst(A, B, generator, 1000)
        assert needed <= NEEDED[corners] <= enough <= 2 * corners


@pytest.mark.slow
@pytest.mark.parametrize("corners", NEEDED)
def test_iterations_of_gjk_over_many_placements(corners):
    generator = np.random.default_rng(100 + corners)
    most = 0
    for k in range(20):
        flat = (1.0, 0.3, 0.02, 0.6)[k % 4]
        A, B = [BAR, BAR] if corners == 2 else [convex(generator, corners, flat) for _ in "AB"]
        needed, enough = worst(A, B, generator, 20_000)
        most = max(most, needed)
        assert needed <= enough
    assert most <= NEEDED[corners]


@pytest.mark.parametrize("name", CORES)
def test_gjk_gives_the_distance_normal_and_point(name):
    generator = np.random.default_rng(14)
    A, B = CORES[name]
    at = poses(generator, N), poses(generator, N)
    gap, normal, point = measured(gjk.distance, A, B, *at)
    exact, exact_normal, _ = measured(closest, A, B, *at)
    apart = exact > 1e-6
    assert np.abs(gap - exact)[apart].max() < ROUNDING
    assert np.abs(np.array(normal) - exact_normal)[:, apart].max() < 1e-8  # of corners 1e-6 m apart
    back = shapely.points(np.stack([p - gap * n for p, n in zip(point, normal, strict=True)], -1))
    assert shapely.distance(back, outlines(A, at[0]))[apart].max() < ROUNDING


def instructions(method, A, B, outputs=1):
    builder = Builder("f64")
    x, y, c, s, *other = (builder.leaf("input", k, "f64") for k in range(8))
    traced = [[(builder.const(u), builder.const(v)) for u, v in corners] for corners in (A, B)]
    gap, normal, point = method(core(traced[0], x, y, c, s), core(traced[1], *other))
    return len(builder.block([gap, *normal, *point][:outputs]))


def every_corner_and_edge(A, B):
    """The signed distance by looking at every corner against every edge, and at every separating axis."""
    worlds = [[(b.x + b.c * u - b.s * v, b.y + b.s * u + b.c * v) for u, v in b.corners] for b in (A, B)]
    nearest, widest = None, None
    for edges, others in (worlds, worlds[::-1]):
        for k, p in enumerate(edges):
            q = edges[(k + 1) % len(edges)]
            d = q[0] - p[0], q[1] - p[1]
            square = d[0] * d[0] + d[1] * d[1]
            low = None
            for o in others:
                e = o[0] - p[0], o[1] - p[1]
                height = d[1] * e[0] - d[0] * e[1]
                low = height if low is None else minimum(low, height)
                part = clip((d[0] * e[0] + d[1] * e[1]) / square, 0.0, 1.0)
                r = e[0] - part * d[0], e[1] - part * d[1]
                far = r[0] * r[0] + r[1] * r[1]
                nearest = far if nearest is None else minimum(nearest, far)
            low = low / sqrt(square)
            widest = low if widest is None else maximum(widest, low)
    return select(widest <= 0.0, widest, sqrt(nearest)), (0.0, 0.0), (0.0, 0.0)


def test_a_third_way_agrees():
    generator = np.random.default_rng(15)
    A, B = CORES["triangle, pentagon"]
    at = poses(generator, N), poses(generator, N)
    assert np.abs(measured(every_corner_and_edge, A, B, *at)[0] - measured(closest, A, B, *at)[0]).max() < 1e-14


@pytest.mark.parametrize(("corners", "cheapest"), [(4, "faces"), (8, "faces"), (16, "gjk")])
@pytest.mark.always("[48]-*")
def test_what_they_cost(corners, cheapest):
    generator = np.random.default_rng(16)
    A, B = convex(generator, corners), convex(generator, corners)
    cost = {
        "faces": instructions(closest, A, B),
        "gjk": instructions(gjk.distance, A, B),
        "every corner and edge": instructions(every_corner_and_edge, A, B),
    }
    if cheapest == "faces":
        assert min(cost, key=cost.get) == "faces", cost
    else:
        assert cost["gjk"] < 1.1 * cost["faces"] < cost["every corner and edge"], cost


def test_a_box_on_a_box_is_as_dear_as_the_documentation_says():
    cost = [instructions(method, BOX, BOX) for method in (closest, gjk.distance, every_corner_and_edge)]
    assert cost == [393, 1106, 863]


def test_the_derivative_depends_on_one_point_of_each_body():
    """What is chosen is chosen by comparisons: no sum over corners carries the distance."""
    builder = Builder("f64")
    leaves = [builder.leaf("input", k, "f64") for k in range(8)]
    traced = [(builder.const(u), builder.const(v)) for u, v in BOX]
    gap, _, _ = closest(core(traced, *leaves[:4]), core(traced, *leaves[4:]))
    instructions = builder.block([gap]).instructions
    carries, stack = set(), [builder.block([gap]).outputs[0]]
    while stack:
        k = stack.pop()
        if k not in carries:
            carries.add(k)
            i = instructions[k]
            stack += i.args[1:] if i.op == "select" else () if i.type == "bool" else i.args
    smooth = [instructions[k].op for k in carries if instructions[k].op in ("add", "sub", "mul", "div", "sqrt")]
    assert len(smooth) < 110, len(smooth)
