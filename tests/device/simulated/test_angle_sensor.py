"""An angle sensor that flies back: never further than its ends, back within its time, and the same counts otherwise."""

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.device.board.settings import nominal
from hapticlab.device.link.serial_ports import open_port
from hapticlab.device.simulated.angle_sensor import AngleSensor
from hapticlab.device.simulated.simulated_paddle import SimulatedPaddle

WRAP = 920


@pytest.mark.parametrize("speed", [3e5, -3e5, 2e4])
@pytest.mark.parametrize("flight", [0.0, 5e-5, 2e-4, 1.3e-3])
def test_a_reading_is_the_position_except_in_the_time_after_an_edge(speed, flight):
    """By the closed form of an even motion: it passes an edge every wrap / speed, and reads on a line between the ends."""
    sensor, T = AngleSensor(WRAP, flight), 1e-4
    for k in range(4000):
        counts = int(np.floor(speed * k * T + 0.5))
        seen = sensor.reading(counts, k * T)
        since = (counts % WRAP if speed > 0 else WRAP - counts % WRAP) / abs(speed)
        begun = abs(counts) >= WRAP or (speed < 0 and counts < 0)
        if since > flight + T or not begun:
            assert seen == counts % WRAP
        elif since < flight - T:
            end = WRAP - 1 if speed > 0 else 0
            assert seen == pytest.approx(end + since / flight * (counts % WRAP - end), abs=0.03 * WRAP)
        assert 0 <= seen < WRAP


def test_without_a_flight_a_board_is_told_the_counts_themselves():
    """The same run, sample by sample, as ever; with one, the handle passes an edge with a reading between its ends."""
    logs = []
    for flight in (0.0, 1e-6, 0.9e-3):
        port = open_port("sim://hapkit")
        hand = hl.Hand(k=200.0, b=2.0, intent=lambda t: 0.02 * np.sin(8 * t))
        told = nominal("hapkit", wired=1, checked=1, sensor_flight=flight)
        port.put_on(SimulatedPaddle(m=0.03, b=0.1, T=1e-3, hand=hand), settings=told)
        assert (port._angle is None) == (flight == 0.0)
        with hl.devices.SerialPaddle("sim://hapkit", port=port) as paddle:
            logs.append(paddle.run(hl.wall()(k=50.0, x_o=0.05), duration=0.4, passive=True))
    assert np.array_equal(logs[0].x, logs[1].x[: len(logs[0])]) and np.ptp(logs[0].x) > 1.5 * WRAP * 12.8e-6
    assert logs[2].fault is not None or not np.array_equal(logs[0].x, logs[2].x)


@pytest.mark.parametrize("flight", [5e-5, 1e-4, 2e-4])
@pytest.mark.always("0.0002")
def test_a_scene_goes_on_while_the_reading_is_in_flight(flight):
    """A hand sways over both edges; before the core distrusted such a reading, most of these runs ended as OVER_SPEED."""
    for rate in (8, 9, 10):
        logs = []
        for own in (0.0, flight):
            port = open_port("sim://hapkit")
            hand = hl.Hand(k=200.0, b=2.0, intent=lambda t, rate=rate: 0.02 * np.sin(rate * t))
            told = nominal("hapkit", wired=1, checked=1, sensor_flight=own)
            port.put_on(SimulatedPaddle(m=0.03, b=0.1, T=1e-3, hand=hand), settings=told)
            with hl.devices.SerialPaddle("sim://hapkit", port=port) as paddle:
                logs.append(paddle.run(hl.wall()(k=50.0, x_o=0.005), duration=2.0))
        assert logs[1].fault is None and len(logs[1]) == 2000
        assert np.abs(logs[1].x - logs[0].x).max() < 1.5e-3  # of a handle at up to 0.2 m/s, whose place it held meanwhile
        assert logs[1].x[-1] == pytest.approx(logs[0].x[-1], abs=2e-4)  # and no count is lost


def test_a_motor_that_its_board_does_not_know():
    """Beside one that it knows: the force that acts at the handle, by where hand and wall balance."""
    curve = {"duty_dead": 0.2, "duty_25": 0.3, "duty_50": 0.5, "duty_75": 0.8, "force_full": 4.0}
    places = []
    for compensated in (True, False):
        port = open_port("sim://eth")
        hand = hl.Hand(k=100.0, b=3.0, intent=0.02)
        port.put_on(SimulatedPaddle(m=0.05, b=0.5, T=1e-3, hand=hand, compensated=compensated, **curve))
        with hl.devices.SerialPaddle("sim://eth", port=port) as paddle:
            assert (paddle.settings.duty_dead > 0) == compensated
            log = paddle.run(hl.wall()(k=30.0, x_o=0.0), duration=0.95)  # a motor that moves nothing is FROZEN after 1.2 s
            places.append((port.handle.x, log.F[-1]))
    (known, F_known), (unknown, F_unknown) = places
    assert F_known == pytest.approx(100 * (0.02 - known), rel=1e-3)
    acted = 4.0 * np.interp(F_unknown / 4.0, [0.2, 0.3, 0.5, 0.8, 1.0], [0, 0.25, 0.5, 0.75, 1.0])
    assert 100 * (0.02 - unknown) == pytest.approx(acted, abs=2e-3) and abs(acted - F_unknown) > 0.1
