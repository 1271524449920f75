"""Pendulums from their Lagrangian: accelerations in closed form, and operations that do not swell with the links.

And the compiler's own work, which does not swell with the comparisons of a motion.
"""

import cProfile
import importlib
from pathlib import Path

import numpy as np
import pytest

import hapticlab as hl

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
@pytest.mark.always("1-*")
def test_the_accelerations_of_a_pendulum(peers, links, kind):
    model = peers.Pendulum(links, kind)
    made, wanted = peers.hapticlab(model), model.reference()
    # read from one Euler step of 0.1 ms, whose rates round at 2e-16 / 1e-4
    np.testing.assert_allclose(model.absolute(made.accelerations()), wanted, rtol=0, atol=1e-10 * np.abs(wanted).max())
    if links == 8:
        total, moving = made.operations()
        assert moving < total <= MOST[kind]


def calls_of(make):
    """What is made, and how many calls of Python functions that takes: the same number on every machine."""
    profile = cProfile.Profile()
    made = profile.runcall(make)
    return made, sum(entry.callcount for entry in profile.getstats())


def boxes(count):
    """Boxes that fall on the ground and on each other, the first of them turning."""
    m, g, J = hl.parameters("m g J", units="kg m/s^2 kg*m^2", values=(0.1, 9.81, 1e-4))
    bodies, L = [hl.shapes.ground()], 0
    for k in range(count):
        X = hl.coordinate(f"X{k}", unit="m", initial=0.1 * k)
        Y = hl.coordinate(f"Y{k}", unit="m", initial=0.05)
        turn = hl.coordinate(f"A{k}", unit="rad", initial=0.1) if k == 0 else 0
        L += m * (X.diff(hl.t) ** 2 + Y.diff(hl.t) ** 2) / 2 - m * g * Y + (J * turn.diff(hl.t) ** 2 / 2 if k == 0 else 0)
        bodies.append(hl.shapes.Box("40 mm", "30 mm").at(x=X, y=Y, angle=turn, name=f"box{k}"))
    contacts = hl.contact.between(bodies, contact_law=hl.contact.penalty(k="2000 N/m", b="1 N*s/m"), method="sample")
    return hl.Scene(force=0, eom=[hl.mechanics.lagrange(L, contacts=contacts)], watch=[X, Y])


def test_the_work_of_compiling_boxes_grows_as_their_program():
    """Two boxes compare 120 numbers. A walk through the program for each two of them took 84000 calls an instruction."""
    scenes = [boxes(1), boxes(2)]
    hl.compile(scenes[0], "semi_implicit_euler", T=5e-4)  # what is imported on first use
    (one, few), (two, many) = (calls_of(lambda scene=scene: hl.compile(scene, "semi_implicit_euler", T=1e-3)) for scene in scenes)
    assert many < 1500 * len(two)
    assert many / few < 2 * len(two) / len(one)
