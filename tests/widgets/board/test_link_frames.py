"""One set of recorded frames, and both hosts: what Python sends and takes a page sends and takes."""

import json
import subprocess

import core_in_node
import pytest
from scripted_port import ScriptedPort
from write_link_frames import FILE, Decoder, decode, decoded, encode, text

from hapticlab.device.board import message_scripts
from hapticlab.device.link.exchange import Exchange
from hapticlab.errors import LinkError
from hapticlab.widgets.browser_view import BROWSER

FRAMES = json.loads(FILE.read_text("utf-8"))
STREAMS = FRAMES["streams"]


class Port(ScriptedPort):
    """A port in virtual time that says this after the first thing it is told."""

    def __init__(self, said):
        super().__init__()
        self.said = said

    def write(self, data):
        self.heard, self.said = self.said, b""


def reply(ask):
    """What Python's host takes for the reply."""
    exchange = Exchange(Port(b"".join(map(bytes.fromhex, ask["came"]))))
    try:
        fields = exchange.ask(ask["message"], *([exchange.session] if ask["message"] == "STATUS" else []), tries=1).fields
    except LinkError:
        return None
    return fields["tick"] if ask["message"] == "STATUS" else [fields["result"], fields["tick"]]


@pytest.fixture(scope="module")
def page():
    """What the page's host makes of the same."""
    if core_in_node.missing():
        pytest.skip(core_in_node.missing())
    done = subprocess.run(["node", FILE.with_suffix(".mjs")], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_the_page_has_the_tables_of_this_package():
    for name, written in message_scripts.generate().items():
        again = "python -m hapticlab.device.board.message_scripts hapticlab/widgets/browser/board"
        assert (BROWSER / "board" / name).read_text("utf-8") == written, again


def test_the_recorded_frames_are_what_a_session_with_the_board_gives():
    assert FILE.read_text("utf-8") == text(), "python tests/vectors/write_link_frames.py"


def test_both_hosts_send_the_recorded_requests(page):
    assert [row["bytes"] for row in FRAMES["requests"]] == page["requests"]
    for row in FRAMES["requests"]:
        sent = encode(row["message"], row["sequence"], *row["values"], rest=bytes.fromhex(row["rest"]), session=FRAMES["session"])
        assert sent.hex() == row["bytes"]


@pytest.mark.parametrize("name", STREAMS)
def test_both_hosts_take_the_same_frames_of_a_stream(page, name):
    stream = STREAMS[name]
    kept = {"frames": stream["frames"], "damaged": stream["damaged"]}
    assert decoded(map(bytes.fromhex, stream["chunks"])) == kept
    assert page["streams"][name] == kept


def test_streams_lose_what_was_damaged_and_nothing_else():
    whole = [row[:3] for row in STREAMS["whole"]["frames"]]
    assert len(whole) > 10 and STREAMS["whole"]["damaged"] == 0
    for name in ("pieces", "noise before", "zeros between"):
        assert [row[:3] for row in STREAMS[name]["frames"]] == whole, name
    assert [row[:3] for row in STREAMS["out of order"]["frames"]] == whole[::-1]
    assert len(STREAMS["doubled"]["frames"]) == 2 * len(whole)
    assert 0 < len(STREAMS["bits flipped"]["frames"]) < len(whole) and STREAMS["bits flipped"]["damaged"] > 3
    assert len({name for name, *_ in whole}) == 7  # all that a board says
    assert STREAMS["another protocol"]["frames"] == STREAMS["an unknown message"]["frames"] == []
    assert Decoder().feed(b"") == []


def test_both_hosts_check_the_guard_as_a_board_does(page):
    assert page["guards"] == [frame for *_, frame in FRAMES["guards"]]
    for data, session, frame in FRAMES["guards"]:
        found = decode(bytes.fromhex(data), session)
        assert (found and [found.message, found.sequence, found.payload.hex()]) == frame
    assert sum(frame is not None for *_, frame in FRAMES["guards"]) == len(FRAMES["guards"]) / 4


@pytest.mark.parametrize("name", FRAMES["asks"])
def test_both_hosts_take_the_same_frame_for_the_reply(page, name):
    ask = FRAMES["asks"][name]
    assert reply(ask) == page["asks"][name] == ask["reply"]
