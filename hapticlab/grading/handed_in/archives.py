"""Files of a zip file, and of a folder, read within bounds: what strangers packed is never unpacked to a disk."""

import io
import os
import stat
import struct
import zipfile
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path, PurePosixPath

from ...errors import CourseError
from .naming import TREE, WORK, is_junk

MIB = 1 << 20
#: of one zip file in another, which is read as a whole; of a zip file's table of contents
MOST_ZIP, MOST_CONTENTS = 64 * MIB, 8 * MIB
#: folders in one another
DEEPEST = 40
#: what stands for a file's name where a folder holds none, and where a link leads elsewhere
NOTHING, LINK = "nothing", "a link"
#: bits of a member's flags
ENCRYPTED, UTF8 = 0x1, 0x800
#: LZMA allocates what a stranger's header says
METHODS = {zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED}


@dataclass(frozen=True)
class Entry:
    """A file, in a folder or in a zip file.

    Attributes
    ----------
    file : Path
        On the disk.
    parts : tuple of str
        Names of its folders and its own, below what was handed in; never used as a path.
    inside : tuple of int
        Which member it is of the zip file at ``file``, and of the zip file which that member is.
    problem : str
        Why it and what lies beside it cannot be graded.
    """

    file: Path
    parts: tuple
    inside: tuple = ()
    problem: str = ""

    @property
    def name(self):
        """Its own name."""
        return self.parts[-1]

    @property
    def suffix(self):
        """Of its name, in lower case; what a browser adds to a notebook's is none of it."""
        name = self.name.lower().removesuffix(".txt").removesuffix(".json")
        return PurePosixPath(name if name.endswith(".ipynb") else self.name.lower()).suffix


def owner_of(folders):
    """Return the folder that is a student's, if one is: the first, and in nbgrader's tree the one below."""
    return folders[: folders.index(TREE) + 2] if TREE in folders[:2] else folders[:1]


def check_depth(folders):
    """Refuse folders that nest deeper than any work."""
    if len(folders) > DEEPEST:
        raise CourseError(f"{owner_of(folders)[-1]} contains folders nested more than {DEEPEST} deep; hand in the notebook only")


def is_kept(parts):
    """Return whether a file is listed: what lies in a hidden folder only where it may be somebody's work.

    Parameters
    ----------
    parts : tuple of str
        Names of its folders and its own.
    """
    *folders, name = parts
    hidden = name.startswith(".") or any(folder.startswith(".") for folder in folders)
    return not any(map(is_junk, parts)) and (not hidden or name.lower().endswith(WORK))


def zip_entries(entry):
    """Return the files of a zip file, in order.

    Parameters
    ----------
    entry : Entry
        The zip file.

    Raises
    ------
    CourseError
        Where it is none, or holds too much.
    """
    found, folders = [], {}
    with _opened(entry) as file, _zip(file) as archive:
        for number, info in enumerate(archive.infolist()):
            parts = tuple(part for part in _name(info).replace("\\", "/").split("/") if part not in ("", ".", ".."))
            if info.is_dir():
                parts = (*parts, NOTHING)
            elif stat.S_ISLNK(info.external_attr >> 16):
                parts = (*parts, LINK)
            one = _within_depth(Entry(entry.file, parts, (*entry.inside, number)))
            if parts and is_kept(one.parts):
                (folders.setdefault(owner_of(parts[:-1]), one) if info.is_dir() else found.append(one))
    owners = {owner_of(one.parts[:-1]) for one in found}
    found += [one for owner, one in folders.items() if owner and owner not in owners]
    return sorted(found, key=lambda one: one.parts)


def _name(info):
    """Return a member's name; macOS writes UTF-8 without saying so, which zipfile takes for cp437."""
    try:
        return info.filename if info.flag_bits & UTF8 else info.filename.encode("cp437").decode("utf-8")
    except UnicodeError:
        return info.filename


def _within_depth(entry):
    try:
        check_depth(entry.parts[:-1])
        return entry
    except CourseError as problem:
        return replace(entry, parts=(*owner_of(entry.parts[:-1]), NOTHING), problem=str(problem))


def read_entry(entry, most):
    """Return the bytes of a file; one that holds more than ``most`` bytes is refused, and so is what is no plain file."""
    with _opened(entry) as file:
        return _bounded(file, most)


@contextmanager
def _opened(entry):
    """Open a file for reading, through the zip files it is in; whatever goes wrong is a CourseError."""
    try:
        with _plain_file(entry.file) as file, _member(file, entry.inside) as member:
            yield member
    except CourseError as problem:
        raise CourseError(f"{entry.name}: {problem}") from None
    except Exception as problem:  # bytes of a stranger raise a dozen kinds in zipfile and zlib
        raise CourseError(f"{entry.name} cannot be read: {_reason(problem)}; hand it in again") from None


def _reason(problem):
    """The error in words, without the path, which tells a student about the grader's computer."""
    return problem.strerror if isinstance(problem, OSError) and problem.strerror else f"{type(problem).__name__}: {problem}"


@contextmanager
def _plain_file(path):
    # a fifo would wait for somebody who writes, a link may lead to the grader's own files
    if path.is_symlink():
        raise CourseError("it is a link; hand in the file itself")
    flags = os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
    with os.fdopen(os.open(path, flags), "rb") as file:
        if not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
            raise CourseError("it is not a plain file")
        yield file


@contextmanager
def _member(file, inside):
    if not inside:
        yield file
        return
    with _zip(file) as archive:
        info = archive.infolist()[inside[0]]
        if info.flag_bits & ENCRYPTED:
            raise CourseError("it is locked by a password; hand it in without one")
        if info.compress_type not in METHODS:
            raise CourseError("it is compressed in an unusual way; make the zip file again")
        with archive.open(info) as member:
            if len(inside) == 1:
                yield member
                return
            content = io.BytesIO(_bounded(member, MOST_ZIP))
    with _member(content, inside[1:]) as member:
        yield member


def _bounded(file, most):
    content = file.read(most + 1)
    if len(content) > most:
        raise CourseError(f"it is larger than {most / MIB:g} MiB; clear the outputs of the notebook and save it again")
    return content


def _zip(file):
    size = _contents_size(file)
    if size > MOST_CONTENTS:
        raise CourseError(f"its table of contents has {size} bytes, more than any class needs; hand in the notebook only")
    file.seek(0)
    return zipfile.ZipFile(file)


def _contents_size(file):
    """Size that the table of contents claims, which zipfile would read as a whole; APPNOTE 4.3.14 to 4.3.16."""
    length = file.seek(0, os.SEEK_END)
    file.seek(max(0, length - 2**16 - 100))
    tail = file.read()
    end = tail.rfind(b"PK\x05\x06")
    if end < 0 or len(tail) < end + 22:
        raise CourseError("it is not a zip file, or it is incomplete; hand it in again")
    if tail[max(0, end - 20) : end].startswith(b"PK\x06\x07") and end >= 76:
        return struct.unpack_from("<Q", tail, end - 36)[0]
    return struct.unpack_from("<L", tail, end + 12)[0]
