"""Shapes: checked when they are made, split where they are not convex, placed and moved as rigid bodies."""

import math

import numpy as np
import pytest
import shapely
import sympy as sp
from placements import values

import hapticlab as hl
from hapticlab.errors import SceneError, UnitsError
from hapticlab.scene.notation.amount import Amount, amount, number_of
from hapticlab.scene.notation.units import unit_of
from hapticlab.scene.shapes.gaps import closest
from hapticlab.scene.shapes.polygons import convex_parts, outline, width
from hapticlab.scene.shapes.shapes import Box, Capsule, Circle, HalfPlane, Polygon, Segment, generalized, ground, replacement

t = hl.t
q = hl.coordinate("q", unit="m")
p = hl.coordinate("p", unit="m")
a = hl.coordinate("a", unit="rad")


def star(generator, corners):
    """A simple polygon that is not convex: corners at random distances around a point."""
    angles = np.sort(generator.uniform(0, 2 * np.pi, corners))
    radii = generator.uniform(0.2, 1.0, corners)
    return [(float(r * np.cos(b)), float(r * np.sin(b))) for r, b in zip(radii, angles, strict=True)]


SPIRAL = [(0, 0), (6, 0), (6, 6), (1, 6), (1, 2), (4, 2), (4, 4), (3, 4), (3, 3), (2, 3), (2, 5), (5, 5), (5, 1), (0, 1)]
COMB = [(0, 0), (7, 0), (7, 3), (6, 3), (6, 1), (5, 1), (5, 3), (4, 3), (4, 1), (3, 1), (3, 3), (0, 3)]


def turn(one, two, three):
    return (two[0] - one[0]) * (three[1] - two[1]) - (two[1] - one[1]) * (three[0] - two[0])


@pytest.mark.parametrize("k", range(20))
def test_convex_parts_cover_a_polygon_once(k):
    generator = np.random.default_rng(k)
    points = [SPIRAL, COMB][k] if k < 2 else star(generator, 4 + k)
    parts = Polygon(points).parts
    whole = shapely.Polygon(points)
    assert all(turn(part[i - 2], part[i - 1], part[i]) > 0 for part in parts for i in range(len(part)))
    pieces = [shapely.Polygon(part) for part in parts]
    assert sum(piece.area for piece in pieces) == pytest.approx(whole.area, rel=1e-12)
    assert shapely.union_all(pieces).symmetric_difference(whole).area < 1e-9 * whole.area
    corners = outline(points)
    reflex = sum(turn(corners[i - 2], corners[i - 1], corners[i]) < 0 for i in range(len(corners)))
    # Hertel and Mehlhorn: at most two cuts that must stay at each reflex corner
    assert math.ceil(reflex / 2) + 1 <= len(parts) <= 2 * reflex + 1


def test_outline_is_counter_clockwise_and_without_what_adds_nothing():
    square = ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0))
    assert outline(square) == outline(square[::-1]) == outline(square[2:] + square[:2]) == square
    close = outline([(0, 0), (0, 0), (0.5, 0), (1, 0), (1, 1 - 1e-13), (1, 1), (0, 1), (0, 1e-12)])
    assert np.allclose(close, square, rtol=0, atol=2e-12)
    assert convex_parts(square) == (square,)


@pytest.mark.parametrize(
    ("points", "word"),
    [
        ([(0, 0), (1, 1), (1, 0), (0, 1)], "cross or touch"),
        ([(0, 0), (2, 0), (2, 1), (1, 0), (0, 1)], "cross or touch"),
        ([(0, 0), (1, 0), (2, 0)], "cross or touch|one line"),
        ([(0, 0), (1, 0), (0, 0)], "at least three"),
        ([(0, 0), (1, 0)], "at least three"),
        ([(0, 0)] * 5, "at least three"),
        ([], "list of corners"),
        (3, "list of corners"),
        ([(0, 0), (1, 0, 0), (1, 1)], "list of corners"),
        ([(0, 0), (1, 0), (math.inf, 1)], "list of corners"),
        ([(0, 0), (1, 0), (math.nan, 1)], "list of corners"),
    ],
)
def test_no_polygon(points, word):
    with pytest.raises(SceneError, match=word):
        Polygon(points)


def test_corners_take_units():
    assert Polygon([(0, 0), ("10 mm", 0), (0, "2 cm")]).points == ((0.0, 0.0), (0.01, 0.0), (0.0, 0.02))
    with pytest.raises(UnitsError, match="corner 2"):
        Polygon([(0, 0), ("10 N", 0), (0, 1)])


@pytest.mark.parametrize(
    ("make", "word"),
    [
        (lambda: Circle(-0.1), "radius of a Circle = -0.1 m; a length needs >= 0"),
        (lambda: Box(0, 1), "width of a Box = 0 m; a length needs > 0"),
        (lambda: Capsule("10 mm", 0), "radius of a Capsule"),
        (lambda: Segment(float("nan")), "finite"),
        (lambda: Circle(hl.parameters("r", units="m")), "may be negative"),
        (lambda: Circle(hl.parameters("k", units="N/m")), "N/m"),
        (lambda: Circle(1).at(x=hl.parameters("k", units="N/m")), "N/m"),
        (lambda: Circle(1).at(angle=q), "angle of circle"),
        (lambda: Circle(1).at(name="two words"), "one word"),
        (lambda: Circle(1).at(x=[1]), "x of circle"),
    ],
)
def test_refused(make, word):
    with pytest.raises(SceneError, match=word):
        make()


def test_thickness_is_the_least_width():
    assert [number_of(s.thickness) for s in (Circle(0.1), Capsule(1, 0.1), Segment(1), Box(3, 0.2))] == [0.2, 0.2, 0, 0.2]
    corners = [(0, 0), (3, 1), (2, 4)]
    altitude = 2 * shapely.Polygon(corners).area / max(math.dist(u, v) for u in corners for v in corners)
    assert width(outline(corners)) == pytest.approx(altitude, rel=1e-15)
    assert HalfPlane().thickness == sp.oo


def test_a_point_of_a_body_moves_as_a_rigid_body():
    body = Box(1, 1).at(x=q * sp.cos(a), y=p, angle=2 * a + hl.x(t) / Amount(0.3, "m"))
    point = body.point(Amount(0.2, "m"), Amount(-0.4, "m"))
    rates = {q: 0.3, p: -0.2, a: 0.7, hl.x(t): -0.5}
    at = {q: 0.1, p: 0.2, a: 0.9, hl.x(t): 0.05}
    h = 1e-6
    late, early = (values(point, {c: at[c] + side * h * rates[c] for c in at}) for side in (1, -1))
    seen = at | {q.diff(t): 0.3, p.diff(t): -0.2, a.diff(t): 0.7, hl.v(t): -0.5}
    velocity = body.velocity(point)
    assert values(velocity, seen) == pytest.approx((np.array(late) - early) / (2 * h), abs=1e-9)
    assert [unit_of(v) for v in velocity] == ["m/s", "m/s"]


def test_replacement_has_the_power_of_the_forces():
    body = Box(1, 1).at(x=q, y=q * sp.sin(a), angle=p / Amount(0.5, "m") - a)
    F = hl.parameters("F_1 F_2 F_3 F_4", units="N N N N", values=(3, -2, 0.5, 7))
    forces = [((F[0], F[1]), body.point(Amount(0.3, "m"), sp.S.Zero)), ((F[2], F[3]), body.point(sp.S.Zero, Amount(-0.2, "m")))]
    F_x, F_y, couple = replacement(body, forces)
    assert unit_of(couple) == "N*m"
    power = sum(f[0] * body.velocity(at)[0] + f[1] * body.velocity(at)[1] for f, at in forces)
    dx, dy = body.velocity((body.x, body.y))
    by_resultant = F_x * dx + F_y * dy + couple * body.turning
    by_coordinates = sum(generalized(body, F_x, F_y, couple, c).doit() * c.diff(t) for c in (q, p, a))
    at = {q: 0.4, p: 0.1, a: -0.6, q.diff(t): 1.1, p.diff(t): -0.3, a.diff(t): 0.8} | {f: f.value for f in F}
    one, two, three = values([power, by_resultant, by_coordinates], at)
    assert one == pytest.approx(two, rel=1e-13) == pytest.approx(three, rel=1e-13)
    assert abs(one) > 1


def test_a_contact_force_does_what_its_gap_says():
    body, other = Box(0.4, 0.2).at(x=q, y=p, angle=a), Circle(0.05).at(x=0.3, y=0.2)
    found = closest(other, body)
    force = hl.parameters("N", units="N", values=4.0)
    F_x, F_y, couple = replacement(body, [found.force(force)])
    at = {q: 0.1, p: 0.05, a: 0.3, force: 4.0}
    for c in (q, p, a):
        h = 1e-6
        late, early = (values([found.gap], at | {c: at[c] + side * h})[0] for side in (1, -1))
        here = values([generalized(body, F_x, F_y, couple, c).doit()], at)[0]
        assert here == pytest.approx(4.0 * (late - early) / (2 * h), abs=1e-8)


def test_amounts_are_numbers_with_a_unit():
    five = Amount(0.005, "m")
    assert str(five + q) in ("q(t) + (0.005 m)", "(0.005 m) + q(t)")
    assert unit_of(2 * five) == "m"
    assert five.diff(q) == 0 and five.evalf() == 0.005 and not five.is_zero and five.is_positive
    assert sp.latex(five) == r"0.005\,\mathrm{m}"
    assert amount("5 mm", "m", "r") == five and amount(0, "m", "r") == 0
    assert amount(math.pi, "rad", "angle") == sp.pi and amount(sp.Rational(1, 2), "m", "r") == Amount(0.5, "m")
    scene = hl.Scene(force=hl.parameters("k", units="N/m", values=2) * (hl.x(hl.n) + five))
    program = hl.compile(scene, T=1e-3)
    assert any(i.op == "const" and abs(i.value - 0.005) < 1e-9 for i in program.tick.instructions)


def test_ground_and_walls():
    assert ground(0.5, name="table").y == Amount(0.5, "m")
    wall = HalfPlane().at(x=0.1, angle=math.pi / 2)
    assert wall.direction(sp.S.Zero, sp.S.One) == (-1, 0)
