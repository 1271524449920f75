"""What the cells of an untouched lab print, show and open, as a notebook has it, in a process of its own."""

import contextlib
import sys
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

from hapticlab.errors import HapticlabError

from . import views
from .examples import ExampleError

#: what a page can show, the richest first
KINDS = ("text/markdown", "text/html", "text/plain")
VIEW = "application/vnd.jupyter.widget-view+json"


@dataclass
class Outcome:
    """What one cell did.

    Attributes
    ----------
    printed : str
    shown : list of (kind, text)
    files : list of str
        Texts of shared files, one for each live view.
    """

    printed: str = ""
    shown: list = field(default_factory=list)
    files: list = field(default_factory=list)


def outcomes(sources):
    """Run cells of a notebook one after another in a temporary folder, and return the outcome of each.

    Parameters
    ----------
    sources : list of str

    Raises
    ------
    ExampleError
        For the first cell that raises, with its first line.
    """
    from IPython.core.displayhook import CapturingDisplayHook
    from IPython.core.displaypub import CapturingDisplayPublisher
    from IPython.core.interactiveshell import InteractiveShell
    from IPython.utils.capture import capture_output

    shell = InteractiveShell.instance()
    shell.display_formatter.set_trait("active_types", [*KINDS])  # as a notebook, not as a terminal
    found = []
    try:
        with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder), views.noted() as opened:
            for source in sources:
                shell.display_pub, outputs = CapturingDisplayPublisher(), []
                shell.display_trap.hook = CapturingDisplayHook(shell, outputs)
                with capture_output(stdout=True, stderr=True, display=False) as text:
                    ran = shell.run_cell(source)
                if problem := ran.error_before_exec or ran.error_in_exec:
                    raise ExampleError(f"the cell {source.partition(chr(10))[0]!r}: {type(problem).__name__}: {problem}")
                every = [*shell.display_pub.outputs, *outputs]
                found.append(Outcome(text.stdout, [one for each in every for one in richest(each["data"])], [*_shared(opened)]))
                opened.clear()
    finally:
        InteractiveShell.clear_instance()
    return found


def richest(data):
    """Yield the richest form of an output that a page can show; nothing of a live view, which becomes a frame.

    Examples
    --------
    >>> list(richest({"text/plain": "4", "text/html": "<b>4</b>"}))
    [('text/html', '<b>4</b>')]
    """
    if VIEW not in data:
        yield from [(kind, data[kind]) for kind in KINDS if kind in data][:1]


def _shared(opened):
    """Yield the shared file of each view; none of a board, or of a scene that a page cannot draw: there the code stands alone."""
    for asked in opened:
        with contextlib.suppress(HapticlabError):
            yield views.shared_text(asked)


def of_notebook(path):
    """Return the outcomes of a notebook by the id of each cell; for a process of its own."""
    from hapticlab.course.notebook import read

    cells = [cell for cell in read(path)["cells"] if cell["cell_type"] == "code"]
    sys.path.insert(0, str(Path(path).parent))
    try:
        found = outcomes(["".join(cell["source"]) for cell in cells])
    except ExampleError as problem:
        raise ExampleError(f"{Path(path).name}, {problem}") from problem
    return dict(zip([cell["id"] for cell in cells], found, strict=True))
