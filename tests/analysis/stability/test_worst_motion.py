"""The worst closed motion of a switched scene: against dynamic programming on a grid, closed forms, and runs."""

import itertools
import math

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import n, v, when, x
from hapticlab.analysis.stability.closed_motions import ClosedMotions
from hapticlab.errors import AnalysisError
from hapticlab.limits.passivity import required_damping

T, REACH = 1e-3, 1e-3
K, H, B, P, d, u, s = hl.parameters(
    "K H B P d u s", units="N/m N/m N*s/m N m m/s N/m^2", ranges=dict.fromkeys("KHBPdus", (-math.inf, math.inf))
)
X, V = x(n), v(n)
SWITCHED = when(X >= 0, K * X, B * V)
#: name: (force, law(x, v) in NumPy, constants, the device's b, what else it has)
SCENES = {
    "negative damper outside": (SWITCHED, lambda x, v: np.where(x >= 0, 690 * x, -0.25 * v), {"K": 690, "B": -0.25}, 0.35),
    "softer, more negative": (SWITCHED, lambda x, v: np.where(x >= 0, 500 * x, -0.3 * v), {"K": 500, "B": -0.3}, 0.32),
    "both outside and inside": (
        when(X >= 0, K * X - B * V, B * V), lambda x, v: np.where(x >= 0, 300 * x + 0.2 * v, -0.2 * v),
        {"K": 300, "B": -0.2}, 0.3,
    ),
    "negative damper inside": (
        when(X >= 0, K * X + B * V), lambda x, v: np.where(x >= 0, 200 * x - 0.2 * v, 0), {"K": 200, "B": -0.2}, 0.15,
    ),
    "damper inside": (
        when(X >= 0, K * X + B * V), lambda x, v: np.where(x >= 0, 200 * x + 0.3 * v, 0), {"K": 200, "B": 0.3}, 0.35,
    ),
    "damper that never pulls": (
        sp.Max(when(X >= 0, K * X + B * V), 0), lambda x, v: np.maximum(np.where(x >= 0, 400 * x + 0.3 * v, 0), 0),
        {"K": 400, "B": 0.3}, 0.35,
    ),
    "damper one way outside": (
        when(X >= 0, K * X, when(V < 0, B * V)), lambda x, v: np.where(x >= 0, 400 * x, np.where(v < 0, -0.3 * v, 0)),
        {"K": 400, "B": -0.3}, 0.25,
    ),
    "damper one way": (
        K * X + when(V >= 0, B * V), lambda x, v: 400 * x + np.where(v >= 0, 0.2 * v, 0), {"K": 400, "B": 0.2}, 0.25,
    ),
    "damper when fast": (
        when(X >= 0, K * X) + when(V >= u, B * V), lambda x, v: np.where(x >= 0, 200 * x, 0) + np.where(v >= 0.3, 0.3 * v, 0),
        {"K": 200, "B": 0.3, "u": 0.3}, 0.2,
    ),
    "Eq. (23.5), gate": (
        when(X >= 0, K * (1.5 * X - 0.5 * x(n - 1))), lambda x, v: np.where(x >= 0, 500 * (x + T / 2 * v), 0), {"K": 500}, 0.4,
    ),
    "Eq. (23.5), clip": (
        hl.wall("backward_difference", unilateral="clip").force,
        lambda x, v: 500 * (1.5 * np.maximum(x, 0) - 0.5 * np.maximum(x - T * v, 0)), {"k": 500, "B": 0, "x_o": 0}, 0.4,
    ),
    "gate on the past sample": (
        when(x(n - 1) >= 0, K * X), lambda x, v: np.where(x - T * v >= 0, 400 * x, 0), {"K": 400}, 0.25,
    ),
    "a gap between two walls": (
        when(X >= d, K * (X - d)) + when(X <= -d, K * (X + d)),
        lambda x, v: np.where(x >= 5e-4, 900 * (x - 5e-4), 0) + np.where(x <= -5e-4, 900 * (x + 5e-4), 0),
        {"K": 900, "d": 5e-4}, 0.4,
    ),
    "a stiffer core": (
        when(X >= 0, K * X) + when(X >= d, H * (X - d)),
        lambda x, v: np.where(x >= 0, 300 * x, 0) + np.where(x >= 4e-4, 600 * (x - 4e-4), 0),
        {"K": 300, "H": 600, "d": 4e-4}, 0.35,
    ),
    "hysteresis": (
        when(X >= 0, when(V >= 0, K * X, H * X)), lambda x, v: np.where(x >= 0, np.where(v >= 0, 300 * x, 400 * x), 0),
        {"K": 300, "H": 400}, 0.15,
    ),
    "a spring on the way in alone": (
        when(X >= 0, when(V >= 0, K * X)), lambda x, v: np.where((x >= 0) & (v >= 0), 300 * x, 0), {"K": 300}, 0.1,
    ),
    "a spring that saturates": (
        when(X >= 0, sp.Min(K * X, P)), lambda x, v: np.where(x >= 0, np.minimum(2000 * x, 0.6), 0), {"K": 2000, "P": 0.6}, 0.5,
    ),
    "a jump": (when(X >= 0, P), lambda x, v: np.where(x >= 0, 0.3, 0), {"P": 0.3}, 0.35),
    "a jump against friction": (when(X >= 0, P), lambda x, v: np.where(x >= 0, 0.3, 0), {"P": 0.3}, 0.1, {"coulomb": 0.05}),
    "a groove": (when(X >= 0, K * X - P), lambda x, v: np.where(x >= 0, 200 * x - 0.1, 0), {"K": 200, "P": 0.1}, 0.08),
    "a push outside": (
        when(X >= 0, K * X + P, P / 2), lambda x, v: np.where(x >= 0, 300 * x + 0.1, 0.05), {"K": 300, "P": 0.1}, 0.18,
    ),
    "a hardening wall": (
        when(X >= 0, s * X**2, B * V), lambda x, v: np.where(x >= 0, 6e5 * x**2, -0.2 * v), {"s": 6e5, "B": -0.2}, 0.45,
    ),
    "a detent": (
        when(X >= d, K * (X - 2 * d), when(X <= -d, K * (X + 2 * d), -K * X)),
        lambda x, v: np.where(x >= 5e-4, 500 * (x - 1e-3), np.where(x <= -5e-4, 500 * (x + 1e-3), -500 * x)),
        {"K": 500, "d": 5e-4}, 0.2,
    ),
    "a wall one period late": (when(X >= 0, K * X), lambda x, v: np.where(x >= 0, 300 * x, 0), {"K": 300}, 0.35, {"delay": T}),
}  # fmt: skip
#: of these 24 the surfaces away from x = 0 [m]
SURFACES = {"a gap between two walls": (-5e-4, 5e-4), "a stiffer core": (4e-4,), "a detent": (-5e-4, 5e-4)}


def worst_cycle_on_a_grid(law, b, coulomb=0.0, delay=0.0, surfaces=(), points=31, steps=200):
    """Return the most energy per period [J] of a closed walk over positions, by dynamic programming in (x(n-1), x(n)).

    After 200 steps the best walk to each pair goes round the best cycle, wherever it began; that cycle is cut out of it.
    """
    sides = np.array([p + side for p in (0.0, *surfaces) for side in (-5e-8, 5e-8)])
    grid = np.linspace(-REACH, REACH, points)
    grid = np.unique(np.r_[grid[np.abs(grid[:, None] - sides).min(axis=1) > 1e-7], sides])
    i, j, k = np.ix_(grid, grid, grid)
    force = law(i, 0 * i) if delay else law(j, (j - i) / T)  # the late law knows no velocity
    gain = np.zeros((len(grid),) * 3) - force * (k - j) - coulomb * np.abs(k - j) - b * (k - j) ** 2 / T
    value, came = np.zeros((len(grid),) * 2), []
    for _ in range(steps):
        reached = value[:, :, None] + gain
        came.append(reached.argmax(axis=0))
        value = reached.max(axis=0)
    walk = [*np.unravel_index(value.argmax(), value.shape)][::-1]
    for choice in came[::-1]:
        walk.append(choice[walk[-1], walk[-2]])
    walk = walk[::-1]
    earned = np.cumsum([0.0] + [gain[tuple(walk[m : m + 3])] for m in range(steps)])
    pairs = list(itertools.pairwise(walk))
    loops = [(a, c) for a in range(steps) for c in range(a + 1, min(a + 65, steps)) if pairs[a] == pairs[c]]
    return max((earned[c] - earned[a]) / (c - a) for a, c in loops)


def found_and_expected(name, samples, points):
    force, law, values, b, *more = SCENES[name]
    more = more[0] if more else {}
    scene = hl.Scene(force=force, name=name)(**values)
    found = hl.passivity.worst_motion(hl.Device(b=b, T=T, **more), scene, reach=REACH, samples=samples, about=0.0)
    return found, worst_cycle_on_a_grid(law, b, surfaces=SURFACES.get(name, ()), points=points, **more)


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.always("a stiffer core")
def test_energy_is_that_of_dynamic_programming(name):
    """A grid knows no better motion than the search does, within 5 %; it is no finer than 70 um."""
    found, expected = found_and_expected(name, samples=24 if name == "damper one way outside" else 12, points=31)
    assert found.found and expected > 0
    assert 0.95 * expected < found.energy / len(found.x) < 1.2 * expected


def test_the_cycle_that_was_known():
    """x = -0.249, 0-, 1, 0- mm: 690 X^2 + 2 a |B| X/T - a^2 |B|/T uJ, of which b (2 X^2 + 2 a^2)/T is dissipated."""
    force, _, values, b = SCENES["negative damper outside"]
    scene, device = hl.Scene(force=force)(**values), hl.SimulatedPaddle(m=0.05, b=b, T=T)
    port = hl.passivity.port(device, scene)
    assert port.passive and "passive in each mode" in str(port) and "worst_motion" in str(port)
    motions = ClosedMotions(hl.compile(scene, T=T, dtype="float64", live=()))
    books = motions.books(1e-3 * np.array([[-0.249], [-1e-9], [1.0], [-1e-9]]))
    assert 1e6 * books.drawn[0] == pytest.approx(690 + 2 * 249 * 0.25 - 250 * 0.249**2, rel=1e-6)
    assert 1e6 * b * books.viscous[0] == pytest.approx(350 * (2 + 2 * 0.249**2), rel=1e-6)
    found = hl.passivity.worst_motion(device, scene, samples=4)
    assert found.found and found.energy > books.drawn[0] - b * books.viscous[0] > 55e-6
    assert found.b_req >= 0.9999 * books.drawn[0] / books.viscous[0] > port.b_req
    assert "not passive. The worst motion found draws" in str(found) and "2 to 4 samples" in found.searched


@pytest.mark.parametrize("law", ["zoh", "backward_difference"])
@pytest.mark.parametrize("delay", [0.0, 0.4e-3, 1e-3])
@pytest.mark.always("0.0-zoh")
def test_a_wall_that_always_acts_asks_for_what_theory_says(law, delay):
    """Between 98 and 100 % of the exact damping: slow motions need long cycles."""
    wall, samples = hl.wall(law, unilateral=None)(k=400), 32 if law == "zoh" and delay else 10
    exact = hl.passivity.margin(hl.Device(b=1, T=T, delay=delay), hl.laws.LinearLaw.of(law, K=400, T=T)).required
    if law == "zoh":
        assert exact == pytest.approx(required_damping(K=400, T=T, delay=delay), rel=1e-9)
    for part, found in ((0.95, True), (1.02, False)):
        motion = hl.passivity.worst_motion(hl.Device(b=part * exact, T=T, delay=delay), wall, samples=samples)
        assert motion.found == found and 0.98 * exact < motion.b_req <= exact * (1 + 1e-9)


def test_ellis_behind_a_gate_one_period_late_asks_for_more_than_alone():
    """x = 0-, 0.7865, 1, 0.1739: 1.5331 K T, where the linear law asks for 1.5282 K T."""
    found = hl.passivity.worst_motion(hl.Device(T=T, delay=T), hl.wall("ellis")(k=400), samples=8)
    assert found.b_req == pytest.approx(1.5331 * 400 * T, rel=1e-3) and found.found is None


def test_ellis_behind_a_gate_half_a_period_late_by_hand():
    """1.3306 K T, where the linear law asks for 1.3150 K T. The force of the sample before acts in the first half of a period."""
    found = hl.passivity.worst_motion(hl.Device(T=T, delay=T / 2), hl.wall("ellis")(k=1 / T), samples=3)
    x, between = found.x, found.positions[1::2]
    F = np.where(x >= 0, 2 * x - 1.5 * np.roll(x, 1) + 0.5 * np.roll(x, 2), 0) / T
    first, second = between - x, np.roll(x, -1) - between
    drawn, viscous = -(np.roll(F, 1) @ first + F @ second), (first @ first + second @ second) / (T / 2)
    assert (found.drawn, found.viscous) == pytest.approx((drawn, viscous), rel=1e-9)
    assert found.b_req == pytest.approx(drawn / viscous) == pytest.approx(1.3306, rel=2e-4)


def random_scene(generator):
    """Return (scene, law, b): a stiffness inside and outside, a damper for each side and direction, just enough damping."""
    (K_in, K_out), B_each = generator.uniform(0, 800, 2), generator.uniform(-0.3, 0.3, 4)
    K_out *= generator.choice([0, 0.5])
    names = "K_in K_out B_1 B_2 B_3 B_4"
    units = "N/m N/m N*s/m N*s/m N*s/m N*s/m"
    k, h, *B = hl.parameters(names, units=units, ranges=dict.fromkeys(names.split(), (-math.inf, math.inf)))
    inside, outside = k * X + when(V >= 0, B[0] * V, B[1] * V), h * X + when(V >= 0, B[2] * V, B[3] * V)
    values = dict(zip(names.split(), (K_in, K_out, *B_each), strict=True))

    def law(x, v):
        damper = np.where(x >= 0, np.where(v >= 0, *B_each[:2]), np.where(v >= 0, *B_each[2:]))
        return np.where(x >= 0, K_in, K_out) * x + damper * v

    each_mode = max(K_in * T / 2 + np.abs(B_each[:2]).max(), K_out * T / 2 + np.abs(B_each[2:]).max())
    return hl.Scene(force=when(X >= 0, inside, outside))(**values), law, generator.uniform(0.8, 0.95) * each_mode


@pytest.mark.parametrize(
    ("scenes", "samples"), [(1, 8), pytest.param(5, 12, marks=pytest.mark.wide), pytest.param(60, 12, marks=pytest.mark.slow)]
)
def test_random_switched_scenes_against_dynamic_programming(scenes, samples):
    generator, active = np.random.default_rng(11), 0
    while active < scenes:
        scene, law, b = random_scene(generator)
        expected = worst_cycle_on_a_grid(law, b, points=21)
        if expected > 1e-6:  # at less a cycle is long, or what is gained a small difference of what is exchanged
            found = hl.passivity.worst_motion(hl.Device(b=b, T=T), scene, samples=samples)
            assert found.energy / len(found.x) > 0.95 * expected, scene.values
            active += 1


@pytest.mark.parametrize("damper", [0.5, pytest.param(1.0, marks=pytest.mark.wide)])
def test_a_body_on_a_coupler_asks_for_what_theory_says(damper):
    """Semi-implicit Euler, zero-order hold: b_0/(1 - m_0/m) at Nyquist, b_0 = K T/2 + B, m_0 = b_0 T/2; the body's motion is
    the one that repeats itself, found by shooting, though nothing but the coupler damps it."""
    z, m = hl.coordinate("z", unit="m"), hl.parameters("m", units="kg", values=0.05)
    F = K * (hl.x(hl.t) - z) + B * (hl.v(hl.t) - z.diff(hl.t))
    scene = hl.Scene(force=F, eom=[sp.Eq(m * z.diff(hl.t, 2), F)])(K=500, B=damper)
    options = {"method": "semi_implicit_euler", "hold": "zoh"}
    b_0 = 500 * T / 2 + damper
    expected = b_0 / (1 - b_0 * T / 2 / 0.05)
    found = hl.passivity.worst_motion(hl.Device(T=T, b=0.9 * expected), scene, samples=3, **options)
    assert found.b_req == pytest.approx(expected, rel=1e-4) and found.found
    assert found.b_req == pytest.approx(hl.passivity.port(hl.Device(T=T), scene, **options).b_req, rel=1e-4)


def test_a_run_confirms_the_energy():
    force, _, values, b = SCENES["negative damper outside"]
    paddle, scene = hl.SimulatedPaddle(m=0.05, b=b, T=T, delay=T), hl.Scene(force=force)(**values)
    found = hl.passivity.worst_motion(paddle, scene, samples=5)
    log, samples = found.run(paddle, cycles=10), len(found.x)
    W = hl.energy(log).W
    assert W[-1 - samples] - W[-1] == pytest.approx(found.drawn, rel=1e-4)
    assert log.x[-1 - samples : -1] == pytest.approx(found.x, abs=1e-8)
    assert found.path(np.arange(samples) * T) == pytest.approx(found.x)
    axes = found.plot().axes
    assert axes[1].lines[0].get_ydata()[-1] == pytest.approx(2e6 * found.drawn)
    assert axes[1].lines[1].get_ydata()[-1] == pytest.approx(2e6 * found.dissipated)
    late = hl.passivity.worst_motion(hl.Device(T=T, b=b, delay=0.4e-3), scene, samples=3)
    with pytest.raises(AnalysisError, match="fraction of a period"):
        late.run(paddle)


def test_where_none_is_found_it_says_what_was_searched():
    found = hl.passivity.worst_motion(hl.Device(b=0.2, T=T), hl.wall()(k=300, x_o="10 mm"), samples=4, reach="2 mm")
    assert found.found is False and found.energy < 0 and found.b_req == pytest.approx(0.15)
    text = str(found)
    assert (
        "no motion was found" in text and "2 to 4 samples within 2 mm of x = 10 mm" in text and "cannot prove passivity" in text
    )
    assert "2 to 4 samples" in found.plot().axes[1].get_xlabel()
    with pytest.raises(AnalysisError, match="samples = 1"):
        hl.passivity.worst_motion(hl.Device(T=T), hl.wall()(k=300), samples=1)
    with pytest.raises(AnalysisError, match="reach = 0 m"):
        hl.passivity.worst_motion(hl.Device(T=T), hl.wall()(k=300), reach=0)
    with pytest.raises(AnalysisError, match="seed = -1"):
        hl.passivity.worst_motion(hl.Device(T=T), hl.wall()(k=300), seed=-1)
    with pytest.raises(AnalysisError, match="needs at least one position"):
        hl.passivity.worst_motion(hl.Device(T=T), hl.wall()(k=300), about=[])


def test_a_force_that_does_not_change_draws_nothing():
    for force in (0, hl.parameters("F_c", units="N", values=1.0)):
        found = hl.passivity.worst_motion(hl.Device(b=0.2, T=T), hl.Scene(force=force), samples=3)
        assert found.found is False and found.b_req == pytest.approx(0, abs=1e-9)


def test_a_count_and_a_sum_never_repeat_themselves():
    """A Newton step along what a cycle hands on whole would go to 1e12, where the force changes by no part of itself."""
    s, total = hl.signal("s", unit="1"), hl.signal("total", unit="m")
    counted = hl.Scene(force=K * X * s(n), eom=[sp.Eq(s(n), s(n - 1) + 1)])(K=300)
    with pytest.raises(AnalysisError, match="none had a force that repeats from cycle to cycle."):
        hl.passivity.worst_motion(hl.Device(b=0.2, T=T), counted, samples=3, about=0)
    summed = hl.Scene(force=K * X + H * total(n), eom=[sp.Eq(total(n), total(n - 1) + X)])(K=300, H=30)
    found = hl.passivity.worst_motion(hl.Device(b=0.2, T=T), summed, samples=4, about=0)
    assert abs(found.x.sum()) < 1e-6 and np.abs(found.held).max() < 2


def test_what_a_search_does_not_take_is_refused():
    with pytest.raises(AnalysisError, match="option = 'dtype'; needs one of method, substeps, hold, force_at"):
        hl.passivity.worst_motion(hl.Device(b=0.2, T=1e-3), hl.wall()(k=500), dtype="float32")


def test_motions_that_never_repeat_are_counted():
    """A wall with an integral of the depth: every motion that goes inside winds it up."""
    total = hl.signal("total", unit="m")
    wound = sp.Eq(total(n), total(n - 1) + sp.Max(X, 0))
    scene = hl.Scene(force=when(X >= 0, K * X) + H * total(n), eom=[wound])(K=300, H=30)
    found = hl.passivity.worst_motion(hl.Device(b=0.35, T=1e-3), scene, samples=4)
    assert "their force does not repeat from cycle to cycle" in found.searched
    plain = hl.passivity.worst_motion(hl.Device(b=0.35, T=1e-3), hl.wall()(k=300), samples=4)
    assert "does not repeat" not in plain.searched
