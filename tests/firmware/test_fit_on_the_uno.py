"""What is refused before it is sent, and what is sent, on the emulated Uno: what is said to fit fits."""

import math
import re

import numpy as np
import pytest
import sympy
from emulated import emulated_uno
from emulator import INT0, INT1, TIMER1_COMPA, missing
from five_scenes import SCENES, cart_pole, mass_and_wall, pendulum, wall

import hapticlab as hl
from hapticlab.compiler.boards.board_fit import fit
from hapticlab.compiler.boards.cost import cost
from hapticlab.device.board.settings import nominal
from hapticlab.device.link.messages import SENSORS
from hapticlab.errors import ProgramLimitError

pytestmark = pytest.mark.skipif(missing() is not None, reason=str(missing()))
HAND = hl.Hand(m=0.05, b=3, k=400, intent=lambda t: 0.004 * np.sin(9 * t) + 0.003 * np.sin(31 * t))


def test_a_scene_that_does_not_fit_is_refused_with_what_would():
    scene, options = pendulum()
    words = r"pendulum with rk4: .* of a 1 ms period on uno .*fits with method='"
    with emulated_uno() as paddle, pytest.raises(ProgramLimitError, match=words):
        paddle.run(scene, duration=0.1, **options)
    with emulated_uno(T=2e-3) as paddle:
        assert paddle.run(scene, duration=0.1, method="semi_implicit_euler").fault is None


@pytest.mark.wide
def test_the_cost_said_before_is_the_load_measured_after():
    hand = hl.Hand(m=0.05, b=3, k=400, intent=lambda t: 0.006 * np.sin(9 * t) + 0.003 * np.sin(31 * t))
    with emulated_uno(hand) as paddle:
        scene, _ = wall()
        said, board = paddle.cost(scene), paddle.loop.board
        paddle.start(scene)
        count, mean, _ = board.cost(TIMER1_COMPA)
        paddle.wait(1.0)
        count_after, mean_after, worst = board.cost(TIMER1_COMPA)
        paddle.stop()
    cycles = (count_after * mean_after - count * mean) / (count_after - count)  # the whole interrupt, others in it too
    assert cycles == pytest.approx(said.typical + said.step[0], rel=0.1)  # what is said of a typical time
    assert worst <= said.longest() <= said.longest(promise=True)


@pytest.mark.wide
@pytest.mark.parametrize("every", [50, 333])
def test_rare_samples_leave_the_heartbeat_alone(every):
    with emulated_uno() as paddle:
        log = paddle.run(wall()[0], duration=1.0, every=every)
        assert log.fault is None and log.every == every and len(log) == -(-1000 // every)


# ---------------------------------------------------------------- what is said to fit, while parameters are set


def clips():
    """Return a scene of nine parameters: the largest SET there is, and memory nearly full."""
    a = hl.parameters("a0 a1 a2 a3 a4 a5 a6 a7", units="m m m m m m m m")
    k, force = hl.parameters("k", units="N/m"), 0
    for j in range(8):
        g = hl.x(hl.n)
        for i in range(4):
            g = sympy.Max(sympy.Min(g, a[(j + i) % 8]), -a[(j + i + 1) % 8])
        force += g
    return hl.Scene(k * force / 8, name="clips")(k=20, **{f"a{j}": 0.002 * (j + 1) for j in range(8)}), {}


def whole_us(T):
    return math.ceil(T * 1e6) * 1e-6


def period_needed(make, every, promise):
    """Return the shortest period in whole microseconds; the scene's own constants hold it, so it is looked for twice."""
    scene, options = make()
    T = 2e-3
    for _ in range(3):
        T = whole_us(cost(hl.compile(scene, T=T, **options), every=every).T_needed(promise))
    return T


#: a slow handle, so that its magnet may be looked at every 10 ms
SLOW = nominal("hapkit", wired=1, checked=1, ident=0x3F2A, date=20261120, speed_max=0.4)


def holds(scene, options, T, every, sets=60, settings=SLOW, hand=HAND):
    """Run while all parameters, up to 8, are set a hundred times a second, heartbeats between; nothing may be late or lost."""
    with emulated_uno(hand, T=T, settings=settings) as paddle:
        board = paddle.loop.board
        paddle.start(scene, every=every, check_fit=False, **options)
        values = paddle._loaded.program.values[:8]
        rest = b"".join(bytes([k]) + np.float32(v).tobytes() for k, v in enumerate(values))
        edges = sum(board.cost(v)[0] for v in (INT0, INT1))
        for k in range(sets):
            if values:
                paddle.exchange.command("SET", len(values), rest=rest)
            paddle.wait(0.01 + (k * 0.382 % 1) * T)
        edges = (sum(board.cost(v)[0] for v in (INT0, INT1)) - edges) / (sets * 0.01)
        longest = board.cost(TIMER1_COMPA)[2]
        log = paddle.stop()
    said = f"T = {T * 1e6:.0f} us, every={every}: {log.fault or 'no fault'}, {paddle.timing}, longest {longest} cycles"
    print("\n" + said)
    assert log.fault is None, said
    assert paddle.timing.overruns == paddle.timing.lost == 0, said
    assert (np.round(np.diff(log.t) / (T * every)) == 1).all(), said
    return longest, edges


CASES = [
    pytest.param(make, every, promise, marks=() if make in (wall, clips) and every == 1 else pytest.mark.slow)
    for make in (wall, mass_and_wall, cart_pole, pendulum, clips)
    for every in (1, 2, 10)
    for promise in (False, True)
]


@pytest.mark.parametrize("make, every, promise", CASES)
@pytest.mark.always("wall-1-True")
def test_at_the_shortest_period_that_fits_no_step_is_late_and_no_sample_lost(make, every, promise):
    scene, options = make()
    T = period_needed(make, every, promise)
    said = cost(hl.compile(scene, T=T, **options), every=every)
    assert said.promised if promise else said.fits
    longest, _ = holds(scene, options, T, every)
    assert longest <= said.longest(promise)


def named(message):
    """Return the alternatives that a refusal names, as keyword arguments."""
    for words in message.split("; fits ")[1].split(", or "):
        numbers = dict(re.findall(r"(substeps|every|T) ?= ?([\d.e-]+)", words))
        made = {name: float(n) if name == "T" else int(n) for name, n in numbers.items()}
        yield dict(re.findall(r"(\w+)='(\w*)'", words)) | made


@pytest.mark.wide
@pytest.mark.parametrize(
    "make, T",
    [pytest.param(m, T, marks=() if (m, T) == (wall, 0.45e-3) else pytest.mark.slow)
     for m in SCENES for T in (0.45e-3, 0.7e-3, 1e-3, 2e-3)],
)  # fmt: skip
@pytest.mark.parametrize("promise", [False, True])
def test_every_offer_of_a_refusal_holds(make, T, promise):
    scene, options = make()
    try:
        fit(scene, T=T, promise=promise, **options)
    except ProgramLimitError as refusal:
        offers = list(named(str(refusal)))
    else:
        offers = [{}]
    for offer in offers:
        given = {**options, **offer}
        T_offered, every = given.pop("T", T), given.pop("every", 1)
        if given.get("live") == "":
            given["live"] = ()
        law = given.pop("law", None)
        offered = hl.wall(law)(**scene.values) if law else scene
        holds(offered, given, T_offered, every, sets=25)


@pytest.mark.slow
def test_edges_of_an_encoder_are_part_of_the_step():
    scene, options = clips()
    kept = nominal("hapkit", wired=1, checked=1, ident=1, date=20261120, sensor=1, metres_per_count=2e-5)
    fast = hl.Hand(m=0.05, b=60, k=8000, intent=lambda t: 0.02 * np.sin(45 * t))
    edges = 60_000
    T = 2e-3
    for _ in range(3):
        T = whole_us(cost(hl.compile(scene, T=T), edges_per_second=edges).T_needed(promise=True))
    _, measured = holds(scene, options, T, 1, settings=kept, hand=fast)
    assert 10_000 < measured <= edges


def test_an_encoders_edges_are_counted_where_there_is_one():
    """As many as the speed limit allows: 2 m/s over 12.8 um are 156 250 in a second, of 103 cycles each."""
    costs = []
    for sensor in ("MAGNETORESISTIVE", "QUADRATURE"):
        with emulated_uno(settings=nominal("hapkit", wired=1, checked=1, ident=1, sensor=SENSORS[sensor])) as paddle:
            costs.append(paddle.cost(wall()[0]))
    without, edges = costs
    assert (without.edges, edges.edges) == (0.0, pytest.approx(103 * 2 / 12.8e-6, rel=0.05))
    assert edges.T_needed() > 2 * without.T_needed() and "none counted" in str(without)
