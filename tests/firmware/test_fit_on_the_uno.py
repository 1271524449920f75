"""What is refused before it is sent, and what is sent, on the emulated Uno."""

import numpy as np
import pytest
from emulated import emulated_uno
from emulator import TIMER1_COMPA, missing
from five_scenes import pendulum, wall

import hapticlab as hl
from hapticlab.errors import ProgramLimitError

pytestmark = pytest.mark.skipif(missing() is not None, reason=str(missing()))


def test_a_scene_that_does_not_fit_is_refused_with_what_would():
    scene, options = pendulum()
    with emulated_uno() as paddle:
        with pytest.raises(ProgramLimitError, match=r"pendulum with rk4: .* of a 1 ms period on uno .*fits with method='"):
            paddle.run(scene, duration=0.1, **options)
        assert paddle.run(scene, duration=0.1, method="semi_implicit_euler").fault is None


def test_the_cost_said_before_is_the_load_measured_after():
    hand = hl.Hand(m=0.05, b=3, k=400, intent=lambda t: 0.006 * np.sin(9 * t) + 0.003 * np.sin(31 * t))
    with emulated_uno(hand) as paddle:
        scene, _ = wall()
        said, board = paddle.cost(scene), paddle.loop.board
        paddle.start(scene)
        count, mean, _ = board.cost(TIMER1_COMPA)
        paddle.wait(1.0)
        count_after, mean_after, worst = board.cost(TIMER1_COMPA)
        paddle.stop()
    cycles = (count_after * mean_after - count * mean) / (count_after - count)  # the whole interrupt, others in it too
    assert cycles == pytest.approx(said.typical + said.step[0], rel=0.1)  # what is said of a typical time
    assert worst <= said.bound + said.step[1]


@pytest.mark.parametrize("every", [50, 333])
def test_rare_samples_leave_the_heartbeat_alone(every):
    with emulated_uno() as paddle:
        log = paddle.run(wall()[0], duration=1.0, every=every)
        assert log.fault is None and log.every == every and len(log) == -(-1000 // every)
