"""Who is in the class, as other systems write it."""

import pytest

from hapticlab.errors import CourseError
from hapticlab.grading.handed_in.roster import read_roster


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
    assert found.missing == ("zz9 (al1)",)


CANVAS = """Student,ID,SIS User ID,SIS Login ID,Section,Lab 02 (5511)
    Points Possible,,,,,10
"Lovelace, Ada",4242,s1,alovelace,A,4243
"de Vries, Bob",4243,s2,bvries,A,
"Ng, Cleo",4244,s3,cng,A,3
"Student, Test",4245,,abcdef,A,
"""
MOODLE = """Kennung,"Full name","Email address",Grade
Teilnehmer/in 123456,Ada Lovelace,ada@x.org,
Teilnehmer/in 123457,Bob de Vries,bob@x.org,123456
Teilnehmer/in 123499,Zed Absent,zed@x.org,
"""
PEOPLE = """Nachname,Vorname,Email address
Lovelace,Ada,ada@x.org
de Vries,Bob,bob@x.org
Ng,Cleo,cleo@x.org
Ng,Cleo,cleo2@x.org
"""


def test_canvas_own_names_are_found_by_its_own_ids(tmp_path):
    found = roster(tmp_path, CANVAS).match(["lovelaceada_4242", "devriesbob_4243", "studenttest_4245"])
    assert {student: row["sis_login_id"] for student, row in found.rows.items()} == {
        "lovelaceada_4242": "alovelace",
        "devriesbob_4243": "bvries",
    }
    assert (found.unknown, found.missing) == (("studenttest_4245",), ("4244 (Ng, Cleo)",))


def test_who_is_missing_is_told_by_name(tmp_path):
    found = roster(tmp_path, CANVAS).match(["alovelace"])
    assert found.missing == ("bvries (de Vries, Bob)", "cng (Ng, Cleo)")
    assert roster(tmp_path, MOODLE).match(["ada"]).missing == ("bob@x.org (Bob de Vries)", "zed@x.org (Zed Absent)")
    assert roster(tmp_path, MOODLE).match(["ada lovelace"]).missing == ("Bob de Vries", "Zed Absent")
    people = "First name,Surname,Login\nAda,Lovelace,al\nCleo,Ng,cn\n"
    assert roster(tmp_path, people).match(["al"]).missing == ("cn (Cleo Ng)",)


def test_moodles_own_names_are_found_by_participant_or_by_name(tmp_path):
    students = ["Ada Lovelace_123456", "Bob de Vries_123457"]
    for text in (MOODLE, PEOPLE):
        rows = roster(tmp_path, text).match(students).rows
        assert [rows[student]["email_address"] for student in students] == ["ada@x.org", "bob@x.org"]


def test_a_name_that_two_have_is_nobodys(tmp_path):
    found = roster(tmp_path, PEOPLE).match(["Ada Lovelace_1", "Cleo Ng_2"])
    assert (list(found.rows), found.unknown) == (["Ada Lovelace_1"], ("Cleo Ng_2",))


def test_numbers_of_submissions_are_nobodys(tmp_path):
    for students in (["submission_4242"], ["4242_x"], ["ada_42"]):
        with pytest.raises(CourseError, match="none of its columns"):
            roster(tmp_path, CANVAS).match(students)
    assert roster(tmp_path, CANVAS).match(["cng", "x_4242"]).unknown == ("x_4242",)


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
        ("Login\nbob\n", "none of its columns 'Login' contains the id of a student, such as 'ada';"),
        ("Login,login\nada,1\n", "it needs a different name for each column"),
        ("Login,\nada,1\n", "it needs a different name for each column"),
        ("", "not a CSV file whose first row has the names of the columns: "),
        ('Login\n"ada\n', "not a CSV file whose first row has the names of the columns: "),
    ],
)
def test_a_roster_that_leaves_doubt_is_refused(tmp_path, text, words):
    with pytest.raises(CourseError, match=words):
        roster(tmp_path, text).match(["ada"])


def test_two_students_of_one_row_have_no_row_and_stop_nobody_else(tmp_path):
    found = roster(tmp_path, "Login\nada\nbob\ncy\n").match(["ada", "ADA", "bob"])
    assert (list(found.rows), found.alike, found.unknown, found.missing) == (["bob"], ("ada", "ADA"), (), ("cy",))


def test_the_number_of_a_group_is_nobodys_id(tmp_path):
    """Moodle names a group's work by the group and its number, which may be that of somebody's participation."""
    found = roster(tmp_path, MOODLE).match(["Red team_123456", "Bob de Vries_123457"])
    assert (list(found.rows), found.unknown) == (["Bob de Vries_123457"], ("Red team_123456",))
    hidden = roster(tmp_path, "Identifier,Grade\nParticipant 7,\nParticipant 8,\n").match(["Participant_7"])
    assert hidden.rows["Participant_7"]["identifier"] == "Participant 7"
    assert roster(tmp_path, "ID,Grade\n4242,\n4243,\n").match(["lovelaceada_4242"]).rows["lovelaceada_4242"]["id"] == "4242"


def test_excels_line_on_its_separator_is_no_row(tmp_path):
    found = roster(tmp_path, "sep=;\r\nLogin;Name\r\nada;Lovelace, Ada\r\n")
    assert [row["name"] for row in found.rows] == ["Lovelace, Ada"]


def test_a_file_that_is_none_is_refused(tmp_path):
    with pytest.raises(CourseError, match="No such file"):
        read_roster(tmp_path / "class.csv")
    with pytest.raises(CourseError, match="save it as CSV UTF-8"):
        roster(tmp_path, "Name\nMüller\n", "latin-1")
