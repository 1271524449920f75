"""Which of the files that a student handed in is graded."""

import re
from collections import defaultdict
from dataclasses import replace
from itertools import islice

from ...course.labs import CHECKS
from ...errors import CourseError
from .archives import MIB, NOTHING, read_entry, zip_entries
from .naming import PACKED, WORK, lab_number
from .notebook_text import notebook_cells, script_cells

#: of a notebook; notebooks of one student that are opened to see which is meant
MOST_BYTES, MOST_OPENED = 32 * MIB, 20
#: of all of these together
MOST_TOGETHER = 4 * MOST_BYTES
#: so many answers of another lab, and none of this one, tell a notebook of that lab whatever it is called
MANY = 3
CHECK = re.compile(rb"""check\(\s*\\?['"](\w\w)\.?(\w+)""")


def is_handed(entry):
    """Return whether somebody may have handed a file in as their work."""
    return entry.suffix in WORK and entry.name != CHECKS


def is_work(entry):
    """Return whether a file may be graded: one that a dot before its name or a folder's hides is not."""
    return is_handed(entry) and not any(part.startswith(".") for part in entry.parts)


def cells_of(entry, raw):
    """Return the sources of the code cells of a notebook or a script."""
    try:
        return notebook_cells(raw) if entry.suffix == ".ipynb" else script_cells(raw)
    except CourseError as problem:
        raise CourseError(f"{entry.name} {problem}") from None


def chosen(entries, lab, own=()):
    """Return the file that is graded, and its bytes.

    Parameters
    ----------
    entries : sequence of Entry
        What a student handed in.
    lab : str
        Its number or name.
    own : sequence of str
        Code cells of the lab as it was handed out: a copy of these is set aside where there is anything else.

    Raises
    ------
    CourseError
        Where there is none, or more than one may be meant, or all are of other labs.
    """
    work = _work([one for entry in entries for one in _unpacked(entry)])
    number = lab[:2]
    work = _narrowed(work, lambda entry: not number or {lab_number(part) for part in entry.parts} <= {number, ""})
    work = _narrowed(work, lambda entry: not number or number in map(lab_number, entry.parts))
    contents = _of_this_lab(_highest(work, own), number)
    counts = [len(_checked(raw)[number.encode()]) for _, raw in contents]
    best = [content for content, count in zip(contents, counts, strict=True) if count == max(counts)]
    if len({raw for _, raw in best}) > 1:
        raise CourseError(f"{' and '.join(entry.name for entry, _ in best[:3])} are all possible; hand in only one")
    return best[0]


def _work(entries):
    """Return the notebooks; where there are none, the scripts."""
    if refused := next((entry for entry in entries if entry.problem), None):
        raise CourseError(refused.problem)
    work = [entry for entry in entries if is_work(entry)]
    found = [entry for entry in work if entry.suffix == ".ipynb"] or [entry for entry in work if entry.suffix == ".py"]
    if found:
        return found
    if work:
        raise CourseError(f"{work[0].name} is a zip file inside a zip file; hand in the notebook itself")
    if packed := [entry for entry in entries if entry.suffix in PACKED]:
        raise CourseError(f"{packed[0].name} cannot be unpacked here; hand in the notebook itself, or a zip file")
    there = ", ".join(entry.name for entry in entries[:3]) or NOTHING
    hidden = "; a file is hidden by the dot before its name" if any(map(is_handed, entries)) else ""
    raise CourseError(f"it contains no notebook; there is {there}{' and more' if len(entries) > 3 else ''}{hidden}")


def _unpacked(entry):
    """Return a file, or what a zip file holds."""
    if entry.suffix != ".zip" or len(entry.inside) > 1:
        return [entry]
    return [replace(one, parts=(*entry.parts[:-1], *one.parts)) for one in zip_entries(entry)]


def _highest(work, own):
    """Return the files that lie highest, with their bytes; copies of the lab as it came only where nothing else is."""
    plain, opened, size = [], 0, 0
    for depth in sorted({len(entry.parts) for entry in work}):
        here = islice((entry for entry in work if len(entry.parts) == depth), max(0, MOST_OPENED - opened))
        contents = []
        for entry in here:
            contents.append((entry, read_entry(entry, MOST_BYTES)))
            opened, size = opened + 1, size + len(contents[-1][1])
            if size > MOST_TOGETHER:
                raise CourseError(f"its notebooks have more than {MOST_TOGETHER // MIB} MiB together; hand in only one")
        meant = [content for content in contents if len(work) == 1 or not _is_plain(*content, own)]
        if meant:
            return meant
        plain += contents
    return plain


def _is_plain(entry, raw, own):
    """Return whether a notebook has the cells of the lab's own."""
    try:
        return bool(own) and _texts(cells_of(entry, raw)) == _texts(own)
    except CourseError:
        return False


def _texts(cells):
    return [cell.strip() for cell in cells if cell.strip()]


def _of_this_lab(contents, number):
    """Return those that are not plainly of another lab."""
    others = [_other_lab(entry, raw, number) for entry, raw in contents]
    if number and all(others):
        raise CourseError(f"{contents[0][0].name} is of lab {others[0]}, not of lab {number}")
    return [content for content, other in zip(contents, others, strict=True) if not other]


def _other_lab(entry, raw, number):
    """Return the number of the lab that a notebook is plainly of, where that is another: it checks no answer of this one."""
    found = _checked(raw)
    if not number or number.encode() in found:
        return ""
    counts = {lab.decode(): len(names) for lab, names in found.items() if lab.isdigit()}
    return next((lab for lab, count in counts.items() if lab == lab_number(entry.name) or count >= MANY), "")


def _narrowed(several, wanted):
    """Return those that are wanted; where none is, all."""
    return [one for one in several if wanted(one)] or several


def _checked(raw):
    """Return the labs of which a notebook checks answers, each with their names."""
    found = defaultdict(set)
    for lab, name in CHECK.findall(raw):
        found[lab].add(name)
    return found
