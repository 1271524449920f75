"""Uploads over a line that loses, and settings back."""

import pytest
from bad_line import lossy_port
from host_driver import fixed, settings, spring

import hapticlab as hl
from hapticlab.compiler.engines.bytecode import encode
from hapticlab.device.board.serial_paddle import SerialPaddle
from hapticlab.device.board.settings import nominal
from hapticlab.device.board.upload import PIECE, check_room, read_settings, upload
from hapticlab.device.link.exchange import Exchange
from hapticlab.device.link.messages import LARGEST_PAYLOAD, MESSAGES, STATES, TARGETS
from hapticlab.errors import LinkError, PaddleError


def talking(**judges):
    exchange = Exchange(lossy_port(**judges))
    exchange.ask("HELLO", exchange.session)
    return exchange


def every_third():
    count = 0

    def keep(frame):
        nonlocal count
        count += 1
        return count % 3 != 0

    return keep


@pytest.mark.parametrize("way", ["told", "heard"])
@pytest.mark.parametrize("target", TARGETS)
def test_an_upload_survives_every_third_frame_lost(way, target):
    exchange = talking(**{way: every_third()})
    kept = settings(wired=0, checked=0)  # as anything that a board has not confirmed
    data = kept.to_bytes() if target == "SETTINGS" else encode(fixed(0.5), word_bits=16)
    assert len(data) > 2 * PIECE - LARGEST_PAYLOAD
    upload(exchange, target, data)
    if target == "SETTINGS":
        assert read_settings(exchange) == kept.to_float32()


@pytest.mark.parametrize("lost", range(1, 5))
def test_a_piece_that_never_arrives_ends_in_words_and_nothing_is_taken(lost):
    pieces = 0

    def told(frame):
        nonlocal pieces
        pieces += frame is not None and frame.message == "DATA" and frame.sequence != told.last
        told.last = frame.sequence if frame is not None and frame.message == "DATA" else told.last
        return not (frame is not None and frame.message == "DATA" and pieces == lost)

    told.last = None
    exchange = talking(told=told)
    data = encode(spring(K=2.0), word_bits=16) + b"x" * 200
    with pytest.raises(LinkError, match="does not answer DATA"):
        upload(exchange, "PROGRAM", data)
    assert not exchange.refresh()["flags"] & 32


@pytest.mark.parametrize("data, result", [
    (b"x" * 40000, "TOO_LARGE"), (b"not a program, though long enough for one: 40 bytes", "MAGIC"), (b"x", "SIZE")])  # fmt: skip
def test_what_is_no_program_is_refused_by_name(data, result):
    with pytest.raises(LinkError, match=result) as refusal:
        upload(talking(), "PROGRAM", data)
    assert refusal.value.result == result


def test_a_board_without_settings_has_none():
    exchange = talking()
    exchange.port.put_on(None, store=b"")
    exchange.ask("HELLO", exchange.session)
    assert read_settings(exchange) is None


UNO = {"period_min": 250, "period_max": 10_000, "channels": 8}


@pytest.mark.parametrize(
    ("T", "kept", "words"),
    [
        (20e-3, settings(), r"T = 0.02 s; this board needs 0.00025 to 0.01 s. Use T=0.01"),
        (1e-4, settings(), r"T = 0.0001 s; this board needs 0.00025 to 0.01 s. Use T=0.00025"),
        # 3/8 of 920 counts of 12.8 um at 2 m/s: 2.208 ms
        (
            2e-4,
            nominal("hapkit", sensor_flight=3e-4),
            r"needs 0.0003 to 0.01 s, because its sensor takes 0.0003 s .* Use T=0.0003",
        ),
        (4e-3, nominal("hapkit"), r"needs 0.00025 to 0.002208 s, because at speed_max = 2 m/s its magnet .* Use T=0.002208"),
    ],
)
def test_a_period_the_board_cannot_do_is_refused_with_the_nearest_it_can(T, kept, words):
    with pytest.raises(PaddleError, match=words):
        check_room(UNO, kept, spring(K=1.0, T=T))


def test_a_period_it_can_do_passes():
    check_room(UNO, nominal("hapkit"), spring(K=1.0, T=2e-3))
    check_room(UNO, None, spring(K=1.0, T=10e-3))


def test_a_slow_upload_does_not_let_the_running_scene_fall_silent():
    """Pieces of a program are no word of the host to the board: between them it says that it is there."""
    lost = 0

    def heard(frame):
        nonlocal lost
        if frame is None or frame.message != "ACK" or frame.fields["request"] != MESSAGES["DATA"].number:
            return True
        lost += 1
        return lost % 6 == 0  # five tries of 30 ms each for every piece

    port = lossy_port(heard=heard)
    with SerialPaddle("sim://hapkit", port=port) as paddle:
        paddle.home(at=port.handle.x)
        k = hl.parameters("k", units="N/m")
        paddle.start(hl.Scene(force=k * hl.x(hl.n), name="spring")(k=10.0))
        begun = paddle.exchange.now()
        upload(paddle.exchange, "PROGRAM", encode(spring(), word_bits=16))
        assert paddle.exchange.now() - begun > 0.3 and lost > 10
        assert paddle.state()["state"] == STATES["RUN"]


def test_questions_that_are_no_word_of_the_host_do_not_put_off_its_heartbeat():
    lost = 0

    def heard(frame):
        nonlocal lost
        lost += frame is not None and frame.message == "PONG"
        return frame is None or frame.message != "PONG" or lost % 2 == 0

    port = lossy_port(heard=heard)
    with SerialPaddle("sim://hapkit", port=port) as paddle:
        paddle.home(at=port.handle.x)
        paddle.start(hl.Scene(force=hl.parameters("k", units="N/m") * hl.x(hl.n), name="spring")(k=10.0))
        begun = paddle.exchange.now()
        for token in range(30):
            paddle.exchange.ask("PING", token, patience=0.01)
        assert paddle.exchange.now() - begun > 0.2
        assert paddle.state()["state"] == STATES["RUN"]
