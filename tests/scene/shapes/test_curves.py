"""Closest points of curves, tracked by their own equations of motion."""

import math

import numpy as np
import pytest
import shapely
import sympy as sp
from placements import values

import hapticlab as hl
from hapticlab.compiler.engines import engine
from hapticlab.errors import SceneError, UnitsError
from hapticlab.scene.notation.amount import Amount
from hapticlab.scene.notation.units import unit_of
from hapticlab.scene.shapes.curves import Curve, track
from hapticlab.scene.shapes.gaps import gap
from hapticlab.scene.shapes.shapes import Box, Circle, ground

t = hl.t
a, b, c, d = hl.parameters("a b c d", units="m m m m", values=(0.1, 0.05, 0.04, 0.08))
q = hl.coordinate("q", unit="m", initial=Amount(0.3, "m"), rate=Amount(-0.03, "m/s"))
th = hl.coordinate("th", unit="rad", initial=0.4, rate=Amount(1.3, "rad/s"))
ph = hl.coordinate("ph", unit="rad", initial=1.4, rate=Amount(-2.6, "rad/s"))
FREE = [sp.Eq(body.diff(t, 2), 0) for body in (th, ph, q)]
CAM = Curve(lambda u: (a * sp.cos(u), b * sp.sin(u)))
EGG = Curve(lambda u: (c * sp.cos(u), d * sp.sin(u)))
DENSE = np.linspace(0, 2 * np.pi, 3000, endpoint=False)


def run(scene, ticks, T=1e-3, **options):
    program = hl.compile(scene, T=T, dtype="float64", **options)
    found = engine.load(program).run(ticks, np.zeros((ticks, 1)), np.array(program.values)[:, None])
    return dict(zip((channel.name for channel in program.outputs), found.outputs[:, :, 0].T, strict=True))


def ellipse(across, up, pose):
    """Points of an ellipse in its place, by angle."""
    x, y, angle = pose
    u, v = across * np.cos(DENSE), up * np.sin(DENSE)
    return np.stack([x + u * np.cos(angle) - v * np.sin(angle), y + u * np.sin(angle) + v * np.cos(angle)], -1)


def distance(one, other):
    return shapely.distance(shapely.Polygon(one), shapely.Polygon(other))


@pytest.fixture(scope="module")
def two_ellipses():
    tracked = track(CAM.at(angle=th, name="cam"), EGG.at(x=q, y=0.02, angle=ph, name="egg"))
    k = hl.parameters("k", units="N/m", values=1)
    u, w = tracked.coordinates
    watch = {"d": tracked.gap, "rate_1": tracked.rate, "u": u, "w": w, "th": th, "ph": ph, "q": q}
    watch |= {"p_x": tracked.point[0], "p_y": tracked.point[1], "n_x": tracked.normal[0], "s": tracked.slip}
    scene = hl.Scene(force=k * tracked.gap, eom=[*FREE, *tracked.eom], watch=watch)
    return tracked, run(scene, 700)


def test_two_ellipses_that_turn(two_ellipses):
    _, log = two_ellipses
    for k in range(0, 700, 70):
        cam, egg = ellipse(0.1, 0.05, (0, 0, log["th"][k])), ellipse(0.04, 0.08, (log["q"][k], 0.02, log["ph"][k]))
        # the polygon of 3000 points lies within 0.1 (pi/3000)^2/2 = 6e-8 m of its ellipse
        assert log["d"][k] == pytest.approx(distance(cam, egg), abs=1.2e-7)
        assert shapely.distance(shapely.Polygon(egg), shapely.Point(log["p_x"][k], log["p_y"][k])) < 1.2e-7
    assert np.ptp(log["d"]) > 0.03 and np.ptp(log["u"]) > 0.2


def test_it_stays_on_the_minimum(two_ellipses):
    """What RK4 at T = 1 ms loses moves u by 1e-8, and the distance, which is stationary, by its square."""
    _, log = two_ellipses
    u, w, turned, other = log["u"], log["w"], log["th"], log["ph"]

    def at(across, up, s, angle, x=0, y=0):
        p = np.array([across * np.cos(s), up * np.sin(s)])
        dp = np.array([-across * np.sin(s), up * np.cos(s)])
        R = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        return np.einsum("ijk,jk->ik", R, p) + [x + 0 * s, y + 0 * s], np.einsum("ijk,jk->ik", R, dp)

    (one, done), (two, dtwo) = at(0.1, 0.05, u, turned), at(0.04, 0.08, w, other, log["q"], 0.02)
    assert np.abs(((two - one) * done).sum(0)).max() < 2e-10
    assert np.abs(((two - one) * dtwo).sum(0)).max() < 2e-10


def test_rate_is_that_of_the_gap(two_ellipses):
    tracked, log = two_ellipses
    differences = (log["d"][2:] - log["d"][:-2]) / 2e-3
    # second differences of the rate bound the error of a central difference
    assert np.abs(log["rate_1"][1:-1] - differences).max() < 1e-5
    assert [unit_of(e) for e in (tracked.gap, tracked.rate, tracked.slip)] == ["m", "m/s", "m/s"]


def test_a_start_beside_the_minimum_is_pulled_to_it():
    """With initial values moved by hand the residual decays at the rate asked for."""
    z = hl.coordinate("z", unit="m", initial=Amount(0.2, "m"))
    tracked = track(CAM.at(), Circle(0).at(x=0.05, y=z), correction=Amount(5, "1/s"))
    (u,) = tracked.coordinates
    moved = hl.coordinate("u", unit="1", initial=type(u).initial + 0.01)
    swap = {u: moved, u.diff(t): moved.diff(t)}
    eom = [sp.Eq(z.diff(t, 2), 0), *(e.xreplace(swap) for e in tracked.eom)]
    log = run(hl.Scene(force=0, eom=eom, watch={"u": moved}), 1300)
    final = log["u"][-1]
    left = -(0.05 - 0.1 * np.cos(log["u"])) * -0.1 * np.sin(log["u"]) - (0.2 - 0.05 * np.sin(log["u"])) * 0.05 * np.cos(log["u"])
    steps = np.array([0, 400, 800, 1200])
    assert left[steps] / left[0] == pytest.approx(np.exp(-5 * steps * 1e-3), rel=1e-9)
    assert final == pytest.approx(float(type(u).initial), abs=1e-4)


def test_a_circle_has_a_closed_form_and_overlap_a_sign():
    """Two round curves: the gap is the distance of the centres less the radii, in overlap too."""
    z = hl.coordinate("z", unit="m", initial=Amount(0.2, "m"), rate=Amount(-0.1, "m/s"))
    wheel = Curve(lambda u: (a * sp.cos(u), a * sp.sin(u)))
    tracked = track(wheel.at(name="wheel"), Circle("2 cm").at(x=0.06, y=z, name="ball"))
    log = run(hl.Scene(force=0, eom=[sp.Eq(z.diff(t, 2), 0), *tracked.eom], watch={"d": tracked.gap, "z": z}), 1200)
    assert np.abs(log["d"] - (np.hypot(0.06, log["z"]) - 0.12)).max() < 1e-13
    assert log["d"].min() < -0.01


def test_the_start_is_the_nearest_of_several_minima():
    """A point inside the reach of two lobes: what is found is the global minimum."""
    trefoil = Curve(lambda u: ((a + b * sp.cos(3 * u)) * sp.cos(u), (a + b * sp.cos(3 * u)) * sp.sin(u)))
    z = hl.coordinate("z", unit="m")
    r = 0.1 + 0.05 * np.cos(3 * DENSE)
    shape = shapely.Polygon(np.stack([r * np.cos(DENSE), r * np.sin(DENSE)], -1))
    for x, y in ((0.2, 0.05), (-0.05, -0.15)):
        tracked = track(trefoil.at(x=z), Circle(0).at(x=x, y=y))
        at = {z: 0.0, a: 0.1, b: 0.05, tracked.coordinates[0]: float(type(tracked.coordinates[0]).initial)}
        assert values([tracked.gap], at)[0] == pytest.approx(shape.distance(shapely.Point(x, y)), abs=1e-6)


def test_a_cam_is_felt():
    """A follower on a spring rides a cam that the handle turns; its lift is that of the closed form."""
    wheel = Curve(lambda u: (a * sp.cos(u), a * sp.sin(u)))
    z = hl.coordinate("z", unit="m", initial=Amount(0.13, "m"))
    turn = hl.x(t) / Amount(0.1, "m")
    off = wheel.at(x=b * sp.cos(turn) / 5, y=b * sp.sin(turn) / 5, angle=turn, name="cam")
    tracked = track(off, Circle("1 cm").at(x=0.03, y=z, name="follower"))
    k, m, g = hl.parameters("k m g", units="N/m kg m/s^2", values=(2000, 0.05, 9.81))
    push = k * sp.Max(-tracked.gap, 0)
    scene = hl.Scene(
        force=push * tracked.normal[0], eom=[sp.Eq(m * z.diff(t, 2), push * tracked.normal[1] - m * g), *tracked.eom],
        watch={"d": tracked.gap, "z": z},
    )  # fmt: skip
    log = hl.SimulatedPaddle(m=0.1, b=0.5, T=1e-3, hand=hl.Hand(push=0.3)).run(scene, duration=0.4)
    centre = 0.01 * np.cos(log.x / 0.1), 0.01 * np.sin(log.x / 0.1)
    assert np.abs(log.d - (np.hypot(0.03 - centre[0], log.z - centre[1]) - 0.11)).max() < 3e-6  # float32
    assert log.d.min() < 0 < np.ptp(log.x)


def test_a_cam_and_an_egg_collide_and_keep_their_energy():
    """A law with the tracked gap as its potential: what the cam loses the egg has."""
    m, J, k = hl.parameters("m J k", units="kg kg*m^2 N/m", values=(0.2, 4e-4, 20_000))
    y, turn, other = (
        hl.coordinate("y1", unit="m", initial=Amount(0.16, "m"), rate=Amount(-0.5, "m/s")),
        hl.coordinate("a1", unit="rad", initial=0.3),
        hl.coordinate("a2", unit="rad", initial=0.9),
    )
    found = track(CAM.at(angle=turn, name="cam"), EGG.at(x=0.02, y=y, angle=other, name="egg"))
    law = hl.contact.penalty(k=k)
    L = m * y.diff(t) ** 2 / 2 + J * (turn.diff(t) ** 2 + other.diff(t) ** 2) / 2
    motion = hl.mechanics.lagrange(L, forces={c: found.generalized_force(law, c) for c in (y, turn, other)})
    depth = sp.Max(-found.gap, 0)
    watch = {"E": motion.energy + k * depth**2 / 2, "d": found.gap, "spin": turn.diff(t)}
    log = run(hl.Scene(force=0, eom=[motion, *found.eom], watch=watch), 1300, T=1e-4)
    assert log["d"].min() < -5e-4 and log["d"][-1] > 0.001 and abs(log["spin"][-1]) > 0.5
    # what is left is the method's, where the contact closes inside a step: 1e-6 at T = 25 us
    assert np.ptp(log["E"]) < 2e-4 * log["E"][0]


def landing(law, by):
    """A ball that lands on a cam, by the force of the tracked curves or by a contact with their gap."""
    m, g = hl.parameters("m g", units="kg m/s^2", values=(0.05, 9.81))
    z = hl.coordinate("z", unit="m", initial=Amount(0.08, "m"))
    found = track(CAM.at(name="cam"), Circle(0.01).at(x=0.02, y=z))
    L = m * z.diff(t) ** 2 / 2 - m * g * z
    if by == "force":
        motion = hl.mechanics.lagrange(L, forces={z: found.generalized_force(law, z)})
    else:
        motion = hl.mechanics.lagrange(L, contacts=[hl.contact.Contact(found.gap, law, name="lands")])
    return hl.Scene(force=0, eom=[motion, *found.eom], watch={"z": z, "d": found.gap})


def test_the_gap_of_tracked_curves_makes_a_contact():
    own, contact = (run(landing(hl.contact.penalty(k="2000 N/m"), by), 400, method="rk4") for by in ("force", "contact"))
    assert own["d"].min() < -1e-3 and own["d"].max() > 0.01  # it lands, and is thrown up again
    np.testing.assert_allclose(contact["z"], own["z"], rtol=0, atol=1e-12)


@pytest.mark.parametrize(
    ("law", "word"),
    [
        (hl.contact.penalty(k="2000 N/m", b="0.5 N s/m"), "damps with the rate of the gap.* forces={q: found.generalized_force"),
        (hl.contact.impulse(e=0.5), "needs the acceleration of the gap. Use a penalty law"),
        (hl.contact.micro_impulse(e=0.5), "needs the acceleration of the gap. Use a penalty law"),
    ],
)
def test_a_tracked_gap_under_a_law_that_cannot_know_its_rate_is_refused(law, word):
    with pytest.raises(SceneError, match=f"lands: its gap contains u, which has an equation of first order, .*{word}"):
        hl.compile(landing(law, "contact"), T=1e-3)


@pytest.mark.parametrize(
    ("make", "word"),
    [
        (lambda: track(CAM.at(name="cam"), EGG.at(x=q, name="egg"), near=(0.1, 3.0)), "not where they are closest"),
        (
            lambda: track(CAM.at(name="cam"), Circle(0).at(x=q), near=math.pi),
            r"is not a minimum \(its second derivative there has",
        ),
        (lambda: track(CAM.at(name="cam"), Circle(0.01).at(y=q / 10), near=(0.0, 1.0)), "needs 1 numbers"),
        (lambda: track(CAM.at(name="cam"), Circle(0.3).at(x=q)), "touch or overlap at the start"),
        (lambda: track(CAM.at(), Circle(0.001).at(x=q / 100, y=0.001)), "overlap at the start|not a minimum"),
        (lambda: track(Curve(lambda u: (a * sp.cos(u), -b * sp.sin(u))).at(), Circle(0.01).at(x=q)), "clockwise"),
        (lambda: track(CAM.at(), EGG.at(x=q / 4)), "touch or overlap at the start|not a minimum"),
        (lambda: track(CAM.at(), Box(1, 1).at(x=q)), "track needs a Curve,"),
        (lambda: track(CAM.at(), ground()), "track needs a Curve,"),
        (lambda: gap(CAM.at(name="cam"), Circle(0).at(x=q)), "cam is a curve"),
        (lambda: track(CAM, CAM.at()), "not a shape with a position"),
        (lambda: track(CAM.at(), Circle(hl.parameters("r", units="m", ranges=(0, 1))).at(x=q)), "without a value"),
        (lambda: Curve(lambda u: a * u), "gives \\(x, y\\)"),
        (lambda: Curve(lambda u: (sp.cos(u), sp.sin(u))), "point of the curve"),
        (lambda: track(CAM.at(), Circle(0).at(x=q), correction=a), "correction of tracking"),
    ],
)
def test_refused(make, word):
    with pytest.raises((SceneError, UnitsError), match=word):
        make()
