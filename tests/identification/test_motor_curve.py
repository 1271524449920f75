"""A motor's dead band and curve: against curves that were put in, with noise of a scale; what tells nothing is refused."""

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.errors import AnalysisError

MOTORS = {
    "dead band": ((0.1, 0.2, 0.45, 0.7), 4.0, 21),
    "none": ((0.0, 0.25, 0.5, 0.75), 8.0, 11),
    "bent": ((0.05, 0.3, 0.55, 0.8), 3.0, 13),
}


def readings(knots, full, number, *, noise=0.01, offset=0.03, seed=0, up_to=1.0):
    duties = np.linspace(0, up_to, number)
    forces = full * np.interp(duties, [*knots, 1.0], [0, 0.25, 0.5, 0.75, 1.0])
    return duties, forces + offset + noise * np.random.default_rng(seed).standard_normal(number)


@pytest.mark.parametrize("name", MOTORS)
@pytest.mark.always("dead band")
def test_intervals_hold_what_was_put_in(name):
    """30 draws: each interval of 95 % holds the truth in at least 25 of them."""
    knots, full, number = MOTORS[name]
    truth = dict(zip(("force_full", "duty_dead", "duty_25", "duty_50", "duty_75", "offset"), (full, *knots, 0.03), strict=True))
    found = [hl.identify.motor(*readings(knots, full, number, seed=seed)) for seed in range(30)]
    for key, value in truth.items():
        assert sum(value in one[key] for one in found) >= 25, key
    assert np.median([one["duty_50"].half_width for one in found]) < 0.02
    assert found[0].rms < 0.02 and "residual" in str(found[0])


def test_order_does_not_matter_and_the_curve_comes_back():
    duties, forces = readings((0.1, 0.2, 0.45, 0.7), 4.0, 21, noise=0.0)
    shuffled = np.random.default_rng(1).permutation(21)
    found = hl.identify.motor(duties[shuffled], forces[shuffled])
    assert found.force([0.05, 0.1, 0.2, 0.45, 0.7, 1.0]) == pytest.approx([0, 0, 1, 2, 3, 4], abs=1e-6)
    assert found.plot().axes[0].get_xlabel() == "part of full duty [1]"
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, compensated=False, **found.values())
    assert (paddle.duty_25, paddle.force_full) == (pytest.approx(0.2), pytest.approx(4.0))


GOOD = readings((0.1, 0.2, 0.45, 0.7), 4.0, 21)


@pytest.mark.parametrize(("duties", "forces", "words"), [
    (GOOD[0][:8], GOOD[1][:8], "8 different duties up to 0.35; needs 9 or more, up to 0.8"),
    (*readings((0.1, 0.2, 0.45, 0.7), 4.0, 21, up_to=0.7), "21 different duties up to 0.7; needs"),
    (GOOD[0][:9], GOOD[1][:8], "needs one force for each duty"),
    (GOOD[0] * 100, GOOD[1], "needs duties from 0 to 1"),
    (GOOD[0], -GOOD[1], "the force does not grow with the duty"),
    (GOOD[0][4:], GOOD[1][4:], "no reading (without a force|between)"),
    (GOOD[0], GOOD[1] + 0.8 * np.sin(40 * GOOD[0]), "the readings lie|does not grow|no reading"),
])  # fmt: skip
def test_what_tells_no_curve_is_refused(duties, forces, words):
    with pytest.raises(AnalysisError, match=words):
        hl.identify.motor(duties, forces)
