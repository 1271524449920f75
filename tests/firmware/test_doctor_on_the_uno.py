"""The doctor's steps that need no person, on the emulated Uno: a healthy board gets no advice."""

import pytest
from emulated import emulated_uno
from emulator import missing

from hapticlab.device.setup.doctor_checks import latency, loop_and_link, sensor_at_rest, settings

pytestmark = pytest.mark.skipif(missing() is not None, reason=str(missing()))


@pytest.mark.wide
def test_a_healthy_board_is_healthy():
    with emulated_uno() as paddle:
        checks = [settings(paddle), latency(paddle), *loop_and_link(paddle), sensor_at_rest(paddle)]
        assert [check.state for check in checks] == ["ok"] * 5, "\n".join(map(str, checks))
        assert "2000 samples of 2000, 0 gaps, 0 lost, 0 damaged" in str(checks[3])


@pytest.mark.wide
def test_a_frame_damaged_on_the_way_is_told():
    with emulated_uno() as paddle:
        wait = paddle.exchange.wait

        def wait_on_a_bad_line(condition, seconds):
            paddle.exchange.wait = wait  # once
            paddle.exchange.port.write(b"no frame\0")
            return wait(condition, seconds)

        paddle.exchange.wait = wait_on_a_bad_line
        _, link = loop_and_link(paddle)
        assert link.state == "attention" and "1 damaged" in link.found and "a different, short cable" in link.cure
