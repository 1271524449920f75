"""Python in Pyodide, in node: ``run_in_pyodide(code)`` returns what the code prints.

One Pyodide serves all tests of a process, because loading it takes 8 s. micropip installs hapticlab there, by its wheel and from
the archive alone. A request that would leave node is refused, and the run that makes it fails.
"""

import atexit
import json
import os
import shutil
import subprocess
import sys
import tempfile
import threading
import tomllib
from functools import cache
from pathlib import Path

from pyodide_archive import NoPyodideError, archive

ROOT = Path(__file__).resolve().parents[2]


def run_in_pyodide(code, folder=None, seconds=280, **values):
    """Run Python in Pyodide, and return what it printed.

    Parameters
    ----------
    code : str or Path
        Python, which may ``await``; a file's content if it is a Path. Each run has names of its own; modules stay imported.
    folder : str or Path, optional
        Of this computer: the working directory of the code, which reads and writes it as ``/folder``.
    seconds : float
        What the code may take before Pyodide is ended.
    **values
        What the code finds under these names: numbers, texts, lists, dicts.

    Raises
    ------
    AssertionError
        With the traceback of Pyodide, if the code fails, or if a request would have left node.
    """
    code = code.read_text("utf-8") if isinstance(code, Path) else code
    folder = None if folder is None else str(Path(folder).resolve())
    said = _pyodide().ask({"code": code, "folder": folder, "values": values}, seconds)
    assert not said["error"], said["printed"] + said["error"]
    assert not said["left"], f"requests that would have left Pyodide: {said['left']}"
    return said["printed"]


def pytest_in_pyodide(*arguments, seconds=280):
    """Run files of tests in Pyodide, and return pytest's last line. A test may be skipped only if llvmlite is missing.

    The fixtures of tests/conftest.py are not there, nor are threads, processes, and packages beyond the archive's.
    """
    with (ROOT / "pyproject.toml").open("rb") as file:
        settings = tomllib.load(file)["tool"]["pytest"]["ini_options"]
    options = ["-q", "-rs", "-c", "/dev/null", "--rootdir=/folder", "--noconftest", "--import-mode=importlib"]
    options += ["-p", "no:cacheprovider", "-p", "no:faulthandler"]
    options += ["-o", "pythonpath=" + " ".join(f"/folder/{name}" for name in settings["pythonpath"])]
    options += [f"-W{words}" for words in (*settings["filterwarnings"], "ignore::pytest.PytestUnknownMarkWarning")]
    code = "import pytest\nprint('ended with', int(pytest.main(arguments)))"
    printed = run_in_pyodide(code, ROOT, seconds, arguments=[*options, *arguments])
    skipped = [line for line in printed.splitlines() if line.startswith("SKIPPED") and "llvmlite" not in line]
    assert printed.rstrip().endswith("ended with 0") and not skipped, printed
    return printed.splitlines()[-2]


@cache
def wheel():
    """Return the path of the project's wheel for a browser, which is built from this checkout."""
    folder = tempfile.mkdtemp(prefix="hapticlab-wheel-")
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    command = [sys.executable, "-m", "pip", "wheel", "-q", "--no-deps", "--no-build-isolation", "-w", folder, ROOT]
    done = subprocess.run(
        command, env={**os.environ, "HAPTICLAB_TARGETS": "emscripten-wasm32-32"}, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    (made,) = Path(folder).glob("hapticlab-*.whl")
    return made


@cache
def _pyodide():
    return Pyodide()


class Pyodide:
    """A process of node with Pyodide, and the wheel installed."""

    def __init__(self):
        node = shutil.which("node")
        if not node:
            raise NoPyodideError("Pyodide is run by node 18 or newer, which is not on the path. Install it.")
        command = [node, Path(__file__).with_suffix(".mjs"), archive(), wheel()]
        self._process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        atexit.register(self.close)
        self._answer(280)

    @property
    def pid(self):
        return self._process.pid

    def ask(self, request, seconds):
        self._process.stdin.write(json.dumps(request) + "\n")
        self._process.stdin.flush()
        return self._answer(seconds)

    def _answer(self, seconds):
        watch = threading.Timer(seconds, self._process.kill)
        watch.start()
        line = self._process.stdout.readline()
        watch.cancel()
        if not line:
            _pyodide.cache_clear()  # the next test begins with a new one
            raise AssertionError(f"node ended with code {self._process.wait()}; after {seconds} s it is ended from here")
        return json.loads(line)

    def close(self):
        self._process.kill()
        self._process.wait()
        self._process.stdin.close()
        self._process.stdout.close()
