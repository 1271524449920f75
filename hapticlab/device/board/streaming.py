"""A scene on a board whose samples are taken as they come, while its parameters change."""

from contextlib import suppress
from dataclasses import replace

from ...errors import HapticlabError
from ..link.messages import STATES
from ..live_parameters import checked, in_portions, named_values, tell
from .greeting import explain_silence
from .homing import state_flag
from .run import decimation, fault_words
from .serial_paddle import PATIENCE

#: a board is fed so long after the last look at its samples, then its motor goes off by itself [s]
LEASH = 1.0
LEAD = "Move the handle slowly to one stop, then to the other, and back, so that the board finds its position"


class Streaming:
    """A scene on a board: the counterpart of :class:`~hapticlab.device.simulated.stepping.Stepping`, with a hand of flesh.

    Parameters
    ----------
    paddle : SerialPaddle
    scene : Scene or Program
        Refused here where it does not fit the board.
    **options
        Of hapticlab.compile.

    Attributes
    ----------
    program : Program
        With the values it has now.
    period : float
        From one sample to the next [s].
    begun : bool
        Whether the scene runs, or waits for the handle to be led to its stops.
    motor : bool
        Whether the motor is on.
    waits : str
        What is waited for, in words.
    fault : str or None
        What stopped the motor.

    Examples
    --------
    >>> import hapticlab as hl, numpy as np
    >>> with hl.connect("sim://hapkit") as paddle:
    ...     streaming = Streaming(paddle, hl.wall()(k=150, x_o=0.01))
    ...     streaming.start()
    ...     samples = streaming.advance(np.zeros(101))
    ...     streaming.stop()
    >>> 95 <= len(samples["t"]) <= 105, streaming.motor
    (True, False)
    """

    kind = "board"

    def __init__(self, paddle, scene, **options):
        self.paddle = paddle
        self.program = paddle.fitted(scene, None, True, options)
        self.period = paddle.T * decimation(self.program, paddle.exchange.port, board=paddle.board["board"])
        self._last_run = self._run = None
        self.place, self.waits, self.fault = 0.0, "", None

    @property
    def begun(self):
        return bool(self.waits) or self.motor

    @property
    def motor(self):
        return self._run is not None and self._run is self.paddle.under_way and self.fault is None

    def start(self):
        """Start the scene, or wait for the handle to be led to its stops where the board does not know where it is."""
        self.stop()
        self.paddle.clear()
        self.fault, self.waits = None, LEAD if self.is_lost() else ""
        if not self.waits:
            self._begin()

    def stop(self):
        """Switch the motor off; what another run on this paddle does is left alone."""
        mine, self._run, self.waits = self._run, None, ""
        if mine is not None and mine is self.paddle.under_way:
            try:
                self.paddle.stop()
            except BaseException:
                self.paddle.abandon()
                raise

    def advance(self, intent):
        """The samples since the last look, a dict of columns; None where there are none.

        Where time is virtual it passes for as many ticks as there are places less one; nobody looks at the places.
        """
        if self.waits:
            if not self.is_lost():
                self.waits = ""
                self._begin()
            return None
        if not self.motor:
            self.fault = self.fault or self._why_off()
            return None
        exchange, run = self.paddle.exchange, self._run
        self._leash.renew()
        if exchange.lockstep:
            self._until += (len(intent) - 1) * self.paddle.T
            exchange.wait(lambda: run.fault is not None, max(0.0, self._until - exchange.now()))
        exchange.check()
        samples = run.take()
        if len(samples["t"]):
            self._heard, self.place = exchange.now(), float(samples["x"][-1])
        elif exchange.now() - self._heard > PATIENCE and run.fault is None:
            run.fault = explain_silence(exchange, self.paddle.url)
        self.fault = fault_words(run.fault, self.paddle.T)
        return samples if len(samples["t"]) else None

    def check(self, **values):
        """Return values in SI, or say why a parameter cannot have one."""
        numbers = {}
        for some in in_portions(values):
            numbers |= checked(self.program, some)
        return numbers

    def set(self, **values):
        """Set parameters of the scene, on the board where it runs; return the time from which they hold [s]."""
        numbers, since = self.check(**values), 0.0
        for some in in_portions(numbers) if self.motor else ():
            self.paddle.set(**some)
            since = self._run.changes[-1][0]
        self.program = replace(self.program, values=tuple((named_values(self.program) | numbers).values()))
        return since

    def hear(self, **numbers):
        """Set what another paddle sends, in SI, unchecked and unrecorded; return False where the board is not ready for it.

        Nobody waits for the answer: what is lost, the next one replaces.
        """
        return not self.motor or tell(self.paddle.exchange, self.program, numbers)

    def hold(self, held):
        """A hand of flesh takes the handle and lets go of it by itself."""

    def warm(self):
        """Nothing is compiled while a board runs."""

    def telemetry(self, rows, *, values, changes=()):
        """Return rows that :meth:`advance` gave, put together, as Telemetry that begins at 0 s."""
        begin = rows["t"][0]
        moved = [(t - begin, numbers) for t, numbers in changes]
        return self._last_run.as_telemetry(
            rows | {"t": rows["t"] - begin}, delay=self._delay(), paddle=str(self.paddle), changes=moved, values=dict(values)
        )

    def _begin(self):
        self.paddle.start(self.program, check_fit=False)
        self._run = self._last_run = self.paddle.under_way
        exchange = self.paddle.exchange
        self._leash = exchange.beating = Leash(exchange)
        self._until = self._heard = exchange.now()

    def is_lost(self):
        """Return whether the board waits for the handle to be led to its stops; a simulated one is put to the middle."""
        paddle = self.paddle
        if paddle.settings is None or hasattr(paddle.exchange.port, "lead"):
            return False
        return not state_flag(paddle.exchange, "HOMED")

    def _why_off(self):
        exchange = self.paddle.exchange
        if exchange.broken is not None:
            return str(exchange.broken)
        if exchange.closed:
            return "this paddle was closed. Connect it again, and run the view's cell again"
        return "another cell began a scene on this paddle, or ended this one"

    def _delay(self):
        """Mean time of a step on the board [s]."""
        state = self.paddle.state() if self.motor else None
        if state is not None and state["state"] == STATES["RUN"]:
            return state["step_mean"] / self.paddle.board["clock_hz"]
        with suppress(HapticlabError, AttributeError):
            return self.paddle.timing.mean
        return 0.0


class Leash:
    """True until nobody has looked for a while: whoever feeds a board's watchdog asks, so that it ends with who looked."""

    def __init__(self, exchange):
        self._now = exchange.now
        self.renew()

    def renew(self):
        """Look."""
        self._until = self._now() + LEASH

    def __bool__(self):
        return self._now() < self._until
