"""The stiffest wall of a law that a push finds, against the closed forms of the linear loop, which a held push keeps."""

import math
from dataclasses import replace

import pytest

import hapticlab as hl
from hapticlab.errors import AnalysisError, HapticlabError

PADDLE = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3)


@pytest.fixture(scope="module")
def found():
    return hl.design.law_limits(PADDLE, laws=["zoh", "predictive"], first=120.0, most=500.0)


def test_a_pushed_handle_finds_the_linear_limits(found):
    """2b/T for little damping, within the 3 % of the search and of decays too slow to tell."""
    assert found["zoh"].K == pytest.approx(2 * 0.1 / 1e-3, rel=0.04)
    assert found["zoh"].K < found["zoh"].beyond <= 1.03 * found["zoh"].K
    assert found["predictive"].K > 400 and found["predictive"].beyond == math.inf


@pytest.mark.slow
def test_a_predictor_s_limit_too():
    """2 sqrt(bm/T^3) for little damping."""
    found = hl.design.law_limits(PADDLE, laws=["backward_difference"], first=2000.0)
    assert found["backward_difference"].K == pytest.approx(2 * math.sqrt(0.1 * 0.05 / 1e-9), rel=0.05)


def test_it_prints_and_draws(found):
    assert "under a push of 1 N" in str(found) and "Hz" in found["zoh"].why
    (axes,) = found.plot().axes
    assert axes.get_xscale() == "log" and axes.get_xlabel() == "stiffest wall that does not chatter [N/m]"
    with pytest.raises(AnalysisError, match="no limit of 'ellis'; there are zoh"):
        found["ellis"]


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"push": 0}, "push = 0 N; law_limits needs push > 0"),
        ({"push": -1.0}, "law_limits needs push > 0"),
        ({"laws": ["zohh"]}, r"laws = \['zohh'\]; needs one or more of zoh"),
        ({"laws": []}, "needs one or more of zoh"),
        ({"first": 0}, "first = 0.0 N/m.*needs 0 < first <= most"),
        ({"first": 10.0, "most": 5.0}, "needs 0 < first <= most"),
        ({"duration": 0.01}, "duration = 0.01 s is 10 samples; needs at least 32"),
        ({"push": 0.2, "force_max": 0.1}, "no wall can resist the push. Give a smaller push"),
    ],
)
def test_it_refuses_what_no_trial_can_answer(given, words):
    given = dict(given)
    paddle = replace(PADDLE, force_max=given.pop("force_max", None))
    with pytest.raises(HapticlabError, match=words):
        hl.design.law_limits(paddle, **given)


def test_it_goes_softer_than_a_first_wall_that_does_not_stand():
    """The exact limit is 200.07 N/m; a name alone is one law."""
    pytest.importorskip("llvmlite")  # some minutes at the interpreter
    found = hl.design.law_limits(PADDLE, laws="zoh", first=1000.0)["zoh"]
    assert found.K == pytest.approx(200.07, rel=0.04)


def test_a_decay_that_the_motor_clips_is_followed_until_it_is_linear():
    """Clipped, 285 N/m decays from 0.2 N onto a cycle that stays; linear it stands to 200.07 N/m."""
    pytest.importorskip("llvmlite")  # some minutes at the interpreter
    found = hl.design.law_limits(replace(PADDLE, force_max=0.25), laws="zoh", push=0.2)["zoh"]
    assert found.K == pytest.approx(200.07, rel=0.04)


def test_what_neither_dies_out_nor_grows_is_not_told():
    """Without any damping Eq. (23.3) is neutral: no stiffness stands, and none is unstable, below 4 m/T^2 = 2e5 N/m."""
    pytest.importorskip("llvmlite")  # some minutes at the interpreter
    found = hl.design.law_limits(replace(PADDLE, b=0.0), laws="half_sample")
    assert math.isnan(found["half_sample"].K) and "neither dies out nor grows" in str(found)
    assert found.plot().axes
