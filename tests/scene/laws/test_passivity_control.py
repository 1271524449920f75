"""Passivity observer and controller against energies summed by hand over prescribed motions."""

from dataclasses import replace

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import n, t, v
from hapticlab.compiler.engines.engine import load
from hapticlab.errors import ParameterError, SceneError, UnitsError

T, K = 1e-3, 700.0
GENERATOR = np.random.default_rng(3)
#: a wandering handle: in and out of a wall at 0, back and forth within it, resting for two samples
MOTION = np.r_[np.full(3, -1e-3), -1e-3 + np.cumsum(3e-4 * GENERATOR.normal(size=400)), np.zeros(2)]
ENERGY = hl.laws.wall_energy()
STORED = hl.laws.Credit(stored=ENERGY)
WALL = hl.wall()(k=K)


def played(scene, motion=MOTION, *, engine="auto", dtype="float64", **options):
    """Return (force, watched channels) of a scene along a prescribed motion."""
    program = hl.compile(scene, T=T, dtype=dtype, **options)
    out = load(program, engine).run(len(motion), np.asarray(motion)[:, None]).outputs[:, :, 0]
    return out[:, 0], {c.name: out[:, j] for j, c in enumerate(program.outputs) if j}


def taken(force, motion=MOTION, lag=0):
    """Work done on the environment up to each sample, force and displacement as they act."""
    held = np.r_[np.zeros(lag), force][: len(force)]
    return np.r_[0.0, np.cumsum(held[:-1] * np.diff(motion))]


def elastic(motion=MOTION, stiffness=K):
    return stiffness * np.maximum(motion, 0) ** 2 / 2


@pytest.mark.parametrize("lag", [0, 1, 3])
def test_the_observer_is_the_work_of_the_held_force(lag):
    F, seen = played(hl.laws.passivity_observer(WALL, lag=lag))
    np.testing.assert_array_equal(F, np.maximum(K * MOTION, 0))  # the scene's own, in every bit
    # rounding: 400 sums of some 1e-4 J
    np.testing.assert_allclose(seen["W"], taken(F, lag=lag), atol=1e-17, rtol=1e-13)


def test_the_observer_of_one_push_finds_the_area_of_the_staircase():
    """In and out at v T a sample: K v T x_max, Fig. 23.6; and -K v T x_max if paired with the displacement before."""
    step = 2.3e-4
    inside = np.r_[np.arange(-2, 9), np.arange(9, -4, -1)] * step + 0.4 * step
    F, seen = played(hl.laws.passivity_observer(WALL), inside)
    assert seen["W"][-1] == pytest.approx(-K * step * inside.max(), abs=1e-17)
    wrong = np.cumsum(F * np.diff(inside, prepend=inside[0]))[-1]
    assert wrong == pytest.approx(K * step * inside.max(), abs=1e-17)


def by_hand_series(f, motion, alpha_max, stored, keep=lambda credit: credit, limit=np.inf, ahead=None):
    """The series controller in a loop of its own."""
    force, credit, damper = np.zeros(len(f)), np.zeros(len(f)), np.zeros(len(f))
    for i in range(len(f)):
        moved = motion[i] - motion[i - 1] if i else 0.0
        if i:
            credit[i] = keep(credit[i - 1]) + force[i - 1] * moved - (stored[i] - stored[i - 1])
        owed = credit[i] + (f[i] * moved - (ahead(motion[i] + moved) - ahead(motion[i])) if ahead else 0.0)
        if owed < 0 and moved:
            damper[i] = min(alpha_max, -owed * T / moved**2)
        force[i] = np.clip(f[i] + damper[i] * moved / T, -limit, limit)
    return force, credit, damper


@pytest.mark.parametrize(
    "options, hand",
    [
        ({}, {}),
        ({"alpha_max": 0.4}, {"alpha_max": 0.4}),
        ({"force_max": 0.8}, {"limit": 0.8}),
        ({"credit": hl.laws.Credit(forget=0.02)}, {"keep": lambda c: c / (1 + T / 0.02) if c > 0 else c}),
        ({"credit": hl.laws.Credit(credit_max=2e-5)}, {"keep": lambda c: min(c, 2e-5)}),
        ({"credit": STORED}, {"stored": elastic()}),
        ({"credit": STORED, "predict": True}, {"stored": elastic(), "ahead": elastic}),
        ({"predict": True}, {"ahead": lambda place: 0.0}),
    ],
    ids=["plain", "weak", "limited", "forgets", "bounded", "reference", "predicts", "predicts the work"],
)
def test_the_series_form_is_its_lines_written_out(options, hand):
    f = np.maximum(K * MOTION, 0)
    hand = {"alpha_max": 30.0, "stored": np.zeros(len(f))} | hand
    expected, credit, damper = by_hand_series(f, MOTION, **hand)
    F, seen = played(hl.laws.passivity_controller(WALL, **({"alpha_max": 30.0} | options)))
    assert (damper > 0).sum() > 10
    np.testing.assert_allclose(F, expected, rtol=1e-9, atol=1e-10)
    np.testing.assert_allclose(seen["credit"], credit, rtol=0, atol=1e-13)  # a division by small D multiplies rounding
    np.testing.assert_allclose(seen["alpha"], damper, rtol=1e-8, atol=1e-9)


def test_the_series_form_takes_back_what_was_generated():
    """An unbounded damper repays in the next sample what the same displacement would repay, whatever came before."""
    step = 2e-4
    motion = np.r_[np.arange(-2, 9), np.arange(9, -12, -1)] * step + 0.4 * step
    F, seen = played(hl.laws.passivity_controller(WALL, alpha_max=1e4), motion)
    W = taken(F, motion)
    assert taken(np.maximum(K * motion, 0), motion)[-1] < -1e-4
    assert W[-1] == pytest.approx(0.0, abs=1e-17)
    assert W.min() >= -K * motion.max() * step  # never more than one period's work in debt
    np.testing.assert_allclose(seen["credit"], W, atol=1e-17)


@pytest.mark.parametrize("taps", [(-300.0,), (-900.0, 900.0), (-200.0, 400.0), (0.0, 0.0, 400.0)])
def test_any_scene_owes_no_more_than_some_periods_of_its_work_while_the_handle_moves_smoothly(taps):
    """Springs that push the wrong way, dampers that drive, late forces: without the controller they give without end."""
    k = hl.parameters("k", units="N/m", values=1, ranges=(-1e4, 1e4))
    scene = hl.Scene(force=k * sp.Add(*(c * hl.x(n - lag) for lag, c in enumerate(taps))))
    motion = 5e-3 * np.sin(2 * np.pi * 4.3 * T * np.arange(3000)) + 2e-3 * np.sin(2 * np.pi * 11.7 * T * np.arange(3000))
    bare, _ = played(scene, motion)
    F, _ = played(hl.laws.passivity_controller(scene, alpha_max=1e5), motion)
    period = abs(bare[:-1] * np.diff(motion)).max()
    assert taken(bare, motion).min() < -10 * period
    assert taken(F, motion).min() > -3 * period


def test_with_prediction_and_reference_a_steady_push_feels_the_half_sample_lead():
    """What the coming period would generate, K D^2/2, is a damper K T/2: Eq. (23.5), inside the wall."""
    step = 2e-4
    motion = np.r_[np.arange(1, 9), np.arange(9, 1, -1)] * step
    scene = hl.laws.passivity_controller(WALL, alpha_max=30, credit=hl.laws.Credit(stored=hl.laws.wall_energy()), predict=True)
    F, seen = played(scene, motion)
    law = K * (1.5 * motion - 0.5 * np.r_[motion[0], motion[:-1]])
    # at sample 0 nothing moves, and sample 1 repays; then the handle goes in at a steady step
    np.testing.assert_allclose(F[2:8], law[2:8], rtol=1e-12)
    np.testing.assert_allclose(seen["alpha"][2:8], K * T / 2, rtol=1e-9)
    np.testing.assert_allclose(seen["credit"][2:8], 0, atol=1e-17)
    # the turn was not foreseen: its debt is repaid in the sample after
    np.testing.assert_allclose(F[10:], law[10:], rtol=1e-12)


def by_hand_parallel(motion, beta_max):
    """The parallel controller around a plain wall in a loop of its own."""
    force, credit, slip = (np.zeros(len(motion)) for _ in range(3))
    beta, before = 0.0, 0.0
    for i, place in enumerate(motion):
        slip[i] = slip[i - 1] + T * beta * force[i - 1] if i and place > 0 else 0.0
        left = K * max(place - slip[i], 0) ** 2 / 2
        if i:
            credit[i] = credit[i - 1] + force[i - 1] * (place - motion[i - 1]) - (left - before)
        force[i], before = K * (place - slip[i]) if place >= slip[i] else 0.0, left
        beta = min(beta_max, -credit[i] / (T * force[i] ** 2)) if credit[i] < 0 and force[i] else 0.0
    return force, credit, slip


@pytest.mark.parametrize("beta_max", [1e4, 0.2])
def test_the_parallel_form_is_its_lines_written_out(beta_max):
    scene = hl.laws.passivity_controller(WALL, "parallel", beta_max=beta_max, credit=hl.laws.Credit(stored=hl.laws.wall_energy()))
    force, credit, slip = by_hand_parallel(MOTION, beta_max)
    F, seen = played(scene)
    assert slip.max() > 1e-4
    np.testing.assert_allclose(seen["credit"], credit, rtol=0, atol=1e-14)
    np.testing.assert_allclose(seen["slip"], slip, rtol=0, atol=1e-12)
    np.testing.assert_allclose(F, force, rtol=0, atol=1e-9)


def test_the_parallel_form_gives_back_no_more_than_was_stored():
    """What the port took covers what is left in the spring, to the leak of one period, K (D - slip)^2/2."""
    step = 2e-4
    motion = np.r_[np.arange(-2, 12), np.arange(12, -4, -1)] * step + 0.3 * step
    F, seen = played(
        hl.laws.passivity_controller(WALL, "parallel", beta_max=1e4, credit=hl.laws.Credit(stored=hl.laws.wall_energy())), motion
    )
    W = taken(F, motion)
    bound = K * np.diff(motion - seen["slip"]) ** 2 / 2
    inside = F[:-1] > 0  # the first period inside has no force that could slip
    assert (seen["credit"][1:] >= -bound - 1e-17)[inside].all()
    assert taken(np.maximum(K * motion, 0), motion)[-1] < -3e-4 < -bound.max() < W.min()
    assert seen["slip"].max() > step and seen["slip"][-1] == 0  # the wall is where it was once the handle has left it


def test_a_spring_that_is_loaded_at_the_start_is_known_by_what_it_stores():
    """Let go from 3 mm inside: without ``stored`` what it gives back looks generated, with it nothing does but the hold."""
    motion = np.linspace(3e-3, -1e-3, 41)
    without, known = (
        played(hl.laws.passivity_controller(WALL, alpha_max=50, credit=o), motion) for o in (hl.laws.Credit(), STORED)
    )
    loaded = K * 3e-3**2 / 2
    assert known[1]["credit"].min() > -0.06 * loaded  # two periods' leak, K D^2/2 each, while it repays
    assert without[1]["alpha"].max() > 20 * np.median(known[1]["alpha"]) > 0
    assert (without[0] < known[0])[1:20].all()  # it brakes what may go


def honey(B=2.0):
    """A damper that turns into its opposite at t1: a human stirs, and then the environment is active."""
    B, t1 = hl.parameters("B t1", units="N*s/m s", values=(B, 1.0))
    return hl.Scene(force=hl.when(t < t1, B, -B) * v(n), name="honey")


def active_until(scene, t1, period=0.1, amplitude=2e-3, ticks=4000):
    """Return when the controller first acts after t1, from t1 on [s]; the handle goes to and fro."""
    motion = amplitude * np.sin(2 * np.pi * T / period * np.arange(ticks))
    _, seen = played(scene(t1=t1), motion)
    late = np.arange(ticks) * T
    return late[np.argmax((seen["alpha"] > 0) & (late > t1))] - t1


@pytest.mark.parametrize("t1", [0.5, 1.7])
def test_a_human_who_was_active_for_long_lets_the_environment_be_active_as_long(t1):
    assert active_until(hl.laws.passivity_controller(honey(), alpha_max=50), t1) == pytest.approx(t1, abs=0.05)  # half a period


@pytest.mark.parametrize("t1", [0.5, 1.7])
@pytest.mark.parametrize("forget", [0.1, 0.3])
def test_a_credit_that_is_forgotten_ends_that_soon(forget, t1):
    """At a power P the credit is forget*P (1 - e^(-t1/forget)); drained at P and forgotten it lasts forget*ln(2 - ...)."""
    expected = forget * np.log(2 - np.exp(-t1 / forget))
    found = active_until(hl.laws.passivity_controller(honey(), alpha_max=50, credit=hl.laws.Credit(forget=forget)), t1)
    assert found == pytest.approx(expected, abs=0.05)
    assert found < forget * np.log(2) + 0.05  # however long the human was active


def test_a_bounded_credit_ends_when_it_is_spent():
    P = 2.0 * (2e-3 * 2 * np.pi / 0.1) ** 2 / 2  # of the honey, averaged
    found = active_until(hl.laws.passivity_controller(honey(), alpha_max=50, credit=hl.laws.Credit(credit_max=0.2 * P)), 1.7)
    assert found == pytest.approx(0.2, abs=0.05)


@pytest.mark.parametrize("cure", [hl.laws.Credit(forget=0.004), hl.laws.Credit(credit_max=1e-6)])
def test_the_cures_strike_off_credit_and_never_debt(cure):
    """Whatever is struck off, the energy taken at the port stays above the credit that is left."""
    F, seen = played(hl.laws.passivity_controller(WALL, alpha_max=30, credit=cure))
    assert (taken(F) >= seen["credit"] - 1e-15).all()
    assert (seen["credit"] < 0).any() and taken(F)[-1] > seen["credit"][-1] + 1e-4


@pytest.mark.parametrize("form, bound", [("series", "alpha_max"), ("parallel", "beta_max")])
def test_a_reset_strikes_off_what_one_contact_left_for_the_next(form, bound):
    """A wall with a damper earns credit; 20 ms outside it is gone, and what was owed would not be."""
    there = np.r_[np.linspace(-1e-3, 4e-3, 26), np.linspace(4e-3, -1e-3, 26)[1:]]
    motion = np.r_[there, np.full(40, -1e-3), there]
    damped = hl.wall()(k=100, B=0.5)
    plain, reset = (
        played(hl.laws.passivity_controller(damped, form, **{bound: 5}, credit=credit), motion)[1]["credit"]
        for credit in (STORED, replace(STORED, reset=0.02))
    )
    last = len(there) - 1
    assert plain[last] > 1e-4
    out = np.flatnonzero(motion[: last + 1] >= 0)[-1] + 1  # the first sample without force
    assert (reset[: out + 20] == plain[: out + 20]).all()
    assert (reset[out + 21 : last + 41] == 0).all() and plain[last + 40] == plain[last]
    np.testing.assert_allclose(np.diff(reset[last + 41 :]), np.diff(plain[last + 41 :]), atol=1e-16)


@pytest.mark.parametrize("form, bound", [("series", "alpha_max"), ("parallel", "beta_max")])
def test_the_firmware_gives_the_same_bits(form, bound):
    scene = hl.laws.passivity_controller(
        WALL, form, **{bound: 5.0}, credit=hl.laws.Credit(stored=hl.laws.wall_energy(), forget=0.1, credit_max=1e-3), force_max=2
    )
    (F, seen), (felt, there) = (played(scene, dtype="float32", engine=engine) for engine in ("interpreter", "vm"))
    assert abs(F).max() > 0.5
    np.testing.assert_array_equal(F, felt)
    for name in seen:
        np.testing.assert_array_equal(seen[name], there[name])


def test_float32_keeps_the_books_to_a_millionth():
    exact, single = (played(hl.laws.passivity_observer(WALL), dtype=dtype)[1]["W"] for dtype in ("float64", "float32"))
    np.testing.assert_allclose(single, exact, atol=1e-6 * abs(exact).max())


def mass_on_a_coupler():
    m, c = hl.parameters("m c", units="kg N*s/m", values=(0.05, 1.0))
    z = hl.coordinate("z", unit="m")
    pull = hl.laws.virtual_coupler(z, K=hl.parameters("K", units="N/m", values=300), b=c)
    return hl.Scene(force=pull, eom=[sp.Eq(m * z.diff(t, 2), pull)], watch=["z"])


def test_it_goes_around_scenes_with_bodies():
    body = mass_on_a_coupler()
    F, seen = played(hl.laws.passivity_controller(body, alpha_max=5))
    bare, _ = played(body)
    np.testing.assert_allclose(seen["credit"], taken(F), atol=1e-15)
    np.testing.assert_allclose(F - bare, seen["alpha"] * np.diff(MOTION, prepend=MOTION[0]) / T, atol=1e-12)


@pytest.mark.parametrize(
    "call, error, words",
    [
        (lambda: hl.laws.passivity_controller(WALL, "bogus"), SceneError, "'series'"),
        (lambda: hl.laws.passivity_controller(WALL, "parallel"), SceneError, "stored=hl.laws.wall_energy"),
        (lambda: hl.laws.passivity_controller(mass_on_a_coupler(), "parallel", credit=STORED), SceneError, "moves z"),
        (lambda: hl.laws.passivity_controller(WALL, beta_max=2), SceneError, "give alpha_max"),
        (lambda: hl.laws.passivity_controller(WALL, predict=True, lag=1), SceneError, "lag = 0"),
        (lambda: hl.laws.passivity_controller(WALL, credit=hl.laws.Credit(stored=hl.x(n))), UnitsError, "in m but"),
        (lambda: hl.laws.passivity_controller("wall"), SceneError, "needs a Scene"),
        (lambda: hl.laws.passivity_observer(3), SceneError, "needs a Scene"),
        (lambda: hl.laws.passivity_observer(WALL, lag=0.5), SceneError, "whole samples"),
        (lambda: hl.laws.passivity_observer(hl.laws.passivity_observer(WALL)), SceneError, "F_sent|W"),
        (lambda: hl.laws.passivity_controller(WALL, alpha_max=-1), ParameterError, "alpha_max = -1"),
        (lambda: hl.compile(hl.laws.passivity_controller(WALL), T=T, live=()), ParameterError, "alpha_max"),
    ],
)  # fmt: skip
def test_it_says_what_it_needs(call, error, words):
    with pytest.raises(error, match=words):
        call()
