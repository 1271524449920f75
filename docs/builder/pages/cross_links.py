"""In the pages that people write, names in code, labs, equations and figures become links to their pages."""

import os
import re

from hapticlab.vocabulary import public

#: folders and pages that are written by hand; the builder writes all others with their links
WRITTEN = ("tutorial", "how_to", "explanation", "extending", "teaching", "paddle", "papers", "reference/glossary.md")
NAME = re.compile(r"`(hl\.[\w.]+)`")
LAB = re.compile(r"\b[Ll]ab (\d\d)\b")
CITED = re.compile(r"\b(Eq\.|Fig\.) (?:\(23\.(\d+)\)|23\.(\d+))")
LINK = re.compile(r"(\[[^\]]*\]\([^)]*\)|\[[^\]]*$|^[^\[]*\]\([^)]*\))")
CHAPTER = "reference/chapter.md"


def write(source):
    """Link the written pages to the pages that the copied source has."""
    labs = {path.stem[:2]: f"labs/{path.name}" for path in (source / "labs").glob("[0-9][0-9]_*.md")}
    chapter = source / CHAPTER
    targets = set(re.findall(r"^\(((?:eq|fig)-23-\d+)\)=", chapter.read_text("utf-8"), re.M)) if chapter.is_file() else set()
    names = set(public()) if (source / "reference/hl.md").is_file() else set()
    for path in sorted(source.rglob("*.md")):
        page = path.relative_to(source).as_posix()
        if page.startswith(WRITTEN):
            path.write_text(linked(path.read_text("utf-8"), page, names=names, labs=labs, targets=targets), "utf-8")


def linked(text, page, *, names, labs, targets):
    """Return the text of a page with links; headings, code and links stay as they are.

    Parameters
    ----------
    text : str
    page : str
        Its path in the source.
    names : set of str
        The public names that have a page.
    labs : dict
        Two digits -> page of the lab.
    targets : set of str
        The equations and figures that the page of the chapter has, such as "eq-23-1".

    Examples
    --------
    >>> given = {"names": {"hl.wall"}, "labs": {"02": "labs/02_virtual_wall.md"}, "targets": {"eq-23-1"}}
    >>> linked("See `hl.wall`, Eq. (23.1), lab 02.", "how_to/units.md", **given)
    'See {py:obj}`hl.wall <hapticlab.wall>`, [Eq. (23.1)](../reference/chapter.md#eq-23-1), [lab 02](../labs/02_virtual_wall.md).'
    """

    def relative(there):
        return os.path.relpath(there, os.path.dirname(page))

    def name(found):
        return f"{{py:obj}}`{found[1]} <hapticlab{found[1][2:]}>`" if found[1] in names else found[0]

    def lab(found):
        return f"[{found[0]}]({relative(labs[found[1]])})" if found[1] in labs else found[0]

    def cited(found):
        target = f"{found[1][:-1].lower()}-23-{found[2] or found[3]}"
        return f"[{found[0]}]({relative(CHAPTER)}#{target})" if target in targets else found[0]

    lines, fence = [], ""
    for line in text.split("\n"):
        opened = re.match(r" *(`{3,}|~{3,})", line)
        if opened and not fence:
            fence = opened[1]
        elif opened and opened[1].startswith(fence):
            fence = ""
        elif not fence and not line.startswith(("#", "    ")):
            parts = LINK.split(line)
            parts[::2] = [_outside_code(part, lab, cited) for part in (NAME.sub(name, part) for part in parts[::2])]
            line = "".join(parts)
        lines.append(line)
    return "\n".join(lines)


def _outside_code(text, lab, cited):
    """Link labs, equations and figures between the pieces of code of a line."""
    parts = re.split(r"(`[^`]*`)", text)
    parts[::2] = [CITED.sub(cited, LAB.sub(lab, part)) for part in parts[::2]]
    return "".join(parts)
