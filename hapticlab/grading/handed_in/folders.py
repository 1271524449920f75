"""Files of a folder, listed within bounds: a part that cannot be listed is a problem of its student, never the end of a class."""

import itertools
import os
from collections import Counter, defaultdict
from pathlib import Path

from ...errors import CourseError
from .archives import LINK, NOTHING, Entry, check_depth, is_kept, owner_of
from .naming import is_junk
from .replies import line_of

#: files of a class that lie in no student's folder; files and folders of one student
MOST_FILES, MOST_OF_ONE = 100_000, 20_000


def folder_entries(folder):
    """Return the files of a folder, those of each folder in order; no link is followed.

    A folder without files has one entry, named "nothing", and a link to a folder one named "a link". A student's folder that
    cannot be read, nests too deep or holds too many files has one entry, with a problem.

    Parameters
    ----------
    folder : str or Path

    Raises
    ------
    CourseError
        If the folder itself cannot be read, or holds too many files outside the students' folders.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     _ = Path(folder, "ada.py").write_text("k = 150"), Path(folder, "bob").mkdir()
    ...     [entry.parts for entry in folder_entries(folder)]
    [('ada.py',), ('bob', 'nothing')]
    """
    found, counts, refused, left = defaultdict(list), Counter(), set(), [(Path(folder), ())]
    while left:  # a function that calls itself would end where folders nest deeper than calls may
        place, parts = left.pop()
        owner = owner_of(parts)
        if owner in refused:
            continue
        try:
            entries, folders, count = _listed(place, parts, (MOST_OF_ONE if owner else MOST_FILES) - counts[owner])
        except CourseError as problem:
            if not owner:
                raise
            refused.add(owner)
            found[owner] = [Entry(place, (*owner, NOTHING), problem=str(problem))]
            continue
        counts[owner] += count
        found[owner] += entries
        left += [(place / name, (*parts, name)) for name in reversed(folders)]
    return [entry for entries in found.values() for entry in entries]


def _listed(place, parts, room):
    """Return the entries of a folder's own files, the names of its folders, and the number of both."""
    told = line_of("/".join(parts), 100) or place
    check_depth(parts)
    try:
        with os.scandir(place) as several:
            there = sorted(itertools.islice(several, room + 1), key=lambda one: one.name)
        folders = [one.name for one in there if one.is_dir(follow_symlinks=False)]
    except OSError as problem:
        words = f"{told} cannot be read: {problem.strerror}; change its permissions, or ask for the notebook again"
        raise CourseError(words) from None
    if len(there) > room and not parts:
        raise CourseError(f"{told} contains more than {MOST_FILES} files; give the folder of the submissions")
    if len(there) > room:
        raise CourseError(f"{owner_of(parts)[-1]} contains more than {MOST_OF_ONE} files; hand in the notebook only")
    names = [(*parts, one.name, LINK) if _leads_away(one) else (*parts, one.name) for one in there if one.name not in folders]
    kept, inner = [name for name in names if is_kept(name)], [name for name in folders if not is_junk(name)]
    if parts and not kept and not inner and is_kept((*parts, NOTHING)):
        kept = [(*parts, NOTHING)]
    return [Entry(place / name[len(parts)], name) for name in kept], inner, len(there)


def _leads_away(one):
    """Whether it is a link to a folder, or to nothing; a link to a file is refused where it is opened."""
    try:
        return one.is_symlink() and not one.is_file()
    except OSError:  # such as links in a circle
        return True
