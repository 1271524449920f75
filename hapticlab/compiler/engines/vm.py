"""The firmware's virtual machine on this computer: the code of a board, at the speed of a PC."""

import ctypes
import functools

import numpy as np

from ...errors import ProgramError
from .bytecode import RESULTS, encode, layout
from .firmware_library import load_library


class Vm:
    """Run a float32 program on the virtual machine: the contract is :meth:`hapticlab.compiler.engines.engine.Engine.run`.

    Where the other engines carry a nan or an infinity on, the machine stops as a board does: from the sample whose
    output or next state is not finite, the outputs of that lane and its states are nan. ``faults`` holds what the
    machine said about each lane of the last run.

    Parameters
    ----------
    program : Program
    word_bits : {16, 8}
        8 runs it as a small board does, with at most 256 registers.
    """

    name = "vm"

    def __init__(self, program, word_bits=16):
        self.bytes = encode(program, word_bits=word_bits)
        self.program = program
        self.faults = ()
        self._library = machine(word_bits)
        self._registers = layout(self.bytes).size["registers"]

    def run(self, ticks, inputs, parameters, states=None, every=1):
        lanes = parameters.shape[1]
        outputs = np.empty((ticks // every, len(self.program.outputs), lanes))
        carried = np.empty((len(self.program.states), lanes))
        if states is not None:
            carried[:] = states
        registers = np.zeros(max(1, self._registers), np.int32)
        scratch = np.zeros(max(1, len(self.program.outputs)), np.int32)
        faults = np.zeros(lanes, np.int32)
        inputs, parameters = (np.ascontiguousarray(a, float) for a in (inputs, parameters))
        arrays = (a.ctypes.data for a in (inputs, parameters, carried, outputs, faults))
        memory = registers.ctypes.data, self._registers, scratch.ctypes.data
        verified = self._library.hl_host_run(
            self.bytes, len(self.bytes), *memory, ticks, every, lanes, states is not None, *arrays
        )
        if verified:
            raise ProgramError(f"{self.program.name}: the virtual machine rejects it: {meaning(verified)}")
        self.faults = tuple(meaning(f) if f else None for f in faults)
        return outputs, carried


def meaning(number):
    """The meaning of a result of the machine, in words."""
    return next((f"{name}: {text}" for name, (n, text) in RESULTS.items() if n == number), f"result {number}")


def open_vm():
    """Raise EngineMissingError, which says what to install, where there is no library of the machine."""
    machine(16)


@functools.cache
def machine(word_bits, *flags):
    """Return the library that holds the machine, with the types of the two functions called here."""
    library = load_library(word_bits, *flags)
    pointer, i64 = ctypes.c_void_p, ctypes.c_int64
    program = [ctypes.c_char_p, ctypes.c_uint32, pointer, ctypes.c_uint16]
    library.hl_host_verify.argtypes = program
    library.hl_host_run.argtypes = [*program, pointer, i64, i64, i64, ctypes.c_int, *[pointer] * 5]
    return library
