"""The linked program: delays against located events, lanes, engines, measures, and states of every type."""

import itertools

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp

from hapticlab.compiler.engines.engine import load
from hapticlab.compiler.engines.table import ENGINES as TABLE
from hapticlab.compiler.ir.program import Block, Channel, Program
from hapticlab.compiler.ir.trace import Builder, cast, maximum, select
from hapticlab.compiler.tick.compile_scene import compile
from hapticlab.device.hand.hand import Hand
from hapticlab.device.simulated.simulated_paddle import SimulatedPaddle, link
from hapticlab.errors import PaddleError
from hapticlab.scene.notation.symbols import coordinate, n, parameters, t, v, when, x
from hapticlab.scene.scene import Scene

ENGINES = [name for name, record in TABLE.items() if record.automatic and record.is_here()]
HAND = Hand(m=0.02, b=1, k=200, push=0.6, intent=lambda t: 0.004 * np.sin(40 * t))
EVERYTHING = {"m": 0.05, "b": 0.1, "T": 1e-3, "delay": 1.3e-3, "coulomb": 0.05, "force_max": 3.0, "hand": HAND}
k, B, m, x_o = parameters("k B m x_o", units="N/m N*s/m kg m")
z = coordinate("z", unit="m")
WALL = Scene(force=when(x(n) >= x_o, k * (x(n) - x_o)), name="wall")


def closed_loop(paddle, law, ticks, x, v):
    """Integrate handle and hand with DOP853 from event to event: every sample and every arrival of a force."""
    hand, T = paddle.hand, paddle.T
    M = paddle.m + hand.m
    intent = hand.intent(np.arange(ticks + 1) * T)
    y, rows, arrivals, F = np.array([x, v]), [], [], 0.0
    for tick in range(ticks):
        rows.append([y[0], y[1], law(y[0])])
        arrivals.append((tick * T + paddle.delay, rows[-1][2]))
        now, end, switch = tick * T, (tick + 1) * T, np.nan
        slope = (intent[tick + 1] - intent[tick]) / T

        def field(time, y, start=now, at=intent[tick], slope=slope):
            pull = hand.k * (y[0] - at - slope * (time - start)) + hand.b * (y[1] - slope)
            return [y[1], (hand.push - F - paddle.b * y[1] - pull) / M]  # noqa: B023 - F changes on purpose

        while now < end - 1e-12:
            if arrivals and arrivals[0][0] <= now + 1e-12:
                F, switch = arrivals.pop(0)[1], y[0]
            until = min(end, arrivals[0][0]) if arrivals else end
            y = solve_ivp(field, (now, until), y, method="DOP853", rtol=1e-13, atol=1e-16).y[:, -1]
            now = until
        rows[-1] += [F, switch]
    return np.array(rows).T


@pytest.mark.parametrize("delay", [0.0, 1e-3, 2e-3, 4e-4, 1.4e-3, 2.9e-3])
@pytest.mark.always("0.001", "0.0014")
def test_delay_against_located_events(delay):
    paddle = SimulatedPaddle(m=0.05, b=0.1, T=1e-3, delay=delay, hand=HAND)
    log = paddle.run(WALL(k=300, x_o=0.001), duration=0.1, v=0.1, dtype="float64")
    x, v, F, applied, switch = closed_loop(paddle, lambda x: 300 * (x - 0.001) * (x >= 0.001), 100, 0.0, 0.1)
    assert (F > 0).any() and (F == 0).sum() > 10
    scale = np.abs(x).max()
    assert np.abs(log.x - x).max() < 1e-10 * scale
    assert np.abs(log.v - v).max() < 1e-10 * np.abs(v).max()
    assert np.abs(getattr(log, "F_applied", log.F) - applied).max() < 1e-10 * np.abs(F).max()
    late = ~np.isnan(switch)
    assert np.abs(getattr(log, "x_switch", log.x) - switch)[late].max() < 1e-10 * scale and late.sum() > 95
    assert ("x_switch" in log.columns) == (delay % 1e-3 > 1e-9 and delay not in (1e-3, 2e-3))


def test_only_what_the_paddle_has_is_compiled_in():
    bare = link(compile(WALL, T=1e-3), SimulatedPaddle(m=0.05, b=0.1, T=1e-3))
    assert [c.name for c in bare.states] == ["plant.x", "plant.v", "fault"] and not bare.inputs
    assert "sqrt" not in str(bare) and "floor" not in str(bare)
    full = link(compile(WALL, T=1e-3), SimulatedPaddle(**EVERYTHING, counts_per_metre=1e5, noise=1e-5))
    assert [c.name for c in full.inputs] == ["intent", "intent.rate", "noise"]
    assert [c.name for c in full.outputs] == ["x", "v", "F", "x_true", "v_true", "F_applied", "x_switch", "fault"]
    assert "floor" in str(full) and len(full) > 20 * len(bare)


def test_parameters_and_inputs_are_in_order():
    paddle = SimulatedPaddle(**EVERYTHING, counts_per_metre=1e5, noise=1e-5)
    linked = link(compile(WALL(k=150, x_o=0), T=1e-3), paddle)
    named = dict(zip((c.name for c in linked.parameters), (150, 0, *paddle.plant_values(x=0.1, v=-2)), strict=True))
    assert named["plant.coulomb"] == 0.05 and named["plant.force_max"] == 3 and named["plant.push"] == 0.6
    assert named["start.x"] == 0.1 and named["start.v"] == -2 and named["plant.counts_per_metre"] == 1e5
    inputs = paddle.inputs(50)
    assert inputs.shape == (50, 3)
    assert np.array_equal(inputs[:, 0], HAND.intent(np.arange(50) * 1e-3))
    assert inputs[:-1, 0] + 1e-3 * inputs[:-1, 1] == pytest.approx(inputs[1:, 0], abs=1e-17)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("given", [{}, {"counts_per_metre": 1e5}, EVERYTHING])
@pytest.mark.always("given[01]-*")
def test_lanes_equal_scalar(engine, given):
    """Lanes may differ in the scene's parameters, in mass, damping and start; every bit is that of the scalar run."""
    points = [(150, 0.05, 0.1, 0.0), (900, 0.07, 0.3, -0.2), (40, 0.03, 0.0, 0.4)]
    paddles = [SimulatedPaddle(**{"T": 1e-3, **given, "m": m, "b": b}) for _, m, b, _ in points]
    assert len({p.structure for p in paddles}) == 1
    linked = load(link(compile(WALL, T=1e-3), paddles[0]), engine)
    columns = [(K, 0.001, *p.plant_values(v=v)) for (K, _, _, v), p in zip(points, paddles, strict=True)]
    lanes = linked.run(60, paddles[0].inputs(60), np.array(columns).T)
    for lane, column in enumerate(columns):
        alone = linked.run(60, paddles[0].inputs(60), column)
        assert np.array_equal(lanes.outputs[:, :, lane], alone.outputs[:, :, 0])
        assert np.array_equal(lanes.states[:, lane], alone.states[:, 0])


@pytest.mark.wide
@pytest.mark.skipif(len(ENGINES) == 1, reason="neither llvmlite nor wasmtime is installed")
@pytest.mark.parametrize("given", [{}, {"counts_per_metre": 1e5, "noise": 1e-5}])
def test_engines_give_the_same_bits(given):
    coupler = k * (x(t) - z) + B * (v(t) - z.diff(t))
    mass = Scene(force=coupler, eom=[sp.Eq(m * z.diff(t, 2), coupler)], watch=[z])
    paddle = SimulatedPaddle(**EVERYTHING, **given)
    logs = [paddle.run(mass(k=120, B=1, m=0.05), duration=0.1, engine=engine) for engine in ENGINES]
    for name, other in itertools.product(logs[0].columns, logs[1:]):
        assert np.array_equal(getattr(logs[0], name), getattr(other, name)), name
    assert np.ptp(logs[0].z) > 0


class PortEnergy:
    """Work of the force felt, over the displacement between switching instants, and the largest position."""

    outputs = (Channel("work", "J", "f64"), Channel("x_max", "m", "f64"), Channel("last", "1", "f64"))
    states = tuple(Channel(name, "1", "f64") for name in ("work", "x_max", "F", "x_switch"))

    def init(self, sample):
        return [0.0 * sample["x_true"], sample["x_true"], 0.0 * sample["x_true"], sample["x_true"]]

    def update(self, sample, states):
        work, x_max, F, x_before = states
        work = work + F * (sample["x_switch"] - x_before)
        x_max = maximum(sample["x_true"], x_max)
        tick = sample["tick"].builder.emit("itof", sample["tick"], type="f64")
        return [work, x_max, tick], [work, x_max, sample["F_applied"], sample["x_switch"]]


@pytest.mark.parametrize("delay", [0.0, 1e-3, 1.3e-3])
@pytest.mark.always("0.0")
def test_measure_sees_what_the_traces_show(delay):
    paddle = SimulatedPaddle(**{**EVERYTHING, "delay": delay})
    program = compile(WALL(k=150, x_o=0.001), T=1e-3, dtype="float64")
    parameters = (*program.values, *paddle.plant_values(v=0.3))
    measured = load(link(program, paddle, PortEnergy())).run(80, paddle.inputs(80), parameters, every=80)
    log = paddle.run(program, duration=0.08, v=0.3)
    work, x_max, last = measured.outputs[-1, :, 0]
    assert last == 79 and x_max == log.x.max() > 0.005
    felt, where = getattr(log, "F_applied", log.F), getattr(log, "x_switch", log.x)
    assert work == pytest.approx(felt[:-1] @ np.diff(where), rel=1e-12) and work != 0


def test_states_nobody_needs_are_dropped():
    paddle = SimulatedPaddle(m=0.05, b=0.1, T=1e-3, counts_per_metre=1e5)
    program = compile(WALL(k=150, x_o=0.001), T=1e-3)
    names = [c.name for c in link(program, paddle, PortEnergy()).states]
    assert "sensed.x" not in names and "tick" in names
    assert [c.name for c in link(program, paddle).states] == ["plant.x", "plant.v", "sensed.x", "fault"]


@pytest.mark.parametrize("real", ["f32", "f64"])
def test_scene_states_of_every_type(real):
    """A counter (i32), a latch (bool) and a sum (real): F counts ticks until the handle passes 1 mm, then holds."""
    first = Builder(real)
    init = first.block(states=[first.const(0, "i32"), first.const(False), first.const(0.0, real)])
    builder = Builder(real)
    position = builder.leaf("input", 0, real)
    count, latch, total = (builder.leaf("state", j, type) for j, type in enumerate(("i32", "bool", real)))
    passed = latch | (position > 0.001)
    number = builder.emit("itof", count, type=real)
    total = select(passed, total, total + number * 0.01)
    tick = builder.block([total], [builder.emit("iadd", count, builder.const(1, "i32")), passed, total])
    states = (Channel("count", "1", "i32"), Channel("latch", "1", "bool"), Channel("total", "N", real))
    program = Program("latch", (Channel("x", "m", real),), (), states, (Channel("F", "N", real),), init, tick, 1e-3)
    log = SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=Hand(push=2)).run(program, duration=0.05)
    passed = int(np.argmax(log.x > 0.001))
    expected = 0.01 * np.cumsum(np.arange(50))
    expected[passed:] = expected[passed - 1]
    assert 3 < passed < 40 and log.F == pytest.approx(expected, rel=1e-6)


def test_inputs_no_paddle_has_are_refused():
    builder = Builder("f64")
    tick = builder.block([cast(builder.leaf("input", 0, "f64"), "f64")])
    channel = (Channel("gaze", "rad", "f64"),)
    program = Program("odd", channel, (), (), (Channel("F", "N", "f64"),), Block(), tick, 1e-3)
    with pytest.raises(PaddleError, match=r"odd needs the input gaze; a paddle gives x \[m\] and v \[m/s\] only."):
        link(program, SimulatedPaddle(m=1, b=0, T=1e-3))
