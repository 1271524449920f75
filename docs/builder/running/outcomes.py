"""What an example printed, drew or showed, written below it into the page."""

import re

from hapticlab.base.figure_words import describe

from . import examples
from .views import frame_of_view

FIGURES = "figures"
#: what the page itself says that the block prints; it gives way to what was printed
PRINTED = re.compile(r"\n```text\n.*?^```$\n?", re.M | re.S)
#: a picture of the page below the block, which gives way to the figure that the block has drawn
PICTURE = re.compile(
    r"(?P<between>(?:\n```text\n.*?^```$\n?)?\n)!\[(?P<alt>[^\]]*)\]\((?P<file>[\w./-]+\.(?:png|svg))\)", re.M | re.S
)
#: figures larger than this as SVG [bytes] are drawn in pixels
LARGEST = 200_000
DOTS = 160


def write(source, page):
    """Run the examples of a page and write what comes of them into its file; return how many ran."""
    path = source / page
    ran = examples.run(path.read_text("utf-8"), f"docs/{page}")
    if ran.examples:
        path.write_text(text_with_outcomes(ran, source, page), "utf-8")
    return len(ran.examples)


def text_with_outcomes(ran, source, page):
    """Return the text of a page that ran, with outcomes; figures and live views become files in the source."""
    parts, at = [], 0
    for number, example in enumerate(ran.examples, 1):
        name = f"{page.removesuffix('.md').replace('/', '-')}-{number}"
        parts.append(ran.text[at : example.end])
        at = example.end
        parts += [_printed(example.printed)] if example.printed else []
        if example.printed and (said := PRINTED.match(ran.text, at)):
            at = said.end()
        for count, figure in enumerate(example.figures):
            file = save(figure, source / FIGURES / (f"{name}-{count}" if count else name))
            alt, shown = figure_words(figure), PICTURE.match(ran.text, at)
            if shown and not count:
                parts.append(shown["between"] if not example.printed else "\n")
                alt, at = shown["alt"], shown.end()
            parts.append(f"\n```{{image}} /{FIGURES}/{file.name}\n:alt: {' '.join(alt.split())}\n:class: figure\n```\n")
        for count, asked in enumerate(example.views):
            shown = frame_of_view(f"{name}-{count}" if count else name, asked, source=source, page=page)
            parts += [f"\n```{{raw}} html\n{shown}\n```\n"] if shown else []
    return "".join([*parts, ran.text[at:]])


def _printed(text):
    return f"\n```{{code-block}} text\n:class: printed\n\n{text.rstrip()}\n```\n"


def figure_words(figure):
    """Return the alternative text of a figure: its own, or one from its axes and lines."""
    return getattr(figure, "alt", None) or describe(figure)


def save(figure, path):
    """Write a figure, as SVG unless that is large; return the file."""
    path.parent.mkdir(exist_ok=True)
    file = path.with_suffix(".svg")
    figure.savefig(file, metadata={"Date": None}, bbox_inches="tight")
    if file.stat().st_size > LARGEST:
        file.unlink()
        file = path.with_suffix(".png")
        figure.savefig(file, dpi=DOTS, bbox_inches="tight")
    return file
