"""A drive train obeys mechanics: power in is power out, and each profile agrees with its own drive."""

import math
from dataclasses import replace

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.device.profiles import PROFILES
from hapticlab.errors import PaddleError

TOY = hl.devices.DriveTrain(
    drum=0.004, sector=0.08, handle=0.06, counts_per_turn=1000, torque_constant=0.03, resistance=6, supply=12, rotor_inertia=9e-7
)


def test_the_jacobian_is_that_of_the_mechanism():
    """Turned by a little, the rim moves as far as the drum, and the handle as far as the angle of the sector says."""
    turn = 1e-3
    angle_of_the_sector = turn * 0.004 / 0.08
    assert TOY.jacobian * turn == pytest.approx(0.06 * angle_of_the_sector)
    assert TOY.metres_per_count == pytest.approx(TOY.jacobian * 2 * math.pi / 1000)


def test_motor_and_handle_exchange_the_same_power_and_hold_the_same_energy():
    force, speed = 2.5, 0.3
    w = speed / TOY.jacobian
    assert TOY.torque(force) * w == pytest.approx(force * speed)
    assert TOY.torque_constant * TOY.current(force) * w == pytest.approx(force * speed)
    assert 0.5 * TOY.rotor_inertia * w**2 == pytest.approx(0.5 * TOY.rotor_mass * speed**2)


def test_the_supply_limits_the_current_in_both_directions():
    forces = np.array([-100.0, -20.0, -1.0, 0.0, 1.0, 20.0, 100.0])  # 2 A through 6 ohm, 10 N/A
    assert TOY.force_full == pytest.approx(20)
    assert TOY.current(forces) == pytest.approx([-2, -2, -0.1, 0, 0.1, 2, 2])
    assert TOY.duty(forces) == pytest.approx([1, 1, 0.05, 0, 0.05, 1, 1])
    assert TOY.duty([5.0], squared=True) == pytest.approx([0.5])
    assert replace(TOY, supply=None).current(100.0) == pytest.approx(10), "without a supply nothing limits it"


def test_it_says_what_each_part_does():
    lines = str(replace(TOY, counts_per_turn=16_384, source="a sketch")).split("\n")
    assert lines[0] == "drive: the handle moves 3 mm per radian of the motor"
    assert [line.split()[0] for line in lines[1:]] == ["radii", "sensor", "motor", "supply", "rotor", "source"]
    assert "16384 counts per turn, 1.15 um per count" in lines[2] and lines[4].endswith("at most 2 A, 20 N at the handle")
    assert "felt as 100 g" in lines[5] and "rotor" not in str(replace(TOY, rotor_inertia=None))


def test_what_is_not_known_is_none_or_refused():
    bare = hl.devices.DriveTrain(drum=0.004, sector="80 mm", handle=0.06)
    assert bare.sector == 0.08
    lacking = (bare.metres_per_count, bare.force_per_ampere, bare.current_full, bare.force_full, bare.rotor_mass)
    assert lacking == (None,) * 5
    with pytest.raises(PaddleError, match="no torque_constant"):
        bare.current(1.0)
    with pytest.raises(PaddleError, match="lacks its supply or its resistance"):
        replace(bare, torque_constant=0.02).duty(1.0)
    for wrong in ({"drum": 0}, {"drum": None}, {"supply": math.nan}, {"source": 3}):
        with pytest.raises(PaddleError, match=next(iter(wrong))):
            replace(TOY, **wrong)
    with pytest.raises(PaddleError, match="needs an hl.devices.DriveTrain, or None"):
        hl.devices.PaddleProfile("toy", m=0.05, b=0.1, drive=5.3)


@pytest.mark.parametrize("kind", PROFILES)
def test_a_profile_agrees_with_its_drive(kind):
    """To half a percent, which the rounded numbers of the Hapkit need; its source says so."""
    profile, drive = PROFILES[kind], PROFILES[kind].drive
    if drive.counts_per_turn:
        assert 1 / profile.counts_per_metre == pytest.approx(drive.metres_per_count, rel=5e-3)
    else:
        assert profile.counts_per_metre is None
    if drive.force_full:
        assert profile.force_full == pytest.approx(drive.force_full, rel=5e-3)
        assert profile.force_max <= drive.force_full
    assert drive.rotor_mass < profile.m, "the rotor is a part of what is felt"
    assert drive.source and profile.nominal


def test_the_published_inertias_and_damping_of_eth_give_its_mass_and_damping():
    """J_p = 2.2e-4 kg m^2 and B_m = 7.9e-7 N m s/rad, of the same file as its drive, at the handle."""
    eth = hl.devices.profile("eth")
    assert eth.drive.rotor_mass + 2.2e-4 / eth.drive.handle**2 == pytest.approx(eth.m, rel=2e-3)
    assert 7.9e-7 / eth.drive.jacobian**2 == pytest.approx(eth.b, rel=3e-3)


def test_a_coarse_encoder_counts_less_per_turn():
    coarse = hl.devices.profile("hapkit_coarse")
    assert coarse.drive.metres_per_count == pytest.approx(1 / coarse.counts_per_metre)
    assert hl.devices.profile("hapkit_slow").drive == hl.devices.profile("hapkit").drive


def test_a_twin_keeps_the_drive_of_its_base():
    twin = hl.identify.twin("bench 7", base="hapkit", m="34 g")
    assert twin.drive == hl.devices.profile("hapkit").drive
