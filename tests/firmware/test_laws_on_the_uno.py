"""Laws with a chosen velocity, pulses on entry and damping compensation on the emulated Uno: bits, load, and refusals."""

import numpy as np
import pytest
from emulated import emulated_uno
from emulator import TIMER1_COMPA, missing

import hapticlab as hl
from hapticlab.compiler.engines.engine import load
from hapticlab.errors import ProgramLimitError

pytestmark = pytest.mark.skipif(missing() is not None, reason=str(missing()))
#: pushes the handle through the boundary and back again, twice in the quarter of a second that is run
HAND = hl.Hand(m=0.02, b=2, k=300, intent=lambda t: 0.006 * np.sin(2 * np.pi * 8 * t))
WALL = {"k": 150, "x_o": "2 mm"}
COUNT = 13.8e-6  # the emulated paddle's, rounded up [m]


def scenes():
    fast, mass = hl.velocity.filtered(tau="2 ms"), 0.05
    return {
        "filter": hl.wall("half_sample", velocity=fast)(**WALL, B=0.3),
        "window": hl.laws.virtual_damper(velocity=hl.velocity.window(deviation=COUNT, longest=4))(B=0.4),
        "kalman": hl.wall("half_sample", velocity=hl.velocity.kalman(acceleration=20, noise=COUNT / 3))(**WALL),
        "from_start": hl.laws.virtual_damper(velocity=hl.velocity.kalman(acceleration=20, noise=COUNT / 3, steady=False))(B=0.4),
        "brake": hl.laws.braking_pulse(hl.wall()(**WALL), part=0.5, mass=mass, periods=3, entry=hl.laws.Entry(velocity=fast)),
        "friction": hl.laws.friction_pulse(hl.wall()(**WALL), friction=0.5, mass=mass, periods=15),
        "compensation": hl.laws.damping_compensation(
            hl.wall()(**WALL), b=0.1, coulomb=0.02, speed="20 mm/s", sign="dead_zone", velocity=fast
        )(viscous=0.5, dry=0.5),
        "force filter": hl.laws.force_filter(hl.wall()(**WALL)),
    }


def run_on_the_uno(scene, duration):
    with emulated_uno(HAND) as paddle:
        said, board = paddle.cost(scene), paddle.loop.board
        paddle.start(scene)
        count, mean, _ = board.cost(TIMER1_COMPA)
        paddle.wait(duration)
        count_after, mean_after, worst = board.cost(TIMER1_COMPA)
        log = paddle.stop()
    cycles = (count_after * mean_after - count * mean) / (count_after - count)
    return log, said, cycles, worst


ALWAYS = "kalman", "brake"  # a third of a second each; the others with -m slow


@pytest.mark.parametrize("name", [pytest.param(n, marks=() if n in ALWAYS else pytest.mark.slow) for n in scenes()])
@pytest.mark.always("brake")
def test_it_runs_with_the_bits_of_the_core_and_the_load_that_was_said(name):
    log, said, cycles, worst = run_on_the_uno(scenes()[name], 0.25)
    print(f"\n{name}: {said.typical} cycles of the scene, {cycles:.0f} of a step, longest {worst}, {said.verdict}")
    assert log.fault is None and not log.gap.any()
    assert np.abs(log.F).max() > 0.05
    program = said.program
    again = load(program, "vm").run(len(log.x), log.x[:, None]).outputs[:, 0, 0]
    np.testing.assert_array_equal(log.F, np.clip(again, -log.F.max(), log.F.max()) if log.saturated.any() else again)
    # what was said of a typical time, less its error, and not more than that with all that interrupts it
    assert 0.9 * (said.typical + said.step[0]) <= cycles <= said.longest()
    assert worst <= said.longest(promise=True)


@pytest.mark.slow
def test_a_dearer_estimate_is_refused_with_the_cheaper_one():
    scene = hl.wall("half_sample", velocity=hl.velocity.window(deviation=COUNT, longest=5, fit="best"))(**WALL)
    words = r"of a 1 ms period on uno .*fits with velocity='adaptive window of \d, end fit'"
    with emulated_uno() as paddle, pytest.raises(ProgramLimitError, match=words):
        paddle.run(scene, duration=0.1)
