"""Wrong answers as students write them: each earns nothing, and the lab has a sentence for it."""

from math import log, log10
from statistics import NormalDist


def one_down(answers, start, factor):
    levels = [start]
    for right in answers[:-1]:
        levels.append(levels[-1] / factor if right else levels[-1] * factor)
    return levels


def by_ten(threshold, levels, right):
    P = [NormalDist().cdf(level / (2**0.5 * threshold)) for level in levels]
    return sum(log10(p if r else 1 - p) for p, r in zip(P, right, strict=True))


WRONG = [
    ("part_right", lambda k_1, k_2, weber: NormalDist().cdf(abs(log(k_2 / k_1)) / log(1 + weber))),
    ("part_right", lambda k_1, k_2, weber: NormalDist().cdf(abs(k_2 - k_1) / (k_1 * weber) / 2**0.5)),
    ("part_right", lambda k_1, k_2, weber: NormalDist().cdf(log(k_2 / k_1) / log(1 + weber) / 2**0.5)),
    ("staircase", one_down),
    ("converges_to", lambda down, weight: weight / (1 + weight)),
    ("converges_to", lambda down, weight: (1 / (1 + weight)) ** (1 / down)),
    ("log_likelihood", by_ten),
    ("at_d_prime_1", lambda level, part: level / NormalDist().inv_cdf(part)),
    ("steps_between", lambda k_low, k_high, weber: (k_high - k_low) / (weber * k_low)),
    ("standard_first", "a"),
]  # fmt: skip
