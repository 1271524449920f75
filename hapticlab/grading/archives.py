"""Files of a folder or of a zip file, listed and read within bounds: what strangers packed is never unpacked to a disk."""

import io
import itertools
import os
import re
import stat
import struct
import zipfile
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from ..errors import CourseError
from .naming import TREE, WORK

MIB = 1 << 20
#: of a class; of one student; of one zip file in another, which is read as a whole; of a zip file's table of contents
MOST_FILES, MOST_OF_ONE, MOST_ZIP, MOST_CONTENTS = 100_000, 20_000, 64 * MIB, 8 * MIB
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


def folder_entries(folder):
    """Return the files of a folder, in order; no link is followed.

    Of a folder in it that holds too many files there is one entry, with a problem: the others' are as they are.
    """
    found = []
    for owner, entries in itertools.groupby(_files_below(folder), key=_owner):
        most = MOST_OF_ONE if owner else MOST_FILES
        several = list(itertools.islice(entries, most + 1))
        if owner and len(several) > most:
            words = f"{owner[-1]} holds more than {most} files; hand in the notebook alone"
            several = [Entry(several[0].file, (*owner, several[0].name), problem=words)]
        found += several
        if len(found) > MOST_FILES:
            raise CourseError(f"{folder} holds more than {MOST_FILES} files; name the folder of the submissions")
    return found


def _files_below(folder):
    for place, folders, names in os.walk(folder):
        folders[:] = sorted(name for name in folders if not _is_junk(name))
        inside = Path(place).relative_to(folder).parts
        yield from (Entry(Path(place, name), (*inside, name)) for name in sorted(names) if not _is_junk_file(name))


def _owner(entry):
    """Return the folder that is a student's, if one is: the first, and in nbgrader's tree the one below."""
    folders = entry.parts[:-1]
    return folders[: folders.index(TREE) + 2] if TREE in folders[:2] else folders[:1]


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
    with _opened(entry) as file, _zip(file) as archive:
        infos = archive.infolist()
        found = []
        for number, info in enumerate(infos):
            parts = tuple(part for part in info.filename.replace("\\", "/").split("/") if part not in ("", ".", ".."))
            if not parts or info.is_dir() or _is_link(info) or any(map(_is_junk, parts[:-1])) or _is_junk_file(parts[-1]):
                continue
            found.append(Entry(entry.file, parts, (*entry.inside, number)))
    return sorted(found, key=lambda one: one.parts)


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
        raise CourseError(f"{entry.name} cannot be read: {type(problem).__name__}: {problem}") from None


@contextmanager
def _plain_file(path):
    # a fifo would wait for somebody who writes, a link may lead to the grader's own files
    if path.is_symlink():
        raise CourseError("it is a link; hand in the file itself")
    flags = os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
    with os.fdopen(os.open(path, flags), "rb") as file:
        if not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
            raise CourseError("it is no plain file")
        yield file


@contextmanager
def _member(file, inside):
    if not inside:
        yield file
        return
    with _zip(file) as archive:
        info = archive.infolist()[inside[0]]
        if info.compress_type not in METHODS:
            raise CourseError("it is compressed in an unusual way; make the zip file anew")
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
        raise CourseError(
            f"its table of contents has {size} bytes, more than any class needs; hand in the notebook alone"
        )
    file.seek(0)
    return zipfile.ZipFile(file)


def _contents_size(file):
    """Return how large the table of contents says it is, which zipfile would read as a whole; APPNOTE 4.3.14 to 4.3.16."""
    length = file.seek(0, os.SEEK_END)
    file.seek(max(0, length - 2**16 - 100))
    tail = file.read()
    end = tail.rfind(b"PK\x05\x06")
    if end < 0 or len(tail) < end + 22:
        raise CourseError("it is no zip file, or was cut off; hand it in anew")
    if tail[max(0, end - 20) : end].startswith(b"PK\x06\x07") and end >= 76:
        return struct.unpack_from("<Q", tail, end - 36)[0]
    return struct.unpack_from("<L", tail, end + 12)[0]


def _is_link(info):
    return stat.S_ISLNK(info.external_attr >> 16)


def _is_junk(name):
    """Whether Jupyter, Python or a file manager made it."""
    return name.startswith((".", "__"))


def _is_junk_file(name):
    """Whether it is junk; a notebook that somebody's dot hides is none, so that it can be named."""
    hidden = re.match(r"\.[^._~]", name) and PurePosixPath(name).suffix.lower() in WORK
    return _is_junk(name) and not hidden
