"""The chapter's laws, every variant against the formula in whole-array arithmetic."""

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import n, t, v, x
from hapticlab.compiler.boards.board_fit import _cheaper_laws
from hapticlab.compiler.engines.engine import load
from hapticlab.errors import SceneError
from hapticlab.scene.laws.chapter_laws import UNILATERAL
from hapticlab.scene.laws.taps import LEAD, TAPS

T, K, B, BOUNDARY = 1e-3, 180.0, 0.4, 0.01
GENERATOR = np.random.default_rng(11)
#: a walk across the boundary: enters, leaves, touches, and rests outside for longer than any law remembers
MOTION = BOUNDARY + np.concatenate([0.002 * GENERATOR.normal(size=60).cumsum(), np.full(4, -0.003), [0.0, 0.002, 0.002]])
VELOCITY = GENERATOR.normal(size=len(MOTION))


def past(series, lag):
    return series[np.maximum(np.arange(len(series)) - lag, 0)]


def by_formula(law, unilateral, clamp):
    p = MOTION - BOUNDARY
    inside = p >= 0
    p = np.maximum(p, 0) if unilateral == "clip" else p
    velocity = np.where(inside, VELOCITY, 0) if unilateral == "clip" else VELOCITY
    force = K * (sum(c * past(p, lag) for lag, c in enumerate(TAPS[law])) + LEAD[law] * T * velocity)
    force = force + B * (p - past(p, 1)) / T
    force = np.where(inside, force, 0) if unilateral == "gate" else force
    return np.maximum(force, 0) if clamp else force


def forces(scene, **options):
    program = hl.compile(scene, T=T, dtype="float64", **options)
    rows = np.column_stack([MOTION, VELOCITY][: len(program.inputs)])
    return load(program).run(len(MOTION), rows).outputs[:, 0, 0]


@pytest.mark.parametrize("clamp", [False, True])
@pytest.mark.parametrize("unilateral", UNILATERAL)
@pytest.mark.parametrize("law", TAPS)
@pytest.mark.always("zoh-gate-*", "half_sample-None-*", "backward_difference-gate-*", "ellis-clip-*")
def test_a_wall_is_its_formula(law, unilateral, clamp):
    scene = hl.wall(law, unilateral=unilateral, clamp=clamp)(k=K, B=B, x_o=BOUNDARY)
    expected = by_formula(law, unilateral, clamp)
    assert expected.max() > 0
    assert (expected.min() >= 0) == clamp  # every unclamped variant pulls somewhere here
    np.testing.assert_allclose(forces(scene, velocity="measured"), expected, rtol=1e-12, atol=1e-12)


def test_the_variants_differ_only_around_the_boundary():
    """Deep inside, and far outside, the three agree; on leaving, a clipped law still acts from memory."""
    gate, clip = (by_formula("ellis", unilateral, False) for unilateral in ("gate", "clip"))
    deep = np.all([past(MOTION, lag) > BOUNDARY for lag in range(3)], axis=0)
    away = np.all([past(MOTION, lag) < BOUNDARY for lag in range(3)], axis=0)
    np.testing.assert_array_equal(gate[deep], clip[deep])
    assert (gate[away] == 0).all()
    assert (clip[away] == 0).all()
    just_left = (MOTION < BOUNDARY) & (past(MOTION, 1) > BOUNDARY)
    assert just_left.any()
    assert (clip[just_left] != 0).any()


def test_an_estimated_velocity_turns_half_sample_into_the_backward_difference():
    pair = [hl.wall(law)(k=K, x_o=BOUNDARY) for law in ("half_sample", "backward_difference")]
    one, other = (forces(scene) for scene in pair)
    np.testing.assert_allclose(one, other, rtol=1e-11, atol=1e-13)


@pytest.mark.parametrize("strength", [0.3, -0.3])
def test_a_virtual_damper_of_either_sign(strength):
    scene = hl.laws.virtual_damper()(B=strength)
    np.testing.assert_allclose(forces(scene, velocity="measured"), strength * VELOCITY, rtol=1e-15)
    estimated = (MOTION - past(MOTION, 1)) / T
    np.testing.assert_allclose(forces(scene), strength * estimated, rtol=1e-11, atol=1e-13)


def test_the_coupler_is_the_spring_and_damper_of_fig_23_4():
    z = hl.coordinate("z", unit="m")
    stiffness, damping = hl.parameters("K b", units="N/m N*s/m")
    assert hl.laws.virtual_coupler(z, K=stiffness, b=damping) == stiffness * (x(t) - z) + damping * (v(t) - z.diff(t))


def test_the_filter_keeps_what_it_filters():
    z = hl.coordinate("z", unit="m")
    m, k = hl.parameters("m k", units="kg N/m", values=(0.1, 50.0))
    body = hl.Scene(force=k * (x(t) - z), eom=[sp.Eq(m * z.diff(t, 2), k * (x(t) - z))], watch="z", name="body")
    filtered = hl.laws.force_filter(body)
    assert (filtered.eom, filtered.watch, filtered.values) == (body.eom, body.watch, body.values)
    assert hl.laws.predicted_sample(v) == 2 * v(n) - v(n - 1)


def by_filter(force):
    """Eq. (23.8) on a whole record, its past before the first sample the first sample."""
    return 2 * force - 1.5 * past(force, 1) + 0.5 * past(force, 2)


def scenes_to_filter():
    y = hl.signal("y", unit="N", initial=0)
    k3 = hl.parameters("k3", units="N/m^3", values=1e6)
    boundary = hl.shapes.Amount(BOUNDARY, "m")
    hardening = hl.when(x(n) >= boundary, k3 * (x(n) - boundary) ** 3)
    return {
        "gated": hl.wall("half_sample")(k=K, B=B, x_o=BOUNDARY),
        "clipped": hl.wall("ellis", unilateral="clip", clamp=True)(k=K, x_o=BOUNDARY),
        "hardening": hl.Scene(hardening, name="hardening spring"),
        "with a memory": hl.Scene(y(n), [sp.Eq(y(n), sp.Rational(4, 5) * y(n - 1) + hl.wall().force)])(k=K, x_o=BOUNDARY),
        "braked": hl.laws.braking_pulse(hl.wall()(k=K, x_o=BOUNDARY), impulse=1e-3, periods=3),
        "estimated": hl.wall("half_sample", velocity=hl.velocity.window(deviation=1e-4, longest=3))(k=K, B=B, x_o=BOUNDARY),
    }


@pytest.mark.parametrize("clamp", [False, True])
@pytest.mark.parametrize("name", scenes_to_filter())
@pytest.mark.always("gated-False", "with a memory-True", "braked-True")
def test_the_filter_filters_whatever_is_felt(name, clamp):
    """Around switches, powers, memories and estimates it is the formula on the record of the force alone."""
    scene = scenes_to_filter()[name]
    plain = forces(scene, velocity="measured")
    assert plain.max() > 0 and (abs(plain) < 1e-3).any()  # it switches here
    expected = by_filter(plain)
    assert (expected.min() < 0) == (name != "with a memory")  # a switch pulls after leaving
    expected = np.maximum(expected, 0) if clamp else expected
    np.testing.assert_allclose(forces(hl.laws.force_filter(scene, clamp), velocity="measured"), expected, rtol=1e-12, atol=1e-12)


def test_a_gated_wall_is_filtered_and_not_an_ellis_wall():
    """(23.8) around (23.1) forgets what lies outside; (23.7) takes the raw past: equal deep inside, not at the entry."""
    path = BOUNDARY + 0.002 * np.sin(0.3 * np.arange(100))
    scenes = hl.laws.force_filter(hl.wall()), hl.wall("ellis")
    programs = [hl.compile(scene(k=K, x_o=BOUNDARY), T=T, dtype="float64") for scene in scenes]
    filtered, ellis = (load(program).run(100, path[:, None]).outputs[:, 0, 0] for program in programs)
    deep = np.all([past(path, lag) > BOUNDARY for lag in range(3)], axis=0)
    entered = (path > BOUNDARY) & (past(path, 1) < BOUNDARY)
    np.testing.assert_allclose(filtered[deep], ellis[deep], rtol=1e-11, atol=1e-12)
    assert entered.sum() > 2 and (abs(filtered - ellis)[entered] > 1e-3).all()


def test_a_filter_of_a_filter_is_the_product():
    twice = hl.laws.force_filter(hl.laws.force_filter(hl.wall(unilateral=None)))(k=K, x_o=BOUNDARY)
    expected = by_filter(by_filter(K * (MOTION - BOUNDARY)))
    np.testing.assert_allclose(forces(twice), expected, rtol=1e-11, atol=1e-12)


@pytest.mark.parametrize("name", scenes_to_filter())
@pytest.mark.always("gated", "with a memory", "estimated")
def test_a_filtered_scene_runs_in_the_firmware_core(name):
    program = hl.compile(hl.laws.force_filter(scenes_to_filter()[name]), T=T)
    path = MOTION.astype(np.float32)[:, None]
    there, here = (load(program, engine).run(len(path), path).outputs for engine in ("vm", "interpreter"))
    np.testing.assert_array_equal(there, here)


@pytest.mark.parametrize("kind", [("clip", False), ("gate", True), (None, False)])
def test_a_refused_wall_is_offered_one_of_its_own_kind(kind):
    """Its own unilateral variant, and clamped where it was, with fewer samples."""
    kind = dict(zip(("unilateral", "clamp"), kind, strict=True))
    found = dict(_cheaper_laws(hl.wall("ellis", **kind)))
    assert list(found) == ["backward_difference", "zoh", "half_sample"]
    assert all(scene.force == hl.wall(law, **kind).force for law, scene in found.items())


@pytest.mark.parametrize(
    ("arguments", "words"), [({"law": "foh"}, "needs one of zoh"), ({"unilateral": "gated"}, "'clip' or None")]
)
def test_a_law_that_is_none_is_refused(arguments, words):
    with pytest.raises(SceneError, match=words):
        hl.wall(**arguments)
