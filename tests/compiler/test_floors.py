"""The C that the benchmark compares with computes the same numbers as the compiled programs: the comparison is of equals."""

import importlib
from pathlib import Path

import numpy as np
import pytest

from hapticlab.compiler.engines.engine import load

BENCHMARKS = Path(__file__).parents[1] / "benchmarks"


@pytest.fixture
def bench(monkeypatch):
    monkeypatch.syspath_prepend(BENCHMARKS)
    return importlib.import_module("scenes"), importlib.import_module("floors")


@pytest.mark.wide
@pytest.mark.parametrize(("name", "columns"), [("coupler", 2), ("pendulum", 1)])
def test_a_step_by_hand_and_a_compiled_step_agree(bench, name, columns):
    scenes, floors = bench
    inputs = np.ascontiguousarray(scenes.handle(300)[:, :columns])
    program = scenes.compiled(getattr(scenes, name)())
    known = getattr(scenes, name.upper())
    values = [known[c.name] for c in program.parameters]
    by_hand, force = floors.stepper(name, inputs, values, scenes.T)
    by_hand()
    assert np.ptp(force) > 0.01  # [N]; the scene moved
    compiled = load(program).run(300, inputs, values).outputs[:, 0, 0]
    assert np.abs(compiled - force).max() < 1e-12 * np.abs(force).max()
