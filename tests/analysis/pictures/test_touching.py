"""What is said to be touched, beside where the handle is by geometry: 30 mm of its way, in steps of 0.5 mm."""

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab.analysis.pictures.touching import touching
from hapticlab.analysis.pictures.wall_boundaries import boundaries

k, x_o, w, b = hl.parameters("k x_o w b", units="N/m m m N*s/m", values=(300, 0.01, 0.01, 1))
X, V = hl.x(hl.n), hl.v(hl.n)
WALL, RAMP = k * (X - x_o), k * w
PLACES = np.arange(-30.25, 30, 0.5) * 1e-3
SPRING = k * X / 10
IN_WALL, IN_PATCH = PLACES > 0.01, (PLACES > 0.01) & (PLACES < 0.02)


def said(force, F=1.0, **samples):
    """Whether a scene of a force is touched at each place, where the force acts."""
    touched = touching(hl.Scene(force=force))
    return touched({"x": PLACES, "F": np.full(len(PLACES), F), **samples}, {"k": 300.0, "x_o": 0.01, "w": 0.01, "b": 1.0})


@pytest.mark.parametrize(
    "force",
    [
        sp.Piecewise((WALL, X >= x_o), (0, True)),
        sp.Piecewise((0, X < x_o), (WALL, True)),
        hl.when(sp.Not(X < x_o), WALL, 0),
        hl.when(X < x_o, 0, WALL),
        sp.Max(0, WALL),
        k * sp.Max(0, X - x_o),
        -k * sp.Min(0, x_o - X),
        sp.Piecewise((WALL + b * V, X >= x_o), (b * V, True)),  # in a viscous fluid
        sp.Piecewise((b * V, X < x_o), (WALL + b * V, True)),
        sp.Piecewise((b * V, X > x_o), (0, True)),
        sp.Piecewise((WALL + k * (X - x_o - w), X >= x_o + w), (WALL, X >= x_o), (0, True)),  # two layers
        sp.Piecewise((0, X < x_o), (WALL, X < x_o + w), (2 * WALL, True)),
    ],
)
def test_a_wall_is_touched_inside_it_however_it_is_written(force):
    for centring in (0, SPRING):
        assert np.array_equal(said(force + centring) == 1, IN_WALL)
    assert not said(force, F=0.0).any()


@pytest.mark.parametrize(
    "force",
    [
        sp.Piecewise((WALL, sp.And(X >= x_o, X < x_o + w)), (0, True)),
        sp.Piecewise((0, X < x_o), (RAMP, X < x_o + w), (0, True)),
        sp.Piecewise((0, sp.Or(X < x_o, X > x_o + w)), (RAMP, True)),
        sp.Piecewise((RAMP, sp.Abs(X - x_o - w / 2) < w / 2), (0, True)),
    ],
)
def test_a_patch_is_touched_between_its_ends_alone_also_where_a_spring_acts_outside(force):
    assert np.array_equal(said(force + SPRING) == 1, IN_PATCH)


@pytest.mark.parametrize(
    "force",
    [
        sp.Piecewise((WALL, X >= x_o), (k * (X + x_o), X <= -x_o), (0, True)),
        k * sp.Max(0, X - x_o) + k * sp.Min(0, X + x_o),
        sp.Piecewise((k * (sp.Abs(X) - x_o) * sp.sign(X), sp.Abs(X) > x_o), (0, True)),
        sp.Piecewise((0, sp.And(X < x_o, X > -x_o)), (RAMP * sp.sign(X), True)),
    ],
)
def test_of_two_walls_each_is_touched(force):
    assert np.array_equal(said(force + SPRING) == 1, np.abs(PLACES) > 0.01)


def test_a_wall_that_moves_is_touched_where_it_is_by_then():
    """By time, and on a coordinate whose samples are known."""
    t = np.linspace(0, 1, len(PLACES))
    w_1 = hl.parameters("w_1", units="rad/s", values=7)
    touched = touching(hl.Scene(force=hl.when(x_o * sp.sin(w_1 * hl.t) > X, -RAMP, 0)))
    samples = {"t": t, "x": PLACES, "F": np.ones(len(t))}
    assert np.array_equal(touched(samples, {"x_o": 0.01, "w_1": 7.0, "k": 300.0, "w": 0.01}) == 1, PLACES < 0.01 * np.sin(7 * t))
    z, m = hl.coordinate("z", unit="m"), hl.parameters("m", units="kg", values=0.1)
    scene = hl.Scene(force=hl.when(X > z, k * (X - z), 0), eom=[sp.Eq(m * z.diff(hl.t, 2), -k * z)], watch=[z])
    place = 0.02 * np.cos(9 * t)
    assert np.array_equal(touching(scene, ["z"])({**samples, "z": place}, {"k": 300.0, "m": 0.1}) == 1, PLACES > place)
    assert touching(scene) is None  # nobody knows where it is


def test_what_has_no_boundary_is_never_touched_and_what_a_record_lacks_is_not_guessed():
    for force in (SPRING, b * V, k * X + k * X**3 / w**2, RAMP * sp.sin(X / w)):
        assert touching(hl.Scene(force=force)) is None
    touched = touching(hl.Scene(force=sp.Piecewise((WALL, X >= x_o), (0, True))))
    assert np.isnan(touched({"x": PLACES, "F": PLACES}, {"k": 300.0})).all()
    moved = np.where(PLACES < 0, 0.01, 0.02)  # a parameter that changed meanwhile
    assert np.array_equal(touched({"x": PLACES, "F": PLACES, "x_o": moved}, {"x_o": 0.0}) == 1, PLACES > 0.02)


def test_a_wall_whose_free_case_comes_first_is_drawn_where_the_other_is():
    ways = [sp.Piecewise((WALL, X >= x_o), (0, True)), sp.Piecewise((0, X < x_o), (WALL, True))]
    found = [[(one.mover, one.side, one.label, str(one.stiffness)) for one in boundaries(hl.Scene(force=way))] for way in ways]
    assert found == [[("x", 1, "x_o", "k")]] * 2
