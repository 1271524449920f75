"""The three figures of a design against numbers computed apart from it, and the exact reason where it is not feasible."""

import dataclasses
import math

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab.analysis.budget import measured as module
from hapticlab.analysis.budget.front import DesignFront
from hapticlab.compiler.engines.engine import load

PLAIN = {"T": 1e-3, "law": "zoh", "velocity": "backward"}
RK4 = {"method": "rk4", "T": 2e-3, "substeps": 1, "hold": "soh"}


def task(name, encoder=50_000, **constants):
    return hl.design.task(name, paddle=dataclasses.replace(hl.design.textbook, counts_per_metre=encoder), **constants)


@pytest.mark.always("0.001-0.002")
@pytest.mark.parametrize(("T", "tau"), [(1e-3, 2e-3), (5e-4, 8e-3), (2e-3, 1e-3)])
def test_margin_of_a_filtered_wall_is_that_of_the_formula(T, tau):
    found = hl.design.measured(task("wall", K=400, B=1.5), {"T": T, "law": "zoh", "velocity": "filtered", "tau": tau})
    assert found.margin == pytest.approx(1.0 - 400 * T / 2 - 1.5 / (1 + 2 * tau / T), abs=2e-3)


@pytest.mark.always("None-0.001")
@pytest.mark.parametrize(("encoder", "T"), [(None, 1e-3), (5_000, 1e-3), (None, 5e-4)])
def test_error_of_a_spring_is_that_of_its_held_samples(encoder, T):
    """A spring that is held: K times the motion since the sample, and with an encoder K times the missing part of a count."""
    K, per = 300.0, 100
    motion = hl.methods.HandleMotion("push", 0.01 * sp.sin(7 * hl.t), 0.8)
    stiffness = hl.parameters("K", units="N/m", values=K)
    paddle = dataclasses.replace(hl.design.textbook, counts_per_metre=encoder)
    spring = hl.design.Task("spring", hl.Scene(force=stiffness * hl.x(hl.n)), motion, paddle=paddle)
    found = hl.design.measured(spring, {"method": "rk4", "T": T, "hold": "soh"})
    true, x = (0.01 * np.sin(7 * T * (np.arange(round(0.8 / T) * many) + part) / many) for many, part in ((1, 0), (per, 0.5)))
    seen = true if encoder is None else np.floor(true * encoder) / encoder
    error, peak = K * (np.repeat(seen, per) - x), K * np.abs(x).max()
    assert found.error == pytest.approx(100 * np.sqrt(np.mean(error**2)) / peak, rel=5e-3)
    floor = 100 * K * np.sqrt(np.mean((seen - true) ** 2)) / peak
    assert found.sensor_floor == pytest.approx(floor, rel=2e-2)


def test_late_sensor_costs_what_a_late_force_does():
    found = []
    for late in ({"delay": 0.75e-3}, {"sensor_delay": 0.75e-3}):
        paddle = dataclasses.replace(hl.design.textbook, counts_per_metre=None, **late)
        found.append(hl.design.measured(hl.design.task("mass", paddle=paddle), {**RK4, "method": "verlet"}))
    assert found[1].error == pytest.approx(found[0].error, rel=0.02) and found[1].margin == found[0].margin
    assert found[0].error > 1.2 * hl.design.measured(task("mass", None), {**RK4, "method": "verlet"}).error


@pytest.mark.wide
def test_load_is_the_cycles_of_a_tick_in_those_of_a_period():
    wall = hl.design.task("wall")
    slow, quick = (hl.design.measured(wall, {**PLAIN, "T": T}).load for T in (2e-3, 1e-3))
    assert quick == pytest.approx(2 * slow, rel=1e-2), "the same cycles twice as often"
    assert 0 < slow < quick < 100


@pytest.mark.wide
def test_every_engine_gives_the_same_figures(monkeypatch):
    mass = task("mass", m=0.06)
    design = {"method": "verlet", "T": 2e-3, "substeps": 1, "hold": "foh"}
    usual = hl.design.measured(mass, design)
    module._measured.cache_clear()
    monkeypatch.setattr(module, "load", lambda program, engine: load(program, "interpreter"))
    assert hl.design.measured(mass, design) == usual


@pytest.mark.wide
def test_motor_limits_the_force():
    wall = hl.design.task("wall", K=600)
    weak = hl.design.task("wall", K=600, paddle=dataclasses.replace(hl.design.textbook, force_max=2.0))
    assert hl.design.measured(weak, PLAIN).error > 10 * hl.design.measured(wall, PLAIN).error


BAD = [
    ({**PLAIN, "T": math.nan}, "T is not a finite number; it needs one"),
    ({**PLAIN, "T": 10**400}, "T is not a finite number; it needs one"),
    ({**PLAIN, "T": 1.0}, "T = 1 s; it needs a whole number of 0.125 ms from 0.25 to 10 ms, in seconds: 1 ms is 0.001"),
    ({**PLAIN, "T": 1.05e-3}, "T = 0.00105 s; it needs a whole number of 0.125 ms from 0.25 to 10 ms, in seconds: 1 ms is 0.001"),
    ({**PLAIN, "T": -1e-3}, "T = -0.001 s; it needs a whole number of 0.125 ms from 0.25 to 10 ms, in seconds: 1 ms is 0.001"),
    ({**PLAIN, "T": "1 ms"}, "T is a text; it needs a number"),
    ({**PLAIN, "T": True}, "T is True or False; it needs a number"),
    ({**PLAIN, "law": "best"}, "law is 'best'; it needs one of 'zoh', 'half_sample', 'backward_difference', 'ellis'"),
    ({**PLAIN, "law": ["zoh"]}, "law is a list; it needs one of 'zoh', 'half_sample', 'backward_difference', 'ellis'"),
    ({**PLAIN, "velocity": "filtered"}, "tau = 0 s; a filtered velocity needs 0 < tau <= 0.05 s"),
    ({**PLAIN, "method": "rk4"}, "'method' is not chosen in the task wall; its names are T, law, velocity, tau"),
    ({"T": 1e-3}, "law is missing; a design of the task wall gives T, law, velocity"),
    ("zoh", "a design is a dict of names and values, such as {'T': 0.001, ...}; this is a text"),
    (None, "a design is a dict of names and values, such as {'T': 0.001, ...}; this is None"),
]


@pytest.mark.parametrize(("design", "why"), BAD)
def test_what_is_no_design_says_exactly_why(design, why):
    found = hl.design.measured(hl.design.task("wall"), design)
    assert (found.why, found.feasible) == (why, False)
    assert str(found) == f"not feasible: {why}" and math.isnan(found.error)


@pytest.mark.parametrize(
    ("name", "change", "why"),
    [
        (
            "mass",
            {"method": "euler", "T": 1e-3},
            "it is unstable: euler is stable up to a step of 0.125 ms, and this step is 1 ms",
        ),
        ("mass", {"T": 2.5e-4}, "it does not fit the board: 0.78 ms of a 0.25 ms period on uno"),
        ("bumper", {"method": "taylor"}, "it does not fit the board: needs "),
        ("bumper", {}, "bumper: the contact lasts 14 ms"),
        ("mass", {"hold": "third"}, "hold is 'third'; it needs one of 'zoh', 'foh', 'soh'"),
        ("mass", {"substeps": 1.5}, "substeps = 1.5; it needs a whole number from 1 to 8"),
        ("mass", {"substeps": 1e9}, "substeps = 1e+09; it needs a whole number from 1 to 8"),
        ("mass", {"method": "exact", "substeps": 2}, "substeps = 2: method='exact' solves the whole period in one step"),
    ],
)
def test_design_that_cannot_run_says_exactly_why(name, change, why):
    assert hl.design.measured(hl.design.task(name), {**RK4, **change}).why.startswith(why)


def test_overload_still_tells_its_load():
    assert hl.design.measured(hl.design.task("mass"), {**RK4, "T": 2.5e-4}).load > 100


@pytest.mark.parametrize(
    ("name", "constants", "said"),
    [
        ("floor", {}, "task 'floor' does not exist; there are wall, mass, bumper"),
        ("wall", {"paddle": "hapkit"}, "paddle = 'hapkit'; a task needs a profile, such as hl.devices.profile('hapkit')"),
        ("wall", {"m": 1.0}, "the task wall has no constant m; it has K, B"),
        ("wall", {"K": math.nan}, "K = nan; the task wall needs a finite number > 0"),
    ],
)
def test_what_is_no_task_is_told(name, constants, said):
    with pytest.raises(hl.errors.AnalysisError) as problem:
        hl.design.task(name, **constants)
    assert said in str(problem.value)


def test_a_name_is_no_task_and_a_point_has_three_numbers():
    with pytest.raises(hl.errors.AnalysisError, match=r"needs a task, such as hl\.design\.task"):
        hl.design.measured("wall", PLAIN)
    with pytest.raises(hl.errors.AnalysisError, match="reference point A = .* needs three numbers"):
        hl.design.front(hl.design.task("wall"), {}, reference_points={"A": (0.3, 40.0)})


def test_front_is_what_no_other_design_dominates():
    """Against a search through all pairs, on figures drawn with many ties."""
    random = np.random.default_rng(5)
    figures = {f"d{k}": tuple(float(one) for one in random.integers(1, 5, 3)) for k in range(40)}
    designs = {name: module.MeasuredDesign({}, error, 0.0, load, margin) for name, (error, load, margin) in figures.items()}
    designs["none"] = module.MeasuredDesign({}, why="it does not run")
    found = DesignFront(hl.design.task("wall"), designs)
    beaten = {
        name
        for name, (error, load, margin) in figures.items()
        for e, l, m in figures.values()
        if e <= error and l <= load and m >= margin and (e < error or l < load or m > margin)
    }
    assert set(found.front) == set(figures) - beaten and 0 < len(found.front) < 40
    assert [designs[name].load for name in found.front] == sorted(designs[name].load for name in found.front)
    assert "none: not feasible: it does not run" in str(found)


@pytest.mark.wide
def test_figure_of_a_front_tells_what_it_shows():
    found = hl.design.front(hl.design.task("wall"), {"plain": PLAIN}, reference_points={"A": (0.5, 40.0, 0.1)})
    figure = found.plot()
    assert "reference point A: error 0.5 %, load 40 %, margin 0.1 N s/m" in figure.alt and "plain: error" in figure.alt
    assert [axes.get_ylabel() for axes in figure.axes] == ["error at the handle [%]", "passivity margin [N s/m]"]
