"""The passivity observer on the firmware behind sim://: what it watches against the energy of its telemetry."""

import numpy as np
import pytest

import hapticlab as hl


@pytest.mark.parametrize("form", ["observer", "series", "parallel"])
def test_the_observer_of_a_board_keeps_the_books_of_its_telemetry(board, form):
    limit = board.settings.force_max
    if form == "observer":
        scene = hl.laws.passivity_observer(hl.wall())
    elif form == "series":
        scene = hl.laws.passivity_controller(hl.wall(), alpha_max=2, force_max=limit)
    else:
        scene = hl.laws.passivity_controller(
            hl.wall(), "parallel", beta_max=5, force_max=limit, credit=hl.laws.Credit(stored=hl.laws.wall_energy())
        )
    x_o = board.run(hl.wall()(k=1), duration=0.01).x[-1] - 0.003  # the handle rests 3 mm inside and is pushed out
    log = board.run(scene(k=200, x_o=x_o), duration=0.3)
    assert log.fault is None and not log.gap.any()
    assert log.F[0] > 0.3 and np.ptp(log.x) > 1e-3
    seen = log.channels.get("W", log.channels.get("credit"))
    work = np.r_[0, np.cumsum(log.F[:-1] * np.diff(log.x))]
    spring = 200 * np.maximum(log.x - x_o - log.channels.get("slip", 0), 0) ** 2 / 2
    expected = work - (spring - spring[0]) if form == "parallel" else work
    # float32: 300 sums, and of a position of some centimetres the difference of two samples
    np.testing.assert_allclose(seen, expected, atol=1e-5 * abs(work).max())
    assert hl.passivity.trace(log).drained == pytest.approx((np.maximum.accumulate(work) - work).max(), rel=1e-9)
