"""Who the students are: a CSV file, as a learning management system exports it, with a row for each."""

import csv
import io
import re
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from ..errors import CourseError

#: rows of Canvas' gradebook that are of no student
NO_STUDENT = re.compile(r"\s*(points possible.*|muted|manual posting.*)?\s*", re.I)


@dataclass(frozen=True)
class Matched:
    """Which row is whose.

    Attributes
    ----------
    column : str
        By which they were matched.
    rows : dict of str to dict
        Student to row.
    unknown : tuple of str
        Students without a row.
    missing : tuple of str
        What the column says of rows without a submission.
    """

    column: str
    rows: dict
    unknown: tuple
    missing: tuple


@dataclass(frozen=True)
class Roster:
    """Rows of a file; columns are named in small letters with underscores: "SIS User ID" is ``sis_user_id``.

    Attributes
    ----------
    path : str
        For errors.
    columns : dict of str to str
        Such a name to the one in the file.
    rows : tuple of dict
    """

    path: str
    columns: dict
    rows: tuple

    def match(self, students):
        """Match the students of submissions to rows.

        Taken is the column in which most of them are found, of equal ones the first. A cell is a student's where it is the
        student's id, or begins with the id and an @, without regard to capitals and to spaces around.

        Parameters
        ----------
        students : iterable of str

        Returns
        -------
        Matched

        Raises
        ------
        CourseError
            Where no column holds any of them, or two rows are of one student, or two students of one row.

        Examples
        --------
        >>> rows = ({"name": "Ada", "email": "ada@uni.edu"}, {"name": "Bob", "email": "bob@uni.edu"})
        >>> matched = Roster("class.csv", {"name": "Name", "email": "Email"}, rows).match(["ADA", "bo"])
        >>> matched.column, matched.unknown, matched.missing
        ('name', ('bo',), ('Bob',))
        """
        students = list(dict.fromkeys(students))
        found = {column: self._found(column, students) for column in self.columns}
        column = max(found, key=lambda name: len(found[name]), default=None)
        if column is None or (students and not found[column]):
            some = ", ".join(map(repr, students[:3]))
            raise CourseError(
                f"{self.path}: none of its columns {self.told()} holds a student's id, such as {some}; submissions must be named "
                "by what a column holds"
            )
        rows = {}
        for student, several in found[column].items():
            if len(several) > 1:
                raise CourseError(f"{self.path}: {len(several)} rows of {self.columns[column]} are {student!r}; it needs one")
            rows[student] = self.rows[several[0]]
        taken = {several[0]: student for student, several in found[column].items()}
        alike = [one for one, several in found[column].items() if taken[several[0]] != one]
        if alike:
            raise CourseError(f"{alike[0]!r} and {taken[found[column][alike[0]][0]]!r} are one row of {self.path}; rename one")
        missing = tuple(row[column] for number, row in enumerate(self.rows) if number not in taken)
        return Matched(column, rows, tuple(one for one in students if one not in rows), missing)

    def rows_of(self, students):
        """Return student to row, without those who have none."""
        return self.match(students).rows

    def told(self):
        """Return the names of the columns, as they are in the file."""
        return ", ".join(map(repr, self.columns.values()))

    def _found(self, column, students):
        """Return student to the numbers of the rows whose cell in a column is that student's."""
        cells = self._cells[column]
        return {student: cells[_key(student)] for student in students if _key(student) in cells}

    @cached_property
    def _cells(self):
        """For each column: what a cell may be called to the numbers of its rows."""
        held = {column: {} for column in self.columns}
        for number, row in enumerate(self.rows):
            for column in self.columns:
                whole = _key(row[column])
                for key in dict.fromkeys((whole, whole.partition("@")[0])):
                    if key:
                        held[column].setdefault(key, []).append(number)
        return held


def _key(text):
    return text.strip().casefold()


def read_roster(path):
    """Return the roster of a CSV file, its cells separated by commas, semicolons or tabs.

    Parameters
    ----------
    path : str or Path

    Returns
    -------
    Roster
    """
    try:
        content = Path(path).read_bytes()
        text = content.decode("utf-16" if content[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig")
    except OSError as problem:
        raise CourseError(f"{path}: {problem.strerror or problem}; a roster is a CSV file with a row for each student") from None
    except UnicodeError:
        raise CourseError(f"{path} is no text in UTF-8; save it as CSV UTF-8") from None
    first = text.partition("\n")[0]
    separator = max(",;\t", key=first.count)
    try:
        head, *rows = csv.reader(io.StringIO(text, newline=""), delimiter=separator, strict=True)
    except (ValueError, csv.Error) as problem:
        raise CourseError(f"{path} is no CSV file with a row of names first: {problem}") from None
    columns = {re.sub(r"\W+", "_", name.strip().casefold()).strip("_"): name.strip() for name in head}
    if len(columns) != len(head) or "" in columns:
        raise CourseError(f"{path}: the first row is {head}; it needs a name for each column, no two alike")
    people = [[*row, *[""] * len(head)] for row in rows if not all(NO_STUDENT.fullmatch(cell) for cell in row[:5])]
    return Roster(str(path), columns, tuple(dict(zip(columns, row, strict=False)) for row in people))
