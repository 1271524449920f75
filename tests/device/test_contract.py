"""What every paddle must do: simulated, the firmware's core behind sim://, the emulated Uno and Pico, and a real board.

A person with a board runs it there: ``pytest tests/device/test_contract.py --port COM3``, the handle led to both stops
when asked.
"""

import numpy as np
import pytest
import sympy as sp
from emulated import emulated_uno
from emulator import missing
from pico_emulator import missing as missing_pico
from pico_loop import emulated_pico

from hapticlab.base.telemetry import Telemetry
from hapticlab.device.board.serial_paddle import SerialPaddle
from hapticlab.device.board.settings import nominal
from hapticlab.device.hand.hand import Hand
from hapticlab.device.link.serial_ports import open_port
from hapticlab.device.paddle import Paddle
from hapticlab.device.setup.connect import connect
from hapticlab.device.simulated.simulated_paddle import SimulatedPaddle
from hapticlab.errors import HapticlabError, ParameterError
from hapticlab.scene.notation.symbols import coordinate, n, parameters, t, v, when, x
from hapticlab.scene.scene import Scene

pytestmark = pytest.mark.interpreter

HAND = Hand(m=0.02, b=1, k=200, push=0.5, intent=lambda t: 0.004 * np.sin(20 * t))
PADDLES = {
    "ideal": lambda: SimulatedPaddle(m=0.05, b=0.1, T=1e-3),
    "pushed": lambda: SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=Hand(push=2.0)),
    "encoder": lambda: SimulatedPaddle(m=0.05, b=0.1, T=5e-4, counts_per_metre=2e4, rounding="nearest", hand=HAND),
    "late": lambda: SimulatedPaddle(m=0.05, b=0.1, T=1e-3, delay=1.3e-3, hand=HAND),
    "everything": lambda: SimulatedPaddle.from_profile("hapkit", delay=4e-4, coulomb=0.05, hand=HAND, noise=1e-5),
}
#: the same mechanics behind the whole protocol
BEHIND_A_PORT = ("pushed", "encoder", "late", "everything")
#: a Hapkit whose sensor takes so long from its last count back to its first, which the hand leads it over [us]
FLIGHTS = [pytest.param(f"sim:// flight {us}", marks=() if us == 200 else pytest.mark.wide) for us in (0, 50, 100, 200)]
k, x_o = parameters("k x_o", units="N/m m")
z = coordinate("z", unit="m")
WALL = Scene(force=when(x(n) >= x_o, k * (x(n) - x_o)), name="wall")


@pytest.fixture(scope="module")
def pico():
    """One board for all: what a run leaves behind is in the contract too."""
    if missing_pico():
        pytest.skip(missing_pico())
    with emulated_pico(hand=HAND) as board:
        yield board


PICO = pytest.param("emulated Pico", marks=pytest.mark.wide)


@pytest.fixture(params=[*PADDLES, *(f"sim:// {name}" for name in BEHIND_A_PORT), *FLIGHTS, "emulated Uno", PICO])
def paddle(request):
    url = request.config.getoption("--port")
    if url:  # a person's board is asked in the place of the first, and the others are left alone
        if request.param != "ideal":
            pytest.skip("a board is asked instead: --port")
        with connect(url) as board:
            yield board
    elif request.param == "emulated Uno":
        if missing():
            pytest.skip(missing())
        with emulated_uno(hand=HAND, T=2e-3) as board:
            yield board
    elif request.param == "emulated Pico":
        yield request.getfixturevalue("pico")
    elif request.param.startswith("sim:// flight"):
        port = open_port("sim://hapkit")
        told = nominal("hapkit", wired=1, checked=1, sensor_flight=float(request.param.split()[2]) * 1e-6)
        port.put_on(SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=HAND), settings=told)
        with SerialPaddle("sim://hapkit", port=port) as board:
            yield board
    elif request.param.startswith("sim://"):
        mechanics = PADDLES[request.param.split()[1]]()
        with connect("sim://hapkit", paddle=mechanics, T=mechanics.T) as board:
            yield board
    else:
        yield PADDLES[request.param]()


def test_it_is_a_paddle_and_says_what_it_is(paddle):
    assert isinstance(paddle, Paddle)
    assert np.isfinite(paddle.T) and paddle.T > 0
    assert paddle.velocity in ("measured", "backward_difference")
    assert f"T = {paddle.T:g} s" in str(paddle) or f"T = {paddle.T * 1e3:g} ms" in str(paddle)


def test_a_run_returns_one_row_a_sample(paddle):
    log = paddle.run(WALL(k=150, x_o=0.001), duration=0.2)
    assert isinstance(log, Telemetry) and len(log) == round(0.2 / paddle.T)
    assert np.allclose(log.t, np.arange(len(log)) * paddle.T, rtol=1e-12)
    assert log.T == paddle.T and log.scene == "wall" and log.paddle == str(paddle)
    assert log.parameters == {"k": 150.0, "x_o": 0.001}
    assert log.fault is None and np.isfinite([log.x, log.v, log.F]).all()


def test_force_is_the_scene_of_the_sample(paddle):
    """In float32, the precision of a board."""
    log = paddle.run(WALL(k=150, x_o=0.0005), duration=0.2)
    k, x_o, x = np.float32(150), np.float32(0.0005), log.x.astype(np.float32)
    law = np.where(x >= x_o, k * (x - x_o), 0).astype(float)
    assert np.array_equal(log.x, x) and np.array_equal(log.F[~log.saturated], law[~log.saturated])
    assert (np.abs(log.F[log.saturated]) <= np.abs(law[log.saturated])).all()


def test_states_of_a_scene_are_recorded_when_watched(paddle):
    m, K, c = parameters("m K c", units="kg N/m N*s/m")
    coupler = K * (x(t) - z) + c * (v(t) - z.diff(t))
    mass = Scene(force=coupler, eom=[sp.Eq(m * z.diff(t, 2), coupler)], watch=[z])
    log = paddle.run(mass(m=0.1, K=100, c=1), duration=0.05)
    assert log.z.shape == log.t.shape and log.units["z"] == "m"


@pytest.mark.parametrize("paddle", FLIGHTS, indirect=True)
def test_a_run_over_the_ends_of_an_angle_sensor_is_whole(paddle):
    """The hand leads an angle sensor over its end six times a second."""
    log = paddle.run(WALL(k=150, x_o=0.001), duration=2.0)
    assert log.fault is None and len(log) == round(2.0 / paddle.T)


def test_runs_are_independent(paddle):
    first, second = (paddle.run(WALL(k=150, x_o=0.001), duration=0.05) for _ in range(2))
    assert first.t[0] == second.t[0] == 0 and len(first) == len(second)


@pytest.mark.parametrize("duration", [0, -1, float("nan"), float("inf"), "1", 1e-9])
@pytest.mark.always("ideal-*", "sim:// late-*", "emulated Uno-*")
def test_bad_durations_are_refused(paddle, duration):
    with pytest.raises(HapticlabError, match="duration"):
        paddle.run(WALL(k=150, x_o=0.001), duration=duration)


def test_unbound_parameters_are_named_with_the_cure(paddle):
    said = r"wall: no value for x_o \[m\]; bind them before the run: scene\(x_o=\.\.\.\)"
    with pytest.raises(ParameterError, match=said):
        paddle.run(WALL(k=150), duration=0.05)


def test_what_is_no_scene_is_refused(paddle):
    with pytest.raises(HapticlabError, match="is not a scene"):
        paddle.run(lambda x: 5 * x, duration=0.05)
