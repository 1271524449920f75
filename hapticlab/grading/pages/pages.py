"""Pages of a graded class: one for each student, and one of all; they open without a network, run no script, and print."""

import base64
import hashlib
from pathlib import Path

from ...errors import CourseError
from .class_page import class_body
from .page_text import clean, file_name
from .student_page import student_body

#: near the beginning of every page
OWN = b"default-src 'none'; style-src 'sha256-"
STYLE = Path(__file__).with_name("pages.css")


def write_pages(reports, folder, *, lab):
    """Write a page for each student and one of the class; the same reports give the same bytes, in whatever order.

    A student's page names nobody else, so it can be sent to its student.

    Parameters
    ----------
    reports : sequence of Report
        Of one lab.
    folder : str or Path
        Made where it is missing; pages of the same names are written anew.
    lab : Lab

    Returns
    -------
    list of Path
        ``class.html``, then each student's page in ``students``.

    Raises
    ------
    CourseError
        Where the folder cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> from hapticlab.course.exercise import Lab
    >>> from hapticlab.grading.report import ExerciseReport, Report
    >>> report = Report("ada", "02", "Walls", "wall.ipynb", exercises=(ExerciseReport("k", "value", points=2.0),))
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     written = write_pages([report], folder, lab=Lab("02", "Walls", 90, ()))
    ...     [path.relative_to(folder).as_posix() for path in written]
    ['class.html', 'students/ada.html']
    """
    named, copies = [], {}
    for report in sorted(reports, key=lambda r: (r.student.casefold(), r.student, r.submission, r.sha256)):
        copies[report.student] = copies.get(report.student, -1) + 1
        named.append((f"students/{file_name(report.student, copies[report.student])}.html", report))
    style = STYLE.read_text("utf-8")
    pages = {"class.html": page(f"Lab {lab.number}, the class", class_body(named, lab), style)}
    for address, report in named:
        pages[address] = page(f"Lab {report.lab}, {report.student}", student_body(report, lab), style)
    return _written(Path(folder), pages)


def check_folder(folder):
    """Refuse a folder whose class.html is of something else, which would be overwritten.

    Raises
    ------
    CourseError
    """
    path = Path(folder) / "class.html"
    if path.is_file() and OWN not in path.read_bytes()[:500]:
        raise CourseError(f"{path} is not a page of hapticlab's and would be overwritten; name a folder of its own for the pages")


def page(title, body, style):
    """Return a whole page, which may load and run nothing: its style is allowed by its hash alone."""
    allowed = base64.b64encode(hashlib.sha256(style.encode()).digest()).decode()
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f"<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'sha256-{allowed}'; "
        "base-uri 'none'; form-action 'none'\">\n"
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n<meta name="referrer" content="no-referrer">\n'
        f"<title>{clean(title, 150)}</title>\n<style>{style}</style>\n</head>\n<body>\n{body}\n</body>\n</html>\n"
    )


def _written(folder, pages):
    path = folder / "students"
    try:
        path.mkdir(parents=True, exist_ok=True)
        for address, text in pages.items():
            path = folder / address
            path.write_text(text, "utf-8", newline="\n")
    except OSError as problem:  # of a disk that is full, without the name of the file
        why = f"cannot write {problem.filename or path}: {problem.strerror or problem}"
        raise CourseError(f"{why}; name a folder of your own, such as: --pages pages") from None
    return [folder / address for address in pages]
