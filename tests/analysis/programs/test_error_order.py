"""The order of the error of a compiled force, measured, against what order_of claims, on motions known otherwise."""

import itertools
from functools import lru_cache

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp

import hapticlab as hl
from hapticlab import t, v, x
from hapticlab.analysis.programs.error_order import order_of
from hapticlab.compiler.engines.engine import load
from hapticlab.compiler.methods.method_table import METHODS
from hapticlab.errors import ParameterError

M_, K_, B_, C_, D_ = 0.05, 60.0, 0.4, 0.3, 2.0
m, K, B, c, d = hl.parameters("m K B c d", units="kg N/m N*s/m N*s/m 1/m", values=(M_, K_, B_, C_, D_))
z = hl.coordinate("z", unit="m", initial=hl.parameters("z_0", units="m", values=0.01))
SPAN = 0.32
STEPS = (256, 512, 1024)


def scene_with(pull, damping):
    return hl.Scene(force=pull, eom=[sp.Eq(m * z.diff(t, 2), pull - damping)], watch={"w": z.diff(t)})


#: a force that depends on velocities and is not linear; one with the handle's velocity; one free of velocities
FORCES = {
    "damped": scene_with(K * (x(t) - z), c * (1 + d * z) * z.diff(t)),
    "coupler": scene_with(K * (x(t) - z) + B * (v(t) - z.diff(t)), sp.S.Zero),
    "spring": scene_with(K * (x(t) - z) - K * d**2 * z**3, sp.S.Zero),
}
PULL = {
    "damped": lambda x, v, z, w: K_ * (x - z),
    "coupler": lambda x, v, z, w: K_ * (x - z) + B_ * (v - w),
    "spring": lambda x, v, z, w: K_ * (x - z) - K_ * D_**2 * z**3,
}


def handle(time):
    """A push of 40 mm from rest, with three derivatives that start at zero, as the histories of a program suppose."""
    s, rate = np.sin(6.0 * time), 6.0 * np.cos(6.0 * time)
    return 0.04 * s**4, 0.16 * s**3 * rate


def test_it_says_what_sets_the_order():
    assert str(order_of(FORCES["damped"], "rk4", hold="foh")) == "2 (x(t) of hold foh; method rk4: 4)"
    assert str(order_of(FORCES["damped"], "adams_bashforth3", hold="zoh")) == "3 (method adams_bashforth3)"
    assert str(order_of(FORCES["damped"], "adams_bashforth3", hold="zoh", substeps=2)) == (
        "1 (x(t) of hold zoh; method adams_bashforth3: 3)"
    )
    assert str(order_of(hl.Scene(force=K * x(hl.n)))) == "only rounding errors"
    assert "states late by one period" in order_of(FORCES["spring"], force_at="after").limits
    with pytest.raises(ParameterError, match="K is not live, so it needs a value"):
        order_of(hl.Scene(force=hl.parameters("K", units="N/m") * x(hl.n)))


@lru_cache
def reference(force):
    """Return (force at t, impulse of the force since 0) by DOP853 at 1e-12."""

    def rates(time, y):
        pull = PULL[force](*handle(time), y[0], y[1])
        damping = C_ * (1 + D_ * y[0]) * y[1] if force == "damped" else 0.0
        return [y[1], (pull - damping) / M_, pull]

    dense = solve_ivp(rates, (0, SPAN + 0.02), [0.01, 0, 0], method="DOP853", rtol=1e-12, atol=1e-15, dense_output=True).sol
    return lambda time: PULL[force](*handle(time), *dense(time)[:2]), lambda time: dense(time)[2]


def error(force, steps, velocity="measured", **options):
    """Return the largest error of F, over the samples of the second half that every step has."""
    T = SPAN / steps
    time = np.arange(steps + 1) * T
    program = hl.compile(FORCES[force], T=T, velocity=velocity, live=(), **{"dtype": "float64", **options})
    F = load(program).run(steps + 1, np.array(handle(time))[: len(program.inputs)].T).outputs[:, 0, 0]
    at, impulse = reference(force)
    true = (impulse(time + T) - impulse(time)) / T if options["force_at"] == "mean" else at(time)
    common = np.arange(32, 65) * (steps // 64)
    return np.abs(F - true)[common].max()


def measured(errors):
    """Return the order of the last halving, with the drift of the next term taken out."""
    first, second = np.log2(errors[:-1]) - np.log2(errors[1:])
    return 2 * second - first


COMBINATIONS = list(itertools.product(FORCES, [*METHODS, "taylor", "exact"], ("zoh", "foh", "soh"), ("before", "after", "mean")))
#: each method on two of the forces, with a hold and an instant that go round; all together are slow
FEW = [one for k, one in enumerate(COMBINATIONS) if k % 9 == (k // 9 * 4 + k // 117) % 9 and (k // 117 + k // 9 % 13) % 3 != 2]


def is_taken(force, method, hold, force_at):
    """nystrom4 takes what is free of velocities, exact what is linear."""
    return not (method == "nystrom4" and force != "spring") and not (method == "exact" and force != "coupler")


@pytest.mark.parametrize(
    ("force", "method", "hold", "force_at"),
    [pytest.param(*one, marks=() if one in FEW else pytest.mark.slow) for one in COMBINATIONS if is_taken(*one)],
)
@pytest.mark.always("damped-euler-*", "damped-verlet-*", "damped-midpoint-*", "damped-rk4-*", "coupler-exact-*")
def test_the_order_measured_is_the_order_claimed(force, method, hold, force_at):
    options = {"method": method, "hold": hold, "force_at": force_at}
    errors = [error(force, steps, **options) for steps in STEPS]
    claim = float(order_of(FORCES[force], velocity="measured", **options))
    assert measured(errors) == pytest.approx(claim, abs=0.1), (errors, claim)


@pytest.mark.parametrize(
    ("force", "method", "hold", "force_at", "claim"),
    [
        ("damped", "rk4", "foh", "before", 2), ("damped", "verlet", "soh", "mean", 2), ("damped", "ssprk3", "soh", "before", 3),
        ("coupler", "rk4", "soh", "before", 1), ("coupler", "rk4", "soh", "mean", 2), ("coupler", "rk4", "foh", "mean", 1),
        ("coupler", "adams_bashforth3", "zoh", "mean", 1), ("damped", "adams_bashforth3", "zoh", "before", 3),
    ],
)  # fmt: skip
@pytest.mark.always("coupler-rk4-soh-mean-2")
def test_an_estimated_velocity_costs_what_is_claimed(force, method, hold, force_at, claim):
    options = {"method": method, "hold": hold, "force_at": force_at, "velocity": "backward_difference"}
    errors = [error(force, steps, **options) for steps in STEPS]
    assert float(order_of(FORCES[force], **options)) == claim
    assert measured(errors) == pytest.approx(claim, abs=0.1), errors


@pytest.mark.parametrize(
    ("force", "method", "hold", "steps", "substeps"),
    [
        ("damped", "euler", "soh", (256, 512, 1024), 1), ("damped", "semi_implicit_euler_damped", "foh", (256, 512, 1024), 1),
        ("damped", "rk4", "zoh", (256, 512, 1024), 4), ("coupler", "verlet", "soh", (64, 128, 256), 1),
        ("spring", "nystrom4", "foh", (64, 128, 256), 1), ("damped", "adams_bashforth2", "zoh", (64, 128, 256), 1),
        ("damped", "heun", "soh", (64, 128, 256), 2),
    ],
)  # fmt: skip
@pytest.mark.always("damped-rk4-*", "coupler-verlet-*", "damped-heun-*")
def test_float32_has_the_order_where_truncation_dominates(force, method, hold, steps, substeps):
    """F is some 2 N and its steps are rounded to 1e-7 N: errors of 2e-4 N and more are those of the truncation."""
    options = {"method": method, "hold": hold, "force_at": "before", "substeps": substeps}
    errors = [error(force, k, dtype="float32", **options) for k in steps]
    claim = float(order_of(FORCES[force], velocity="measured", **options))
    assert min(errors) > 1e-5 and measured(errors) == pytest.approx(claim, abs=0.1), (errors, claim)


@pytest.mark.parametrize("method", ["rk4", "adams_bashforth3"])
def test_a_delay_costs_an_order(method):
    """A spring whose other end is felt a sample late: beside the one that feels it at once, by DOP853."""
    PULL_ = K * (x(t) - z)
    scene = hl.Scene(force=PULL_, eom=[sp.Eq(m * z.diff(t, 2), PULL_ - c * z.diff(t) - K * hl.laws.delay(z))])
    rates = lambda s, y: [y[1], (K_ * (handle(s)[0] - 2 * y[0]) - C_ * y[1]) / M_]  # noqa: E731
    end = solve_ivp(rates, (0, SPAN), [0.01, 0], method="DOP853", rtol=1e-12, atol=1e-15).y[0, -1]
    errors = []
    for steps in STEPS:
        program = hl.compile(scene, method, T=SPAN / steps, dtype="float64", live=())
        time = np.arange(steps + 1) * SPAN / steps
        F = load(program).run(steps + 1, handle(time)[0][:, None]).outputs[-1, 0, 0]
        errors.append(abs(F - K_ * (handle(SPAN)[0] - end)))
    assert float(order_of(scene, method)) == 1 and "late by one sample" in str(order_of(scene, method))
    assert measured(errors) == pytest.approx(1, abs=0.1), errors


WALL, SPEED, K_W, B_W = 0.01, 0.2, 2000.0, 1.0
z_w, k_w, b_w, s_c = hl.parameters("z_w k_w b_w s_c", units="m N/m N*s/m m", values=(WALL, K_W, B_W, 1e-3))
ball = hl.coordinate("y", unit="m", rate=hl.parameters("v_0", units="m/s", values=SPEED))
depth = ball - z_w
#: how the force of a wall begins -> (the wall, it as a function of depth and rate)
WALLS = {
    "kink": (k_w * sp.Max(0, depth), lambda d, w: K_W * d),
    "jump": (hl.when(depth > 0, k_w * depth + b_w * ball.diff(t)), lambda d, w: K_W * d + B_W * w),
    "hertz": (k_w * s_c * sp.Max(0, depth / s_c) ** sp.Rational(3, 2), lambda d, w: K_W * 1e-3 * max(d / 1e-3, 0.0) ** 1.5),
}


def thrown(wall):
    return hl.Scene(force=K * (x(t) - ball), eom=[sp.Eq(m * ball.diff(t, 2), -WALLS[wall][0])], name=wall)


def contact_error(wall, method, fraction, steps):
    """Return the error of F some 3 ms after touch, which falls on the same fraction of a step whatever the step."""
    touch = WALL / SPEED
    T = touch / (steps + fraction)
    ticks = steps + round(0.003 / T)
    program = hl.compile(thrown(wall), method, T=T, dtype="float64", live=())
    F = load(program).run(ticks + 1, np.zeros((ticks + 1, 1))).outputs[-1, 0, 0]
    inside = solve_ivp(
        lambda _, y: [y[1], -WALLS[wall][1](y[0], y[1]) / M_], (0, ticks * T - touch), [0.0, SPEED], method="DOP853",
        rtol=1e-13, atol=1e-16,
    )  # fmt: skip
    return abs(F + K_ * (WALL + inside.y[0, -1]))


@pytest.mark.parametrize(
    ("wall", "method"),
    [
        ("kink", "euler"), ("kink", "verlet"), ("kink", "heun"), ("kink", "midpoint"),
        ("kink", "ssprk3"), ("kink", "nystrom4"), ("kink", "rk4"), ("jump", "semi_implicit_euler_damped"), ("jump", "heun"),
        ("jump", "rk4"), ("hertz", "verlet"), ("hertz", "rk4"),
    ],
)  # fmt: skip
@pytest.mark.always("jump-rk4")
def test_stepping_over_a_touch_costs_what_is_claimed(wall, method):
    errors = [contact_error(wall, method, 0.47, steps) for steps in (400, 800, 1600)]
    claim = float(order_of(thrown(wall), method))
    assert measured(errors) == pytest.approx(claim, abs=0.1), (errors, claim)


@pytest.mark.parametrize("wall", ["kink", "jump"])
@pytest.mark.parametrize("method", ["taylor", "exact"])
@pytest.mark.always("exact-jump")
def test_a_touch_that_is_located_costs_nothing(wall, method):
    """At 1/40 of these steps the error is the rounding of F, 0.7 N."""
    assert float(order_of(thrown(wall), method)) == np.inf
    assert contact_error(wall, method, 0.47, 40) < 1e-12


K_STOP = 400.0
k_stop = hl.parameters("k_stop", units="N/m", values=K_STOP)
#: the body of "damped", on its way by the handle into a stop
PUSH = K * (x(t) - z)
STOPPED = hl.Scene(force=PUSH, eom=[sp.Eq(m * z.diff(t, 2), PUSH - c * z.diff(t) - k_stop * sp.Max(0, z - z_w))], name="stopped")


@lru_cache
def stopped():
    """Return (time of touch, force at t, impulse since 0) by DOP853, up to the touch and from it on."""

    def rates(time, y):
        pull = K_ * (handle(time)[0] - y[0])
        return [y[1], (pull - C_ * y[1] - K_STOP * max(0.0, y[0] - WALL)) / M_, pull]

    def touch(time, y):
        return y[0] - WALL

    touch.terminal, touch.direction = True, 1
    options = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-15, "dense_output": True}
    before = solve_ivp(rates, (0.05, 0.4), _at_50_ms(), events=touch, **options)
    after = solve_ivp(rates, (before.t[-1], 0.4), before.y[:, -1], **options)
    return before.t[-1], lambda s: K_ * (handle(s)[0] - after.sol(s)[0]), lambda s: after.sol(s)[2]


def _at_50_ms():
    """The start lies on the stop, which the body has left by then: 10 mm is where z begins."""
    body = lambda s, y: [y[1], (K_ * (handle(s)[0] - y[0]) - C_ * y[1]) / M_, K_ * (handle(s)[0] - y[0])]  # noqa: E731
    return solve_ivp(body, (0, 0.05), [0.01, 0, 0], method="DOP853", rtol=1e-13, atol=1e-16).y[:, -1]


@pytest.mark.parametrize(
    ("method", "hold", "force_at"),
    [
        ("rk4", "soh", "before"), ("heun", "foh", "mean"), ("semi_implicit_euler_damped", "soh", "before"),
        ("taylor", "foh", "before"), ("exact", "soh", "before"),
        *(pytest.param(*one.split(), marks=pytest.mark.slow) for one in (
            "rk4 zoh before", "ssprk3 soh mean", "verlet soh after", "exact foh mean", "exact soh after", "taylor zoh before",
            "taylor soh mean",
        )),
    ],
)  # fmt: skip
@pytest.mark.always("rk4-*", "heun-*", "semi_implicit_euler_damped-*")
def test_the_least_of_method_hold_instant_and_touch_is_the_order(method, hold, force_at):
    touch, force, impulse = stopped()
    options, errors = {"method": method, "hold": hold, "force_at": force_at}, []
    for steps in (100, 200, 400) if method in ("taylor", "exact") else (400, 800, 1600):
        T = touch / (steps + 0.47)
        ticks = round(1.05 * steps)
        time = np.arange(ticks + 1) * T
        program = hl.compile(STOPPED, T=T, velocity="measured", dtype="float64", live=(), **options)
        F = load(program).run(ticks + 1, np.array(handle(time))[: len(program.inputs)].T).outputs[-1, 0, 0]
        end = time[-1]
        errors.append(abs(F - ((impulse(end + T) - impulse(end)) / T if force_at == "mean" else force(end))))
    claim = float(order_of(STOPPED, velocity="measured", **options))
    assert measured(errors) == pytest.approx(claim, abs=0.1), (errors, claim)
