"""Cutting a coast or a throw out of a recording: against a motion that is known in closed form."""

from dataclasses import replace

import numpy as np
import pytest

import hapticlab as hl

M, B, COULOMB, T, COUNT = 0.03, 0.15, 0.05, 1e-3, 12.8e-6


def coast(v=0.4, samples=400):
    """Position of a handle that coasts from a speed until friction holds it, by hand."""
    t, heads_for = np.arange(samples) * T, -COULOMB / B
    stops = M / B * np.log(1 + v * B / COULOMB)
    t = np.minimum(t, stops)
    return heads_for * t + (v - heads_for) * M / B * (1 - np.exp(-B / M * t))


def log_of(x, **channels):
    x = np.floor(x / COUNT) * COUNT
    return hl.records.Telemetry(t=np.arange(len(x)) * T, x=x, v=0 * x, F=0 * x, T=T, channels=channels)


def test_a_flick_by_hand_in_either_direction_gives_the_ratios():
    pushed = 0.4 * np.arange(1, 60) ** 2 / 60 * T / 2  # faster and faster up to 0.4 m/s
    for sign in (1, -1):
        found = hl.identify.coasting(log_of(sign * np.r_[np.zeros(200), pushed, pushed[-1] + coast()]))
        assert found.t[0] == found.x[0] == 0
        assert found.x.max() == pytest.approx(coast()[-1], abs=0.4 * 12 * T)
        fit = hl.identify.spin_down(found, counts_per_metre=1 / COUNT)
        assert B / M in fit["b/m"] and COULOMB / M in fit["coulomb/m"]


def test_a_fit_that_did_not_converge_says_what_its_intervals_are_worth():
    found = hl.identify.spin_down(hl.identify.coasting(log_of(coast())), m=M, counts_per_metre=1 / COUNT, confidence=0.9)
    assert "NOT CONVERGED" not in str(found)
    said = str(replace(found, converged=False))
    assert "NOT CONVERGED: a small change would fit better" in said and "the true value less often than 90%. Record" in said


def test_of_a_view_only_the_longest_part_without_a_hand_counts():
    x, nan = coast(), np.full(400, np.nan)
    held = 0.02 * np.sin(np.arange(600) * 0.05)  # faster than any coast
    intent = np.r_[np.zeros(600), nan, np.zeros(600), nan[:50]]
    found = hl.identify.coasting(log_of(np.r_[held, x, held, x[:50]], intent=intent))
    assert len(found) == 400 - 5 and found.x.max() == pytest.approx(x[-1] - x[5], abs=2 * COUNT)


@pytest.mark.parametrize(
    ("log", "words"),
    [
        (None, "nothing was recorded yet"),
        (log_of(np.zeros(400), intent=np.zeros(400)), "held throughout"),
        (log_of(np.zeros(400)), "0 mm in 0 samples"),
        (log_of(coast(samples=5)), "5 samples without a hand"),
    ],
)
def test_a_recording_without_a_coast_says_what_to_do(log, words):
    with pytest.raises(hl.errors.AnalysisError, match=words) as refusal:
        hl.identify.coasting(log)
    assert "release it while it moves" in str(refusal.value)


@pytest.mark.parametrize("finger", [600, 3000])
def test_a_throw_by_hand_gives_the_mass(finger):
    """A finger [N/m] that can only push throws, lets go and catches; m, b and friction are known, no code is shared."""
    A, h = 0.15, 1e-4
    x, v, seen = 0.0, 0.0, []
    for i in range(20000):
        s = min(max((i * h - 0.5) / 0.08, 0.0), 1.0)
        place = 0.016 * (10 * s**3 - 15 * s**4 + 6 * s**5)
        caught = max(0.0, finger / 3 * (0.004 - x) - 3 * v) if x < 0.004 else 0.0
        push = caught if s == 1 else max(0.0, finger * (place - x))
        if s > 0:
            v += h * (push - A - B * v - COULOMB * np.sign(v)) / M
            x += h * v
        if i % 10 == 0:
            seen.append(x)
    rising, falling = (_slope(part) for part in hl.identify.throw(log_of(np.array(seen))))
    assert 2 * A / (rising + falling) == pytest.approx(M, rel=0.01)  # counts leave 0.3 % over flights of 37 to 105 ms
    assert (rising - falling) / 2 == pytest.approx(COULOMB / M, rel=0.03)


def _slope(part):
    """Acceleration of x + b/m integral of x, downwards: a parabola's."""
    area = np.concatenate([[0], np.cumsum((part.x[1:] + part.x[:-1]) / 2) * T])
    return -2 * np.polyfit(part.t - part.t[0], part.x + B / M * area, 2)[0]


def test_a_handle_that_only_rises_was_not_thrown():
    with pytest.raises(hl.errors.AnalysisError, match="0 of fall; needs 15 of each"):
        hl.identify.throw(log_of(coast()))


def test_intervals_that_miss_the_true_value_are_counted_and_a_wide_one_does_not_set_the_axis():
    figure = hl.identify.plot_intervals({"a": (4, 6), "b": (5.1, 7), "wide": (-90, 100)}, label="b/m [1/s]", true=5.0)
    assert "1 of 3 miss the true value 5" in figure.alt
    low, high = figure.axes[0].get_xlim()
    assert 3 < low < 4 and 7 < high < 8
