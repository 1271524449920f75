"""The glossary of the site: its pictures are drawn, and the names, labs and equations in it become links."""

import re

import matplotlib as mpl

from . import glossary_pictures

PAGE, FOLDER = "reference/glossary.md", "reference/glossary"
NAME = re.compile(r"`(hl\.[\w.]+)`")
LAB = re.compile(r"\blab (\d\d)\b")
EQUATION = re.compile(r"\bEq\. \(23\.(\d+)\)")


def write(source):
    """Draw the pictures into the copied source, and link the page to the pages that are there."""
    folder = source / FOLDER
    folder.mkdir(parents=True, exist_ok=True)
    with mpl.rc_context({"svg.hashsalt": "hapticlab", "font.size": 9}):
        for name in glossary_pictures.PICTURES:
            glossary_pictures.figure(name).savefig(folder / f"{name}.svg", metadata={"Date": None})
    page = source / PAGE
    labs = {path.stem[:2]: path.stem for path in (source / "labs").glob("[0-9][0-9]_*.md")}
    there = {"names": (source / "reference/hl.md").is_file(), "chapter": (source / "reference/chapter.md").is_file()}
    page.write_text(linked(page.read_text("utf-8"), labs=labs, **there), "utf-8")


def linked(text, *, labs, names, chapter):
    """Return the text of the glossary with links.

    Parameters
    ----------
    text : str
    labs : dict
        Two digits -> name of the lab's page.
    names, chapter : bool
        Whether the site has pages of the public names, and of the chapter.

    Examples
    --------
    >>> linked("See `hl.wall`, Eq. (23.1), lab 02.", labs={"02": "02_virtual_wall"}, names=True, chapter=True)
    'See {py:obj}`hl.wall <hapticlab.wall>`, [Eq. (23.1)](chapter.md#eq-23-1), [lab 02](../labs/02_virtual_wall.md).'
    """
    if names:
        text = NAME.sub(lambda found: f"{{py:obj}}`{found[1]} <hapticlab{found[1][2:]}>`", text)
    if chapter:
        text = EQUATION.sub(r"[\g<0>](chapter.md#eq-23-\1)", text)
    return LAB.sub(lambda found: f"[{found[0]}](../labs/{labs[found[1]]}.md)" if found[1] in labs else found[0], text)
