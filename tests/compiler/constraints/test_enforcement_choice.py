"""The choice of how constraints are enforced, and what is refused, in the student's words."""

import math

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import t
from hapticlab.compiler.constraints.enforcement import Closed, Multipliers, Partitioned
from hapticlab.compiler.constraints.enforcement_choice import enforcement
from hapticlab.compiler.methods.method_table import METHODS
from hapticlab.errors import MassError, SceneError

theta, phi = hl.coordinate("theta", unit="rad"), hl.coordinate("phi", unit="rad")
s, X, Y = (hl.coordinate(name, unit="m") for name in ("s", "X", "Y"))
SLIDER_CRANK = (
    0.03 * sp.cos(theta) + 0.1 * sp.cos(phi) - s,
    0.03 * sp.sin(theta) - 0.1 * sp.sin(phi),
)
COORDINATES = (phi, s, theta)
SEMI = METHODS["semi_implicit_euler"]


def start(rate=2.0):
    angle = math.asin(0.3 * math.sin(0.7))
    turning = 0.3 * math.cos(0.7) / math.cos(angle) * rate
    return {
        theta: 0.7, phi: angle, s: 0.03 * math.cos(0.7) + 0.1 * math.cos(angle), theta.diff(t): rate,
        phi.diff(t): turning, s.diff(t): -0.03 * math.sin(0.7) * rate - 0.1 * math.sin(angle) * turning, t: 0.0,
    }  # fmt: skip


def four_bar(crank, coupler, rocker, ground):
    q2, q3, q4 = (hl.coordinate(name, unit="rad") for name in ("q2", "q3", "q4"))
    return (q2, q3, q4), (
        crank * sp.cos(q2) + coupler * sp.cos(q3) - rocker * sp.cos(q4) - ground,
        crank * sp.sin(q2) + coupler * sp.sin(q3) - rocker * sp.sin(q4),
    )


def test_a_loop_is_closed_where_it_can_be_and_the_program_says_so():
    found, (note,) = enforcement(SLIDER_CRANK, COORDINATES, start())
    assert isinstance(found, Closed)
    assert found.second == (theta,)
    assert note == "phi, s in closed form, driven by theta: no drift"


def test_only_what_takes_part_is_said_to_drive():
    A, om = hl.parameters("A om", units="m 1/s")
    at = {X: 0.0, Y: 0.0, s: 0.0, A: 0.01, om: 30.0, t: 0.0, hl.x(t): 0.0}
    for constraints, said in (
        ([Y - A * sp.sin(om * t)], "Y in closed form, driven by time"),
        ([Y - hl.x(t)], "Y in closed form, driven by the handle"),
        ([Y - 2 * X], "Y in closed form, driven by X"),
        ([Y - 2 * X - A * sp.sin(om * t)], "Y in closed form, driven by X, time"),
        ([Y - X, X - hl.x(t)], "X, Y in closed form, driven by the handle"),
        ([Y], "Y in closed form, held still"),
    ):
        _, (note,) = enforcement(constraints, (X, Y, s), at)
        assert note == f"{said}: no drift"
    turning = (*SLIDER_CRANK, theta - sp.asin(0.5) - om * t)
    angle = math.asin(0.3 * 0.5)
    begin = {
        theta: math.pi / 6, phi: angle, s: 0.03 * math.cos(math.pi / 6) + 0.1 * math.cos(angle), X: 0.0, om: 30.0, t: 0.0,
        theta.diff(t): 0.0, phi.diff(t): 0.0, s.diff(t): 0.0, X.diff(t): 0.0,
    }  # fmt: skip
    _, (note,) = enforcement(turning, (*COORDINATES, X), begin)
    assert "driven by time: no drift" in note and "X" not in note


def test_what_has_no_closed_form_takes_multipliers_and_says_why():
    found, (note,) = enforcement((X**2 + Y**2 - 0.01,), (X, Y), {X: 0.06, Y: -0.08})
    assert isinstance(found, Multipliers)
    assert found.alpha is None
    assert "one projection per tick: X has no declared range" in note
    with pytest.raises(SceneError, match="no closed form.*enforce='auto' or 'kkt'"):
        enforcement((X**2 + Y**2 - 0.01,), (X, Y), {X: 0.06, Y: -0.08}, enforce="embed")


def test_each_way_can_be_asked_for():
    numeric, (note,) = enforcement(SLIDER_CRANK, COORDINATES, start(), enforce="numeric")
    assert isinstance(numeric, Partitioned)
    # the rod and the slider follow the crank everywhere; no other pair does
    assert numeric.first == (phi, s)
    assert "Newton" in note
    fed_back, (note,) = enforcement(SLIDER_CRANK, COORDINATES, start(), enforce="baumgarte", method=SEMI, h=1e-3)
    assert fed_back.alpha == pytest.approx((math.sqrt(2) - 1) / 1e-3)
    assert "alpha = 414.2 1/s" in note
    with pytest.raises(SceneError, match=r"alpha = 900 1/s.*alpha < 828\.4"):
        enforcement(SLIDER_CRANK, COORDINATES, start(), enforce="baumgarte", alpha=900.0, method=SEMI, h=1e-3)
    with pytest.raises(SceneError, match=r"dead centre, at X = -0\.1, Y = 0\b|dead centre, at X = 0, Y = "):
        enforcement((X**2 + Y**2 - 0.01,), (X, Y), {X: 0.06, Y: -0.08}, enforce="numeric")


def test_a_massless_coordinate_is_given_the_constraints_weight():
    massive, _ = enforcement(SLIDER_CRANK, COORDINATES, start(), enforce="kkt", M=np.diag([1e-5, 0.1, 2e-5]))
    assert massive.weight == 0
    massless, _ = enforcement(SLIDER_CRANK, COORDINATES, start(), enforce="kkt", M=np.diag([0, 0.1, 2e-5]))
    assert massless.weight > 0
    with pytest.raises(MassError, match="not symmetric"):
        enforcement(SLIDER_CRANK, COORDINATES, start(), enforce="kkt", M=np.diag([1e-5, 0.1, 2e-5]) + np.eye(3, k=1) * 1e-5)
    with pytest.raises(MassError, match="neither masses nor constraints determine the acceleration of Y"):
        enforcement((X - s,), (X, Y, s), {X: 0.1, Y: 0.0, s: 0.1}, enforce="kkt", M=np.diag([0.1, 0.0, 0.1]))


@pytest.mark.parametrize("enforce", ["auto", "kkt", "numeric"])
def test_a_start_off_the_constraints(enforce):
    said = r"start .*phi = 0\.2.* does not satisfy the constraint.*0\.00054.* phi = 0\.19\d+ rad"
    with pytest.raises(SceneError, match=said):
        enforcement(SLIDER_CRANK, COORDINATES, start() | {phi: 0.2}, enforce=enforce)


def test_the_closest_start_is_on_the_constraints():
    with pytest.raises(SceneError) as caught:
        enforcement(SLIDER_CRANK, COORDINATES, start() | {phi: 0.2}, enforce="kkt")
    told = str(caught.value).split("them is ")[1]
    given = {part.split()[0]: float(part.split()[2]) for part in told.split(", ")}
    at = {q: given[type(q).__name__] for q in COORDINATES}
    assert max(abs(g.subs(at)) for g in SLIDER_CRANK) < 1e-15


def test_rates_that_break_the_constraints():
    with pytest.raises(
        SceneError,
        match=r"rates at the start violate the constraints.*change at 0.00904, 0\.0459 per second.* phi = 0\.44\d+ rad/s",
    ):
        enforcement(SLIDER_CRANK, COORDINATES, start() | {phi.diff(t): 0.0}, enforce="kkt")
    # rates that follow from the driver need not be given, but must not be wrong
    enforcement(SLIDER_CRANK, COORDINATES, start() | {phi.diff(t): 0.0})
    with pytest.raises(SceneError, match=r"phi = 0\.46\d+ rad/s"):
        enforcement(SLIDER_CRANK, COORDINATES, start() | {phi.diff(t): 0.1})


def test_a_constraint_of_rates():
    knife = (X.diff(t) * sp.sin(theta) - Y.diff(t) * sp.cos(theta),)
    along = {X: 0.0, Y: 0.0, theta: 0.3, X.diff(t): math.cos(0.3), Y.diff(t): math.sin(0.3), theta.diff(t): 1.0}
    found, (note,) = enforcement(knife, (X, Y, theta), along)
    assert isinstance(found, Multipliers)
    assert "a constraint on rates has none" in note
    with pytest.raises(SceneError, match=r"X = 0\.91266\d+ m/s, Y = 0\.28232\d+ m/s"):
        enforcement(knife, (X, Y, theta), along | {X.diff(t): 1.0, Y.diff(t): 0.0})
    with pytest.raises(SceneError, match="not linear in the rates"):
        enforcement((X.diff(t) ** 2 - 1,), (X, Y), {X: 0.0, Y: 0.0})
    with pytest.raises(SceneError, match="needs enforce='kkt'"):
        enforcement(knife, (X, Y, theta), along, enforce="numeric")


def test_redundant_and_contradicting_constraints_are_named():
    third = sp.expand(2 * SLIDER_CRANK[0] - SLIDER_CRANK[1])
    with pytest.raises(SceneError, match=r"redundant.*repeat each other.*Leave out one of them") as caught:
        enforcement((*SLIDER_CRANK, third), COORDINATES, start())
    assert all(str(g) in str(caught.value) for g in (*SLIDER_CRANK, third))
    with pytest.raises(SceneError, match=r"s\(t\) - 0\.1 = 0 and s\(t\) - 0\.11 = 0 cannot be satisfied together"):
        enforcement((s - 0.1, s - 0.11), (s, theta), {s: 0.1, theta: 0.0})


def test_a_change_point_is_refused_and_named_whatever_enforces():
    (q2, q3, q4), constraints = four_bar(0.06, 0.1, 0.06, 0.1)
    for enforce in ("auto", "kkt", "baumgarte"):
        with pytest.raises(SceneError, match=r"lose a rank within the range it can reach, at q2 = (0|-?3\.142|-?6\.283)"):
            enforcement(constraints, (q2, q3, q4), {q2: 0.5, q3: 0.0, q4: 0.5}, enforce=enforce, method=SEMI, h=1e-3)


def test_a_start_at_a_change_point():
    (q2, q3, q4), constraints = four_bar(0.06, 0.1, 0.06, 0.1)
    with pytest.raises(SceneError, match=r"lose a rank at the start, at q2 = 0, q3 = 0, q4 = 0"):
        enforcement(constraints, (q2, q3, q4), {q2: 0.0, q3: 0.0, q4: 0.0})


def test_an_angle_that_winds_up_is_not_used_by_itself():
    (q2, q3, q4), constraints = four_bar(0.08, 0.06, 0.09, 0.03)
    d = 0.03 - 0.08 * np.exp(1j)
    along = (0.06**2 - 0.09**2 + abs(d) ** 2) / (2 * abs(d))
    arm = d / abs(d) * (along + 1j * math.sqrt(0.06**2 - along**2))
    at = {q2: 1.0, q3: float(np.angle(arm)), q4: float(np.angle(arm - d))}
    found, _ = enforcement(constraints, (q2, q3, q4), at, used=[sp.sin(q4) * q4.diff(t) + q2])
    assert isinstance(found, Closed)
    found, (note,) = enforcement(constraints, (q2, q3, q4), at, used=[q4**2])
    assert isinstance(found, Multipliers)
    assert "q4 turns without end, and is used outside a cosine" in note


def test_a_rank_that_a_motion_hardly_meets_is_noted():
    links = [hl.coordinate(f"a{k}", unit="rad") for k in range(5)]
    lengths = (0.1, 0.1, 0.1, 0.1, 0.2)
    closed = tuple(sum(length * turn(q) for length, q in zip(lengths, links, strict=True)) for turn in (sp.cos, sp.sin))
    at = dict(zip(links, (math.pi / 3, math.pi / 3, -math.pi / 3, -math.pi / 3, math.pi), strict=True))
    found, notes = enforcement(closed, links, at, enforce="kkt")
    assert isinstance(found, Multipliers)
    (note,) = (note for note in notes if "lose a rank" in note)
    # all links in one line
    where = [float(part.split(" = ")[1]) for part in note.split(" at ")[1].split(":")[0].split(", ")]
    np.testing.assert_allclose(np.sin(np.subtract(where, where[0])), 0, atol=2e-3)
    assert "switches the motor off" in note
    # within declared ranges it is refused
    held = [hl.coordinate(f"a{k}", unit="rad", range=(-7, 7)) for k in range(5)]
    renamed = dict(zip(links, held, strict=True))
    with pytest.raises(SceneError, match="lose a rank within the range it can reach"):
        enforcement([g.xreplace(renamed) for g in closed], held, {renamed[q]: angle for q, angle in at.items()}, enforce="kkt")
