"""Pages of the labs: each untouched notebook with its text typeset what its cells show on a simulated paddle, and an index."""

import multiprocessing
import re
import shutil
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

from hapticlab.course.labs import find_labs
from hapticlab.course.notebook import read

from ..running.frames import frame
from ..running.lab_outcomes import of_notebook

LABS = Path(__file__).parents[3] / "labs"
PROCESSES = 2
#: folder of the labs that run in a browser, where a build embeds them
IN_BROWSER = "labs_in_browser"
TABLE_ROW = re.compile(r"^\| (\d\d) ([^|]+?) \|", re.MULTILINE)
HEAD = """:::{{admonition}} To work on this lab
:class: tip

{browser} `hapticlab labs my-labs`, which copies all labs and opens JupyterLab. You can also
{{download}}`download this notebook <{name}.ipynb>`.

This page shows the lab as you receive it: the answers are yours to find. Its outputs come from a simulated paddle with nominal
constants.
:::
"""
INDEX = """
```{{toctree}}
:hidden:

{pages}
```
"""


def page(name, cells, outcomes, frames, browser="Run"):
    """Return the Markdown of a lab.

    Parameters
    ----------
    name : str
    cells : list of dict
        Of the notebook.
    outcomes : dict
        Outcome of each code cell, by its id.
    frames : callable (number, html) -> str
        Makes the frame of a live view.
    browser : str
        Beginning of the sentence on how to open the labs, with a link to the labs in a browser where the build has them.
    """
    title, rest = "".join(cells[0]["source"]).split("\n", 1)
    parts = [title, HEAD.format(name=name, browser=browser), rest.strip()]
    for cell in cells[1:]:
        source = "".join(cell["source"]).strip()
        if cell["cell_type"] == "markdown":
            parts.append(source.replace("```python\n", "```py\n"))  # an example for readers, which needs an answer to run
        elif source:
            parts += [f"```py\n{source}\n```", *_shown(outcomes.get(cell["id"]), "hl.check(" in source, frames)]
    return "\n\n".join(parts) + "\n"


def _shown(outcome, checks, frames):
    """Yield what a cell printed and showed; of a check only what it printed, since nothing is answered."""
    if outcome is None:
        return
    if outcome.printed.strip():
        yield f"```{{code-block}} text\n:class: printed\n\n{outcome.printed.rstrip()}\n```"
    for html in outcome.files:
        yield f"```{{raw}} html\n{frames(html)}\n```"
    for kind, text in [] if checks else outcome.shown:
        if kind == "text/markdown":
            yield text.strip()
        elif kind == "text/html":
            yield f"`````{{raw}} html\n{text}\n`````"
        else:
            yield f"```{{code-block}} text\n:class: printed\n\n{text.rstrip()}\n```"


def index(readme, names):
    """Return the Markdown of the index: labs/README.md, in whose tables each lab is a link.

    Examples
    --------
    >>> print(index("| 00 Meet the paddle | metres |", ["00_meet_the_paddle"]).splitlines()[0])
    | [00 Meet the paddle](00_meet_the_paddle.md) | metres |
    """
    of = {name[:2]: name for name in names}
    linked = TABLE_ROW.sub(lambda row: f"| [{row[1]} {row[2]}]({of[row[1]]}.md) |" if row[1] in of else row[0], readme)
    return linked + INDEX.format(pages="\n".join(names))


def write(source: Path, quick: bool = False) -> None:
    """Write the pages of all labs and their index; where ``quick``, run none of them."""
    folder, labs = Path(source, "labs"), find_labs(LABS)
    folder.mkdir()
    browser = (
        f'<a href="../{IN_BROWSER}/index.html">Open the labs in your browser</a>, or run'
        if (source / IN_BROWSER).is_dir()
        else "Run"
    )
    with ProcessPoolExecutor(PROCESSES, multiprocessing.get_context("spawn")) as pool:
        found = [{}] * len(labs) if quick else pool.map(of_notebook, [lab.notebook for lab in labs])
        for lab, outcomes in zip(labs, found, strict=True):
            text = page(lab.name, read(lab.notebook)["cells"], outcomes, _frames(lab.name, source), browser)
            (folder / f"{lab.name}.md").write_text(text, "utf-8")
            shutil.copy(lab.notebook, folder)
    (folder / "index.md").write_text(index((LABS / "README.md").read_text("utf-8"), [lab.name for lab in labs]), "utf-8")


def _frames(name, source):
    """Return a function that makes the next frame of a lab's page."""
    count = iter(range(1, 100))

    def made(html):
        number = next(count)
        title = f"Live view {number} of this lab"
        return frame(f"lab_{name}_{number}", html, folder=source, page=f"labs/{name}", title=title)

    return made
