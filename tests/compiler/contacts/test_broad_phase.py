"""Pairs that cannot meet are left out, and only those."""

import math

import numpy as np
import pytest
import sympy as sp
from placements import values

import hapticlab as hl
from hapticlab.compiler.algebra.first_sample import numbers
from hapticlab.compiler.contacts.broad_phase import Contacts, _sweep, check_apart, contacts_between, possible_pairs
from hapticlab.compiler.engines import engine
from hapticlab.compiler.events.taylor_method import Taylor
from hapticlab.errors import SceneError
from hapticlab.scene.contact.instant_laws import impulse, rigid
from hapticlab.scene.contact.penalty_laws import penalty
from hapticlab.scene.mechanics.lagrange import lagrange
from hapticlab.scene.notation.amount import Amount
from hapticlab.scene.shapes.gaps import gap
from hapticlab.scene.shapes.shapes import Box, Capsule, Circle, HalfPlane, Polygon, Segment, ground

t = hl.t


def ranged(name, low, high, unit="m", initial=None):
    start = (low + high) / 2 if initial is None else initial
    return hl.coordinate(name, unit=unit, range=(low, high), initial=Amount(start, unit) if unit == "m" else start)


def crowd(seed, count=6):
    """Bodies of all kinds, each in a region and a turn of its own."""
    generator = np.random.default_rng(seed)
    kinds = [Circle(0.2), Box(0.4, 0.2), Capsule(0.5, 0.1), Segment(0.5), Polygon([(0, 0), (0.5, 0.1), (0.1, 0.4)])]
    bodies, coordinates = [], []
    for k in range(count):
        x, y = generator.uniform(-1, 1, 2)
        spread = generator.uniform(0.05, 0.4)
        q = [
            ranged(f"x{k}", x - spread, x + spread), ranged(f"y{k}", y - spread, y + spread),
            ranged(f"a{k}", *sorted(generator.uniform(-3, 3, 2)), unit="rad"),
        ]  # fmt: skip
        shape = kinds[generator.integers(len(kinds))]
        if k % 3 == 2:  # an arm, whose length cannot change
            bodies.append(shape.at(x=Amount(x, "m") + Amount(spread, "m") * sp.cos(q[2]), y=q[1], angle=q[2], name=f"b{k}"))
        else:
            bodies.append(shape.at(x=q[0], y=q[1], angle=q[2], name=f"b{k}"))
        coordinates += q
    plane = HalfPlane().at(y=-0.8, angle=float(generator.uniform(-1, 1)), name="plane")
    return [*bodies, plane], coordinates


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.always("0")
def test_what_is_left_out_never_meets(seed):
    bodies, coordinates = crowd(seed)
    pairs = possible_pairs(bodies)
    named = {b.name: b for b in bodies}
    generator = np.random.default_rng(seed)
    at = {q: generator.uniform(type(q).low, type(q).high, 500) for q in coordinates}
    for q in coordinates:  # corners of the ranges too
        at[q][:100] = generator.choice([type(q).low, type(q).high], 100)
    for d in pairs.dropped:
        assert values([gap(named[d.first], named[d.second])], at)[0].min() > 0, d
    assert len(pairs.kept) + len(pairs.dropped) == len(bodies) * (len(bodies) - 1) / 2
    assert len(pairs.dropped) > 1 and len(pairs.kept) > 2
    # of the pairs that are kept most do meet: the boxes are not much too large
    meet = [values([gap(a, b)], at)[0].min() < 0.1 for a, b in pairs.kept]
    assert np.mean(meet) > 0.4


def test_sweep_finds_what_every_pair_compared_finds():
    generator = np.random.default_rng(4)
    corners = generator.uniform(0, 10, (200, 2))
    sides = generator.uniform(0, 0.8, (200, 2))
    boxes = {k: tuple((low, low + side) for low, side in zip(corners[k], sides[k], strict=True)) for k in range(200)}

    def meet(a, b):
        return all(one[0] <= other[1] and other[0] <= one[1] for one, other in zip(boxes[a], boxes[b], strict=True))

    every = {frozenset((a, b)) for a in boxes for b in range(a) if meet(a, b)}
    assert _sweep(boxes) == every and len(every) > 50


def test_reasons_are_in_words_and_ranges_are_recorded():
    q, p, a = ranged("q", 0, 1), ranged("p", 2.5, 3), hl.coordinate("a", unit="rad")
    half = Amount(0.5, "m")
    bodies = [
        ground(), Circle(0.1).at(x=q, y=0.5, name="left"), Circle(0.1).at(x=p, y=0.5, name="right"),
        Circle(0.1).at(x=q + half, y=0.5, name="ahead"), Box(0.1, 0.1).at(x=5, y=0.5, angle=a, name="post"),
        Box(1, 1).at(x=9, name="block"),
    ]  # fmt: skip
    pairs = possible_pairs(bodies, ignore=["block"])
    why = {(d.first, d.second): d.why for d in pairs.dropped}
    assert why["left", "right"] == "left stays within -0.1 <= x <= 1.1 m, right within 2.4 <= x <= 3.1 m"
    assert why["ground", "left"] == "ground stays within y <= 0 m, left within 0.4 <= y <= 0.6 m"
    assert why["left", "ahead"] == "their origins stay at least 0.5 m apart, and their radii add up to 0.2 m"
    assert why["post", "block"] == "ignored" and why["ground", "block"] == "ignored"
    assert pairs.kept == ()
    assert pairs.ranges == {q: (0.0, 1.0), p: (2.5, 3.0)}


def test_without_a_range_nothing_is_left_out():
    free, q = hl.coordinate("free", unit="m"), ranged("q", 0, 1)
    pairs = possible_pairs([Circle(0.1).at(x=free, name="one"), Circle(0.1).at(x=q, name="other")])
    assert len(pairs.kept) == 1 and not pairs.dropped
    r = hl.parameters("r", units="m", ranges=(0, 0.5), values=0.01)
    pairs = possible_pairs([Circle(r).at(x=2, name="one"), Circle(0.1).at(x=q, name="other")])
    assert pairs.dropped  # up to 0.5 m, whatever it is now
    pairs = possible_pairs([Circle(r).at(x=1.4, name="one"), Circle(0.1).at(x=q, name="other")])
    assert pairs.kept


def test_the_handle_has_a_range_too():
    q = ranged("q", 0.5, 1)
    bodies = [Circle(0.1).at(x=hl.x(t), name="tip"), Circle(0.1).at(x=q, name="ball")]
    assert possible_pairs(bodies).kept
    known = possible_pairs(bodies, handle=(-0.1, 0.1))
    assert not known.kept and known.ranges == {q: (0.5, 1.0), hl.x(t): (-0.1, 0.1)}
    m, k = hl.parameters("m k", units="kg N/m", values=(0.1, 10))
    contacts = contacts_between([*bodies, ground(-1)], contact_law=rigid(), handle=(-0.1, 0.1), ignore=[("ball", "ground")])
    scene = hl.Scene(force=k * hl.x(t), eom=[lagrange(m * q.diff(t) ** 2 / 2, contacts=contacts)], watch=["q"])
    program = hl.compile(scene, T=1e-3, dtype="float64", method="taylor")
    felt = engine.load(program).run(3, np.array([[0.05], [0.1], [0.11]]), np.array(program.values)[:, None]).outputs[:, 0, 0]
    assert felt[:2] == pytest.approx([0.5, 1.0]) and np.isnan(felt[2])


def test_contacts_carry_gap_slip_name_and_law():
    y, a = ranged("y", 0, 1), hl.coordinate("a", unit="rad")
    k = hl.parameters("k", units="N/m")
    box = Box(0.2, 0.1).at(x=0.3, y=y, angle=a, name="box")
    (contact,) = contacts = contacts_between([box, ground()], contact_law=penalty(k=k))
    assert contact.name == "ground_box" and contact.contact_law.k == k
    at = {y: 0.2, a: 0.3, y.diff(t): 0.5, a.diff(t): -1.1}
    low = 0.2 - 0.1 * math.sin(0.3) - 0.05 * math.cos(0.3)
    assert values([contact.gap], at)[0] == pytest.approx(low, rel=1e-14)
    corner = np.array([-0.1, -0.05]) @ np.array([[math.cos(0.3), math.sin(0.3)], [-math.sin(0.3), math.cos(0.3)]])
    assert values([contacts.places[contact.name].slip], at)[0] == pytest.approx(-1.1 * corner[1], rel=1e-13)
    four = contacts_between([ground(), box], contact_law=lambda one, other: rigid(), corners=True)
    assert [c.name for c in four] == [f"ground_box_{k}" for k in (1, 2, 3, 4)]
    assert values([four[0].gap], at)[0] == pytest.approx(low, rel=1e-14)
    assert isinstance(four, Contacts) and isinstance(four + four, tuple)
    (rough,) = contacts_between([ground(), box], contact_law=impulse(e=0.5, mu=0.3))
    assert rough.slip == contacts.places["ground_box"].slip and contact.slip == 0


def test_bodies_that_start_in_each_other():
    z = hl.coordinate("z", unit="m", initial=Amount(0.097, "m"))
    ball = Circle(0.1).at(y=z, name="ball")
    with pytest.raises(SceneError, match="ground_ball: at the start the bodies overlap by 0.003 m;"):
        contacts_between([ground(), ball], contact_law=rigid())
    assert not contacts_between([ground(), ball], contact_law=rigid(), ignore=[("ball", "ground")])
    r = hl.parameters("r", units="m", ranges=(0, 1))
    bodies = [ground(), Circle(r).at(y=z, name="ball")]
    later = contacts_between(bodies, contact_law=rigid())  # r has no value yet
    check_apart(later, {"r": 0.05})
    with pytest.raises(SceneError, match="ground_ball: at the start the bodies overlap by 0.903 m"):
        check_apart(later, {"r": 1.0})
    with pytest.raises(SceneError, match="at the start the bodies overlap by 0.103 m"):
        contacts_between(bodies, contact_law=rigid(), values={"r": 0.2})
    # in touch is no overlap
    assert contacts_between([ground(), Circle(0.097).at(y=z, name="ball")], contact_law=rigid())


def test_values_that_are_bound_later_are_looked_at_when_a_scene_is_compiled():
    r, m = hl.parameters("r m", units="m kg", ranges=((0, 1), None), values=(0.1, 0.2))
    z = hl.coordinate("z", unit="m", initial=Amount(0.3, "m"))
    contacts = contacts_between([ground(), Circle(r).at(y=z, name="ball")], contact_law=penalty(k=m * Amount(1e4, "1/s^2")))
    rubbing = contacts + (hl.contact.friction(slip=z.diff(t), coulomb=m * Amount(1.0, "m/s^2"), stick_speed=Amount(1.0, "m/s")),)
    assert isinstance(rubbing, Contacts) and rubbing.ranges == contacts.ranges
    scene = hl.Scene(force=0, eom=[lagrange(m * z.diff(t) ** 2 / 2, contacts=rubbing)], watch=["z"])
    assert len(hl.compile(scene(r=0.2), T=1e-3)) > 10
    with pytest.raises(SceneError, match="ground_ball: at the start the bodies overlap by 0.1 m;"):
        hl.compile(scene(r=0.4), T=1e-3)


def test_polygons_that_rub():
    """A law with friction takes the slip of two polygons, linear in the rates as it must be."""
    x, y, a = (ranged(name, -1, 1, unit) for name, unit in (("x1", "m"), ("y1", "m"), ("a1", "rad")))
    hook = Polygon([(-1, -1), (0.5, -1), (0.5, -0.8), (-0.8, -0.8), (-0.8, 0.5), (-1, 0.5)]).at(name="hook")
    bodies = [hook, Box(0.3, 0.2).at(x=x, y=y, angle=a, name="box")]
    (contact,) = contacts_between(bodies, contact_law=impulse(e=0.5, mu=0.3))
    at = {x: 0.1, y: 0.2, a: 0.3, x.diff(t): 0.5, y.diff(t): -0.2, a.diff(t): 2.0}
    one, two = (values([contact.slip], at | {q.diff(t): s * at[q.diff(t)] for q in (x, y, a)})[0] for s in (1, 3))
    assert two == pytest.approx(3 * one, rel=1e-13) and abs(one) > 0.1


def test_numbers_at_the_first_sample():
    a = hl.coordinate("a", unit="rad", initial=0.3, rate=2)
    z = hl.coordinate("z", unit="m", initial=hl.x(hl.n) + Amount(0.5, "m"))
    k = hl.parameters("k", units="1", values=3)
    assert numbers([k * sp.sin(a), z, a.diff(t)], {}) == pytest.approx([3 * math.sin(0.3), 0.5, 2.0], rel=1e-15)
    assert numbers([hl.parameters("m", units="kg") * k], {}) is None


def test_thin_bodies_and_speeds():
    q = hl.coordinate("q", unit="m", initial=Amount(1, "m"))
    sheet, wire = Segment(1).at(angle=1.5, name="sheet"), Segment(0.1).at(x=q, name="wire")
    with pytest.warns(UserWarning, match="sheet and wire have no thickness"):
        contacts_between([sheet, wire], contact_law=rigid())
    found = contacts_between([sheet, Circle("1 mm").at(x=q, name="bead")], contact_law=rigid())
    assert found.speeds(1e-3) == {"sheet_bead": pytest.approx(2.0)}
    assert "1 contacts: sheet_bead" in str(found)


@pytest.mark.parametrize(
    ("make", "word"),
    [
        (lambda a, b: possible_pairs([a, b], ignore=["c"]), "c: no such body"),
        (lambda a, b: contacts_between([a, a], contact_law=rigid()), "two bodies have the name one;"),
        (lambda a, b: contacts_between([a, Circle(1)], contact_law=rigid()), "not a shape with a position"),
        (lambda a, b: contacts_between([a, b], contact_law=3), "contact_law = 3"),
    ],
)
def test_refused(make, word):
    q = hl.coordinate("q", unit="m", initial=Amount(3, "m"))
    with pytest.raises(SceneError, match=word):
        make(Circle(1).at(name="one"), Circle(1).at(x=q, name="other"))


def falling(shape, method, ticks):
    """Energy and gap of a body that falls on a tile and bounces about, elastic all along; and the instructions."""
    x, y = (hl.coordinate(name, unit="m", initial=Amount(value, "m")) for name, value in (("x1", 0.02), ("y1", 0.38)))
    a = hl.coordinate("a1", unit="rad", initial=0.3, rate=Amount(2.0, "rad/s"))
    m, J, g, k = hl.parameters("m J g k", units="kg kg*m^2 m/s^2 N/m", values=(0.1, 2e-4, 9.81, 3000))
    tile = Polygon([(-0.2, 0), (0.2, 0), (0.15, 0.1), (-0.15, 0.1)]).at(y=0.2, name="tile")
    (contact,) = contacts_between([tile, shape.at(x=x, y=y, angle=a, name="rod")], contact_law=penalty(k=k), method=method)
    L = m * (x.diff(t) ** 2 + y.diff(t) ** 2) / 2 + J * a.diff(t) ** 2 / 2 - m * g * y
    fall = lagrange(L, contacts=[contact])
    depth = sp.Max(-contact.gap, 0)
    scene = hl.Scene(force=0, eom=[fall], watch={"E": fall.energy + k * depth**2 / 2, "d": contact.gap})
    program = hl.compile(scene, T=4e-4, dtype="float64")
    found = engine.load(program).run(ticks, np.zeros((ticks, 1)), np.array(program.values)[:, None])
    return *found.outputs[:, 1:, 0].T, len(program)


@pytest.mark.parametrize(
    ("shape", "method", "ticks"),
    [
        (Box(0.1, 0.06), "sample", 400),
        pytest.param(Box(0.1, 0.06), "faces", 2000, marks=pytest.mark.slow),
        pytest.param(Capsule(0.1, 0.02), "sample", 2000, marks=pytest.mark.slow),
    ],
)
@pytest.mark.wide
def test_a_fall_keeps_its_energy(shape, method, ticks):
    """The force is along the gradient of the gap, whichever corner or edge is closest, so k d^2/2 is its potential."""
    E, d, cost = falling(shape, method, ticks)
    assert d.min() < -0.003 and np.any(np.diff((d < 0).astype(int)) < 0)
    # what is left is the method's: RK4 has order 1 where the contact closes inside a step
    assert np.ptp(E) < 3e-4 * E[0]
    assert cost < (1700 if method == "sample" else 4000)


def test_a_box_lies_on_its_corners():
    """Each of the two corners below carries half the weight: m g/(2 k) deep."""
    y = hl.coordinate("y1", unit="m", initial=Amount(0.0503, "m"))
    a = hl.coordinate("a1", unit="rad", initial=0.002)
    m, J, g, k, b = hl.parameters("m J g k b", units="kg kg*m^2 m/s^2 N/m N*s/m", values=(0.2, 5e-4, 9.81, 2000, 20))
    box = Box(0.2, 0.1).at(y=y, angle=a, name="box")
    contacts = contacts_between([ground(), box], contact_law=penalty(k=k, b=b), corners=True)
    L = m * y.diff(t) ** 2 / 2 + J * a.diff(t) ** 2 / 2 - m * g * y
    total = sp.Add(*(c.force for c in contacts))
    scene = hl.Scene(force=0, eom=[lagrange(L, contacts=contacts)], watch={"y1": y, "a1": a, "N": total})
    program = hl.compile(scene, T=1e-3, dtype="float64", method="verlet")
    y_end, a_end, N = engine.load(program).run(1500, np.zeros((1500, 1)), np.array(program.values)[:, None]).outputs[-1, 1:, 0]
    assert y_end == pytest.approx(0.05 - 0.2 * 9.81 / (2 * 2000), abs=1e-9)
    assert abs(a_end) < 1e-9 and N == pytest.approx(0.2 * 9.81, rel=1e-6)


def bouncing(shape, ticks):
    """Energy and gap of a body that bounces on a tilted tile by impulses that keep the energy, located in the step."""
    x, y = (hl.coordinate(name, unit="m", initial=Amount(value, "m")) for name, value in (("x1", 0.02), ("y1", 0.31)))
    a = hl.coordinate("a1", unit="rad", initial=0.3, rate=Amount(2.0, "rad/s"))
    m, J, g = hl.parameters("m J g", units="kg kg*m^2 m/s^2", values=(0.1, 2e-4, 9.81))
    bodies = [Box(0.4, 0.1).at(y=0.2, angle=0.2, name="tile"), shape.at(x=x, y=y, angle=a, name="body")]
    contacts = contacts_between(bodies, contact_law=impulse(e=1))
    L = m * (x.diff(t) ** 2 + y.diff(t) ** 2) / 2 + J * a.diff(t) ** 2 / 2 - m * g * y
    fall = lagrange(L, contacts=contacts)
    scene = hl.Scene(force=0, eom=[fall], watch={"E": fall.energy, "d": contacts[0].gap})
    program = hl.compile(scene, T=1e-3, dtype="float64", method=Taylor(order=6, events=1), live="m")
    return engine.load(program).run(ticks, np.zeros((ticks, 1)), np.array(program.values)[:, None]).outputs[:, 1:3, 0].T


@pytest.mark.wide
def test_impulses_between_a_disc_and_a_tile():
    E, d = bouncing(Circle(0.04), 250)
    assert np.ptp(E) < 1e-9 * E[0]
    assert d.min() > -1e-9 and np.sum(np.diff(np.sign(np.diff(d))) > 0) >= 2  # it turns between samples


@pytest.mark.slow
def test_impulses_between_a_box_and_a_tile():
    E, d = bouncing(Box(0.1, 0.06), 300)
    assert np.ptp(E) < 1e-9 * E[0]
    assert d.min() > -1e-9 and np.sum(np.diff(np.sign(np.diff(d))) > 0) >= 2
