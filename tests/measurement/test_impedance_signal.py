"""What a scene adds to its force is the signal asked for, tick by tick, in both precisions."""

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.compiler.boards.cost import cost
from hapticlab.compiler.engines.engine import load
from hapticlab.measurement.guard import guarded
from hapticlab.measurement.impedance_signal import Signal

T = 1e-3


def shaken(how, lines, dtype, periods=3, samples=200):
    excitation = Signal(how, np.array(lines), samples, T, 0.3, seed=4)
    program = hl.compile(excitation.beside(hl.wall()(k=100.0, x_o=0.0), 0.25), T=T, dtype=dtype)
    outputs = load(program).run(periods * samples, np.full((periods * samples, 1), 0.01)).outputs[:, :, 0]
    names = [c.name for c in program.outputs]
    return excitation, outputs[:, names.index("F")], outputs[:, names.index("own")]


@pytest.mark.parametrize(
    ("how", "lines", "dtype", "off"),
    [
        ("multisine", [1, 3, 7, 41], "float64", 1e-13),
        ("multisine", [1, 3, 7, 41], "float32", 2e-5),  # 200 turns of a pointer, each rounded
        ("swept_sine", range(2, 60), "float64", 1e-12),
        ("swept_sine", range(2, 60), "float32", 2e-5),
    ],
)
def test_the_motor_adds_the_signal_and_a_pull(how, lines, dtype, off):
    excitation, F, own = shaken(how, list(lines), dtype)
    assert own == pytest.approx(1.0, rel=1e-6)  # 100 N/m at 10 mm
    assert F - own + 0.25 == pytest.approx(np.tile(excitation.period, 3), abs=off)
    assert np.array_equal(F[:200], F[200:400])  # every period the same bits: no leakage from rounding
    assert np.array_equal(F[:200], F[400:])


def test_the_guard_fits_the_slowest_board_and_a_short_multisine_too_at_half_the_rate():
    wall = hl.wall("ellis")(k=100.0, x_o=0.0)
    assert cost(hl.compile(guarded(wall, energy_max=0.05, speed_max=1.0), T=T), board="uno").fits
    short = Signal("multisine", np.array([3, 9, 21]), 500, 2e-3, 0.3, seed=0).beside(hl.wall()(k=100.0, x_o=0.0), 0.2)
    assert cost(hl.compile(short, T=2e-3), board="uno").fits
