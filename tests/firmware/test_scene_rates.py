"""The rates that docs/paddle/boards.md states: what the model says now, and what the real image does in the emulator."""

import pytest
from emulator import missing
from scene_rates import GRID, holds, row, scenes, stated

import hapticlab as hl
from hapticlab.compiler.boards.cost import cost

pytestmark = pytest.mark.skipif(missing() is not None, reason=str(missing()))
AGAIN = "write it again: python tests/firmware/scene_rates.py"
MASS = "own_mass_and_wall"


@pytest.mark.parametrize("name", scenes())
@pytest.mark.always(MASS)
def test_the_page_states_what_the_model_says(name):
    said = stated()[name]
    for cell, known in zip(said[2:4] + said[5:], row(name)[2:], strict=True):
        assert (cell == "-") == (known == "-"), AGAIN
        assert cell == "-" or int(cell) == pytest.approx(int(known), rel=0.03), AGAIN


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=() if name in ("detents", MASS) else pytest.mark.slow)
        for name in scenes()
        if stated()[name][4] != "-"
    ],
)
@pytest.mark.wide
def test_a_scene_runs_as_fast_as_is_stated_and_no_faster(name):
    fits, promised, found = (int(cell) * 1e-6 for cell in stated()[name][2:5])
    assert found <= fits <= promised, "what is predicted must run"
    assert holds(name, found + GRID) and not holds(name, 0.93 * found), AGAIN


def test_a_mass_and_a_wall_are_promised_at_1_kHz():
    scene, options = scenes()[MASS]
    assert cost(hl.compile(scene, T=1e-3, **options)).promised and holds(MASS, 1e-3, seconds=0.1)
