"""Lowering: samples and histories, difference equations, time, what is left out, and every refusal."""

import math

import numpy as np
import pytest
import sympy as sp
from motions import at_tick
from scipy.signal import lfilter

import hapticlab as hl
from hapticlab import T, n, t, v, x
from hapticlab.compiler.engines.engine import load
from hapticlab.errors import HapticlabError, ParameterError, ProgramError, SceneError

k, m, K, b, tau = hl.parameters("k m K b tau", units="N/m kg N/m N*s/m s", values=(100.0, 0.1, 400.0, 2.0, 4e-3))
z = hl.coordinate("z", unit="m")
F_c = hl.laws.virtual_coupler(z, K=K, b=b)
mass = hl.Scene(force=F_c, eom=[sp.Eq(m * z.diff(t, 2), F_c)], name="mass")
MOTION = 0.01 * np.random.default_rng(1).normal(size=40).cumsum()


def force(scene, motion=MOTION, velocity=None, **options):
    program = hl.compile(scene, T=1e-3, dtype="float64", **options)
    inputs = np.column_stack([motion, velocity] if len(program.inputs) == 2 else [motion])
    return load(program).run(len(motion), inputs).outputs[:, 0, 0]


def past(motion, lag):
    return np.concatenate([np.full(lag, motion[0]), motion[: len(motion) - lag]])


def test_history_starts_at_the_first_measured_sample():
    computed = force(hl.Scene(force=k * (x(n) - 2 * x(n - 1) + 3 * x(n - 4))))
    expected = 100 * (MOTION - 2 * past(MOTION, 1) + 3 * past(MOTION, 4))
    np.testing.assert_allclose(computed, expected, rtol=1e-13, atol=1e-15)


def test_the_backward_difference_is_zero_at_the_first_sample():
    computed = force(hl.Scene(force=b * (v(n) + v(n - 1))))
    difference = (MOTION - past(MOTION, 1)) / 1e-3
    expected = 2 * (difference + np.concatenate([[0.0], difference[:-1]]))
    np.testing.assert_allclose(computed, expected, rtol=1e-12)


def test_a_measured_velocity_is_an_input_with_its_own_history():
    velocity = np.cos(np.arange(40.0))
    program = hl.compile(hl.Scene(force=b * (v(n) - v(n - 2))), T=1e-3, dtype="float64", velocity="measured")
    computed = load(program).run(40, np.column_stack([MOTION, velocity])).outputs[:, 0, 0]
    np.testing.assert_allclose(computed, 2 * (velocity - past(velocity, 2)), rtol=1e-13)


def test_delay_of_any_expression_is_its_past_value():
    inner = k * x(n) ** 2 / hl.parameters("L", units="m", values=1.0)
    computed = force(hl.Scene(force=hl.laws.delay(inner) + hl.laws.delay(hl.laws.delay(inner))))
    np.testing.assert_allclose(computed, 100 * (past(MOTION, 1) ** 2 + past(MOTION, 2) ** 2), rtol=1e-13)


def test_a_difference_equation_is_scipys_filter():
    """First-order low pass y(n) = y(n-1) + T/(T + tau) (x(n) - y(n-1)) and a second one behind it."""
    y, w = hl.signal("y", unit="m"), hl.signal("w", unit="m")
    eom = [
        sp.Eq(y(n), y(n - 1) + T / (T + tau) * (x(n) - y(n - 1))),
        sp.Eq(w(n), y(n) / 4 + w(n - 1) / 2 + w(n - 2) / 4),
    ]
    a = 1e-3 / (1e-3 + 4e-3)
    low_passed = lfilter([a], [1, a - 1], MOTION)
    expected = 100 * lfilter([0.25], [1, -0.5, -0.25], low_passed)
    np.testing.assert_allclose(force(hl.Scene(force=k * w(n), eom=eom)), expected, rtol=1e-12, atol=1e-14)


def test_an_algebraic_loop_is_refused_with_its_path():
    y, w = hl.signal("y", unit="m"), hl.signal("w", unit="m")
    with pytest.raises(SceneError, match=r"y\(n\) -> w\(n\) -> y\(n\)"):
        hl.compile(hl.Scene(force=k * y(n), eom=[sp.Eq(y(n), w(n)), sp.Eq(w(n), y(n))]), T=1e-3)
    with pytest.raises(SceneError, match=r"y\(n\) has no equation"):
        hl.compile(hl.Scene(force=k * y(n)), T=1e-3)


@pytest.mark.parametrize("start", [2**22, 2**24 + 1, 10**9, 2**31 - 2])
def test_time_is_counted_in_whole_ticks(start):
    """After 2^22 ticks a float32 sum of 1 ms would be wrong by seconds; a count is right to a rounding, and stays so."""
    clock = hl.compile(hl.Scene(force=hl.parameters("c", units="N/s", values=1.0) * t, name="clock"), T=1e-3)
    run = load(clock).run(3, np.zeros((3, 1)), states=at_tick(clock, start))
    expected = [np.float32(start + i) * np.float32(1e-3) for i in range(3)]
    assert run.outputs[:, 0, 0].tolist() == [float(e) for e in expected]
    np.testing.assert_array_equal(run.states, at_tick(clock, start + 3))


def test_time_inside_a_step_is_the_time_of_the_stage():
    """z' = c t needs t at the stages: Heun integrates it exactly, z(1 s) = c/2."""
    c = hl.parameters("c", units="m/s^2", values=3.0)
    ramp = hl.Scene(force=0 * k * x(n), eom=[sp.Eq(z.diff(t), c * t)], watch="z")
    program = hl.compile(ramp, "heun", T=0.125, substeps=2, dtype="float64")
    assert load(program).run(9, np.zeros((9, 1))).outputs[-1, 1, 0] == pytest.approx(1.5, rel=1e-15)


def test_initial_values_may_start_at_the_handle():
    start = hl.coordinate("z", unit="m", initial=x(n), rate=hl.parameters("r", units="m/s", values=0.5))
    F = hl.laws.virtual_coupler(start, K=K, b=b)
    scene = hl.Scene(force=F, eom=[sp.Eq(m * start.diff(t, 2), F)], watch={"z": start, "w": start.diff(t)})
    program = hl.compile(scene, T=1e-3, dtype="float64")
    first = load(program).run(1, np.array([[0.07]])).outputs[0, :, 0]
    assert first.tolist() == [-1.0, 0.07, 0.5]  # F = b (0 - 0.5): no spring force at the start


def test_what_no_output_can_see_is_left_out_and_reported():
    y = hl.coordinate("y", unit="m")
    hanging = [sp.Eq(m * y.diff(t, 2), -K * y), mass.eom[0]]
    alone, both = hl.compile(mass, T=1e-3), hl.compile(hl.Scene(force=F_c, eom=hanging, name="both"), T=1e-3)
    assert len(both) == len(alone)
    assert "y" in both.notes[0]
    assert "dy/dt" in both.notes[0]
    watched = hl.compile(hl.Scene(force=F_c, eom=hanging, watch="y"), T=1e-3)
    assert len(watched) > len(both)


def test_what_is_not_live_becomes_a_constant():
    folded = hl.compile(mass, T=1e-3, live=("K",))
    assert [c.name for c in folded.parameters] == ["K"]
    assert len(folded) < len(hl.compile(mass, T=1e-3))
    same = [force(mass, live=live) for live in (None, ("K",), ())]
    np.testing.assert_allclose(same[1:], [same[0]] * 2, rtol=1e-9)
    with pytest.raises(ParameterError, match="q is not a parameter"):
        hl.compile(mass, T=1e-3, live=("q",))


def test_a_massless_coupler_is_a_first_order_scene():
    """b z' = K (x - z) + b v - K z, a closed form for a step: F = K (x - z) + b (v - z')."""
    F = hl.laws.virtual_coupler(z, K=K, b=b)
    scene = hl.Scene(force=K * (x(t) - z), eom=[sp.Eq(F, K * z)], watch="z")
    program = hl.compile(scene, "rk4", T=1e-4, hold="zoh", dtype="float64")
    run = load(program).run(101, np.full((101, 1), 0.01)).outputs[-1, 1, 0]
    assert run == pytest.approx(0.005 * (1 - math.exp(-2 * 400 / 2.0 * 0.01)), rel=1e-8)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"T": 0.0}, "T = 0.0 s; a sampling period needs T > 0"),
        ({"T": -1e-3}, "needs T > 0"),
        ({"T": math.nan}, "needs T > 0"),
        ({"T": math.inf}, "needs T > 0"),
        ({"T": 1e-3, "method": "rk5"}, "method = 'rk5'; needs one of euler, semi_implicit_euler"),
        ({"T": 1e-3, "hold": "toh"}, "hold = 'toh'; needs one of zoh, foh, soh"),
        ({"T": 1e-3, "dtype": "float16"}, "needs one of float32, float64"),
        ({"T": 1e-3, "velocity": "guess"}, "needs one of backward_difference, measured"),
        ({"T": 1e-3, "substeps": 0}, "substeps = 0; needs a whole number >= 1"),
        ({"T": 1e-3, "substeps": 2.5}, "needs a whole number"),
        ({"T": 1e-3, "substeps": True}, "needs a whole number"),
        ({"T": True}, "T = True; a sampling period is a number in s or a text"),
        ({"T": None}, "T = None; a sampling period is a number in s or a text"),
        ({"T": "1 N"}, "T = '1 N'; needs a quantity in s"),
        ({"T": 1e-3, "method": ["rk4"]}, "needs one of euler"),
        ({"T": 1e-3, "live": 5}, "live = 5; needs names of parameters"),
        ({"T": 1e-3, "live": [5]}, "needs names of parameters"),
        ({"T": 1e-3, "live": "Km"}, "live: Km is not a parameter"),
    ],
)
def test_an_option_that_is_not_one_is_refused(options, words):
    with pytest.raises(HapticlabError, match=words):
        hl.compile(mass, **options)


def test_a_period_may_be_a_text_with_its_unit():
    assert hl.compile(hl.wall(), T="0.5 ms").T == 0.5e-3


@pytest.mark.parametrize(("T", "said"), [(9e-6, "no board"), (0.2, "as a step"), (1e-5, None), (0.1, None)])
def test_a_period_that_no_loop_has_is_noted(T, said):
    noted = [note for note in hl.compile(hl.wall(), T=T, dtype="float64").notes if note.startswith(f"T = {T:g} s")]
    assert [said in note for note in noted] == ([True] if said else [])


def test_options_may_be_numbers_of_any_library_and_parameters_themselves():
    plain = hl.compile(mass, T=1e-3, substeps=2, live=("K", "m"))
    assert hl.compile(mass, T=sp.Rational(1, 1000), substeps=np.int64(2), live="K m") == plain
    assert hl.compile(mass, T=np.float64(1e-3), substeps=2, live=[K, m]) == plain
    assert hl.compile(mass, T=np.float32(1e-3)).T == float(np.float32(1e-3))
    assert [c.name for c in hl.compile(mass, T=1e-3, live=K).parameters] == ["K"]
    with pytest.raises(SceneError, match="is not a scene"):
        hl.compile(F_c, T=1e-3)


def test_an_equation_nothing_needs_is_reported():
    y, w = hl.signal("y", unit="m"), hl.signal("w", unit="m")
    eom = [sp.Eq(y(n), w(n - 1)), sp.Eq(w(n), x(n))]
    assert hl.compile(hl.Scene(force=k * x(n), eom=eom), T=1e-3).notes == (
        "left out, because no output depends on it: y(n), w(n)",
    )
    assert hl.compile(hl.Scene(force=k * y(n), eom=eom), T=1e-3).notes == ()


def required_damping(program):
    """Return max over frequency of T/(2(1 - cos a)) Re{(1 - e^-ja) H(e^ja)}: what a passive device must dissipate."""
    size, engine = len(program.states), load(program)

    def tick(sample, states):
        run = engine.run(1, np.array([[sample]]), states=np.array(states, float)[:, None])
        return np.concatenate([run.outputs[0, 0], run.states[:, 0]])

    columns = np.array([tick(0.0, unit) for unit in np.eye(size)]).T
    C, A = columns[0], columns[1:]
    D, *B = tick(1.0, np.zeros(size))
    angles = np.linspace(0.02, np.pi, 2001)
    H = np.array([C @ np.linalg.solve(np.exp(1j * a) * np.eye(size) - A, B) + D for a in angles])
    return (program.T / (2 * (1 - np.cos(angles))) * ((1 - np.exp(-1j * angles)) * H).real).max()


@pytest.mark.parametrize("hold", ["foh", "soh"])
def test_the_velocity_in_a_force_is_the_plain_difference_which_asks_for_less_damping(hold):
    """K T/2 + b is the least a coupler needs; looking ahead in the force would take one b more, 2.29 N s/m."""
    program = hl.compile(mass(K=500.0, b=1.0, m=0.05), T=1e-3, hold=hold, dtype="float64")
    assert 1.25 < required_damping(program) < 1.05 * 1.25
    assert required_damping(hl.compile(hl.wall(unilateral=None)(k=500), T=1e-3, dtype="float64")) == pytest.approx(0.25)


def test_a_misspelt_option_never_passes():
    with pytest.raises(TypeError, match="methd"):
        hl.compile(mass, T=1e-3, methd="rk4")


def test_the_force_may_not_use_what_the_equations_solve_for():
    with pytest.raises(SceneError, match=r"the equations of motion are solved for Derivative\(z\(t\),"):
        hl.compile(hl.Scene(force=m * z.diff(t, 2), eom=mass.eom), T=1e-3)
    with pytest.raises(SceneError, match="a condition is not a number"):
        hl.compile(hl.Scene(force=F_c, eom=mass.eom, watch={"inside": x(n) >= 0}), T=1e-3)


def test_an_unbound_parameter_is_named_when_the_program_runs():
    wall = hl.wall()
    with pytest.raises(ProgramError, match=r"no value for k; bind it: scene\(k=...\)"):
        load(hl.compile(wall, T=1e-3)).run(1, np.zeros((1, 1)))


def test_printing_a_program_lists_every_instruction_and_its_facts():
    program = hl.compile(mass, "rk4", T=1e-3)
    shown = str(program)
    assert f"{len(program)} instructions" in shown
    assert sum(line.startswith("  %") for line in shown.split("tick:")[1].splitlines()) == len(program)
    assert all(word in shown for word in ("method = rk4", "hold = soh", "K = 400 N/m", "dz/dt [m/s]", "next   z"))


@pytest.mark.wide
def test_an_eight_link_pendulum_is_a_straight_line():
    """Absolute angles: M_ij = c_ij cos(q_i - q_j), a symmetric matrix of rank 8, solved in the program."""
    N = 8
    q = [hl.coordinate(f"q{i}", unit="rad", initial=0.1 * (i + 1)) for i in range(N)]
    J, W = hl.parameters("J W", units="kg*m^2 N*m", values=(1e-3, 0.1))
    weight = [[N - max(i, j) for j in range(N)] for i in range(N)]
    rows = [
        sp.Eq(
            sum(
                J * weight[i][j] * (sp.cos(q[i] - q[j]) * q[j].diff(t, 2) + sp.sin(q[i] - q[j]) * q[j].diff(t) ** 2)
                for j in range(N)
            ),
            -W * (N - i) * sp.sin(q[i]),
        )
        for i in range(N)
    ]
    scene = hl.Scene(force=0 * k * x(n), eom=rows, watch={"q7": q[7]}, name="8 links")
    program = hl.compile(scene, "rk4", T=1e-3, dtype="float64")
    # one inverse pivot a link and stage; the first one, 8 J, is the same at all four
    assert sum(i.op == "div" for i in program.tick.instructions) == 4 * N - 3
    links = load(program).run(101, np.zeros((101, 1))).outputs[-1, 1, 0]
    assert links == pytest.approx(pendulum_by_scipy(weight, 0.1), abs=1e-9)


def pendulum_by_scipy(weight, time):
    from scipy.integrate import solve_ivp

    C = np.array(weight, float)

    def rhs(_, y):
        angle, rate = y[:8], y[8:]
        difference = angle[:, None] - angle
        right = -0.1 * np.arange(8, 0, -1) * np.sin(angle) - 1e-3 * (C * np.sin(difference)) @ rate**2
        return np.concatenate([rate, np.linalg.solve(1e-3 * C * np.cos(difference), right)])

    start = np.concatenate([0.1 * np.arange(1, 9), np.zeros(8)])
    return solve_ivp(rhs, (0, time), start, method="DOP853", rtol=1e-13, atol=1e-15).y[7, -1]


def test_a_body_may_start_where_another_one_starts():
    """The start of z is the start of y, and that a parameter no equation holds."""
    r = hl.parameters("r", units="m", values=0.02)
    y = hl.coordinate("y", unit="m", initial=r)
    follower = hl.coordinate("z", unit="m", initial=y)
    eom = [sp.Eq(m * follower.diff(t, 2), K * (x(t) - follower)), sp.Eq(b * y.diff(t), -K * y)]
    program = hl.compile(hl.Scene(force=K * (x(t) - follower), eom=eom), T=1e-3, dtype="float64")
    assert load(program).run(1, np.zeros((1, 1))).outputs[0, 0, 0] == -400.0 * 0.02
