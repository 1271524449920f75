"""Where a program runs: under IPython, and what is shown there; in a browser. The only module that opens IPython."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from typing import Any

from ..errors import HapticlabError


def in_a_notebook() -> bool:
    """Tell whether IPython runs this; it is not imported to find out."""
    if "IPython" not in sys.modules:
        return False
    from IPython import get_ipython

    return get_ipython() is not None


def is_in_browser() -> bool:
    """Whether a browser runs this Python (Pyodide): one thread, and no other process, serial port or socket."""
    return sys.platform == "emscripten"


def require_processes(asked: str, error: type[HapticlabError] = HapticlabError) -> None:
    """Raise an error where there is only one process: ``asked`` is what needs others, as the subject of a sentence."""
    if is_in_browser():
        raise error(
            f"{asked} runs other processes, and Python in a browser cannot start any. Install hapticlab on a computer "
            "(pip install hapticlab), and run this there"
        )


def display(data: Mapping[str, Any], metadata: Mapping[str, Any] | None = None) -> None:
    """Show one output in several forms, such as {"text/plain": ..., "text/html": ...}; the front end takes the richest."""
    from IPython.display import display as show

    show(dict(data), metadata=dict(metadata or {}), raw=True)
