"""What live parameters may be set to, against closed forms and the spectral radius of programs compiled there."""

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import t, v, x
from hapticlab.compiler.engines.engine import load
from hapticlab.compiler.tick.live_stability import SLOW

T = 1e-3
z = hl.coordinate("z", unit="m")
theta = hl.coordinate("theta", unit="rad", initial=0.3)
K, B, m, k, x_o = hl.parameters("K B m k x_o", units="N/m N*s/m kg N/m m", values=(500, 0.4, 0.05, 40_000, 0.01))


def coupler(wall=False, **values):
    F = K * (x(t) - z) + B * (v(t) - z.diff(t))
    stop = hl.when(z >= x_o, k * (z - x_o)) if wall else 0
    return hl.Scene(force=F, eom=[sp.Eq(m * z.diff(t, 2), F - stop)], name="coupler")(**values)


def radius(program, **values):
    """Return the spectral radius of a linear tick, run from unit states at other values of its parameters."""
    S = len(program.states)
    at = [values.get(c.name, bound) for c, bound in zip(program.parameters, program.values, strict=True)]
    run = load(program, "interpreter").run(1, [[0.0]], np.repeat(np.array(at)[:, None], S, axis=1), np.eye(S))
    return np.abs(np.linalg.eigvals(run.states)).max()


@pytest.mark.parametrize(("method", "omega_h"), [("semi_implicit_euler", 2.0), ("verlet", 2.0), ("rk4", np.sqrt(8))])
def test_limits_of_an_undamped_spring(method, omega_h):
    """(w h)^2 = K h^2/m at its end: the stiffest spring and the lightest body, the other as it is bound."""
    for substeps in (1, 4):
        program = hl.compile(coupler(B=0), method, T=T, substeps=substeps, live="K m", dtype="float64")
        h = T / substeps
        assert program.facts["margin"] == pytest.approx(omega_h / (100 * h), rel=0.01)
        low, bound, high = program.limits["K"]
        assert (low, bound) == (-np.inf, 500.0) and high == pytest.approx(omega_h**2 * 0.05 / h**2, rel=0.01)
        assert high <= omega_h**2 * 0.05 / h**2 * (1 + 1e-6)
        assert program.limits["m"][0] == pytest.approx(500 * h**2 / omega_h**2, rel=0.01)
        assert program.limits["m"][2] == np.inf


def test_several_together_keep_the_tick_stable():
    """Where each takes a part of the way to its own limit, and the parts add up to 1, the program run there is stable."""
    program = hl.compile(coupler(), "semi_implicit_euler", T=T, dtype="float64", live="K B m", hold="zoh")
    ends = [(name, end, bound) for name, (low, bound, high) in program.limits.items() for end in (low, high) if np.isfinite(end)]
    assert sorted(name for name, *_ in ends) == ["B", "K", "m"]
    assert all(radius(program, **{name: end}) < 1 + 1e-6 for name, end, _ in ends)
    assert all(radius(program, **{name: end * (end / bound) ** 0.01}) > 1 + 1e-4 for name, end, bound in ends)
    generator = np.random.default_rng(3)
    for parts in generator.dirichlet(np.ones(3), 40):
        values = {name: bound * (end / bound) ** part for part, (name, end, bound) in zip(parts, ends, strict=True)}
        assert radius(program, **values) < 1 + 1e-6, values


def test_what_is_bound_to_zero_has_its_part_too():
    """A damper from 0 to 2 m/h; beside it the spring and the body keep nearly what they have without it."""
    program = hl.compile(coupler(B=0), "semi_implicit_euler", T=T, dtype="float64", live="K B m", hold="zoh")
    limits = program.limits
    assert limits["B"][2] == pytest.approx(2 * 0.05 / T, rel=0.01) and limits["K"][2] == pytest.approx(4 * 0.05 / T**2, rel=0.01)
    generator = np.random.default_rng(7)
    for pB, pK, pm in generator.dirichlet(np.ones(3), 40):
        values = {"B": 0.1 * (limits["B"][2] / 0.1) ** pB, "K": 500 * (limits["K"][2] / 500) ** pK,
                  "m": 0.05 * (limits["m"][0] / 0.05) ** pm}  # fmt: skip
        assert radius(program, **values) < 1 + 1e-6, values


def test_a_wall_is_limited_although_the_scene_starts_apart():
    """In contact both springs act: K + k <= 4 m/h^2 without a damper."""
    program = hl.compile(coupler(wall=True, B=0), "semi_implicit_euler", T=T, live="k x_o", dtype="float64")
    assert program.limits["k"][2] == pytest.approx(4 * 0.05 / T**2 - 500, rel=0.01) and set(program.limits) == {"k"}
    assert program.facts["margin"] == pytest.approx(2 / np.sqrt(40_500 / 0.05) / T, rel=0.01)
    (note,) = [note for note in program.notes if "stable for" in note]
    assert "k <= 1.9" in note and "more substeps" in note


def test_implicit_damping_allows_any_damper():
    """h b/m > 2 ends semi-implicit Euler, and limits its damper; not the one that is implicit."""
    explicit = hl.compile(coupler(K=1), "semi_implicit_euler", T=T, live="B", dtype="float64")
    assert explicit.limits["B"][2] == pytest.approx(2 * 0.05 / T, rel=0.01)
    assert "B" not in hl.compile(coupler(K=1), "semi_implicit_euler_damped", T=T, live="B", dtype="float64").limits


def test_what_is_unstable_as_bound_is_noted():
    program = hl.compile(coupler(K=5e5), "semi_implicit_euler", T=T)
    assert program.facts["margin"] < 1 and not program.limits
    assert program.notes[-1].startswith("unstable as bound: semi_implicit_euler in steps of 0.001 s, its longest step is 0.0006")
    gaining = hl.compile(coupler(B=0), "euler", T=T)
    assert gaining.facts["margin"] == 0 and not gaining.limits
    # |1 + i y| of Euler's step on a spring
    doubles = T * np.log(2) / np.log(np.hypot(1, np.sqrt(500 / 0.05) * T))
    assert gaining.facts["doubles_s"] == pytest.approx(doubles, rel=5e-3)


def test_what_grows_slowly_is_noted_and_limited_to_slow_growth():
    """Heun's step multiplies what vibrates by (1 + y^4/4)^(1/2), y = omega h."""
    program = hl.compile(coupler(B=0), "heun", T=T, live="K")
    assert program.facts["margin"] == 0 and "an oscillation doubles in" in program.notes[0]
    assert program.facts["doubles_s"] == pytest.approx(2 * T * np.log(2) / np.log1p(0.1**4 / 4), rel=5e-3)
    y = (4 * np.expm1(2 * T * np.log(2) / SLOW)) ** 0.25
    assert program.limits["K"][2] == pytest.approx(0.05 * (y / T) ** 2, rel=0.02)


@pytest.mark.parametrize("name", ["mass_spring_damper", "rolling", "pendulum_on_the_handle", "gears", "two_masses"])
@pytest.mark.always("mass_spring_damper", "gears")
def test_the_margin_is_that_of_step_limit(name):
    """Of the same motion at the same places, the start and where all hangs straight, implicit damping included."""
    scene = getattr(hl.library, name)()
    places = [{}, {"theta": 0.0}] if name.startswith("pendulum") else {}
    for method in ("semi_implicit_euler_damped", "rk4"):
        margin = hl.compile(scene, method, T=T).facts["margin"]
        assert margin == pytest.approx(hl.stability.step_limit(scene, method, T=T, at=places).margin, rel=0.01)


def test_rolling_is_stable_at_2_ms():
    program = hl.compile(hl.library.rolling(), "semi_implicit_euler_damped", T=2e-3)
    assert program.facts["margin"] > 20 and "doubles_s" not in program.facts


def test_a_lighter_body_has_its_own_implicit_damping():
    """At h b/m = 50 a mass bound at a hundredth of it would say otherwise."""
    program = hl.compile(coupler(), "semi_implicit_euler_damped", T=T, dtype="float64", live="K m", hold="zoh")
    steps = program.limits.steps
    for values in ({"m": 8e-6}, {"m": 1e-3, "K": 4e5}, {"m": 1e-3, "K": 4e6}, {"m": 5.0, "K": 2e7}):
        largest = radius(program, **values)
        assert steps.growth(values) == pytest.approx(largest, rel=1e-9)
        assert (steps.growth(values) > steps.allowed) == (largest > 1 + 1e-4)


def test_a_window_of_growth_between_stable_springs_is_found():
    """Heun's step gains about omega h = 1 on a spring that is damped a little by its damper, which gains nothing at 2.2."""
    program = hl.compile(coupler(K=20, B=0.02), "heun", T=T, live="K", dtype="float64", hold="zoh")
    limit = program.limits["K"][2]
    assert radius(program, K=limit) < 1 + 7e-5 < radius(program, K=1.05 * limit)
    assert program.limits.steps.growth({"K": 1.05 * limit}) == pytest.approx(radius(program, K=1.05 * limit), rel=1e-9)


def test_what_turns_is_limited_where_it_first_grows():
    """K + 1e4 K sin(alpha)^2 <= 4 m/h^2, stable again where alpha has turned to pi."""
    alpha = hl.parameters("alpha", units="rad", values=0, ranges=(0, 3.14159))
    F = K * (x(t) - z)
    scene = hl.Scene(force=F, eom=[sp.Eq(m * z.diff(t, 2), F - 1e4 * K * sp.sin(alpha) ** 2 * z)])
    program = hl.compile(scene, "verlet", T=T, live="alpha", dtype="float64")
    assert program.limits["alpha"][2] == pytest.approx(np.arcsin(np.sqrt((4 * 0.05 / T**2 - 500) / 5e6)), rel=0.01)
    steps = program.limits.steps
    assert steps.growth({"alpha": 3.14159}) <= steps.allowed < steps.growth({"alpha": 1.5})


def test_what_is_bound_to_zero_does_not_vibrate_and_is_limited():
    program = hl.compile(coupler(K=0, B=0), "semi_implicit_euler", T=T, live="K")
    assert "margin" not in program.facts and program.limits["K"][2] == pytest.approx(4 * 0.05 / T**2, rel=0.01)


def test_a_wall_that_is_bound_to_nothing_is_seen_where_it_is_set():
    program = hl.compile(coupler(wall=True, B=0)(k=0), "semi_implicit_euler", T=T, live="k x_o", dtype="float64")
    steps = program.limits.steps
    assert steps.growth({"k": 1e5}) < steps.allowed < steps.growth({"k": 3e5})


def test_what_rises_slowly_hides_no_blow_up():
    """A coordinate that rises at 0.01 1/s beside a spring past its limit, which doubles at once."""
    u, rise = hl.coordinate("u", unit="m"), hl.parameters("rise", units="1/s^2", values=1e-4)
    F = K * (x(t) - z)
    eom = [sp.Eq(m * z.diff(t, 2), F), sp.Eq(u.diff(t, 2), rise * u)]
    for stiffness, least, most in ((1e6, 0.0, 1e-3), (500, np.inf, np.inf)):
        scene = hl.Scene(force=F, eom=eom, watch=[u])(K=stiffness)
        program = hl.compile(scene, "semi_implicit_euler", T=T, live="K", dtype="float64")
        assert least <= program.facts.get("doubles_s", np.inf) <= most
        steps = program.limits.steps
        assert steps.growth({"K": 1e6}) > 10 and steps.growth({"K": 500}) <= steps.allowed


def test_nothing_is_claimed_of_what_is_fed_back_by_samples():
    y = hl.signal("y", unit="m")
    for held, more in ((hl.laws.delay(z), []), (y(hl.n), [sp.Eq(y(hl.n), z)])):
        F = K * (x(t) - z)
        scene = hl.Scene(force=F, eom=[sp.Eq(m * z.diff(t, 2), F - k * held), *more])
        program = hl.compile(scene, "semi_implicit_euler", T=T, live="K")
        assert "margin" not in program.facts and not program.limits and program.limits.steps is None
        assert any("fed back through samples, by" in note for note in program.notes)


def test_nothing_is_said_where_nothing_is_known_or_needed():
    stiffness = hl.parameters("K_1", units="N/m")
    F = stiffness * (x(t) - z)
    unbound = hl.compile(hl.Scene(force=F, eom=[sp.Eq(m * z.diff(t, 2), F)]), T=T)
    exact = hl.compile(coupler(K=5e6), "exact", T=T, live=())
    wall = hl.compile(hl.wall()(k=150, x_o=0.01), T=T)
    assert not any("margin" in program.facts or program.limits for program in (unbound, exact, wall))


def test_a_declared_end_that_is_stable_is_no_limit():
    narrow = hl.parameters("K", units="N/m", values=500, ranges=(100, 900))
    F = narrow * (x(t) - z)
    program = hl.compile(hl.Scene(force=F, eom=[sp.Eq(m * z.diff(t, 2), F)]), "verlet", T=T, live="K")
    assert not program.limits and (program.parameters[0].low, program.parameters[0].high) == (100, 900)


def test_a_pendulum_is_looked_at_at_rest_too():
    """Friction steep in the rate at rest, c tanh(w/w_s)/w_s: it starts fast, where it is flat."""
    c, w_s, J = hl.parameters("c w_s J", units="N*m rad/s kg*m^2", values=(1e-3, 0.01, 1e-4))
    fast = hl.coordinate("phi", unit="rad", initial=0.0, rate=20.0)
    drag = c * sp.tanh(fast.diff(t) / w_s)
    scene = hl.Scene(force=K * x(t), eom=[sp.Eq(J * fast.diff(t, 2), -drag)], watch=[fast])
    program = hl.compile(scene, "euler", T=T, live="c", dtype="float64")
    assert program.facts["margin"] == pytest.approx(2 / (1e-3 / 0.01 / 1e-4) / T, rel=0.01)
    assert program.limits["c"][2] == pytest.approx(2 * 1e-4 * 0.01 / T, rel=0.01)
    assert any("stable for small motions about the positions that were examined" in note for note in program.notes)


def test_when_the_force_is_computed_does_not_change_what_is_stable():
    """The impulse of ``force_at="mean"`` is fed back to nothing."""
    before, mean = (hl.compile(coupler(wall=True), "rk4", T=1e-3, force_at=when) for when in ("before", "mean"))
    assert dict(mean.limits) == dict(before.limits) and set(mean.limits) == {"K", "B", "k", "m"}
    assert mean.facts["margin"] == before.facts["margin"]
