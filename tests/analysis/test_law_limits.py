"""The stiffest wall of a law that a push finds, against the closed forms of the linear loop, which a held push keeps."""

import math

import pytest

import hapticlab as hl
from hapticlab.errors import AnalysisError

PADDLE = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3)


@pytest.fixture(scope="module")
def found():
    return hl.law_limits(PADDLE, laws=["zoh", "predictive"], first=120.0, most=500.0)


def test_a_pushed_handle_finds_the_linear_limits(found):
    """2b/T for little damping, within the 3 % of the search and of decays too slow to tell."""
    assert found["zoh"].K == pytest.approx(2 * 0.1 / 1e-3, rel=0.04)
    assert found["zoh"].K < found["zoh"].beyond <= 1.03 * found["zoh"].K
    assert found["predictive"].K > 400 and found["predictive"].beyond == math.inf


@pytest.mark.slow
def test_a_predictor_s_limit_too():
    """2 sqrt(bm/T^3) for little damping."""
    found = hl.law_limits(PADDLE, laws=["backward_difference"], first=2000.0)
    assert found["backward_difference"].K == pytest.approx(2 * math.sqrt(0.1 * 0.05 / 1e-9), rel=0.05)


def test_it_prints_and_draws(found):
    assert "under a push of 1 N" in str(found) and "Hz" in found["zoh"].why
    (axes,) = found.plot().axes
    assert axes.get_xscale() == "log" and axes.get_xlabel() == "stiffest wall that stands [N/m]"
    with pytest.raises(AnalysisError, match="no limit of 'ellis'; there are zoh"):
        found["ellis"]
