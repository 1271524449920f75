"""Whose a file is, by its name and its folder's, as Moodle, Canvas, Gradescope and people give them."""

import re
import unicodedata
from pathlib import PurePosixPath

from .replies import line_of

WORK = (".ipynb", ".py", ".zip")
#: what people hand in by mistake in place of these: archives that are not read, and documents
PACKED = (".7z", ".rar", ".tar", ".tgz", ".gz", ".bz2", ".xz")
MISTAKEN = (*PACKED, ".pdf", ".html", ".htm", ".doc", ".docx", ".odt", ".rtf")
#: what systems, editors and Python leave beside people's work, in small letters
JUNK = {
    "__init__.py", "__macosx", "__pycache__", ".cache", ".conda", ".ds_store", ".git", ".ipynb_checkpoints", ".local", ".venv",
    "desktop.ini", "thumbs.db",
}  # fmt: skip
#: nbgrader's folder: submitted/STUDENT/LAB/*.ipynb
TREE = "submitted"
#: how a file ends that somebody handed in; a browser may add to the name of a notebook
OFFERED = re.compile(rf"(?<=.)(\.ipynb\.(txt|json)|\.tar\.\w+|{'|'.join(map(re.escape, (*WORK, *MISTAKEN)))})$", re.IGNORECASE)
MOODLE, GRADESCOPE = re.compile(r"(.+?)_assignsubmission_\w*"), re.compile(r"submission_\d+")
#: a file of somebody, a text or an address that was typed in, and a file of somebody whose name is hidden
CANVAS = re.compile(
    r"([^_]+?)(?:_LATE)?_(\d+)_(?:\d+_.+|text\.html|link\.html)|(?:LATE_)?(anon_[^\W_]+)_(?:\d+_.+|text\.html|link\.html)"
)
#: a lab's number, as its folder and its notebook begin
LAB = re.compile(r"(\d\d)[_\- ]")
#: what browsers, Jupyter and file managers add to the name of a second copy
COPY = re.compile(r"[\W_]*(copy)?[\W_]{0,4}\d{0,4}[\W_]?", re.IGNORECASE)


def student_of(name, lab=""):
    r"""Return the student whose folder or file it is.

    Parameters
    ----------
    name : str
    lab : str
        Name of the lab, which is no part of a student's.

    Examples
    --------
    >>> student_of("Ada Lovelace_4217_assignsubmission_file_"), student_of("02_virtual_wall_ada.ipynb", "02_virtual_wall")
    ('Ada Lovelace_4217', 'ada')
    >>> student_of("lovelaceada_LATE_4217_99213_02_virtual_wall-1.ipynb"), student_of("../../bob\u202e"), student_of("")
    ('lovelaceada_4217', '../../bob', 'unnamed')
    """
    system = MOODLE.match(name) or CANVAS.fullmatch(name)
    if system:
        name = "_".join(filter(None, system.groups()))
    else:
        name = OFFERED.sub("", name)
    if len(lab) > 2 and not is_lab(name, lab):
        name = name.replace(lab, "").strip("_- .") or name
    return line_of(unicodedata.normalize("NFC", name), 80) or "unnamed"


def is_of_system(name):
    """Return whether a folder or a file was named by a system, after a student."""
    return bool(MOODLE.match(name) or GRADESCOPE.fullmatch(name) or CANVAS.fullmatch(name))


def is_junk(name):
    """Return whether a file or a folder was made by a system, an editor or Python."""
    return name.lower() in JUNK or name.startswith(("._", ".~", "~$"))


def lab_number(name):
    """Return the number of the lab that a folder or a file is named after, or an empty text."""
    found = LAB.match(name)
    return found.group(1) if found else ""


def is_lab(name, lab):
    """Return whether a file has a lab's own name, or is a second copy of it.

    Examples
    --------
    >>> is_lab("02_virtual_wall (1).ipynb", "02_virtual_wall"), is_lab("02_virtual_wall_ada.ipynb", "02_virtual_wall")
    (True, False)
    """
    stem = PurePosixPath(name).stem
    if len(lab) > 2:
        return stem.startswith(lab) and COPY.fullmatch(stem.removeprefix(lab)) is not None
    return bool(lab) and lab_number(stem) == lab
