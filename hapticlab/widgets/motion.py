"""What moves in a live view: the scene, by the clock and led by a hand, or a record of it that is played again."""

import math

import numpy as np

from ..base.telemetry import FLAGS
from ..device.live_parameters import named_values
from .pace import Pace
from .traces import RECENT, Traces
from .view_recorder import Recorder, Replay

#: a hand goes no faster to where the pointer is [m/s], and follows it so late [s]: a pointer's steps would shake it
FASTEST, FOLLOWS = 1.0, 0.025


class Motion:
    """The scene on its paddle, advanced to the clock whenever somebody asks.

    Parameters
    ----------
    source : Stepping or Streaming
        What gives samples.
    speed : float
        Scene time over the clock's time.
    clock : callable
        Seconds.
    watched : sequence of str
        Channels that frames carry.
    touching : callable, optional
        Of samples and parameters: whether the environment is touched, see :func:`~hapticlab.analysis.pictures.touching.touching`.

    Attributes
    ----------
    running : bool
        The scene runs; on a board the motor is on, or waits for the handle's home.
    held : bool
    log : Telemetry or None
        What was recorded last.
    missed : bool
        Since the start, an event was left unlocated.
    """

    def __init__(self, source, speed, clock, watched=(), touching=None):
        self.source, self.speed, self.clock = source, speed, clock
        self.watched, self._touching = tuple(watched), touching
        self.pace = Pace(source.paddle.T, speed)
        self.running, self.held, self.log, self.missed = False, True, None, False
        self._recorder = self._replay = self._live = None
        self._at = 0.0
        self._last, self._noticed = {"x": 0.0, "F": 0.0}, {}
        self.traces = Traces(source.period, watched)

    @property
    def recording(self):
        return self._recorder is not None

    @property
    def has_record(self):
        """Whether :meth:`recorded` returns something."""
        return self.log is not None or bool(self._recorder and self._recorder.samples)

    @property
    def replaying(self):
        return self._replay is not None

    @property
    def time(self):
        """Of the last sample shown [s]."""
        return float(self._last.get("t", 0.0))

    @property
    def place(self):
        """Of the handle as last shown [m]."""
        return self._last.get("x_true", self._last["x"])

    def start(self):
        """Run from the beginning; a recording that has samples ends, and a replay."""
        self.replay(None)
        waits = self._recorder is not None and not self._recorder.samples
        self.stop_recording()
        self.source.stop()
        self.running = False  # a start may be refused
        self.traces, self._noticed, self.missed = Traces(self.source.period, self.watched), {}, False
        self.source.start()
        self._at = self.source.place
        self._last = {"x": self._at, "F": 0.0}  # not where it was before
        self.running = True
        if waits:
            self.record()
        self.wake()

    def resume(self):
        """Run on; from the beginning after a fault, and on a board. A replay ends."""
        self.replay(None)
        if self.source.fault or not self.source.begun:
            self.start()
        elif not self.running:
            self.running = True
            self.wake()

    def pause(self):
        """Stand still; a board's motor goes off, and its recording ends. So does a replay."""
        self.replay(None)
        self.rest()

    def rest(self):
        """Stand still; a board's motor goes off, and its recording ends. A replay waits for :meth:`wake`."""
        self.running = False
        try:
            self.source.stop()
        finally:
            if not self.source.begun:
                self.stop_recording()

    def wake(self):
        """Count time from now on: what passed before is not made up for."""
        self.pace.start(self.clock())
        if self._replay is not None:
            self._replay.go_on(self.clock())

    def pass_at(self, speed):
        """Let scene time pass at another speed over the clock's from now on."""
        self.speed = speed
        self.pace.pass_at(speed)
        if self._replay is not None:
            self._replay.pass_at(speed, self.clock())

    def hold(self, held):
        """Take the handle, or let go of it."""
        if held != self.held:
            self.held, self._at = held, self.source.place
            self.source.hold(held)

    def set(self, **values):
        """Set parameters between two ticks, or refuse them."""
        numbers = self.source.check(**values)
        since = self.source.set(**numbers)
        if self._recorder is not None:
            self._recorder.changed(since, numbers)

    def record(self):
        """Record from the next sample on."""
        self._recorder = Recorder(self.source)

    def stop_recording(self):
        """End a recording; what has samples is the log."""
        if self._recorder is not None and self._recorder.samples:
            self.log = self._recorder.log()
        self._recorder = None

    def recorded(self):
        """Return the log of what is being recorded, or of what was; None without one."""
        if self._recorder is not None and self._recorder.samples:
            return self._recorder.log()
        return self.log

    def replay(self, log):
        """Play a log, while the scene stands still; None ends it."""
        if log is None:
            self._end_replay()
            return
        replay, traces = Replay(log, self.speed, self.clock()), Traces(log.T, self.watched)
        if self.source.kind == "board":
            self.pause()
        self._live = self._live or (self.traces, self._last)
        self._replay, self.traces = replay, traces

    def advance(self, wanted):
        """Go on to the clock, with a hand that means to be at a place [m]; return rows as a Frame has them, or None."""
        now = self.clock()
        if self._replay is not None:
            samples = self._replay.take(now)
            if samples is None and self._replay.done:
                self._end_replay()
        else:
            samples = self._lead(self.pace.due(now), wanted) if self.running else None
        if samples is None or not len(samples["t"]):
            return None
        self._last = {name: float(column[-1]) for name, column in samples.items()}
        return self.traces.add(samples, None if self._touching is None else self._touching(samples, self._parameters))

    @property
    def _parameters(self):
        return self._replay.parameters if self._replay is not None else named_values(self.source.program)

    def values(self, wanted=None):
        """Values that a picture is drawn from: the last sample, the parameters, and where the hand is wanted now [m]."""
        led = wanted is not None and self.source.kind == "simulated" and self.held and not self.replaying
        pointer = {"intent": wanted} if led else {}
        return {"T": self.source.paddle.T, **self._parameters, **self._last, "x": self.place, **pointer}

    def noticed(self):
        """Return the flags of a Telemetry that were raised within the last second: saturated, gap, overrun."""
        return [name for name, when in self._noticed.items() if self.clock() - when < RECENT]

    def _notice(self, samples):
        limit = getattr(self.source.paddle, "force_max", None)
        raised = {name: samples[name].any() for name in FLAGS if name in samples}
        if limit is not None:
            F = samples["F"]
            raised["saturated"] = F.max() >= limit or F.min() <= -limit
        self.missed = self.missed or bool(np.any(np.greater(samples.get("unlocated", 0.0), 0.0)))
        self._noticed |= {name: self.clock() for name, there in raised.items() if there}

    def _lead(self, ticks, wanted):
        if not ticks:
            return None
        began, seconds = self.clock(), ticks * self.source.paddle.T
        way = (wanted - self._at) * -math.expm1(-seconds / self.speed / FOLLOWS)
        to = self._at + min(max(way, -FASTEST * seconds), FASTEST * seconds)
        samples = self.source.advance(np.linspace(self._at, to, ticks + 1))
        self._at = to
        self.pace.spent(ticks, self.clock() - began)
        if samples is not None:
            self._notice(samples)
        if samples is not None and self._recorder is not None:
            self._recorder.add(samples)
            if self._recorder.full:
                self.stop_recording()
        if self.source.fault is not None or not self.source.begun:
            self.pause()
        return samples

    def _end_replay(self):
        if self._replay is not None:
            (self.traces, self._last), self._replay, self._live = self._live, None, None
            self.wake()
