"""Orders of the methods, measured on programs, against closed forms and an independent integrator."""

import inspect
import math
import pickle

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp

import hapticlab as hl
from hapticlab import n, t, v, x
from hapticlab.compiler.engines.engine import load
from hapticlab.compiler.methods.method_table import METHODS
from hapticlab.errors import ProgramError

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
MIXED = scene_with([sp.Eq(m * z.diff(t, 2), -K * (z - s) - c * z.diff(t)), sp.Eq(tau * s.diff(t), z - s)], {"z": z, "s": s})


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


@pytest.mark.parametrize("method", sorted(set(METHODS) - {"nystrom4"}))
@pytest.mark.parametrize(
    ("scene", "reference"),
    [(OSCILLATOR, oscillator), pytest.param(PENDULUM, pendulum, marks=pytest.mark.slow), (MIXED, mixed)],
    ids=["oscillator", "pendulum", "with a first-order state"],
)
@pytest.mark.always("oscillator-euler", "oscillator-rk4", "oscillator-verlet", "oscillator-adams_bashforth3")
def test_the_measured_order_is_within_a_tenth_of_the_claim(scene, reference, method):
    errors = [error(scene, reference, method, T) for T in (2e-3, 1e-3, 5e-4)]
    # Richardson on three steps: the order of the last halving, with the next term's drift taken out
    orders = np.log2(errors[:-1]) - np.log2(errors[1:])
    assert 2 * orders[1] - orders[0] == pytest.approx(METHODS[method].order, abs=0.1), (errors, orders)


@pytest.mark.parametrize("method", ["heun", "ssprk3", "semi_implicit_euler_damped", "adams_bashforth2", "adams_bashforth3"])
@pytest.mark.always("heun", "adams_bashforth2")
def test_substeps_are_shorter_steps(method):
    coarse = hl.compile(OSCILLATOR, method, T=1e-3, substeps=4, dtype="float64")
    fine = hl.compile(OSCILLATOR, method, T=2.5e-4, dtype="float64")
    one = load(coarse).run(101, np.zeros((101, 1))).outputs[-1, 1, 0]
    other = load(fine).run(401, np.zeros((401, 1))).outputs[-1, 1, 0]
    assert one == pytest.approx(other, rel=1e-12)


@pytest.mark.parametrize(
    ("method", "growth"),
    [
        ("euler", lambda y: 1 + y**2),
        ("heun", lambda y: 1 + y**4 / 4),
        ("midpoint", lambda y: 1 + y**4 / 4),
        ("ssprk3", lambda y: 1 - y**4 / 12 + y**6 / 36),
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
@pytest.mark.always("zoh-*", "soh-backward_difference-*")
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

    past = [([0.0], [-1.0], [-1.0])] * (method.steps - 1)
    method.step(rhs, 0.0, ([1.0], [0.0], [1.0]), 0.1, *([past] if past else []))
    assert len(calls) == method.evaluations


def test_nystroms_method_is_the_textbooks():
    """Hairer, Norsett and Wanner I, table II.14.1: c = 0, 1/2, 1; a21 = 1/8, a32 = 1/2; b' = 1/6 1/3 0, b = 1/6 4/6 1/6."""
    f = lambda t, q: math.cos(3 * t) - 4 * q + q**3  # noqa: E731
    h, q, w, t0 = 0.1, 0.3, -0.2, 0.05
    k1 = f(t0, q)
    k2 = f(t0 + h / 2, q + h / 2 * w + h * h / 8 * k1)
    k3 = f(t0 + h, q + h * w + h * h / 2 * k2)
    step = METHODS["nystrom4"].step(lambda tau, q, v, s: ([f(tau, q[0])], []), t0, ([q], [w], []), h)
    assert step[0][0] == pytest.approx(q + h * w + h * h * (k1 / 6 + k2 / 3), rel=1e-14)
    assert step[1][0] == pytest.approx(w + h * (k1 + 4 * k2 + k3) / 6, rel=1e-14)


@pytest.mark.parametrize(
    ("method", "weights"), [("adams_bashforth2", (3 / 2, -1 / 2)), ("adams_bashforth3", (23 / 12, -16 / 12, 5 / 12))]
)
def test_a_multistep_program_is_its_recurrence_from_a_true_past(method, weights):
    """The recurrence by hand from the rates of the closed form at -T and -2 T: RK4 backwards adds T^5 to those."""
    T, steps = 1e-3, 40
    A = np.array([[0.0, 1.0], [-400.0, -3.0]])
    eigenvalues, V = np.linalg.eig(A)
    true = lambda time: (V @ (np.exp(eigenvalues * time) * np.linalg.solve(V, [0.02, 0.0]))).real  # noqa: E731
    y, past = true(0.0), [A @ true(-k * T) for k in range(1, len(weights))]
    for _ in range(steps):
        rates = [A @ y, *past]
        y, past = y + T * sum(b * rate for b, rate in zip(weights, rates, strict=True)), rates[:-1]
    run = load(hl.compile(OSCILLATOR, method, T=T, dtype="float64")).run(steps + 1, np.zeros((steps + 1, 1)))
    assert run.outputs[-1, 1, 0] == pytest.approx(y[0], rel=1e-9)


def test_a_multistep_program_evaluates_once_a_tick_and_has_no_start_in_it():
    sines = lambda method: sum(i.op == "sin" for i in hl.compile(PENDULUM, method, T=1e-3).tick.instructions)  # noqa: E731
    program = hl.compile(PENDULUM, "adams_bashforth3", T=1e-3)
    assert (sines("adams_bashforth3"), sines("rk4")) == (1, 4)
    assert not any(i.op == "select" for i in program.tick.instructions)
    assert [c.name for c in program.states if "back" in c.name] == [
        "rate of theta, 1 back", "rate of dtheta/dt, 1 back", "rate of theta, 2 back", "rate of dtheta/dt, 2 back"
    ]  # fmt: skip


def test_a_multistep_method_starts_along_a_handle_that_moves():
    """With a measured velocity the handle came along its line: x = x_0 + v_0 t, which the motion follows from before it."""
    time = np.arange(3) * 1e-3
    follower = hl.Scene(
        force=0 * K * x(n), eom=[sp.Eq(tau * s.diff(t), x(t) - s)], watch={"s": s},
    )  # fmt: skip
    inputs = np.array([0.03 + 0.5 * time, np.full(3, 0.5)]).T
    a, x0, v0, s0 = 0.07, 0.03, 0.5, 0.05
    true = lambda q: x0 + v0 * (q - a) + (s0 - x0 + v0 * a) * math.exp(-q / a)  # noqa: E731
    program = hl.compile(follower, "adams_bashforth3", T=1e-3, velocity="measured", hold="foh", dtype="float64")
    rate = lambda q: (x0 + v0 * q - true(q)) / a  # noqa: E731
    first = s0 + 1e-3 * (23 * rate(0.0) - 16 * rate(-1e-3) + 5 * rate(-2e-3)) / 12
    assert load(program).run(2, inputs[:2, : len(program.inputs)]).outputs[1, 1, 0] == pytest.approx(first, rel=1e-11)


@pytest.mark.parametrize("method", ["semi_implicit_euler_damped", "ssprk3", "adams_bashforth3"])
def test_the_engines_agree_to_the_bit(method):
    pytest.importorskip("llvmlite")
    motion = np.array([0.01 * (1 - np.cos(0.02 * np.arange(60)))]).T
    program = hl.compile(DRIVEN, method, T=1e-3, force_at="mean")
    one, *others = (load(program, engine).run(60, motion).outputs for engine in ("interpreter", "llvm", "vm"))
    assert np.ptp(one[:, 1]) > 0 and all((one == other).all() for other in others)


@pytest.mark.parametrize("method", METHODS.values(), ids=METHODS)
def test_a_method_says_what_it_is_and_travels_by_its_name(method):
    text = str(method)
    for fact in ("order", "cost", "stable", "source", "not to be confused with"):
        assert f"\n  {fact} " in text, fact
    assert inspect.getdoc(method) == method.says and pickle.loads(pickle.dumps(method)) is method


def test_the_instructions_beside_the_evaluations_are_those_of_a_program():
    """An evaluation is three instructions here; all else of a tick is the step's."""
    scene = hl.Scene(force=0, eom=[sp.Eq(z.diff(t, 2), w * z + d * z.diff(t))], watch=[z])
    for name, of_step in (("euler", 4), ("semi_implicit_euler", 4), ("verlet", 9), ("rk4", 24)):
        method = METHODS[name]
        assert method.instructions == of_step
        assert len(hl.compile(scene, name, T=1e-3)) == of_step + 3 * method.evaluations


def test_a_record_compiles_to_the_very_program_of_its_text():
    scene = hl.library.mass_spring_damper()
    for name in hl.methods.__all__:
        record = getattr(hl.methods, name)
        if isinstance(record, hl.methods.Method) and not record.order_with_velocity:
            assert hl.compile(scene, record, T=1e-3) is hl.compile(scene, record.name, T=1e-3)
        if isinstance(record, hl.methods.Hold):
            assert hl.compile(scene, T=1e-3, hold=record) is hl.compile(scene, T=1e-3, hold=record.name)
            assert "\n  order " in str(record) and "confused" in str(record) and "hold" in inspect.getdoc(record)
    exact, taylor = hl.methods.Exact, hl.methods.Taylor
    assert hl.compile(scene, exact, T=1e-3, live="") is hl.compile(scene, "exact", T=1e-3, live="")
    assert hl.compile(scene, exact(rest=hl.methods.RK4), T=1e-3, live="") is hl.compile(scene, "exact+rk4", T=1e-3, live="")
    assert hl.compile(scene, taylor, T=1e-3) is hl.compile(scene, taylor(), T=1e-3) is hl.compile(scene, "taylor", T=1e-3)
    assert hl.methods.order_of(scene, hl.methods.Heun, hold=hl.methods.ZeroOrderHold).limits["method heun"] == 2
    assert hl.stability.step_limit(scene, hl.methods.Verlet, T=1e-3).method == "verlet"


def test_what_is_no_record_is_refused():
    with pytest.raises(ProgramError, match=r"method = 4; needs one of euler"):
        hl.compile(hl.wall(), 4, T=1e-3)
    with pytest.raises(ProgramError, match="method = 'rk5'; needs one of euler"):
        hl.compile(hl.wall(), hl.methods.Exact(rest="rk5"), T=1e-3)
    with pytest.raises(ProgramError, match="hold = 'third'; needs one of zoh, foh, soh"):
        hl.compile(hl.wall(), T=1e-3, hold="third")
