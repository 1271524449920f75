"""Cases as switches: in its mode a switched scene is the scene, and every mode that can be reached is found."""

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import n, t, v, x
from hapticlab.analysis.stability.condition_switches import switched
from hapticlab.analysis.stability.linearization import motion_at, tick_at
from hapticlab.analysis.stability.operating_points import operating_points
from hapticlab.compiler.engines.engine import load

z, y = hl.coordinate("z", unit="m", initial=0.002), hl.coordinate("y", unit="m", initial=0.03)
K, B, m, k, x_o = hl.parameters("K B m k x_o", units="N/m N*s/m kg N/m m", values=(500, 0.4, 0.05, 4000, 0.01))
F = K * (x(t) - z) + B * (v(t) - z.diff(t))


def two_stops():
    """Return a body between two stops that push only, and a friction by sign beside it."""
    right = sp.Max(k * (z - x_o), 0)
    left = hl.when(z < -x_o, k * (z + x_o), 0)
    friction = B / 10 * sp.Abs(z.diff(t)) * sp.sign(z.diff(t))
    return hl.Scene(force=F, eom=[sp.Eq(m * z.diff(t, 2), F - right - left - friction)], name="two stops")


def meeting():
    """Return two bodies, one of which the other meets; a wall at the handle itself."""
    push = hl.when(z >= y, k * (z - y))
    wall = hl.when(x(n) > x_o, k * (x(n) - x_o) + B * v(n))
    pulled = sp.Min(k * (y - x_o), 2 * k * (y - x_o))
    eom = [sp.Eq(m * z.diff(t, 2), F - push), sp.Eq(m * y.diff(t, 2), push - pulled)]
    return hl.Scene(force=F + wall, eom=eom, name="meeting")


def plain():
    return hl.Scene(force=F, eom=[sp.Eq(m * z.diff(t, 2), F)], name="plain")


@pytest.mark.parametrize("make", [two_stops, meeting, plain, hl.library.virtual_fixture, hl.library.texture])
@pytest.mark.always("plain", "virtual_fixture", "texture")
def test_a_switched_scene_is_the_scene_in_its_mode(make):
    """One Euler tick from every operating point: the same force and the same next states."""
    scene, known = make(), switched(make())
    options = {"method": "euler", "T": 1e-4, "dtype": "float64", "hold": "zoh"}
    written = hl.compile(hl.Scene(scene.force, scene.eom, values=scene.values), live=(), **options)
    switches = tuple(s.name for s in known.switches)
    points = operating_points(known)
    reached = {"two stops": 6, "meeting": 8, "plain": 1, "virtual fixture": 8, "texture": 2}
    assert len({p.mode for p in points}) == reached[scene.name]
    for p in points:
        moded = hl.compile(known.set(p.mode), live=switches, **options)
        assert [c.name for c in moded.states] == [c.name for c in written.states]
        states = [p.values.get(c.name, p.values["x"] if c.name.startswith("x(") else 0.0) for c in written.states]
        states = np.reshape(states, (-1, 1))
        runs = [load(program, "interpreter").run(1, [[p.values["x"]]], None, states) for program in (written, moded)]
        assert runs[1].outputs == pytest.approx(runs[0].outputs, rel=1e-12, abs=1e-15)
        assert runs[1].states == pytest.approx(runs[0].states, rel=1e-12, abs=1e-15)


def test_slopes_of_a_mode_are_those_of_its_springs():
    """J of two bodies that touch, worked out by hand."""
    known = switched(meeting())
    points = operating_points(known)
    J, seconds = motion_at(known, points, 1e-3)
    assert seconds == 2
    for p, one in zip(points, J, strict=True):
        touching = 4000.0 * (p.values["z"] >= p.values["y"])
        pulled = 4000.0 * (1 if p.values["y"] > 0.01 else 2)
        order = [list(p.values).index(name) - 2 for name in ("y", "z")]
        A = -np.array([[touching + pulled, -touching], [-touching, 500 + touching]]) / 0.05
        assert order == [0, 1] and one[2:, :2] == pytest.approx(A, rel=1e-12)
        assert one[2:, 2:] == pytest.approx(np.diag([0.0, -0.4 / 0.05]), rel=1e-12)


@pytest.mark.parametrize("method", ["rk4", "semi_implicit_euler", "verlet", "taylor", "exact"])
def test_a_tick_in_its_mode_is_one_map_at_every_stage(method):
    """Where a stage of the tick would leave the mode, the map is that of the mode all the same: its force at the port."""
    known = switched(two_stops())
    points = [p for p in operating_points(known) if p.values["z"] > 0.01]
    stiff = hl.Scene(force=F, eom=[sp.Eq(m * z.diff(t, 2), F - k * (z - x_o) - B / 10 * z.diff(t))])
    (expected,), _ = tick_at(switched(stiff), operating_points(switched(stiff))[:1], 1e-3, method=method)
    found, _ = tick_at(known, points, 1e-3, method=method)
    for tick in found:
        for part, other in zip(tick, expected, strict=True):
            assert part == pytest.approx(other, rel=1e-9, abs=1e-12)


def test_slopes_of_a_tick_are_differences_of_its_runs():
    """A nonlinear tick, with its past samples, against central differences of the program itself."""
    theta, g, l = hl.coordinate("theta", unit="rad", initial=0.7), *hl.parameters("g l", units="m/s^2 m", values=(9.81, 0.2))
    swing = sp.Eq(l * theta.diff(t, 2), -g * sp.sin(theta) - F / m * sp.cos(theta))
    scene = hl.Scene(force=F * sp.cos(theta) + K * (x(n) - x(n - 1)), eom=[sp.Eq(m * z.diff(t, 2), F), swing])
    known = switched(scene)
    (point,) = operating_points(known, {"x": 0.003, "theta": 0.4, "dtheta/dt": 2.0})
    ((A, B_x, C, D),), handle = tick_at(known, [point], 1e-3, hold="soh")
    program = hl.compile(scene, T=1e-3, dtype="float64", live=())
    start = load(program, "interpreter").run(1, [[0.003]]).states * 0
    for row, channel in enumerate(program.states):
        start[row] = point.values.get(channel.name, 0.003 if channel.name.startswith("x(") else 0.0)
    S, e = len(program.states), 1e-6
    bumps = np.hstack([np.zeros((S, 2)), e * np.eye(S), -e * np.eye(S)])
    engine, values = load(program, "interpreter"), np.repeat(np.array(program.values)[:, None], 2 + 2 * S, axis=1)
    at, forward, back = (engine.run(1, [[0.003 + d]], values, start + bumps) for d in (0.0, e, -e))
    both = [np.vstack([run.outputs[0, :1], run.states]) for run in (at, forward, back)]
    slopes = (both[0][:, 2 : 2 + S] - both[0][:, 2 + S :]) / (2 * e)
    assert np.vstack([C, A]) == pytest.approx(slopes, rel=1e-6, abs=1e-6)
    assert np.r_[D, B_x] == pytest.approx((both[1] - both[2])[:, 0] / (2 * e), rel=1e-6, abs=1e-6)
    assert [program.states[i].name for i in handle] == [c.name for c in program.states if c.name[:2] in ("x(", "v(")]
