"""A scene that runs while somebody looks at it: inputs of a front end go in, frames come out, beside whatever cells do."""

import math
import threading
import time
from collections import deque

from ..device.turns import begin, has_threads
from ..errors import PaddleError
from .pace import CellsBetween
from .stage import Stage

#: presses that a front end has, see :meth:`Session.press`
PRESSES = ("start", "pause", "resume", "record", "stop", "save", "replay", "restart", "slow")
#: frames a second; where a hand moves, at least and at most so many, each as soon as it has moved
RATE, SLOWEST, FASTEST = 60.0, 50.0, 65.0
#: a hand that begins to move is waited for so long after a frame [s]
SOONEST = 4e-3
#: a front end that says nothing for so long is gone [s]
SILENCE = 2.0
#: where its words wait for the cell that runs, a simulation goes on for so long without them [s]
LONG_SILENCE = 60.0
#: a board's motor starts only where a view was heard without such a gap for so long [s]: words that waited come at once
GAP, STEADY = 1.0, 0.5
ENDED = "This view has ended; run its cell again."
#: where there are no threads: what a page says waits for the cell that runs, and frames go on where that cell awaits
A_CELL_RUNS = "A cell is running, so the pointer, keys and buttons take effect only after the cell"


class Session:
    """What a front end is connected to.

    A front end calls ``connect(sink)`` once, sends ``description()`` to its views, and says ``ready(view)`` for every view
    that opened, ``alive(view)`` at least once a second from each, ``gone(view)`` when one closed; ``view`` is any text that
    tells views apart. Nothing runs before the first ready; everything ends with the last view, or after 2 s of silence
    (a simulation in a browser's Python: 60 s, because what a page says waits there for the cell that runs).
    Then the inputs: each stores what it is given and returns at once, from whatever thread. A front end may keep the
    session; it must not keep the LiveView, whose end closes the session.

    Parameters
    ----------
    paddle : SimulatedPaddle or SerialPaddle
    scene : Scene
    sliders, speed, picture, let_go
        As for :func:`hapticlab.live`, speed its time_scale.
    show_force : bool
        False shows neither force, energy nor target position: for experiments whose answer they would tell.
    clock : callable
        Seconds, as time.monotonic gives them.
    in_thread : bool
        False leaves :meth:`turn` to the caller; else a thread does it or, where there are none, the event loop.
    **options
        Of hapticlab.compile.
    """

    def __init__(
        self, paddle, scene, *, sliders=None, speed=1.0, picture=None, show_force=True, let_go=False,
        clock=time.monotonic, in_thread=True, **options,
    ):  # fmt: skip
        self.clock, self._in_thread = clock, in_thread
        looks = {"sliders": sliders, "speed": speed, "picture": picture, "show_force": show_force, "let_go": let_go}
        self.stage = Stage(paddle, scene, clock=clock, **looks, **options)
        self.scene, self.spans, self.picture = self.stage.scene, self.stage.spans, self.stage.picture
        self.source, self.motion, self.description = self.stage.source, self.stage.motion, self.stage.description
        self._lock, self._door, self._closed = threading.RLock(), threading.Lock(), False
        self._moved = False  # a hand, since the turn before; or all has to end
        self._views, self._turns, self._sink = {}, None, None
        self._said, self._wanted = deque(maxlen=1000), 0.0  # nobody may be there to do what is said
        self._heard = self._steady = -math.inf  # when a view was heard last, and since when without a gap
        self._cells = CellsBetween()
        self._silent, self._end = None, ENDED  # since when, where silence ended it; and the words of the end

    # --- what a front end says, from whatever thread: stored, and done in the next turn

    def connect(self, sink):
        """Give frames to ``sink(frame)``, from the session's thread, 65 a second at most; one sink at a time."""
        self._sink = sink

    def ready(self, view=""):
        """Note that a view opened: the first starts a simulation, or shows that a board's motor is off."""
        self._said.append(("look", None))
        self.alive(view)

    def alive(self, view=""):
        """Note that a view is still there."""
        if not self._closed:
            now = self.clock()
            if self._views and now - self._heard > SILENCE and not has_threads() and self.source.kind == "board":
                # the motor of a board goes off after silence, also where a cell took the turn that would have noticed it
                self._silent = self._heard
                self._said.append(("press", ("pause", now)))
            self._views[view] = now
            self._steady = self._steady if now - self._heard <= GAP else now
            self._heard = now
            self._keep_turning()

    def gone(self, view=""):
        """Note that a view closed: with the last one the turns end, and a board's motor goes off."""
        self._views.pop(view, None)
        self._heard = self._heard if self._views else -math.inf

    def intend(self, x):
        """Say where the hand means to be [m]; the next frame comes at once."""
        self._said.append(("intend", float(x)))  # in its order: a press of "restart" before it also puts the hand somewhere
        self._wake()

    def hold(self, held):
        """Take the handle, or let go of it."""
        self._said.append(("hold", bool(held)))

    def move(self, name, value):
        """Move a slider, by name or by its number, in SI. What is refused is told, and ``flags["values"]`` say what holds."""
        name = self.spans[name].name if isinstance(name, int) else name
        self._said.append(("move", (name, float(value))))

    def press(self, name, age=0.0):
        """Press one of PRESSES, so long after it was pressed in the page [s].

        "stop" ends a recording, "replay" begins to play one or ends it, "save" writes a file, "restart" begins again at
        the first state of the scene, "slow" begins or ends slow motion. A press that would start a
        board's motor is dropped, in words, where it comes late: :meth:`Stage.obey`. It came late too, whatever its age is
        said to be, where the views were not heard steadily before.
        """
        if name not in PRESSES:
            raise PaddleError(f"press {name!r}; there are {', '.join(PRESSES)}")
        now = self.clock()
        if now - self._heard > GAP or now - self._steady < STEADY:
            age = math.inf
        self._said.append(("press", (name, now - age)))

    # --- what a program says, done at once between two turns

    def set(self, **values):
        """Set parameters from the next tick on, or refuse them."""
        with self._lock:
            self.motion.set(**values)

    def pressed(self, name, *given):
        """Do what a press of this name asks for."""
        with self._lock:
            if self._closed and name not in ("pause", "stop"):
                raise PaddleError(f"{name}: {self._end[0].lower()}{self._end[1:]}")
            getattr(self.stage, name)(*given)

    @property
    def values(self):
        """The scene's parameters as they are now, SI."""
        return self.stage.values

    @property
    def status(self):
        """One or two sentences about what goes on."""
        with self._lock:
            if self._closed:
                return self._end
            return self.stage.words() if self._views else f"Not on view, so nothing moves. {self.stage.note}".rstrip()

    @property
    def at_limit(self):
        """Whether the motor was at its limit within the last second."""
        with self._lock:
            return "saturated" in self.motion.noticed()

    def recorded(self):
        """The last record, or None."""
        with self._lock:
            return self.motion.recorded()

    @property
    def on_view(self):
        """Whether somebody looks."""
        return bool(self._views)

    def close(self):
        """Ask for the end: it comes with the next turn, and a board's motor stops with it. Waits for nothing."""
        self._closed = True
        self._views.clear()
        self._wake()

    def end(self):
        """Close, and wait until all stands still."""
        self.close()
        with self._lock:
            self.stage.end()

    # --- turns

    @property
    def _hears_between_cells(self):
        """Whether what a page says waits for the cell that runs, as in a browser, and nothing but time can be lost meanwhile."""
        return not has_threads() and self.source.kind == "simulated"

    @property
    def _longest_silence(self):
        return LONG_SILENCE if self._hears_between_cells else SILENCE

    def _keep_turning(self):
        with self._door:
            if self._in_thread and self._turns is None:
                self._turns = begin(self._run(), "hapticlab live view")

    def _run(self):
        due, led = self.clock(), False
        try:
            while self.turn() or not self._turns_may_end():
                due, led = yield from self._wait(due, led)
        finally:
            with self._lock:
                (self.stage.end if self._closed else self.stage.rest)()
            with self._door:
                self._turns = None if self._turns is not None and self._turns.is_current() else self._turns
        if self._closed:
            self._show(self.stage.last_frame(self._end))

    def _wait(self, due, led):
        """Wait after a turn that was due then, led by a hand or not, for the next; return when that is, and whether led."""
        soonest, following = due + (1 / FASTEST if led else SOONEST), due + 1 / (SLOWEST if led else RATE)
        yield 0.0  # others go first, also where turns take all the time
        while not self._closed and (left := soonest - self.clock()) > 0:
            yield left
        while not self._moved and (left := following - self.clock()) > 0:
            yield left
        led, self._moved = self._moved, False
        return (self.clock() if led else max(following, self.clock())), led

    def _wake(self):
        """Let the next turn come as soon as it may."""
        self._moved, turns = True, self._turns
        if turns is not None:
            turns.wake()

    def _turns_may_end(self):
        with self._door:  # a view that opens now begins turns of its own
            if not self._views:
                self._turns = None
            return not self._views

    def turn(self):
        """Do all that is due, and give one frame to the sink; return whether anybody looks."""
        with self._lock:
            try:
                self._tell_of_a_cell()
                frame = self._turn() if self._somebody_looks() else self._rest()
            except Exception as problem:  # a fault of the view's own: it ends, in words, with the motor off
                self._end = f"This view has ended: {type(problem).__name__}: {problem}. Run its cell again."
                self.close()
                self.stage.end()
                frame = self.stage.last_frame(self._end)
            looks = bool(self._views)
            self._cells.turn_ended(self.clock() if looks else math.inf)
        if frame is not None:
            self._show(frame)
        return looks

    def _turn(self):
        if self._silent is not None:
            self.stage.tell(f"The notebook was silent for {self.clock() - self._silent:.1f} s: {self.stage.stopped}")
            self._silent = None
        self.stage.guarded(self.stage.wake)
        self.stage.obey([self._said.popleft() for _ in range(len(self._said))])
        self._follow_hand()
        rows = self.stage.advance(self._wanted)
        self._follow_hand()
        return self.stage.frame(rows, self._wanted)

    def _tell_of_a_cell(self):
        """Say what a cell does to a simulation on view where there are no threads: it stands still, or hears nobody."""
        if not self._hears_between_cells:
            return
        computed, awaits = self._cells.turn_begins(self.clock(), self._heard)
        if computed:
            self.motion.wake()  # what passed is not made up for
            self.stage.tell(f"A cell computed for {computed:.1f} s: {self.stage.stopped}")
        elif awaits and not self.stage.note:
            self.stage.tell(A_CELL_RUNS)
        elif not awaits and self.stage.note == A_CELL_RUNS:
            self.stage.tell("")

    def _follow_hand(self):
        """Let the hand go on to where it was led, or where the stage has put it."""
        if self.stage.hand_at is not None:
            self._wanted, self.stage.hand_at = self.stage.hand_at, None

    def _somebody_looks(self):
        """Forget views that are silent; return whether any is left."""
        now = self.clock()
        for view, heard in list(self._views.items()):
            if now - heard > self._longest_silence:
                self._views.pop(view, None)
                self._silent = None if self._views else heard
        return bool(self._views)

    def _rest(self):
        """Stand still, for nobody looks; return what to show where that is by silence: a page may still be there."""
        was_awake = self.stage.awake
        self.stage.rest()
        self._said.clear()
        if was_awake and self._silent is not None:
            return self.stage.last_frame(f"No word from the page for {self._longest_silence:g} s: {self.stage.stopped}.")
        return None

    def _show(self, frame):
        try:
            if self._sink is not None:
                self._sink(frame)
        except Exception as problem:  # nobody can be told: as if all views had closed
            self.stage.tell(f"The view cannot be reached: {problem}")
            self._views.clear()
