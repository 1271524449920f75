"""Which packages the labs need in a browser, and where each comes from: Pyodide's distribution, or this Python's packages."""

import re
from importlib.metadata import PackageNotFoundError, distribution

from ..errors import CourseError

#: hapticlab, the view in a notebook, and what JupyterLite's kernel imports
ROOTS = ("hapticlab", "anywidget", "ipywidgets", "comm", "ipython", "jedi")
#: of their requirements: pages of grades, and JavaScript that the site has as extensions
NOT_THERE = {"jinja2", "jupyterlab-widgets", "widgetsnbextension"}
#: what of these Pyodide's own distribution has at its address, which a build never asks; a test compares its lock file
OF_PYODIDE = {
    "ipython", "jedi", "lazy-loader", "matplotlib", "numpy", "platformdirs", "scipy", "sympy", "tqdm", "traitlets",
    "typing-extensions",
}  # fmt: skip
#: how markers of requirements see a browser
BROWSER = {
    "sys_platform": "emscripten", "platform_system": "Emscripten", "platform_machine": "wasm32", "os_name": "posix",
    "python_version": "3.14", "python_full_version": "3.14.0", "extra": "",
}  # fmt: skip


def normal(name):
    """Return a package's name as indexes write it: PEP 503."""
    return re.sub(r"[-_.]+", "-", name).lower()


def needed(of_pyodide=frozenset(OF_PYODIDE)):
    """Return the names of packages that come from Pyodide, and of those that are to be made of this Python's.

    Parameters
    ----------
    of_pyodide : set of str
        What Pyodide has; the requirements of its packages are Pyodide's own affair.

    Returns
    -------
    tuple of two lists of str
        Both sorted.

    Examples
    --------
    >>> theirs, ours = needed()
    >>> "numpy" in theirs, {"hapticlab", "pint", "anywidget"} <= set(ours)
    (True, True)
    """
    theirs, ours, waiting = set(), set(), list(ROOTS)
    while waiting:
        name = normal(waiting.pop())
        if name in theirs | ours | NOT_THERE:
            continue
        if name in of_pyodide:
            theirs.add(name)
        else:
            ours.add(name)
            waiting += requirements(name)
    return sorted(theirs), sorted(ours)


def requirements(name):
    """Return what an installed package requires in a browser."""
    from packaging.requirements import Requirement

    try:
        given = [Requirement(text) for text in distribution(name).requires or ()]
    except PackageNotFoundError:
        raise CourseError(
            f'{name} is not installed, and the labs need it in a browser; do: pip install "hapticlab[site]"'
        ) from None
    return [one.name for one in given if one.marker is None or one.marker.evaluate(BROWSER)]
