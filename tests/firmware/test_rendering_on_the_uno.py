"""Model-based walls on the emulated Uno, the hand and the handle simulated around it."""

from dataclasses import replace

import pytest
from emulated import emulated_uno
from emulator import missing

import hapticlab as hl

pytestmark = [pytest.mark.slow, pytest.mark.skipif(missing() is not None, reason=str(missing()))]
HAND = hl.Hand(m=0.05, b=3.0, k=400, intent=0.004)


@pytest.mark.parametrize(("T", "name"), [(1e-3, "half a sample by the model"), (2.2e-3, "half a sample, dead-beat")])
def test_the_best_wall_that_fits_runs_and_holds(T, name):
    """A spring hand that leans 4 mm into 300 N/m: on the wall itself it rests at 400 * 4/700 mm, and comes to rest."""
    model = hl.SimulatedPaddle.from_profile("hapkit", T=T, hand=replace(HAND, k=0.0, intent=None))
    wall = hl.laws.wall_for_board(model, K=300.0)
    assert wall.name.startswith(name)
    with emulated_uno(HAND, T=T) as paddle:
        log = paddle.run(wall.scene, duration=0.6)
    assert log.fault is None and not log.overrun.any()
    assert hl.chatter(log).state in ("none", "decaying")
    assert log.x[-100:].mean() == pytest.approx(0.4 * 4e-3 / 0.7, rel=0.03)
