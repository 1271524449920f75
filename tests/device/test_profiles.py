"""Profiles are marked as what they are, and the ETH constants follow from the published ones."""

import pytest

from hapticlab.device.profiles import eth, hapkit, profile
from hapticlab.device.simulated.simulated_paddle import SimulatedPaddle
from hapticlab.errors import PaddleError


def test_eth_from_its_published_inertias():
    """J = J_p + (r_p/r_m)^2 J_m and B = (r_p/r_m)^2 B_m at the pivot, over the handle radius squared."""
    ratio, handle = 75 / 4.3, 0.065
    assert eth.m == pytest.approx((2.2e-4 + ratio**2 * 1.58e-6) / handle**2, rel=5e-3)
    assert eth.b == pytest.approx(ratio**2 * 7.9e-7 / handle**2, rel=5e-3)


def test_hapkit_count():
    """920 counts per 180 degrees of motor over the published radii are about 12.8 um at the handle."""
    per_count = 3.14159265 / 920 * 0.004191 / 0.073152 * 0.065659
    assert 1 / hapkit.counts_per_metre == pytest.approx(per_count, rel=5e-3)


@pytest.mark.parametrize("name", ["eth", "hapkit"])
def test_paddle_says_where_its_constants_come_from(name):
    text = str(SimulatedPaddle.from_profile(name))
    assert f"from paddle {name}" in text and "nominal, not measured on this device" in text
    assert profile(name).source in text


def test_changes_and_unknown_names():
    paddle = SimulatedPaddle.from_profile(hapkit, T=5e-4, coulomb=0.1)
    assert (paddle.m, paddle.T, paddle.coulomb, paddle.force_max) == (hapkit.m, 5e-4, 0.1, hapkit.force_max)
    with pytest.raises(PaddleError, match="mass is not an argument of SimulatedPaddle"):
        SimulatedPaddle.from_profile(eth, mass=1)
    with pytest.raises(PaddleError, match="no profile 'falcon'; there are hapkit, eth"):
        profile("falcon")
