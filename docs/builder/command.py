"""The command line of the builder."""

import argparse
from pathlib import Path

from .whole import BuildError, build


def main(words=None):
    """Build what the words of a command line ask for; return the exit code."""
    parser = argparse.ArgumentParser(prog="docs/build.py", description="Build the site of the documentation.")
    parser.add_argument("folder", type=Path, metavar="FOLDER", help="where to; an earlier build there is replaced")
    parser.add_argument("--quick", action="store_true", help="the small form: a few examples and one scene of the gallery run")
    parser.add_argument("--labs", action="store_true", help="embed the labs in a browser, as `hapticlab site` builds them")
    words_of_pyodide = "embed the labs with this distribution of Pyodide, so that no request leaves the site"
    parser.add_argument("--pyodide", type=Path, metavar="FILE", help=words_of_pyodide)
    given = parser.parse_args(words)
    try:
        build(given.folder, quick=given.quick, labs=given.labs or given.pyodide is not None, pyodide=given.pyodide)
    except BuildError as problem:
        print(problem)
        return 1
    return 0
