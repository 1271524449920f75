"""Psychometric functions against integrals of signal detection theory and finite differences."""

import math

import numpy as np
import pytest

from hapticlab.errors import AnalysisError
from hapticlab.experiments.response_curves import SHAPES, Psychometric, rise


def two_alternatives(d_prime):
    """P(right) in two alternatives: the signal's sample is the larger one; the integral of phi(z - d') Phi(z)."""
    z = np.linspace(-12, 12 + d_prime, 20001)
    cdf = np.array([0.5 * math.erfc(-a / math.sqrt(2)) for a in z])
    f = np.exp(-((z - d_prime) ** 2) / 2) / math.sqrt(2 * math.pi) * cdf
    return float(np.sum((f[1:] + f[:-1]) / 2 * np.diff(z)))


@pytest.mark.parametrize("level", [0.05, 0.2, 0.33, 0.9])
def test_d_prime_is_two_alternatives_of_signal_detection_theory(level):
    curve = Psychometric(threshold=0.2, slope=1.3)
    assert float(curve(level)) == pytest.approx(two_alternatives((level / 0.2) ** 1.3), abs=1e-9)


def test_guess_and_lapse_are_the_ends():
    curve = Psychometric(threshold=0.2, slope=2.0, guess=0.25, lapse=0.04, shape="weibull")
    assert float(curve(0.0)) == 0.25
    assert float(curve(20.0)) == pytest.approx(0.96, abs=1e-12)
    assert float(curve(0.2)) == pytest.approx(0.25 + 0.71 * (1 - math.exp(-1)), abs=1e-12)


@pytest.mark.parametrize("shape", SHAPES)
def test_derivatives_are_those_of_the_curve(shape):
    levels, h = np.array([0.0, 0.03, 0.2, 0.7]), 1e-6
    place, log_slope = (0.3, 0.8) if shape == "normal" else (math.log(0.25), 0.4)
    _, along, steeper = rise(shape, levels, place, log_slope)
    moved = [rise(shape, levels, place + s * h, log_slope)[0] for s in (1, -1)]
    turned = [rise(shape, levels, place, log_slope + s * h)[0] for s in (1, -1)]
    np.testing.assert_allclose(along, (moved[0] - moved[1]) / (2 * h), atol=1e-9)
    np.testing.assert_allclose(steeper, (turned[0] - turned[1]) / (2 * h), atol=1e-9)


def test_what_is_no_curve_is_refused():
    with pytest.raises(AnalysisError, match="d_prime, weibull, normal"):
        Psychometric(0.2, 1.0, shape="probit")
    with pytest.raises(AnalysisError, match="both positive"):
        Psychometric(-0.2, 1.0)
    with pytest.raises(AnalysisError, match="guess \\+ lapse < 1"):
        Psychometric(0.2, 1.0, 0.9, 0.2)
