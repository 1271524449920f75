"""What the front says to a browser and hears from it, byte by byte; the browser's half is tests/browser."""

import re
import struct

import numpy as np
import pytest

pytest.importorskip("anywidget")

from hapticlab.widgets.browser_view import BROWSER, KINDS, SCRIPTS, Listener, Speaker, front
from hapticlab.widgets.frame import Frame
from hapticlab.widgets.session import PRESSES

PICTURE = (
    ("line", [(0.0, 0.0), (0.01, 0.0), (0.02, 0.005)], {"width": 1.5, "colour": "#000000", "dash": (6, 4)}),
    ("spring", [(0.0, 0.0), (0.01, 0.0)], {"high": 0.002, "coils": 5}),
    ("label", [(0.03, 0.01), (0.03, 0.02)], {"words": "handle", "colour": "#3f5563"}),
    ("arrow", [(0.0, 0.01), (0.02, 0.01)], {"colour": "#000000"}),
)


class Session:
    """Notes what it is told."""

    def __init__(self, kind="simulated"):
        self.kind, self.told, self.now = kind, [], 1000.0

    def description(self):
        return {"kind": self.kind, "speed": 1.0, "parameters": [], "traces": [], "title": "a wall"}

    def connect(self, sink):
        self.sink = sink

    def clock(self):
        return self.now

    def __getattr__(self, name):
        return lambda *given: self.told.append((name, *given))


def message(kind, value=0.0, more=0.0, view=7):
    return np.array([view, KINDS.index(kind), value, more], "<f8").tobytes()


def frame(**changed):
    given = dict(time=1.5, rows=np.arange(15, dtype=np.float32).reshape(3, 5), picture=PICTURE, status="Running.")
    return Frame(**(given | {"flags": {"running": True, "values": {"k": 300.0}}} | changed))


def test_a_frame_is_header_rows_and_points():
    sent = []
    Speaker(lambda content, buffers: sent.append((content, buffers[0]))).say(frame())
    content, data = sent[0]
    _, time, rows = struct.unpack_from("<3d", data)
    numbers = np.frombuffer(data, "<f4", offset=24)
    assert (time, rows) == (1.5, 3)
    np.testing.assert_array_equal(numbers[:15], np.arange(15))
    np.testing.assert_allclose(numbers[15:21], [0, 0, 0.01, 0, 0.02, 0.005], rtol=1e-7)
    assert len(numbers) == 15 + 2 * (3 + 2 + 2 + 2)
    assert content["shape"] == [[kind, len(points), style] for kind, points, style in PICTURE]
    assert content["flags"] == {"running": True} and content["values"] == {"k": 300.0}


def test_only_news_is_said_again_and_a_new_view_hears_everything():
    sent = []
    speaker = Speaker(lambda content, buffers: sent.append(content))
    for each in (frame(), frame(status=""), frame(status="", flags={"running": False})):
        speaker.say(each)
    assert [sorted(each) for each in sent] == [["flags", "shape", "status", "values"], ["values"], ["flags", "values"]]
    speaker.forget()
    speaker.say(frame(status=""))
    assert sent[-1]["status"] == "Running." and sent[-1]["shape"]


@pytest.mark.parametrize(("late", "held"), [(0.2, False), (3.0, True)])
def test_a_page_that_is_far_behind_gets_fewer_frames_and_no_fewer_rows(monkeypatch, late, held):
    """Frames of 60 Hz over a line that delays them: a delay alone changes nothing, a jam thins them out."""
    now, sent = [50.0], []
    monkeypatch.setattr("hapticlab.widgets.browser_view.time.perf_counter", lambda: now[0])
    speaker = Speaker(lambda content, buffers: sent.append((now[0], buffers[0])))
    for k in range(300):
        now[0] += 1 / 60
        there = [when for when, _ in sent if when < now[0] - late]
        if k % 24 == 0 and there:
            speaker.heard(message("alive", 1.0, 5.0) + struct.pack("<d", there[-1]))
        elif k % 24 == 0 and late > 1:
            speaker.heard(message("alive", 1.0, 5.0) + struct.pack("<d", 50.0 + 1 / 60))
        speaker.say(frame(rows=np.full((17, 8), k, np.float32)))
    rows = sum(int(struct.unpack_from("<3d", data)[2]) for _, data in sent)
    if not held:
        assert len(sent) == 300 and rows == 300 * 17
        return
    assert len([when for when, _ in sent if 52 < when < 54]) == pytest.approx(8, abs=1)
    assert rows >= 285 * 17  # the last quarter of a second waits
    speaker.heard(message("gone"))
    speaker.say(frame(rows=np.full((17, 8), 300, np.float32)))
    assert sum(int(struct.unpack_from("<3d", data)[2]) for _, data in sent) == 301 * 17


def test_a_page_whose_words_wait_gets_every_frame(monkeypatch):
    """As in a browser's Python while a cell awaits: frames go out, and no word of the page comes in."""
    now, sent = [50.0], []
    monkeypatch.setattr("hapticlab.widgets.browser_view.time.perf_counter", lambda: now[0])
    speaker = Speaker(lambda content, buffers: sent.append(now[0]))
    for k in range(240):
        now[0] += 1 / 60
        if k < 60 and k % 24 == 23:
            speaker.heard(message("alive", 1.0, 5.0) + struct.pack("<d", sent[-1]))
        speaker.say(frame(rows=np.full((17, 8), k, np.float32)))
    assert len(sent) == 240


def run(begin, count=16):
    """A frame of a run of samples 1 ms apart; of none, a frame at rest then."""
    t = begin + np.arange(count) * 1e-3
    return frame(time=float(t[-1]) if count else begin, rows=np.repeat(t[:, None], 8, 1).astype(np.float32))


@pytest.mark.parametrize("follow", [[], [0.0, 0.016], [2.0]])
@pytest.mark.parametrize("rest", [True, False])
def test_what_waits_comes_with_the_next_frame_and_never_with_another_run(monkeypatch, follow, rest):
    now, sent = [50.0], []
    monkeypatch.setattr("hapticlab.widgets.browser_view.time.perf_counter", lambda: now[0])
    speaker = Speaker(lambda content, buffers: sent.append(buffers[0]))
    speaker.say(run(0.0))
    speaker._sent = now[0] = 60.0
    speaker.heard(message("alive", 1.0, 5.0) + struct.pack("<d", 50.0))  # the page is 10 s behind
    for k in range(10):
        now[0] += 0.01
        speaker.say(run(10.0 + 0.016 * k))
    assert len(sent) == 1
    if rest:  # the scene is paused
        speaker.say(run(10.16, 0))
    now[0] += 1.0
    for begin in follow:
        speaker.say(run(begin))
        now[0] += 1.0
    times = []
    for data in sent[1:]:
        numbers = np.frombuffer(data, "<f4", offset=24)[: 8 * int(struct.unpack_from("<3d", data)[2])].reshape(-1, 8)
        times.append(numbers[:, 0])
        assert (np.diff(times[-1]) > 0).all()
    waited = 10.0 + np.arange(160) * 1e-3 if rest else []
    expected = np.concatenate([waited, *(begin + np.arange(16) * 1e-3 for begin in follow)])
    np.testing.assert_allclose(np.concatenate([[], *times]), expected, atol=1e-6)


@pytest.mark.parametrize(
    ("said", "told"),
    [
        (message("intend", 0.012), ("intend", 0.012)),
        (message("hold", 1.0), ("hold", True)),
        (message("hold", 0.0), ("hold", False)),
        (message("move", 2, 450.0), ("move", 2, 450.0)),
        (message("press", PRESSES.index("record")), ("press", "record", 0.0)),
        (message("alive", 99.0), ("alive", "7")),
        (message("gone"), ("gone", "7")),
    ],
)
def test_what_a_view_says(said, told):
    session = Session()
    assert not Listener(session).heard(said)
    assert session.told == [told]


def test_a_page_that_was_loaded_anew_finds_the_motor_off():
    session = Session("board")
    listener = Listener(session)
    assert listener.heard(message("ready", value=100.0, view=1))
    listener.heard(message("ready", value=100.0, view=2))  # a second view in the same page
    listener.heard(message("press", PRESSES.index("start"), view=1))
    session.told.clear()
    listener.heard(message("ready", value=101.0, view=3))  # another page: the first said no goodbye
    assert session.told == [("gone", "1"), ("gone", "2"), ("press", "pause"), ("ready", "3")]


def test_a_press_that_waited_is_told_with_its_age():
    """Heartbeats and a press wait 3 s for the kernel, by the page's clock, and come in one bunch."""
    session = Session("board")
    listener, page = Listener(session), 5e8
    for at in (0.0, 0.4, 0.8):
        session.now = 1000.0 + at + 0.01
        listener.heard(message("alive", 100.0, page + at))
    session.now = 1003.8
    for at in (1.2, 1.6, 2.0):
        listener.heard(message("alive", 100.0, page + at))
    listener.heard(message("press", PRESSES.index("start"), page + 2.1))
    kind, name, age = session.told[-1]
    assert (kind, name) == ("press", "start")
    assert age == pytest.approx(1.7 - 0.01, abs=0.02)  # less what two clocks may drift apart meanwhile
    session.now = 1004.0
    listener.heard(message("press", PRESSES.index("pause"), page + 3.98))
    assert session.told[-1][2] < 0.05


def test_a_simulation_goes_on_in_a_new_page():
    session = Session()
    listener = Listener(session)
    listener.heard(message("ready", value=100.0, view=1))
    listener.heard(message("ready", value=101.0, view=2))
    assert session.told == [("ready", "1"), ("gone", "1"), ("ready", "2")]


def test_the_widget_brings_all_it_needs():
    session = Session()
    widget = front(session)
    assert widget.about["presses"] == list(PRESSES)
    assert all((BROWSER / script).read_text("utf-8") in widget._esm for script in SCRIPTS)
    for text in (widget._esm, widget._css):  # a classroom may have no network
        assert not re.search(r"https?://|\bimport\b|url\(", text)
    kinds = re.search(r"const KIND = \{(.*?)\}", widget._esm)[1]
    assert kinds.replace(" ", "") == ",".join(f"{kind}:{number}" for number, kind in enumerate(KINDS))
    widget.close()
