"""The closed-form motion under a held force, against integrators that share nothing with it."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from hapticlab.device.hand.hand import Hand
from hapticlab.device.simulated.simulated_paddle import SimulatedPaddle
from hapticlab.identification.hand_motion import hand_positions
from hapticlab.identification.held_force_motion import FEW, positions
from hapticlab.identification.identifying_forces import Excitation, designed

T = 1e-3
BODY = {"m": 0.03, "b": 0.1, "coulomb": 0.05}


def integrated(F, T, delay, m, b, k, coulomb, rest, x0, v0, push=0.0, scale=1.0):
    """Return positions by an adaptive integrator, restarted at every change of the force and every stop."""
    changes = [(n * T + delay, force) for n, force in enumerate(F)]
    edges = sorted({0.0, *(n * T for n in range(len(F))), *(t for t, _ in changes if 0 < t < (len(F) - 1) * T)})
    x, v, found = x0, v0, {0: x0}
    for begin, end in zip(edges, edges[1:], strict=False):
        felt = [force for t, force in changes if t <= begin + 1e-12]
        x, v = stretch(x, v, end - begin, push - scale * (felt[-1] if felt else 0.0), m, b, k, coulomb, rest)
        if abs(end / T - round(end / T)) < 1e-9:
            found[round(end / T)] = x
    return np.array([found[n] for n in range(len(F))])


def stretch(x, v, lasts, u, m, b, k, coulomb, rest):
    while lasts > 1e-15:
        net = u - k * (x - rest)
        heading = np.sign(v) if v else (np.sign(net) if abs(net) > coulomb else 0.0)
        if heading == 0:
            return x, 0.0

        def stops(t, s, heading=heading):
            return s[1] * heading + (1e-9 if t < 1e-7 else 0.0)

        def rate(t, s, heading=heading):
            return [s[1], (u - b * s[1] - k * (s[0] - rest) - coulomb * heading) / m]

        stops.terminal, stops.direction = True, -1
        way = solve_ivp(rate, (0, lasts), [x, v], method="DOP853", rtol=1e-12, atol=1e-15, events=stops)
        x, v = way.y[:, -1]
        v = 0.0 if way.status == 1 else v
        lasts -= way.t[-1]
    return x, v


@pytest.mark.parametrize("delay", [0.0, 0.4e-3, 1.7e-3])
def test_a_free_handle_moves_as_an_adaptive_integrator_says(delay):
    F = Excitation("steps", 0.3, 6, 70).forces(T)
    expected = integrated(F, T, delay, k=0.0, rest=0.0, x0=1e-3, v0=0.02, push=0.01, scale=1.1, **BODY)
    found = positions(F, T, delay=delay, scale=1.1, push=0.01, x0=1e-3, v0=0.02, **BODY)
    assert np.ptp(expected) > 2e-4
    # the integrator's own tolerance, over 70 restarts
    np.testing.assert_allclose(found, expected, rtol=0, atol=2e-13)


@pytest.mark.parametrize("coulomb", [0.0, 0.05])
@pytest.mark.parametrize("body", [(0.13, 5.1, 500.0), (0.04, 8.0, 100.0)])  # swings, creeps
def test_a_held_handle_moves_as_an_adaptive_integrator_says(coulomb, body):
    m, b, k = body
    F = np.where((np.arange(60) >= 10) & (np.arange(60) < 25), 1.0, 0.0)
    start = {"rest": 1e-3, "x0": 1e-3, "v0": 0.0}
    expected = integrated(F, T, 0.4e-3, m, b, k, coulomb, **start)
    found = hand_positions(F, T, m=m, b=b, k=k, coulomb=coulomb, delay=0.4e-3, **start)
    assert np.ptp(expected) > 5e-4
    np.testing.assert_allclose(found, expected, rtol=0, atol=2e-13)


def test_the_simulated_paddle_moves_alike():
    chirp = Excitation("chirp", 0.3, 60, 300)
    log = SimulatedPaddle(T=T, delay=1.3e-3, **BODY).run(chirp.scene(0.1), duration=0.3, dtype="float64")
    np.testing.assert_allclose(log.F, chirp.forces(T), rtol=0, atol=1e-13)  # its cosine is another one
    found = positions(log.F, T, delay=1.3e-3, scale=1.0, push=0.0, x0=0.0, v0=0.0, **BODY)
    np.testing.assert_allclose(found, log.x, rtol=0, atol=1e-15)


def test_many_motions_side_by_side_are_each_one_alone():
    F, draws = Excitation("chirp", 0.3, 40, 200).forces(T), np.random.default_rng(0)
    body = {"m": 0.03, "b": 0.1, "coulomb": 0.1, "delay": 1e-3, "scale": 1.0, "push": 0.02, "x0": 0.01, "v0": 0.1}
    many = {name: value * draws.uniform(0, 2, (FEW, 2)) for name, value in body.items()}
    alone = [positions(F, T, **{name: a[k, 1] for name, a in many.items()}) for k in range(FEW)]
    # the order of sums
    np.testing.assert_allclose(positions(F, T, **many)[:, :, 1], np.transpose(alone), rtol=0, atol=1e-14)


def test_a_force_felt_before_its_time_is_the_next_one_late():
    F = Excitation("steps", 0.3, 6, 70).forces(T)
    rest = {"scale": 1.0, "push": 0.0, "x0": 0.0, "v0": 0.0, **BODY}
    early, late = positions(F, T, delay=-0.3 * T, **rest), positions(np.roll(F, -1), T, delay=0.7 * T, **rest)
    np.testing.assert_allclose(early[:-1], late[:-1], rtol=0, atol=1e-18)  # 0.7 T is not 1 T - 0.3 T to the last digit


def test_lanes_do_not_see_each_other():
    F = np.random.default_rng(1).normal(0, 0.2, (80, 3))
    lanes = {"m": np.array([[0.02], [0.05]]), "b": np.array([0.0, 0.1, 3.0]), "coulomb": np.array([0.0, 0.1, 0.05])}
    rest = {"scale": 1.0, "push": 0.0, "x0": 0.0}
    delay, v0 = np.array([0.0, 1e-3, 0.25e-3]), np.array([0.1, 0.0, -0.2])
    found = positions(F, T, delay=delay, v0=v0, **lanes, **rest)
    for row in range(2):
        for lane in range(3):
            own = {"m": lanes["m"][row, 0], "b": lanes["b"][lane], "coulomb": lanes["coulomb"][lane]}
            alone = positions(F[:, lane], T, delay=delay[lane], v0=v0[lane], **own, **rest)
            np.testing.assert_allclose(found[:, row, lane], alone, rtol=0, atol=1e-16)


def test_without_damping_the_series_meets_the_parabola():
    t = np.arange(50) * T
    for b in (0.0, 1e-12, 1e-6):
        found = positions(np.zeros(50), T, m=0.05, b=b, coulomb=0.0, delay=0.0, scale=1.0, push=0.2, x0=0.0, v0=0.3)
        np.testing.assert_allclose(found, 0.3 * t + 2 * t**2, rtol=2e-5 if b == 1e-6 else 1e-10)


def test_a_design_fills_the_travel_and_no_more():
    constants = {**BODY, "delay": 1e-3}
    for kind in ("kick", "steps", "chirp"):
        made = designed(kind, 0.4, T, 0.02, constants)
        moved = np.abs(positions(made.forces(T), T, scale=1.0, push=0.0, x0=0.0, v0=0.0, **constants)).max()
        assert 0.006 < moved <= 0.012, kind


def test_the_guard_of_an_excitation_takes_the_force_away():
    made = Excitation("steps", 0.3, 40, 200)
    log = SimulatedPaddle(T=T, hand=Hand(k=20.0), **BODY).run(made.scene(2e-3), duration=0.2)
    outside = np.abs(log.x) > 2e-3
    assert outside.any() and not log.F[outside].any()
