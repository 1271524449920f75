"""The firmware as a library of this computer: the code of a board, at the speed of a PC.

It comes with the installed package, made for this computer, or for six kinds of it and for Pyodide. In a checkout, and
elsewhere, it is built on first use by the system's C compiler or by ziglang's (PyPI), and kept in the user's cache.
"""

import contextlib
import ctypes
import functools
import os
import sys
import tempfile
from pathlib import Path

from ...errors import EngineMissingError
from . import toolchain

PACKAGE = Path(__file__).resolve().parents[2]
INSTEAD = 'engine="interpreter" runs without it, and hl.SimulatedPaddle replaces sim://'
CURE = f"install a C compiler, or do: pip install ziglang; {INSTEAD}"
if sys.platform == "emscripten":  # Pyodide, in a browser: nothing can be built there
    CURE = f"use the wheel for every target, which has it ready; {INSTEAD}"


@functools.cache
def load_library(word_bits, *flags):
    """Return the library of the firmware and of the host board for registers numbered in words of 8 or 16 bits.

    With flags it is always one built for them. One object serves every caller, so that who calls a function of it
    declares that function's types.

    Raises
    ------
    EngineMissingError
        If there is none and it cannot be built; the message says what to install.
    """
    shipped = None if flags else prebuilt(word_bits)
    if shipped:
        with contextlib.suppress(OSError):  # this system cannot load it: perhaps it can load what it builds
            return ctypes.CDLL(str(shipped))
    return ctypes.CDLL(str(built(word_bits, *flags)))


def firmware_folder():
    """The folder of the C sources: inside an installed package, or beside it in a checkout."""
    for folder in (PACKAGE / "firmware", PACKAGE.parent / "firmware"):
        if (folder / "core" / "vm.c").is_file():
            return folder
    raise EngineMissingError("the C sources of the virtual machine are not installed; reinstall hapticlab")


def prebuilt(word_bits):
    """Return the library that came with the package, or None if it is missing or of other sources than are here."""
    target = toolchain.running_target()
    path = PACKAGE / "prebuilt" / target / toolchain.library_name(target, word_bits)
    stamp = toolchain.stamp(firmware_folder(), word_bits)
    return path if path.is_file() and stamp in path.read_bytes() else None


def built(word_bits, *flags):
    """Return the library in the user's cache, built now if it has none of these sources and flags."""
    firmware, target = firmware_folder(), toolchain.running_target()
    name = toolchain.library_name(target, word_bits)
    path = cache_folder() / f"{target}-{toolchain.digest(firmware, word_bits, *flags)[:20]}-{name}"
    if not path.exists():
        _make_folder(path.parent)
        # built aside and renamed: another process sees the whole library or none
        with tempfile.TemporaryDirectory(dir=path.parent) as aside:
            try:
                made = toolchain.build_library(firmware, aside, target, word_bits, *flags)
            except toolchain.CompileError as error:
                raise EngineMissingError(f"the firmware did not compile for this computer; {CURE}\n{error}") from error
            _put(made, path)
    return path


def _make_folder(folder):
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise EngineMissingError(
            f"the firmware's library is kept in {folder}, which cannot be written ({error.strerror}). Set XDG_CACHE_HOME to "
            f"a folder of your own; {INSTEAD}"
        ) from error


def _put(made, path):
    try:
        os.replace(made, path)
    except PermissionError:  # Windows: another process has put it there and opened it
        if not path.exists():
            raise


def cache_folder():
    """Return the folder in which this system keeps what can be made again; it need not be there yet."""
    if os.name == "nt":
        base = os.environ.get("LOCALAPPDATA") or Path.home() / "AppData/Local"
    elif sys.platform == "darwin":
        base = Path.home() / "Library/Caches"
    else:
        base = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(base) / "hapticlab"
