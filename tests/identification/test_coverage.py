"""The intervals hold the truth as often as they say, and are as narrow as they can be; the whole table is a benchmark's."""

import importlib.util
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import hapticlab as hl

_FILE = Path(__file__).parents[1] / "benchmarks" / "identification.py"
_spec = importlib.util.spec_from_file_location("identification_benchmark", _FILE)
trials = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(trials)
KINDS, SENSORS = trials.kinds(), trials.SENSORS


def check(rows, count):
    for name, covered, width, bias, pull, converged in rows:
        # three standard errors of a binomial draw with 95 %; four of a mean
        assert abs(covered - 0.95) < 3 * (0.95 * 0.05 / count) ** 0.5, (name, covered)
        assert 0.9 < width < 1.1, (name, width)
        assert abs(bias) < 4 / count**0.5, (name, bias)
        # the size of the errors tells an interval too narrow from fewer trials than their count; 3 standard errors
        assert abs(pull**2 - 1) < 3 * (2 / count) ** 0.5, (name, pull)
        assert converged == 1.0


def test_spin_down_covers_with_noise():
    check(trials.trial_rows(KINDS["spin-down"], SENSORS["noise 10 um"], 150), 150)


@pytest.mark.wide
def test_steps_cover_with_counts():
    check(trials.trial_rows(KINDS["steps"], SENSORS["noise 5 um, counts of 12.8 um"], 24), 24)


@pytest.mark.wide
def test_a_handle_without_friction_is_fitted_to_the_end():
    """The likelihood has a kink where friction begins, unless it is turned about zero."""
    kind = trials.kinds(b=0.0, coulomb=0.0)["chirp"]
    y, F = trials.recorded(kind, SENSORS["noise 10 um"], 6)
    found = trials.fitted(kind, SENSORS["noise 10 um"], y, F)
    assert found.converged.all()
    assert np.all(np.abs(found.values[1:3]) < 4 * found.error[1:3])
    assert np.all(found.values[1:3] >= 0) and np.any(found.values[2] < 1e-9) and np.any(found.values[2] > 1e-9)


@pytest.mark.wide
def test_of_two_tops_the_higher_is_found_where_friction_takes_half_the_force():
    """From least squares alone all of these end at m = 0.037 kg, b = 1.5 N s/m with residuals of 12 um for 10 um."""
    kind = trials.kinds(coulomb=0.2)["chirp"]
    y, F = trials.recorded(kind, SENSORS["noise 10 um"], 2, first=4)
    found = trials.fitted(kind, SENSORS["noise 10 um"], y, F)
    np.testing.assert_allclose(found.values[0], 0.03, rtol=0.03)
    np.testing.assert_allclose(found.values[2], 0.2, rtol=0.03)


@pytest.mark.slow
@pytest.mark.parametrize("sensor", SENSORS)
@pytest.mark.parametrize("kind", KINDS)
def test_a_thousand_trials_cover(kind, sensor):
    for name, covered, width, *_ in trials.trial_rows(KINDS[kind], SENSORS[sensor], 1000):
        assert 0.93 <= covered <= 0.97, (name, covered)
        assert width < 2, (name, width)


@pytest.mark.slow
@pytest.mark.parametrize("changed", [{"b": 0.0}, {"coulomb": 0.2}, {"m": 0.1, "delay": 0.0}])
def test_other_constants_are_covered_as_well(changed):
    check(trials.trial_rows(trials.kinds(**changed)["steps"], SENSORS["noise 10 um"], 200), 200)


def test_a_trial_is_what_a_paddle_of_that_seed_records():
    kind, sensor = KINDS["chirp"], SENSORS["noise 5 um, counts of 12.8 um"]
    y, F = trials.recorded(kind, sensor, 2, first=7)
    paddle = replace(trials.paddle_of(sensor), seed=8)
    log = paddle.run(kind.excitation.scene(trials.TRAVEL), duration=kind.excitation.samples * 1e-3, dtype="float64")
    # float32 of a count; forces come from the same scene
    np.testing.assert_allclose(y[:, 1], log.x, rtol=0, atol=3e-9)
    np.testing.assert_array_equal(F, log.F)


def test_damping_of_a_coasting_handle_is_told_as_well_as_the_curvature_of_a_parabola():
    """With nothing but b sought, x = x0 + v t - b/m v t^2/2 while b t/m is small."""
    t, noise, v = np.arange(200) * 1e-3, 1e-5, 0.1
    log = hl.SimulatedPaddle(m=0.03, b=0.0, T=1e-3, noise=noise).run(hl.laws.virtual_damper()(B=0), duration=0.2, v=v)
    found = hl.identify.handle(hl.identify.HandleRecord(log, at_rest=False), known={"m": 0.03, "coulomb": 0.0, "delay": 0.0})
    columns = np.column_stack([np.ones(200), t, t**2 / 2])
    curvature = noise * np.sqrt(np.linalg.inv(columns.T @ columns)[2, 2])
    # 1.97 is Student's 97.5 % at 197; the noise is estimated, to its standard error of 5 %
    assert found["b"].high - found["b"].value == pytest.approx(1.97 * curvature * 0.03 / v, rel=0.15)
