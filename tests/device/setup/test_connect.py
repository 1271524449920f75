"""Finding a paddle: by its answer, never by its USB numbers alone, and each failure says what to do."""

import pytest

import hapticlab as hl
from hapticlab.device.board.serial_paddle import SerialPaddle
from hapticlab.device.link.serial_ports import Port
from hapticlab.device.setup import connect as module
from hapticlab.device.urls import protocol_sim
from hapticlab.errors import LinkError, PaddleError, PortError

KNOWN = {"known": "Arduino Uno R3"}


@pytest.fixture
def plugged(monkeypatch):
    """Say which ports there are, and get the list of those that were opened."""
    opened, real = [], protocol_sim.Serial.open

    def noted(port):
        opened.append(port.port)
        real(port)

    monkeypatch.setattr(protocol_sim.Serial, "open", noted)

    def plug(*ports):
        monkeypatch.setattr(module, "available_ports", lambda: list(ports))
        return opened

    return plug


def test_the_one_that_answers_is_taken_and_no_stranger_is_opened(plugged):
    opened = plugged(Port("sim://eth", "somebody's robot"), Port("sim://hapkit", **KNOWN))
    with hl.connect() as paddle:
        assert paddle.url == "sim://hapkit" and isinstance(paddle, SerialPaddle)
    assert opened == ["sim://hapkit"]


def test_several_paddles_are_listed_and_none_is_taken(plugged):
    plugged(Port("sim://hapkit", **KNOWN), Port("sim://eth", **KNOWN))
    with pytest.raises(
        PortError, match=r"2 paddles are plugged in: sim://hapkit: host 0000.*Say which: connect\('sim://hapkit'\)"
    ):
        hl.connect()


def test_no_board_names_what_there_is_and_what_to_do(plugged):
    plugged(Port("COM7", "Bluetooth"))
    with pytest.raises(PortError, match=r"found COM7 \(Bluetooth\).*some carry power only.*connect\(\"COM3\"\)"):
        hl.connect()
    plugged()
    with pytest.raises(PortError, match="no serial port at all"):
        hl.connect()


def test_a_known_board_without_our_firmware_is_told_apart(plugged, monkeypatch):
    plugged(Port("sim://hapkit", **KNOWN))
    monkeypatch.setattr(protocol_sim.Serial, "write", lambda port, data: len(data))  # a deaf device
    with pytest.raises(PortError, match=r"no paddle answers within 0.4 s.*`hapticlab flash`"):
        hl.connect(hello=0.4)


def test_firmware_of_another_version_is_refused_with_the_cure(monkeypatch):
    monkeypatch.setattr("hapticlab.device.board.greeting.table_hash", lambda: 1)
    both = rf"firmware 2.0 uses .* from firmware 2.0, which comes with hapticlab {hl.__version__}.*: hapticlab flash"
    with pytest.raises(LinkError, match=both):
        hl.connect("sim://hapkit")


def test_mechanics_are_for_simulated_boards_only():
    with pytest.raises(PaddleError, match='connect\\("sim://hapkit", paddle=...\\)'):
        hl.connect(paddle=hl.SimulatedPaddle(m=1, b=1, T=1e-3))
    with pytest.raises(PaddleError, match="simulated board, which loop:// is not"):
        hl.connect("loop://", paddle=hl.SimulatedPaddle(m=1, b=1, T=1e-3))


def test_a_looped_line_is_no_paddle():
    """Its own words come back: a cable that joins both lines, or an echo."""
    with pytest.raises(LinkError, match="no paddle answers"):
        hl.connect("loop://", hello=0.2)


@pytest.mark.parametrize("url", ["sim://nobody", "sim://hapkit?pace=fast"])
def test_a_simulation_that_does_not_exist_says_which_do(url):
    with pytest.raises(PaddleError, match=r"sim://eth|needs pace=real"):
        hl.connect(url)


def test_it_introduces_itself_in_a_line():
    kept = hl.device.board.settings.nominal("hapkit", ident=0x3F2A, date=20261120, wired=1, checked=1, force_max=5.0)
    port = hl.device.link.serial_ports.open_port("sim://hapkit")
    port.put_on(None, settings=kept)
    with SerialPaddle("sim://hapkit", port=port, T=5e-4) as paddle:
        assert str(paddle) == "host 3F2A, firmware 2.0, T = 0.5 ms, calibrated 2026-11-20, |F| <= 5 N"


def test_a_simulated_handle_that_starts_elsewhere_is_where_it_is():
    port = hl.device.link.serial_ports.open_port("sim://hapkit")
    port.put_on(hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3), x=0.0125)
    with SerialPaddle("sim://hapkit", port=port) as paddle:
        paddle.home(at=port.handle.x)
        assert paddle.state()["x"] == pytest.approx(0.0125, abs=1e-7)
        log = paddle.run(hl.Scene(force=hl.parameters("k", units="N/m") * hl.x(hl.n), name="spring")(k=10), duration=0.002)
        assert log.x[0] == pytest.approx(0.0125, abs=1e-7) and log.F[0] == pytest.approx(0.125, abs=1e-6)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: hl.connect("sim://hapkit", T="a"), "T = 'a'; a paddle needs T > 0. Give a number in s"),
        (lambda: hl.connect("sim://hapkit", T=0), "T = 0 s; a paddle needs T > 0"),
        (lambda: hl.connect("sim://hapkit", T=1), "T = 1 s; this board needs 5e-05 to 0.03 s. Use T=0.03"),
        (lambda: hl.connect("sim://hapkit", paddle=5), "paddle = 5; needs a SimulatedPaddle"),
        (lambda: hl.connect("sim://hapkit?pce=real"), r"pce is not an option of a simulated board\. .*pace=real"),
        (lambda: hl.connect("sim://hapkit/x"), "sim://hapkit/x: no such paddle"),
        (
            lambda: hl.connect("sim://hapkit", T=1e-3, paddle=hl.SimulatedPaddle(m=1, b=1, T=2e-3)),
            "T = 0.001 s, but the paddle has T = 0.002 s. Give only one of them.",
        ),
    ],
)
def test_wrong_arguments_are_refused_in_words(call, words):
    with pytest.raises(PaddleError, match=words):
        call()


def test_a_paddle_brings_its_period_and_wrong_values_name_the_range():
    with hl.connect("sim://hapkit", paddle=hl.SimulatedPaddle(m=1, b=1, T=2e-3)) as paddle:
        assert paddle.T == 2e-3 and repr(paddle).startswith("<SerialPaddle sim://hapkit: host 0000, firmware 2.0, T = 2 ms")
        with pytest.raises(PaddleError, match=r"at = 10 m; the handle's travel is -0.5 to 0.5 m"):
            paddle.home(at=10)
        for wrong, words in (
            (-1, "force_max = -1 N; a run needs force_max >= 0"),
            ("2 kN/m", "force_max = '2 kN/m'; needs a quantity in N"),
        ):
            with pytest.raises(PaddleError, match=words):
                paddle.start(hl.wall()(k=1, x_o=0), force_max=wrong)
