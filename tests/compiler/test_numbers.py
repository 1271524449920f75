"""Numbers that float32 does not have are refused where they enter a program; angles that time drives keep their digits."""

from dataclasses import replace
from fractions import Fraction

import mpmath as mp
import numpy as np
import pytest
import sympy as sp
from motions import at_tick

import hapticlab as hl
from hapticlab import T, n, t, v, x
from hapticlab.compiler.algebra.constants import entering
from hapticlab.compiler.algebra.phase import frequency
from hapticlab.compiler.engines.bytecode import encode, layout
from hapticlab.compiler.engines.engine import load
from hapticlab.errors import ParameterError, ProgramError

F0, u = hl.parameters("F0 u", units="N m", values=(1, 1))
k = hl.parameters("k", units="N/m", values=100)


def law(force, **options):
    return hl.compile(hl.Scene(force=force), **{"T": 1e-3, **options})


# numbers that the dtype does not have


@pytest.mark.parametrize(
    "value, words",
    [
        (1e-50, r"0 in float32; use units of a larger scale or dtype='float64'"),
        (-1e-40, "without its digits in float32"),
        (1e39, r"inf in float32; use units of a smaller scale or dtype='float64'"),
        (-4e38, "-inf in float32"),
        (sp.Integer(10) ** 400, "inf in float32"),
        (sp.Rational(1, 10**400), "0 in float32"),
        (float("nan"), "not a finite number"),
        (float("inf"), "not a finite number"),
        (sp.oo, "not a finite number"),
    ],
)
def test_a_number_the_type_does_not_have_is_refused(value, words):
    with pytest.raises(ProgramError, match=f"it is {words}"):
        entering(value, "f32", "it")


@pytest.mark.parametrize("value", [0, -0.0, 1e-37, -3.4e38, 0.1, sp.pi, sp.Rational(1, 3), sp.Integer(0), sp.Float(0)])
def test_a_number_the_type_has_is_the_same_float(value):
    assert entering(value, "f32", "it") == float(value)
    assert entering(1e300, "f64", "it") == 1e300


def test_a_number_of_an_equation_is_checked():
    with pytest.raises(ProgramError, match="^1.00e[+]39 is inf in float32; use units of a smaller scale or dtype='float64'$"):
        law(k * x(n) * sp.Float("1e39"))
    assert len(law(k * x(n) * sp.Float("1e39"), dtype="float64")) == 2
    with pytest.raises(ProgramError, match="^1.00e[+]400 is inf in float64; use units of a smaller scale$"):
        law(k * x(n) * sp.Integer(10) ** 400, dtype="float64")


def test_bound_values_are_checked_whether_they_are_live_or_not():
    for value, words in (
        (1e39, "c = 1e[+]39 is inf in float32"),
        (1e-39, "c = 1e-39 is without its digits in float32"),
    ):
        c = hl.parameters("c", units="m", values=value)
        for live in (None, []):
            with pytest.raises(ParameterError, match=words):
                law(F0 * (x(n) / c), live=live)
        assert len(law(F0 * (x(n) / c), dtype="float64")) == 2
    c = hl.parameters("c", units="m", values=0)
    assert law(F0 * (x(n) - c) / u).values  # zero is a number of every type


def test_folded_products_that_vanish_or_overflow_are_refused():
    s, r, e = hl.parameters("s r e", units="m m N", values=(3.4e-10, 3e-10, 1e-12))
    force = e * s**6 / (x(n) + r) ** 6
    for live in ([], None):  # bound and live, the same answer
        with pytest.raises(ProgramError, match=r"s\*\*6 = 1.54e-57 is 0 in float32; use units of a larger scale"):
            law(force, live=live)
    position = np.array([0.0, 1e-10])
    computed = load(law(force, live=[], dtype="float64")).run(2, position).outputs[:, 0, 0]
    assert computed == pytest.approx(1e-12 * 3.4e-10**6 / (position + 3e-10) ** 6, rel=1e-14)
    large = hl.parameters("large", units="m", values=1e20)
    with pytest.raises(ProgramError, match=r"large\*\*2 = 1.00e[+]40 is inf in float32; use units of a smaller scale"):
        law(F0 * x(n) / u * (large / u) ** 2, live=[])
    z = hl.coordinate("z", unit="m")
    small = hl.parameters("small", units="kg", values=1e-20)
    motion = [sp.Eq(small**3 * z.diff(t, 2), k * small**2 * x(t))]
    with pytest.raises(ProgramError, match=r"small\*\*[23] = 1.00e-[46]0 is .* in float32"):
        hl.compile(hl.Scene(force=k * z, eom=motion), T=1e-3)


def test_folded_zeros_that_are_zeros_pass():
    B = hl.parameters("B", units="N*s/m", values=0)
    assert len(law(k * x(n) + B * v(n) + B * u / T * (x(n) / u), live=[])) == 1


@pytest.mark.parametrize("divisor", [2.0**-110, 2.0**-126, 2.0**110, 3e-38, 3e38])
def test_a_constant_divisor_whose_reciprocal_is_not_ordinary_divides(divisor):
    c = hl.parameters("c", units="m", values=float(np.float32(divisor)))
    position = [float(np.float32(0.7 * divisor)), float(np.float32(1.1 * divisor))]
    for live in (None, []):
        computed = load(law(F0 * (x(n) / c), live=live)).run(2, position).outputs[:, 0, 0]
        assert computed == pytest.approx([0.7, 1.1], rel=3e-7)


@pytest.mark.parametrize(
    "period, words",
    [
        (1e-40, "T = 1e-40 s is without its digits"),
        (1e-50, "is 0 in float32"),
        (1e39, "is inf"),
        (1e38, "1/T with T = 1e[+]38 s"),
    ],
)
def test_a_period_the_type_does_not_have_is_refused(period, words):
    with pytest.raises(ParameterError, match=words):
        law(k * x(n) + F0 * v(n) * T / u, T=period)


def test_a_board_counts_whole_microseconds():
    wall = law(k * x(n))
    assert layout(encode(replace(wall, T=1e-6))).period_us == 1
    assert layout(encode(replace(wall, T=250.0005e-6))).period_us == 250
    for period, nearest in (
        (1 / 3000, "T=333e-6"),
        (4e-7, "T=1e-6"),
        (1.5e-3 + 2e-9, "T=1500e-6"),
        (1e9, "T=4294967295e-6"),
    ):
        with pytest.raises(ProgramError, match=f"whole microseconds, at least 1: the nearest is {nearest}"):
            encode(replace(wall, T=period))


# angles that time drives


def test_the_frequency_is_read_off_an_angle_that_is_linear_in_time():
    f, w, phi = hl.parameters("f w phi", units="Hz rad/s rad")
    for angle, expected in (
        (2 * sp.pi * f * t, (f, 0)),
        (2 * sp.pi * f * (t - phi / w) + x(n) / u, (f, x(n) / u - 2 * sp.pi * f * phi / w)),
        (w * n * T, (w / (2 * sp.pi), 0)),
        (w * t + 2 * sp.pi * f * t + phi, (f + w / (2 * sp.pi), phi)),
        (w * t**2 + phi, (0, w * t**2 + phi)),
        (w * t * x(n) / u, (0, w * t * x(n) / u)),
        (x(t) / u, (0, x(t) / u)),
    ):
        found = frequency(angle)
        assert all(sp.simplify(a - b) == 0 for a, b in zip(found, expected, strict=True))


#: ticks looked at in one stretch
STRETCH = 500


def turned(hertz, start, rate=1000):
    """Return the angle at a stretch of ticks less whole turns [rad], from integers."""
    per_tick = Fraction(str(hertz)) / rate
    tick = start + np.arange(STRETCH, dtype=np.int64)
    return 2 * np.pi * (tick * per_tick.numerator % per_tick.denominator) / per_tick.denominator


#: how often the frequency and its turns a tick are rounded, live and folded: 250 Hz is a quarter turn, 50 Hz a whole number
VIBRATIONS = [(250, 20, 0, 0), (50, 1000, 1, 0), (247.3, 100, 2, 1)]


@pytest.mark.parametrize("dtype, fine", [("float32", 1e-6), ("float64", 1e-14)])
@pytest.mark.parametrize("hertz, seconds, live_roundings, folded_roundings", VIBRATIONS)
@pytest.mark.parametrize("time", [t, n * T], ids=str)
@pytest.mark.always("t-*-float64-*", "T*n-*-float32-*")
def test_a_vibration_keeps_its_phase(dtype, fine, hertz, seconds, live_roundings, folded_roundings, time):
    f = hl.parameters("f", units="Hz", values=hertz)
    ticks = 1000 * seconds
    if dtype == "float64":  # a folded frequency has no more digits than a live one there
        folded_roundings = live_roundings
    for live, roundings in ((None, live_roundings), ([], folded_roundings)):
        program = law(F0 * sp.sin(2 * sp.pi * f * time), dtype=dtype, live=live)
        allowed = fine + roundings * np.finfo(dtype).eps / 2 * 2 * np.pi * hertz * seconds
        # the phase depends on the tick count alone, which is all the program keeps: stretches stand for the whole run
        assert {c.name for c in program.states} <= {"tick", "tick_high"}
        for start in (0, 5000, ticks // 3, ticks - STRETCH):
            computed = load(program).run(STRETCH, np.zeros(STRETCH), states=at_tick(program, start)).outputs[:, 0, 0]
            assert np.abs(computed - np.sin(turned(hertz, start))).max() < allowed
            with mp.workdps(30):
                reference = mp.sin(2 * mp.pi * mp.mpf(str(hertz)) * (start + STRETCH - 1) / 1000)
                assert abs(computed[-1] - reference) < allowed


@pytest.mark.parametrize("dtype, last, fine", [("float32", 2**33, 1e-6), ("float64", 2**48, 1e-14)])
def test_the_phase_is_exact_where_neither_an_int32_nor_a_float32_counts_ticks(dtype, last, fine):
    f = hl.parameters("f", units="Hz", values=250)
    program = law(F0 * sp.cos(2 * sp.pi * f * t), dtype=dtype)
    for first in (2**24 - 4, 10**9, 2**31 - 4, 2**32 - 4, last - 9):
        computed = load(program).run(9, np.zeros(9), states=at_tick(program, first)).outputs[:, 0, 0]
        assert np.abs(computed - np.cos(np.pi / 2 * ((first + np.arange(9)) % 4))).max() < fine


def test_phase_offsets_and_stages_between_samples_follow_the_closed_form():
    """z' = w cos(w t + x) has z = sin(w t + x) - sin(x), through every stage of the method."""
    f, one, L = hl.parameters("f one L", units="Hz m/s m", values=(40, 1, 1))
    z = hl.coordinate("z", unit="m")
    eom = [sp.Eq(z.diff(t), one * sp.cos(2 * sp.pi * f * t + x(n) / L))]
    scene = hl.Scene(force=k * z, eom=eom, name="integral")
    program = hl.compile(scene, "rk4", T=1e-3, dtype="float64")
    times = np.arange(400) * 1e-3
    computed = load(program).run(400, np.full(400, 0.3)).outputs[:, 0, 0]
    w = 2 * np.pi * 40
    exact = 100 * (np.sin(w * times + 0.3) - np.sin(0.3)) / w
    assert np.abs(computed - exact).max() < 2e-6 * np.abs(exact).max()  # RK4 is Simpson's rule here: (w h)^4/2880


@pytest.mark.parametrize("engine", ["llvm", "vm"])
def test_the_engines_agree_on_a_driven_angle(engine):
    from random_programs import assert_same_bits

    if engine == "llvm":
        pytest.importorskip("llvmlite")
    f = hl.parameters("f", units="Hz", values=247.3)
    program = law(F0 * sp.sin(2 * sp.pi * f * t + x(n) / u))
    handle = np.linspace(-0.1, 0.1, 200)
    one, other = (load(program, e).run(200, handle, states=at_tick(program, 9_999_900)).outputs for e in ("interpreter", engine))
    assert_same_bits(one, other)


def test_a_fault_names_the_angle_that_may_have_caused_it():
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3)
    c = hl.parameters("c", units="rad/s^2", values=1e6)
    swept = hl.Scene(force=F0 * sp.sin(c * t**2))
    assert "beyond 8192 rad, which has no sine in float32" in paddle.run(swept, duration=0.2).fault
    assert "beyond 1e+08 rad, which has no sine in float64" in paddle.run(swept(c=1e11), duration=0.2, dtype="float64").fault
    broken = hl.Scene(force=F0 * sp.sqrt(-1 - (x(n) / u) ** 2))
    assert paddle.run(broken, duration=0.01).fault.endswith("the motor is off from then on")
    vibration = F0 * sp.sin(2 * sp.pi * hl.parameters("f", units="Hz", values=250) * t)
    assert paddle.run(hl.Scene(force=vibration), duration=6).fault is None
