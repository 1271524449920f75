"""The bookkeeping of a sweep, in arrays, against one paddle made for every point."""

import itertools
import pickle
import tracemalloc
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.analysis.sweeps import sweep_chunks
from hapticlab.analysis.sweeps.sweep_grid import PADDLE_AXES, Grid
from hapticlab.analysis.sweeps.sweep_plan import Plan

HANDS = {
    "no hand": None,
    "holding": hl.Hand(m=0.02, b=0.4, k=80.0, push=0.3),
    "moving": hl.Hand(b=0.2, k=50.0, intent=np.sin),
}
#: delays on both sides of whole samples of either T; no friction, and some
AXES = {
    "k": np.array([50.0, 200.0]),
    "delay": np.array([0.0, 4e-4, 1e-3, 1.3e-3, 2e-3]),
    "b": np.array([0.1, 60.0]),
    "T": np.array([1e-3, 5e-4]),
    "x": np.array([0.0, 1e-3]),
    "coulomb": np.array([0.0, 0.05]),
    "m": np.array([0.03, 0.2]),
}
MORE = {
    "force_max": np.array([3.0, 8.0]),
    "noise": np.array([0.0, 1e-5]),
    "counts_per_metre": np.array([2e4, 5e4]),
    "v": np.array([0.0, 0.2, 0.5]),
    "delay": np.array([0.0, 4e-4]),
}


def plan_of(paddle, axes, **options):
    starts = {"x": -1e-4, "v": 0.05}
    return Plan(hl.wall()(x_o=0.0, k=70.0), Grid(paddle, axes), starts, options, 0.05, "energy", "auto")


def one_by_one(plan, paddle):
    """Yield every point's values by name and a paddle made for it, in the order of the result."""
    names = list(plan.grid.axes)
    for values in itertools.product(*(a.tolist() for a in plan.grid.axes.values())):
        here = dict(zip(names, values, strict=True))
        yield here, replace(paddle, **{name: a for name, a in here.items() if name in PADDLE_AXES})


def program_of(plan, points):
    """Return what is asked of a linked program: the names of its first parameters, and a value for each."""
    program = plan._program(points)
    return SimpleNamespace(parameters=program.parameters, values=(*program.values, *points.paddle.plant_values()))


@pytest.mark.parametrize("axes", [AXES, MORE], ids=["AXES", "MORE"])
@pytest.mark.parametrize("hand", HANDS.values(), ids=HANDS)
@pytest.mark.always("holding-MORE")
def test_every_point_has_the_parameters_of_its_own_paddle(axes, hand):
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hand, counts_per_metre=1e4, force_max=5.0)
    plan = plan_of(paddle, axes)
    expected = list(one_by_one(plan, paddle))
    met = np.zeros(plan.grid.points, int)
    for points in plan.groups:
        program, cells = program_of(plan, points), plan.grid.cells(points, 0, len(points))
        met[cells] += 1
        found = points.parameters(program, plan.starts, 0, len(points))
        counts = np.broadcast_to(points.count(0, len(points)), len(points))
        for column, count, (here, one) in zip(found.T, counts, (expected[cell] for cell in cells), strict=True):
            start = [here.get(name, plan.starts[name]) for name in "xv"]
            scene = [here.get(c.name, plan.scene.values[c.name]) for c in plan._program(points).parameters]
            assert (one.T, one.structure, one.noise) == (points.paddle.T, points.paddle.structure, points.paddle.noise)
            np.testing.assert_array_equal(column, [*scene, *one.plant_values(*start)])
            assert count == 1 / one.counts_per_metre
    assert (met == 1).all()
    kinds = {(one.T, repr(one.structure), one.noise) for _, one in expected}
    assert len(plan.groups) == len(kinds)  # no program is compiled twice


def test_a_cut_has_the_same_points():
    plan = plan_of(hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3), AXES)
    random = np.random.default_rng(3)
    for points in plan.groups:
        program = program_of(plan, points)
        whole = points.parameters(program, plan.starts, 0, len(points))
        for first, stop in np.sort(random.integers(0, len(points) + 1, (10, 2)), axis=1):
            if first < stop:
                part, at = points.cut(first, stop)
                got = part.parameters(program, plan.starts, at, at + stop - first)
                np.testing.assert_array_equal(got, whole[:, first:stop])


def test_values_out_of_range_are_found_at_either_end_of_an_axis():
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3)
    with pytest.raises(hl.errors.PaddleError, match="m = 0 kg"):
        Grid(paddle, {"m": np.array([0.1, 0.0, 0.2])})
    with pytest.raises(hl.errors.PaddleError, match="delay = -0.001"):
        Grid(paddle, {"delay": np.array([1e-3, -1e-3])})
    with pytest.raises(hl.errors.PaddleError, match="delay = 0.6 s is 6000 samples"):
        Grid(paddle, {"delay": np.array([0.0, 0.6]), "T": np.array([1e-3, 1e-4])})


@pytest.mark.parametrize("axes", [{"k": 10**6}, {"m": 1000, "b": 1000}, {"delay": 1000, "k": 1000}], ids=str)
@pytest.mark.always("{'k'*", "{'m'*")
def test_a_chunk_of_a_million_points_is_small_and_so_is_what_lays_them_out(axes):
    values = {name: np.linspace(*{"delay": (0, 3e-3)}.get(name, (1, 2)), n) for name, n in axes.items()}
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, noise=1e-5)
    tracemalloc.start()
    plan = plan_of(paddle, values)
    parts = list(plan.chunks([], 1))
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert sum(c.count for c in parts) == 10**6
    # its program, two kilobytes, and the values in use of each axis, 8 bytes each: never one value a point and parameter
    longest = max(len(pickle.dumps(c)) - 8 * sum(map(len, c.points.axes.values())) for c in parts)
    assert longest < 30_000
    assert max(sum(map(len, c.points.axes.values())) for c in parts) <= sweep_chunks.MOST + 1000
    assert peak < 40e6  # a paddle for each would take ten times as much
