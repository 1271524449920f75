"""What a board does at its extremes: the motor is off in the tick of a fault, and one bad value changes nothing."""

import math
import struct

import numpy as np
import pytest
import sympy as sp
from host_driver import Host, fault_name, spring, state_name

import hapticlab as hl
from hapticlab import n, t, v, x
from hapticlab.errors import HapticlabError, PaddleError, ParameterError

k, x_o, F0, B = hl.parameters("k x_o F0 B", units="N/m m N N*s/m", values=(100.0, 0.002, 0.1, 0.5))
z = hl.coordinate("z", unit="m")
m, K, b = hl.parameters("m K b", units="kg N/m N*s/m", values=(0.05, 100.0, 1.0))
F_c = K * (x(t) - z) + b * (v(t) - z.diff(t))
MASS = hl.Scene(force=F_c, eom=[sp.Eq(m * z.diff(t, 2), F_c)], name="mass")
WALL = hl.Scene(force=hl.when(x(n) >= x_o, k * (x(n) - x_o)), name="wall")
COUNT = 1e-5  #: [m], of the host's board


def host_of(force, **kept):
    program = hl.compile(hl.Scene(force=force), T=1e-3, live=())
    return Host(speed_max=1e3, **kept).running(program)


def stopped(host, fault):
    """The motor is off, and stays off whatever comes, until the fault is cleared."""
    state = host.state()
    assert state_name(state["state"]) == "FAULT" and fault_name(state["fault"]) == fault
    assert host.board.duty == 0 and not any(host.tick(c, beat=True) for c in (0, 100, 200))
    assert host.start() != "OK"


# faults, motor off in their tick


u = x(n) / x_o  # 200 counts of 10 um


@pytest.mark.parametrize(
    "force, good, bad",
    [
        (F0 / u, -1, 0),
        (F0 * sp.sqrt(1 - u), 200, 201),
        (F0 * sp.log(2 - u), 399, 401),
        (F0 * sp.sin(8000 * u), 204, 205),
        (F0 * sp.exp(90 * (u - 1)) / 1e30, 397, 398),
        (F0 * u ** sp.Rational(3, 2), 2, -1),
        (F0 * sp.acos(u), 200, 201),
    ],
)
def test_no_number_stops_the_motor_in_its_tick(force, good, bad):
    host = host_of(force + F0)
    for counts in (good - 2, good - 1, good):
        host.tick(counts, beat=True)
        assert state_name(host.state()["state"]) == "RUN"
    assert host.tick(bad) == 0
    stopped(host, "NOT_FINITE")


early = hl.signal("early", unit="m", initial=x_o**2 / x(n))  # infinite where the handle starts at 0, and never felt


@pytest.mark.parametrize(
    "scene",
    [
        hl.Scene(force=k * x(n), watch={"depth": F0 * sp.sqrt(1 - u)}),
        hl.Scene(force=k * hl.when(n > 0, early(n - 1)), eom=[sp.Eq(early(n), x(n))]),
    ],
    ids=["watched", "first state"],
)
def test_the_board_and_the_simulation_stop_in_the_same_tick(scene):
    paddle = hl.SimulatedPaddle(m=0.05, b=0.5, T=1e-3, hand=hl.Hand(push=1.0))
    simulated = paddle.run(scene(k=1.0), duration=0.1)
    with hl.connect("sim://hapkit", paddle=paddle) as board:
        felt = board.run(scene(k=1.0), duration=0.1)
    first = simulated.fault.split(":")[0]
    assert first.startswith("tick ") and felt.fault.startswith(first) and "NOT_FINITE" in felt.fault
    assert not simulated.F[int(first.split()[1]) :].any()


@pytest.mark.parametrize("counts", [2**31 - 1, -(2**31), 2**30])
def test_an_encoder_that_jumps_to_the_end_of_its_count_stops_the_motor(counts):
    host = Host(speed_max=1e3).running()
    host.tick(100, beat=True)
    assert host.tick(counts) == 0
    stopped(host, "OVER_TRAVEL")


def test_a_count_that_turns_over_is_one_count_on():
    """From 2^31 - 1 to -2^31 is a step of one: the difference is what counts, and the speed that of one count a tick."""
    host = Host()
    host.tick(2**31 - 1)
    host.ready(at=0.0)
    assert host.start() == "OK"
    for step in (0, 1, 2, 3):
        duty = host.tick((2**31 - 1 + step + 2**31) % 2**32 - 2**31, beat=True)
        assert state_name(host.state()["state"]) == "RUN"
    F = [struct.unpack_from("<f", f.payload, 13)[0] for f in host.samples]
    np.testing.assert_allclose(F, 100.0 * COUNT * np.arange(4), rtol=1e-4, atol=1e-9)
    assert duty < 0


@pytest.mark.parametrize("late", [1.2e-3, 1.9e-3, 20e-3])
def test_steps_that_are_late_time_after_time_stop_the_motor(late):
    host = Host().running()
    for _ in range(30):
        if not host.tick(500, step=late, beat=True):
            break
    stopped(host, "OVERRUN")


# survive


def test_one_count_of_jitter_is_felt_as_the_wall_and_its_damper_make_it():
    """F steps by K q + B q/T between two neighbouring counts: 5 mN + 5 mN here, no more."""
    program = hl.compile(hl.Scene(force=k * x(n) + B * v(n))(k=500.0, B=0.5), T=1e-3, live=())
    host = Host().running(program)
    for tick in range(100):
        host.tick(tick % 2, beat=True)
    F = np.array([struct.unpack_from("<f", f.payload, 13)[0] for f in host.samples])[2:]
    assert state_name(host.state()["state"]) == "RUN"
    assert np.ptp(F) == pytest.approx(500 * COUNT + 2 * 0.5 * COUNT / 1e-3, rel=1e-4)  # v is + q/T and - q/T


def test_a_wall_as_stiff_as_float32_goes_gives_the_motors_most_and_no_more():
    paddle = hl.SimulatedPaddle(m=0.05, b=0.5, T=1e-3, hand=hl.Hand(push=1.0))
    with hl.connect("sim://hapkit", paddle=paddle) as board:
        log = board.run(WALL(k=3.4e38), duration=0.3)
    assert log.fault is None and set(np.unique(log.F)) == {0.0, 20.0}


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, 1e39, -1.0, 10**400, None, "ten", 1j])
def test_a_value_that_is_none_changes_nothing_while_a_scene_runs(value):
    paddle = hl.SimulatedPaddle(m=0.05, b=0.5, T=1e-3, hand=hl.Hand(push=1.0, k=1000, b=5))
    with hl.connect("sim://hapkit", paddle=paddle) as board:
        board.start(WALL(k=100.0, x_o=-0.01))
        board.wait(0.05)
        with pytest.raises(HapticlabError, match="k = "):
            board.set(k=value)
        board.wait(0.05)
        log = board.stop()
    assert log.fault is None
    np.testing.assert_allclose(log.F, np.float32(100) * (log.x + np.float32(0.01)), rtol=1e-5)


@pytest.mark.parametrize("bits", [0x7F800000, 0xFF800000, 0x7FC00000, 0x7F800001, 0xFFFFFFFF])
def test_bits_that_are_no_number_are_refused_by_the_board_itself(bits):
    host = Host().running(_0=100.0)
    before = host.tick(1000, beat=True)
    assert host.ask("SET", 1, rest=b"\0" + struct.pack("<I", bits)) == "NO_VALUE"
    assert host.tick(1000, beat=True) == before != 0


def test_the_smallest_numbers_are_taken_as_they_are():
    host = Host().running(_0=100.0)
    for bits in (1, 0x80000001, 0x007FFFFF, 0x80000000):
        assert host.ask("SET", 1, rest=b"\0" + struct.pack("<I", bits)) == "OK"
        assert host.tick(1000, beat=True) == 0
        assert state_name(host.state()["state"]) == "RUN"


@pytest.mark.parametrize("start", [65.535, 4294.9672, 86400.0 * 60])
def test_clocks_that_turn_over_are_not_felt(start):
    """16 bits of ticks, 32 of microseconds (71.6 min), two months: the handle moves on at its speed."""
    host = Host()
    host.t = start
    host.ready()
    assert host.start() == "OK"
    for tick in range(200):
        host.tick(tick, beat=True)
    v_seen = [struct.unpack_from("<f", f.payload, 9)[0] for f in host.samples]
    assert state_name(host.state()["state"]) == "RUN" and host.state()["overruns"] == 0
    np.testing.assert_allclose(v_seen[1:], COUNT / 1e-3, rtol=1e-4)


# refused before the motor moves


@pytest.mark.parametrize("values", [dict(m=1e-6), dict(K=1e30), dict(b=1e6)])
def test_a_scene_that_its_steps_make_unstable_does_not_start(values):
    paddle = hl.SimulatedPaddle(m=0.05, b=0.5, T=1e-3)
    with hl.connect("sim://hapkit", paddle=paddle) as board:
        with pytest.raises(PaddleError, match="unstable as bound.*its longest step is"):
            board.run(MASS(**values), duration=0.1)
        assert board.run(MASS, duration=0.05).fault is None


def test_a_value_past_the_limit_of_the_steps_is_refused_while_it_runs():
    """RK4 in 1 ms holds K up to where omega h = 2.83 at the most; the scene runs on with what it had."""
    paddle = hl.SimulatedPaddle(m=0.05, b=0.5, T=1e-3, hand=hl.Hand(push=0.5, k=100, b=5))
    with hl.connect("sim://hapkit", paddle=paddle) as board:
        board.start(MASS)
        board.wait(0.1)
        with pytest.raises(ParameterError, match="K = "):
            board.set(K=1.1 * 0.05 * (2.95 / 1e-3) ** 2)
        board.set(K=200.0)
        board.wait(0.1)
        log = board.stop()
    assert log.fault is None and np.abs(log.F).max() < 2.0


@pytest.mark.parametrize("T, told", [(49e-6, "RANGE"), (30.001e-3, "RANGE")])
def test_a_period_no_timer_has_is_refused_by_the_board(T, told):
    assert Host().ready(spring(T=T), _0=1.0).start() == told
