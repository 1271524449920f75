"""A simulated paddle advanced piece by piece: the bits of one run, parameters and grips that change between ticks."""

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab.device.simulated.stepping import Stepping, with_grip

SCENE = hl.wall("half_sample")(k=400, x_o=0.004, B=0.5)
COLUMNS = ("t", "x", "v", "F")


def push(t):
    return 0.012 * np.sin(9 * np.asarray(t))


def in_pieces(stepping, ticks, pieces, path=push):
    """Advance by pieces of these lengths, again and again, and put together what came."""
    T, found, done = stepping.paddle.T, [], 0
    while done < ticks:
        piece = min(pieces[len(found) % len(pieces)], ticks - done)
        found.append(stepping.advance(path(np.arange(done, done + piece + 1) * T)))
        done += piece
    return {name: np.concatenate([part[name] for part in found]) for name in found[0]}


@pytest.mark.parametrize(
    "more",
    [
        {},
        {"counts_per_metre": 78125.0},
        {"delay": 1.3e-3},
        {"coulomb": 0.03, "noise": 1e-5},
        {"force_max": 1.0},
        {"delay": 3e-4, "sensor_delay": 1.6e-3},
        {"force_max": 1.0, "duty_dead": 0.1, "compensated": False},
    ],
    ids=["plain", "encoder", "delay", "friction and noise", "limit", "sensor lag", "motor"],
)
@pytest.mark.always("plain", "encoder", "delay", "limit", "sensor lag", "motor")
def test_pieces_are_bit_for_bit_one_run(more):
    hand = hl.Hand(m=0.02, b=1.0, k=200.0, push_noise=0.01, intent=push)
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hand, seed=3, **more)
    run = paddle.run(SCENE, duration=0.4)
    pieces = in_pieces(Stepping(paddle, SCENE), 400, (17, 1, 33))
    for name in run.columns:
        assert np.array_equal(getattr(run, name), pieces[name]), name


def test_the_interpreter_gives_the_same_bits():
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand("pinch"))
    found = [in_pieces(Stepping(paddle, SCENE, engine=engine), 60, (7,)) for engine in ("auto", "interpreter")]
    for name in COLUMNS:
        assert np.array_equal(found[0][name], found[1][name]), name


def test_a_parameter_holds_from_the_next_tick_on():
    """A wall set anew half way is, bit for bit, a scene with two walls that a clock chooses between."""
    k, later, t_k = hl.parameters("k later t_k", units="N/m N/m s", values=(400, 900, 0.1))
    x, n, T = hl.x(hl.n), hl.n, hl.T
    choosing = hl.Scene(force=hl.when(n * T < t_k, k * x, later * x))
    one = hl.Scene(force=k * x)
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=2.0**-10, hand=hl.Hand("pinch", intent=push))
    run = paddle.run(choosing, duration=0.2, dtype="float64")
    stepping = Stepping(paddle, one, dtype="float64")
    switch = int(np.argmax(run.t >= 0.1))
    before = in_pieces(stepping, switch, (10,))
    stepping.set(k=900)
    after = in_pieces(stepping, len(run) - switch, (10,), lambda t: push(t + switch * paddle.T))
    assert np.array_equal(np.r_[before["x"], after["x"]], run.x)
    assert np.array_equal(np.r_[before["F"], after["F"]], run.F)


def test_let_go_the_handle_coasts_as_its_mass_and_damper_do():
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand("pinch"))
    stepping = Stepping(paddle, hl.wall()(k=0, x_o=0.01), dtype="float64")
    stepping.advance(np.linspace(0, 0.02, 101))
    x, v = stepping.place, float(stepping.advance(np.full(2, 0.02))["v"][0])
    stepping.hold(False)
    found = stepping.advance(np.zeros(201))
    t = np.arange(200) * 1e-3
    start = found["x"][0], found["v"][0]
    decay = np.exp(-t * 0.1 / 0.05)
    assert np.allclose(found["v"], start[1] * decay, rtol=1e-12)
    assert np.allclose(found["x"], start[0] + start[1] * 0.5 * (1 - decay), rtol=1e-12)
    assert np.isnan(found["intent"]).all()
    assert abs(start[0] - x) < 2e-3 * abs(v)


def test_taken_again_nothing_jumps_and_the_hand_leads():
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand("grip"))
    stepping = Stepping(paddle, hl.wall()(k=0, x_o=1.0))
    stepping.hold(False)
    stepping.advance(np.zeros(11))
    place = stepping.place
    stepping.hold(True)
    found = stepping.advance(np.full(2001, 0.01))
    assert found["x"][0] == np.float32(place)
    assert abs(found["x"][-1] - 0.01) < 1e-7
    stepping.start()
    assert (stepping.ticks, stepping.place, stepping.fault) == (0, 0.0, None)


def test_a_fault_is_told_as_a_run_tells_it():
    k, end = hl.parameters("k end", units="N/m^0.5 m", values=(1, "1 mm"))
    scene = hl.Scene(force=k * sp.sqrt(end - hl.x(hl.n)))
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand("pinch", intent=push))
    stepping = Stepping(paddle, scene)
    rows = in_pieces(stepping, 100, (6,))
    assert stepping.fault == paddle.run(scene, duration=0.1).fault
    stopped = int(stepping.fault.split()[1].strip(":"))
    assert rows["F"][stopped - 1] > 0 and not rows["F"][stopped:].any()


def test_a_value_past_its_range_is_refused_and_nothing_changes():
    stepping = Stepping(hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3), SCENE)
    with pytest.raises(hl.errors.ParameterError, match="needs k >= 0"):
        stepping.set(k=-1)
    with pytest.raises(hl.errors.ParameterError, match="not a live parameter of half_sample wall."):
        stepping.set(q=1)
    assert dict(zip([c.name for c in stepping.program.parameters], stepping.program.values, strict=True))["k"] == 400


def test_a_hand_without_a_spring_is_a_pinch():
    bare = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand(push=2.0))
    assert with_grip(bare).hand.k == hl.Hand("pinch").k
    assert with_grip(bare).hand.push == 0


def test_telemetry_begins_at_zero_and_keeps_changes():
    paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, force_max=1.0, hand=hl.Hand("pinch"))
    stepping = Stepping(paddle, SCENE)
    stepping.advance(np.zeros(101))
    rows = stepping.advance(np.linspace(0, 0.02, 101))
    log = stepping.telemetry(rows, values={"k": 400.0}, changes=((0.15, {"k": 500.0}),))
    assert log.t[0] == 0 and len(log) == 100
    assert log.changes[0][0] == pytest.approx(0.05, abs=1e-12)
    assert log.units["intent"] == "m"
