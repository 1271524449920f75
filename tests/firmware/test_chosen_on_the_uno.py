"""What a trade-off chooses for an Uno, run there in emulation: the error and the load are those that were promised."""

import numpy as np
import pytest
import sympy as sp
from closed_loop import STEP, ClosedLoop
from emulated import image
from emulator import CYCLES_PER_SECOND, TIMER1_COMPA, Uno, missing
from uno_port import offer

import hapticlab as hl
from hapticlab.analysis.accuracy.handle_motions import HandleMotion
from hapticlab.analysis.accuracy.reference import reference
from hapticlab.device.board.serial_paddle import SerialPaddle
from hapticlab.device.board.settings import nominal

pytestmark = pytest.mark.skipif(missing() is not None, reason=str(missing()))
QUICKEST = 0.06  # of the motion [m/s]
#: a sensor as fine as the board follows at that speed, so that what is left is the error of the program; 0.2 mm a turn
COUNT = 2.2e-7  # [m]
SENSOR = nominal("hapkit", wired=1, checked=1, ident=0x3F2A, date=20261120, metres_per_count=COUNT, speed_max=QUICKEST)
SINES = sp.sin(2 * sp.pi * 0.83 * hl.t) + sp.sin(2 * sp.pi * 2.3 * hl.t) / 2
MOTION = HandleMotion("two sines", 0.004 * SINES * (1 - sp.exp(-((hl.t / 0.1) ** 3))), 1.0)
EVERY = 5  # ticks a sample of telemetry, whose frames are no part of the step that is measured


class LedHandle:
    """A handle in a hand so strong that no motor moves it off its motion; it stands until it is told to begin."""

    def __init__(self, motion):
        self.x = motion.at(STEP * np.arange(round(motion.duration / STEP) + 1))[0]
        self.at, self.begun = 0, False

    def step(self, force, seconds):
        """Move on by STEP and return the position [m]."""
        self.at = min(self.at + (self.begun and seconds > 0), len(self.x) - 1)
        return float(self.x[self.at])


def run_on_the_uno(program, handle):
    """Return the telemetry of a run along the handle's motion, and the mean cycles of a control step."""
    with Uno(image(), eeprom=SENSOR.to_bytes()) as board:
        loop = ClosedLoop.of(SENSOR.to_float32(), board, handle)
        with SerialPaddle(offer(f"led{id(loop)}", loop), T=program.T) as paddle:
            paddle.home(at=loop.x)
            paddle.start(program, every=EVERY)
            paddle.wait(0.05)
            count, mean, _ = board.cost(TIMER1_COMPA)
            handle.begun = True
            paddle.wait(MOTION.duration)
            count_after, mean_after, _ = board.cost(TIMER1_COMPA)
            log = paddle.stop()
    return log, (count_after * mean_after - count * mean) / (count_after - count)


def error_of(log, truth):
    """Return the greatest error of the force beside the reference, which begins where positions say the motion did."""
    n = np.arange(len(log)) * log.T
    moving = np.flatnonzero(np.abs(log.x) > 2e-6)[0]
    grid = STEP / 5 * np.arange(round(MOTION.duration / STEP * 5))
    path = MOTION.at(grid)[0]
    starts = n[moving] + np.linspace(-0.06, 0.01, 1401)
    kept = (n > n[moving]) & (n < n[moving] + 0.9)
    misfits = [np.mean((np.interp(n[kept] - start, grid, path) - log.x[kept]) ** 2) for start in starts]
    start = starts[np.argmin(misfits)]
    assert np.sqrt(min(misfits)) < COUNT + QUICKEST * STEP  # a count, and the step of the emulated handle
    return np.abs(np.interp(n[kept] - start, truth.t, truth.F) - log.F[kept]).max()


@pytest.mark.wide
def test_the_chosen_configuration_has_the_error_and_the_load_that_it_promised():
    tolerance, scene = 1e-2, hl.library.mass_spring_damper()
    paddle = hl.SimulatedPaddle.from_profile(hl.library.nominal, counts_per_metre=1 / COUNT)
    found = hl.methods.tradeoff(
        scene,
        paddle,
        tried=hl.methods.Tried(methods=["semi_implicit_euler", "verlet", "exact"], T=[1.25e-3, 1e-3], precision=["float32"]),
        targets=["uno"],
        conditions=hl.methods.Conditions(motions=[MOTION], every=EVERY),
        workers=1,
        progress=False,
    )
    chosen = found.choose(tolerance=tolerance, load=0.75)
    assert chosen, chosen
    program, truth = hl.compile(scene, **chosen.options), reference(scene, MOTION)
    log, cycles = run_on_the_uno(program, LedHandle(MOTION))
    assert log.fault is None and not log.gap.any()
    error, promised = error_of(log, truth), chosen.row.err_max * truth.peak
    load = cycles / CYCLES_PER_SECOND / program.T
    print(f"\n{chosen}\n  measured: error {error / truth.peak:.2%}, load {load:.1%}")
    assert error <= tolerance * truth.peak
    assert scene.values["K"] * COUNT < 0.05 * promised  # what the sensor adds is no part of the tolerance
    assert error == pytest.approx(promised, rel=0.1)
    assert load == pytest.approx(chosen.row.load, rel=0.1)
