"""``sim://``: the firmware's own core on this computer, closed around a simulated paddle, behind a serial port.

``sim://hapkit`` takes the mechanics, the sensor and the drive of a profile, ``sim://bench7.json`` those of the profile in a
file; ``sim://hapkit?pace=real`` runs by the clock on the wall; where there are no threads it catches up with the clock whenever
somebody looks. Without a pace time is virtual: it passes while somebody reads, as fast as the computer can, so that the same
calls give the same run.
"""

import threading
import time
from urllib.parse import parse_qs

from serial import SerialBase

from ...base.profile.profile_file import SUFFIX
from ...errors import PaddleError, PortError
from ..board.host_board import HostBoard
from ..board.settings import changed, of_profile, simulated
from ..link.messages import MOTOR_LAWS, SENSORS
from ..profiles import PROFILES, kind_named, profile
from ..simulated.angle_sensor import AngleSensor
from ..simulated.moved_handle import Handle
from ..simulated.simulated_paddle import SimulatedPaddle
from ..turns import begin, has_threads
from ..variants import VARIANTS

SCHEME = "sim://"
#: of ticks that are late, made up for at once [s]
LONGEST_BURST = 0.03
#: between two looks of a read that waits by itself [s]
LOOK = 1e-3


class Serial(SerialBase):
    """A port of a simulated board; see the module. ``put_on`` replaces its ``paddle`` before the first read.

    ``wiring`` is what lies between the board and its motor: 1 right, -1 swapped wires, 0 no supply. ``sensor`` is what lies
    between the sensor and the board: counts in, counts out.
    """

    bytes_per_second = float("inf")
    wiring = 1

    def open(self):
        self._at, pace = _parts(self.port)
        if pace not in ("virtual", "real"):
            raise PaddleError(f"{self.port}: pace={pace}; needs pace=real, or none for virtual time.")
        self.lockstep = pace == "virtual"
        self._changed = threading.Condition()
        self._heard = b""
        self.is_open = True
        self.put_on(None)

    def put_on(self, paddle, x=0.0, *, settings=None, store=None):
        """Power the board anew, its core closed around this paddle, with the handle at x [m].

        ``settings`` are what sensor and motor really are, ``store`` what the board keeps of them: the same if None, and
        nothing, as on a new board, if b"".
        """
        paddle, usual, kept = _mechanics(self._at, paddle)
        with self._changed:
            self.paddle = paddle
            self.settings = (settings or usual).to_float32()
            kept = kept if settings is None else self.settings
            self.board = HostBoard(kept.to_bytes() if store is None else store)
            self.handle = Handle(paddle, x).with_period(self.board.period)
            self._per_metre = 1 / self.settings.metres_per_count
            self._angle = self._angle_sensor()
            self.board.tick(self._counts(), self.now())  # it has looked at its sensor before anybody asks
        self._begun = time.monotonic() - self.now()
        if not self.lockstep and has_threads() and not hasattr(self, "_clock"):
            self._clock = begin(self._run_by_the_clock(), self.port)

    def lead(self, x):
        """Put the handle to x [m], at rest, as a hand would; the board's sensor has seen it there."""
        with self._changed:
            self.handle.put(x)
            self._angle = self._angle_sensor()
            self.board.tick(self._counts(), self.now())

    def close(self):
        self.is_open = False

    def now(self):
        """Virtual time since power-on [s]."""
        return self.handle.t

    @property
    def in_waiting(self):
        self._require_open()
        with self._changed:
            self._catch_up_alone()
        return len(self._heard)

    def read(self, size=1):
        self._require_open()
        with self._changed:
            if self.lockstep:
                deadline = self.now() + (self.timeout or 0.0)
                while len(self._heard) < size and self.now() < deadline:
                    self._tick()
            elif not has_threads():
                until = time.monotonic() + (self.timeout or 0.0)
                self._catch_up_alone()
                while len(self._heard) < size and time.monotonic() < until:
                    time.sleep(LOOK)
                    self._catch_up_alone()
            else:
                self._changed.wait_for(lambda: len(self._heard) >= size or not self.is_open, self.timeout)
            said, self._heard = self._heard[:size], self._heard[size:]
        return said

    def write(self, data):
        self._require_open()
        with self._changed:
            self.board.receive(bytes(data))
            self._heard += self.board.transmit()
            self._changed.notify_all()
        return len(data)

    def reset_input_buffer(self):
        self._heard = b""

    def _require_open(self):
        if not self.is_open:
            raise PortError(f"{self.port} is closed; connect again", "left")

    def _tick(self):
        """One tick of the board, and what the handle does until the next."""
        if abs(self.board.period - self.handle.paddle.T) > 1e-9:
            self.handle = self.handle.with_period(self.board.period)
        step = min(self.handle.paddle.delay, self.handle.paddle.T)
        duty = self.board.tick(self._counts(), self.handle.t, step)
        self.handle.step(-self.wiring * self.settings.force_of_duty(duty))  # the motor gives -F (Fig. 23.5)
        self._heard += self.board.transmit()

    def _counts(self):
        """What the sensor reads now."""
        counts = self.handle.counts()
        counts = self.sensor(round(self.handle.seen * self._per_metre) if counts is None else counts)
        return counts if self._angle is None else self._angle.reading(counts, self.handle.t)

    def sensor(self, counts):
        """Return what arrives of the sensor's counts."""
        return counts

    def _angle_sensor(self):
        """The sensor's own part in what the board reads: None where every count is as good as its reading."""
        settings = self.settings
        flies = settings.sensor != SENSORS["QUADRATURE"] and settings.sensor_flight > 0
        return AngleSensor(settings.wrap, settings.sensor_flight) if flies else None

    def _run_by_the_clock(self):
        while self.is_open:
            with self._changed:
                self._catch_up()
                self._changed.notify_all()
            yield self.board.period

    def _catch_up(self):
        """Tick until now, by the clock on the wall."""
        # a computer that slept does not make up for it: in a burst nobody could say that he is there
        now = time.monotonic()
        self._begun = max(self._begun, now - self.now() - LONGEST_BURST)
        while self.is_open and self.now() < now - self._begun:
            self._tick()

    def _catch_up_alone(self):
        """The same where no thread does."""
        if not (self.lockstep or has_threads()):
            self._catch_up()

    def _reconfigure_port(self):
        """Nothing of a port's settings matters to a simulation."""

    _update_dtr_state = _update_rts_state = _update_break_state = _reconfigure_port


def _parts(url):
    """Return the profile that a URL names, which may be the path of a file on any system, and the pace."""
    at, _, query = url[len(SCHEME) :].partition("?")
    at = at if at.endswith(SUFFIX) else at.rstrip("/")
    options = parse_qs(query, keep_blank_values=True)
    unknown = sorted(set(options) - {"pace"})
    if unknown:
        raise PaddleError(
            f"{url}: {unknown[0]} is not an option of a simulated board. The only option is pace=real: sim://hapkit?pace=real"
        )
    return at, options.get("pace", ["virtual"])[0]


def _profile_at(at):
    """Return the profile that a URL names, by its kind or its file."""
    if not at.endswith(SUFFIX) and kind_named(at) is None:
        names, more = ", ".join(f"{SCHEME}{name}" for name in PROFILES), ", ".join(f"_{word}" for word in VARIANTS)
        raise PaddleError(
            f"{SCHEME}{at}: no such paddle; there are {names}, each also with {more}. A file that profile.save() wrote is a "
            f"paddle too: {SCHEME}bench7.json"
        )
    try:
        return profile(at)
    except PaddleError as refusal:
        raise PaddleError(f"{SCHEME}{at}: {refusal}") from None


def _mechanics(at, paddle):
    """Return the paddle, the settings that are true of it, and those that its board keeps."""
    if paddle is None:
        kind = _profile_at(at)
        paddle, kept = SimulatedPaddle.from_profile(kind), of_profile(kind)
        if kept is not None:
            return paddle, kept, kept
    true = simulated(paddle)
    plain = {} if paddle.compensated else {"duty_dead": 0.0, "motor_law": MOTOR_LAWS["LINEAR"]}
    return paddle, true, changed(true, **plain)
