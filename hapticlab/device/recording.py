"""Samples as they come from a board, and the Telemetry they make."""

import struct

import numpy as np

from ..records import Telemetry
from .messages import FAULTS, SAMPLE_FLAGS

_NUMPY = {"f32": "<f4", "bool": "<i4", "i32": "<i4"}


class Recording:
    """What one run said: samples are kept as bytes, and become arrays once, at the end.

    Parameters
    ----------
    program : Program
        Whose outputs the samples carry.
    every : int
        Ticks from one sample to the next.
    """

    def __init__(self, program, every):
        self.program, self.every = program, every
        self.fault, self.last_tick, self.changes = None, -1, []
        self._rows = []
        self._row = np.dtype([("tick", "<u4"), ("flags", "u1"), ("x", "<f4"), ("v", "<f4"), ("F", "<f4")] + [
            (f"channel.{c.name}", _NUMPY[c.type]) for c in program.outputs[1:]])  # fmt: skip

    def add(self, frame):
        """Take a SAMPLE or FAULTED frame."""
        if frame.message == "FAULTED":
            self.fault = frame.fields
        elif len(frame.payload) == self._row.itemsize:
            (tick,) = struct.unpack_from("<I", frame.payload)
            if tick > self.last_tick or self.last_tick < 0:  # a repeat on the wire is no new sample
                self._rows.append(frame.payload)
                self.last_tick = tick

    def telemetry(self, *, ticks, delay, paddle):
        """Return the Telemetry of the first so many ticks; None takes them all."""
        T, program = self.program.T, self.program
        rows = np.frombuffer(b"".join(self._rows), self._row)
        rows = rows if ticks is None else rows[rows["tick"] < ticks]
        tick = rows["tick"].astype(np.int64)
        missing = np.diff(tick, prepend=tick[:1] - self.every) > self.every
        flags = {name.lower(): rows["flags"] & bit > 0 for name, bit in SAMPLE_FLAGS.items()}
        columns = {c.name: rows[f"channel.{c.name}"].astype(float) for c in program.outputs[1:]}
        return Telemetry(
            t=tick * T, x=rows["x"].astype(float), v=rows["v"].astype(float), F=rows["F"].astype(float),
            T=T * self.every, delay=delay, channels=columns, units={c.name: c.unit for c in program.outputs[1:]},
            paddle=paddle, scene=program.name,
            parameters={c.name: a for c, a in zip(program.parameters, program.values, strict=True)},
            fault=fault_words(self.fault, T), saturated=flags["saturated"], gap=missing, overrun=flags["overrun"],
            changes=tuple(self.changes),
        )  # fmt: skip


def fault_words(fault, T=None):
    """Return a fault's name, time, cause and cure in words, or None for no fault."""
    if fault is None:
        return None
    name, cause, cure = next(((n, c, h) for n, (k, c, h) in FAULTS.items() if k == fault["fault"]), ("UNKNOWN", "", ""))
    when = f"tick {fault['tick']}" + (f" (t = {fault['tick'] * T:g} s)" if T else "")
    return f"{when}: {name}: {cause}; the motor is off from there on. {cure[:1].upper()}{cure[1:]}."
