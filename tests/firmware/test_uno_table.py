"""What the Uno's README states: sizes of the image, cycles of a tick with each wiring, and how fast an encoder may count."""

import pytest
from count_rate import follows
from emulator import missing
from five_scenes import wall
from uno_table import image_sizes, stated, tick_cycles
from wired import PADDLES

pytestmark = pytest.mark.skipif(missing() is not None, reason=str(missing()))
ROWS = {row[0]: row[1:] for row in stated()}


def test_the_sizes_are_those_of_the_image():
    (flash, _, ram, stack, _), found = next(row for row in stated() if row[0].isdigit()), image_sizes()
    for name, said in (("flash", flash), ("RAM", ram), ("stack", stack)):
        assert int(said) == pytest.approx(found[name], rel=0.05), "write it again: python tests/firmware/uno_table.py"


@pytest.mark.parametrize("name", PADDLES)
@pytest.mark.always("hapkit")
def test_a_tick_takes_what_is_stated(name):
    for said, found in zip(map(int, ROWS[name][-1].split(",")), tick_cycles(PADDLES[name]), strict=True):
        assert said == pytest.approx(found, rel=0.08), "write it again: python tests/firmware/uno_table.py"


def test_an_encoder_as_fast_as_stated_makes_no_step_late():
    fault, late, _ = follows(0.9 * int(ROWS["wall, 1 kHz"][-1]), wall, 1e-3, 0.1)
    assert (fault, late) == (None, 0)


@pytest.mark.wide
def test_a_faster_one_ends_the_run_and_a_much_faster_one_loses_edges():
    rate = int(ROWS["wall, 1 kHz"][-1])
    fault, _, _ = follows(1.25 * rate, wall, 1e-3, 0.1)
    assert "OVERRUN" in fault or "SENSOR" in fault  # which comes first depends on the phase of edges and bytes
    fault, late, _ = follows(120_000, wall, 10e-3, 0.1)
    assert "SENSOR" in fault and late == 0
