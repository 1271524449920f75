"""Four paddles of each kind: nominal as it was, and three that differ in what their name says."""

from dataclasses import fields

import pytest

import hapticlab as hl
from hapticlab.device.profiles import PROFILES
from hapticlab.device.variants import TYPICAL

CHANGES = {
    "rough": {"coulomb", "delay", "sensor_delay"},
    "coarse": {"counts_per_metre", "drive"},
    "slow": {"T", "delay"},
}
ABOUT = {"name", "source", "estimates"}


@pytest.mark.parametrize("kind", PROFILES)
@pytest.mark.parametrize("word", CHANGES)
def test_a_variant_differs_in_what_its_name_says(word, kind):
    usual, other = hl.devices.profile(kind), hl.devices.profile(f"{kind}_{word}")
    differ = {field.name for field in fields(usual) if getattr(usual, field.name) != getattr(other, field.name)} - ABOUT
    assert differ <= CHANGES[word] and differ
    assert other.nominal and other.name == f"{kind}_{word}" and usual.source in other.source
    limit = hl.stability_limit(hl.SimulatedPaddle.from_profile(other)).K
    assert 0 < limit <= hl.stability_limit(hl.SimulatedPaddle.from_profile(usual)).K


def test_what_is_typical_is_marked_and_has_an_interval():
    assert set(TYPICAL) == set(PROFILES)
    for kind in PROFILES:
        rough = hl.devices.profile(f"{kind}_rough")
        assert set(rough.estimates) == set(TYPICAL[kind]) and {"coulomb", "delay"} <= {one.name for one in rough.estimates}
        assert all("illustrative" in one.source or "measured on an emulated Uno" in one.source for one in rough.estimates)
        assert rough["coulomb"].low > 0 and rough["coulomb"].low < rough["coulomb"].high


def test_the_four_hapkits():
    """Friction that hides chatter, 100 um per count, 2 ms: the stiffest passive wall in N/m, 2 b/(T + 2 delay)."""
    paddles = [hl.devices.profile(f"hapkit{word}") for word in ("", "_rough", "_coarse", "_slow")]
    late = 190e-6 + 1 / (2 * 3.14159265 * 700)
    assert [paddle.coulomb for paddle in paddles] == [0.0, 0.05, 0.0, 0.0]
    assert paddles[2].counts_per_metre == pytest.approx(1 / 100e-6)
    wanted = [0.2 / 1e-3, 0.2 / (1e-3 + 2 * late), 0.2 / 1e-3, 0.2 / 4e-3]
    assert [hl.bounds.diolaiti(hl.Device(b=p.b, T=p.T, delay=p.delay + p.sensor_delay)).K for p in paddles] == pytest.approx(
        wanted
    )
