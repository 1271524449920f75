"""The index of the chapter: below each equation and figure of docs/reference/chapter.md, what names it."""

import re

from . import uses
from .uses import ROOT

PAGE = "reference/chapter"
#: what stands before the heading of an equation or a figure
TARGET = re.compile(r"^\((eq|fig)-23-(\d+)\)=$", re.M)
KINDS = {"eq": "equation", "fig": "figure"}
NOTHING = "- Nothing in this package names it."


def write(source):
    """Add to the copied page what names each equation and figure."""
    (source / f"{PAGE}.md").write_text(page(lambda address: (source / f"{address}.md").is_file()), "utf-8")


def page(exists=lambda address: True):
    """The page with its index."""
    text = (ROOT / "docs" / f"{PAGE}.md").read_text("utf-8")
    parts = TARGET.split(text)
    shown = [parts[0]]
    for kind, number, body in zip(parts[1::3], parts[2::3], parts[3::3], strict=True):
        body, heading, rest = body.partition("\n## ")
        found = "\n".join(uses.links(uses.citing(int(number), KINDS[kind]), PAGE, exists)) or NOTHING
        shown.append(f"({kind}-23-{number})={body.rstrip()}\n\n{found}\n\n{heading.strip()} {rest}" if heading else
                     f"({kind}-23-{number})={body.rstrip()}\n\n{found}\n\n")  # fmt: skip
    return "".join(shown)
