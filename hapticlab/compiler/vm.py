"""The firmware's virtual machine built for this computer: the code of a board, at the speed of a PC.

Built on first use by the system's C compiler or by ziglang's (PyPI), and kept in the user's cache.
"""

import ctypes
import functools
import hashlib
import os
import platform
import shutil
import subprocess
import sys
import tempfile
from importlib.util import find_spec
from pathlib import Path

import numpy as np

from ..errors import EngineMissingError, ProgramError
from .bytecode import RESULTS, encode, layout

SOURCES = ("core/vm.c", "core/verify.c", "generated/elementary.c", "boards/host/run.c")
#: contraction off: a fused multiply-add rounds once where a board rounds twice
FLAGS = ("-O2", "-std=c99", "-ffp-contract=off")


class Vm:
    """Run a float32 program on the virtual machine: the contract is :meth:`hapticlab.compiler.engine.Engine.run`.

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
        self._library = load_library(word_bits)
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
            raise ProgramError(f"{self.program.name}: the virtual machine refuses it: {meaning(verified)}")
        self.faults = tuple(meaning(f) if f else None for f in faults)
        return outputs, carried


def meaning(number):
    """Return what a result of the machine means, in words."""
    return next((f"{name}: {text}" for name, (n, text) in RESULTS.items() if n == number), f"result {number}")


def firmware_folder():
    """Return where the C sources are: inside an installed package, or beside it in a checkout."""
    package = Path(__file__).resolve().parents[1]
    for folder in (package / "firmware", package.parent / "firmware"):
        if all((folder / s).is_file() for s in SOURCES):
            return folder
    raise EngineMissingError("the C sources of the virtual machine are not installed; reinstall hapticlab")


def c_compiler():
    """Return the command of a C compiler of this machine.

    Raises
    ------
    EngineMissingError
        If there is neither a system compiler nor ziglang.
    """
    for name in ("cc", "gcc", "clang"):
        if shutil.which(name):
            return [shutil.which(name)]
    if find_spec("ziglang"):
        return [sys.executable, "-m", "ziglang", "cc"]
    raise EngineMissingError(
        'engine "vm" needs a C compiler and found no cc, gcc, clang or ziglang; '
        'do: pip install ziglang, or use engine="interpreter"'
    )


def build_command(compiler, word_bits, target, *flags, sources=SOURCES):
    """Return the command that compiles sources of the firmware folder into target."""
    folder = firmware_folder()
    includes = [f"-I{folder / name}" for name in ("core", "generated", "boards/host")]
    math = [] if os.name == "nt" else ["-lm"]
    files = [str(folder / s) for s in sources]
    return [*compiler, *FLAGS, *flags, f"-DHL_WORD_BITS={word_bits}", *includes, *files, "-o", str(target), *math]


@functools.cache
def load_library(word_bits, *flags):
    """Return the machine as a shared library, built now if the cache has none of these sources and flags."""
    library = ctypes.CDLL(str(_built_library(word_bits, flags)))
    pointer, i64 = ctypes.c_void_p, ctypes.c_int64
    program = [ctypes.c_char_p, ctypes.c_uint32, pointer, ctypes.c_uint16]
    library.hl_host_verify.argtypes = program
    library.hl_host_run.argtypes = [*program, pointer, i64, i64, i64, ctypes.c_int, *[pointer] * 5]
    return library


def _built_library(word_bits, flags):
    folder = firmware_folder()
    flags = ("-shared", *(() if os.name == "nt" else ("-fPIC",)), *flags)
    headers = sorted(p for part in ("core", "generated", "boards/host") for p in (folder / part).glob("*.h"))
    text = b"".join(p.read_bytes() for p in (*headers, *(folder / s for s in SOURCES)))
    text += repr((FLAGS, flags, word_bits, sys.platform, sys.maxsize, platform.machine())).encode()
    suffix = {"win32": ".dll", "darwin": ".dylib"}.get(sys.platform, ".so")
    path = _cache_folder() / f"vm{word_bits}-{hashlib.sha256(text).hexdigest()[:20]}{suffix}"
    if not path.exists():
        _make_folder(path.parent)
        # built aside and renamed: another process sees the whole library or none
        with tempfile.TemporaryDirectory(dir=path.parent) as aside:
            target = Path(aside, path.name)
            command = build_command(c_compiler(), word_bits, target, *flags)
            done = subprocess.run(command, capture_output=True, text=True, check=False)
            if done.returncode:
                raise EngineMissingError(f"the virtual machine did not compile: {' '.join(command)}\n{done.stderr}")
            _put(target, path)
    return path


def _make_folder(folder):
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise EngineMissingError(
            f'engine "vm" keeps its library in {folder}, which is not to be written ({error.strerror}); '
            'set XDG_CACHE_HOME to a folder of yours, or use engine="interpreter"'
        ) from error


def _put(target, path):
    try:
        os.replace(target, path)
    except PermissionError:  # Windows: another process has put it there and opened it
        if not path.exists():
            raise


def _cache_folder():
    if os.name == "nt":
        base = os.environ.get("LOCALAPPDATA") or Path.home() / "AppData/Local"
    elif sys.platform == "darwin":
        base = Path.home() / "Library/Caches"
    else:
        base = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(base) / "hapticlab"
