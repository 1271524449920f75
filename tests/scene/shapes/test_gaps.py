"""Gaps of every pair of shapes against shapely, their derivatives against differences."""

import itertools

import numpy as np
import pytest
import shapely
import sympy as sp
from placements import convex, outlines, poses, signed_distance, values

import hapticlab as hl
from hapticlab.compiler.algebra.graph import Graph
from hapticlab.compiler.ir.trace import reachable
from hapticlab.errors import SceneError
from hapticlab.scene.notation.amount import Amount
from hapticlab.scene.notation.derivative import Partial, Rate
from hapticlab.scene.notation.units import unit_of
from hapticlab.scene.shapes.closest_points import ClosestPoints
from hapticlab.scene.shapes.gaps import closest, corners, gap
from hapticlab.scene.shapes.shapes import Box, Capsule, Circle, HalfPlane, Polygon, Segment, ground

N = 400
t = hl.t
A = [hl.coordinate(name, unit=unit) for name, unit in (("x_a", "m"), ("y_a", "m"), ("a_a", "rad"))]
B = [hl.coordinate(name, unit=unit) for name, unit in (("x_b", "m"), ("y_b", "m"), ("a_b", "rad"))]
ROUND = convex(np.random.default_rng(3), 6)
SHAPES = {
    "circle": Circle(0.3),
    "box": Box(1, 0.6),
    "capsule": Capsule(1, 0.2),
    "segment": Segment(1),
    "polygon": Polygon(ROUND),
    "rounded": Polygon(ROUND[:4], radius="10 cm"),
    "half-plane": HalfPlane(),
}
CORES = {
    "circle": ([(0.0, 0.0)], 0.3),
    "box": ([(-0.5, -0.3), (0.5, -0.3), (0.5, 0.3), (-0.5, 0.3)], 0.0),
    "capsule": ([(-0.5, 0.0), (0.5, 0.0)], 0.2),
    "segment": ([(-0.5, 0.0), (0.5, 0.0)], 0.0),
    "polygon": (ROUND, 0.0),
    "rounded": (list(Polygon(ROUND[:4]).points), 0.1),
}
PAIRS = [pair for pair in itertools.combinations_with_replacement(SHAPES, 2) if pair != ("half-plane", "half-plane")]
#: a segment is a capsule without a radius
OTHERS = [pair for pair in PAIRS if "segment" not in pair or pair == ("circle", "segment")]
FEW = OTHERS[::2]


def pair(one, other):
    a = SHAPES[one].at(x=A[0], y=A[1], angle=A[2], name="a")
    return a, SHAPES[other].at(x=B[0], y=B[1], angle=B[2], name="b")


def placed(seed, far=1.2, count=N):
    generator = np.random.default_rng(seed)
    return dict(zip([*A, *B], [*poses(generator, count, far), *poses(generator, count, far)], strict=True))


def expected(one, other, at):
    """The signed distance as shapely has it."""
    if other == "half-plane":
        (core, r), (x, y, angle) = CORES[one], [at[q] for q in B]
        body = outlines(core, [at[q] for q in A])
        heights = [
            (np.array(shapely.get_coordinates(g)) - (x[k], y[k])) @ (-np.sin(angle[k]), np.cos(angle[k]))
            for k, g in enumerate(body)
        ]
        return np.array([h.min() for h in heights]) - r
    (core, r), (other_core, s) = CORES[one], CORES[other]
    geometry, other_geometry = outlines(core, [at[q] for q in A]), outlines(other_core, [at[q] for q in B])
    thin = len(core) + len(other_core) < 4
    distance = shapely.distance if thin else signed_distance
    return distance(geometry, other_geometry) - r - s


@pytest.mark.parametrize(("one", "other"), PAIRS)
@pytest.mark.always("circle-*", "box-box", "capsule-segment", "polygon-*")
def test_gap_is_the_signed_distance_either_way_around(one, other):
    at, (a, b) = placed(1), pair(one, other)
    there, back = values([gap(a, b), gap(b, a)], at)
    assert np.abs(there - expected(one, other, at)).max() < 5e-15
    assert np.abs(there - back).max() < 5e-15
    assert unit_of(gap(a, b)) == "m"
    assert (there < 0).mean() > (0.02 if (one, other) != ("segment", "segment") else 0.01) and (there > 0).mean() > 0.2


@pytest.mark.parametrize(("one", "other"), FEW)
def test_gap_changes_as_the_closest_points_move(one, other):
    """The envelope theorem: d gap/dq = normal . d(witness)/dq, with the witness held in its body."""
    at, (a, b) = placed(2), pair(one, other)
    found = closest(a, b)
    g, n_x, n_y, p_x, p_y = values([found.gap, *found.normal, *found.point], at)
    assert np.abs(np.hypot(n_x, n_y) - 1).max() < 1e-12
    arms = [n_x, n_y, n_y * (p_x - at[B[0]]) - n_x * (p_y - at[B[1]])]
    arms += [-n_x, -n_y, -(n_y * (p_x - at[A[0]]) - n_x * (p_y - at[A[1]]))]
    h = 1e-6
    steps = h * np.concatenate([np.eye(6), -np.eye(6)])[:, :, None]  # late and early of each coordinate, all in lanes
    moved = {q: (at[q] + steps[:, k]).ravel() for k, q in enumerate([*B, *A])}
    there = values([found.gap], moved)[0].reshape(2, 6, -1)
    for q, arm, late, early in zip([*B, *A], arms, *there, strict=True):
        smooth = np.abs((late - g) - (g - early)) < 1e-4 * h  # no other features within h
        assert smooth.mean() > 0.95
        assert np.abs(arm - (late - early) / (2 * h))[smooth].max() < 2e-6, (one, other, q)


@pytest.mark.wide
@pytest.mark.parametrize(
    ("one", "other"),
    [
        ("circle", "circle"), ("circle", "box"), ("box", "half-plane"), ("box", "box"), ("capsule", "polygon"),
        ("rounded", "segment"),
    ],
)  # fmt: skip
def test_derivatives_on_the_graph(one, other):
    """First derivatives by closed form; second ones, which hold how the normal turns, by differences of the first."""
    at, (a, b) = placed(5, count=200), pair(one, other)
    found, Q = closest(a, b), [*B, *A]
    graph, generator = Graph(), np.random.default_rng(6)
    at |= {q.diff(t): generator.uniform(-1, 1, 200) for q in Q}
    n_x, n_y, p_x, p_y = values([*found.normal, *found.point], at)
    arms = [n_x, n_y, n_y * (p_x - at[B[0]]) - n_x * (p_y - at[B[1]])]
    arms += [-n_x, -n_y, -(n_y * (p_x - at[A[0]]) - n_x * (p_y - at[A[1]]))]
    rate, second = Rate(found.gap), Rate(Rate(found.gap))
    *partials, r, r_t = graph.evaluate([*(Partial(found.gap, q) for q in Q), rate, second], at)
    assert max(np.abs(partial - arm).max() for partial, arm in zip(partials, arms, strict=True)) < 1e-13
    assert np.abs(r - sum(arm * at[q.diff(t)] for arm, q in zip(arms, Q, strict=True))).max() < 1e-13
    h = 1e-5
    late, early = (graph.evaluate([rate], at | {q: at[q] + side * h * at[q.diff(t)] for q in Q})[0] for side in (1, -1))
    # where the closest features do not change within h, and are not so close that the normal turns within it
    smooth = (np.abs(late - early) < 1e3 * h * 10) & (np.abs(late - 2 * r + early) < 1e-6)
    assert smooth.mean() > 0.95
    assert np.median(np.abs(r_t - (late - early) / (2 * h))[smooth]) < 1e-10
    assert np.quantile(np.abs(r_t - (late - early) / (2 * h))[smooth], 0.9) < 1e-7


@pytest.mark.parametrize(("one", "other"), FEW)
@pytest.mark.always("circle-*", "box-rounded", "polygon-polygon")
def test_features_of_the_sample_are_the_same_at_the_sample(one, other):
    at, (a, b) = placed(7, count=200), pair(one, other)
    here, held = closest(a, b), closest(a, b, method="sample")
    known, found = (values([c.gap, *c.normal, *c.point], at) for c in (here, held))
    assert max(np.abs(k - f).max() for k, f in zip(known, found, strict=True)) < 1e-13


@pytest.mark.parametrize(("one", "other"), [("circle", "polygon"), ("box", "box"), ("capsule", "rounded"), ("box", "half-plane")])
@pytest.mark.always("circle-*", "box-*")
def test_features_of_the_sample_have_the_same_derivatives(one, other):
    """Held, a corner's distance is taken to second order, so that a disc that rolls over one feels it turn."""
    at, (a, b) = placed(8, count=200), pair(one, other)
    generator = np.random.default_rng(9)
    at |= {q.diff(t): generator.uniform(-1, 1, 200) for q in (*A, *B)}
    (g, r, r_t), (held, rate, rate_t) = (
        Graph().evaluate([c, Rate(c), Rate(Rate(c))], at) for c in (gap(a, b), gap(a, b, method="sample"))
    )
    assert np.abs(g - held).max() < 1e-14 and np.abs(r - rate).max() < 1e-12
    core = g + CORES[one][1] + CORES.get(other, ((), 0))[1]
    radii = core - g
    alike = (core > radii) & (radii > 1e-9) | (core < 0)  # corners nearer than in touch bend as they do in touch
    assert alike.mean() > 0.15
    assert np.abs(r_t - rate_t)[alike].max() < 1e-9


def test_boxes_stacked_edge_on_edge_push_straight_up():
    """Corners coincide and edges are parallel: the normal and its derivatives are those of the edges all the same."""
    a, b = pair("box", "box")
    g = gap(a, b)
    x = np.array([0.0, 0.3, -0.999, 0.0, 0.0])
    up = np.array([0.6, 0.6, 0.6, 0.6 + 1e-9, 0.6 - 1e-9])
    for turn in (0.0, 0.3):
        c, s = np.cos(turn), np.sin(turn)
        at = dict(zip([*A, *B], [0.1, 0.2, turn, 0.1 + c * x - s * up, 0.2 + s * x + c * up, turn], strict=True))
        found, n_x, n_y = Graph().evaluate([g, Partial(g, B[0]), Partial(g, B[1])], at)
        assert np.abs(found - (up - 0.6)).max() < 1e-15
        assert np.abs(n_x + s).max() < 1e-12 and np.abs(n_y - c).max() < 1e-12


def test_the_gradient_of_polygons_costs_the_same_for_any_number_of_corners():
    """Corners are chosen by comparisons, so only the chosen ones are differentiated."""
    cost = []
    for many in (4, 8, 12):
        graph = Graph()
        shape = Polygon(convex(np.random.default_rng(2), many))
        a, b = shape.at(x=A[0], y=A[1], angle=A[2]), shape.at(x=B[0], y=B[1], angle=B[2])
        wanted = [gap(a, b), *(Partial(gap(a, b), q) for q in (*A, *B))]
        whole, alone = (reachable(graph.builder.instructions, [graph(e).id for e in es]) for es in (wanted, wanted[:1]))
        cost.append(len(whole) - len(alone))
    assert max(cost) - min(cost) <= 12 and max(cost) < 170, cost


@pytest.mark.parametrize(("one", "other"), OTHERS)
@pytest.mark.always("circle-*", "box-box", "polygon-*")
def test_the_point_is_on_both_bodies_in_touch(one, other):
    at, (a, b) = placed(3), pair(one, other)
    found = closest(a, b)
    g, n_x, n_y = values([found.gap, *found.normal], at)
    at |= {B[0]: at[B[0]] - g * n_x, B[1]: at[B[1]] - g * n_y}
    g, p_x, p_y = values([found.gap, *found.point], at)
    touching = np.abs(g) < 1e-14  # overlaps too deep to have one way out are left
    assert touching.mean() > 0.9
    for name, pose in ((one, A), (other, B)):
        if name != "half-plane":
            core, r = CORES[name]
            far = shapely.distance(outlines(core, [at[q] for q in pose]), shapely.points(p_x, p_y))
            assert np.abs(far - r)[touching].max() < 1e-14


@pytest.mark.parametrize(("one", "other"), [("box", "half-plane"), ("circle", "box"), ("capsule", "polygon")])
@pytest.mark.always("box-half-plane", "circle-box")
def test_slip_is_how_the_material_passes(one, other):
    at, (a, b) = placed(4, count=50), pair(one, other)
    found = closest(a, b)
    assert unit_of(found.slip) == "m/s"
    generator = np.random.default_rng(5)
    rates = {q: generator.uniform(-1, 1, 50) for q in (*A, *B)}
    seen = at | {q.diff(t): rate for q, rate in rates.items()}
    slip, n_x, n_y, p_x, p_y = values([found.slip, *found.normal, *found.point], seen)
    past = 0
    for body, sign in ((A, -1), (B, 1)):
        v_x = rates[body[0]] - rates[body[2]] * (p_y - at[body[1]])
        v_y = rates[body[1]] + rates[body[2]] * (p_x - at[body[0]])
        past = past + sign * (-n_y * v_x + n_x * v_y)
    assert np.abs(slip - past).max() < 1e-13
    same = closest(b, a)
    assert np.abs(values([same.slip], seen)[0] - slip)[values([found.gap], at)[0] > 0.1].max() < 5  # of another point


HOOK = [(-0.5, -0.5), (0.5, -0.5), (0.5, -0.2), (-0.2, -0.2), (-0.2, 0.5), (-0.5, 0.5)]


@pytest.mark.parametrize("other", ["circle", "box", "capsule", "half-plane"])
def test_a_hook_keeps_its_hollow(other):
    at = placed(6)
    hook = Polygon(HOOK).at(x=A[0], y=A[1], angle=A[2], name="hook")
    _, b = pair("circle", other)
    found = closest(hook, b)
    g, n_x, n_y, p_x, p_y = values([found.gap, *found.normal, *found.point], at)
    body = outlines(HOOK, [at[q] for q in A])
    if other == "half-plane":
        x, y, angle = (at[q] for q in B)
        reach = [
            ((shapely.get_coordinates(h) - (x[k], y[k])) @ (-np.sin(angle[k]), np.cos(angle[k]))).min()
            for k, h in enumerate(body)
        ]
        assert np.abs(g - reach).max() < 1e-14
        return
    core, r = CORES[other]
    apart = shapely.distance(body, outlines(core, [at[q] for q in B]))
    clear = apart > 1e-12
    assert clear.mean() > 0.3
    assert np.abs(g - (apart - r))[clear].max() < 5e-15
    assert (g[~clear] < 1e-12).all()
    assert np.abs(np.hypot(n_x, n_y) - 1)[clear].max() < 1e-12
    far = shapely.distance(outlines(core, [at[q] for q in B]), shapely.points(p_x, p_y))
    assert np.abs(far - r)[clear].max() < 1e-13


def test_closed_forms_are_written_out():
    z = A[1]
    assert gap(ground(), Circle("5 mm").at(y=z)) == z - Amount(0.005, "m")
    r, l = hl.parameters("r l", units="m m", ranges=((0, 1), (0, 1)))
    two = gap(Circle(r).at(), Circle(l).at(x=A[0], y=z))
    assert two == sp.sqrt(A[0] ** 2 + z**2) - r - l
    for shape in (Box(1, l), Capsule(l, r), Segment(l)):
        assert not gap(shape.at(), Circle(r).at(x=A[0], y=z)).has(ClosestPoints)
    assert gap(Box(1, l).at(), Box(r, l).at(x=A[0])).has(ClosestPoints)
    assert str(gap(Box(1, l).at(name="a"), Box(r, l).at(x=A[0], name="b"))) == "distance(a, b)"
    assert "distance" in sp.latex(gap(Box(1, l).at(name="a"), Box(r, l).at(x=A[0], name="b")))


def test_a_disc_level_with_a_box_has_a_gap():
    """No corner is ever the closest there, which is known before anything moves."""
    found = gap(Circle("1 mm").at(x=A[0]), Box("10 mm", "40 mm").at(x="15 mm"))
    places = np.array([0.0, 0.009, 0.012, 0.015, 0.025])
    at = [values([found], {A[0]: place})[0] for place in places]
    np.testing.assert_allclose(at, np.abs(places - 0.015) - 0.006, atol=1e-15)


def test_sizes_may_be_parameters():
    r, l, w = hl.parameters("r l w", units="m m m", ranges=((0, 1),) * 3)
    a, b = Box(l, w).at(x=A[0], y=A[1], angle=A[2]), Capsule(w, r).at(x=B[0], y=B[1], angle=B[2])
    at = placed(8)
    found = values([gap(a, b)], at | {r: 0.2, l: 1.0, w: 0.6})[0]
    capsule = ([(-0.3, 0.0), (0.3, 0.0)], 0.2)
    one, other = outlines(CORES["box"][0], [at[q] for q in A]), outlines(capsule[0], [at[q] for q in B])
    assert np.abs(found - (signed_distance(one, other) - 0.2)).max() < 5e-15


def test_gjk_is_offered_for_shapes_with_a_radius():
    at, (a, b) = placed(9), pair("rounded", "polygon")
    one, other = values([gap(a, b), gap(a, b, method="gjk")], at)
    assert np.abs(one - other)[one > -0.1 + 1e-9].max() < 5e-15
    with pytest.raises(SceneError, match="gjk gives no negative distance"):
        gap(*pair("polygon", "box"), method="gjk")
    with pytest.raises(SceneError, match="faces, sample, gjk"):
        gap(a, b, method="sat")


def test_corners_above_a_half_plane_each_have_a_gap():
    at, (_, b) = placed(10), pair("circle", "box")
    plane = HalfPlane().at(x=A[0], y=A[1], angle=A[2], name="plane")
    each = values([c.gap for c in corners(plane, b)], at)
    assert len(each) == 4
    assert np.abs(np.min(each, 0) - values([gap(plane, b)], at)[0]).max() < 1e-15
    with pytest.raises(SceneError, match="is a Box"):
        corners(b, plane)


@pytest.mark.parametrize(
    ("make", "word"),
    [
        (lambda: gap(ground(), HalfPlane().at(y=A[0])), "two half-planes"),
        (lambda: gap(Circle(1), ground()), "not a shape with a position"),
        (lambda: gap(ground(), 3), "not a shape with a position"),
    ],
)
def test_refused(make, word):
    with pytest.raises(SceneError, match=word):
        make()


def test_a_scene_with_a_gap_runs():
    """A rod that swings through a tile on the handle: the gap as the program has it against shapely."""
    z = hl.coordinate("z", unit="m", initial=Amount(0.3, "m"), rate=Amount(-0.1, "m/s"))
    k, m = hl.parameters("k m", units="N/m kg", values=(50, 0.1))
    box = Polygon(ROUND).at(x=hl.x(t), angle=0.3, name="tile")
    found = closest(box, Capsule(0.2, 0.01).at(x=0.2, y=z, angle=0.1, name="rod"))
    scene = hl.Scene(
        force=k * sp.Max(-found.gap, 0), eom=[sp.Eq(m * z.diff(t, 2), -k * z)], watch={"d": found.gap, "z": z, "s": found.slip}
    )
    log = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand(push=0.5)).run(scene, duration=0.3, method="verlet")
    rod = outlines([(-0.1, 0.0), (0.1, 0.0)], (0.2 + 0 * log.z, log.z, 0.1 + 0 * log.z))
    tile = outlines(ROUND, (log.x, 0 * log.x, 0.3 + 0 * log.x))
    assert np.abs(log.d - (signed_distance(tile, rod) - 0.01)).max() < 3e-6  # float32
    assert np.ptp(log.d) > 0.01
