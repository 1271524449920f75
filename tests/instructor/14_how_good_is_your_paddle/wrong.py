"""Wrong answers as students write them: each earns nothing, and the lab has a sentence for it."""

from math import cos, pi, radians, sin, sqrt

import numpy as np


def least_noise(lag, noise, cycles, B, felt, most_cycles):
    able = (sqrt(2) * B * np.array(noise) <= felt) & (np.array(cycles) <= most_cycles)
    return int(np.argmin(np.where(able, noise, np.inf))) if able.any() else -1


def rms_felt(lag, noise, cycles, B, felt, most_cycles):
    able = (B * np.array(noise) <= felt) & (np.array(cycles) <= most_cycles)
    return int(np.argmin(np.where(able, lag, np.inf))) if able.any() else -1


def any_cost(lag, noise, cycles, B, felt, most_cycles):
    able = sqrt(2) * B * np.array(noise) <= felt
    return int(np.argmin(np.where(able, lag, np.inf))) if able.any() else -1


def in_the_rest(lag, noise, cycles, B, felt, most_cycles):
    able = (sqrt(2) * B * np.array(noise) <= felt) & (np.array(cycles) <= most_cycles)
    return int(np.argmin(np.array(lag)[able])) if able.any() else -1


def last_inside(f, off, weber):
    inside = np.flatnonzero(np.array(off) <= weber)
    return float(f[inside[-1]]) if len(inside) else 0.0


def first_outside(f, off, weber):
    outside = np.flatnonzero(np.array(off) > weber)
    return float(f[outside[0]]) if len(outside) else float(f[-1])


WRONG = [
    ("buzz_border", lambda count, felt: felt / count),
    ("buzz_border", lambda count, felt: 2 * felt / count),
    ("buzz_border", lambda count, felt: felt / (sqrt(2) * count)),
    ("border", lambda b, B, late, f, gain, lag: (b + B * gain) / late),
    ("border", lambda b, B, late, f, gain, lag: (b + B * gain * cos(f * lag)) / late),
    ("border", lambda b, B, late, f, gain, lag: (b + B * gain * sin(2 * pi * f * lag)) / late),
    ("border", lambda b, B, late, f, gain, lag: 2 * (b + B * gain * cos(2 * pi * f * lag)) / late),
    ("border", lambda b, B, late, f, gain, lag: (b + B * gain * cos(radians(2 * pi * f * lag))) / late),
    ("choose", least_noise),
    ("choose", rms_felt),
    ("choose", any_cost),
    ("choose", in_the_rest),
    ("when_a_filter_helps", "a"),
    ("when_a_filter_helps", "c"),
    ("effective", lambda f, real, imaginary: {"stiffness": 2 * np.pi * f * imaginary, "damping": real}),
    ("effective", lambda f, real, imaginary: {"stiffness": -f * imaginary, "damping": real}),
    ("effective", lambda f, real, imaginary: {"stiffness": 2 * np.pi * f * abs(real + 1j * imaginary), "damping": real}),
    ("same_up_to", last_inside),
    ("same_up_to", first_outside),
    ("same_damping", lambda b, B, late, weber: (b + B) / late),
    ("same_damping", lambda b, B, late, weber: weber * b / late),
    ("same_damping", lambda b, B, late, weber: (1 - weber) * (b + B) / late),
]  # fmt: skip
