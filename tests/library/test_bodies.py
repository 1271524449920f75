"""Masses and springs against the closed forms of linear vibration."""

import numpy as np

import hapticlab as hl
from hapticlab.compiler.boards.cost import cost


def test_mass_spring_damper_rings_as_an_oscillator_on_both_springs(led):
    scene = hl.library.mass_spring_damper()(m=0.08, k=90, b=0.3, K=150, b_c=0.2)
    T, start = 1e-4, 0.004
    log = led(scene, np.zeros(4000), T=T, start={"z": start})
    decay, stiffness = (0.3 + 0.2) / (2 * 0.08), (90 + 150) / 0.08
    w = np.sqrt(stiffness - decay**2)
    exact = start * np.exp(-decay * log.t) * (np.cos(w * log.t) + decay / w * np.sin(w * log.t))
    # RK4: (w T)^5/120 a step, 4000 steps
    assert np.abs(log.z - exact).max() < 1e-9 * start
    rate = np.exp(-decay * log.t) * start * -stiffness / w * np.sin(w * log.t)
    assert np.abs(log.F - (-150 * exact - 0.2 * rate)).max() < 1e-8


def test_mass_spring_damper_at_rest_is_two_springs_in_series(led):
    scene = hl.library.mass_spring_damper()(b=5)
    log = led(scene, 0.01 * np.minimum(np.arange(4000) / 500, 1), T=1e-3)
    K, k = scene.values["K"], scene.values["k"]
    assert abs(log.F[-1] - 0.01 * K * k / (K + k)) < 1e-9


def test_two_masses_keep_their_elastic_mode_when_the_handle_lets_go(led):
    m_1, m_2, k = 0.04, 0.11, 70.0
    scene = hl.library.two_masses()(m_1=m_1, m_2=m_2, k=k, b=0, K=0, b_c=0)
    log = led(scene, np.zeros(5000), T=1e-4, start={"z_1": 1e-3 / m_1, "z_2": -1e-3 / m_2})
    swing = 1e-3 * np.cos(np.sqrt(k * (1 / m_1 + 1 / m_2)) * log.t)
    assert np.abs(log.z_1 - swing / m_1).max() < 1e-9
    assert np.abs(log.z_2 + swing / m_2).max() < 1e-9


def test_two_masses_hold_the_first_still_at_the_antiresonance(led):
    scene = hl.library.two_masses()(b=0, b_c=3)
    T, w = 1e-3, np.sqrt(scene.values["k"] / scene.values["m_2"])
    log = led(scene, 0.005 * np.sin(w * T * np.arange(12_000)), T=T)
    last = slice(-1000, None)
    assert np.ptp(log.z_1[last]) < 1e-3 * np.ptp(log.x[last])  # what is left of the start
    # the second mass answers the coupler alone: k z_2 = -(K x + b_c x')
    K, b_c, k = (scene.values[name] for name in ("K", "b_c", "k"))
    assert abs(np.ptp(log.z_2[last]) / 2 - 0.005 * np.hypot(K, b_c * w) / k) < 2e-5


def test_tuned_absorber_silences_the_machine_and_swings_with_the_force_over_its_spring(led):
    scene = hl.library.tuned_absorber()(b_1=3)
    log = led(scene, np.zeros(15_000), T=1e-3)
    last, F_0, k_2 = slice(-1000, None), scene.values["F_0"], scene.values["k_2"]
    assert np.ptp(log.z_1[last]) / 2 < 1e-4 * F_0 / k_2
    assert abs(np.abs(log.z_2[last]).max() / (F_0 / k_2) - 1) < 2e-4  # sampled beside its peak: (w T)^2/8


def test_a_detuned_absorber_follows_den_hartog(led):
    scene = hl.library.tuned_absorber()(b_1=3, b_2=0.05, Omega=25)
    log = led(scene, np.zeros(15_000), T=1e-3)
    p, w = scene.values, 25.0
    own = p["k_2"] + 1j * w * p["b_2"]
    absorbing = own * -p["m_2"] * w**2 / (own - p["m_2"] * w**2)  # the force of the absorber on the machine per metre
    main = p["k_1"] + p["K"] - p["m_1"] * w**2 + 1j * w * (p["b_1"] + p["b_c"]) + absorbing
    last = slice(-2000, None)
    basis = np.column_stack([np.cos(w * log.t[last]), np.sin(w * log.t[last])])
    (cosine, sine), *_ = np.linalg.lstsq(basis, log.z_1[last], rcond=None)
    exact = p["F_0"] / main / 1j  # of sin(w t)
    assert abs(cosine - 1j * sine - exact) < 1e-6 * abs(exact)


def test_a_fixed_mass_spring_damper_fits_an_uno_at_1000_hz_and_is_exact(led):
    scene = hl.library.mass_spring_damper()
    taken = cost(hl.compile(scene, method="exact", live="", T=1e-3))
    assert taken.fits, str(taken)
    p = scene.values
    log = led(scene, np.zeros(300), T=1e-3, start={"z": 1e-3}, method="exact", live="")
    decay, stiffness = (p["b"] + p["b_c"]) / (2 * p["m"]), (p["k"] + p["K"]) / p["m"]
    poles = np.roots([1, 2 * decay, stiffness])
    exact = 1e-3 * (poles[1] * np.exp(poles[0] * log.t) - poles[0] * np.exp(poles[1] * log.t)) / (poles[1] - poles[0])
    assert np.abs(log.z - exact.real).max() < 1e-14
