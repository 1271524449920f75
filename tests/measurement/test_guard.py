"""The guard cuts at the sample that passes a limit, pairs forces with the motion they act on, and stays cut."""

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.measurement.guard import guarded

T = 1e-3
WALL = hl.wall()(k=800.0, x_o=0.0)


def run(paddle, **limits):
    scene = guarded(WALL, **{"energy_max": 1.0, "speed_max": 10.0, **limits})
    return paddle.run(scene, duration=0.5, progress=False, dtype="float64")


@pytest.mark.parametrize("periods", [0, 1, 3])
@pytest.mark.always("1")
def test_the_energy_drawn_is_the_work_at_the_port(periods):
    """Against the energy of the record, which pairs forces and displacements by itself; F[n - d] acts from n to n + 1."""
    paddle = hl.SimulatedPaddle(m=0.05, b=0.0, T=T, delay=periods * T, hand=hl.Hand(push=1.0))
    log = run(paddle, periods=periods)
    assert not log.tripped.any()
    assert log.drawn == pytest.approx(-hl.energy(log).W, abs=1e-12 * abs(log.drawn).max())


def test_too_much_energy_cuts_at_once_and_for_good():
    paddle = hl.SimulatedPaddle(m=0.05, b=0.0, T=T, hand=hl.Hand(push=1.0))
    log = run(paddle, energy_max=1e-3)
    cut = int(np.argmax(log.tripped))
    assert log.drawn[cut] > 1e-3 >= log.drawn[:cut].max()
    assert (log.F[cut:] == 0).all() and (log.tripped[cut:] == 1).all() and (log.tripped[:cut] == 0).all()
    assert (log.x[cut:] > 0).any()  # where the wall would push


def test_too_much_speed_cuts_at_once():
    paddle = hl.SimulatedPaddle(m=0.05, b=0.0, T=T, hand=hl.Hand(push=1.0))
    log = run(paddle, speed_max=0.1)
    cut = int(np.argmax(log.tripped))
    assert abs(log.v[cut]) > 0.1 >= abs(log.v[:cut]).max() and (log.F[cut:] == 0).all()


def test_the_guard_cuts_on_a_board_as_in_simulation():
    paddle = hl.SimulatedPaddle(m=0.05, b=0.0, T=T, counts_per_metre=1e7, rounding="nearest", hand=hl.Hand(push=1.0))
    scene = guarded(WALL, energy_max=1e-3, speed_max=10.0)
    with hl.connect("sim://hapkit", paddle=paddle) as board:
        felt = board.run(scene, duration=0.2)
    log = paddle.run(scene, duration=0.2, progress=False)
    assert np.argmax(felt.tripped) == np.argmax(log.tripped) > 0
    assert (felt.F[felt.tripped > 0] == 0).all()


def test_a_wall_that_gives_little_is_the_wall_itself():
    paddle = hl.SimulatedPaddle(m=0.05, b=1.0, T=T, hand=hl.Hand(push=1.0))
    plain = paddle.run(WALL, duration=0.5, progress=False, dtype="float64")
    assert np.array_equal(run(paddle).x, plain.x)
