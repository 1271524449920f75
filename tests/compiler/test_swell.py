"""Pendulums from their Lagrangian: accelerations in closed form, and operations that do not swell with the links."""

import importlib
from pathlib import Path

import numpy as np
import pytest

BENCHMARKS = Path(__file__).parents[1] / "benchmarks"
pytest.importorskip("llvmlite")
#: 1.1 times the operations of CasADi's SX at 8 links, M, f and its LDL^T after its cse, as modelling.py counts them
MOST = {"absolute": 1.1 * 959, "relative": 1.1 * 1239, "cart": 1.1 * 1098}


@pytest.fixture
def peers(monkeypatch):
    monkeypatch.syspath_prepend(BENCHMARKS)
    return importlib.import_module("modelling_peers")


@pytest.mark.parametrize("kind", MOST)
@pytest.mark.parametrize("links", [1, 3, 8])
@pytest.mark.always("1-*", "3-*")
def test_the_accelerations_of_a_pendulum(peers, links, kind):
    model = peers.Pendulum(links, kind)
    made, wanted = peers.hapticlab(model), model.reference()
    # read from one Euler step of 0.1 ms, whose rates round at 2e-16 / 1e-4
    np.testing.assert_allclose(model.absolute(made.accelerations()), wanted, rtol=0, atol=1e-10 * np.abs(wanted).max())
    if links == 8:
        total, moving = made.operations()
        assert moving < total <= MOST[kind]
