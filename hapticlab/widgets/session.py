"""A scene that runs while somebody looks at it: inputs of a front end go in, frames come out, in a thread of its own."""

import threading
import time
from collections import deque
from contextlib import suppress
from dataclasses import asdict, replace
from pathlib import Path

from ..device.board import SerialPaddle
from ..device.live import named_values
from ..device.running import is_refusal
from ..device.simulated import SimulatedPaddle
from ..device.stepping import Stepping
from ..device.streaming import Streaming
from ..errors import HapticlabError, PaddleError
from .frame import COLUMNS, Frame
from .motion import Motion
from .picture import moving_picture
from .spans import spans
from .words import NOTICED, chatter_words, contact_words, late_words

#: presses that a front end has, see :meth:`Session.press`
PRESSES = ("start", "pause", "resume", "record", "stop", "save", "replay")
#: frames a second, and of a picture that rests
RATE, RESTING = 60.0, 4.0
#: a front end that says nothing for so long is gone [s]
SILENCE = 2.0
#: words change no sooner than this, and a note stays so long [s]
LOOK, NOTE = 0.25, 6.0
TRACES = (
    {"name": "x", "label": "x", "unit_shown": "mm", "scale": 1e3},
    {"name": "F", "label": "F", "unit_shown": "N", "scale": 1.0},
    {"name": "E", "label": "E drawn", "unit_shown": "mJ", "scale": 1e3},
)


class Session:
    """What a front end is connected to.

    A front end calls ``connect(sink)`` once, sends ``description()`` to its views, and says ``ready(view)`` for every view
    that opened, ``alive(view)`` at least once a second from each, ``gone(view)`` when one closed; ``view`` is any text that
    tells views apart. Nothing runs before the first ready; everything ends with the last view, or after 2 s of silence.
    Then the inputs: each stores what it is given and returns at once, from whatever thread. A front end may keep the
    session; it must not keep the LiveView, whose end closes the session.

    Parameters
    ----------
    paddle : SimulatedPaddle or SerialPaddle
    scene : Scene
    sliders, speed, picture
        As for :func:`hapticlab.live`.
    clock : callable
        Seconds, as time.monotonic gives them.
    in_thread : bool
        False leaves :meth:`turn` to the caller.
    **options
        Of hapticlab.compile.
    """

    def __init__(
        self, paddle, scene, *, sliders=None, speed=1.0, picture=None, clock=time.monotonic, in_thread=True, **options
    ):
        self.picture = moving_picture(scene, paddle, picture)
        self.scene = replace(scene, watch={**scene.watch, **self.picture.channels})
        self.source = source_of(paddle, self.scene, **options)
        self.spans = spans(self.source.program, sliders)
        self.motion = Motion(self.source, speed, clock)
        self.clock, self._in_thread = clock, in_thread
        self._lock, self._door, self._closed = threading.RLock(), threading.Lock(), threading.Event()
        self._views, self._thread, self._sink = {}, None, None
        self._said, self._wanted = deque(maxlen=1000), 0.0  # nobody may be there to do what is said
        self._watched, self._wants_to_run = False, self.source.kind == "simulated"
        self._note, self._note_until = "", -1.0
        self._status, self._next_look, self._next_frame = "", -1.0, -1.0

    # --- what a front end says, from whatever thread: stored, and done in the next turn

    def connect(self, sink):
        """Give frames to ``sink(frame)``, from the session's thread, 60 a second at most; one sink at a time."""
        self._sink = sink

    def ready(self, view=""):
        """Note that a view opened: the first starts a simulation, or shows that a board's motor is off."""
        self._next_frame = -1.0
        self.alive(view)

    def alive(self, view=""):
        """Note that a view is still there."""
        if not self._closed.is_set():
            self._views[view] = self.clock()
            self._keep_a_thread()

    def gone(self, view=""):
        """Note that a view closed: the last one ends the thread, and a board's motor goes off."""
        self._views.pop(view, None)

    def intend(self, x):
        """Say where the hand means to be [m]."""
        self._wanted = float(x)

    def hold(self, held):
        """Take the handle, or let go of it."""
        self._said.append(("hold", bool(held)))

    def move(self, name, value):
        """Move a slider, by name or by its number, in SI. What is refused is told, and ``flags["values"]`` say what holds."""
        name = self.spans[name].name if isinstance(name, int) else name
        self._said.append(("move", (name, float(value))))

    def press(self, name):
        """Press one of PRESSES; "stop" ends a recording, "replay" begins or ends one, "save" writes a file."""
        self._said.append(("press", name))

    # --- what a program says, done at once between two turns

    def set(self, **values):
        """Set parameters from the next tick on, or refuse them."""
        with self._lock:
            self.motion.set(**values)

    def pressed(self, name, *given):
        """Do what a press of this name asks for."""
        with self._lock:
            getattr(self, f"_{name}")(*given)

    @property
    def values(self):
        """The scene's parameters as they are now, SI."""
        return named_values(self.source.program)

    @property
    def status(self):
        """One or two sentences about what goes on."""
        with self._lock:
            return self._words()

    def recorded(self):
        """Return what was recorded last, or None."""
        with self._lock:
            return self.motion.recorded()

    @property
    def on_view(self):
        """Whether somebody looks."""
        return bool(self._views)

    def close(self):
        """Ask for the end: the thread stops within a turn, and a board's motor with it. Waits for nothing."""
        self._closed.set()
        self._views.clear()

    def end(self):
        """Close, and wait until all stands still."""
        self.close()
        with self._lock:
            self._rest()

    def description(self):
        """Return what a front end is told once: a dict of what JSON can carry.

        ``title``; ``kind``, "simulated" or "board"; ``parameters``, a list of {name, unit, value, low, high, limit_words};
        ``traces``, a list of {name, label, unit_shown, scale}, where shown = scale * value in SI, in the order of a frame's
        columns after t; ``x_range``, [left, right], and ``box``, [left, right, bottom, top], of the picture [m];
        ``along``, the direction in which the handle moves there; ``help``, words on what moves it; ``speed``; ``columns``.
        """
        box, values = self.picture.box, self.values
        return {
            "title": self.source.program.name,
            "kind": self.source.kind,
            "parameters": [{**asdict(span), "value": values[span.name]} for span in self.spans],
            "traces": [dict(trace) for trace in TRACES],
            "x_range": [box[0], box[1]],
            "box": list(box),
            "along": list(self.picture.along),
            "help": _help(self.source, self.motion.speed),
            "speed": self.motion.speed,
            "columns": list(COLUMNS),
        }

    # --- the thread

    def _keep_a_thread(self):
        with self._door:
            if self._in_thread and self._thread is None:
                self._thread = threading.Thread(target=self._run, name="hapticlab live view", daemon=True)
                self._thread.start()

    def _run(self):
        following = self.clock()
        try:
            while self.turn() or not self._thread_may_end():
                following = max(following + 1 / RATE, self.clock())
                self._closed.wait(following - self.clock())
        finally:
            with self._lock:
                self._rest()
        if self._closed.is_set():
            self._show(Frame(self.motion.time, status="This view has ended; run its cell again.", flags=self._flags()))

    def _thread_may_end(self):
        with self._door:  # a view that opens now starts a thread of its own
            if not self._views:
                self._thread = None
            return not self._views

    def turn(self):
        """Do all that is due, and give one frame to the sink; return whether anybody looks."""
        with self._lock:
            now = self.clock()
            for view in [view for view, heard in list(self._views.items()) if now - heard > SILENCE]:
                self._views.pop(view, None)
            if not self._views:
                self._rest()
                return False
            rows = self._guarded(self._go_on)
            frame = self._frame(now, rows)
        if frame is not None:
            self._show(frame)
        return True

    def _show(self, frame):
        try:
            if self._sink is not None:
                self._sink(frame)
        except Exception as problem:  # nobody can be told: as if all views had closed
            self._tell(f"The view cannot be reached: {problem}")
            self._views.clear()

    def _go_on(self):
        if not self._watched:
            self._watched = True
            self.source.warm()
            self.motion.wake()  # after it, for compiling took its time
            if self._wants_to_run:
                self._resume()
        moves, said = {}, []
        while self._said:
            what, given = self._said.popleft()
            if what == "move":
                moves[given[0]] = given[1]
            else:
                said.append((what, given))
        if moves:
            self._guarded(lambda: self.motion.set(**moves))
            self._next_frame = -1.0
        for what, given in said:
            self._next_frame = self._next_look = -1.0
            self.motion.hold(given) if what == "hold" else self._guarded(getattr(self, f"_{given}"))
        recording = self.motion.recording
        rows = self.motion.advance(self._wanted)
        if recording and not self.motion.recording:
            self._tell("The recording ended: it was long, or the motor went off")
        return rows

    def _guarded(self, work):
        """Do work; what it raises is told, and anything but a refusal stops what moves."""
        try:
            return work()
        except Exception as problem:  # a thread has nobody else to tell
            kind = "" if isinstance(problem, HapticlabError) else f"{type(problem).__name__}: "
            self._tell(f"{kind}{problem}")
            if not is_refusal(problem):
                with suppress(HapticlabError):
                    self.motion.pause()
        return None

    def _rest(self):
        """Stand still because nobody looks; a simulation goes on when somebody does, a board only after Start."""
        if self._watched:
            self._watched = False
            with suppress(HapticlabError):
                self.motion.pause()

    # --- presses

    def _start(self):
        self._wants_to_run = self.source.kind == "simulated"
        self.motion.start()

    def _resume(self):
        self._wants_to_run = self.source.kind == "simulated"
        self.motion.resume()

    def _pause(self):
        self._wants_to_run = False
        self.motion.pause()

    def _record(self):
        self.motion.record()

    def _stop(self):
        self.motion.stop_recording()

    def _save(self, path=None):
        log = self.motion.recorded()
        if log is None:
            raise PaddleError("nothing is recorded yet; press Record, and Stop recording")
        self._tell(f"Saved {log.save(path or _free_name(log.scene))}: log = hl.Telemetry.load(...) reads it")

    def _replay(self, log=None):
        log = self.motion.recorded() if log is None else log
        if log is None and not self.motion.replaying:
            raise PaddleError("nothing is recorded yet; press Record, and Stop recording")
        self.motion.replay(None if self.motion.replaying else log)

    # --- frames

    def _tell(self, note):
        self._note, self._note_until, self._next_look = note, self.clock() + NOTE, -1.0

    def _words(self):
        motion, source = self.motion, self.source
        board = source.kind == "board"
        if motion.replaying:
            said = ["Replaying a record"]
        elif motion.running:
            x, F = motion.traces.recent()
            said = [source.waits or f"{'Motor on' if board else 'Running'}, {contact_words(F[-len(F) // 4 :])}"]
            said += [chatter_words(x, F, source.period), *(NOTICED[name] for name in motion.noticed())]
            said += ["" if board else late_words(motion.pace.behind(self.clock()))]
            said += ["" if motion.held else "The handle is let go"]
        else:
            said = ["Motor off: press Start, and hold the handle" if board else "Paused"]
            said += [f"Stopped: {source.fault}" if source.fault else ""]
        said += ["Recording" if motion.recording else "", self._note if self.clock() < self._note_until else ""]
        return " ".join(f"{sentence.rstrip('.')}." for sentence in said if sentence)

    def _frame(self, now, rows):
        """Return the frame that is due, or None: a picture that rests is shown now and then."""
        if rows is None and now < self._next_frame:
            return None
        self._next_frame, status = now + 1 / RESTING, ""
        if now >= self._next_look:
            self._next_look = now + LOOK
            self._status, before = self._words(), self._status
            status = self._status if self._status != before else ""
        given = {} if rows is None else {"rows": rows}
        return Frame(self.motion.time, picture=self._drawn(), status=status, flags=self._flags(), **given)

    def _flags(self):
        flags = {name: getattr(self.motion, name) for name in ("running", "recording", "replaying", "held")}
        values = self.values
        return {**flags, "motor": self.source.motor, "values": {span.name: values[span.name] for span in self.spans}}

    def _drawn(self):
        """Return the picture; one that cannot be drawn is told, and the scene goes on without it."""
        try:
            return self.picture.draw(self.motion.values(self._wanted))
        except Exception as problem:
            self._tell(f"The picture cannot be drawn: {type(problem).__name__}: {problem}")
            return ()


def source_of(paddle, scene, **options):
    """Return what gives samples of a scene on a paddle."""
    kinds = {SimulatedPaddle: Stepping, SerialPaddle: Streaming}
    for kind, source in kinds.items():
        if isinstance(paddle, kind):
            return source(paddle, scene, **options)
    raise PaddleError(f"paddle = {paddle!r}; a live view needs a SimulatedPaddle, or a board: hl.connect()")


def _help(source, speed):
    if source.kind == "board":
        return "Start switches the motor on: hold the handle. The motor goes off with Stop, and when this view closes."
    hand = source.paddle.hand
    slow = f" Time runs at {speed:g} of the clock's." if speed != 1 else ""
    return (
        "Drag the handle, or use the arrow keys: they move where the hand means to be, and the hand's spring follows "
        f"({hand.k:g} N/m, {hand.b:g} N s/m, {1e3 * hand.m:g} g).{slow}"
    )


def _free_name(scene):
    """Return a name of a file that is not there yet."""
    stem = "".join(c if c.isalnum() else "_" for c in scene).strip("_") or "live"
    return next(path for k in range(1, 10_000) if not (path := Path(f"{stem}-{k}.npz")).exists())
