"""Long runs, wrapping counters, large angles and delays."""

import math
from pathlib import Path

import mpmath as mp
import numpy as np
import pytest
import sympy as sp
from motions import at_tick

import hapticlab as hl
from hapticlab import n, t, x
from hapticlab.compiler.engines.engine import load
from hapticlab.compiler.ir.elementary import TABLES
from hapticlab.errors import HapticlabError, ProgramLimitError, SceneError

F0, w = hl.parameters("F0 w", units="N rad", values=(1.0, 0.0))
k = hl.parameters("k", units="N/m", values=100.0)
ENGINES = ("interpreter", "vm", "auto")


def from_tick(scene, start, ticks, engine="auto", T=1e-3, **options):
    program = hl.compile(scene, T=T, **options)
    handle = np.zeros((ticks, len(program.inputs)))
    return load(program, engine).run(ticks, handle, states=at_tick(program, start)).outputs[:, 0, 0]


# survive: time is an integer


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("start", [10**9, 2**31 - 3, 2**32 - 3, 2**33 - 9])
def test_a_vibration_goes_on_after_a_billion_ticks_and_past_every_counter(engine, start):
    """A quarter of a turn a tick: the turns of a tick are exact in float32, so what is left is the sine's own rounding."""
    found = from_tick(hl.Scene(force=F0 * sp.cos(2 * sp.pi * hl.parameters("f", units="Hz", values=250) * t)), start, 6, engine)
    np.testing.assert_allclose(found, np.cos(np.pi / 2 * ((start + np.arange(6)) % 4)), rtol=0, atol=1e-6)


@pytest.mark.parametrize("T", [1e-5, 1e-3, 0.1])
def test_time_itself_never_turns_back(T):
    """An int32 of ticks would be negative after six hours at 10 us; a float32 sum would have stopped long before."""
    s = hl.parameters("s", units="s", values=1.0)
    late = hl.when(t >= 2 * s, F0 * t / s, -F0)
    for start in (10**9, 2**31 - 2, 2**31 + 5, 2**32 + 7):
        for engine in ENGINES:
            found = from_tick(hl.Scene(force=late), start, 4, engine, T)
            np.testing.assert_allclose(found, (start + np.arange(4)) * T, rtol=2e-7)


def test_a_billion_ticks_of_a_tenth_are_what_float64_says():
    found = from_tick(hl.Scene(force=F0 * t / hl.parameters("s", units="s", values=1.0)), 10**9, 3, T=0.1, dtype="float64")
    assert found.tolist() == [(10**9 + i) * 0.1 for i in range(3)]


# angles: right as far as their type has digits, then a fault that names them


@pytest.mark.parametrize("dtype, angle, ulps", [("float32", 1e3, 1), ("float32", 8000.0, 1), ("float64", 1e8, 1)])
def test_an_angle_within_its_types_range_has_its_sine(dtype, angle, ulps):
    program = hl.compile(hl.Scene(force=F0 * sp.sin(w))(w=angle), T=1e-3, dtype=dtype)
    (found,) = load(program).run(1, np.zeros((1, len(program.inputs)))).outputs[:, 0, 0]
    with mp.workdps(30):
        assert abs(found - float(mp.sin(mp.mpf(angle)))) <= ulps * np.finfo(dtype).eps


@pytest.mark.parametrize(
    "dtype, angle, limit", [("float32", 1e8, "8192"), ("float32", 3e38, "8192"), ("float64", 1e15, "1e[+]08")]
)
def test_an_angle_past_all_sines_stops_the_motor_and_is_named(dtype, angle, limit):
    paddle = hl.SimulatedPaddle(m=0.05, b=0.5, T=1e-3)
    log = paddle.run(hl.Scene(force=F0 * sp.sin(w))(w=angle), duration=0.01, dtype=dtype)
    assert log.fault.startswith("tick 0 ") and not log.F.any()
    assert hl.records.Telemetry is type(log) and f"angle beyond {limit.replace('[', '').replace(']', '')} rad" in log.fault


def test_a_wheel_that_turns_for_ever_stops_with_its_angle_named():
    """Its angle passes 8192 rad after 8192 / 1e5 s, and no tick sooner."""
    turn = hl.coordinate("turn", unit="rad", rate=1e5)
    J = hl.parameters("J", units="kg*m^2", values=1.0)
    wheel = hl.Scene(force=F0 * sp.sin(turn), eom=[sp.Eq(J * turn.diff(t, 2), 0)])
    log = hl.SimulatedPaddle(m=0.05, b=0.5, T=1e-3).run(wheel, duration=0.1)
    assert int(log.fault.split()[1]) == math.ceil(8192 / 1e5 / 1e-3) and "angle beyond 8192 rad" in log.fault


@pytest.mark.parametrize("dtype, step", [("float32", 8192 / 400), ("float64", None)])
def test_what_turns_like_a_motor_meets_the_limit_when_the_page_says(dtype, step):
    turn = hl.coordinate("turn", unit="rad", rate=400.0)
    J = hl.parameters("J", units="kg*m^2", values=1.0)
    wheel = hl.Scene(force=F0 * sp.sin(turn), eom=[sp.Eq(J * turn.diff(t, 2), 0)])
    log = hl.SimulatedPaddle(m=0.05, b=0.5, T=1e-3).run(wheel, duration=25.0, dtype=dtype)
    if step is None:
        assert log.fault is None
    else:  # float32 adds up 0.4 rad with a rounding each tick
        assert abs(float(log.fault.split("t = ")[1].split(" s")[0]) - step) < 0.01 and "use dtype='float64'" in log.fault
    page = (Path(__file__).parents[2] / "docs" / "explanation" / "engines.md").read_text("utf-8")
    largest = TABLES[{"float32": "f32", "float64": "f64"}[dtype]].angle_limit
    apart, seconds = np.spacing(np.nextafter(np.dtype(dtype).type(largest), 0)), largest / 400
    when = f"{seconds:.0f} s" if seconds < 60 else f"{seconds / 3600:.0f} h"
    row = f"| `{dtype}` | {largest:g} rad | {apart:.2g} rad | {when} |"
    assert row.replace("e+0", "e").replace("e-0", "e-") in page


# delays


@pytest.mark.parametrize("lag", [1, 7, 300])
@pytest.mark.always("[17]")
def test_a_delay_of_many_samples_is_a_shift(lag):
    rng = np.random.default_rng(5)
    handle = rng.normal(size=lag + 20)
    program = hl.compile(hl.Scene(force=k * x(n - lag)), T=1e-3, dtype="float64")
    found = load(program).run(len(handle), handle).outputs[:, 0, 0]
    np.testing.assert_array_equal(found, 100.0 * np.r_[np.full(lag, handle[0]), handle[:-lag]])


@pytest.mark.parametrize("periods", [1.0, 3.0, 5.5])
def test_a_force_several_ticks_late_is_stable_up_to_its_limit(periods):
    """The limit is that of the exact eigenvalues, with the delay in them; 10 % either side decays and grows."""
    paddle = hl.SimulatedPaddle(m=0.05, b=0.5, T=1e-3, delay=periods * 1e-3)
    limit = hl.stability_limit(paddle).K
    for share, grows in ((0.9, False), (1.1, True)):
        log = paddle.run(hl.Scene(force=k * x(n))(k=share * limit), duration=4.0, x=1e-3, dtype="float64")
        late, early = np.abs(log.x[-200:]).max(), np.abs(log.x[:200]).max()
        assert log.fault is None and (late > 2 * early) == grows and (late < 0.5 * early) != grows


@pytest.mark.parametrize(
    "force, error, words",
    [
        (k * x(n - 10**6), ProgramLimitError, "more than 2000 states.*Use fewer past samples"),
        (k * x(n - 10**18), ProgramLimitError, "more than 2000 states"),
    ],
)
def test_a_memory_that_no_program_has_is_refused_at_once(force, error, words):
    with pytest.raises(error, match=words):
        hl.compile(hl.Scene(force=force), T=1e-3)


def test_a_sample_that_is_not_there_yet_is_refused():
    with pytest.raises(SceneError, match="lies in the future"):
        hl.Scene(force=k * x(n + 1))


@pytest.mark.parametrize("duration", [0, -1.0, math.nan, math.inf, 1e-9, 1e9, "2 m"])
def test_a_duration_that_no_run_has_is_refused(duration):
    with pytest.raises(HapticlabError, match="duration = "):
        hl.SimulatedPaddle(m=0.05, b=0.5, T=1e-3).run(hl.Scene(force=k * x(n)), duration=duration)
