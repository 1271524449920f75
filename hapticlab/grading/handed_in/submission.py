"""What students handed in: found in folders, zip files and nbgrader's tree, and read as the sources of code cells."""

import hashlib
from collections import defaultdict
from dataclasses import dataclass, replace
from pathlib import Path

from ...course.labs import find_labs
from ...errors import CourseError
from .archives import LINK, Entry, zip_entries
from .file_choice import cells_of, chosen, is_handed, is_work
from .folders import folder_entries
from .naming import MISTAKEN, TREE, is_lab, is_of_system, lab_number, student_of
from .replies import line_of


@dataclass(frozen=True)
class Source:
    """Where a submission is: its student, its name, and the files one of which it is."""

    student: str
    name: str
    entries: tuple
    lab: str = ""
    problem: str = ""


@dataclass(frozen=True)
class Submission:
    """What a student handed in.

    Attributes
    ----------
    student : str
    name : str
        Of the file, without the way to it.
    cells : tuple of str
        Sources of its code cells; of a script, its statements, each on the lines it has there.
    sha256 : str
        Of the file's bytes; where there is no file, of the problem.
    problem : str
        Why it cannot be graded; it has no cells then.
    """

    student: str
    name: str
    cells: tuple = ()
    sha256: str = ""
    problem: str = ""


def find_submissions(paths, lab=None):
    """Return where the submissions are, one for each student; no notebook is opened.

    A file is one student's. So is a folder or zip file that holds one notebook or script, or nothing but notebooks and
    folders of labs under their own names. In any other each notebook, script, zip file or folder is a student's, and one
    under the lab's own name has a problem; in a folder ``submitted``, as nbgrader has it, each folder. Names as Moodle,
    Canvas and Gradescope give them are known.

    Parameters
    ----------
    paths : sequence of str or Path
    lab : str, optional
        Number or name, "02" or "02_virtual_wall".

    Returns
    -------
    list of Source
        Students are unique: of one who is there twice, each has a problem that names both.

    Raises
    ------
    CourseError
        For a path that is not there.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     for name in ("ada.py", "bob.ipynb"):
    ...         _ = Path(folder, name).write_text("k = 150")
    ...     [(source.student, read(source).cells, read(source).problem) for source in find_submissions([folder])]
    [('ada', ('k = 150',), ''), ('bob', (), 'bob.ipynb is not a notebook; it needs the JSON that Jupyter writes')]
    """
    return [replace(source, lab=lab or "") for source in _told_apart(_with_work(_all_found(paths, lab or "")))]


def left_aside(paths, lab=None):
    """Files that are in no submission: those that are no work, texts and PDFs beside somebody's work.

    Parameters
    ----------
    paths, lab
        As of :func:`find_submissions`.

    Returns
    -------
    list of str
    """
    held = {(entry.file, entry.inside) for source in find_submissions(paths, lab) for entry in source.entries}
    found = []
    for path in [path.resolve() for path in map(Path, paths) if _is_container(path)]:
        try:
            listed = _entries(path)
        except CourseError:  # it is a submission, with a problem
            continue
        if not any(entry.parts[0] == TREE for entry in listed):  # beside that lies the rest of a course
            found += [line_of("/".join(one.parts), 100) for one in listed if (one.file, one.inside) not in held]
    return found


def lab_of(sources):
    """Return the number of the lab that the names of all files agree on."""
    parts = {part for source in sources for entry in source.entries for part in entry.parts}
    named = sorted({lab_number(part) for part in parts} - {""})
    if len(named) != 1:
        told = f"name labs {', '.join(named)}" if named else "name no lab"
        raise CourseError(f"the files {told}; give the lab to grade, such as --lab 02")
    return named[0]


def _all_found(paths, lab):
    return [source for path in paths for source in _found(Path(path), lab, len(paths) > 1)]


def _found(path, lab, several):
    """Return the sources at one path, as it was named on the command line, alone or as one of several."""
    try:
        if several and path.is_symlink():  # a shell named it with all others: a student may have made it
            return [_source(path.name, path.name, [Entry(path.absolute(), (path.name, LINK))], lab)]
        path = path.resolve(strict=True)
    except FileNotFoundError:
        raise CourseError(f"{path}: no such file or folder") from None
    except (OSError, RuntimeError) as problem:
        raise CourseError(f"{path}: {getattr(problem, 'strerror', problem)}") from None
    below = path.parts[path.parts.index(TREE) + 1 :] if TREE in path.parts else ()
    if not _is_container(path):
        owner = below[0] if len(below) > 1 else path.parent.name if is_lab(path.name, lab) else path.name
        return [_source(owner, path.name, [Entry(path, (path.name,))], lab)]
    name = path.name if path.is_dir() else path.stem
    try:
        entries = _entries(path)
    except CourseError as problem:
        if not several and path.is_dir():
            raise
        return [replace(_source(path.name, path.name, [], lab), problem=str(problem))]  # the others are graded
    if below or is_of_system(path.name):
        return [_source(below[0] if below else path.name, path.name, entries, lab)]
    tree = [_lifted(entry) for entry in entries if len(entry.parts) > 2 and entry.parts[0] == TREE]
    if tree or path.name == TREE:
        return _each(tree or entries, lab, name)
    return _grouped(entries, name, lab, named_by_zip=not path.is_dir(), of_one=several or not path.is_dir())


def _is_container(path):
    return path.is_dir() or (path.suffix.lower() == ".zip" and path.is_file())


def _entries(path):
    return folder_entries(path) if path.is_dir() else zip_entries(Entry(path, (path.name,)))


def _lifted(entry):
    return replace(entry, parts=entry.parts[1:])


def _grouped(entries, name, lab, named_by_zip, of_one):
    """Return the sources among the files of a folder or a zip file; ``of_one``: a file alone in it is named after it."""
    while folder := _only_folder(entries):
        name, of_one = name if named_by_zip or lab_number(folder) else folder, True
        entries = list(map(_lifted, entries))
    folders = {entry.parts[0] for entry in entries if len(entry.parts) > 1}
    files = [entry for entry in entries if len(entry.parts) == 1 and is_handed(entry)]
    if any(map(is_of_system, [*folders, *(entry.name for entry in files)])):
        return _each(entries, lab, name)
    labs = {lab, *(one.name for one in find_labs())}
    work = {entry.parts[0] for entry in entries if is_handed(entry)}
    # one file under the lab's name among others is no sign: it would take the marks of a whole class
    of_labs = work and all(any(is_lab(name, one) for one in labs) for name in work)
    if of_labs or not (files or folders) or (of_one and len(files) <= 1 and not folders):
        return [_source(name, name, entries, lab)]
    return _each(entries, lab, name)


def _only_folder(entries):
    """Return the name of the folder that all is in, where no system named it after a student."""
    first = {entry.parts[0] if len(entry.parts) > 1 else "" for entry in entries}
    name = first.pop() if len(first) == 1 else ""
    return "" if is_of_system(name) else name


def _each(entries, lab, name):
    """Return a source for each folder, and for each file that is a student's work; files of one student go together."""
    groups = defaultdict(list)
    for entry in entries:
        first = entry.parts[0]
        by_system = is_of_system(first)
        if len(entry.parts) > 1 or is_handed(entry) or by_system or entry.suffix in MISTAKEN:
            groups[by_system, student_of(first, lab) if by_system else first].append(entry)
    found = [_source(owner, several[0].parts[0], several, lab) for (_, owner), several in groups.items()]
    words = line_of(
        f"it has the name of the lab, next to other files in {name}. Name it after its student, or, if all these files "
        f"belong to one student, put {name} into a folder {TREE}"
    )
    return [replace(one, problem=one.problem or words) if is_lab(one.name, lab) else one for one in found]


def _source(owner, name, entries, lab):
    problem = next((entry.problem for entry in entries if entry.problem), "")
    return Source(student_of(owner, lab), line_of(name, 120), tuple(entries), problem=problem)


def _with_work(sources):
    """Return sources without those in which no work is, where the same student has work: a text of Moodle's, a PDF."""
    found = [(source, any(map(is_work, source.entries))) for source in sources]
    worked = {source.student for source, works in found if works}
    return [source for source, works in found if works or source.problem or source.student not in worked]


def _told_apart(sources):
    """Return sources whose students are unique."""
    several, taken, found = defaultdict(list), {source.student for source in sources}, []
    for source in sources:
        several[source.student].append(source)
    for source in sources:
        others, student = several[source.student], source.student
        if len(others) > 1:
            ways = " and ".join("/".join(one.entries[0].parts) if one.entries else one.name for one in others[:3])
            words = f"{len(others)} submissions belong to {student}: {ways}; keep one, or give them different names"
            number = 1
            while source is not others[0] and student in taken:
                number += 1
                student = f"{source.student} ({number})"
            taken.add(student)
            source = replace(source, student=student, problem=source.problem or line_of(words))
        found.append(source)
    return found


def read(source, own=()):
    """Return the submission of a source; whatever is wrong with its files is its problem, and nothing is raised.

    Of several notebooks the one is taken that has the lab in its path, that is no copy of the lab as it came, that lies
    highest, and that checks most answers of the lab; where this leaves more than one, it is a problem, and so is a notebook
    that checks answers of another lab and none of this one. Scripts count where there is no notebook.

    Parameters
    ----------
    source : Source
    own : sequence of str
        Code cells of the lab as it was handed out.

    Returns
    -------
    Submission
    """
    name, digest = source.name, ""
    try:
        if source.problem:
            raise CourseError(source.problem)
        entry, raw = chosen(source.entries, source.lab, own)
        name, digest = line_of(entry.name, 120), hashlib.sha256(raw).hexdigest()
        cells = cells_of(entry, raw)
    except CourseError as problem:
        words = line_of(str(problem))
        return Submission(source.student, name, (), digest or hashlib.sha256(words.encode()).hexdigest(), words)
    return Submission(source.student, name, cells, digest)
