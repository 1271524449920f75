"""Energy at the port against areas worked out by hand from Fig. 23.6."""

import math

import numpy as np
import pytest

from hapticlab.analysis.records.energy import energy
from hapticlab.base.telemetry import Telemetry
from hapticlab.errors import AnalysisError

K, T, v = 450.0, 1e-3, 0.31


def in_and_out(inside, offset):
    """Move at v into a wall at 0 and out again, turning at a sample; offset is how far, in steps, the first lies outside."""
    steps = np.r_[np.arange(-3, inside), np.arange(inside, -4, -1)]
    return v * T * (steps + offset)


def record(x, F, delay=0.0, **channels):
    return Telemetry(t=np.arange(len(x)) * T, x=x, v=0 * x, F=F, T=T, delay=delay, channels=channels)


@pytest.mark.parametrize("inside, offset", [(7, 0.35), (12, 0.0), (1, 0.8)])
def test_a_uniform_push_leaks_the_area_between_the_staircases(inside, offset):
    """In and out staircases lie one step v T apart over the depth x_max: K (v T) x_max, whatever the phase."""
    x = in_and_out(inside, offset)
    found = energy(record(x, np.maximum(K * x, 0)))
    assert found.generated == pytest.approx(K * v * T * x.max(), abs=1e-12)
    assert found.contacts == 1 and found.exact and found.absorbed == -found.generated
    assert found.extracted >= found.generated - 1e-15


def test_pairing_with_the_previous_displacement_would_call_it_dissipation():
    x = in_and_out(9, 0.4)
    F = np.maximum(K * x, 0)
    wrong = -float(F[1:] @ np.diff(x))
    assert wrong == pytest.approx(-K * v * T * x.max(), abs=1e-12)
    assert energy(record(x, F)).generated == pytest.approx(-wrong, abs=1e-12)


@pytest.mark.parametrize("whole", [1, 3])
def test_each_sample_of_delay_leaks_two_steps_more(whole):
    """A delay of d samples sets the staircases 1 + 2 d steps apart over the depth, rounded off at the turn."""
    x = np.r_[in_and_out(11, 0.25), v * T * (0.25 - np.arange(4, 12))]
    F = np.maximum(K * x, 0)
    held = np.r_[np.zeros(whole), F[:-whole]]
    expected = -sum(held[n] * (x[n + 1] - x[n]) for n in range(len(x) - 1))
    for log in (record(x, F, whole * T), record(x, F, whole * T, F_applied=held)):
        assert energy(log).generated == pytest.approx(expected, abs=1e-13)
    depth = x.max()
    # around the turn, d samples of force from before it act on the way out: (1 + 2 d) steps less a triangle of d (d + 1) steps
    assert expected == pytest.approx(K * v * T * ((1 + 2 * whole) * depth - whole * (whole + 1) * v * T), abs=1e-12)


def test_a_fraction_of_delay_uses_the_position_at_the_switch():
    f = 0.3
    t = np.arange(46) * T
    position = lambda s: 2e-3 * np.sin(2 * np.pi * 12.7 * s)  # noqa: E731
    x, switch = position(t), position(t + f * T)
    F = np.maximum(K * x, 0)
    W = [0.0]
    for n in range(len(x) - 1):
        before = F[n - 1] if n else 0.0
        W.append(W[-1] + before * (switch[n] - x[n]) + F[n] * (x[n + 1] - switch[n]))
    found = energy(record(x, F, f * T, x_switch=switch))
    np.testing.assert_allclose(found.W, W, atol=1e-15)
    assert found.exact
    interpolated = energy(record(x, F, f * T))
    assert not interpolated.exact and "interpolated" in str(interpolated)
    assert interpolated.W[-1] == pytest.approx(found.W[-1], rel=1e-2)


def test_true_position_is_used_where_the_encoder_hid_it():
    x = in_and_out(7, 0.35)
    sensed = np.floor(x / 1e-4) * 1e-4
    F = np.maximum(K * sensed, 0)
    expected = -float(F[:-1] @ np.diff(x))
    assert energy(record(sensed, F, x_true=x)).generated == pytest.approx(expected, abs=1e-15)


@pytest.mark.parametrize("phase", [0.1, 0.5, 0.9])
def test_one_bounce_speeds_the_handle_up_by_the_hold(phase):
    """Without damping one bounce multiplies the speed by about exp(pi w T/4), w = sqrt(K/m)."""
    m, x, speed, positions = 0.05, -phase * v * T, v, []
    for _ in range(200):
        positions.append(x)
        force = max(K * x, 0.0)
        x, speed = x + speed * T - force * T**2 / (2 * m), speed - force * T / m
    x = np.array(positions)
    found = energy(record(x, np.maximum(K * x, 0)))
    ratio = math.sqrt(1 + found.generated / (m * v**2 / 2))
    assert ratio == pytest.approx(abs(speed) / v, rel=1e-12)  # the handle's own kinetic energy, to the last joule
    assert ratio == pytest.approx(math.exp(math.pi * math.sqrt(K / m) * T / 4), rel=0.03)  # phase scatters a few percent


def test_a_handle_still_inside_has_completed_nothing():
    x = np.linspace(0, 1e-2, 50)
    found = energy(record(x, K * x))
    assert math.isnan(found.generated) and found.contacts == 0 and found.extracted == 0
    assert found.W[-1] == pytest.approx(K * (1e-2**2) / 2, rel=0.03)  # the staircase lies below K x^2/2
    assert "no completed penetration" in str(found)


def test_words():
    x = in_and_out(7, 0.35)
    assert str(energy(record(x, np.maximum(K * x, 0)))).startswith("1 penetration generated 0.3")
    with pytest.raises(AnalysisError, match="energy needs at least 2"):
        energy(record(np.zeros(1), np.zeros(1)))


def test_a_wrong_guess_names_the_right_one():
    x = in_and_out(7, 0.35)
    found = energy(record(x, np.maximum(K * x, 0)))
    for tried, meant in (("dissipated", "absorbed"), ("work", "W"), ("peak", "extracted"), ("absorb", "absorbed")):
        with pytest.raises(AttributeError, match=f"Energy has no {tried}; take .{meant}; it has W, absorbed, contacts"):
            getattr(found, tried)
