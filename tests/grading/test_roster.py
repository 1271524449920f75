"""Who is in the class, as other systems write it."""

import pytest

from hapticlab.errors import CourseError
from hapticlab.grading.roster import read_roster


def roster(tmp_path, text, encoding="utf-8"):
    path = tmp_path / "class.csv"
    path.write_bytes(text.encode(encoding))
    return read_roster(path)


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
@pytest.mark.parametrize("separator", [",", ";", "\t"])
def test_a_spreadsheets_file_is_read(tmp_path, encoding, separator):
    lines = [["Family name", "E-Mail"], ['"Müller, Änne"', "am7@uni.edu"], ["Ng", "ng@uni.edu"]]
    found = roster(tmp_path, "\r\n".join(separator.join(line) for line in lines) + "\r\n", encoding)
    assert found.columns == {"family_name": "Family name", "e_mail": "E-Mail"}
    assert [row["family_name"] for row in found.rows] == ["Müller, Änne", "Ng"]
    assert found.match(["am7"]).rows["am7"]["family_name"] == "Müller, Änne"


def test_the_column_that_holds_most_students_counts(tmp_path):
    found = roster(tmp_path, "Name,Login,Number\nada,al1, 17\nbob,BB2,18\nal1,zz9,19\n").match(["al1", "bb2", "17", "nobody"])
    assert (found.column, found.rows["bb2"]["name"]) == ("login", "bob")
    assert found.unknown == ("17", "nobody")
    assert found.missing == ("zz9",)


def test_an_address_is_found_by_what_stands_before_its_at(tmp_path):
    found = roster(tmp_path, "Email address,ID\nAda.L@uni.edu,5\nada@uni.edu,6\n").match(["ada", "ada.l@uni.edu"])
    assert {student: row["id"] for student, row in found.rows.items()} == {"ada": "6", "ada.l@uni.edu": "5"}


def test_rows_of_nobody_are_left_out(tmp_path):
    found = roster(tmp_path, "Student,ID\n    Points Possible,\n,\n,Manual Posting\n\nAda,1\n")
    assert [row["student"] for row in found.rows] == ["Ada"]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("Login\nada\nAda \n", "2 rows of Login are 'ada'"),
        ("Login\nbob\n", "none of its columns 'Login' holds a student's id, such as 'ada'"),
        ("Login,login\nada,1\n", "no two alike"),
        ("Login,\nada,1\n", "a name for each column"),
        ("", "no CSV file with a row of names first"),
        ('Login\n"ada\n', "no CSV file"),
    ],
)
def test_a_roster_that_leaves_doubt_is_refused(tmp_path, text, words):
    with pytest.raises(CourseError, match=words):
        roster(tmp_path, text).match(["ada"])


def test_two_students_of_one_row_are_refused(tmp_path):
    with pytest.raises(CourseError, match="'ada' and 'ADA' are one row"):
        roster(tmp_path, "Login\nada\n").match(["ada", "ADA"])


def test_a_file_that_is_none_is_refused(tmp_path):
    with pytest.raises(CourseError, match="No such file"):
        read_roster(tmp_path / "class.csv")
    with pytest.raises(CourseError, match="save it as CSV UTF-8"):
        roster(tmp_path, "Name\nMüller\n", "latin-1")
