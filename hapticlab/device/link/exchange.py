"""Requests and replies over one open port, with one reader.

On a real port a thread reads, and keeps the board's watchdog fed. A port in virtual time (``lockstep``) has no thread:
whoever waits reads, so that the same calls give the same run; time passes for that thread alone, and others are refused.
Where there are no threads, the event loop reads between two turns of others, and whoever waits reads meanwhile.
"""

import itertools
import secrets
import threading
import time
from contextlib import contextmanager, suppress

from ...errors import LinkError, PaddleError, PortError
from ..turns import begin, has_threads
from .messages import HOST_SILENCE_MS, MESSAGES, RESULTS, row_of
from .port_faults import slept
from .presence import LONGEST_PAUSE, Presence
from .serial_ports import port_watched, read_available
from .wire import Decoder, encode

#: seconds; four heartbeats fit into the silence that a board takes for the host's end
HEARTBEAT = HOST_SILENCE_MS / 4000
#: seconds until a request is sent again, soon enough to break no silence, and how often. A board answers within 2 ms.
PATIENCE, TRIES = 0.03, 33
#: between two looks at a port on which nobody else reads while somebody waits [s]
LOOK = 1e-3


class Exchange:
    """Ask a board, and collect what it says by itself.

    Parameters
    ----------
    port : serial object
        Of open_port.
    on_frame : callable
        Called with every Frame that is no reply: samples, fault reports. In the reader's thread, so it only stores. The
        reader keeps alive whatever this refers to: never a paddle, whose motor would then run on when nobody holds it.

    Attributes
    ----------
    state : dict or None
        Fields of the last STATE.
    broken : PortError or None
        Why the reader stopped.
    presence : Presence
        Whether this program ran all the time since the last START; where time is virtual it always did.
    """

    def __init__(self, port, on_frame=lambda frame: None):
        self.port, self.on_frame = port, on_frame
        self.lockstep = getattr(port, "lockstep", False)
        self.now = port.now if self.lockstep else time.monotonic
        self.decoder = Decoder()
        # never 0, a board's word for no session; drawn, so that no frame left over from another session passes for this one's
        self.session = secrets.randbits(31) + 1
        self.state, self.broken, self.beating = None, None, False
        # guarded requests count by themselves: a board refuses one older than the last it obeyed
        self._sequences = {guarded: itertools.count(1) for guarded in (False, True)}
        self._wanted = self._reply = self._then = self._beat_sequence = self._told = None
        self._alone = not (self.lockstep or has_threads())  # nobody reads while somebody waits
        port.timeout = 0.0 if self._alone else HEARTBEAT / 4  # so that a silent board does not keep the reader from beating
        self._turn, self._news, self.closed = threading.Lock(), threading.Condition(), False
        self._waiting = None  # the thread for which virtual time passes
        self._last_sent = self.now()
        self.presence = Presence(self.now) if self.lockstep else Presence()
        self._reader = None if self.lockstep else begin(self._read_for_ever(), f"hapticlab {port.port}")

    def ask(self, message, *values, rest=b"", patience=PATIENCE, tries=TRIES, then=lambda: None):
        """Send a request until its reply comes; return the reply's Frame.

        A repeat carries the same sequence number, so that a board obeys it once. ``then`` is called, between the frames
        that came before the reply and those after it, if the board did what was asked.

        Raises
        ------
        LinkError
            If nothing came back.
        PortError
            If the port failed.
        PaddleError
            If time is virtual, and another thread waits.
        """
        with self._turn:
            self._require_my_time()
            sequence = self._next_sequence(message)
            frame = encode(message, sequence, *values, rest=rest, session=self.session)
            self._wanted, self._reply, self._then = (message, sequence & 255), None, then
            for _ in range(tries):
                if not _keeps_alive(message):
                    self._say_present()
                # a board takes one frame at a time: a heartbeat under way is answered first
                self._wait_until(lambda: self._beat_sequence is None, HEARTBEAT / 2)
                self._beat_sequence = None
                self._send(frame, _keeps_alive(message))
                if self._wait_until(lambda: self._reply is not None, patience):
                    return self._reply
        raise LinkError(
            f"{self.port.port} does not answer {message} in {tries} tries of {patience:g} s; "
            "check that the board has power and its cable is in, then connect again (`hapticlab doctor` finds the cause)"
        )

    def command(self, message, *values, rest=b"", **options):
        """Ask for something to be done; return the tick after which it was, or raise LinkError with the board's reason."""
        if message == "START":
            self.presence.forget()
        reply = self.ask(message, *values, rest=rest, **options)
        said = reply.fields
        if said["result"]:
            name, meaning = _result(said["result"])
            raise LinkError(f"the board rejected {message}: {name}: {meaning}", name)
        return said["tick"]

    def tell(self, message, *values, rest=b""):
        """Send a request once and wait for no reply; return False, with nothing sent, where another one is under way.

        This is for what may be lost and comes again at once. A board takes one frame at a time, so the next one is sent
        when this one was answered, or was lost.
        """
        if self._told is not None and self.now() - self._told_at < PATIENCE:
            return False
        if not self._turn.acquire(blocking=False):
            return False
        try:
            self._require_my_time()
            sequence = self._next_sequence(message)
            self._told, self._told_at = sequence & 255, self.now()
            self._send(encode(message, sequence, *values, rest=rest, session=self.session))
        finally:
            self._turn.release()
        return True

    def refresh(self):
        """Ask for the board's state and return its fields."""
        return self.ask("STATUS", self.session).fields

    def wait(self, condition, seconds):
        """Read until condition() holds; return whether it did within so many seconds of the port's time."""
        with self._my_time():
            return self._wait_until(condition, seconds, beat=True)

    def give(self, on_frame=None):
        """Give samples and fault reports to another than before, or to nobody."""
        with self._news:
            self.on_frame = on_frame or (lambda frame: None)
            self._news.notify_all()

    def hang_up(self):
        """Say STOP, to whoever may hear it, and close. Waits for no answer: a garbage collector may call it anywhere."""
        self.beating = False
        with suppress(Exception):  # then the board stops its motor by itself, 100 ms after the last word
            if self._turn.acquire(timeout=HEARTBEAT):
                try:
                    self._send(encode("STOP", self._next_sequence("STOP"), session=self.session))
                finally:
                    self._turn.release()
        self.close()

    def close(self):
        """End the reader and close the port; the board goes silent-host by itself."""
        self.closed = True
        if self._reader is not None and not self._reader.is_current():
            self._reader.join(2)
        carrier = getattr(self.port, "_socket", None)
        self.port.close()
        if carrier is not None:
            carrier.close()  # pyserial leaves it open where the other end has gone first

    @contextmanager
    def _my_time(self):
        """On a port in virtual time nobody else may ask or wait meanwhile: they would let each other's time pass."""
        if not self.lockstep:
            yield
            return
        with self._turn:
            self._require_my_time()
            before, self._waiting = self._waiting, threading.get_ident()
        try:
            yield
        finally:
            self._waiting = before

    def _require_my_time(self):
        if self._waiting not in (None, threading.get_ident()):
            raise PaddleError(
                f"{self.port.port}: time is virtual here and passes only while a thread waits, and another thread is "
                "waiting now. Call this between its waits, or let time pass by itself: sim://hapkit?pace=real"
            )

    def _next_sequence(self, message):
        return next(self._sequences[MESSAGES[message].guarded])

    def _send(self, frame, keeps_alive=True):
        self.check()
        self._last_sent = self.now() if keeps_alive else self._last_sent
        begun = self.presence.now()
        try:
            with port_watched(self.port):
                self.port.write(frame)
        except PortError as problem:
            # a blocked port takes the time that a write may take; longer, this program was stopped, and the frame is lost
            if problem.cause == "silent" and self.presence.now() - begun > self.port.write_timeout + LONGEST_PAUSE:
                self.presence.note()
                return
            raise self._explained(problem) from problem.__cause__

    def absent(self):
        """Return for how long this program did not run since the last START [s]; 0 where time is virtual."""
        return 0.0 if self.lockstep else self.presence.absent()

    def _explained(self, problem):
        """What broke the exchange; of a port that went while the computer slept, in these words."""
        gone = isinstance(problem, PortError) and problem.cause == "left" and not self.closed
        return slept(self.port.port, self.absent()) if gone and self.absent() else problem

    def check(self):
        """Raise what broke the exchange, if anything did."""
        if self.broken is not None:
            raise self.broken

    def _wait_until(self, condition, seconds, beat=False):
        deadline = self.now() + seconds
        if not (self.lockstep or self._alone):
            with self._news:
                self._news.wait_for(lambda: condition() or self.broken, seconds)
            self.check()
            return bool(condition())
        while not condition():
            if self.now() >= deadline:
                return False
            if beat:
                self._beat()
            if self.lockstep:
                self._take(read_available(self.port))
            elif not self._read():
                self.check()
                time.sleep(LOOK)
        return True

    def _take(self, data):
        """Sort what came: replies to whoever waits, states kept, the rest to on_frame."""
        for frame in self.decoder.feed(data):
            try:
                known = frame.fields
            except ValueError:
                self.decoder.damaged += 1
                continue
            if frame.message == "STATE":
                self.state = known
                self._beat_sequence = None if frame.sequence == self._beat_sequence else self._beat_sequence
            elif frame.message == "ACK" and frame.sequence == self._told:
                self._told = None
            if frame.message in ("SAMPLE", "FAULTED"):
                self.on_frame(frame)
            elif self._is_wanted(frame, known):
                self._reply, self._wanted = frame, None  # a request sent twice is answered twice; the second is nobody's
                if not known.get("result"):
                    self._then()

    def _is_wanted(self, frame, known):
        if self._wanted is None or frame.sequence != self._wanted[1]:
            return False
        asked = MESSAGES[self._wanted[0]].number
        return known["request"] == asked if frame.message == "ACK" else frame.message in ANSWERS.get(self._wanted[0], ())

    def _beat(self):
        """Say that the host is there, unless a request said so or waits for its reply."""
        if self._turn.acquire(blocking=False):
            try:
                self._say_present()
            finally:
                self._turn.release()

    def _say_present(self):
        """Say it where it is due; whoever calls has the turn."""
        if self.beating and self.now() - self._last_sent >= HEARTBEAT:
            self._beat_sequence = self._next_sequence("STATUS") & 255
            self._send(encode("STATUS", self._beat_sequence, self.session))

    def _read_for_ever(self):
        while not self.closed and self.broken is None:
            self._read(beat=True)
            yield HEARTBEAT / 4 if self._alone else 0.0

    def _read(self, beat=False):
        """Take what has come, and say that the host is there; return whether something came."""
        try:
            data = read_available(self.port)
            self.presence.note()
            if beat:
                self._beat()
            if data:
                with self._news:
                    self._take(data)
                    self._news.notify_all()
            return bool(data)
        except Exception as problem:  # whatever it was, those who wait must hear of it
            if not self.closed:
                self.broken = self._explained(problem)
            self.presence.end()
            with self._news:
                self._news.notify_all()
            return False


#: which message answers which request, where it is not ACK
ANSWERS = {"HELLO": ("WELCOME",), "PING": ("PONG",), "STATUS": ("STATE",), "READ": ("BYTES",)}


def _keeps_alive(message):
    """Whether a board takes a message for the word of the session that drives it."""
    return MESSAGES[message].guarded or message in ("HELLO", "STATUS")


def _result(number):
    return row_of(RESULTS, number) or (f"result {number}", "unknown")
