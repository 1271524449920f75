"""Expressions at their edges: boundaries hit exactly, branches that are missing or overlap, roots, quotients, and sheer size."""

import math

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import n, t, x
from hapticlab.compiler.engines.engine import load
from hapticlab.errors import HapticlabError, MassError, ProgramError, SceneError, UnitsError

k, x_o, F0 = hl.parameters("k x_o F0", units="N/m m N", values=(100.0, 0.01, 1.0))
m, g, l = hl.parameters("m g l", units="kg m/s^2 m", values=(0.1, 9.81, 0.1))
q, p = hl.coordinate("q", unit="m"), hl.coordinate("p", unit="m")
u = x(n) / x_o
ENGINES = ("interpreter", "vm", "auto")


def felt(force, at, engine="auto", dtype="float32", **values):
    program = hl.compile(hl.Scene(force=force)(**values), T=1e-3, dtype=dtype)
    at = np.atleast_1d(np.asarray(at, float))
    handle = np.zeros((len(at), len(program.inputs)))
    handle[:, 0] = at
    return load(program, engine).run(len(at), handle).outputs[:, 0, 0]


def run(force, **options):
    paddle = hl.SimulatedPaddle(m=0.05, b=0.5, T=1e-3, hand=hl.Hand(push=1.0, k=100, b=2))
    return paddle.run(hl.Scene(force=force), **{"duration": 0.2, "x": 0.0, **options})


# a boundary belongs to the side that is written


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("relation, on", [(sp.Ge, 1.0), (sp.Gt, 0.0), (sp.Le, 1.0), (sp.Lt, 0.0), (sp.Eq, 1.0), (sp.Ne, 0.0)])
def test_a_boundary_hit_exactly_and_one_number_beside_it(engine, relation, on):
    edge = np.float32(0.01)
    below, above = np.nextafter(edge, np.float32(0)), np.nextafter(edge, np.float32(1))
    found = felt(hl.when(relation(x(n), x_o), F0, 0 * F0), [below, edge, above], engine)
    sides = {sp.Ge: (0, 1), sp.Gt: (0, 1), sp.Le: (1, 0), sp.Lt: (1, 0), sp.Eq: (0, 0), sp.Ne: (1, 1)}[relation]
    assert found.tolist() == [sides[0], on, sides[1]]


def test_of_overlapping_branches_the_first_counts():
    force = sp.Piecewise((F0, x(n) > 0), (2 * F0, x(n) > -x_o), (3 * F0, True))
    assert felt(force, [0.005, 0.0, -0.005, -0.01, -0.02]).tolist() == [1, 2, 2, 3, 3]


@pytest.mark.parametrize(
    "branches",
    [
        [(k * x(n), x(n) > x_o)],
        [(k * x(n), x(n) > x_o), (-k * x(n), x(n) < 0)],
        [(k * x(n), x(n) > x_o), (-k * x(n), x(n) < x_o)],
    ],
)
def test_branches_that_leave_a_gap_are_refused(branches):
    with pytest.raises(ProgramError, match="has no case for when .* fails; add .value, True., or use hl.when"):
        felt(sp.Piecewise(*branches), 0.0)


def test_a_heaviside_is_a_half_at_its_edge_on_every_engine():
    for engine in ENGINES:
        assert felt(F0 * sp.Heaviside(u), [-1e-30, 0.0, -0.0, 1e-30], engine).tolist() == [0, 0.5, 0.5, 1]


# what is no number at some place is a fault there; an arm that is not chosen is none


@pytest.mark.parametrize(
    "force, dtype",
    [
        (F0 * sp.sqrt(u**2 - 1), "float32"),
        (F0 * sp.sqrt(u - sp.Float(1e-18)), "float64"),
        (F0 * sp.acos(1 + u + sp.Float(3e-16)), "float64"),
        (F0 / u, "float32"),
        (F0 * sp.log(u), "float32"),
        (F0 * sp.exp(u) ** 1000 / u, "float64"),
        (F0 * (u - 1) ** sp.Rational(3, 2), "float32"),
        (F0 * sp.atan(1 / u) / u, "float32"),
        (F0 * u**n, "float32"),
    ],
)
def test_no_number_at_the_start_stops_the_motor_in_the_first_tick(force, dtype):
    log = run(force, dtype=dtype)
    assert log.fault.startswith("tick 0 (t = 0 s): the force F of scene was not finite; the motor is off")
    assert not log.F.any() and np.isfinite(log.x).all()


def test_an_overflow_on_the_way_stops_the_motor_there():
    """e^(u / 50) passes the largest float32 where u = 50 ln(3.4e38)."""
    force = F0 * sp.exp(u / 50) / 1e6
    edge = 0.01 * 50 * math.log(float(np.finfo(np.float32).max))
    assert np.isfinite(felt(force, 0.999 * edge)).all() and not np.isfinite(felt(force, 1.001 * edge)).any()
    log = hl.SimulatedPaddle(m=0.05, b=0, T=1e-3).run(hl.Scene(force=0 * k * x(n) + force), x=1.1 * edge, duration=0.01)
    assert log.fault.startswith("tick 0 ") and not log.F.any()


@pytest.mark.parametrize(
    "guarded",
    [
        hl.when(u > 1, F0 * sp.sqrt(u**2 - 1)),
        F0 * sp.sqrt(sp.Max(0, u**2 - 1)),
        hl.when(sp.Abs(u) > 0, F0 * sp.sin(u) / u, F0),
        hl.when(u > 0, F0 * sp.log(1 + u)),
        F0 * sp.acos(sp.Min(1, sp.Max(-1, 1 + u**2))),
    ],
)
def test_a_guarded_root_or_quotient_survives(guarded):
    log = run(guarded)
    assert log.fault is None and np.isfinite(log.F).all()
    for engine in ENGINES:
        assert np.isfinite(felt(guarded, [-1.0, -1e-45, -0.0, 0.0, 1e-45, 1e-30, 0.01, 1.0], engine)).all()


def test_a_watched_channel_that_is_no_number_is_a_fault_in_its_tick():
    scene = hl.Scene(force=k * x(n), watch={"depth": F0 * sp.sqrt(1 - u)})
    log = hl.SimulatedPaddle(m=0.05, b=0.5, T=1e-3, hand=hl.Hand(push=1.0)).run(scene(k=0.0), duration=0.2)
    first = int(np.argmax(log.x > np.float32(0.01)))
    assert first > 0 and log.fault.startswith(f"tick {first} ") and "the watched depth of scene" in log.fault


# refused where it is written


@pytest.mark.parametrize(
    "force",
    [
        k * x(n) * sp.I,
        k * x(n) * sp.oo,
        k * x(n) * sp.nan,
        k * x(n) * sp.zoo,
        k * sp.sqrt(-(x(n) ** 2)),
        F0 * sp.acos(sp.Integer(2)),
        F0 * sp.log(sp.Integer(-1)),
    ],
)
def test_what_is_no_real_number_is_refused(force):
    with pytest.raises(HapticlabError, match="is not a real number; only"):
        felt(force, 0.0)


def test_a_sine_of_a_length_is_refused_by_its_unit():
    with pytest.raises(UnitsError, match=r"sin needs a number without unit, but x\(n\) is in m;"):
        hl.Scene(force=F0 * sp.sin(x(n)))


@pytest.mark.parametrize(
    "equations, words",
    [
        ([0 * q.diff(t, 2) - F0], "q"),
        (
            [sp.Eq(m * q.diff(t, 2) + m * p.diff(t, 2), F0), sp.Eq(m * q.diff(t, 2) + m * p.diff(t, 2), -F0)],
            "singular mass.*each its own mass",
        ),
        ([sp.Eq(m * q.diff(t, 2), m * p.diff(t, 2))], "p"),
    ],
)
def test_equations_that_leave_an_acceleration_open_are_refused(equations, words):
    equations = [e if isinstance(e, sp.Eq) else sp.Eq(e, 0) for e in equations]
    with pytest.raises(HapticlabError, match=words):
        hl.compile(hl.Scene(force=k * q, eom=equations, watch=[q, p] if len(equations) == 2 else [q]), T=1e-3)


def test_a_massless_link_is_refused_by_name():
    with pytest.raises(MassError, match="p"):
        hl.compile(
            hl.Scene(force=k * q, eom=[hl.mechanics.lagrange(m * q.diff(t) ** 2 / 2 - k * (q - p) ** 2 / 2)], watch=[p]), T=1e-3
        )


def test_a_mass_that_is_gone_stops_the_motor():
    """m (1 - p/l) p'' = F0, and p starts at l."""
    start = hl.coordinate("start", unit="m", initial=l)
    scene = hl.Scene(force=k * start, eom=[sp.Eq(m * (1 - start / l) * start.diff(t, 2), F0)])
    log = hl.SimulatedPaddle(m=0.05, b=0.5, T=1e-3).run(scene, duration=0.1)
    assert log.fault.startswith("tick 0 ") and "the state" in log.fault and not log.F.any()


# sheer size


def polynomial(terms):
    """Return a sum of as many different powers, as sympy leaves it where nothing is evaluated."""
    powers = [sp.Mul(i, sp.Pow(u, i, evaluate=False), evaluate=False) for i in map(sp.Integer, range(2, terms + 2))]
    return sp.Mul(F0, sp.Add(*powers, evaluate=False), evaluate=False)


@pytest.mark.wide
@pytest.mark.parametrize("terms", [34_000, pytest.param(100_000, marks=pytest.mark.slow)])
def test_sums_that_no_program_can_hold_are_refused_before_they_are_looked_into(terms):
    with pytest.raises(SceneError, match="more than 100000 different parts.*fewer terms"):
        hl.Scene(force=polynomial(terms))


def test_a_power_of_a_hundred_thousand_is_short():
    program = hl.compile(hl.Scene(force=F0 * (1 + u / 1e6) ** 100_000), T=1e-3, dtype="float64")
    assert len(program) < 60
    assert load(program).run(1, [[0.02]]).outputs[0, 0, 0] == pytest.approx((1 + 2e-6) ** 100_000, rel=1e-10)


@pytest.mark.wide
def test_a_nest_too_deep_says_how_to_write_it():
    deep = x(n)
    for _ in range(300):
        deep = hl.laws.delay(deep)
    with pytest.raises(ProgramError, match="nested too deeply to compile. Name its parts as signals"):
        hl.compile(hl.Scene(force=k * deep), T=1e-3)


def test_a_hundred_walls_in_a_row_are_one_program():
    force = sum((hl.when(x(n) > x_o * i, F0) for i in range(100)), 0 * F0)
    assert felt(force, [0.0, 0.005, 0.995, 10.0]).tolist() == [0, 1, 100, 100]
