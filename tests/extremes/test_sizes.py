"""Masses, stiffnesses and periods at the ends of their range: what survives, what is refused, what stops with a fault."""

import math

import mpmath as mp
import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab import n, t, v, x
from hapticlab.compiler.engines.engine import load
from hapticlab.errors import HapticlabError, ProgramError, SceneError

z = hl.coordinate("z", unit="m")
m, b, K = hl.parameters("m b K", units="kg N*s/m N/m", values=(0.05, 1.0, 500.0))
k, x_o = hl.parameters("k x_o", units="N/m m", values=(100.0, 0.0))
F_c = K * (x(t) - z) + b * (v(t) - z.diff(t))
MASS = hl.Scene(force=F_c, eom=[sp.Eq(m * z.diff(t, 2), F_c)], name="mass")
WALL = hl.Scene(force=hl.when(x(n) >= x_o, k * (x(n) - x_o)), name="wall")
HELD = 0.01  #: [m], where the handle is held


def paddle(T=1e-3, **constants):
    return hl.SimulatedPaddle(**{"m": 0.05, "b": 0.5, "T": T, "hand": hl.Hand(push=1.0, k=100, b=2)} | constants)


def coupler_force(times, mass, damping, stiffness):
    """Return F of a mass that a coupler pulls to a handle held at 1 cm, from rest at 0, to 40 digits."""
    with mp.workdps(40):
        mass, damping, stiffness = map(mp.mpf, (mass, damping, stiffness))
        root = mp.sqrt(mp.mpc(damping**2 - 4 * mass * stiffness))
        s1, s2 = (-damping + root) / (2 * mass), (-damping - root) / (2 * mass)
        A = HELD * s2 / (s2 - s1)  # of the gap x - z, which starts at 1 cm with rate 0

        def gap(tau, rate):
            return A * s1**rate * mp.exp(s1 * tau) + (HELD - A) * s2**rate * mp.exp(s2 * tau)

        return np.array([float(mp.re(stiffness * gap(t, 0) + damping * gap(t, 1))) for t in map(mp.mpf, times)])


def held_force(T, ticks, dtype="float64", **values):
    program = hl.compile(MASS(**values), "exact", T=T, dtype=dtype, live=())
    return load(program).run(ticks, np.full(ticks, HELD)).outputs[:, 0, 0]


# survive: the exact map is stable at any stiffness, and right


@pytest.mark.parametrize(
    "mass, damping, stiffness",
    [
        (1e-12, 1.0, 500.0),
        (1e-6, 1.0, 500.0),
        (1e12, 1.0, 500.0),
        (1e-12, 1e-9, 1e-3),
        (1e12, 1e9, 1e-6),
        (0.05, 1.0, 1e12),
        (0.05, 1e12, 500.0),
        (1e-12, 1e-6, 1e12),
        (0.05, 1e-12, 1e9),
    ],
)
@pytest.mark.always("1e-12-1.0-500.0", "0.05-1e-12-*", "0.05-1000000000000.0-500.0")
def test_a_mass_on_a_coupler_of_any_size_is_exact(mass, damping, stiffness):
    """What is left is rounding: of the rates that the exponential is squared up from, and of the angle turned."""
    ticks = 40
    times = 1e-3 * np.arange(ticks)
    exact = coupler_force(times, mass, damping, stiffness)
    turned = math.sqrt(stiffness / mass) * times[-1] if damping**2 < 4 * mass * stiffness else 1e-3 * damping / mass
    found = held_force(1e-3, ticks, m=mass, b=damping, K=stiffness)
    assert np.abs(found - exact).max() <= (1e-13 + 4e-16 * turned) * stiffness * HELD


@pytest.mark.parametrize("T", [1e-5, 1e-4, 1e-3, 1e-2, 0.1])
@pytest.mark.always("1e-05", "0.1")
def test_periods_from_10_us_to_100_ms_are_exact(T):
    ticks = 50
    exact = coupler_force(T * np.arange(ticks), 0.05, 1.0, 500.0)
    np.testing.assert_allclose(held_force(T, ticks), exact, rtol=0, atol=1e-12)
    np.testing.assert_allclose(held_force(T, ticks, "float32"), exact, rtol=0, atol=3e-5)


@pytest.mark.parametrize("dtype", ["float32", "float64"])
def test_a_mass_of_a_billion_tonnes_stays_where_it_is(dtype):
    log = paddle().run(MASS(m=1e12), duration=0.5, method="rk4", dtype=dtype)
    wall = paddle().run(hl.Scene(force=K * x(n) + b * v(n)), duration=0.5, dtype=dtype)
    assert log.fault is None
    np.testing.assert_allclose(log.F, wall.F, rtol=1e-5, atol=1e-6)


@pytest.mark.parametrize("dtype, stiffness", [("float32", 3.4e38), ("float64", 1.7e308)])
def test_a_wall_as_stiff_as_numbers_go_saturates_the_motor_and_no_more(dtype, stiffness):
    log = paddle(force_max=4.0).run(WALL(k=stiffness), duration=0.5, dtype=dtype)
    assert log.fault is None and log.saturated.any() and np.isfinite(log.x).all()
    assert set(np.unique(log.F)) <= {0.0, 4.0}


def test_a_filter_decays_through_the_denormals_to_zero_on_every_engine():
    """Halving is exact down to 2^-149, whose half rounds to 0: no engine flushes denormals."""
    y = hl.signal("y", unit="m", initial=1)
    program = hl.compile(hl.Scene(force=k * y(n), eom=[sp.Eq(y(n), y(n - 1) / 2)])(k=1.0), T=1e-3)
    exact = [np.float32(2.0 ** -(i + 1)) if i < 149 else 0.0 for i in range(160)]
    for engine in ("interpreter", "vm", "auto"):
        found = load(program, engine).run(160, np.zeros((160, len(program.inputs)))).outputs[:, 0, 0]
        assert found.tolist() == exact, engine


@pytest.mark.parametrize(
    "constants",
    [
        dict(m=1e-12),
        dict(m=1e12),
        dict(b=1e12),
        dict(hand=hl.Hand(k=1e12)),
        dict(coulomb=1e12),
        dict(hand=hl.Hand(b=1e15)),
        dict(counts_per_metre=1e12),
        dict(counts_per_metre=1e-12),
        dict(force_max=1e-12),
        dict(m=1e-12, hand=hl.Hand(k=1e12)),
    ],
)
def test_a_paddle_of_any_size_stays_finite(constants):
    log = paddle(**constants).run(WALL(k=50), duration=0.2, x=1e-3)
    assert log.fault is None
    assert np.isfinite(log.F).all() and np.isfinite(log.x).all() and np.abs(log.x).max() < 10


# refused at build, by name


@pytest.mark.parametrize(
    "values, words",
    [
        (dict(m=0), r"m = 0 kg; a mass needs m > 0"),
        (dict(m=-1e-9), r"m = -1e-09 kg; a mass needs m > 0"),
        (dict(m=math.nan), "m = nan; needs a finite number in kg"),
        (dict(K=math.inf), "K = inf; needs a finite number"),
        (dict(K=-1), "K = -1 N/m; a stiffness needs K >= 0"),
        (dict(b="2 kg"), "b = '2 kg'; needs a quantity in N[*]s/m"),
        (dict(K=10**400), "K = a number above 1e308; needs a number in N/m"),
    ],
)
def test_a_value_out_of_its_range_is_refused_where_it_is_bound(values, words):
    with pytest.raises(SceneError, match=words):
        MASS(**values)


@pytest.mark.parametrize(
    "values, options, words",
    [
        (dict(K=1e39), {}, "K = 1e[+]39 is inf in float32; use units of a smaller scale or dtype='float64'"),
        (dict(m=1e-40), {}, "m = 1e-40 is without its digits in float32"),
        (dict(m=5e-324), dict(dtype="float64"), "without its digits in float64"),
        (
            dict(m=1e-300),
            dict(dtype="float64", method="exact", live=()),
            "rates of z are .* above 1e[+]150.*Check the masses",
        ),
        (
            dict(m=1e-12),
            dict(method="taylor"),
            r"omega = .* rad/s.*needs at most 1. Use a shorter T or, for what is linear",
        ),
        (dict(K=1e5), dict(method="taylor"), r"omega = 1414 rad/s.*Use substeps=2$"),
        (dict(), dict(T=0), "T = 0 s; a sampling period needs T > 0"),
        (dict(), dict(T=-1e-3), "T = -0.001 s"),
        (dict(), dict(T=math.nan), "T = nan s"),
        (dict(), dict(T=1e-320), "T = .* is 0 in float32"),
        (dict(), dict(T=1e300), "T = 1e[+]300 s is inf in float32"),
        (dict(), dict(substeps=10**9), "a period has at most 50000. Use fewer substeps"),
    ],
)
def test_a_size_that_no_program_can_have_is_refused_when_it_is_compiled(values, options, words):
    with pytest.raises((ProgramError, SceneError), match=words):
        hl.compile(MASS(**values), **{"T": 1e-3, **options})


@pytest.mark.parametrize(
    "constants",
    [
        dict(m=0.0),
        dict(m=math.nan),
        dict(b=-1e-9),
        dict(T=0.0),
        dict(delay=-1e-3),
        dict(delay=1e3),
        dict(force_max=0.0),
        dict(counts_per_metre=1e300),
        dict(counts_per_metre=0.0),
        dict(m=1e-12, coulomb=0.1),
        dict(noise=-1.0),
        dict(T=math.inf),
    ],
)
def test_a_paddle_that_cannot_be_is_refused(constants):
    with pytest.raises(HapticlabError, match=next(iter(constants))):
        paddle(**constants).run(WALL, duration=0.01)


# stops with a named fault, and the motor off


@pytest.mark.parametrize(
    "scene, method",
    [
        (MASS(m=1e-12), "rk4"),
        (MASS(m=1e-12), "verlet"),
        (MASS(b=1e9), "rk4"),
        (MASS(K=1e30), "euler"),
        (MASS(K=3e38), "semi_implicit_euler"),
    ],
)
def test_what_a_step_makes_infinite_stops_with_the_motor_off(scene, method):
    log = paddle(force_max=4.0).run(scene, duration=0.3, method=method)
    assert "was not finite; the motor is off from then on" in log.fault
    first = int(log.fault.split()[1])
    assert not log.F[first:].any() and np.isfinite(log.F).all() and np.abs(log.F).max() <= 4.0
    assert np.isfinite(log.x).all()
