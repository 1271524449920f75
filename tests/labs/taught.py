"""What the labs teach: which sections of chapter 23 each lab works with, and how many public names.

    python tests/labs/taught.py            # print both, and the public names that no lab uses
    python tests/labs/taught.py --write    # and write the table into docs/teaching/labs_for_instructors.md

A lab works with a section if its text or its code names it, one of its equations or one of its figures. A public name is
taught if the code of a lab, as it is handed out, uses it.
"""

import re
import sys
from pathlib import Path

import hapticlab as hl
from hapticlab.course.labs import find_labs
from hapticlab.course.notebook import code_of, read

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "teaching" / "labs_for_instructors.md"
BEGIN, END = "<!-- sections of the chapter -->\n", "<!-- end of the sections -->\n"
#: section: title, its equations, its figures
SECTIONS = {
    "23.1": ("Introduction", (), (1, 2)),
    "23.2.1": ("Characterizing the Human User", (), ()),
    "23.2.2": ("Specification and Design of the Haptic Interface", (), (3,)),
    "23.2.3": ("Design of the Virtual Environment", (), (4, 5)),
    "23.3.1": ("Some Observations", (), ()),
    "23.3.2": ("Some History in Haptics", (), ()),
    "23.3.3": ("Anticipatory Control", (), ()),
    "23.4": ("Haptic Interface", range(1, 9), (6,)),
    "23.4.1": ("Compensation Based on System Models", (), ()),
    "23.4.2": ("Passivity Applied to Haptic Interface", (9, 10), ()),
    "23.5.1": ("Collision Detector", (), (7,)),
    "23.5.2": ("Interaction Calculator", (), ()),
    "23.5.3": ("Forward Dynamics Solver", (), ()),
}
#: pages of public names
PAGES = [name for name in hl.__all__ if hasattr(getattr(hl, name), "__all__")]


def sections_of(text):
    """Return the sections of the chapter that a text names."""
    equations = {int(number) for number in re.findall(r"\(23\.(\d+)\)", text)}
    figures = {int(number) for number in re.findall(r"Figs?\. 23\.(\d+)", text)}
    named = {number.rstrip(".") for number in re.findall(r"Sections? (23(?:\.\d+)+)", text)}
    return [
        section
        for section, (_, own, drawn) in SECTIONS.items()
        if equations & set(own) or figures & set(drawn) or any(one == section or one.startswith(f"{section}.") for one in named)
    ]


def public_names():
    """Return all public names as they are written, ``wall`` and ``laws.virtual_damper``, without the pages themselves."""
    own = [name for name in hl.__all__ if name not in PAGES]
    return own + [f"{page}.{name}" for page in PAGES for name in getattr(hl, page).__all__]


def used_names(code):
    """Return the public names that code uses."""
    imported = [name for line in re.findall(r"^from hapticlab import (.*)$", code, re.M) for name in re.findall(r"\w+", line)]
    dotted = re.findall(r"\bhl\.((\w+)(?:\.\w+)?)", code)
    return {*imported, *(name for pair in dotted for name in pair)}


def table():
    """Return the table of sections and labs, and the line on public names, in Markdown."""
    labs = {folder.number: read(folder.notebook) for folder in find_labs(ROOT / "labs")}
    texts = {number: "".join("".join(cell["source"]) + "\n" for cell in lab["cells"]) for number, lab in labs.items()}
    named = {number: sections_of(text) for number, text in texts.items()}
    rows = ["| section of chapter 23 | labs |", "| --- | --- |"]
    for section, (title, _, _) in SECTIONS.items():
        rows.append(f"| {section} {title} | {', '.join(lab for lab, found in named.items() if section in found) or 'none'} |")
    used = set().union(*(used_names("\n".join(code_of(lab))) for lab in labs.values()))
    every = public_names()
    taught = [name for name in every if name in used]
    rows += ["", f"The code of the labs uses {len(taught)} of {len(every)} public names.", ""]
    return "\n".join(rows), [name for name in every if name not in used]


def written(page):
    """Return the page with the table of now."""
    head, rest = page.split(BEGIN)
    return f"{head}{BEGIN}{table()[0]}{END}{rest.split(END)[1]}"


if __name__ == "__main__":
    shown, unused = table()
    print(shown)
    print("no lab uses:", ", ".join(unused))
    if "--write" in sys.argv[1:]:
        PAGE.write_text(written(PAGE.read_text("utf-8")), "utf-8")
