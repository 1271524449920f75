"""Wrong answers as students write them, lab by lab: each earns nothing, and the lab has a sentence for it."""

from math import log, log10
from statistics import NormalDist

import numpy as np
import sympy as sp
from matplotlib.figure import Figure

import hapticlab as hl
from hapticlab import n, t, v, x

k, b, x_o, m, K, b_c = hl.parameters("k b x_o m K b_c", units="N/m N*s/m m kg N/m N*s/m")
z = hl.coordinate("z", unit="m", initial=x(n))


def on_coupler(force_sign, mass_sign, z=z):
    F_c = K * (x(t) - z) + b_c * (v(t) - z.diff(t))
    return hl.Scene(force=force_sign * F_c, eom=[sp.Eq(m * z.diff(t, 2), mass_sign * F_c)], watch=[z])


def mass_moves(force):
    return sp.Eq(m * z.diff(t, 2), force)


def pendulum(weight, product, z=z):
    """A pendulum with gravity's sign, and the product of the velocities, as given."""
    theta = hl.coordinate("theta", unit="rad", initial=0.3)
    M, l, g, c = hl.parameters("M l g c", units="kg m m/s^2 N*m*s/rad", values=(0.05, 0.15, 9.81, 1e-4))
    F_c = hl.virtual_coupler(z, K=K, b=b_c)
    square = z.diff(t) ** 2 + product * z.diff(t) * l * theta.diff(t) + (l * theta.diff(t)) ** 2
    energy = M * z.diff(t) ** 2 / 2 + m * square / 2 + weight * m * g * l * sp.cos(theta)
    model = hl.lagrange(energy, dissipation=c * theta.diff(t) ** 2 / 2, forces={z: F_c})
    return hl.Scene(force=F_c, eom=[model], watch=[z, theta])


def drawn_limit(limit):
    axes, delay = Figure().subplots(), np.linspace(0, 3, 100)
    axes.plot(delay, limit(1e-3 * delay))
    axes.set(xlabel="delay [ms]", ylabel="k [N/m]")
    return axes


def crossings(t, x):
    y = x - x.mean()
    return np.sum(y[:-1] * y[1:] < 0) / (t[-1] - t[0])


def turned_back(t, v0, m, b, coulomb):
    return -coulomb / b + (v0 + coulomb / b) * np.exp(-b / m * t)


def one_down(answers, start, factor):
    levels = [start]
    for right in answers[:-1]:
        levels.append(levels[-1] / factor if right else levels[-1] * factor)
    return levels


def by_ten(threshold, levels, right):
    P = [NormalDist().cdf(level / (2**0.5 * threshold)) for level in levels]
    return sum(log10(p if r else 1 - p) for p, r in zip(P, right, strict=True))


WRONG = {
    "00": [
        ("handle_position", lambda counts, left, right, travel: counts * travel / (right - left)),
        ("handle_position", lambda counts, left, right, travel: (counts - (left + right) / 2) * travel / abs(right - left)),
        ("sign_evidence", lambda asked, moved, on: np.sum(asked * moved) / np.sqrt(np.sum((asked * moved) ** 2))),
        ("force_full", lambda duty, grams: np.polyfit(duty, grams * 9.80665e-3, 1)[0]),
        ("force_full", lambda duty, grams: np.polyfit(duty**2, grams * 9.80665, 1)[0]),
        ("felt_stiffness", lambda x, F: np.mean(F / x)),
        ("limits", lambda k, metres_per_count, force_max, T: {
            "reach": k / force_max, "force_step": k * metres_per_count, "speed_step": metres_per_count / T}),
        ("which_way", "a"),
    ],
    "01": [
        ("spring_damper_force", lambda x, v, k, b: -k * x - b * v),
        ("spring_damper_force", lambda x, v, k, b: k * x - b * v),
        ("spring_damper_force", lambda x, v, k, b: 1000 * k * x + b * v),
        ("spring_damper", hl.Scene(force=k * x(n) - b * v(n))),
        ("spring_and_damper", lambda x, v, F: {"k": np.sum(F * x) / np.sum(x * x), "b": np.sum(F * v) / np.sum(v * v)}),
        ("spring_and_damper", lambda x, v, F: dict(zip("bk", np.linalg.lstsq(np.c_[x, v], F, rcond=None)[0], strict=True))),
        ("count_step", lambda m, metres_per_count, T: m * metres_per_count / T),
        ("mass_equation", mass_moves(K * (z - x(t)) + b_c * (z.diff(t) - v(t)))),
        ("mass_equation", mass_moves(K * (x(t) - z) + b_c * (z.diff(t) - v(t)))),
        ("mass_equation", mass_moves(K * (x(t) - z) - b_c * z.diff(t))),
        ("mass_equation", mass_moves(K * (z - x(t)) + b_c * (v(t) - z.diff(t)))),
        ("mass_equation", mass_moves(K * (x(t) + z) + b_c * (v(t) + z.diff(t)))),
        ("mass_equation", mass_moves(K * (x(t) - z) + 2 * b_c * (v(t) - z.diff(t)))),
        ("mass_equation", mass_moves(K * (x(t) - z) + b_c * (v(t) - z.diff(t)) - 9.81 * m)),
        ("mass_on_coupler", on_coupler(1, -1)),
        ("mass_on_coupler", on_coupler(-1, 1)),
        ("mass_on_coupler", on_coupler(1, 1, hl.coordinate("z", unit="m"))),
        ("resonance", lambda m, K, b_c: {"f": np.sqrt(K / m), "zeta": b_c / (2 * np.sqrt(K * m))}),
        ("resonance", lambda m, K, b_c: {
            "f": np.sqrt(K / m - (b_c / m) ** 2 / 4) / (2 * np.pi), "zeta": b_c / (2 * np.sqrt(K * m))}),
        ("thousand", "c"),
    ],
    "02": [
        ("held_work", lambda k, x, D: k * (x + D / 2) * D),
        ("period_leak", lambda k, D: k * D**2),
        ("bounce_gain", lambda k, m, T: np.pi * T * np.sqrt(k / m)),
        ("bounce_gain", lambda k, m, T: 100 * np.pi / 2 * T * np.sqrt(k / m)),
        ("bounce_gain", lambda k, m, T: np.pi / 2 * T * np.sqrt(m / k)),
        ("energy_generated", lambda x, k: -np.sum(k * np.maximum(x, 0)[1:] * np.diff(x))),
        ("energy_generated", lambda x, k: np.sum(k * np.maximum(x, 0)[:-1] * np.diff(x))),
        ("two_walls", hl.Scene(force=hl.when(x(n) >= x_o, k * (x(n) - x_o)))),
        ("two_walls", hl.Scene(force=hl.when(x(n) >= x_o, k * (x(n) - x_o)) + hl.when(x(n) <= -x_o, k * x(n)))),
        ("two_walls", hl.Scene(force=hl.when(x(n) <= x_o, k * (x(n) - x_o)) + hl.when(x(n) >= -x_o, k * (x(n) + x_o)))),
        ("two_walls", hl.Scene(force=hl.when(x(n) < x_o, k * (x(n) - x_o)) + hl.when(x(n) > -x_o, k * (x(n) + x_o)))),
        ("two_walls", hl.Scene(force=hl.when(x(n) >= x_o, k * (x(n) + x_o)) + hl.when(x(n) <= -x_o, k * (x(n) - x_o)))),
        ("damping_that_pays", 0.5),
        ("who_pays", "c"),
    ],
    "03": [
        ("stability_estimate", lambda b, T, delay: b / (T + delay)),
        ("limit_over_delay", lambda b, T: drawn_limit(lambda delay: b / (T + delay))),
        ("limit_over_delay", lambda b, T: drawn_limit(lambda delay: 2 * b / (T / 2 + delay))),
        ("growth_per_sample", lambda m, k, T: 1 + k * T**2 / (2 * m)),
        ("growth_per_sample", lambda m, k, T: 1 + k * T**2 / (4 * m)),
        ("late_wall", hl.Scene(force=hl.when(x(n) >= x_o, k * (x(n - 1) - x_o)))),
        ("chatter_frequency", crossings),
        ("threshold_speed", lambda k, b, T, f_c: 4 * f_c / (np.pi * (k * T - b))),
        ("quantised_limit", lambda b, T, f_c, resolution: 2 * b / T + 2 * f_c / resolution),
        ("culprit", "a"),
    ],
    "04": [
        ("half_sample_wall", hl.wall()),
        ("half_sample_wall", hl.Scene(force=hl.when(x(n) >= x_o, k * (2 * x(n) - x(n - 1) - x_o)))),
        ("half_sample_wall", hl.Scene(force=hl.when(x(n) > x_o, k * (1.5 * x(n) - 0.5 * x(n - 1) - x_o)))),
        ("ellis_wall", hl.Scene(force=hl.when(x(n) >= x_o, k * (1.5 * x(n) - 0.5 * x(n - 1) - x_o)))),
        ("nyquist_damping", lambda taps, k, T: k * T * np.sum(taps) / 2),
        ("stiffest_passive", lambda b, b_added, B, T: max(0, 2 * (b + b_added + B) / T)),
        ("deadbeat_forces", lambda m, T, x, v, x_goal, v_goal: [
            (3 * m * (v - v_goal) / T - 2 * m * (x + 2 * T * v - x_goal) / T**2) / 2,
            (2 * m * (x + 2 * T * v - x_goal) / T**2 - m * (v - v_goal) / T) / 2]),
        ("which_law", "b"),
    ],
    "05": [
        ("period_energy", lambda x, D, K, b, T: {"leak": K * (x + D) ** 2 / 2 - K * x**2 / 2, "loss": b * D**2 / T}),
        ("period_energy", lambda x, D, K, b, T: {"leak": K * D**2 / 2, "loss": b * D**2}),
        ("damper_gives", lambda D, B, T: {"slow": -B * D**2 / T, "alternating": -B * D**2 / T}),
        ("damper_gives", lambda D, B, T: {"slow": -abs(B) * D**2 / T, "alternating": abs(B) * D**2 / T}),
        ("observed_energy", lambda x, F: np.concatenate([[0], np.cumsum(F[1:] * np.diff(x))])),
        ("damping_asked", lambda taps, theta, T: (
            T / 2 * ((1 - np.exp(-1j * theta)) * np.sum(taps * np.exp(1j * theta * np.arange(len(taps))))).real
            / (1 - np.cos(theta)))),
        ("disk_size", lambda K, theta, b, T: K * abs(T / (4 * b) * (1 + 1j / np.tan(theta / 2)))),
        ("controlled_force", lambda f, credit, D, T, alpha_max: (
            f if credit >= 0 or D == 0 else f - min(-credit * T / D**2, alpha_max) * D / T)),
        ("why_it_failed", "c"),
    ],
    "06": [
        ("euler_step", lambda z, w, x, v, m, K, b_c, T: {"z": z + T * w, "w": w + T * (K * (x - z) + b_c * (v - w)) / m}),
        ("pendulum", pendulum(-1, 2 * sp.cos(hl.coordinate("theta", unit="rad", initial=0.3)))),
        ("pendulum", pendulum(1, 0)),
        ("pendulum", pendulum(1, 2 * sp.cos(hl.coordinate("theta", unit="rad", initial=0.3)), hl.coordinate("z", unit="m"))),
        ("coupler_stiffness", lambda b, T, b_c: 2 * b / T),
        ("felt_wall", lambda K, k: K + k),
        ("longest_period", 1.5e-4),
        ("swing_frequency", lambda l, g, M, m, K: np.sqrt(g / l) / (2 * np.pi)),
        ("who_pays", "a"),
    ],
    "07": [
        ("step_matrix", lambda m, K, b, h: [[1, h], [-h * K / m, 1 - h * b / m]]),
        ("euler_growth", lambda m, K, b, h: 1 - h * b / m + h**2 * K / m),
        ("longest_step", lambda m, K, b: 2 * np.sqrt(m / K)),
        ("order_seen", lambda h, error: np.polyfit(np.log(error), np.log(h), 1)[0]),
        ("shortest_period", lambda cycles, rest, load, hz: (cycles + rest) / hz),
        ("why_order_one", "a"),
    ],
    "08": [
        ("penalty_force", lambda gap, rate, k, b: np.where(gap < 0, -k * gap - b * rate, 0.0)),
        ("penalty_force", lambda gap, rate, k, b: np.maximum(0, -k * gap - b * rate)),
        ("stiffest_penalty", lambda m, M, h: m * (np.pi / (10 * h)) ** 2),
        ("impact", lambda v, w, m, M, e: {"v": -e * v, "w": w + (1 + e) * m * v / M, "p": -(1 + e) * m * v}),
        ("pulse_time", lambda p, F_max: 2 * p / F_max),
        ("reaction", lambda a, m, g: {"N": m * (g + a), "gap_acceleration": -g - a}),
        ("largest_multiplier", lambda a, e, g: np.linalg.det(
            [[1, (1 + e) / g], [(1 + e) * a, (1 + e) ** 2 * a / g + e**2]])),
        ("two_springs", "a"),
    ],
    "09": [
        ("coasting_speed", turned_back),
        ("coast_fit", lambda t, x: dict(zip(("b/m", "coulomb/m"), -np.polyfit(
            np.gradient(x, t), np.gradient(np.gradient(x, t), t), 1), strict=True))),
        ("mass_and_friction", lambda A, rising, falling: {"m": A / rising, "coulomb": A * (rising - falling) / 2}),
        ("promised_stiffness", lambda b_low, b_high, T, B: 2 * (b_high - abs(B)) / T),
        ("promised_stiffness", lambda b_low, b_high, T, B: 2 * b_low / T),
        ("hand_constants", lambda M, sigma, omega, m, b: {"m": M, "b": 2 * M * sigma, "k": M * (omega**2 + sigma**2)}),
        ("what_95_means", "a"),
        ("which_window", "b"),
    ],
    "10": [
        ("part_right", lambda k_1, k_2, weber: NormalDist().cdf(abs(log(k_2 / k_1)) / log(1 + weber))),
        ("part_right", lambda k_1, k_2, weber: NormalDist().cdf(abs(k_2 - k_1) / (k_1 * weber) / 2**0.5)),
        ("staircase", one_down),
        ("converges_to", lambda down, weight: weight / (1 + weight)),
        ("log_likelihood", by_ten),
        ("at_d_prime_1", lambda level, part: level / NormalDist().inv_cdf(part)),
        ("steps_between", lambda k_low, k_high, weber: (k_high - k_low) / (weber * k_low)),
        ("standard_first", "a"),
    ],
}  # fmt: skip

_SQUARED = "1000000 times too large. Was a value in millimetres or milliseconds squared?"
_OR_T = "In this case T = 0.001, so a factor T may also be missing"
#: (exercise, answer, sentence): slips that are not of one lab, so that hapticlab has the sentence
ANYWHERE = {
    "02": [
        ("held_work", lambda k, x, D: k * 1e3 * x * 1e3 * D, _SQUARED),
        ("period_leak", lambda k, D: k * (1e3 * D) ** 2 / 2, _SQUARED),
        ("bounce_gain", lambda k, m, T: np.pi / 2 * np.sqrt(k / m), _OR_T),
    ],
}
