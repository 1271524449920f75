"""A paddle on a board: scenes run in its firmware, and this computer sends, watches and records."""

import math
import threading
import weakref
from contextlib import suppress
from dataclasses import replace

from ...compiler.boards.board_fit import fit
from ...compiler.boards.cost import BOARDS, cost
from ...compiler.ir.program import Program
from ...errors import PaddleError
from ..hand.hand import require
from ..link.exchange import Exchange
from ..link.messages import OPTIONS, SENSORS, STATES
from ..link.serial_ports import open_port
from ..live import check_margin, checked, named_values, send
from ..paddle import Paddle
from ..progress import progress_bar
from .greeting import cleared, introduction, say_hello, what_happened
from .homing import home
from .recording import decimation, fault_words
from .running import begin, collect, guarded
from .standalone import forget, keep
from .step_timing import Timing
from .upload import check_period, check_room, read_settings


class SerialPaddle(Paddle):
    """A paddle whose firmware runs the scene; made by :func:`hapticlab.connect`.

    The motor goes off when :meth:`run` or :meth:`wait` is interrupted, when the paddle is closed, and when nothing refers to
    it any more. A scene begun by :meth:`start` runs as long as this computer's program lives and holds the paddle.

    Parameters
    ----------
    url : str
        A port or any URL of pyserial: ``COM3``, ``/dev/ttyACM0``, ``sim://hapkit``, ``socket://host:port``.
    T : float
        Sampling period [s], whole microseconds within the board's range.
    port : serial object, optional
        Already open; url then only names it.
    hello : float
        How long a board may take to answer, from reset [s].

    Attributes
    ----------
    settings : Settings or None
        What the board keeps; None where it was never calibrated.
    board : dict
        What the board said of itself: name, ident, sizes, clock, period range.

    Examples
    --------
    >>> import hapticlab as hl
    >>> x_o, k = hl.parameters("x_o k", units="m N/m")
    >>> wall = hl.Scene(force=hl.when(hl.x(hl.n) >= x_o, k * (hl.x(hl.n) - x_o)), name="wall")
    >>> with hl.connect("sim://hapkit") as paddle:
    ...     log = paddle.run(wall(k=150, x_o=0.01), duration=0.1)
    >>> len(log), log.fault
    (100, None)
    """

    def __init__(self, url, *, T=1e-3, port=None, hello=3.0):
        self.url, self.T = url, require("T", T, "s", "a paddle", above=0)
        self.exchange = Exchange(open_port(url) if port is None else port)
        self._recording = self._program = self._crc = None
        self._lock = threading.RLock()  # two threads: what the board has last is what is known here
        try:
            self.board = say_hello(self.exchange, url, hello)
            check_period(self.board, T)
            self.settings = read_settings(self.exchange)
            for sentence in what_happened(self.exchange, url, self.board["reset_cause"]):
                print(sentence)
        except BaseException:
            self.exchange.close()
            raise
        # the exchange holds a recording and never the paddle, so that a dropped paddle ends; at exit this is called too
        self._end = weakref.finalize(self, self.exchange.hang_up)

    @property
    def velocity(self):
        return "backward_difference"

    def accept(self, program):
        check_room(self.board, self.settings, program)
        return super().accept(program)

    def run(self, scene=None, *, duration, x=None, v=None, progress=True, **options):
        """Run a scene on the board for a duration and return what it recorded; the motor is off before and after.

        Parameters
        ----------
        scene : Scene, Program or None
            None runs what is on the board again, with the parameters it has.
        duration : float
            [s]; rounded to whole samples.
        x, v : None
            A real handle is where it is; a start can be given to a simulated paddle alone.
        progress : bool
            Show a bar when the run lasts longer than two seconds.
        **options
            Of :meth:`start`: every, force_max, passive; and of hapticlab.compile.

        Raises
        ------
        PaddleError, LinkError, PortError, ProgramLimitError
        """
        if x is not None or v is not None:
            raise PaddleError("x, v: a handle on a board starts where it is; move it there, or use a SimulatedPaddle.")
        ticks = self.ticks(duration)
        with guarded(self._abandon):
            self.start(scene, **options)
            with progress_bar(ticks, progress) as bar:
                collect(self, ticks, bar)
            return self.stop(ticks=ticks)

    def cost(self, scene, **options):
        """Return what a scene or a program takes of this board: cycles, memory, share of the period; print it."""
        return cost(self.program(scene, **options), **self._board())

    def start(self, scene=None, *, every=None, force_max=math.inf, passive=False, check_fit=True, **options):
        """Start a scene and return at once; :meth:`set` changes it, :meth:`wait` lets it run, :meth:`stop` ends it.

        Parameters
        ----------
        scene : Scene, Program or None
        every : int, optional
            One sample in so many ticks is sent; by default as many as the link carries.
        force_max : float
            A lower limit of force than the board's own, for this run [N].
        passive : bool
            Watch the handle with the motor off; needs no home.
        check_fit : bool
            Refuse a scene that takes longer than the period before it is sent; the board itself faults on one anyway.

        Raises
        ------
        ProgramLimitError
            With the share of the period it would take, and the rate, method or law that would fit.
        """
        if force_max != math.inf:
            force_max = require("force_max", force_max, "N", "a run", "passive=True runs with the motor off.", low=0)
        with guarded(self._abandon):
            program = self._checked(scene, every, check_fit, options)
            if not passive:
                check_margin(self._program if program is None else program)
            self.clear()
            if not passive and self.settings is not None:
                self.home()
            with self._lock:
                begin(self, program, every, OPTIONS["PASSIVE"] if passive else 0, min(force_max, 3e38))

    def set(self, **values):
        """Set parameters of the scene on the board, live, all of them between the same two ticks.

        Raises
        ------
        ParameterError
            For an unknown name, a bad value, or more than 8 at once.
        """
        with self._lock, guarded(self._motor_off):
            if self._program is None:
                raise PaddleError("nothing is on the board yet; start a scene first: paddle.start(scene)")
            numbers = checked(self._program, values)
            tick = send(self.exchange, self._program, numbers)
            known = named_values(self._program) | numbers
            self._program = replace(self._program, values=tuple(known.values()))
            if self._recording is not None:
                self._recording.changes.append(((tick + 1) * self.T, numbers))

    def wait(self, seconds):
        """Let the scene run for so many seconds of the board's time, or until a fault, which is told.

        Interrupted, it switches the motor off; :meth:`stop` returns what was recorded until then.
        """
        recording = self._running()
        with guarded(self._motor_off):
            collect(self, recording.last_tick + 1 + self.ticks(seconds), None)
        if recording.fault is not None:
            print(f"{self.url}: {fault_words(recording.fault, self.T)}")

    def stop(self, *, ticks=None):
        """Switch the motor off and return the Telemetry of the run."""
        with self._lock:
            recording = self._running()
            self.exchange.beating = False  # first: whatever happens to STOP, the motor goes off
            self.exchange.command("STOP")
            state = self.exchange.refresh()
            if state["state"] == STATES["FAULT"]:
                recording.fault = recording.fault or {"fault": state["fault"], "tick": state["tick"], "value": math.nan}
                self.exchange.command("CLEAR")
            self._record(None)
            self.timing = Timing(state, self.board["clock_hz"], self.T)
            return recording.telemetry(ticks=ticks, delay=self.timing.mean, paddle=str(self))

    def clear(self):
        """Say which fault stands, if one does, and clear it: the board takes a scene again. The motor stays off."""
        for sentence in cleared(self.exchange, self.url):
            self.exchange.beating = False  # what ran had ended
            print(sentence)

    def home(self, at=None, *, timeout=60.0):
        """Tell the board where the handle is; it forgets with every reset, and gives no force until it knows.

        Parameters
        ----------
        at : float, optional
            The handle is held at this position [m], now. Without it the handle is to be led to both stops, by hand; a
            simulated one (``sim://``) has no hand, and is put to the middle, at rest.
        timeout : float
            How long that may take [s].
        """
        home(self.exchange, self.settings, at, timeout)

    def keep(self, scene, **options):
        """Have the board keep a scene and run it without a computer; return what starts it. See standalone.keep."""
        with self._lock:
            self._require_idle("keep")
            self._program = None  # the upload takes the place of what was loaded
            return keep(self, scene, **options)

    def forget(self):
        """Have the board wait for a computer after power-on again."""
        with self._lock:
            self._require_idle("forget")
            forget(self)

    def state(self):
        """Return the board's state as it is now: a dict of messages.STATE's fields."""
        return self.exchange.refresh()

    def close(self):
        """Stop the motor and give the port back."""
        with self._lock:
            try:
                if self.exchange.broken is None:
                    self._abandon()
            finally:
                self._end()

    def __enter__(self):
        return self

    def __exit__(self, *failure):
        self.close()

    def __repr__(self):
        return f"<SerialPaddle {self.url}: {self}>"

    def __str__(self):
        return introduction(self.board, self.settings, self.T)

    def _board(self):
        """What cost() asks: the board, "host" where its time is not known, and the most edges of its encoder in a second."""
        s, name = self.settings, self.board["board"]
        edges = s.speed_max / abs(s.metres_per_count) if s is not None and s.sensor == SENSORS["QUADRATURE"] else 0.0
        return {"board": name if name in BOARDS else "host", "edges_per_second": edges}

    def _checked(self, scene, every, check_fit, options):
        """Return the program of a scene that fits the board, or None for the one that is there."""
        if scene is None:
            if self._program is None:
                raise PaddleError("nothing is on the board yet; give a scene: paddle.start(scene)")
            return None
        program = self.program(scene, **options)
        sent = decimation(program, self.exchange.port, every)
        if check_fit and not cost(program, every=sent, **self._board()).fits:
            known = {} if isinstance(scene, Program) else {"T": self.T, "velocity": self.velocity}
            fit(scene, every=sent, **self._board(), **known, **options)
        return program

    def _require_idle(self, asked):
        if self._recording is not None:
            raise PaddleError(f"{asked}: a scene runs; end it first: paddle.stop()")

    def _running(self):
        if self._recording is None:
            raise PaddleError("nothing runs; start a scene first: paddle.start(scene)")
        return self._recording

    def _record(self, recording):
        """Give what the board says to a recording, or to none."""
        self._recording = recording
        self.exchange.give(recording and recording.add)

    def _abandon(self):
        """Motor off, and nothing recorded any more."""
        self._record(None)
        self._motor_off()

    def _motor_off(self):
        self.exchange.beating = False
        with suppress(PaddleError):  # then the board stops its motor by itself, 100 ms after the last word
            self.exchange.command("STOP", tries=4)
