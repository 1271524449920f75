"""Every fault ends with the motor off, within the time that is stated for it."""

from functools import cache

import pytest
from emulated import emulated_uno
from emulator import missing
from faults import ALWAYS, FAULTS, assert_off_in_time, measure

from hapticlab.device.board.settings import changed
from hapticlab.device.link.messages import FAULTS as NAMES
from hapticlab.device.setup.stored_settings import store

pytestmark = pytest.mark.skipif(missing() is not None, reason=str(missing()))


@cache
def measured(name):
    return measure(FAULTS[name])


@pytest.mark.parametrize("name", FAULTS)
@pytest.mark.always(
    "host silent", "over-speed", "over-travel", "sensor's wire", "tick stops", "brown-out"
)  # each way to find one
def test_the_motor_is_off_in_time(name, record_property):
    assert_off_in_time(name, FAULTS[name], *measured(name), record_property)


def test_every_fault_of_the_table_is_injected():
    assert {fault.says for fault in FAULTS.values()} - {None} == set(NAMES)


def test_the_heat_fault_comes_when_the_first_order_model_says():
    taken, _ = measured("heat")
    assert 1.06 < taken < 1.57


def test_a_board_that_wrote_its_settings_gives_force_afterwards():
    """Nobody takes the heat of the ticks meanwhile; it was never taken again, and each run ended as an OVERRUN."""
    with emulated_uno() as paddle:
        store(paddle, changed(paddle.settings, speed_max=1.5))
        paddle.home(at=0.0)
        log = paddle.run(ALWAYS, duration=0.03)
    assert log.fault is None and len(log) == 30 and log.F.all()
