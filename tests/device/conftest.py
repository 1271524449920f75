"""Scenes and programs the device tests run, and the board they run on."""

from types import SimpleNamespace

import pytest
from bad_line import lossy_port
from serial.urlhandler import protocol_socket

from hapticlab.compiler.ir.program import Channel, Program
from hapticlab.compiler.ir.trace import Builder, equal, select
from hapticlab.compiler.tick.compile_scene import compile
from hapticlab.device.board.serial_paddle import SerialPaddle
from hapticlab.scene.notation.symbols import n, parameters, x
from hapticlab.scene.scene import Scene


@pytest.fixture(autouse=True, scope="session")
def sockets_close_at_once():
    """Pyserial sleeps 0.3 s after each, for a server that would not be ready for the next connection: here each has its own."""
    with pytest.MonkeyPatch.context() as changed:
        changed.setattr(protocol_socket, "time", SimpleNamespace(sleep=lambda _: None))
        yield


@pytest.fixture
def board():
    """A paddle over a port that can lose what it carries, homed."""
    port = lossy_port()
    with SerialPaddle("sim://hapkit", port=port) as made:
        made.home(at=port.handle.x)
        yield made


@pytest.fixture
def spring():
    """F = K x(n), on both sides: no switching, so everything is linear."""

    def make(K, T=1e-3, dtype="float64", velocity="measured"):
        k = parameters("k", units="N/m")
        return compile(Scene(force=k * x(n), name="spring")(k=K), T=T, dtype=dtype, velocity=velocity)

    return make


@pytest.fixture
def breaks_at():
    """F = 1 N, but not a number at one tick (or its counter infinite, with state=True)."""

    def make(when, bad=float("nan"), T=1e-3, state=False):
        first = Builder("f64")
        init = first.block(states=[first.const(0.0)])
        builder = Builder("f64")
        count = builder.leaf("state", 0, "f64")
        broken = select(equal(count, float(when)), bad, 1.0)
        following = select(equal(count, float(when)), bad, count + 1.0) if state else count + 1.0
        tick = builder.block([builder.const(1.0) if state else broken], [following])
        channels = (Channel("x", "m", "f64"),), (), (Channel("count", "1", "f64"),), (Channel("F", "N", "f64"),)
        return Program("breaks", *channels, init, tick, T)

    return make
