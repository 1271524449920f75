"""Step limits predicted, against blow-ups found in runs, spectral radii of compiled ticks, and closed forms."""

import pickle

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import t, v, x
from hapticlab.compiler.engines.engine import load
from hapticlab.errors import AnalysisError, HapticlabError, ParameterError
from hapticlab.limits.port import tick_map

z, theta = hl.coordinate("z", unit="m", initial=1e-3), hl.coordinate("theta", unit="rad", initial=0.3)
K, B, m, k, x_o = hl.parameters("K B m k x_o", units="N/m N*s/m kg N/m m", values=(500, 0.4, 0.05, 40_000, 0.01))
#: those with a stable interval on lightly damped oscillations
WITH_INTERVAL = (
    "semi_implicit_euler", "semi_implicit_euler_damped", "verlet", "ssprk3", "adams_bashforth3", "rk4",
)  # fmt: skip


def coupler(**values):
    F = K * (x(t) - z) + B * (v(t) - z.diff(t))
    return hl.Scene(force=F, eom=[sp.Eq(m * z.diff(t, 2), F)], name="a mass on a coupler")(**values)


def chain(n=3):
    """Return masses in a row, the first on the coupler, the last on the ground."""
    qs = [hl.coordinate(f"q{i}", unit="m", initial=1e-3 * (-1) ** i) for i in range(n)]
    stretch = [x(t) - qs[0], *(a - b for a, b in zip(qs, qs[1:], strict=False)), qs[-1]]
    rates = [v(t) - qs[0].diff(t), *(d.diff(t) for d in stretch[1:])]
    forces = [K * d * (1 + i) + B / 20 * rate for i, (d, rate) in enumerate(zip(stretch, rates, strict=True))]
    eom = [sp.Eq(m * q.diff(t, 2), forces[i] - forces[i + 1]) for i, q in enumerate(qs)]
    return hl.Scene(force=forces[0], eom=eom, name="a chain")


def grows(scene, method, T, ticks):
    """Tell whether a run with the handle held ends a thousand times above where it began."""
    program = hl.compile(scene, method, T=T, hold="zoh", dtype="float64", live=())
    run = load(program, "interpreter").run(ticks, np.zeros((ticks, 1)))
    peak = np.abs(run.outputs[:, 0, 0])
    return not np.isfinite(peak).all() or peak[-20:].max() > 1e3 * peak[:5].max()


@pytest.mark.parametrize("method", WITH_INTERVAL)
@pytest.mark.parametrize("scene", [coupler(), chain()], ids=["coupler", "chain"])
@pytest.mark.always("coupler-semi_implicit_euler", "coupler-verlet", "coupler-rk4")
def test_blow_ups_are_found_where_they_are_predicted(scene, method):
    """Within 2 % on linear scenes: no growth just below, a thousandfold growth just above."""
    limit = hl.stability.step_limit(scene, method, T=1e-3)
    assert limit.kind == "linear" and 0 < limit.h_max < 0.1
    assert not grows(scene, method, 0.98 * limit.h_max, 200)
    assert grows(scene, method, 1.02 * limit.h_max, 600)


@pytest.mark.parametrize("method", ["euler", "heun", "midpoint", "adams_bashforth2"])
def test_without_an_interval_the_gain_of_energy_is_predicted(method):
    """By the spectral radius of the compiled tick; numbers of the spring at w h = 0.1."""
    scene = coupler(B=0)
    limit = hl.stability.step_limit(scene, method, T=1e-3)
    assert limit.h_max == 0 and limit.verdict == "unstable"
    A, *_ = tick_map(hl.compile(scene, method, T=1e-3, hold="zoh", dtype="float64", live=()))
    assert limit.energy_gain == pytest.approx(np.abs(np.linalg.eigvals(A)).max() ** 2 - 1, rel=1e-6)
    expected = {"euler": 1e-2, "heun": 2.5e-5, "midpoint": 2.5e-5, "adams_bashforth2": 5.1e-5}[method]
    assert limit.energy_gain == pytest.approx(expected, rel=1e-2)


@pytest.mark.parametrize("method", ["semi_implicit_euler", "semi_implicit_euler_damped", "verlet", "adams_bashforth3", "rk4"])
@pytest.mark.parametrize("substeps", [1, 3])
@pytest.mark.always("1-rk4")
def test_the_step_matrix_is_that_of_the_compiled_tick(method, substeps):
    """The tick, run from unit states, crosses the unit circle within a thousandth of the predicted longest step."""
    h = hl.stability.step_limit(chain(), method, T=1e-3).h_max

    def radius(h):
        program = hl.compile(chain(), method, T=h * substeps, substeps=substeps, hold="zoh", dtype="float64", live=())
        return np.abs(np.linalg.eigvals(tick_map(program)[0])).max()

    assert radius(h * 0.999) < 1 + 1e-9 and radius(h * 1.001) > 1 + 1e-4


def test_each_mode_has_its_limit():
    """A body that meets a wall: semi-implicit Euler in contact, 2 (sqrt(1 + zeta^2) - zeta)/w with both springs."""
    F = K * (x(t) - z) + B * (v(t) - z.diff(t))
    scene = hl.Scene(force=F, eom=[sp.Eq(m * z.diff(t, 2), F - hl.when(z >= x_o, k * (z - x_o)))])
    limit = hl.stability.step_limit(scene, "semi_implicit_euler", T=1e-3)
    apart, touching = limit.modes
    for mode, stiffness in ((apart, 500), (touching, 40_500)):
        w = np.sqrt(stiffness / 0.05)
        zeta = 0.4 / (2 * 0.05 * w)
        assert mode.h_max == pytest.approx(2 * (np.hypot(1, zeta) - zeta) / w, rel=1e-5)
    assert limit.worst is touching and limit.kind == "piecewise linear" and touching.mode == "z(t) >= x_o"
    w_d = np.sqrt(40_500 / 0.05 - 4.0**2)
    assert limit.steps_per_contact == pytest.approx(np.pi / (w_d * 1e-3), rel=1e-9) and limit.verdict == "close"
    assert touching.point == "z = 0.011"


def test_a_scene_that_is_not_linear_says_where_it_was_looked_at():
    """J of a pendulum is [[0, 1], [-g/l cos theta, 0]]: it changes with the angle, and so does the limit."""
    F = K * (x(t) - z)
    g, l = hl.parameters("g l", units="m/s^2 m", values=(9.81, 0.2))
    swing = sp.Eq(l * theta.diff(t, 2), -g * sp.sin(theta) + F / m)
    scene = hl.Scene(force=F, eom=[sp.Eq(m * z.diff(t, 2), F), swing], watch=[theta], name="pendulum")
    limit = hl.stability.step_limit(scene, "verlet", T=1e-3, at=[{"theta": 0.0}, {"theta": 1.0}, {"theta": 3.0}])
    assert limit.small_signal and "small motions" in str(limit)
    for mode, angle in zip(limit.modes, (0.0, 1.0, 3.0), strict=True):
        squares = np.sort([-(100.0**2)] * 2 + [-9.81 / 0.2 * np.cos(angle)] * 2)
        assert np.sort((mode.eigenvalues**2).real) == pytest.approx(squares, rel=1e-9)
        assert f"theta = {angle:g}" in mode.point
    # upright it falls by itself; the coupler's spring sets the limit all the same
    assert limit.modes[2].h_max == pytest.approx(2 / 100, rel=1e-4)


def test_what_changes_with_time_and_what_strikes_is_not_called_exact():
    """Mathieu's spring; a ball that bounces by impulses, looked at in the air."""
    f = hl.parameters("f", units="Hz", values=3)
    F = K * (x(t) - z) * (1 + sp.sin(2 * sp.pi * f * t) / 2)
    assert hl.stability.step_limit(hl.Scene(force=F, eom=[sp.Eq(m * z.diff(t, 2), F)]), T=1e-3).small_signal
    ball = hl.stability.step_limit(hl.library.ball_on_the_paddle(), "taylor", T=1e-3)
    assert ball.kind == "piecewise linear" and ball.worst.mode == "everywhere, touch free"


def test_a_hardening_spring_is_looked_at_where_it_is_stiff():
    """K + 3 k_3 z^2 at 50 mm: semi-implicit Euler is stable up to 2 sqrt(m/that)."""
    k_3 = hl.parameters("k_3", units="N/m^3", values=1e6)
    F = K * (x(t) - z)
    scene = hl.Scene(force=F, eom=[sp.Eq(m * z.diff(t, 2), F - k_3 * z**3)])
    limit = hl.stability.step_limit(scene, "semi_implicit_euler", T=1e-3)
    assert limit.h_max == pytest.approx(2 * np.sqrt(0.05 / (500 + 3e6 * 0.05**2)), rel=1e-3)
    assert limit.small_signal and "within 50 mm" in str(limit) and "0.05" in limit.worst.point
    assert len(limit.modes) == 2  # the start, and where it is worst


@pytest.mark.parametrize("kind", ["delay", "signal"])
def test_what_is_held_and_felt_is_looked_at_in_the_tick(kind):
    """A spring that feels its body a sample late gives it energy, which its own damping outweighs or not."""
    felt = hl.signal("felt", unit="m")
    k_d, c = hl.parameters("k_d c", units="N/m N*s/m", values=(2000, 0.1))
    F = K * (x(t) - z)
    late = hl.laws.delay(z) if kind == "delay" else felt(hl.n - 1)
    body = sp.Eq(m * z.diff(t, 2), F - c * z.diff(t) - k_d * late)
    scene = hl.Scene(force=F, eom=[body] if kind == "delay" else [body, sp.Eq(felt(hl.n), z)])
    verdicts = set()
    for damping in (0.1, 10.0):
        limit = hl.stability.step_limit(scene(c=damping), T=1e-3)
        program = hl.compile(scene(c=damping), T=1e-3, dtype="float64", live=())
        expected = np.abs(np.linalg.eigvals(tick_map(program)[0])).max()
        assert limit.held == pytest.approx(expected, rel=1e-9) and limit.margin > 1
        assert limit.verdict == ("unstable" if expected > 1 else "stable") and "linear: exact" not in str(limit)
        verdicts.add(limit.verdict)
    assert len(verdicts) == 2


def test_the_picture_crosses_one_at_the_longest_step():
    limit = hl.stability.step_limit(coupler(), "rk4", T=1e-3)
    line, step = limit.plot().axes[0].lines
    h, radius = line.get_data()
    assert h[np.argmax(radius > 1)] == pytest.approx(1e3 * limit.h_max, rel=0.05)
    assert step.get_xdata()[0] == 1.0


def test_what_is_exact_has_no_longest_step_and_taylor_takes_a_radian():
    scene = coupler(B=0)
    assert hl.stability.step_limit(scene, "exact", T=0.5).h_max == np.inf
    assert hl.stability.step_limit(scene, "taylor", T=1e-3).h_max == pytest.approx(1 / 100, rel=1e-9)
    assert hl.stability.step_limit(scene, "exact+rk4", T=1e-3).h_max == np.inf
    assert hl.stability.step_limit(hl.wall()(k=150, x_o=0.01), T=1e-3).h_max == np.inf


def test_beside_the_exact_part_the_rest_alone_has_a_longest_step():
    """A spring that stiffens, driven by the exact carriage: from rest it has the frequency of its linear spring."""
    y = hl.coordinate("y", unit="m")
    c = hl.parameters("c", units="N/m^3", values=1000.0)
    F = K * (x(t) - z)
    stiffens = sp.Eq(m * y.diff(t, 2), K * (z - y) - c * y**3)
    scene = hl.Scene(force=F + K * y, eom=[sp.Eq(m * z.diff(t, 2), F), stiffens])(K=500)
    alone = hl.Scene(force=K * y, eom=[sp.Eq(m * y.diff(t, 2), -K * y - c * y**3)])(K=500)
    at = {"x": 0.0, "z": 0.0, "y": 0.0}
    limit = hl.stability.step_limit(scene, "exact+rk4", T=1e-3, at=at)
    assert limit.h_max == pytest.approx(hl.stability.step_limit(alone, "rk4", T=1e-3, at={"x": 0.0, "y": 0.0}).h_max, rel=1e-6)
    assert limit.h_max == pytest.approx(np.sqrt(8 * 0.05 / 500), rel=1e-3)


@pytest.mark.parametrize("method", ["rk4", "semi_implicit_euler_damped", "taylor", "exact"])
def test_a_limit_goes_to_another_process(method):
    limit = hl.stability.step_limit(coupler(), method, T=1e-3)
    twin = pickle.loads(pickle.dumps(limit))
    h = np.array([1e-4, 2e-3])
    assert str(twin) == str(limit)
    np.testing.assert_array_equal(twin.worst.step(h), limit.worst.step(h))


def test_refusals():
    with pytest.raises(AnalysisError, match=r"hl\.stability\.step_limit"):
        hl.stability.step_limit("scene", T=1e-3)
    with pytest.raises(HapticlabError, match="rk9"):
        hl.stability.step_limit(coupler(), "rk9", T=1e-3)
    with pytest.raises(AnalysisError, match=r"the states are x, v, z, dz/dt"):
        hl.stability.step_limit(coupler(), T=1e-3, at={"y": 1.0})
    free = hl.parameters("k_free", units="N/m")
    F = free * (x(t) - z)
    with pytest.raises(ParameterError, match="k_free"):
        hl.stability.step_limit(hl.Scene(force=F, eom=[sp.Eq(m * z.diff(t, 2), F)]), T=1e-3)
