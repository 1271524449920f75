"""A reading taken while the magnet's sensor flies from one end to the other is no motion: nothing stops, and no count is lost."""

import numpy as np
import pytest
from emulated import emulated_uno
from emulator import missing
from wired import CALIBRATED, SPRING

import hapticlab as hl
from hapticlab.device.board.settings import nominal

pytestmark = pytest.mark.skipif(missing() is not None, reason=str(missing()))
FLIGHTS = (50e-6, 100e-6, 200e-6)
COUNT = 12.8e-6


def hand_of(seed):
    """Return a hand that moves over three turns of the magnet, at up to 0.19 m/s."""
    a, b, w = np.random.default_rng(seed).uniform((0, 0, 4), (6, 6, 6))
    return hl.Hand(m=0.05, b=3, k=400, intent=lambda t: 0.012 * np.sin(w * t + a) + 0.004 * np.sin(31 * t + b))


def goes_on(flight, seed, seconds, **values):
    """Run, and look for the handle where the board has it: both at the end, when it has stopped."""
    with emulated_uno(hand_of(seed), settings=nominal("hapkit", **CALIBRATED, sensor_flight=flight, **values)) as paddle:
        log = paddle.run(SPRING(K=5), duration=seconds)
        assert log.fault is None, f"{seed}: {log.fault}"
        loop = paddle.loop
        assert loop.sensor.flights > 4 * seconds
        last, where = loop.x, paddle.state()["x"]
        assert abs(where - loop.x) < abs(loop.x - last) + 0.2e-3 + values.get("sensor_delay", 0), "the position was lost"
        # nearly over, a flight may pass for a change of the speed: by a 16th of the turn, and once more on the way back
        assert np.abs(np.diff(log.x)).max() < 2 * 920 / 16 * COUNT, "a reading in flight was taken for a position"


@pytest.mark.parametrize("flight", FLIGHTS)
@pytest.mark.always("0.0002")
def test_a_flight_of_the_sensor_stops_nothing(flight):
    goes_on(flight, 0, 0.5 if flight == max(FLIGHTS) else 2.0)


@pytest.mark.wide
def test_nor_does_one_of_a_sensor_with_lag_and_noise():
    goes_on(100e-6, 3, 1.0, sensor_delay=0.5e-3, sensor_noise=COUNT)


@pytest.mark.slow
@pytest.mark.parametrize("flight", FLIGHTS)
@pytest.mark.parametrize("seed", range(8))
def test_24_runs_of_two_seconds_are_whole(flight, seed):
    goes_on(flight, seed, 2.0)
