"""The lag of a sensor, told from the time of the computation: a paddle in simulation, and a board that measures its steps."""

import pytest

import hapticlab as hl
from hapticlab.device.board.settings import nominal
from hapticlab.device.link.serial_ports import open_port

LATE = {"m": 0.03, "b": 0.1, "T": 1e-3, "coulomb": 0.05, "delay": 2e-4, "sensor_delay": 6e-4}


def test_a_simulated_paddle_has_the_lag_that_was_put_in():
    paddle = hl.SimulatedPaddle(**LATE, noise=5e-6, force_max=2.0, counts_per_metre=78125)
    found = hl.identify.paddle(paddle, kinds=("steps",))
    assert 6e-4 in found.sensor_delay and found.sensor_delay.half_width < 2e-5
    assert 8e-4 in found["delay"] and 0.03 in found["m"]


@pytest.mark.wide
def test_a_board_tells_its_own_part_of_the_delay():
    port = open_port("sim://hapkit")
    port.put_on(hl.SimulatedPaddle(**LATE, noise=8e-6), settings=nominal("hapkit", wired=1, checked=1))
    with hl.devices.SerialPaddle("sim://hapkit", port=port) as board:
        board.home(at=0.0)
        found = hl.identify.paddle(board, kinds=("steps",))
    assert found.records[0].log.delay == pytest.approx(2e-4, rel=0.02)
    assert found.sensor_delay.value == pytest.approx(6e-4, abs=2e-5)
