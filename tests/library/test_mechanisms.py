"""Mechanisms against their loop closures, the velocity loop, and the masses that one should feel."""

import numpy as np
import pytest

import hapticlab as hl


@pytest.mark.parametrize("teeth", [(60, 20), (20, 60)])
def test_gears_feel_like_the_flywheel_times_the_ratio_squared(led, teeth):
    N_1, N_2 = teeth
    p = {"r": 0.025, "J_1": 2e-5, "J_2": 3e-6, "K": 150.0}
    scene = hl.library.gears()(**p, N_1=N_1, N_2=N_2, c=0, b_c=0)
    log = led(scene, np.zeros(4000), T=1e-4, start={"phi": 0.1})
    felt = (p["J_1"] + (N_1 / N_2) ** 2 * p["J_2"]) / p["r"] ** 2
    assert np.abs(log.phi - 0.1 * np.cos(np.sqrt(p["K"] / felt) * log.t)).max() < 1e-9
    assert np.abs(log.phi_2 * N_2 + log.phi * N_1).max() < 1e-12


def test_slider_crank_keeps_its_rod_and_its_energy(led):
    p = {"r": 0.035, "l": 0.08, "J": 3e-5, "m": 0.05}
    scene = hl.library.slider_crank()(**p, c=0, K=0, b_c=0)
    T = 1e-4
    log = led(scene, np.zeros(6000), T=T, start={"theta": 1.0, "dtheta/dt": 25.0})
    crank = p["r"] * np.exp(1j * log.theta)
    assert np.abs(np.abs(log.s - p["l"] - crank) - p["l"]).max() < 1e-12  # the rod's length
    rate, speed = np.gradient(log.theta, T)[2:-2], np.gradient(log.s, T)[2:-2]
    kept = p["J"] * rate**2 + p["m"] * speed**2
    assert np.ptp(log.theta) > 4 * np.pi  # through the dead centres, twice
    assert np.ptp(kept) < 1e-4 * kept.mean()  # central differences: (w T)^2/6


def test_four_bar_keeps_the_energy_of_its_velocity_loop(led):
    p = {"a": 0.02, "b": 0.05, "c": 0.04, "d": 0.05, "J_2": 2e-5, "J_4": 1e-4}
    scene = hl.library.four_bar()(**p, B=0, K=0, b_c=0)
    log = led(scene, np.zeros(6000), T=1e-4, start={"theta": 1.0, "dtheta/dt": 25.0})
    # the rocker's joint, where the circles about the crank's tip and about the rocker's pin meet
    reach = p["a"] * np.exp(1j * log.theta) - p["d"]
    opening = (p["c"] ** 2 + np.abs(reach) ** 2 - p["b"] ** 2) / (2 * p["c"] * np.abs(reach))
    rocker = p["d"] + p["c"] * np.exp(1j * (np.angle(reach) - np.arccos(opening)))
    beta, psi = np.angle(rocker - p["a"] * np.exp(1j * log.theta)), np.angle(rocker - p["d"])
    # velocity loop, independent of any formula for psi: c psi' = a theta' sin(theta - beta)/sin(psi - beta)
    ratio = p["a"] / p["c"] * np.sin(log.theta - beta) / np.sin(psi - beta)
    rate = np.gradient(log.theta, 1e-4)[2:-2]
    kept = (p["J_2"] + p["J_4"] * ratio[2:-2] ** 2) * rate**2
    assert np.ptp(log.theta) > 4 * np.pi
    assert np.ptp(kept) < 1e-4 * kept.mean()


def test_rolling_adds_a_third_of_the_disc(led):
    p = {"M": 0.06, "m": 0.12, "K": 150.0}
    scene = hl.library.rolling()(**p, b_c=0)
    log = led(scene, np.zeros(4000), T=1e-4, start={"z": 0.005})
    w = np.sqrt(p["K"] / (p["M"] + p["m"] / 3))
    assert np.abs(log.z - 0.005 * np.cos(w * log.t)).max() < 1e-9
    assert np.abs(log.u + 2 / 3 * (log.z - 0.005)).max() < 1e-9  # u'' = -2/3 z''


def test_rolling_down_a_tilted_plate(led):
    scene = hl.library.rolling()(K=1e5, b_c=20, alpha=0.1)  # the plate all but held
    log = led(scene, np.zeros(10_000), T=2e-5)
    exact = -2 / 3 * 9.81 * np.sin(0.1) * log.t**2 / 2
    assert np.abs(log.u - exact).max() < 3e-5
