"""Profiles are marked as what they are, and the ETH constants follow from the published ones."""

import pytest

import hapticlab as hl
from hapticlab.compiler.boards.board_records import BOARDS
from hapticlab.device.board.settings import nominal
from hapticlab.device.profiles import PROFILES, eth, hapkit, profile
from hapticlab.device.simulated.simulated_paddle import SimulatedPaddle
from hapticlab.device.wiring import Wiring, require_possible
from hapticlab.device.wirings import build
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


def test_the_labs_hapkit_is_what_it_was():
    """Its lag, noise, flight, friction and dead band stay out of it; the labs' numbers are of this paddle."""
    assert (hapkit.m, hapkit.b, hapkit.counts_per_metre, hapkit.force_max, hapkit.T) == (0.03, 0.10, 1 / 12.8e-6, 3.3, 1e-3)
    left_out = hapkit.sensor_delay, hapkit.sensor_noise, hapkit.sensor_flight, hapkit.duty_dead, hapkit.coulomb, hapkit.delay
    assert left_out == (0.0,) * 6 and hapkit.duty_25 is None and hapkit.estimates == ()


def test_travel_of_a_turn_from_published_radii():
    """A turn of the pulley is 2 pi rp rh / rs at the handle, 33.5, 35.6 and 24.6 mm; torque over rp rh / rs is a force."""
    turns = {"hapkit_as5048a": (16384, 33.51e-3), "longhorn": (48, 35.60e-3), "motor_shield": (2000, 24.63e-3)}
    for name, (counts, turn) in turns.items():
        assert counts / profile(name).counts_per_metre == pytest.approx(turn, rel=1e-3), name
    assert profile("hapkit_as5048a").force_full == pytest.approx(0.0183 / 5.333e-3, rel=1e-3)
    assert profile("longhorn").force_full == pytest.approx(0.0167 / 5.667e-3, rel=1e-3)
    # 0.06 degrees of noise are 2.7 counts
    assert profile("hapkit_as5048a").sensor_noise * profile("hapkit_as5048a").counts_per_metre == pytest.approx(2.73, rel=1e-2)


@pytest.mark.parametrize("name", [name for name, one in PROFILES.items() if one.wiring])
def test_nominal_settings_have_the_wiring_of_the_build(name):
    """And the board that has it can do it; a board's own settings are the profile's numbers."""
    kind, kept = profile(name), nominal(name)
    built = build(kind.wiring)
    assert Wiring.of(kept) == built.wiring and kept.carrier == kind.carrier == built.wiring.carrier
    require_possible(built.wiring, BOARDS[built.board])
    assert (kept.wired, kept.checked, kept.date) == (0, 0, 0) and kept.force_max <= kept.force_full
    assert kept.metres_per_count * kind.counts_per_metre == pytest.approx(1)
    assert kept.device(kind.T).sensor_delay == kind.sensor_delay


@pytest.mark.parametrize("name", PROFILES)
@pytest.mark.always("hapkit_as5048a", "eth")
def test_a_simulated_board_of_each_kind_gives_a_wall(name):
    """The firmware's core with its sensor and its drive; the handle stands where spring and hand balance."""
    with hl.connect(f"sim://{name}") as paddle:
        port, kind = paddle.exchange.port, profile(name)
        port.put_on(SimulatedPaddle.from_profile(kind, hand=hl.Hand(k=100.0, b=3.0, intent=0.02)), settings=port.settings)
        paddle = hl.devices.SerialPaddle(f"sim://{name}", port=port)
        log = paddle.run(hl.wall()(k=30.0, x_o=0.0), duration=1.5)
        count = 1 / (kind.counts_per_metre or 1e7)
        place = port.handle.x
        assert log.fault is None and place == pytest.approx(0.02 * 100 / 130, abs=3 * count + 2e-4)
        assert paddle.device.sensor_delay == log.sensor_delay == pytest.approx(kind.sensor_delay)
        assert log.F[-100:].mean() == pytest.approx(30 * place, abs=30 * count + 0.01)


@pytest.mark.parametrize("name", ["eth", "hapkit", "hapkit_as5048a", "longhorn", "motor_shield"])
def test_paddle_says_where_its_constants_come_from(name):
    text = str(SimulatedPaddle.from_profile(name))
    assert f"from paddle {name}" in text and "nominal, not measured on this device" in text
    assert profile(name).source in text


def test_changes_and_unknown_names():
    paddle = SimulatedPaddle.from_profile(hapkit, T=5e-4, coulomb=0.1)
    assert (paddle.m, paddle.T, paddle.coulomb, paddle.force_max) == (hapkit.m, 5e-4, 0.1, hapkit.force_max)
    with pytest.raises(PaddleError, match="mass is not an argument of SimulatedPaddle"):
        SimulatedPaddle.from_profile(eth, mass=1)
    with pytest.raises(PaddleError, match="by its name or its file, not as an int; there are hapkit, "):
        profile(5)
    with pytest.raises(PaddleError, match=f"no profile 'falcon'; there are {', '.join(PROFILES)}"):
        profile("falcon")
