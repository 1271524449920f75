"""A distribution of Pyodide on this computer, a folder or a packed one, and the part of it that a site needs."""

import hashlib
import json
import tarfile
from pathlib import Path

from ..errors import CourseError
from .needs import normal

LOCK = "pyodide-lock.json"
#: what starts Python; the lock file lists everything else
CORE = ("pyodide.mjs", "pyodide.asm.mjs", "pyodide.asm.wasm", "python_stdlib.zip")
#: what JupyterLite's kernel is built for
PYTHON = "3.14"


class Archive:
    """The files of a distribution by their names, and its lock file's packages by normal names."""

    def __init__(self, place):
        inside = Path(place, "pyodide")  # where a release has it
        self.place = place
        self.paths = {path.name: path for path in (inside if inside.is_dir() else Path(place)).iterdir() if path.is_file()}
        lacking = [name for name in (*CORE, LOCK) if name not in self.paths]
        if lacking:
            raise CourseError(
                f"{place} has no {lacking[0]}, so that it is not a distribution of Pyodide for JupyterLite; give the folder "
                "or the archive pyodide-VERSION.tar.bz2 of a release, from https://github.com/pyodide/pyodide/releases"
            )
        self.lock = json.loads(self.paths[LOCK].read_text("utf-8"))
        python = self.lock["info"]["python"]
        if not python.startswith(f"{PYTHON}."):
            raise CourseError(f"{place} is Pyodide with Python {python}; JupyterLite's kernel needs Python {PYTHON}")
        self.packages = {
            normal(name): record for name, record in self.lock["packages"].items() if record["file_name"] in self.paths
        }

    def copy(self, names, folder):
        """Copy Python, the packages of these names and what they need into a folder, with a lock file of just these.

        Raises
        ------
        CourseError
            If a package is missing, or differs from what the lock file says.
        """
        Path(folder).mkdir(parents=True)
        wanted = self.closure(names)
        for name in (*CORE, *(record["file_name"] for record in wanted.values())):
            content = self.paths[name].read_bytes()
            Path(folder, name).write_bytes(content)
        for record in wanted.values():
            content = Path(folder, record["file_name"]).read_bytes()
            if hashlib.sha256(content).hexdigest() != record["sha256"]:
                raise CourseError(f"{record['file_name']} is not the file that {LOCK} names; get {self.place} again")
        kept = {key: one for key, one in self.lock["packages"].items() if normal(key) in wanted}
        Path(folder, LOCK).write_text(json.dumps(self.lock | {"packages": kept}), "utf-8")

    def closure(self, names):
        """Return the records of packages and of all that these depend on, by normal names."""
        found, waiting = {}, [normal(name) for name in names]
        while waiting:
            name = waiting.pop()
            if name in found:
                continue
            if name not in self.packages:
                raise CourseError(f"{self.place} has no {name}, which the labs need; give the whole distribution of Pyodide")
            found[name] = self.packages[name]
            waiting += [normal(one) for one in found[name]["depends"]]
        return found


def opened(given, aside):
    """Return the Archive of a folder, or of a packed distribution, which is unpacked into the folder ``aside``."""
    given = Path(given)
    if given.is_dir():
        return Archive(given)
    try:
        with tarfile.open(given) as packed:
            packed.extractall(aside, filter="data")
    except FileNotFoundError:
        raise CourseError(f"{given} is not there; give a folder, or an archive such as pyodide-314.0.6.tar.bz2") from None
    except (tarfile.TarError, EOFError, OSError) as problem:
        why = str(problem).partition("\n")[0].rstrip(":")
        raise CourseError(f"{given} could not be unpacked: {why}; give a folder, or a whole .tar.bz2") from None
    return Archive(aside)
