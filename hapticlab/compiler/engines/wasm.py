"""The engine wasm: a program as a WebAssembly module, run by wasmtime or, in a browser, by the module that Python is."""

import atexit
import ctypes
import functools
import math
import os
import tempfile
import weakref

import numpy as np

from ...base.in_notebook import is_in_browser
from ...errors import EngineMissingError, ProgramError
from ..ir.cache import Shared
from .wasm_emit import at_once, emit
from .wasm_lanes import ONE

#: numbers of inputs and outputs that wasmtime's memory holds at a time: they stay in a processor's cache
ROOM = 32_768
RESERVED = 2**24  #: bytes of addresses for a memory, and for what it grows by
PAGE = 65_536  #: bytes, Core Specification 2.0, 4.2.8


class Wasm:
    """Run a program as WebAssembly. See :meth:`hapticlab.compiler.engines.engine.Engine.run` for the contract."""

    name = "wasm"

    def __init__(self, program):
        self.program = program.verify()
        self._hosts = Shared(math.inf)
        if is_in_browser():
            self.bound = self._host(ONE).bound

    def run(self, ticks, inputs, parameters, states=None, every=1):
        lanes = parameters.shape[1]
        width = ONE if lanes == 1 else self._at_once
        more = -lanes % width.count
        outputs = np.empty((ticks // every, len(self.program.outputs), lanes + more))
        carried = np.empty((len(self.program.states), lanes + more))
        if states is not None:
            carried[:, :lanes] = states
            carried[:, lanes:] = carried[:, lanes - 1 : lanes]
        parameters = np.pad(parameters, ((0, 0), (0, more)), "edge")
        inputs, parameters = (np.ascontiguousarray(a, float) for a in (inputs, parameters))
        self._host(width).run(ticks, every, states is not None, inputs, parameters, carried, outputs)
        return outputs[..., :lanes], carried[:, :lanes]

    @functools.cached_property
    def _at_once(self):
        return at_once(self.program)

    def _host(self, width):
        kind = Library if is_in_browser() else Wasmtime
        return self._hosts.get(width.count, lambda: kind(self.program.name, emit(self.program, width)))


class Library:
    """A module as a library of Emscripten: it works on the arrays where they are."""

    def __init__(self, name, code):
        with tempfile.NamedTemporaryFile(suffix=".so", delete=False) as file:
            file.write(code)
        try:
            self._run = ctypes.CDLL(file.name).run
        except OSError as refused:
            raise ProgramError(f'{name}: WebAssembly refuses it: {refused}; use engine="interpreter"') from refused
        finally:
            os.remove(file.name)
        self._run.restype, self._run.argtypes = None, [ctypes.c_int32] * 4 + [ctypes.c_void_p] * 4

    def run(self, ticks, every, resumed, inputs, parameters, states, outputs):
        pointers = (a.ctypes.data for a in (inputs, parameters, states, outputs))
        self._run(ticks, every, 8 * parameters.shape[1], resumed, *pointers)

    def bound(self, *arrays):
        """A function that runs one tick of one lane on these arrays; it keeps them."""
        pointers, run = [a.ctypes.data for a in arrays], self._run

        def tick(_arrays=arrays):
            run(1, 1, 8, True, *pointers)

        return tick


class Wasmtime:
    """A module in wasmtime. Arrays are copied into its memory and out of it, some ticks at a time."""

    def __init__(self, name, code):
        wasmtime = open_wasmtime()
        try:
            self._module = wasmtime.Module(_engine(), code)
        except wasmtime.WasmtimeError as refused:
            raise ProgramError(f'{name}: wasmtime refuses it: {refused}; use engine="interpreter"') from refused
        weakref.finalize(self, self._module.close)  # closed by itself at exit, wasmtime would find its library gone
        self._idle = []  # each in use by one thread at a time

    def run(self, *given):
        try:
            place = self._idle.pop()
        except IndexError:
            place = _Instance(self._module)
        place.run(*given)
        self._idle.append(place)


class _Instance:
    """A module with a memory of its own."""

    def __init__(self, module):
        wasmtime = open_wasmtime()
        self._store = wasmtime.Store(_engine())
        weakref.finalize(self, self._store.close)
        self._memory = wasmtime.Memory(self._store, wasmtime.MemoryType(wasmtime.Limits(1, None)))
        self._run = wasmtime.Instance(self._store, module, [self._memory]).exports(self._store)["run"]

    def run(self, ticks, every, resumed, inputs, parameters, states, outputs):
        a_row, a_result, stride = inputs.shape[1], outputs[:1].size, 8 * parameters.shape[1]
        most = max(1, int(ROOM / max(1, a_row * every + a_result))) * every
        most = min(most, -(-ticks // every) * every)
        sizes = (parameters.size, states.size, most * a_row, most // every * a_result)
        fixed, carried, samples, results = self._arrays(sizes)
        addresses = [8 * sum(sizes[:k]) for k in (2, 0, 1, 3)]
        fixed[:], carried[:] = parameters.ravel(), states.ravel()
        for start in range(0, ticks, most):
            rows = inputs[start : start + most]
            kept = outputs[start // every : (start + len(rows)) // every]
            samples[: rows.size] = rows.ravel()
            self._run(self._store, len(rows), every, stride, int(resumed or start > 0), *addresses)
            kept.ravel()[:] = results[: kept.size]
        states.ravel()[:] = carried

    def _arrays(self, sizes):
        """Return views of the memory, one after another, of so many float64."""
        size = 8 * sum(sizes)
        missing = size - self._memory.data_len(self._store)
        if missing > 0:
            self._grow(missing, size)
        base = ctypes.addressof(self._memory.data_ptr(self._store).contents)
        return np.split(np.frombuffer((ctypes.c_char * size).from_address(base)), np.cumsum(sizes[:-1]))

    def _grow(self, missing, size):
        try:
            self._memory.grow(self._store, -(-missing // PAGE))
        except open_wasmtime().WasmtimeError as refused:
            raise ProgramError(
                f"a run needs {size / 2**30:.3g} GiB; the memory of WebAssembly has at most 4 GiB, if the computer has as much "
                f'({refused}): run fewer lanes, or keep outputs more often, or use engine="interpreter"'
            ) from refused


def open_wasm():
    """Raise EngineMissingError, which says what to install, where WebAssembly does not run."""
    if not is_in_browser():
        open_wasmtime()


def open_wasmtime():
    """Return wasmtime; EngineMissingError says what to install."""
    try:
        import wasmtime
    except (ImportError, OSError, RuntimeError) as missing:  # the last two: installed, but there is no library for this system
        raise EngineMissingError(
            'engine = "wasm" needs wasmtime, which does not import here; do: pip install wasmtime, or use engine="interpreter"'
        ) from missing
    return wasmtime


@functools.cache
def _engine():
    """Return what compiles modules, in the thread that asks for it: a process forked from this one has no other threads.

    By itself it would reserve 4 GB of addresses for every memory, which a sandbox of graded work does not give. Without them a
    tick takes as long (measured: within 5 %).
    """
    wasmtime = open_wasmtime()
    config = wasmtime.Config()
    config.parallel_compilation = False
    config.memory_reservation = config.memory_reservation_for_growth = RESERVED
    config.memory_guard_size = PAGE
    engine = wasmtime.Engine(config)
    atexit.register(engine.close)
    return engine
