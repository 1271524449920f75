"""Constants from records of a free handle: what is found, what is refused, and what a known reference adds."""

from dataclasses import replace

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.base.telemetry import Telemetry
from hapticlab.errors import AnalysisError
from hapticlab.identification.held_force_motion import positions
from hapticlab.identification.identifying_forces import Excitation

COUNTS = 1 / 12.8e-6
PADDLE = hl.SimulatedPaddle(m=0.03, b=0.1, T=1e-3, coulomb=0.05, delay=0.7e-3, noise=6e-6, counts_per_metre=COUNTS)
STEPS, CHIRP = Excitation("steps", 0.3, 30, 300), Excitation("chirp", 0.4, 160, 600)


def run(made, paddle=PADDLE, **start):
    return paddle.run(made.scene(0.1), duration=made.samples * 1e-3, **start)


@pytest.fixture(scope="module")
def steps():
    return run(STEPS)


@pytest.fixture(scope="module")
def found(steps):
    return hl.identify.step_response(steps, counts_per_metre=COUNTS)


def check(found, part=0.02, **true):
    for name, value in true.items():
        # a seeded draw: not outside of two intervals' widths, and told to a part of it (delay to 20 us)
        assert abs(found[name].value - value) < 2 * found[name].half_width, name
        assert found[name].half_width < (2e-5 if name == "delay" else part * value), name


def test_steps_tell_all_four(found):
    check(found, m=0.03, b=0.1, coulomb=0.05, delay=0.7e-3)
    assert found.converged and found.explained and found.counted
    assert found.sigma == pytest.approx(6e-6, rel=0.15)


@pytest.mark.wide
def test_a_chirp_tells_all_four():
    check(hl.identify.chirp_response(run(CHIRP), counts_per_metre=COUNTS), part=0.1, m=0.03, b=0.1, coulomb=0.05, delay=0.7e-3)


def test_a_spin_down_after_a_kick_tells_ratios_or_with_the_mass_both():
    log = run(Excitation("kick", 1.0, 10, 330))
    ratios = hl.identify.spin_down(log, counts_per_metre=COUNTS)
    assert set(ratios.estimates) == {"b/m", "coulomb/m"}
    assert len(ratios.measured) == 330 - 20 - 10 - 5
    check(ratios, **{"b/m": 0.1 / 0.03, "coulomb/m": 0.05 / 0.03})
    both = hl.identify.spin_down(log, m=0.03, counts_per_metre=COUNTS)
    assert both["b"].value == pytest.approx(0.03 * ratios["b/m"].value, rel=1e-6)
    with pytest.raises(AnalysisError, match="mass was not found"):
        ratios.profile()


def test_what_is_known_is_not_sought(steps):
    found = hl.identify.step_response(steps, counts_per_metre=COUNTS, known={"m": 0.03, "delay": 0.7e-3})
    assert list(found.estimates) == ["b", "coulomb"]
    check(found, b=0.1, coulomb=0.05)


def test_the_force_constant_needs_a_reference(steps):
    with pytest.raises(AnalysisError, match="cannot be found from motion alone,.*hanging"):
        hl.identify.handle(steps, force_constant=True, counts_per_metre=COUNTS)


def weaker(log, scale):
    """Return the record of a paddle whose motor gives ``scale`` newtons for each it reckons."""
    return replace(log, F=log.F / scale)


@pytest.mark.wide
def test_a_known_mass_tells_the_force_constant(steps):
    heavy = weaker(run(STEPS, replace(PADDLE, m=0.05, seed=1)), 0.8)
    found = hl.identify.handle(
        weaker(steps, 0.8), hl.identify.HandleRecord(heavy, added=0.02), force_constant=True, counts_per_metre=COUNTS
    )
    check(found, m=0.03, b=0.1, coulomb=0.05, scale=0.8)


@pytest.mark.wide
def test_a_hanging_weight_tells_the_force_constant():
    weight = 0.01
    loaded = replace(PADDLE, m=PADDLE.m + weight, hand=hl.Hand(push=weight * 9.80665))
    log = weaker(run(CHIRP, loaded), 1.25)
    found = hl.identify.handle(hl.identify.HandleRecord.hanging(log, weight), force_constant=True, counts_per_metre=COUNTS)
    check(found, m=0.03, scale=1.25)


def test_what_a_record_does_not_tell_is_named(steps):
    held = replace(steps, F=np.zeros(len(steps)), x=0.4 * steps.t - steps.t**2 / 2)
    with pytest.raises(AnalysisError, match="do not determine m,.*(m|delay)"):
        hl.identify.handle(hl.identify.HandleRecord(held, at_rest=False))


@pytest.mark.wide
def test_a_hand_on_the_handle_is_told_as_not_explained():
    found = hl.identify.step_response(run(STEPS, replace(PADDLE, hand=hl.Hand(m=0.02, b=0.5, k=60))), counts_per_metre=COUNTS)
    assert not found.explained
    assert "NOT EXPLAINED" in str(found) and "a hand" in str(found)


@pytest.mark.wide
def test_a_sensor_without_dither_is_told_and_its_rounding_is_no_misfit():
    for seed in range(2):
        found = hl.identify.step_response(run(STEPS, replace(PADDLE, noise=5e-7, seed=seed)), counts_per_metre=COUNTS)
        assert found.explained and not found.dithered
        assert "NOT DITHERED" in str(found) and "quantising the fitted motion again" in str(found)


def test_refusals_say_what_to_do(steps):
    cases = {
        "few steps": lambda: hl.identify.step_response(run(CHIRP)),
        "always changes": lambda: hl.identify.chirp_response(steps),
        "F = 0 until": lambda: hl.identify.spin_down(replace(steps, F=np.ones(len(steps)))),
        "constants of m": lambda: hl.identify.handle(steps, known={"mass": 1}),
        "no record;": lambda: hl.identify.handle(),
        "20 counts": lambda: hl.identify.step_response(replace(steps, x=np.zeros(len(steps))), counts_per_metre=COUNTS),
        "fault": lambda: hl.identify.handle(replace(steps, fault="OVER_SPEED")),
        "one sample in 2": lambda: hl.identify.handle(replace(steps, every=2)),
        "counts_per_metre": lambda: hl.identify.handle(steps, counts_per_metre=0),
        "was not estimated": lambda: hl.identify.spin_down(run(Excitation("kick", 1.0, 10, 330)), m=0.03)["delay"],
    }
    for words, call in cases.items():
        with pytest.raises(AnalysisError, match=words):
            call()


def test_a_handle_that_a_negative_damper_drives_is_refused(steps):
    x = positions(steps.F, 1e-3, m=0.03, b=-0.1, coulomb=0.0, delay=0.0, scale=1.0, push=0.0, x0=0.0, v0=0.0)
    noise = 6e-6 * np.random.default_rng(0).standard_normal(len(x))
    with pytest.raises(AnalysisError, match=r"the best fit has a negative b,.*the model \(a stop,"):
        hl.identify.step_response(replace(steps, x=x + noise))


@pytest.mark.parametrize("quantum", [0.0, 1 / COUNTS])
def test_one_step_does_not_tell_mass_damping_and_friction_apart_and_a_second_size_does(quantum):
    """(k m, k b, F + k (coulomb - F)) moves alike for every k while the force has one size and drives the handle."""
    draws, counts = np.random.default_rng(0), 1 / quantum if quantum else None

    def identified(F):
        x = positions(F, 1e-3, m=0.03, b=0.3, coulomb=0.05, delay=0.7e-3, scale=1.0, push=0.0, x0=0.0, v0=0.0)
        x = x + 6e-6 * draws.standard_normal(len(F))
        x = np.floor(x / quantum) * quantum if quantum else x
        log = Telemetry(t=np.arange(len(F)) * 1e-3, x=x, v=np.gradient(x, 1e-3), F=F, T=1e-3)
        return hl.identify.step_response(log, counts_per_metre=counts)

    samples = np.arange(150)
    one = -0.3 * (samples >= 20)
    with pytest.raises(
        AnalysisError,
        match=r"do not determine m, b, coulomb separately, or at all. Record a push, steps and a chirp \(hl.identify.paddle "
        r"does this\),",
    ):
        identified(one)
    check(identified(one - 0.2 * (samples >= 85)), part=0.1, m=0.03, b=0.3, coulomb=0.05)


def test_a_profile_is_marked_as_measured_and_makes_a_paddle(found):
    profile = found.profile("mine", force_max=2.0)
    assert (profile.name, profile.nominal, profile.force_max, profile.T) == ("mine", False, 2.0, 1e-3)
    assert profile.counts_per_metre == pytest.approx(COUNTS)
    assert "measured" in str(profile)
    paddle = found.paddle(T=5e-4)
    assert (paddle.m, paddle.delay, paddle.T) == (found["m"].value, found["delay"].value, 5e-4)


def test_it_prints_intervals_and_draws_residuals(found):
    text = str(found)
    for word in ("300 samples", "95% confidence", "mass", "Coulomb friction", "delay", "counts of 12.8 um"):
        assert word in text
    assert found.dithered and "NOT DITHERED" not in text
    assert 0.03 in found["m"] and float(found["m"]) == found["m"].value
    above, below = found.plot().axes
    assert above.get_ylabel().endswith("[mm]") and below.get_ylabel().endswith("[µm]")
    np.testing.assert_allclose(above.lines[0].get_ydata(), 1e3 * found.measured)
