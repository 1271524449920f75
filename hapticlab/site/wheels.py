"""Installed packages as wheels of Python alone, which any Python installs, a browser's too.

A package that is installed has all that its wheel had, and RECORD lists it: so a site is made of what is here, without a
network, and of the very versions that were tested here.
"""

import base64
import hashlib
import itertools
import os
import subprocess
import sys
import tempfile
import zipfile
from importlib.metadata import distribution
from importlib.util import find_spec
from pathlib import Path, PurePosixPath

from ..compiler.engines import toolchain
from ..compiler.engines.firmware_library import PACKAGE, firmware_folder
from ..errors import CourseError

BROWSER = "emscripten-wasm32-32"
#: the libraries of the firmware, in a wheel of hapticlab
OWN = "hapticlab/prebuilt/"
#: what an installer writes beside a wheel's own files
NOT_OF_A_WHEEL = {"INSTALLER", "REQUESTED", "RECORD", "WHEEL", "direct_url.json"}
MACHINE_CODE = {".so", ".pyd", ".dylib", ".dll"}
WHEEL = "Wheel-Version: 1.0\nGenerator: hapticlab\nRoot-Is-Purelib: true\nTag: py3-none-any\n"
DATE = (2020, 2, 2, 0, 0, 0)  # the same files give the same wheel


def installed_wheel(name, folder):
    """Write an installed package into a folder as a wheel, and return its path.

    Machine code is left out where the same module is there in Python.

    Raises
    ------
    CourseError
        If the package is not installed by a wheel, or has modules in machine code alone.
    """
    return write_wheel(folder, installed_files(name))


def installed_files(name, data="\0"):
    """Return the files of an installed package's wheel, by their paths in it; machine code only below ``data``."""
    found = distribution(name)
    paths = [PurePosixPath(path) for path in found.files or () if _belongs(PurePosixPath(path))]
    modules = {_module(path) for path in paths if path.suffix == ".py"}
    code = [path for path in paths if path.suffix in MACHINE_CODE and not str(path).startswith(data)]
    alone = [path for path in code if _module(path) not in modules and "__mypyc" not in path.name]
    if not modules or alone:
        why = f"has machine code, such as {alone[0]}," if alone else "was not installed from a wheel"
        raise CourseError(f"{name} {why} so that no wheel for a browser can be made of it. Install it from PyPI by pip")
    return {str(path): Path(found.locate_file(path)).read_bytes() for path in sorted({*paths} - {*code})}


def _belongs(path):
    """Whether a file came in the wheel, and goes where Python finds it."""
    made = ".." in path.parts or "__pycache__" in path.parts or path.suffix == ".pth"
    return not (made or path.name in NOT_OF_A_WHEEL)


def _module(path):
    return path.with_name(path.name.partition(".")[0])


def hapticlab_wheel(folder, given=None):
    """Write hapticlab for a browser into a folder, with the firmware's core for it, and return the wheel's path.

    It is made of a wheel, if that is given, else of this very hapticlab: installed, or a checkout.
    """
    files = _own_files(given)
    if failed := _put_libraries(files, [BROWSER]):
        raise CourseError(
            "this hapticlab has no core of the firmware for a browser, which sim:// and lab 00 need, and it did not "
            f"compile: {failed[BROWSER]}. Do: pip install ziglang; or give a release of hapticlab by --wheel"
        )
    return write_wheel(folder, files)


def wheel_for(folder, targets, given=None):
    """Write hapticlab for some targets into a folder; return the wheel's path, and a sentence for each lacking library."""
    files = _own_files(given)
    if not any("/data/etc/" in path for path in files):  # pip puts Jupyter's setting outside the package
        info = next(path for path in files if path.endswith(".dist-info/METADATA")).partition(".dist-info")[0]
        files |= {f"{info}.data/data/{path}": content for path, content in _settings()}
    lacking = [
        f"{target}: the library of the firmware, which sim:// and the engine vm need; it did not compile. "
        "Do: pip install ziglang, and the same command again; or give a release of hapticlab by --wheel"
        for target in _put_libraries(files, targets)
    ]
    return write_wheel(folder, files), lacking


def _settings():
    """Yield Jupyter's setting of an installed hapticlab, by its path below the environment, and its content."""
    for path in distribution("hapticlab").files or ():
        if "etc" in path.parts and path.suffix == ".json":
            yield "/".join(path.parts[path.parts.index("etc") :]), Path(path.locate()).read_bytes()


def _own_files(given):
    """Return the files of hapticlab by their paths in a wheel: of a given wheel, or of this very hapticlab."""
    if given is None and (PACKAGE.parent / "pyproject.toml").is_file():
        with tempfile.TemporaryDirectory() as aside:
            return zipped_files(_built(PACKAGE.parent, aside))
    files = installed_files("hapticlab", OWN) if given is None else zipped_files(given)
    if "hapticlab/__init__.py" not in files:
        raise CourseError(f"{given} is not a wheel of hapticlab; give a file such as hapticlab-0.2.0-py3-none-any.whl")
    return files


def _put_libraries(files, targets):
    """Keep the firmware's libraries of some targets alone, compile those that are not there; return why, by target, if not."""
    for path in [path for path in files if path.startswith(OWN) and path.split("/")[2] not in targets]:
        del files[path]
    failed = {}
    for target, bits in itertools.product(targets, toolchain.WORD_BITS):
        path = f"{OWN}{target}/{toolchain.library_name(target, bits)}"
        if toolchain.stamp(firmware_folder(), bits) not in files.get(path, b""):
            try:
                files[path] = _library(target, bits)
            except toolchain.CompileError as problem:
                files.pop(path, None)
                failed[target] = problem
    return failed


def _library(target, bits):
    """Return the firmware's library of a target, compiled now: by ziglang first, whose result older systems load too."""
    with tempfile.TemporaryDirectory() as aside:
        tried = toolchain.compilers(target)[::-1]
        return toolchain.build_library(firmware_folder(), aside, target, bits, tried=tried).read_bytes()


def _built(checkout, folder):
    """Return the wheel of a checkout, without the libraries for this computer."""
    at_hand = ["--no-build-isolation"] if find_spec("hatchling") else []
    command = [sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", *at_hand, "--wheel-dir", folder, str(checkout)]
    environment = os.environ | {"HAPTICLAB_TARGETS": "none"}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    wheels = [*Path(folder).glob("*.whl")]
    if not wheels:
        raise CourseError(f"the wheel of {checkout} could not be built; give one by --wheel. pip said:\n{done.stderr}")
    return wheels[0]


def zipped_files(wheel):
    """Return the files of a wheel by their paths."""
    try:
        with zipfile.ZipFile(wheel) as packed:
            return {name: packed.read(name) for name in packed.namelist() if PurePosixPath(name).name not in NOT_OF_A_WHEEL}
    except zipfile.BadZipFile:
        raise CourseError(f"{wheel} is not a wheel; give a file such as hapticlab-0.2.0-py3-none-any.whl") from None


def write_wheel(folder, files):
    """Write files into a folder as a wheel for any Python, named by their metadata, and return its path."""
    info = next(path for path in files if path.endswith(".dist-info/METADATA")).rpartition("/")[0]
    files = dict(sorted(files.items())) | {f"{info}/WHEEL": WHEEL.encode()}
    rows = [f"{path},sha256={_digest(content)},{len(content)}\n" for path, content in files.items()]
    files[f"{info}/RECORD"] = "".join([*rows, f"{info}/RECORD,,\n"]).encode()
    path = Path(folder, f"{info.removesuffix('.dist-info')}-py3-none-any.whl")
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as packed:
        for name, content in files.items():
            packed.writestr(zipfile.ZipInfo(name, DATE), content, zipfile.ZIP_DEFLATED)
    return path


def _digest(content):
    """Return the digest of a file as RECORD has it."""
    return base64.urlsafe_b64encode(hashlib.sha256(content).digest()).decode().rstrip("=")
