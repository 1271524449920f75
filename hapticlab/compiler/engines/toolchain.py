"""How the firmware's C becomes a library of a computer: sources, compilers, targets.

Nothing but the standard library, and nothing of the package: hatch_build.py loads this file by its path, in an
environment where the package is not installed.
"""

import hashlib
import platform
import shutil
import subprocess
import sys
import sysconfig
from importlib.util import find_spec
from pathlib import Path

#: contraction off: a fused multiply-add rounds once where a board rounds twice
FLAGS = ("-O2", "-std=c99", "-ffp-contract=off")
#: programs of their own, each with a main, are in boards/host/tools
SOURCE_FOLDERS = ("core", "generated", "boards/host")
INCLUDE_FOLDERS = ("core", "generated", "boards", "boards/host")
#: registers of a program are numbered in words of 8 bits as on a small board, or 16: one library for each
WORD_BITS = (8, 16)
#: what is shipped: our name -> zig's, with the oldest C library or system that it asks for
TARGETS = {
    "linux-x86_64": "x86_64-linux-gnu.2.17",
    "linux-aarch64": "aarch64-linux-gnu.2.17",
    "windows-x86_64": "x86_64-windows-gnu",
    "windows-aarch64": "aarch64-windows-gnu",
    "macos-x86_64": "x86_64-macos.11.0-none",
    "macos-aarch64": "aarch64-macos.11.0-none",
    "emscripten-wasm32-32": "wasm32-wasi",  # Python in a browser: Pyodide
}
#: how objects of WebAssembly become what Pyodide opens as a library; what it names and lacks, Pyodide has
SIDE_MODULE = ("-shared", "--experimental-pic", "--import-undefined", "--export=hl_sources")


class CompileError(Exception):
    """No compiler was found, or each that was found refused the sources; the message is what they said."""


def running_target():
    """Return the name of the computer that runs this Python, a key of TARGETS or another name of the same form."""
    system = {"darwin": "macos", "win32": "windows"}.get(sys.platform, sys.platform)
    # Windows on ARM runs Pythons of x86-64 too: there the interpreter counts, not the machine
    machine = sysconfig.get_platform().rpartition("-")[2] if system == "windows" else platform.machine()
    machine = {"amd64": "x86_64", "arm64": "aarch64"}.get(machine.lower(), machine.lower())
    name = f"{system}-{machine}" + ("" if sys.maxsize > 2**32 else "-32")
    return name + ("-musl" if system == "linux" and platform.libc_ver()[0] != "glibc" else "")


def library_name(target, word_bits):
    """Return the file name of a target's library."""
    system = target.partition("-")[0]
    prefix, suffix = {"windows": ("", ".dll"), "macos": ("lib", ".dylib")}.get(system, ("lib", ".so"))
    return f"{prefix}hapticlab_core{word_bits}{suffix}"


def sources(firmware):
    """Return the C files of the library, relative to the firmware folder and sorted."""
    return [p.relative_to(firmware).as_posix() for f in SOURCE_FOLDERS for p in sorted((firmware / f).glob("*.c"))]


def digest(firmware, word_bits, *flags):
    """Return 64 hexadecimal digits that change with any source, header or flag of the library."""
    headers = [p for f in INCLUDE_FOLDERS for p in sorted((firmware / f).glob("*.h"))]
    hashed = hashlib.sha256(repr((FLAGS, flags, word_bits)).encode())
    for path in (*headers, *(firmware / s for s in sources(firmware))):
        content = path.read_bytes()
        hashed.update(f"{path.relative_to(firmware).as_posix()} {len(content)}\n".encode() + content)
    return hashed.hexdigest()


def stamp(firmware, word_bits, *flags):
    """Return the bytes that a library made of just these sources and flags contains."""
    return b"hapticlab sources " + digest(firmware, word_bits, *flags).encode()


def system_compiler():
    """Return the command of this computer's own C compiler, or None."""
    if sys.platform == "darwin":  # without Apple's tools, its cc is there but opens a dialogue instead of compiling
        selected = shutil.which("xcode-select")
        if not selected or subprocess.run([selected, "-p"], capture_output=True, check=False).returncode:
            return None
    found = next(filter(None, map(shutil.which, ("cc", "gcc", "clang"))), None)
    return found and [found]


def compilers(target):
    """Return the commands that compile for a target, the one to try first in front."""
    commands = []
    native = system_compiler() if target == running_target() else None
    if native:
        commands.append([*native, *(["-mmacosx-version-min=11.0"] if target.startswith("macos") else [])])
    if find_spec("ziglang"):
        # never this very processor's instructions: homes and wheels are shared with others
        chosen = ["-target", TARGETS[target]] if target in TARGETS else ["-mcpu=baseline"]
        commands.append([sys.executable, "-m", "ziglang", "cc", *chosen])
    return commands


def build_command(compiler, firmware, word_bits, output, *flags, files):
    """Return the command that compiles files (relative to the firmware folder, or absolute) into output."""
    includes = [f"-I{firmware / name}" for name in INCLUDE_FOLDERS]
    paths = [str(firmware / f) for f in files]
    math = [] if str(output).endswith((".dll", ".exe")) else ["-lm"]
    return [*compiler, *FLAGS, *flags, f"-DHL_WORD_BITS={word_bits}", *includes, *paths, "-o", str(output), *math]


def wasm_commands(compiler, firmware, word_bits, output, *flags, files, linking):
    """Return the commands that make a WebAssembly module: ziglang's compiler takes one file at a time, its linker all."""
    includes = [f"-I{firmware / name}" for name in INCLUDE_FOLDERS]
    fixed = [*compiler, *FLAGS, *flags, f"-DHL_WORD_BITS={word_bits}", *includes]
    objects = [f"{k}_{word_bits}.o" for k in range(len(files))]
    compiling = [[*fixed, "-c", str(firmware / f), "-o", made] for f, made in zip(files, objects, strict=True)]
    linker = [*compiler[: compiler.index("cc")], "wasm-ld"]
    return [*compiling, [*linker, *linking, "-s", "--export-dynamic", *objects, "-o", str(output)]]


def build_library(firmware, folder, target, word_bits, *flags, tried=None):
    """Compile the library of a target into a folder, stamped with its sources, and return its path.

    The compilers tried are those of :func:`compilers`, or the commands given.

    Raises
    ------
    CompileError
        If no compiler for the target was found, or none of them accepts the sources.
    """
    said, firmware = [], Path(firmware).resolve()
    name = library_name(target, word_bits)
    mark = Path(folder, f"stamp{word_bits}.c").resolve()
    text = stamp(firmware, word_bits, *flags).decode()
    mark.write_text(f'extern const char hl_sources[];\nconst char hl_sources[] = "{text}";\n', encoding="ascii")
    position = () if target.startswith("windows") else ("-fPIC",)
    for compiler in compilers(target) if tried is None else tried:
        given = (compiler, firmware, word_bits, name, *position, *flags)
        files = (*sources(firmware), mark)
        if target.startswith("emscripten"):
            commands = wasm_commands(*given, files=files, linking=SIDE_MODULE)
        else:
            commands = [build_command(*given, "-shared", "-s", files=files)]
        failed = run_in_turn(commands, folder)
        if failed is None:
            return Path(folder, name)
        said.append(failed)
    raise CompileError("\n".join(said) or f"no C compiler for {target}: found no cc, gcc, clang or ziglang")


def run_in_turn(commands, folder):
    """Run the commands in a folder; return the one that failed with what it said, or None."""
    for command in commands:
        # in the folder: a library for macOS remembers the path it was linked as, which is to be the same everywhere
        done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=folder)
        if done.returncode:
            return f"{' '.join(command)}\n{done.stderr}"
    return None
