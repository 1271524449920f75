"""The first page of a site: the labs, what is missing in a browser, and where a student's work is kept."""

from __future__ import annotations

from html import escape
from importlib.metadata import version
from pathlib import Path
from string import Template
from typing import TYPE_CHECKING

from .. import __version__
from .pages import PAGES

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..course.labs import LabFolder
    from .pages import Page

TEMPLATE = Path(__file__).with_name("front_page.html")
#: a notebook alone, which a telephone can show; JupyterLab's panels leave it a strip there
NOTEBOOK = "notebooks/index.html?path="
WORDS = ("No", "One", "Two", "Three", "Four", "Five", "Six", "Seven", "Eight", "Nine", "Ten", "Eleven", "Twelve")
#: measured in headless Chromium on two cores, from the link to a first cell that has run; docs/teaching/site.md has the table
SECONDS = "about 15 s on a laptop at the first visit"
MEGABYTE = 1e6


def front_page(labs: Sequence[LabFolder], *, local: float | None, wheels: float, pages: Sequence[Page] = PAGES) -> str:
    """Return the first page as HTML.

    Parameters
    ----------
    labs : sequence of LabFolder
        In the order of the list.
    local : float or None
        Bytes of Pyodide in the site; None where it comes from its own address.
    wheels : float
        Bytes of the packages in the site.
    pages : sequence of Page
        Pages beside the labs.
    """
    paddles = [page for page in pages if page.file == "paddle.html"]
    paddle = ' The page <a href="paddle.html">a real paddle</a> connects to one without Python.' if paddles else ""
    count = WORDS[len(labs)] if len(labs) < len(WORDS) else str(len(labs))
    return Template(TEMPLATE.read_text("utf-8")).substitute(
        count=count,
        scenes=_linked("scenes", "Try a scene at once, before any Python loads", [page for page in pages if page.scene]),
        labs="\n".join(map(_lab, labs)),
        pages=_linked("pages", "Also here", [page for page in pages if not page.scene]),
        start=SECONDS,
        paddle=paddle,
        needs=_needs(local, wheels),
        version=escape(__version__),
        lite=escape(version("jupyterlite-core")),
    )


def _lab(folder):
    lab = folder.lab()
    address = f"{NOTEBOOK}{folder.name}/{folder.notebook.name}"
    title = f'<span class="number">{lab.number}</span><span class="title">{escape(lab.title)}</span>'
    return f'<li><a href="{escape(address)}">{title}<span class="minutes">{lab.minutes} min</span></a></li>'


def _linked(key, heading, pages):
    """A section of links to pages, or nothing where there are none."""
    if not pages:
        return ""
    rows = [
        f'<li><a href="{escape(page.file)}"><span><span class="title">{escape(page.title)}</span>'
        f'<span class="about">{escape(page.about)}</span></span></a></li>'
        for page in pages
    ]
    head = f'<section aria-labelledby="{key}">\n<h2 id="{key}">{escape(heading)}</h2>\n<ul class="list">\n'
    return head + "\n".join(rows) + "\n</ul>\n</section>"


def _needs(local, wheels):
    if local is None:
        comes = (
            "Python comes from cdn.jsdelivr.net, the address of Pyodide, about 50 MB at the first visit. "
            f"{wheels / MEGABYTE:.0f} MB of packages come from this site."
        )
    else:
        comes = f"Python and its packages, {(local + wheels) / MEGABYTE:.0f} MB at the first visit, come from this site alone."
    return (
        "A current Chrome, Edge, Firefox or Safari, on a laptop, a tablet or a telephone. "
        f"{comes} The browser keeps these files for later visits."
    )
