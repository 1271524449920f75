"""The passivity controller on the real image in its emulator: the bits of the PC's program, and its books in order."""

from dataclasses import replace

import numpy as np
import pytest
from emulated import emulated_uno
from emulator import missing

import hapticlab as hl
from hapticlab.compiler.boards.cost import cost
from hapticlab.compiler.engines.engine import load
from hapticlab.device.paddle import Paddle

pytestmark = pytest.mark.skipif(missing() is not None, reason=str(missing()))
HAND = hl.Hand(m=0.02, b=0.5, k=400, intent=lambda t: 0.004 * np.sin(40 * t))
STORED = hl.laws.Credit(stored=hl.laws.wall_energy())


def controlled(**options):
    return hl.laws.passivity_controller(hl.wall(), **({"alpha_max": 3} | options))(k=400, x_o=0.001)


@pytest.mark.parametrize(
    "options, T",
    [
        ({}, 1e-3),
        ({"credit": STORED}, 1e-3),
        ({"predict": True}, 1e-3),
        ({"credit": replace(STORED, forget=0.1), "force_max": 2}, 1.25e-3),
        ({"credit": STORED, "predict": True}, 1.25e-3),
        ({"credit": STORED, "form": "parallel", "alpha_max": None, "beta_max": 3, "force_max": 2}, 1.25e-3),
    ],
)
def test_the_periods_that_an_uno_has_time_for(options, T):
    """The shortest of a usual row of periods, as the docstring says."""
    shorter = {1e-3: 0.75e-3, 1.25e-3: 1e-3}[T]
    fits = [cost(hl.compile(controlled(**options), T=period), board="uno").fits for period in (shorter, T)]
    assert fits == [False, True]


def test_every_bit_and_every_joule():
    with emulated_uno(HAND) as paddle:
        limit = paddle.settings.force_max
        program = Paddle.program(paddle, controlled(force_max=limit))
        log = paddle.run(program, duration=0.25)
    assert log.fault is None and not log.gap.any() and not log.overrun.any()
    outputs, _ = load(program, "interpreter").run(len(log), log.x[:, None], program.values)
    np.testing.assert_array_equal(log.F.astype(np.float32), outputs[:, 0, 0].astype(np.float32))
    np.testing.assert_array_equal(log.credit.astype(np.float32), outputs[:, 1, 0].astype(np.float32))
    assert log.alpha.max() > 0.1 and log.F.max() > 0.3
    W = np.r_[0, np.cumsum(log.F[:-1] * np.diff(log.x))]
    np.testing.assert_allclose(log.credit, W, atol=2e-6 * abs(W).max())  # 250 sums in float32
