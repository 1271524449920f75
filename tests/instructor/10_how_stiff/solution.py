"""Answers of lab 10."""

from math import log
from statistics import NormalDist

import numpy as np

prediction_weber = 20
prediction_trials = 100
prediction_walls = 10


def part_right(k_1, k_2, weber):
    """Return the proportion of trials in which the stiffer wall is picked: two presentations, so twice the variance."""
    d_prime = abs(log(k_2 / k_1)) / log(1 + weber)
    return NormalDist().cdf(d_prime / 2**0.5)


def staircase(answers, start, factor):
    """Return the level at which each answer was given."""
    levels, level, row = [], start, 0
    for right in answers:
        levels.append(level)
        row = row + 1 if right else 0
        if not right:
            level *= factor
        elif row == 2:
            level, row = level / factor, 0
    return np.array(levels)


def converges_to(down, weight):
    """Return the proportion of right answers at which steps down and up cancel."""
    return (weight / (1 + weight)) ** (1 / down)


def log_likelihood(threshold, levels, right):
    """Return the log-likelihood of all answers."""
    P = np.array([NormalDist().cdf(level / (2**0.5 * threshold)) for level in levels])
    return float(np.sum(np.log(np.where(np.array(right) > 0.5, P, 1 - P))))


def at_d_prime_1(level, part):
    """Return the level at d' = 1: at the given level, d' is sqrt(2) times the normal quantile of the proportion."""
    return level / (2**0.5 * NormalDist().inv_cdf(part))


standard_first = "d"


def steps_between(k_low, k_high, weber):
    """Return how many factors of 1 + weber lie between the two."""
    return log(k_high / k_low) / log(1 + weber)


discussion = (
    "My interval reaches from 15 to 31 percent and contains 23 percent, so forty trials give me no reason to call my hand "
    "different; forty trials would not have shown a hand of half the Weber fraction either. I think that I used how far the "
    "wall gave way. To find out, I would stop each press at a depth drawn by chance, or ask for the same force each time, so "
    "that one cue becomes useless, and see whether my threshold grows. Before the experiment I would tell the observers what "
    "the motor can do and how long it takes, and that they may let go, rest or leave at any time without giving a reason."
)
