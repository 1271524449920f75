"""The glossary of the site: its pictures."""

import matplotlib as mpl

from . import glossary_pictures

FOLDER = "reference/glossary"


def write(source):
    """Draw the pictures into the copied source."""
    folder = source / FOLDER
    folder.mkdir(parents=True, exist_ok=True)
    with mpl.rc_context({"svg.hashsalt": "hapticlab", "font.size": 9}):
        for name in glossary_pictures.PICTURES:
            glossary_pictures.figure(name).savefig(folder / f"{name}.svg", metadata={"Date": None})
