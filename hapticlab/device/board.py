"""A paddle on a board: scenes run in its firmware, and this computer sends, watches and records."""

import math
import threading
import zlib
from contextlib import suppress
from dataclasses import replace

from ..compiler.bytecode import encode
from ..compiler.cost import BOARDS, cost
from ..compiler.fit import fit
from ..compiler.ir import Program
from ..errors import LinkError, PaddleError
from .exchange import Exchange
from .greeting import explain_silence, introduction, say_hello, what_happened
from .homing import home
from .live import checked, in_portions, named_values, send
from .messages import OPTIONS, STATES
from .paddle import Paddle
from .progress import progress_bar
from .recording import Recording, decimation
from .serial import open_port
from .standalone import forget, keep
from .timing import Timing
from .upload import check_room, read_settings, upload

#: seconds a board may be silent in a run before the host gives up
PATIENCE = 1.0


class SerialPaddle(Paddle):
    """A paddle whose firmware runs the scene; made by :func:`hapticlab.connect`.

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
        self.url, self.T = url, float(T)
        self.exchange = Exchange(open_port(url) if port is None else port, self._on_frame)
        self._recording = self._program = self._scene = None
        self._setting = threading.Lock()
        try:
            self.board = say_hello(self.exchange, url, hello)
            self.settings = read_settings(self.exchange)
            for sentence in what_happened(self.exchange, url, self.board["reset_cause"]):
                print(sentence)
        except BaseException:
            self.exchange.close()
            raise

    @property
    def velocity(self):
        return "backward_difference"

    def accept(self, program):
        check_room(self.board, program)
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
        self.start(scene, **options)
        try:
            with progress_bar(ticks, progress) as bar:
                self._collect(ticks, bar)
            return self.stop(ticks=ticks)
        except BaseException:  # a notebook's stop button too: the motor is not left running
            self._abandon()
            raise

    def cost(self, scene, **options):
        """Return what a scene or a program takes of this board: cycles, memory, share of the period; print it."""
        return cost(self.program(scene, **options), self._kind)

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
        if scene is not None:
            program = self.program(scene, **options)
            sent = decimation(program, self.exchange.port, every)
            if check_fit and not cost(program, self._kind, every=sent).fits:
                known = {} if isinstance(scene, Program) else {"T": self.T, "velocity": self.velocity}
                fit(scene, self._kind, every=sent, **known, **options)
            self._load(program)
            self._scene = None if isinstance(scene, Program) else scene
        elif self._program is None:
            raise PaddleError("nothing is on the board yet; give a scene: paddle.start(scene)")
        if not passive and self.settings is not None:
            self.home()
        every = decimation(self._program, self.exchange.port, every)
        earlier, recording = self._recording, Recording(self._program, every)
        self._recording, self.exchange.beating = recording, True
        how = every, OPTIONS["PASSIVE"] if passive else 0, min(float(force_max), 3e38)
        try:
            self.exchange.command("START", self._crc, *how, then=recording.begin)
        except LinkError as refusal:
            if refusal.result is None:  # it may run, and only the answer was lost
                self._abandon()
            else:
                self._recording, self.exchange.beating = earlier, earlier is not None
            raise

    def set(self, **values):
        """Set parameters of the scene on the board, live, all of them between the same two ticks.

        Raises
        ------
        ParameterError
            For an unknown name, a bad value, or more than 8 at once.
        """
        if self._program is None:
            raise PaddleError("nothing is on the board yet; start a scene first: paddle.start(scene)")
        with self._setting:  # two callers: what the board has last is what is known here
            scene, numbers = checked(self._program, self._scene, values)
            tick = send(self.exchange, self._program, numbers)
            known = named_values(self._program) | numbers
            self._program, self._scene = replace(self._program, values=tuple(known.values())), scene
            if self._recording is not None:
                self._recording.changes.append(((tick + 1) * self.T, numbers))

    def wait(self, seconds):
        """Let the scene run for so many seconds of the board's time."""
        recording = self._running()
        self._collect(recording.last_tick + 1 + self.ticks(seconds), None)

    def stop(self, *, ticks=None):
        """Switch the motor off and return the Telemetry of the run."""
        recording = self._running()
        self.exchange.command("STOP")
        self.exchange.beating = False
        state = self.exchange.refresh()
        self._recording = None
        if state["state"] == STATES["FAULT"]:
            recording.fault = recording.fault or {"fault": state["fault"], "tick": state["tick"], "value": math.nan}
            self.exchange.command("CLEAR")
        self.timing = Timing(state, self.board["clock_hz"], self.T)
        return recording.telemetry(ticks=ticks, delay=self.timing.mean, paddle=str(self))

    def home(self, at=None, *, timeout=60.0):
        """Tell the board where the handle is; it forgets with every reset, and gives no force until it knows.

        Parameters
        ----------
        at : float, optional
            The handle is held at this position [m], now. Without it the handle is to be led to both stops, by hand.
        timeout : float
            How long that may take [s].
        """
        home(self.exchange, self.settings, at, timeout)

    def keep(self, scene, **options):
        """Have the board keep a scene and run it without a computer; return what starts it. See standalone.keep."""
        self._require_idle("keep")
        self._program = self._scene = None  # the upload takes the place of what was loaded
        return keep(self, scene, **options)

    def forget(self):
        """Have the board wait for a computer after power-on again."""
        self._require_idle("forget")
        forget(self)

    def state(self):
        """Return the board's state as it is now: a dict of messages.STATE's fields."""
        return self.exchange.refresh()

    def close(self):
        """Stop the motor and give the port back."""
        try:
            if self.exchange.broken is None:
                self._abandon()
        finally:
            self.exchange.close()

    def __enter__(self):
        return self

    def __exit__(self, *failure):
        self.close()

    def __str__(self):
        return introduction(self.board, self.settings, self.T)

    @property
    def _kind(self):
        """The board's name where its cost is known, else this computer's, whose time is not limited."""
        name = self.board["board"].rstrip(b"\0").decode("ascii", "replace")
        return name if name in BOARDS else "host"

    def _load(self, program):
        """Put a program and its parameters on the board; nothing runs until it is verified."""
        data = encode(program, word_bits=8 * self.board["word_bytes"])
        if self._recording is not None and self.board["slots"] == 1:
            self.stop()
        upload(self.exchange, "PROGRAM", data)
        self._program, self._crc = program, zlib.crc32(data[:-4])
        for some in in_portions(named_values(program)):
            send(self.exchange, program, some)

    def _require_idle(self, asked):
        if self._recording is not None:
            raise PaddleError(f"{asked}: a scene runs; end it first: paddle.stop()")

    def _running(self):
        if self._recording is None:
            raise PaddleError("nothing runs; start a scene first: paddle.start(scene)")
        return self._recording

    def _collect(self, ticks, bar):
        """Read until so many ticks are recorded, or a fault."""
        recording, seen = self._recording, 0
        wanted = (ticks - 1) // recording.every * recording.every
        while recording.last_tick < wanted and recording.fault is None:
            before, next_look = recording.last_tick, min(wanted, recording.last_tick + 500)
            came = self.exchange.wait(
                lambda enough=next_look: recording.last_tick >= enough or recording.fault, PATIENCE + 500 * self._program.T
            )
            if not came and recording.last_tick == before:
                recording.fault = recording.fault or explain_silence(self.exchange, self.url)
            if bar is not None:
                bar.update(max(0, min(recording.last_tick + 1, ticks) - seen))
                seen = max(seen, recording.last_tick + 1)

    def _abandon(self):
        """Motor off, and nothing recorded any more."""
        self._recording, self.exchange.beating = None, False
        with suppress(PaddleError):  # then the board stops its motor by itself, 100 ms after the last word
            self.exchange.command("STOP", tries=4)

    def _on_frame(self, frame):
        if self._recording is not None:
            self._recording.add(frame)

