"""method="taylor" of whole scenes: against rk4 in the limit, closed forms, and what it refuses."""

import math

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp

import hapticlab as hl
from hapticlab.compiler.engines.engine import load
from hapticlab.compiler.events.taylor_method import Taylor
from hapticlab.errors import ProgramError

T = 1e-3


def drop(k=2000.0, b=1.5, law=lambda q, k, b: hl.when(q <= 0, sp.Max(0, -k * q - b * q.diff(hl.t)))):
    """A ball of 50 g above a penalty floor."""
    m, g, start, u = hl.parameters("m g q_0 u", units="kg m/s^2 m N/m", values=(0.05, 9.81, 0.05, 1.0))
    k, b = hl.parameters("k b", units="N/m N*s/m", values=(k, b))
    q = hl.coordinate("q", unit="m", initial=start)
    return hl.Scene(u * q, [sp.Eq(m * q.diff(hl.t, 2), law(q, k, b) - m * g)], watch={"w": q.diff(hl.t)})


def run(scene, ticks, x=None, **options):
    program = hl.compile(scene, T=options.pop("T", T), **options)
    rows = np.zeros((ticks, 1)) if x is None else x[:, None]
    return program, load(program).run(ticks, rows).outputs[:, :, 0]


@pytest.mark.wide
def test_a_penalty_floor_is_found_and_rk4_comes_to_it():
    program, exact = run(drop(), 300, method="taylor", dtype="float64")
    assert [c.name for c in program.outputs] == ["F", "w", "unlocated"] and not exact[:, 2].any()
    errors = []
    for substeps in (16, 64):
        _, rk4 = run(drop(), 300, method="rk4", substeps=substeps, dtype="float64")
        errors.append(abs(rk4[:, 0] - exact[:, 0]).max())
    # the jump of the damper at touch leaves rk4 first order
    assert errors[1] < 0.5 * errors[0] and 1e-7 < errors[1] < 3e-5


def test_float32_engines_give_the_same_bits():
    small = Taylor(order=5, events=1)
    program, llvm = run(drop(), 140, method=small)
    for engine in ("interpreter", "vm"):
        try:
            other = load(program, engine)
        except Exception as missing:
            if type(missing).__name__ != "EngineMissingError":
                raise
            continue
        np.testing.assert_array_equal(other.run(140, np.zeros((140, 1))).outputs[:, :, 0], llvm)


def test_friction_written_as_a_sign_sticks():
    m, F_c, k = hl.parameters("m F_c k", units="kg N N/m", values=(0.2, 0.8, 300.0))
    q = hl.coordinate("q", unit="m")
    t, x, n = hl.t, hl.x, hl.n
    coupling = k * (x(t) - q)
    scene = hl.Scene(
        k * (x(n) - q), [sp.Eq(m * q.diff(t, 2), coupling - F_c * sp.sign(q.diff(t)))], watch={"q": q, "w": q.diff(t)}
    )
    # 2 mm of the handle pull with 0.6 N: not enough; 6 mm with 1.8 N
    x = np.concatenate([np.full(50, 0.002), np.full(300, 0.006)])
    program, out = run(scene, 350, x, method="taylor", dtype="float64", hold="zoh")
    q, w = out[:, 1], out[:, 2]
    assert not q[:51].any() and not w[:51].any()
    assert any(c.type == "bool" for c in program.states)
    # half a swing about (k x - F)/k, then it rests where the spring is below F
    omega = math.sqrt(300 / 0.2)
    centre = 0.006 - 0.8 / 300
    s = np.minimum(T * (np.arange(350) - 50), math.pi / omega).clip(0)
    np.testing.assert_allclose(q, centre * (1 - np.cos(omega * s)), rtol=0, atol=1e-14)
    assert not w[60 + math.ceil(math.pi / omega / T) :].any()
    assert not out[:, 3].any()


@pytest.mark.parametrize("hold", ["zoh", "foh", "soh"])
@pytest.mark.always("zoh")
def test_a_smooth_scene_is_what_rk4_comes_to(hold):
    m, l, g, k, B, f, A = hl.parameters(
        "m l g k B f A", units="kg m m/s^2 N/m N*s/m Hz N*m", values=(0.1, 0.2, 9.81, 40.0, 0.3, 31.0, 0.02)
    )
    rad = hl.parameters("r_0", units="rad", values=0.7)
    q = hl.coordinate("q", unit="rad", initial=rad)
    t, x, v, n = hl.t, hl.x, hl.v, hl.n
    pull = k * (x(t) - l * sp.sin(q)) + B * (v(t) - l * sp.cos(q) * q.diff(t))
    motor = A * sp.sin(2 * sp.pi * f * t)
    scene = hl.Scene(
        k * (x(n) - l * sp.sin(q)),
        [sp.Eq(m * l**2 * q.diff(t, 2), l * sp.cos(q) * pull - m * g * l * sp.sin(q) + motor)],
        watch={"q": q},
    )
    handle = 0.02 * np.sin(2 * np.pi * 3.3 * T * np.arange(400))
    _, exact = run(scene, 400, handle, method="taylor", dtype="float64", hold=hold)
    errors = [abs(run(scene, 400, handle, method="rk4", substeps=s, dtype="float64", hold=hold)[1] - exact).max() for s in (2, 4)]
    assert errors[1] < errors[0] / 12 and errors[1] < 1e-8  # fourth order, towards it


def test_a_free_scene_agrees_with_dop853():
    a, start = hl.parameters("a r_0", units="1/s^2 rad", values=(30.0, 2.0))
    q = hl.coordinate("q", unit="rad", initial=start)
    t = hl.t
    u = hl.parameters("u", units="N/rad", values=1.0)
    scene = hl.Scene(u * q, [sp.Eq(q.diff(t, 2), -a * sp.sin(q))])
    _, out = run(scene, 500, method="taylor", T=5e-3, dtype="float64")
    times = 5e-3 * np.arange(500)
    exact = solve_ivp(lambda t, y: [y[1], -30 * math.sin(y[0])], (0, 2.5), [2.0, 0.0], "DOP853", times, rtol=2.3e-14, atol=1e-14)
    np.testing.assert_allclose(out[:, 0], exact.y[0], rtol=0, atol=2e-12)


def test_order_and_events_are_chosen_or_given():
    program = hl.compile(drop(), method="taylor", T=T, dtype="float64")
    assert program.facts["method"] == "taylor" and program.facts["events"] == 2
    assert program.facts["omega"] == pytest.approx(math.sqrt(2000 / 0.05), rel=1e-3)
    softer = hl.compile(drop(k=20.0, b=0.01), method="taylor", T=T, dtype="float64")
    assert softer.facts["order"] < program.facts["order"] and len(softer) < len(program)
    given = hl.compile(drop(), method=Taylor(order=4, events=1), T=T)
    assert given.facts["order"] == 4 and given.facts["events"] == 1
    with pytest.raises(ProgramError, match="events = 9"):
        Taylor(events=9)


def test_a_step_too_long_is_refused_with_the_substeps_it_needs():
    stiff = drop(k=1e6)  # omega = 4472/s: the contact lasts 0.7 ms
    with pytest.raises(ProgramError, match=r"omega = 4472 rad/s.*substeps=5"):
        hl.compile(stiff, method="taylor", T=T)
    assert hl.compile(stiff, method=Taylor(order=4, events=1), T=T, substeps=5).facts["omega"] == 4472


def test_a_broken_power_is_refused_where_it_starts_from_zero():
    c = hl.parameters("c", units="N/m^1.5", values=5e5)
    hertz = drop(law=lambda q, k, b: hl.when(q <= 0, c * sp.Max(0, -q) ** sp.Rational(3, 2)))
    with pytest.raises(ProgramError, match="fractional power or a logarithm of a"):
        hl.compile(hertz, method="taylor", T=T)
    u = hl.parameters("F_u", units="N", values=0.1)
    for distance in (abs, lambda a: hl.when(a < 0, -a, a)):
        for power in (sp.sqrt, sp.log, lambda a: a ** sp.Rational(1, 3)):
            rough = drop(law=lambda q, k, b, distance=distance, power=power: -u * power(distance(q * k / u)))
            with pytest.raises(ProgramError, match=r"fractional power or a logarithm of a.*sqrt\(Abs"):
                hl.compile(rough, method="taylor", T=T)
    smooth = drop(law=lambda q, k, b: -u * sp.sqrt(1 + abs(q * k / u)))
    assert hl.compile(smooth, method="taylor", T=T)


def free(law, start=0.3, rate=0.0, ticks=400, **options):
    """Return what becomes of y'' = law(y, y'), in seconds, by method="taylor": y and the program."""
    s1 = hl.parameters("s_1", units="s", values=1.0)
    y = hl.coordinate("y", unit="1", initial=start, rate=rate)
    scene = hl.Scene(0, [sp.Eq(s1**2 * y.diff(hl.t, 2), law(y, s1 * y.diff(hl.t)))], watch={"y": y})
    program, out = run(scene, ticks, method="taylor", dtype="float64", live=(), **options)
    return out[:, 1], program


@pytest.mark.wide
def test_an_angle_of_a_vector_is_smooth_where_it_is_upright():
    y, _ = free(lambda y, w: -20 * sp.atan2(sp.Rational(1, 100), y), rate=-2.0, ticks=300)
    found = solve_ivp(
        lambda s, u: [u[1], -20 * math.atan2(0.01, u[0])], (0, 0.3), [0.3, -2], "DOP853", T * np.arange(300),
        rtol=1e-13, atol=1e-15, max_step=1e-3,
    ).y[0]  # fmt: skip
    assert found[-1] < 0 < found[0]
    np.testing.assert_allclose(y, found, rtol=0, atol=1e-13)


def test_nothing_is_added_where_nothing_switches():
    k, m, start, u = hl.parameters("k m q_0 u", units="N/m kg m N/m", values=(20.0, 0.1, 0.02, 1.0))
    q = hl.coordinate("q", unit="m", initial=start)
    spring = hl.Scene(u * q, [sp.Eq(m * q.diff(hl.t, 2), -k * q)])
    program, out = run(spring, 400, method="taylor", dtype="float64")
    assert [c.name for c in program.outputs] == ["F"] and "events" not in program.facts
    np.testing.assert_allclose(out[:, 0], 0.02 * np.cos(math.sqrt(200) * T * np.arange(400)), rtol=0, atol=3e-16 * 400)
    assert len(program) < 1.5 * len(hl.compile(spring, method="rk4", T=T, dtype="float64"))


def resting(x, hold="soh"):
    """A ball of 50 g that lies on the handle, which goes along x; returns its place and the reaction."""
    m, g = hl.parameters("m g", units="kg m/s^2", values=(0.05, 9.81))
    y = hl.coordinate("y", unit="m")
    on_hand = hl.contact.Contact(y - hl.x(hl.t), hl.contact.impulse(e=0.3), name="hand")
    ball = hl.mechanics.lagrange(m * y.diff(hl.t) ** 2 / 2 - m * g * y, contacts=(on_hand,))
    _, out = run(hl.Scene(on_hand.force, [ball], watch={"y": y}), len(x), x, method="taylor", dtype="float64", hold=hold)
    assert not out[:, 2].any()
    return out[:, 1], out[:, 0]


@pytest.mark.parametrize("hold, tolerance", [("foh", 3e-6), ("soh", 6e-8)])
def test_what_rests_on_the_handle_goes_along(hold, tolerance):
    t, turn = T * np.arange(1500), 2 * math.pi * 3.1
    x = 5e-3 * (1 - np.cos(turn * t))
    y, N = resting(x, hold)
    # the handle of the next sample is not where the hold expects it, by h^2/2 of the acceleration, or h^3 of its rate
    np.testing.assert_allclose(y[10:], x[10:], rtol=0, atol=tolerance)
    if hold == "soh":
        acceleration = 5e-3 * turn**2 * np.cos(turn * t)
        np.testing.assert_allclose(N[10:], 0.05 * (9.81 + acceleration)[10:], rtol=0, atol=0.05 * 2e-3 * 5e-3 * turn**3)


def test_the_handle_that_falls_away_leaves_it_behind():
    t = T * np.arange(300)
    x = 0.02 - np.maximum(t - 0.05, 0) ** 2 * 10.0  # 20 m/s^2
    x -= x[0]
    y, N = resting(x)
    falls = np.maximum(t - 0.05, 0)
    # the first samples tell of the fall a period or two late, and what is let go then has the speed of that instant
    assert (abs(y - x[0] + 9.81 * falls**2 / 2) <= 2.5 * 20 * T * T + 20 * T * falls).all()
    assert N[40] == pytest.approx(0.05 * 9.81) and not N[60:].any()


@pytest.mark.wide
def test_a_declared_range_is_looked_at_where_the_motion_is_not_linear():
    m, k, start, u = hl.parameters("m k q_0 u", units="kg N/m^3 m N/m", values=(0.05, 5e8, 0.0, 1.0))

    def hardening(**declared):
        q = hl.coordinate("q", unit="m", initial=start, **declared)
        return hl.Scene(u * q, [sp.Eq(m * q.diff(hl.t, 2), -k * q**3)])

    assert "omega" not in hl.compile(hardening(), method="taylor", T=T).facts
    # at 2 cm the spring has 3 k q^2 = 6e5 N/m: 3464 rad/s
    with pytest.raises(ProgramError, match=r"substeps=[34]"):
        hl.compile(hardening(range=(-0.02, 0.02)), method="taylor", T=T)


@pytest.mark.wide
def test_a_contact_that_hardens_is_not_judged_by_where_it_does_not_touch():
    # 5 cm above the floor the law k d^2 would have 2 k d = 1e5 N/m; it touches with none, and 2 mm deep has 4000 N/m
    c = hl.parameters("c", units="N/m^2", values=1e6)
    law = drop(law=lambda q, k, b: hl.when(q <= 0, c * sp.Max(0, -q) ** 2))
    _, exact = run(law, 200, method="taylor", dtype="float64")
    _, rk4 = run(law, 200, method="rk4", substeps=64, dtype="float64")
    np.testing.assert_allclose(exact[:, 0], rk4[:, 0], rtol=0, atol=1e-9)
    # a range down to -5 cm says that it may go there
    q, m = hl.coordinate("q", unit="m", range=(-0.05, 0.1)), hl.parameters("m", units="kg", values=0.05)
    deep = hl.Scene(0, [sp.Eq(m * q.diff(hl.t, 2), c * sp.Max(0, -q) ** 2)])
    with pytest.raises(ProgramError, match="substeps=2"):
        hl.compile(deep, T=T, method="taylor")


@pytest.mark.wide
@pytest.mark.parametrize("law", [lambda y: sp.tanh(1000 * y), lambda y: y / sp.sqrt(y**2 + 1e-6)])
def test_a_series_that_diverges_within_a_step_is_a_fault(law):
    # steep within a millimetre of zero, which it passes at 3.7 m/s: a step of 1 ms is past the poles of the series
    y, program = free(lambda y, w: -20 * law(y), start=0.35, ticks=220)
    assert np.isfinite(y[:187]).all() and not np.isfinite(y[190:]).any()
    assert any("diverges. Use more substeps" in note for note in program.notes)
    fine, _ = free(lambda y, w: -20 * law(y), start=0.35, ticks=220, substeps=16)
    f = sp.lambdify(sp.Symbol("y"), law(sp.Symbol("y")), "math")
    found = solve_ivp(
        lambda s, u: [u[1], -20 * f(u[0])], (0, 0.22), [0.35, 0], "DOP853", T * np.arange(220),
        rtol=1e-13, atol=1e-15, max_step=1e-4,
    ).y[0]  # fmt: skip
    np.testing.assert_allclose(fine, found, rtol=0, atol=1e-12)


def test_a_motion_steeper_at_rest_than_at_its_start_is_refused_with_its_substeps():
    m, F_c, v_s = hl.parameters("m F_c v_s", units="kg N m/s", values=(0.1, 0.5, 1e-3))
    q = hl.coordinate("q", unit="m", rate=0.5)
    smoothed = hl.Scene(0, [sp.Eq(m * q.diff(hl.t, 2), -F_c * sp.tanh(q.diff(hl.t) / v_s))], watch={"q": q})
    with pytest.raises(ProgramError, match=r"omega = 5000 rad/s.*substeps=5"):
        hl.compile(smoothed, method="taylor", T=T)


def test_an_event_in_a_series_that_has_not_converged_counts_as_unlocated():
    def law(y, w):
        return -20 * sp.tanh(300 * y) - hl.when(y < -0.1, 1)

    y, program = free(law, start=0.35, ticks=230)
    assert program.outputs[-1].name == "unlocated"
    outputs = load(program).run(230, np.zeros((230, 1))).outputs[:, 2, 0]
    assert np.isfinite(y).all() and outputs[:180].sum() == 0 and 0 < outputs.sum() < 6


def test_the_test_of_the_series_costs_linear_motions_nothing():
    k, m, start = hl.parameters("k m q_0", units="N/m kg m", values=(20.0, 0.1, 0.02))

    def length(power):
        q = hl.coordinate("q", unit="m", initial=start)
        force = -k * start * (q / start) ** power
        return hl.compile(hl.Scene(0, [sp.Eq(m * q.diff(hl.t, 2), force)], watch={"q": q}), method="taylor", T=T)

    assert "remainder" not in length(1).facts and "diverges" not in str(length(1).notes)
    assert length(3).facts["remainder"] == 1e-4
