"""Orders of the methods, measured on programs, against closed forms and an independent integrator."""

import math

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp

import hapticlab as hl
from hapticlab import n, t, v, x
from hapticlab.compiler.engine import load
from hapticlab.compiler.methods import METHODS

m, c, K = hl.parameters("m c K", units="kg N*s/m N/m", values=(0.1, 0.3, 40.0))
z = hl.coordinate("z", unit="m", initial=hl.parameters("z_0", units="m", values=0.02))
theta = hl.coordinate("theta", unit="rad", initial=1.1)
s = hl.coordinate("s", unit="m", initial=hl.parameters("s_0", units="m", values=0.05))
tau = hl.parameters("tau", units="s", values=0.07)
w, d = hl.parameters("w d", units="1/s^2 1/s", values=(60.0, 1.5))
DURATION = 0.4


def scene_with(equations, watch):
    return hl.Scene(force=0 * K * x(n), eom=equations, watch=watch)


OSCILLATOR = scene_with([sp.Eq(m * z.diff(t, 2), -K * z - c * z.diff(t))], {"z": z})
PENDULUM = scene_with([sp.Eq(theta.diff(t, 2), -w * sp.sin(theta) - d * theta.diff(t))], {"theta": theta})
MIXED = scene_with(
    [sp.Eq(m * z.diff(t, 2), -K * (z - s) - c * z.diff(t)), sp.Eq(tau * s.diff(t), z - s)], {"z": z, "s": s}
)


def oscillator(time):
    """Closed form of the damped oscillator released from rest."""
    decay, natural = 0.3 / (2 * 0.1), 40.0 / 0.1
    damped = math.sqrt(natural - decay**2)
    return [0.02 * math.exp(-decay * time) * (math.cos(damped * time) + decay / damped * math.sin(damped * time))]


def integrated(rhs, start, picked):
    def at(time):
        solution = solve_ivp(rhs, (0, time), start, method="DOP853", rtol=1e-13, atol=1e-15)
        return [solution.y[k, -1] for k in picked]

    return at


pendulum = integrated(lambda _, y: [y[1], -60.0 * math.sin(y[0]) - 1.5 * y[1]], [1.1, 0.0], [0])
mixed = integrated(
    lambda _, y: [y[1], (-40.0 * (y[0] - y[2]) - 0.3 * y[1]) / 0.1, (y[0] - y[2]) / 0.07], [0.02, 0.0, 0.05], [0, 2]
)


def error(scene, reference, method, T):
    """Return the largest error of the watched channels at DURATION; the run's last tick shows the state there."""
    ticks = round(DURATION / T)
    program = hl.compile(scene, method, T=T, dtype="float64")
    run = load(program).run(ticks + 1, np.zeros((ticks + 1, 1)))
    return np.max(np.abs(run.outputs[-1, 1:, 0] - reference(DURATION)))


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(
    ("scene", "reference"),
    [(OSCILLATOR, oscillator), (PENDULUM, pendulum), (MIXED, mixed)],
    ids=["oscillator", "pendulum", "with a first-order state"],
)
def test_the_measured_order_is_within_a_tenth_of_the_claim(scene, reference, method):
    errors = [error(scene, reference, method, T) for T in (2e-3, 1e-3, 5e-4)]
    # Richardson on three steps: the order of the last halving, with the next term's drift taken out
    orders = np.log2(errors[:-1]) - np.log2(errors[1:])
    assert 2 * orders[1] - orders[0] == pytest.approx(METHODS[method].order, abs=0.1), (errors, orders)


def test_substeps_are_shorter_steps():
    coarse = hl.compile(OSCILLATOR, "heun", T=1e-3, substeps=4, dtype="float64")
    fine = hl.compile(OSCILLATOR, "heun", T=2.5e-4, dtype="float64")
    one = load(coarse).run(101, np.zeros((101, 1))).outputs[-1, 1, 0]
    other = load(fine).run(401, np.zeros((401, 1))).outputs[-1, 1, 0]
    assert one == pytest.approx(other, rel=1e-12)


@pytest.mark.parametrize(
    ("method", "growth"),
    [
        ("euler", lambda y: 1 + y**2),
        ("heun", lambda y: 1 + y**4 / 4),
        ("rk4", lambda y: 1 - y**6 / 72 + y**8 / 576),
    ],
)
def test_the_energy_gain_per_step_on_a_spring_is_the_closed_form(method, growth):
    """|R(iy)|^2 of each stability polynomial, y = omega h."""
    y = 0.3
    spring = scene_with([sp.Eq(m * z.diff(t, 2), -K * z)], {"z": z, "w": z.diff(t)})
    T = y / math.sqrt(40.0 / 0.1)
    program = hl.compile(spring, method, T=T, dtype="float64")
    (z0, w0), (z1, w1) = load(program).run(2, np.zeros((2, 1))).outputs[:, 1:, 0]
    gain = (40.0 * z1**2 + 0.1 * w1**2) / (40.0 * z0**2 + 0.1 * w0**2)
    assert gain == pytest.approx(growth(y), rel=1e-14)


DRIVEN = hl.Scene(
    force=0 * K * x(n), eom=[sp.Eq(m * z.diff(t, 2), K * (x(t) - z) - c * z.diff(t))], watch={"z": z}, name="driven"
)


def driven_error(hold, T, velocity):
    """Error after the handle motion x = 0.01 (1 - cos(9 t)), which starts from rest as histories assume."""
    ticks = round(DURATION / T)
    time = np.arange(ticks + 1) * T
    motion = [0.01 * (1 - np.cos(9 * time)), 0.09 * np.sin(9 * time)]
    program = hl.compile(DRIVEN, "rk4", T=T, hold=hold, velocity=velocity, dtype="float64")
    z_end = load(program).run(ticks + 1, np.array(motion[: len(program.inputs)]).T).outputs[-1, 1, 0]
    exact = integrated(lambda s, y: [y[1], (40.0 * (0.01 - 0.01 * math.cos(9 * s) - y[0]) - 0.3 * y[1]) / 0.1], [0.02, 0.0], [0])
    return abs(z_end - exact(DURATION)[0])


@pytest.mark.parametrize(
    ("hold", "velocity", "order"),
    [
        ("zoh", "measured", 1),
        ("foh", "measured", 2),
        ("soh", "measured", 3),
        ("foh", "backward_difference", 2),
        ("soh", "backward_difference", 3),
    ],
)
def test_the_hold_sets_the_order_of_a_driven_scene(hold, velocity, order):
    """The hold's error in x(t) over a period is T, T^2 or T^3; RK4's own is far below."""
    errors = [driven_error(hold, T, velocity) for T in (4e-3, 2e-3, 1e-3)]
    orders = np.log2(errors[:-1]) - np.log2(errors[1:])
    assert 2 * orders[1] - orders[0] == pytest.approx(order, abs=0.15), (errors, orders)


def test_a_parabola_is_followed_exactly_by_the_second_order_hold():
    """x(t) = t^2/2: the parabola through three samples is the motion itself, so only RK4's error is left."""
    T = 2e-3
    time = np.arange(202) * T
    program = hl.compile(
        hl.Scene(force=0 * K * x(n), eom=[sp.Eq(tau * s.diff(t), x(t) - s)], watch={"s": s}),
        T=T,
        velocity="backward_difference",
        dtype="float64",
    )
    # the first two samples have no parabola yet: start the clock at rest, where x is zero
    motion = np.where(np.arange(202) < 3, 0.0, (time - time[2]) ** 2 / 2)
    run = load(program).run(202, motion[:, None])
    s_of = run.outputs[:, 1, 0]
    start, span = 5, time[201] - time[5]
    a, t0 = 0.07, time[5] - time[2]
    particular = lambda q: q**2 / 2 - a * q + a**2  # noqa: E731 - solution of a s' + s = q^2/2
    exact = particular(t0 + span) + (s_of[start] - particular(t0)) * math.exp(-span / a)
    assert s_of[201] == pytest.approx(exact, rel=1e-8)
    held = hl.compile(DRIVEN, T=T, hold="zoh", dtype="float64")
    assert len(held) < len(hl.compile(DRIVEN, T=T, hold="soh", dtype="float64"))


def test_velocity_enters_only_where_it_is_used():
    spring = hl.Scene(force=K * x(n))
    assert [c.name for c in hl.compile(spring, T=1e-3, velocity="measured").inputs] == ["x"]
    damper = hl.Scene(force=c * v(n))
    assert [c.name for c in hl.compile(damper, T=1e-3, velocity="measured").inputs] == ["x", "v"]
    assert [c.name for c in hl.compile(damper, T=1e-3).states] == ["x(n-1)"]


@pytest.mark.parametrize("method", METHODS.values(), ids=METHODS)
def test_a_method_evaluates_as_often_as_it_says(method):
    calls = []

    def rhs(tau, q, v, s):
        calls.append(tau)
        return [-q[0]], [-s[0]]

    method.step(rhs, 0.0, ([1.0], [0.0], [1.0]), 0.1)
    assert len(calls) == method.evaluations
