"""Velocity estimators against textbook algorithms in whole arrays: filters of scipy, loops over windows, matrices."""

import pickle

import numpy as np
import pytest
from scipy.linalg import solve_discrete_are
from scipy.signal import lfilter, lfilter_zi

import hapticlab as hl
from hapticlab import n, x
from hapticlab.compiler.boards.board_fit import fit
from hapticlab.compiler.boards.cost import cost
from hapticlab.compiler.engines.engine import load
from hapticlab.errors import ProgramLimitError, SceneError, UnitsError
from hapticlab.scene.laws.adaptive_window import window_velocity
from hapticlab.scene.laws.chapter_laws import virtual_damper, wall
from hapticlab.scene.laws.estimators import backward_velocity, filtered_velocity
from hapticlab.scene.laws.kalman import kalman_velocity

T, BAND, NOISE, ACCELERATION = 1e-3, 20e-6, 6e-6, 30.0
GENERATOR = np.random.default_rng(5)
TIMES = T * np.arange(400)
#: slow and fast stretches, a stop, and noise that no window's line can be within the band of for ever
PATH = 0.01 * np.sin(9 * TIMES) + 0.002 * np.sin(70 * TIMES) + GENERATOR.normal(0, NOISE, len(TIMES))
PATH[250:300] = PATH[250]


def estimated(estimate, path=PATH, dtype="float64", engine="interpreter", period=T):
    program = hl.compile(virtual_damper(velocity=estimate)(B=1), T=period, dtype=dtype)
    return load(program, engine).run(len(path), path[:, None]).outputs[:, 0, 0]


def past(path, lag):
    return path[np.maximum(np.arange(len(path)) - lag, 0)]


def windows_one_after_the_other(path, band, most, line_of):
    """The published loop: lengthen the window while the line of it passes every sample within the band."""
    found = np.zeros(len(path))
    for k in range(len(path)):
        samples = [path[max(k - j, 0)] for j in range(most + 1)]
        found[k] = (samples[0] - samples[1]) / T
        for i in range(2, most + 1):
            slope, newest = line_of(samples[: i + 1])
            if max(abs(samples[j] - newest + j * slope) for j in range(i + 1)) > band:
                break
            found[k] = slope / T
    return found


def end_line(samples):
    return (samples[0] - samples[-1]) / (len(samples) - 1), samples[0]


def best_line(samples):
    slope, newest = np.polyfit(-np.arange(len(samples)), np.array(samples) - samples[0], 1)
    return slope, newest + samples[0]


def kalman_by_matrices(path, speed=None):
    """The filter as every book writes it, from one measurement, or with the gain of the Riccati equation."""
    F, G = np.array([[1, T], [0, 1]]), np.array([[T * T / 2], [T]])
    Q, H, R = ACCELERATION**2 * G @ G.T, np.array([[1.0, 0.0]]), np.array([[NOISE**2]])
    state, P, found = np.array([path[0], 0.0]), None, []
    if speed is None:
        steady = solve_discrete_are(F.T / 1, H.T, Q, R)
    else:
        P = np.diag([NOISE**2, speed**2])
    for k, sample in enumerate(path):
        if speed is None or k > 0:
            state = F @ state
            ahead = steady if speed is None else F @ P @ F.T + Q
            gain = ahead @ H.T / (H @ ahead @ H.T + R)
            state = state + gain[:, 0] * (sample - state[0])
            P = (np.eye(2) - gain @ H) @ ahead
        found.append(state[1])
    return np.array(found)


def test_the_backward_difference_is_its_formula():
    np.testing.assert_allclose(estimated(backward_velocity()), (PATH - past(PATH, 1)) / T, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("tau", [0.0, 0.8e-3, 4e-3])
def test_the_filter_is_the_backward_mapping_of_its_differential_equation(tau):
    """tau v' + v = x' with s = (1 - 1/z)/T: (tau + T) v - tau v[-1] = x - x[-1], from rest."""
    moved = PATH - past(PATH, 1)
    expected = lfilter([1.0], [tau + T, -tau], moved)
    np.testing.assert_allclose(estimated(filtered_velocity(tau=tau)), expected, rtol=1e-8, atol=1e-11)


@pytest.mark.parametrize("most", [1, 2, 3, 8])
@pytest.mark.always("[123]")
def test_a_window_by_end_fit_is_the_published_loop(most):
    """The cones that narrow sample by sample choose the windows that the loop over all pairs chooses."""
    expected = windows_one_after_the_other(PATH, BAND, most, end_line)
    np.testing.assert_allclose(estimated(window_velocity(deviation=BAND, longest=most)), expected, rtol=1e-8, atol=1e-10)


def test_a_window_by_best_fit_is_the_line_of_least_squares():
    path = PATH[180:330]
    expected = windows_one_after_the_other(path, BAND, 5, best_line)
    # polyfit solves by a factorization: 1e-12 of a displacement of 1e-4 m per period
    found = estimated(window_velocity(deviation=BAND, longest=5, fit="best"), path)
    np.testing.assert_allclose(found, expected, rtol=1e-8, atol=1e-9)


def test_windows_of_every_length_are_chosen_here():
    """The path above exercises the loop: what a window of 8 says differs from every shorter one somewhere."""
    found = [windows_one_after_the_other(PATH, BAND, most, end_line) for most in (1, 2, 4, 8)]
    for shorter, longer in zip(found, found[1:], strict=False):
        assert 0.05 < np.mean(shorter != longer) < 1


def test_the_steady_gains_are_those_of_the_riccati_equation():
    expected = kalman_by_matrices(PATH)
    found = estimated(kalman_velocity(acceleration=ACCELERATION, noise=NOISE))
    np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-10)  # the Riccati solver's own 1e-10


@pytest.mark.parametrize("speed", [1.0, 1e-3])
def test_the_filter_from_the_start_is_the_one_of_matrices(speed):
    expected = kalman_by_matrices(PATH, speed)
    found = estimated(kalman_velocity(acceleration=ACCELERATION, noise=NOISE, steady=False, speed=speed))
    np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-11)


def test_from_the_start_a_moving_handle_is_known_at_the_second_sample():
    """From the second sample on the speed is a difference; the steady filter still climbs."""
    path = 0.3 * TIMES[:5]
    early = estimated(kalman_velocity(acceleration=1.0, noise=NOISE, steady=False, speed=10.0), path)
    late = estimated(kalman_velocity(acceleration=1.0, noise=NOISE), path)
    assert abs(early[1] - 0.3) < 1e-5 * 0.3  # (sigma/(speed T))^2 = 3.6e-7 of it is left to the prior
    assert late[1] < 0.25


@pytest.mark.parametrize(
    "estimate",
    [
        backward_velocity(),
        filtered_velocity(tau=2e-3),
        kalman_velocity(acceleration=ACCELERATION, noise=NOISE),
        kalman_velocity(acceleration=0.5, noise=NOISE),
    ],
)
def test_the_transfer_function_is_the_response(estimate):
    over, under = estimate.transfer(T)
    initial = lfilter_zi(over, under) * PATH[0]
    expected, _ = lfilter(over, under, PATH, zi=initial)
    np.testing.assert_allclose(estimated(estimate), expected, rtol=1e-8, atol=1e-9)


@pytest.mark.parametrize(
    ("estimate", "lag"),
    [
        (backward_velocity(), 0.5),
        (filtered_velocity(tau=2e-3), 2.5),
        (window_velocity(deviation=1.0, longest=6), 3.0),
    ],
)
def test_the_lag_under_constant_acceleration(estimate, lag):
    """v_hat(t) = a (t - lag): the lag in periods of the module's table."""
    times = T * np.arange(300)
    found = estimated(estimate, 5 * times**2 / 2)
    assert found[-1] == pytest.approx(5 * (times[-1] - lag * T), rel=1e-9)


def test_the_lag_of_the_steady_filter():
    estimate = kalman_velocity(acceleration=ACCELERATION, noise=NOISE)
    over, under = estimate.transfer(T)
    alpha, beta = 1 - under[2], over[0] * T
    times = T * np.arange(300)
    found = estimated(estimate, 5 * times**2 / 2)
    assert found[-1] == pytest.approx(5 * (times[-1] - T * (alpha / beta - 0.5)), rel=1e-9)


def test_every_estimator_runs_in_the_firmware_core():
    """In float32 the rounding of a position of 12 mm, 1e-9 m, is 1e-6 m/s of a difference: alike to a few of these."""
    for estimate in (
        filtered_velocity(tau=4e-3), window_velocity(deviation=BAND, longest=6),
        window_velocity(deviation=BAND, longest=4, fit="best"),
        kalman_velocity(acceleration=30, noise=NOISE), kalman_velocity(acceleration=30, noise=NOISE, steady=False),
    ):  # fmt: skip
        path = PATH[200:320].astype(np.float32).astype(float)
        there, here = (estimated(estimate, path, "float32", engine) for engine in ("vm", "interpreter"))
        np.testing.assert_array_equal(there, here)
        close = np.abs(there - estimated(estimate, path)) < 2e-5
        assert close.mean() > 0.99, estimate.name  # a window may be chosen otherwise where a sample is on the band


def test_an_estimate_is_better_than_a_difference_on_an_encoder():
    """Counts of 20 um: at 10 mm/s the difference is 0 or 20 mm/s, while the others stay near."""
    times = T * np.arange(900)
    true = 0.01 * np.cos(times)
    counts = np.floor(0.01 * np.sin(times) / BAND) * BAND
    wrong = {
        estimate.name: np.sqrt(np.mean((estimated(estimate, counts) - true)[50:] ** 2))
        for estimate in (
            backward_velocity(), filtered_velocity(tau=8e-3), window_velocity(deviation=BAND, longest=8),
            kalman_velocity(acceleration=0.3, noise=BAND / np.sqrt(12)),
        )
    }  # fmt: skip
    difference = wrong.pop("backward difference")
    assert difference > 5e-3
    assert max(wrong.values()) < 0.3 * difference


# ---------------------------------------------------------------- in a wall


@pytest.mark.parametrize("unilateral", ["gate", "clip", None])
def test_a_wall_takes_the_estimate_for_its_velocity(unilateral):
    """Eq. (23.3) and the damper, with the velocity that was chosen and no other."""
    stiffness, damping, boundary = 300.0, 0.4, 0.004
    scene = wall("half_sample", unilateral=unilateral, velocity=filtered_velocity(tau=2e-3))(k=stiffness, B=damping, x_o=boundary)
    program = hl.compile(scene, T=T, dtype="float64", velocity="measured")
    assert [c.name for c in program.inputs] == ["x"]  # a measured velocity is not asked for
    found = load(program).run(len(PATH), PATH[:, None]).outputs[:, 0, 0]
    v = lfilter([1.0], [2e-3 + T, -2e-3], PATH - past(PATH, 1))
    depth, inside = PATH - boundary, PATH >= boundary
    if unilateral == "clip":
        depth, v = np.maximum(depth, 0), np.where(inside, v, 0)
    expected = stiffness * (depth + T / 2 * v) + damping * v
    expected = np.where(inside, expected, 0) if unilateral == "gate" else expected
    np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-10)


def test_eq_23_2_with_an_estimate_is_eq_23_3():
    estimate = kalman_velocity(acceleration=30, noise=NOISE)
    k = hl.parameters("k", units="N/m")
    ahead = x(n) + hl.T * estimate.velocity
    mean = hl.Scene(k / 2 * (x(n) + ahead), eom=estimate.eom)(k=300)
    lead = wall("half_sample", unilateral=None, velocity=estimate)(k=300)
    forces = [load(hl.compile(s, T=T, dtype="float64")).run(400, PATH[:, None]).outputs for s in (mean, lead)]
    np.testing.assert_allclose(*forces, rtol=1e-12, atol=1e-12)


def test_the_plain_difference_is_the_wall_without_an_estimate():
    one, other = wall("half_sample", velocity=backward_velocity()), wall("half_sample")
    forces = [load(hl.compile(s(k=300, B=0.2), T=T, dtype="float64")).run(400, PATH[:, None]).outputs for s in (one, other)]
    np.testing.assert_allclose(*forces, rtol=1e-9, atol=1e-9)


def test_an_estimate_goes_through_a_pickle_and_its_constants_may_be_live():
    """As scenes do that other workers compile; a Parameter instead of a number is settable while it runs."""
    tau, acceleration = hl.parameters("tau acceleration", units="s m/s^2", values=("4 ms", 20))
    for estimate, live in (
        (filtered_velocity(tau=tau), "tau"),
        (kalman_velocity(acceleration=acceleration, noise=NOISE, steady=False), "acceleration"),
    ):
        scene = virtual_damper(velocity=estimate)(B=1)
        again = pickle.loads(pickle.dumps(scene))
        assert again == scene
        program = hl.compile(again, T=T)
        assert [c.name for c in program.parameters] == ["B", live]
        assert program == hl.compile(scene, T=T)


def test_two_estimates_of_one_name_are_refused():
    wall_of_one = wall(velocity=filtered_velocity(tau=1e-3))
    with pytest.raises(SceneError, match=r"two equations define v_filtered\(n\)"):
        hl.laws.damping_compensation(wall_of_one, b=0.1, velocity=filtered_velocity(tau=2e-3))
    other = filtered_velocity(tau=2e-3, name="v_slow")
    assert len(hl.laws.damping_compensation(wall_of_one, b=0.1, velocity=other).eom) == 2


# ---------------------------------------------------------------- refusals and costs


@pytest.mark.parametrize(
    ("make", "error", "words"),
    [
        (lambda: filtered_velocity(tau=-1e-3), SceneError, r"tau = -0.001 s; a filter needs tau >= 0"),
        (lambda: filtered_velocity(tau="4 mm"), UnitsError, "tau = '4 mm'"),
        (lambda: window_velocity(deviation=1e-5, longest=0), SceneError, "whole number of periods, 1 to 32"),
        (lambda: window_velocity(deviation=1e-5, longest=2.0), SceneError, "whole number"),
        (lambda: window_velocity(deviation=1e-5, fit="least"), SceneError, "'end' .* or 'best'"),
        (lambda: kalman_velocity(acceleration=0, noise=1e-5), SceneError, r"acceleration = 0 m/s\^2; .* > 0"),
        (lambda: kalman_velocity(acceleration=1, noise=-1e-5), SceneError, "a sensor needs noise > 0"),
        (lambda: window_velocity(deviation=1e-5).transfer(T), SceneError, "no transfer function"),
        (lambda: filtered_velocity(tau=hl.parameters("tau", units="s")).transfer(T), SceneError, "tau has no number"),
        (lambda: wall(velocity="filtered"), SceneError, "velocity = 'filtered'; needs an estimate"),
    ],
)
def test_what_is_no_estimate_is_refused(make, error, words):
    with pytest.raises(error, match=words):
        make()


OWN = hl.parameters("k B", units="N/m N*s/m", values=(300, 0.2))
#: how an estimate is made, period, and what a refusal names first; shorter windows for the longest
DEAR = [
    pytest.param(lambda: kalman_velocity(acceleration=30, noise=NOISE, steady=False), 0.8e-3, "Kalman filter"),
    pytest.param(
        lambda: window_velocity(deviation=BAND, longest=12), 1e-3, "adaptive window of 3, end fit", marks=pytest.mark.slow
    ),
    pytest.param(
        lambda: window_velocity(deviation=BAND, longest=4, fit="best"),
        1e-3,
        "adaptive window of 2, end fit",
        marks=pytest.mark.slow,
    ),
]


@pytest.mark.parametrize(("make", "period", "named"), DEAR)
@pytest.mark.wide
def test_a_scene_that_does_not_fit_the_uno_names_the_cheaper_estimate(make, period, named):
    """Any scene that holds one, and watches it; and what is named does fit a wall of ours."""
    (k, B), estimate = OWN, make()
    scene = hl.Scene(k * x(n) + B * estimate.velocity, eom=estimate.eom, watch={"speed": estimate.velocity})
    with pytest.raises(ProgramLimitError, match=f"fits (with every=.*, or )?with velocity='{named}'"):
        fit(scene, T=period)
    cheaper = next(e for e in estimate.cheaper if e.name == named)
    assert fit(wall("half_sample", velocity=cheaper)(k=300, B=0.1), T=period).fits


@pytest.mark.parametrize(
    "estimate",
    [
        filtered_velocity(tau=4e-3),
        window_velocity(deviation=BAND, longest=4),
        kalman_velocity(acceleration=30, noise=NOISE),
        kalman_velocity(acceleration=30, noise=NOISE, steady=False),
    ],
)
def test_what_fits_the_uno_at_1_khz_beside_a_damper(estimate):
    taken = cost(hl.compile(virtual_damper(velocity=estimate)(B=1), T=1e-3))
    assert taken.fits
    assert taken.typical > cost(hl.compile(virtual_damper()(B=1), T=1e-3)).typical
