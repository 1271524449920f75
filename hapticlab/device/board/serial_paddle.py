"""A paddle on a board: scenes run in its firmware, and this computer sends, watches and records."""

from __future__ import annotations

import math
import threading
import weakref
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, Any

from ...base.arguments import number
from ...compiler.boards.board_fit import fit
from ...compiler.boards.cost import BOARDS, cost
from ...compiler.engines.bytecode import encode
from ...compiler.ir.program import Program
from ...errors import HapticlabError, LinkError, PaddleError, PortError
from ..device import Device
from ..link.exchange import Exchange
from ..link.messages import OPTIONS, SENSORS, STATES, TARGETS
from ..link.serial_ports import open_port
from ..live_parameters import check_margin, checked, in_portions, named_values, send
from ..paddle import Paddle
from ..progress import progress_bar
from .greeting import HELLO, cleared, explain_silence, introduction, say_hello, silent_fault, what_happened
from .homing import home
from .run import Loaded, Run, Timing, decimation, fault_words, load
from .upload import STORE_PATIENCE, check_period, check_room, read_settings, upload

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ...base.annotations import Number
    from ...base.telemetry import Telemetry
    from ...compiler.boards.cost import Cost
    from ...scene.scene import Scene

#: seconds a board may be silent in a run, beyond the time to the next look, before the host gives up
PATIENCE = 1.0
#: ticks from one look at a run to the next
LOOK = 500
#: the smallest size that BEGIN takes: one byte beside the CRC-32 at the end
SMALLEST = 5
#: what starts it, for whoever stands beside it
GESTURE = "move the handle to both stops, then hold it in the middle for 1 s; the force then switches on"


@contextmanager
def guarded(give_up):
    """Give up where anything but a refusal ends what is done inside: an interrupt by the keyboard, a port that fails."""
    try:
        yield
    except BaseException as problem:
        if not is_refusal(problem):
            give_up()
        raise


def is_refusal(problem):
    """Return whether the host or the board said no, so that nothing was begun; anything else may leave a motor on."""
    if isinstance(problem, LinkError):
        return problem.result is not None
    return isinstance(problem, HapticlabError) and not isinstance(problem, PortError)


class SerialPaddle(Paddle):
    """A paddle whose firmware runs the scene; made by :func:`hapticlab.connect`.

    The motor switches off when :meth:`run` or :meth:`wait` is interrupted, when the paddle is closed, and when nothing
    refers to it. A scene begun by :meth:`start` runs as long as this program lives and holds the paddle.

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
    notices : tuple of str
        What the board went through before: a reset, a fault that stood and was cleared. ``repr`` of a paddle has them.

    Examples
    --------
    >>> import hapticlab as hl
    >>> with hl.connect("sim://hapkit") as paddle:
    ...     log = paddle.run(hl.wall(k=150, x_o="10 mm"), 0.1)
    >>> len(log), log.fault
    (100, None)
    """

    def __init__(self, url: str, *, T: Number = 1e-3, port: Any = None, hello: Number = HELLO) -> None:
        self.url, self.T = url, number("T", T, "s", "a paddle", above=0, error=PaddleError)
        self.exchange = Exchange(open_port(url) if port is None else port)
        self._loaded: Loaded | None = None  # what is on the board
        self._run: Run | None = None  # what runs, or waits to be told
        self._lock = threading.RLock()  # two threads: what the board has last is what is known here
        try:
            self.board = say_hello(self.exchange, url, number("hello", hello, "s", least=0, error=PaddleError))
            check_period(self.board, self.T)
            self.settings = read_settings(self.exchange)
            self.notices = tuple(what_happened(self.exchange, url, self.board["reset_cause"]))
        except BaseException:
            self.exchange.close()
            raise
        # the exchange holds a run and never the paddle, so that a dropped paddle ends; at exit this is called too
        self._end = weakref.finalize(self, self.exchange.hang_up)

    @property
    def velocity(self) -> str:
        return "backward_difference"

    @property
    def device(self) -> Device:
        """The constants that the board stores, for limits."""
        return Device(T=self.T) if self.settings is None else self.settings.device(self.T)

    def accept(self, program: Program) -> Program:
        check_room(self.board, self.settings, program)
        return super().accept(program)

    def run(
        self,
        scene: Scene | Program | None = None,
        duration: Number | None = None,
        *,
        x: None = None,
        v: None = None,
        progress: bool = True,
        **options: Any,
    ) -> Telemetry:
        """Run a scene on the board for a duration and return what it recorded; the motor is off before and after.

        Parameters
        ----------
        scene : Scene, Program or None
            None runs what is on the board again, with the parameters it has.
        duration : float or text
            [s], as 2.0 or "2 s"; rounded to whole samples.
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
            raise PaddleError("x, v: on a board the handle starts where it is. Move the handle there, or use a SimulatedPaddle.")
        ticks = self.ticks(duration)
        with guarded(self.abandon):
            self.start(scene, **options)
            with progress_bar(ticks, progress) as bar:
                self._collect(ticks, bar)
            return self.stop(ticks=ticks)

    def cost(self, scene: Scene | Program, **options: Any) -> Cost:
        """The cost of a scene or a program on this board: cycles, memory, share of the period; print it.

        Parameters
        ----------
        scene : Scene or Program
            A scene with every parameter bound, or the program that was compiled from one.
        **options
            As for :func:`hapticlab.compile`: method, substeps, hold, dtype, live ...
        """
        return cost(self.program(scene, **options), **self._board())

    def start(
        self,
        scene: Scene | Program | None = None,
        *,
        every: int | None = None,
        force_max: Number = math.inf,
        passive: bool = False,
        check_fit: bool = True,
        **options: Any,
    ) -> None:
        """Start a scene and return at once; :meth:`set` changes it, :meth:`wait` lets it run, :meth:`stop` ends it.

        Parameters
        ----------
        scene : Scene or Program, optional
            With every parameter bound; None starts the program that is on the board.
        every : int, optional
            One sample in so many ticks is sent; by default as many as the link carries.
        force_max : float
            A lower limit of force than the board's own, for this run [N].
        passive : bool
            Watch the handle with the motor off; needs no home.
        check_fit : bool
            Refuse a scene that takes longer than the period before it is sent; the board itself faults on one anyway.
        **options
            As for :func:`hapticlab.compile`: method, substeps, hold, dtype, live ...

        Raises
        ------
        ProgramLimitError
            With the share of the period it would take, and the rate, method or law that would fit.
        """
        if force_max != math.inf:
            why = "passive=True runs with the motor off."
            force_max = number("force_max", force_max, "N", "a run", why=why, least=0, error=PaddleError)
        with guarded(self.abandon):
            program = self.fitted(scene, every, check_fit, options)
            if not passive:
                check_margin(self._loaded.program if program is None else program)  # type: ignore[union-attr]
            self.clear()
            if not passive and self.settings is not None and self.settings.wired:
                self.home()  # where the wiring is not confirmed the board says so, wherever its handle is
            with self._lock:
                self._begin(program, every, OPTIONS["PASSIVE"] if passive else 0, min(force_max, 3e38))

    def set(self, **values: float | str) -> None:
        """Set parameters of the scene on the board, live, all of them between the same two ticks.

        Parameters
        ----------
        **values : float or text
            Live parameters by name, in SI or with a unit; at most 8 at once.

        Raises
        ------
        ParameterError
            For an unknown name, a bad value, or more than 8 at once.
        """
        with self._lock, guarded(self._motor_off):
            if self._loaded is None:
                raise PaddleError("the board has no scene yet; start one first: paddle.start(scene)")
            numbers = checked(self._loaded.program, values)
            tick = send(self.exchange, self._loaded.program, numbers)
            self._loaded = self._loaded.with_values(numbers)
            if self._run is not None:
                self._run.changes.append(((tick + 1) * self.T, numbers))

    def wait(self, seconds: Number) -> None:
        """Let the scene run for a number of seconds of the board's time, or until a fault, which is reported.

        Interrupted, it switches the motor off; :meth:`stop` returns what was recorded until then.

        Parameters
        ----------
        seconds : float or text
            [s], > 0, or a text with its unit.
        """
        run = self._running()
        with guarded(self._motor_off):
            self._collect(run.last_tick + 1 + self.ticks(seconds), None)
        if run.fault is not None:
            print(f"{self.url}: {fault_words(run.fault, self.T)}")

    def stop(self, *, ticks: int | None = None) -> Telemetry:
        """Switch the motor off and return the Telemetry of the run.

        Parameters
        ----------
        ticks : int, optional
            How many ticks of the run the record keeps, from its first; by default every sample that came.
        """
        with self._lock:
            run = self._running()
            self.exchange.beating = False  # first: whatever happens to STOP, the motor goes off
            self.exchange.command("STOP")
            state = self.exchange.refresh()
            if state["state"] == STATES["FAULT"]:
                run.fault = run.fault or silent_fault(state, self.exchange)
                self.exchange.command("CLEAR")
            self._listen(None)
            self.timing = Timing(state, self.board["clock_hz"], self.T)
            return run.telemetry(ticks=ticks, delay=self.timing.mean, paddle=str(self))

    def clear(self) -> None:
        """Report a pending fault, if there is one, and clear it, so that the board accepts a scene again; the motor stays off."""
        for sentence in cleared(self.exchange, self.url):
            self.exchange.beating = False  # what ran had ended
            print(sentence)

    def home(self, at: Number | None = None, *, timeout: Number = 60.0) -> None:
        """Find the position of the handle, which the board loses at every reset; it gives no force before.

        Parameters
        ----------
        at : float, optional
            The handle is held at this position [m], now. Without it the handle is to be led to both stops, by hand; a
            simulated one (``sim://``) has no hand, and is put to the middle, at rest.
        timeout : float
            How long that may take [s].
        """
        home(self.exchange, self.settings, at, timeout)

    def keep(self, scene: Scene | Program, **options: Any) -> str:
        """Write a scene into the board's memory that survives power-off, arm it, and return what starts it, in words.

        After power-on without a computer the board waits for a deliberate act that also tells it where the handle is. A
        computer that says hello takes the board back. Parameters are fixed at their values.

        Parameters
        ----------
        scene : Scene
            With every parameter bound.
        **options
            Of hapticlab.compile.

        Raises
        ------
        PaddleError
            If a scene runs, the motor's sign was never checked, or its steps are unstable.
        ProgramLimitError
            If a step could be late, with whatever operands: nobody is there to see that it was.
        LinkError
            If it does not fit the board's store.

        Examples
        --------
        >>> import hapticlab as hl
        >>> with hl.connect("sim://hapkit") as paddle:
        ...     print(paddle.keep(hl.wall()(k=150, x_o=0.01)))
        move the handle to both stops, then hold it in the middle for 1 s; the force then switches on
        """
        with self._lock:
            self._require_idle("keep")
            if self.settings is None or not self.settings.checked:
                raise PaddleError(
                    "the sign of the motor was not checked on this board, and a board without a computer must not push in "
                    "the wrong direction. Run `hapticlab calibrate` first."
                )
            program = self.program(scene, live=(), **options)
            check_margin(program)
            known = {} if isinstance(scene, Program) else {"T": self.T, "velocity": self.velocity, "live": (), **options}
            fit(scene, promise=True, **self._board(), **known)
            self._loaded = None  # the upload takes the place of what was loaded
            upload(self.exchange, "STANDALONE", encode(program, word_bits=8 * self.board["word_bytes"]))
            self.exchange.command("ARM", 1, patience=STORE_PATIENCE, tries=2)
            return GESTURE

    def forget(self) -> None:
        """Make the board wait for a computer after power-on again."""
        with self._lock:
            self._require_idle("forget")
            self.exchange.command("ARM", 0, patience=STORE_PATIENCE, tries=2)

    @property
    def under_way(self) -> Run | None:
        """The Run that is under way, or None."""
        return self._run

    @contextmanager
    def attended(self) -> Iterator[None]:
        """Start, ask a person and stop inside; what raises here, an interrupt included, leaves no motor running."""
        try:
            yield
        except BaseException:
            self.abandon()
            raise

    def state(self) -> dict[str, Any]:
        """Return the board's state as it is now: a dict of messages.STATE's fields."""
        return self.exchange.refresh()

    def close(self) -> None:
        """Stop the motor and close the port."""
        with self._lock:
            try:
                if self.exchange.broken is None:
                    self.abandon()
            finally:
                self._end()

    def __enter__(self) -> SerialPaddle:
        return self

    def __exit__(self, *failure: Any) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<SerialPaddle {self.url}: {'; '.join([str(self), *self.notices])}>"

    def __str__(self) -> str:
        return introduction(self.board, self.settings, self.T)

    def _board(self):
        """What cost() asks: the board, "host" where its time is not known, and the most edges of its encoder in a second."""
        s, name = self.settings, self.board["board"]
        edges = s.speed_max / abs(s.metres_per_count) if s is not None and s.sensor == SENSORS["QUADRATURE"] else 0.0
        return {"board": name if name in BOARDS else "host", "edges_per_second": edges}

    def fitted(
        self, scene: Scene | Program | None, every: int | None, check_fit: bool, options: dict[str, Any]
    ) -> Program | None:
        """The program of a scene that fits the board, or None for the one that is there.

        Parameters
        ----------
        scene : Scene, Program or None
            None keeps the program that is on the board.
        every : int or None
            One sample in so many ticks is sent; None for as many as the link carries.
        check_fit : bool
            Whether a program that takes longer than the period is rejected; one that is too large always is.
        options : dict
            Options of :func:`hapticlab.compile`.
        """
        if scene is None:
            if self._loaded is None:
                raise PaddleError("the board has no scene yet; give one: paddle.start(scene)")
            return None
        program = self.program(scene, **options)
        sent = decimation(program, self.exchange.port, every, self.board["board"])
        if check_fit and not cost(program, every=sent, **self._board()).fits:
            known = {} if isinstance(scene, Program) else {"T": self.T, "velocity": self.velocity}
            fit(scene, every=sent, **self._board(), **known, **options)
        return program

    def _require_idle(self, asked):
        if self._run is not None:
            raise PaddleError(f"{asked}: a scene is running; end it first: paddle.stop()")

    def _running(self):
        if self._run is None:
            raise PaddleError("no scene is running; start one first: paddle.start(scene)")
        return self._run

    def _begin(self, program, every, options, force_max):
        """Load a program, or take the one that is there for None, and start it; refused, what ran before is meant again."""
        if program is not None and self._run is not None and self.board["slots"] == 1:
            self.stop()
        fed, before, earlier = self.exchange.beating, self._loaded, self._run
        try:
            if program is not None:
                # noted before its values are sent: where the board refuses one, SET already means this program
                self._loaded = load(self.exchange, program, self.board["word_bytes"])
                for some in in_portions(named_values(program)):
                    send(self.exchange, program, some)
            sent = decimation(self._loaded.program, self.exchange.port, every, self.board["board"])
            run = Run(self._loaded, sent, self.exchange.absent, self.device.sensor_delay)
            self._listen(run)
            self.exchange.beating = True
            self.exchange.command("START", self._loaded.crc, run.every, options, force_max, then=run.begin)
        except HapticlabError as problem:
            if is_refusal(problem):
                self._listen(earlier)
                self.exchange.beating = fed
                if fed and self._loaded is not before:
                    self._loaded = before
                    # a BEGIN that nothing follows empties the place that was loaded: SET means the one that runs again
                    self.exchange.command("BEGIN", TARGETS["PROGRAM"], SMALLEST)
            raise

    def _collect(self, ticks, bar):
        """Read until so many ticks are recorded, or a fault."""
        run, exchange, seen = self._running(), self.exchange, 0
        wanted, look = (ticks - 1) // run.every * run.every, max(LOOK, run.every)
        while run.last_tick < wanted and run.fault is None:
            before, next_look = run.last_tick, min(wanted, run.last_tick + look)
            came = exchange.wait(
                lambda enough=next_look: run.last_tick >= enough or run.fault or self._run is not run, PATIENCE + look * self.T
            )
            if self._run is not run:
                raise PaddleError("another thread ended this run or began a new one, and received the recording.")
            if not came and run.last_tick == before:
                run.fault = run.fault or explain_silence(exchange, self.url)
            if bar is not None:
                bar.update(max(0, min(run.last_tick + 1, ticks) - seen))
                seen = max(seen, run.last_tick + 1)

    def _listen(self, run):
        """Give what the board says to a run, or to none."""
        self._run = run
        self.exchange.give(run and run.add)

    def abandon(self) -> None:
        """Switch off the motor and stop recording."""
        self._listen(None)
        self._motor_off()

    def _motor_off(self):
        self.exchange.beating = False
        with suppress(PaddleError):  # then the board stops its motor by itself, 100 ms after the last word
            self.exchange.command("STOP", tries=4)
