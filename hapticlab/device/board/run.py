"""A run on a board: the program that was loaded, the samples as they come, and the Telemetry they make."""

import math
import struct
import zlib
from collections import deque
from dataclasses import dataclass, replace

import numpy as np

from ...base.missed_events import warn_of_missed
from ...base.telemetry import Telemetry
from ...compiler.boards.board_records import BOARDS
from ...compiler.engines.bytecode import encode
from ...compiler.ir.program import Program
from ...errors import PaddleError
from ..link.messages import FAULTS, SAMPLE_FLAGS, row_of
from ..link.port_faults import absence_words
from ..live_parameters import named_values
from .upload import upload

#: part of the link that samples may take; state and requests need the rest
SAMPLES_SHARE = 0.9
#: bytes of a sample beside its numbers: tick, flags, frame
SAMPLE_OVERHEAD = 11
#: of a number in a sample, by its type in the program
ROW_TYPES = {"f32": "<f4", "bool": "<i4", "i32": "<i4"}


@dataclass(frozen=True)
class Loaded:
    """A program on the board, with the values that its parameters have there; START names it by its CRC-32."""

    program: Program
    crc: int

    def with_values(self, numbers):
        """The same program with other values of some parameters, {name: number}."""
        known = named_values(self.program) | numbers
        return Loaded(replace(self.program, values=tuple(known.values())), self.crc)


def load(exchange, program, word_bytes):
    """Put a program on the board, its parameters still without value; nothing runs until the board has verified it."""
    data = encode(program, word_bits=8 * word_bytes)
    upload(exchange, "PROGRAM", data)
    return Loaded(program, zlib.crc32(data[:-4]))


class Run:
    """One run and what it said: samples are kept as bytes, and become arrays once, at the end.

    Parameters
    ----------
    loaded : Loaded
        What runs; the samples carry the outputs of its program.
    every : int
        Ticks from one sample to the next.
    absent : callable
        Gives for how long this program did not run [s]; asked when the board reports a fault.
    sensor_delay : float
        Lag of the board's sensor [s].
    """

    def __init__(self, loaded, every, absent=lambda: 0.0, sensor_delay=0.0):
        self._absent, self.sensor_delay = absent, sensor_delay
        self.loaded, self.program, self.every = loaded, loaded.program, every
        self.fault, self.last_tick, self.changes, self.begun = None, -1, [], False
        self._rows, self._taken = deque(), -every
        self._row = np.dtype([("tick", "<u4"), ("flags", "u1"), ("x", "<f4"), ("v", "<f4"), ("F", "<f4")] + [
            (f"channel.{c.name}", ROW_TYPES[c.type]) for c in self.program.outputs[1:]])  # fmt: skip

    def begin(self):
        """Take samples from here on: those that are still under way from an earlier run came before."""
        self.begun = True

    def add(self, frame):
        """Take a SAMPLE or FAULTED frame."""
        if frame.message == "FAULTED":
            self.fault = frame.fields | {"absent": self._absent()}
        elif len(frame.payload) == self._row.itemsize:
            tick, flags = struct.unpack_from("<IB", frame.payload)
            self.begun = self.begun or bool(flags & SAMPLE_FLAGS["FIRST"])
            if not self.begun:
                return
            if tick > self.last_tick or self.last_tick < 0:  # a repeat on the wire is no new sample
                self._rows.append(frame.payload)
                self.last_tick = tick

    def take(self):
        """Take the samples since the last look, a dict of columns; those that are left make the telemetry."""
        rows = self._table([self._rows.popleft() for _ in range(len(self._rows))])
        found = self._columns(rows, self._taken)
        self._taken = int(rows["tick"][-1]) if len(rows) else self._taken
        return found

    def telemetry(self, *, ticks, delay, paddle):
        """Return the Telemetry of the first so many ticks; None takes them all."""
        rows = self._table(self._rows)
        rows = rows if ticks is None else rows[rows["tick"] < ticks]
        columns = self._columns(rows, self._taken)
        return warn_of_missed(self.as_telemetry(columns, delay=delay, paddle=paddle, changes=self.changes))

    def as_telemetry(self, columns, *, delay, paddle, changes=(), values=None):
        """Return columns of :meth:`take`, put together, as Telemetry; values are the parameters', the program's if None."""
        program = self.program
        values = dict(zip((c.name for c in program.parameters), program.values, strict=True)) if values is None else values
        own = {name: columns[name] for name in ("t", "x", "v", "F", "saturated", "gap", "overrun")}
        return Telemetry(
            **own, T=program.T * self.every, delay=delay, channels={c.name: columns[c.name] for c in program.outputs[1:]},
            units=program.units, paddle=paddle, scene=program.name, parameters=values,
            fault=fault_words(self.fault, program.T), every=self.every, changes=tuple(changes),
            sensor_delay=self.sensor_delay,
        )  # fmt: skip

    def _table(self, rows):
        return np.frombuffer(b"".join(rows), self._row)

    def _columns(self, rows, before):
        """Return rows as columns by name; before is the tick of the row before the first."""
        tick = rows["tick"].astype(np.int64)
        flags = {name.lower(): rows["flags"] & bit > 0 for name, bit in SAMPLE_FLAGS.items()}
        found = {name: rows[name].astype(float) for name in ("x", "v", "F")}
        found |= {c.name: rows[f"channel.{c.name}"].astype(float) for c in self.program.outputs[1:]}
        missing = np.diff(tick, prepend=before) > self.every
        return {"t": tick * self.program.T, **found, "saturated": flags["saturated"], "gap": missing, "overrun": flags["overrun"]}


def decimation(program, port, every=None, board=None):
    """Return the ticks from one sample to the next: as asked, or as few as the link to a board of this name carries.

    Raises
    ------
    PaddleError
        If it carries fewer than asked.
    """
    channels = 2 + len(program.outputs)
    own = BOARDS[board].link if board in BOARDS else None
    rate = own or getattr(port, "bytes_per_second", port.baudrate / 10)
    least = max(1, math.ceil((SAMPLE_OVERHEAD + 4 * channels) / program.T / (SAMPLES_SHARE * rate) - 1e-9))
    if every is None:
        return least
    if every < least or every != int(every) or every > 65535:
        raise PaddleError(
            f"every = {every}; at T = {program.T:g} s with {channels} numbers per sample, this link transmits one sample in "
            f"{least}. Give every={least} or more, watch fewer channels, or leave out every=."
        )
    return int(every)


def fault_words(fault, T=None):
    """Return a fault's name, time, cause and cure in words, or None for no fault."""
    if fault is None:
        return None
    name, cause, cure = row_of(FAULTS, fault["fault"]) or ("UNKNOWN", "", "")
    when = f"tick {fault['tick']}" + (f" (t = {fault['tick'] * T:g} s)" if T else "")
    if name == "HOST_SILENT" and fault.get("absent"):
        cure = f"{absence_words(fault['absent'])}; start the scene again"
    return f"{when}: {name}: {cause}; the motor is off from then on. {cure[:1].upper()}{cure[1:]}."


class Timing:
    """What a board measures of its own steps and periods in one run [s].

    Parameters
    ----------
    state : dict
        Fields of a STATE message.
    clock_hz : float
        Of the board's clock.
    T : float
        [s]
    """

    def __init__(self, state, clock_hz, T):
        self.T = T
        self.period_min, self.period_max = (state[name] / clock_hz for name in ("period_min", "period_max"))
        self.worst, self.mean = state["step_worst"] / clock_hz, state["step_mean"] / clock_hz
        self.overruns, self.lost, self.damaged = state["overruns"], state["lost"], state["damaged"]

    @property
    def load(self):
        """Share of the period that a step takes, on average."""
        return self.mean / self.T

    def __str__(self):
        return (
            f"step {self.mean * 1e6:.0f} us, worst {self.worst * 1e6:.0f} us of T = {self.T * 1e6:.0f} us "
            f"({100 * self.load:.0f} %); period {self.period_min * 1e6:.1f} to {self.period_max * 1e6:.1f} us; "
            f"{self.overruns} overruns, {self.lost} samples lost"
        )

    __repr__ = __str__
