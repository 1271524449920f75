"""Who the students are: a CSV file, as a learning management system exports it, with a row for each."""

import csv
import io
import re
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path

from ...errors import CourseError
from .naming import is_of_system

#: rows of Canvas' gradebook that are of no student
NO_STUDENT = re.compile(r"\s*(points possible.*|muted|manual posting.*)?\s*", re.I)
TEST_STUDENT = re.compile(r"\s*(student, ?test|test student)\s*", re.I)
#: what Canvas and Moodle name a submission by, as naming.student_of returns it: lovelaceada_4242, Ada Lovelace_123456
OF_SYSTEM = re.compile(r"(.+)_(\d+)", re.DOTALL)
#: Canvas' ID, and Moodle's Identifier in any language
NUMBER = re.compile(r"(?:[^\d\s]\D*\s)?(\d+)")
#: a line with which Excel begins a file, to say what stands between its cells
SEPARATOR = re.compile(r"\A\s*sep=.\s*\n", re.IGNORECASE)
#: of letters alone
WORD = re.compile(r"[^\W\d_]{2,}")
#: columns of a student's name
NAMES = ("student", "full_name", "name")


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
        What the column says of people without a submission, and their names.
    alike : tuple of str
        Students who are found in one row, such as Ada and ada: nobody has that row.
    """

    column: str
    rows: dict
    unknown: tuple
    missing: tuple
    alike: tuple = ()


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
        student's id, or begins with the id and an @, without regard to capitals and to spaces around. Where no column holds
        any, submissions are taken to be named by Canvas or Moodle: "lovelaceada_4242" is the row of ID 4242, "Ada
        Lovelace_123456" that of "Participant 123456", or else the only Ada Lovelace, in one column or two. A row of that number
        in which no word is of that name is somebody else's: Moodle numbers groups as it numbers participants.

        Parameters
        ----------
        students : iterable of str

        Returns
        -------
        Matched

        Raises
        ------
        CourseError
            Where no column holds any of them, or two rows are of one student.

        Examples
        --------
        >>> rows = ({"name": "Ada", "email": "ada@uni.edu"}, {"name": "Bob", "email": "bob@uni.edu"})
        >>> matched = Roster("class.csv", {"name": "Name", "email": "Email"}, rows).match(["ADA", "bo"])
        >>> matched.column, matched.unknown, matched.missing
        ('name', ('bo',), ('Bob',))
        """
        students = list(dict.fromkeys(students))
        found = self._found(students)
        column = max(found, key=lambda name: len(found[name]), default=None)
        if column is None or (students and not found[column]):
            some = ", ".join(map(repr, students[:3]))
            raise CourseError(
                f"{self.path}: none of its columns {self.told()} contains the id of a student, such as {some}; the names of "
                "submissions must appear in a column"
            )
        rows = {}
        for student, several in found[column].items():
            if len(several) > 1:
                raise CourseError(f"{self.path}: {len(several)} rows of {self.columns[column]} are {student!r}; it needs one")
            rows[student] = self.rows[several[0]]
        owners = defaultdict(list)
        for student, several in found[column].items():
            owners[several[0]].append(student)
        alike = tuple(student for sharing in owners.values() if len(sharing) > 1 for student in sharing)
        rows = {student: row for student, row in rows.items() if student not in alike}
        missing = tuple(_told(row, column) for number, row in enumerate(self.rows) if number not in owners)
        return Matched(column, rows, tuple(one for one in students if one not in {*rows, *alike}), missing, alike)

    def rows_of(self, students):
        """Return student to row, without those who have none."""
        return self.match(students).rows

    def told(self):
        """Return the names of the columns, as they are in the file."""
        return ", ".join(map(repr, self.columns.values()))

    def _found(self, students):
        """Return, for each column, student to the numbers of the rows whose cell is that student's."""
        found = _looked_up(self._cells(_keys), {student: _key(student) for student in students})
        if any(found.values()):
            return found
        parts = {one: OF_SYSTEM.fullmatch(one) for one in students if not is_of_system(one)}
        numbers = _looked_up(self._cells(_numbers), {one: part[2].lstrip("0") for one, part in parts.items() if part})
        numbers = {column: {one: [row for row in rows if self._is_called(row, parts[one][1])] for one, rows in held.items()}
                   for column, held in numbers.items()}  # fmt: skip
        numbers = {column: {one: rows for one, rows in held.items() if rows} for column, held in numbers.items()}
        names = _looked_up(self._cells(_names), {one: _key(part[1]) for one, part in parts.items() if part})
        only = {column: {one: rows for one, rows in held.items() if len(rows) == 1} for column, held in names.items()}
        return max(numbers, only, key=lambda several: max(map(len, several.values()), default=0))

    def _is_called(self, number, name):
        """Return whether a word of a row is in a name, or the row has no words."""
        cells = [cell for cell in self.rows[number].values() if "@" not in cell]
        words = {word for cell in cells for word in WORD.findall(cell.casefold())}
        return not words or any(word in name.casefold() for word in words)

    def _cells(self, called):
        """Return, for each column, what a cell may be called to the numbers of its rows."""
        held = {column: defaultdict(list) for column in self.columns}
        for number, row in enumerate(self.rows):
            cells = [row[column] for column in self.columns]
            for place, column in enumerate(self.columns):
                for key in dict.fromkeys(called(cells, place)):
                    if key:
                        held[column][key].append(number)
        return held


def _looked_up(held, keys):
    return {column: {one: cells[key] for one, key in keys.items() if key in cells} for column, cells in held.items()}


def _keys(cells, place):
    whole = _key(cells[place])
    return whole, whole.partition("@")[0]


def _numbers(cells, place):
    found = NUMBER.fullmatch(cells[place].strip())
    return [found[1].lstrip("0")] if found else []


def _names(cells, place):
    """Return a name in a column, and a first and a last name in two beside each other."""
    first, *last = map(_key, cells[place : place + 2])
    return [first, *(name for one in last if first and one for name in (f"{first} {one}", f"{one} {first}"))]


def _told(row, column):
    """Return whose row it is, by the column that submissions are named by, and by name."""
    parts = [row[key].strip() for key in ("first_name", "last_name", "surname") if key in row]
    name = next((row[key].strip() for key in NAMES if row.get(key)), " ".join(parts))
    return f"{row[column]} ({name})" if name and column not in NAMES else name or row[column]


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
        raise CourseError(f"{path} is not a text in UTF-8; save it as CSV UTF-8") from None
    text = SEPARATOR.sub("", text)
    first = text.partition("\n")[0]
    separator = max(",;\t", key=first.count)
    try:
        head, *rows = csv.reader(io.StringIO(text, newline=""), delimiter=separator, strict=True)
    except (ValueError, csv.Error) as problem:
        raise CourseError(f"{path} is not a CSV file whose first row has the names of the columns: {problem}") from None
    columns = {re.sub(r"\W+", "_", name.strip().casefold()).strip("_"): name.strip() for name in head}
    if len(columns) != len(head) or "" in columns:
        raise CourseError(f"{path}: the first row is {head}; it needs a different name for each column")
    people = [[*row, *[""] * len(head)] for row in rows if not all(NO_STUDENT.fullmatch(cell) for cell in row[:5])]
    found = (dict(zip(columns, row, strict=False)) for row in people)
    return Roster(str(path), columns, tuple(row for row in found if not TEST_STUDENT.fullmatch(row.get("student", ""))))
