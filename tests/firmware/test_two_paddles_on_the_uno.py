"""Two emulated Unos coupled over their links: they follow each other at 1 kHz, and one that hears nothing fades in time."""

import numpy as np
import pytest
from emulated import emulated_uno
from emulator import missing

import hapticlab as hl

pytestmark = [pytest.mark.skipif(missing() is not None, reason=str(missing())), pytest.mark.wide]


def test_two_unos_follow_each_other_and_one_that_hears_nothing_fades_in_time():
    side = hl.laws.bilateral_coupling()(k=60, b=0.2)
    hand = hl.Hand("pinch", intent=lambda t: 0.01 * np.sin(6 * t))
    with emulated_uno(hand) as left, emulated_uno() as right:
        assert left.cost(side).verdict == "fits, guaranteed for any operands"
        pair = hl.devices.TwoPaddles(left, right, side)
        pair.start()
        pair.wait(0.6)
        pair._left.hear = lambda message: None
        pair.wait(0.15)
        run = pair.stop()
        assert left.timing.overruns == right.timing.overruns == left.timing.lost == right.timing.lost == 0
    assert np.corrcoef(run.left.x[200:600], run.right.x[200:600])[0, 1] > 0.9
    assert run.to_right.median < 8e-3 and run.to_right.rate > 250
    t, silent = run.left.t, run.left.t >= run.left.t[np.flatnonzero(np.diff(run.left.heard))[-1] + 1] + 0.1 - 5e-4
    assert t[-1] > 0.74 and np.count_nonzero(silent) > 20
    assert np.all(run.left.F[silent] == 0) and np.any(run.left.F[~silent] != 0)
