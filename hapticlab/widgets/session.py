"""A scene that runs while somebody looks at it: inputs of a front end go in, frames come out, in a thread of its own."""

import threading
import time
from collections import deque

from ..errors import PaddleError
from .frame import Frame
from .stage import Stage

#: presses that a front end has, see :meth:`Session.press`
PRESSES = ("start", "pause", "resume", "record", "stop", "save", "replay")
#: frames a second; where a hand moves, at least and at most so many, each as soon as it has moved
RATE, SLOWEST, FASTEST = 60.0, 50.0, 75.0
#: a hand that begins to move is waited for so long after a frame [s]
SOONEST = 4e-3
#: a front end that says nothing for so long is gone [s]
SILENCE = 2.0


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
        self.clock, self._in_thread = clock, in_thread
        self.stage = Stage(paddle, scene, clock=clock, sliders=sliders, speed=speed, picture=picture, **options)
        self.scene, self.spans, self.picture = self.stage.scene, self.stage.spans, self.stage.picture
        self.source, self.motion, self.description = self.stage.source, self.stage.motion, self.stage.description
        self._lock, self._door, self._closed = threading.RLock(), threading.Lock(), threading.Event()
        self._moved = threading.Event()  # a hand, since the turn before; or all has to end
        self._views, self._thread, self._sink = {}, None, None
        self._said, self._wanted = deque(maxlen=1000), 0.0  # nobody may be there to do what is said

    # --- what a front end says, from whatever thread: stored, and done in the next turn

    def connect(self, sink):
        """Give frames to ``sink(frame)``, from the session's thread, 75 a second at most; one sink at a time."""
        self._sink = sink

    def ready(self, view=""):
        """Note that a view opened: the first starts a simulation, or shows that a board's motor is off."""
        self._said.append(("look", None))
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
        """Say where the hand means to be [m]; the next frame comes at once."""
        self._wanted = float(x)
        self._moved.set()

    def hold(self, held):
        """Take the handle, or let go of it."""
        self._said.append(("hold", bool(held)))

    def move(self, name, value):
        """Move a slider, by name or by its number, in SI. What is refused is told, and ``flags["values"]`` say what holds."""
        name = self.spans[name].name if isinstance(name, int) else name
        self._said.append(("move", (name, float(value))))

    def press(self, name):
        """Press one of PRESSES; "stop" ends a recording, "replay" begins to play one or ends it, "save" writes a file."""
        if name not in PRESSES:
            raise PaddleError(f"press {name!r}; there are {', '.join(PRESSES)}")
        if name in ("start", "resume") and not self._views:
            return  # a press that comes late starts no motor when somebody looks again
        self._said.append(("press", name))

    # --- what a program says, done at once between two turns

    def set(self, **values):
        """Set parameters from the next tick on, or refuse them."""
        with self._lock:
            self.motion.set(**values)

    def pressed(self, name, *given):
        """Do what a press of this name asks for."""
        with self._lock:
            getattr(self.stage, name)(*given)

    @property
    def values(self):
        """The scene's parameters as they are now, SI."""
        return self.stage.values

    @property
    def status(self):
        """One or two sentences about what goes on."""
        with self._lock:
            return self.stage.words()

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
        self._moved.set()

    def end(self):
        """Close, and wait until all stands still."""
        self.close()
        with self._lock:
            self.stage.rest()

    # --- the thread

    def _keep_a_thread(self):
        with self._door:
            if self._in_thread and self._thread is None:
                self._thread = threading.Thread(target=self._run, name="hapticlab live view", daemon=True)
                self._thread.start()

    def _run(self):
        due, led = self.clock(), False
        try:
            while self.turn() or not self._thread_may_end():
                due, led = self._wait(due, led)
        finally:
            with self._lock:
                self.stage.rest()
            with self._door:
                self._thread = None if self._thread is threading.current_thread() else self._thread
        if self._closed.is_set():
            self._show(Frame(self.motion.time, status="This view has ended; run its cell again.", flags=self.stage.flags()))

    def _wait(self, due, led):
        """Wait after a turn that was due then, led by a hand or not, for the next; return when that is, and whether led."""
        self._closed.wait(due + (1 / FASTEST if led else SOONEST) - self.clock())
        following = due + 1 / (SLOWEST if led else RATE)
        led = self._moved.wait(following - self.clock())
        self._moved.clear()
        return (self.clock() if led else max(following, self.clock())), led

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
                self.stage.rest()
                self._said.clear()
                return False
            self.stage.guarded(self.stage.wake)
            self.stage.obey([self._said.popleft() for _ in range(len(self._said))])
            frame = self.stage.frame(self.stage.advance(self._wanted), self._wanted)
        if frame is not None:
            self._show(frame)
        return True

    def _show(self, frame):
        try:
            if self._sink is not None:
                self._sink(frame)
        except Exception as problem:  # nobody can be told: as if all views had closed
            self.stage.tell(f"The view cannot be reached: {problem}")
            self._views.clear()
