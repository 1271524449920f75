"""The lag of a handle in a light grip, with friction and an encoder, against the delay that it was simulated with."""

import numpy as np
import pytest

from hapticlab.device.bring_up.lag import fit_lag
from hapticlab.device.hand.hand import Hand
from hapticlab.device.simulated.moved_handle import Handle
from hapticlab.device.simulated.simulated_paddle import SimulatedPaddle

T, LASTS = 1e-3, 60


def tugged(sign=1, **constants):
    """Positions under a square wave of 0.4 N, as an encoder of 12.8 um shows them, and the changes of the force."""
    mechanics = SimulatedPaddle(T=T, counts_per_metre=1 / 12.8e-6, hand=Hand(m=0.01, b=0.3, k=15), **constants)
    handle, x = Handle(mechanics), []
    force = [0.4 * (-1) ** ((k + LASTS // 2) // LASTS) for k in range(1500)]
    for f in force:
        x.append(handle.counts() * 12.8e-6)
        handle.step(sign * f)
    changes = [(k * T, f) for k, (f, before) in enumerate(zip(force, [0.0, *force], strict=False)) if f != before]
    return np.arange(len(x)) * T, np.array(x), changes


@pytest.mark.always("0.05-0.0023")
@pytest.mark.parametrize("delay", [0.0, 0.21e-3, 2.3e-3])
@pytest.mark.parametrize("coulomb", [0.0, 0.05])
def test_the_delay_is_found_to_a_tenth_of_a_period(delay, coulomb):
    found = fit_lag(*tugged(m=0.04, b=0.1, coulomb=coulomb, delay=delay))
    assert found.lag == pytest.approx(delay, abs=1e-4)
    assert found.mass == pytest.approx(0.05, rel=0.1)
    assert found.spread < 1e-4


def test_a_motor_with_the_wrong_sign_feels_like_a_negative_mass():
    assert fit_lag(*tugged(sign=-1, m=0.04, b=0.1)).mass < 0
