"""JupyterLite with the labs and their packages: what its builder is told, and the run of that builder."""

import json
import shutil
import subprocess
import sys
import sysconfig
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path

from ..base.in_notebook import require_processes
from ..course.labs import RECORD, copy_labs
from ..errors import CourseError, EngineMissingError

BUILDERS = ("jupyterlite-core", "jupyterlite-pyodide-kernel")
KERNEL = "@jupyterlite/pyodide-kernel-extension:kernel"
#: package -> its extension of JupyterLab; any others of this environment stay out
EXTENSIONS = {
    "jupyterlab-widgets": "@jupyter-widgets/jupyterlab-manager",
    "anywidget": "anywidget",
    "jupyterlite-pyodide-kernel": "@jupyterlite/pyodide-kernel-extension",
}
APPS = ("lab", "notebooks", "tree")
#: light or dark as the reader's system is, like the first page
SETTINGS = {"@jupyterlab/apputils-extension:themes": {"adaptive-theme": True}}
#: from the worker in which Python runs, which is where it is in that extension, to the site's wheels
WHEELS = "../../../../pypi"


def check_builders():
    """Raise EngineMissingError if what builds a site is not installed, or needs processes that are not there."""
    require_processes("Building a site", EngineMissingError)
    for name in (*BUILDERS, *EXTENSIONS):
        try:
            distribution(name)
        except PackageNotFoundError:
            raise EngineMissingError(
                f'{name} is not installed, which builds the site; do: {sys.executable} -m pip install "hapticlab[site]"; '
                "then the same command again"
            ) from None


def prepare(folder, theirs, wheels):
    """Write into a folder what JupyterLite's builder reads, beside ``pypi`` and ``static`` that are there.

    Parameters
    ----------
    theirs : sequence of str
        Packages of Pyodide that Python loads when it starts.
    wheels : sequence of Path
        Those in ``pypi``, which it also loads.
    """
    copy_labs(folder / "labs")
    (folder / "labs" / RECORD).unlink()
    roots = Path(sysconfig.get_path("data"), "share", "jupyter", "labextensions")
    build = {
        "LiteBuildConfig": {
            "apps": APPS,
            "contents": [str(folder / "labs")],
            "federated_extensions": [str(roots / name) for name in EXTENSIONS.values()],
            "ignore_sys_prefix": True,
            "no_sourcemaps": True,
            "no_unused_shared_packages": True,
        }
    }
    # by names and addresses, so that `import hapticlab` is the first thing that a notebook needs to do
    packages = ["micropip", *theirs, *(f"{WHEELS}/{path.name}" for path in wheels)]
    kernel = {"disablePyPIFallback": True, "loadPyodideOptions": {"packages": packages}}
    page = {"appName": "hapticlab", "litePluginSettings": {KERNEL: kernel}}
    (folder / "jupyter_lite_config.json").write_text(json.dumps(build), "utf-8")
    (folder / "overrides.json").write_text(json.dumps(SETTINGS), "utf-8")
    lite = {"jupyter-lite-schema-version": 0, "jupyter-config-data": page}
    (folder / "jupyter-lite.json").write_text(json.dumps(lite), "utf-8")


def build(folder, target):
    """Run JupyterLite's builder on a prepared folder."""
    command = [sys.executable, "-m", "jupyterlite_core", "build", "--lite-dir", str(folder), "--output-dir", str(target)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=folder)
    if done.returncode or "TaskError" in done.stdout + done.stderr:
        raise CourseError(f"JupyterLite's builder failed; it said:\n{(done.stdout + done.stderr)[-2000:]}")
    for name in ("rspack.config.js", "rspack.config.analyze.js", "rspack.config.watch.js"):  # of its own build
        (target / name).unlink(missing_ok=True)
    shutil.rmtree(target / "doc", ignore_errors=True)
    icons = target / "static" / "favicons"  # which the page of one notebook asks for
    icons.mkdir(parents=True)
    for name in ("favicon-notebook.ico", "favicon-busy-1.ico"):
        shutil.copy(target / "notebooks" / "favicon.ico", icons / name)
