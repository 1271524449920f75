"""The live view in a browser: what a session does as bytes for a canvas, and what its hand says; opens anywidget.

To the browser: what changed of the picture's items, the status, the flags and the values as JSON; beside it one buffer,
float64 dispatch [s], scene time [s], number of rows; then float32 the rows and every point of the picture. From the
browser: four float64, the view's number, what it says (``KINDS``), and up to two values. With "alive" and "press" the
second is the page's clock [s], so that a press that waited somewhere is known by its age; "alive" goes on with the dispatch
of the newest frame that came [s].
"""

import math
import struct
import time
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np

from ..errors import EngineMissingError
from .session import PRESSES, SILENCE

KINDS = ("ready", "alive", "gone", "intend", "hold", "move", "press")
BROWSER = Path(__file__).parent / "browser"
SCRIPTS = (
    "samples.js", "playback.js", "labels.js", "parts.js", "picture.js", "bins.js", "traces.js", "loop.js", "sound.js",
    "sliders.js", "hand.js", "words.js", "spoken.js", "controls.js", "sight.js", "view.js", "kernel.js",
)  # fmt: skip
#: time on view in the traces, of the clock [s]
SECONDS = 4.0
#: a view whose newest frame was so old [s] when it spoke gets so many a second
BEHIND, SELDOM = 1.5, 4.0
#: two clocks may drift apart so fast, and an age of a press be wrong by that of a heartbeat at most [s/s]
DRIFT = 0.01


def front(session, keys=True):
    """Return the widget that shows a session in a notebook and hands it what the browser says.

    Parameters
    ----------
    session : Session
    keys : bool
        Whether buttons have keys: False where another widget leads.

    Raises
    ------
    EngineMissingError
        Without anywidget.
    """
    widget = _canvas()(about={**about(session), "keys": keys})
    speaker, listener = Speaker(widget.send), Listener(session)

    def heard(_, content, buffers):
        if not buffers:
            return
        message = bytes(buffers[0])
        speaker.heard(message)
        if listener.heard(message):
            speaker.forget()  # a new view has seen nothing yet

    widget.on_msg(heard)
    session.connect(speaker.say)
    return widget


def about(session):
    """Facts that a view needs of a session before its first frame."""
    told = session.description()
    if told["kind"] == "board":
        told["help"] += " It also goes off when this view is out of sight for 3 s."
    return {**told, "presses": list(PRESSES), "seconds": SECONDS}


class Speaker:
    """Tells every view of a widget what a frame shows; what is as before is not said again.

    Frames are not acknowledged one by one: over a distance that would allow one for each way there and back. Instead each view
    says now and then which one it has. Where that is old, a network holds frames back, and more of them would only wait.
    """

    def __init__(self, send):
        self._send, self._said, self._status = send, {}, ""
        self._taken, self._waiting, self._sent = {}, [], 0.0

    def heard(self, message):
        """Note which frame a view has, where its message says so."""
        number, kind, *values = struct.unpack(f"<{len(message) // 8}d", message)
        if KINDS[int(kind)] == "alive" and len(values) > 2 and values[2] > 0:
            self._taken[number] = self._sent - values[2], time.perf_counter()
        elif KINDS[int(kind)] == "gone":
            self._taken.pop(number, None)

    def _is_behind(self, now):
        """Tell whether a view that spoke lately had then not had the frames of the last while."""
        return any(late > BEHIND for late, heard in list(self._taken.values()) if now - heard < SILENCE)

    def forget(self):
        """Say everything with the next frame."""
        self._said = {}

    def say(self, frame):
        """Send a frame; a moving one seldom where a view is behind, and then with the rows of those before."""
        now, self._status = time.perf_counter(), frame.status or self._status
        first = frame.rows[0, 0] if len(frame.rows) else np.float32(frame.time)
        if self._waiting and first < self._waiting[-1][-1, 0]:
            self._waiting = []  # another run, or a replay: no view needs the end of the one before
        if len(frame.rows):
            self._waiting.append(frame.rows)
            if now < self._sent + 1 / SELDOM and self._is_behind(now):
                return
        if self._waiting:
            frame, self._waiting = replace(frame, rows=np.concatenate(self._waiting)), []
        self._sent = now
        shape, points = take_apart(frame.picture)
        flags = {name: on for name, on in frame.flags.items() if name not in ("values", "wanted")}
        said = {"shape": shape, "flags": flags, "status": self._status}
        before, self._said = self._said, said
        news = {name: value for name, value in said.items() if value != before.get(name)}
        # with every frame, so that a slider whose value was refused goes back
        news["values"] = frame.flags.get("values", {})
        if "wanted" in frame.flags:  # a view that just opened, or another one, begins there
            news["wanted"] = frame.flags["wanted"]
        self._send(news, buffers=[pack(now, frame, points)])


class Listener:
    """Hands a session what its views say.

    A page that was loaded anew finds a board's motor off, also where the page before it could not say goodbye.
    """

    def __init__(self, session):
        self._session, self._pages, self._ages = session, {}, {}
        self._board = session.description()["kind"] == "board"

    def heard(self, message):
        """Take a message of a view; return whether that view is new."""
        number, kind, value, more, *_ = struct.unpack(f"<{len(message) // 8}d", message)
        view, name, session = f"{number:.0f}", KINDS[int(kind)], self._session
        if name == "ready":
            self._welcome(view, page=value)
        elif name == "gone":
            self._pages.pop(view, None)
            self._ages.pop(view, None)
            session.gone(view)
        elif name == "alive":
            self._pages[view] = value
            self._ages.setdefault(view, Age(session.clock)).of(more)
            session.alive(view)
        elif name == "press":
            session.press(PRESSES[int(value)], self._ages.setdefault(view, Age(session.clock)).of(more))
        elif name == "move":
            session.move(int(value), more)
        elif name == "hold":
            session.hold(bool(value))
        else:
            session.intend(value)
        return name == "ready"

    def _welcome(self, view, page):
        if page not in self._pages.values():
            for other in self._pages:
                self._session.gone(other)
            self._pages.clear()
            if self._board:
                self._session.press("pause")
        self._pages[view] = page
        self._session.ready(view)


class Age:
    """How old what a page says is, by the page's own clock: beside what came fastest.

    Parameters
    ----------
    clock : callable
        Seconds.

    Examples
    --------
    >>> now = iter([100.00, 100.40, 103.50])
    >>> age = Age(lambda: next(now))
    >>> [round(age.of(page), 1) for page in (7.00, 7.40, 8.00)]    # the third waited
    [0.0, 0.0, 2.5]
    """

    def __init__(self, clock):
        self._clock, self._last, self._least = clock, -math.inf, math.inf

    def of(self, page):
        """Return the age of what is heard now and was said at the page's time [s]."""
        now = self._clock()
        self._least += DRIFT * min(now - self._last, 1.0)
        self._least, self._last = min(self._least, now - page), now
        return now - page - self._least


def take_apart(picture):
    """Items of a picture, each with its number of points; and all points, shape (points, 2)."""
    shape, points = [], []
    for kind, places, style in picture:
        shape.append([kind, len(places), style])
        points += places
    return shape, np.array(points, dtype="<f4").reshape(-1, 2)


def pack(now, frame, points):
    """Return the bytes of a frame that leaves at a moment [s]."""
    rows = np.asarray(frame.rows, dtype="<f4")
    return struct.pack("<3d", now, frame.time, len(rows)) + rows.tobytes() + points.tobytes()


def around(words=""):
    """Return a widget that, in a VBox with plain ones, keeps a notebook's keys from them and gives pictures these words.

    Raises
    ------
    EngineMissingError
        Without anywidget.
    """
    return _around()(words=words)


@cache
def _around():
    anywidget, traitlets = open_anywidget()

    class Around(anywidget.AnyWidget):
        """Shows nothing."""

        _esm = (BROWSER / "around.js").read_text("utf-8")
        words = traitlets.Unicode().tag(sync=True)

    return Around


@cache
def _canvas():
    """Return the class of the widget; all that it draws with travels in it, so no network is needed."""
    anywidget, traitlets = open_anywidget()

    class LiveCanvas(anywidget.AnyWidget):
        """A canvas with buttons and sliders."""

        _esm = "\n".join((BROWSER / script).read_text("utf-8") for script in SCRIPTS)
        _css = (BROWSER / "view.css").read_text("utf-8")
        about = traitlets.Dict().tag(sync=True)

    return LiveCanvas


def open_anywidget():
    """Return the modules anywidget and traitlets; where they do not import, an error with the cure."""
    try:
        import anywidget
        import traitlets
    except ImportError as missing:
        raise EngineMissingError(
            "hl.live draws with anywidget, which does not import here; do: pip install anywidget, in the environment of the "
            "notebook"
        ) from missing
    return anywidget, traitlets
