"""The records of the chapter's spring laws: each is its name wherever a law is asked for, and says what it is."""

import inspect
import json
import pickle

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.scene.laws.taps import SPRING_LAWS
from hapticlab.scene.notation.amount import number_of

RECORDS = [hl.laws.SampledSpring, hl.laws.HalfSampleSpring, hl.laws.BackwardDifferenceSpring, hl.laws.EllisSpring]
DEVICE = hl.Device(m=0.05, b=0.1, T=1e-3)


@pytest.mark.parametrize("law", RECORDS, ids=list(SPRING_LAWS))
def test_a_record_is_its_name_and_says_what_it_is(law):
    name = json.loads(json.dumps(law))
    assert law == name and f"{law}" == name and pickle.loads(pickle.dumps(law)) is law
    assert hl.wall(law) == hl.wall(name) and hl.wall(law).name == f"{name} wall"
    assert hl.stability_limit(DEVICE, law=law).K == hl.stability_limit(DEVICE, law=name).K
    assert hl.passivity_limit(DEVICE, law=law).K == hl.passivity_limit(DEVICE, law=name).K
    for fact in ("Eq. (23.", "  force ", "  order ", "  cost ", "  source ", "  not to be confused with "):
        assert fact in str(law)
    assert repr(law).startswith(f"SpringLaw({name}: ") and "\n" not in repr(law)
    assert name in inspect.getdoc(law)


def test_every_law_has_the_gain_k_at_rest():
    assert [sum(law.taps) for law in RECORDS] == [1.0] * 4


@pytest.mark.parametrize(
    "estimate",
    [hl.velocity.backward(), hl.velocity.filtered(tau="4 ms"), hl.velocity.kalman(acceleration=50, noise="10 um")],
    ids=lambda estimate: estimate.name,
)
def test_the_lag_of_an_estimate_is_that_of_its_transfer_function(estimate):
    """The phase beside that of a differentiator, over the frequency: the delay of slow motion."""
    T, w = 1e-3, 1.0
    z = np.exp(1j * w * T)
    over, under = (sum(c * z**-k for k, c in enumerate(part)) for part in estimate.transfer(T))
    lag = number_of(estimate.lag.subs(hl.T, T))
    assert -np.angle(over / under / (1j * w)) / w == pytest.approx(lag, rel=1e-4)
    assert estimate.source and estimate.confused_with and "  lag " in str(estimate)
