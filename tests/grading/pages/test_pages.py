"""Pages of a class: what they say is what the reports hold, whatever those hold, and the same bytes each time."""

import base64
import hashlib
import itertools
import re
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from class_reports import class_of
from page_reader import ATTRIBUTES, TAGS, Page

from hapticlab.course.cards.page_text import clean, file_name
from hapticlab.course.exercise import Case, Exercise, Lab
from hapticlab.course.labs import find_labs
from hapticlab.errors import CourseError
from hapticlab.grading.formats.words import state
from hapticlab.grading.pages.pages import write_pages
from hapticlab.grading.report import ExerciseReport, Failing, Report


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """Pages of a class of 30."""
    reports, lab = class_of("02", 30)
    folder = tmp_path_factory.mktemp("class")
    return SimpleNamespace(reports=reports, lab=lab, folder=folder, paths=write_pages(reports, folder, lab=lab))


def page_of(folder, report):
    return Page(folder / "students" / f"{file_name(report.student)}.html")


def test_every_student_has_a_page_that_tells_the_mark_and_what_is_wrong(written):
    assert len(written.paths) == 31
    for report in written.reports:
        page = page_of(written.folder, report)
        assert f"{report.earned:g} of 10 points" in page.words
        assert report.student in page.words and report.title in page.words
        others = {other.student for other in written.reports} - {report.student}
        assert not [name for name in others if name not in report.student and name in page.words]
        if report.problem:
            assert f"could not be graded: {report.problem}" in page.words
            continue
        went = [f"{one.name} {sign}" for one in report.exercises for sign in SIGNS]
        places = [page.words.rindex(words) for words in went if words in page.words]
        assert len(places) == len(report.exercises) and places == sorted(places)
        for one in report.exercises:
            wrong = state(one) == "wrong"
            if wrong:
                told = page.words.rpartition(f"{one.name} ✗ wrong")[2].partition("The first case that is wrong")[0]
                assert f"{one.right} of {one.cases} cases right wrong: " in told and not re.search(r"expected -?[\dTF]", told)
                assert told.count(" ".join(one.slip.split()) or "likely slip:") == bool(one.slip)
                assert f"hint: {one.hint}" in told or not one.hint
            assert " ".join(one.text.split()) in page.words
        assert ("Cells that failed" in page.words) == bool(report.cells)


SIGNS = ("✓ right", "✗ wrong", "○ no answer", "✎ noted")


def test_every_page_is_well_formed_closed_to_the_world_and_has_one_heading(written):
    for path in written.paths:
        page = Page(path)
        assert set(page.tags) <= TAGS
        assert {name for name, _ in page.attributes} <= ATTRIBUTES
        assert page.tags.count("h1") == 1
        assert not re.search(r"https?:|url\((?!#)|@import", page.source)
        (style,) = re.findall("<style>(.*?)</style>", page.source, re.S)
        allowed = base64.b64encode(hashlib.sha256(style.encode()).digest()).decode()
        (policy,) = (value for _, value in page.attributes if value and value.startswith("default-src"))
        assert policy == f"default-src 'none'; style-src 'sha256-{allowed}'; base-uri 'none'; form-action 'none'"
        assert page.source.count("<svg ") == len(re.findall(r'<svg role="img" aria-label="[^"]{20,}"', page.source))
        assert page.source.count("<table") == page.source.count("<thead>")


def test_every_link_of_the_class_leads_to_a_page(written):
    page = Page(written.folder / "class.html")
    assert len(set(page.links)) == len(written.reports)
    assert all((written.folder / link).is_file() for link in page.links)
    student = page_of(written.folder, written.reports[0])
    assert all(link.startswith("#e") for link in student.links)


def test_the_class_page_counts_what_the_reports_hold(written):
    page = Page(written.folder / "class.html")
    graded = [report for report in written.reports if not report.problem]
    earned = np.array([report.earned for report in graded])
    assert f"30 submissions, {len(graded)} graded. Median {np.median(earned):.3g}, mean {earned.mean():.3g}" in page.words
    assert f"{(earned == 10).sum()} earned all" in page.words
    (told,) = [value for name, value in page.attributes if name == "aria-label" and "by points" in value]
    bands = {points: (earned == points).sum() for points in range(11)}
    assert sum(bands.values()) == len(earned)
    assert told == f"Number of students by points: {', '.join(f'{count} with {at}' for at, count in bands.items() if count)}."
    judged = [[one for one in report.exercises if one.kind not in ("prediction", "text")] for report in graded]
    right = {one.name: 0 for one in judged[0]}
    slips = {}
    for one in itertools.chain(*judged):
        right[one.name] += one.right == one.cases
        if one.slip:
            slips[one.name, one.slip] = slips.get((one.name, one.slip), 0) + 1
    hardest = min(right, key=right.get)
    assert f"Hardest: {hardest} , right in {right[hardest]} of {len(graded)} submissions." in page.words
    assert len(slips) > 4
    told = [page.words.index(f" {count} {name} {' '.join(slip.split())}") for (name, slip), count in slips.items()]
    assert [slips[key] for _, key in sorted(zip(told, slips, strict=True))] == sorted(slips.values(), reverse=True)
    for report in written.reports:
        assert not report.problem or f"{report.student} wall.docx {report.problem}" in page.words
        for one in report.exercises:
            assert not one.ended or f"{report.student} {one.name} {one.words}" in page.words


def test_what_students_wrote_stands_side_by_side_and_is_escaped(tmp_path):
    said = {"ada": "b = 0.1\nI <b>think</b>", "ned": "about 16 %", "zoe": "  "}
    reports = [
        Report(
            name,
            "02",
            "Walls",
            "w",
            exercises=(ExerciseReport("guess", "prediction", "the share [%]", answered=True, text=text),),
        )
        for name, text in said.items()
    ]
    page = Page(write_pages(reports, tmp_path, lab=LAB)[0])
    assert "guess Asked for: the share [%] ada b = 0.1 I <b>think</b> ned about 16 % Could not" in page.words
    assert "b" not in page.tags and "&lt;b&gt;think" in page.source


def test_marks_come_first_and_each_exercise_tells_its_question_and_points(written):
    page = Page(written.folder / "class.html")
    heads = ("Students", "Exercises", "Common mistakes", "Predictions and discussions", "Could not be graded")
    places = [page.source.index(f"<h2>{head}</h2>") for head in heads]
    assert places == sorted(places)
    for one in written.lab.exercises:
        if one.judged:
            assert f"{one.name} {one.points:g} point{'' if one.points == 1 else 's'} Asked for: {one.asks}" in page.words


def test_a_choice_tells_its_options_and_a_right_answer_takes_one_line(tmp_path):
    lab = Lab("02", "Walls", 90, (Exercise("who", "choice", 1, options={"a": "the hand", "b": "the <motor>"}),))
    wrong = ExerciseReport("who", "choice", 'a "letter"', 1.0, answered=True, cases=1, words="not b")
    right = ExerciseReport("k", "value", "the stiffness [N/m]", 1.0, 1.0, answered=True, right=1, cases=1)
    page = Page(write_pages([Report("ada", "02", "Walls", "w", exercises=(wrong, right))], tmp_path, lab=lab)[1])
    assert 'Asked for: a "letter" a: the hand b: the <motor>' in page.words
    assert "the stiffness" not in page.words and page.words.count("k ✓ right") == 2


def test_code_that_ends_with_an_error_gets_no_hint_about_the_physics(tmp_path):
    words = {"math": "it raises NameError in line 7 of its cell: math is not known yet.", "sign": "-2 N, expected 2 N."}
    one = ExerciseReport("wall", "function", points=1.0, answered=True, cases=1, hint="Which of the two frequencies?")
    reports = [Report(name, "02", "Walls", "w", exercises=(replace(one, words=said),)) for name, said in words.items()]
    _, math, sign = map(Page, write_pages(reports, tmp_path, lab=LAB))
    assert "hint:" not in math.words and "math is not known yet" in math.words and "hint: Which of" in sign.words


def test_the_same_reports_give_the_same_bytes_in_whatever_order(written, tmp_path):
    again = write_pages(written.reports[::-1], tmp_path, lab=written.lab)
    assert [path.read_bytes() for path in again] == [path.read_bytes() for path in written.paths]
    assert [path.relative_to(tmp_path) for path in again] == [path.relative_to(written.folder) for path in written.paths]


NAMES = (
    "ada", "Ada", "ADA", "a da", "a/da", "../ada", "ada.", "ada ", "con", "CON", "com1", "aux.txt", "", ".", "..",
    "~root", "\0",
    "<script>", 'x" onload="x', "a" * 39, "a" * 40, "a" * 41, "a" * 3000, "é", "e\u0301", "ß", "ss", "-", "-rf",
    "ada\u202e", "\ud800",
    file_name("Ada"), file_name(file_name("Ada")),
)  # fmt: skip


def test_no_two_students_share_a_page_on_any_file_system(tmp_path):
    names = [file_name(student) for student in NAMES]
    assert len({name.casefold() for name in names}) == len(NAMES)
    assert all(re.fullmatch(r"[a-z0-9][a-z0-9_-]{0,59}", name) and name not in ("con", "com1", "aux") for name in names)
    reports = [Report(student, "02", "Walls", "wall.ipynb") for student in NAMES for _ in range(2)]
    paths = write_pages(reports, tmp_path, lab=Lab("02", "Walls", 90, ()))
    assert len(set(paths)) == 2 * len(NAMES) + 1
    assert len([*(tmp_path / "students").iterdir()]) == 2 * len(NAMES)


TEXTS = (
    "", "<script>alert(1)</script>", '"><img src=x onerror=alert(1)>', "]]></style><svg onload=x>", "&lt;",
    "\x00\x1b[31m\x07\r\n\t",
    "\u202egnp.exe\u2066\u2069\u200b", "\ud800\udfff", "=cmd|' /C calc'!A0", "a" * 100_000, "e" + "\u0301" * 5000,
    "{}%s\\{0}", "زينب",
    "nan", "javascript:alert(1)",
)  # fmt: skip
DEEP = {"a": [[[[[[1.0]]]]]], "b": {"c": {"d": {"e": {"f": 1.0}}}}}
VALUES = (
    None, True, 0.0, -0.0, 1.0, float("nan"), float("inf"), -float("inf"), 1e308, 5e-324, 10**400, "", "nan", "<b>",
    [], {}, [None],
    [1.0], [1.0, 2.0, 3.0], [1e308, -1e308, 1e308], [5e-324, 0.0, 1e-310], [1.0, 1.0, 1.0], [1.0, 1.0 + 2e-16, 1.0],
    ["nan", "inf", "-inf", 1.0], [float("nan")] * 5, [10**400, 1.0, 2.0], [True, False, True], ["<b>", "x", "y"],
    [[1.0, 2.0], [3.0]],
    [[1.0, 2.0], [3.0, 4.0]], [[float(k), -float(k), 1e300 * k] for k in range(9)], [float(k % 7) for k in range(5000)],
    {"<i>": [1.0, 2.0, 3.0], "F": 1.0, "x": "<u>"}, {"curve 1": {"x": [0.0, 1.0, 2.0], "y": [0.0, 2.0, 4.0],
    "x_unit": "<b>"}},
    {"curve 2": {"x": [0.0, 1.0], "y": [1.0]}}, {"x": [1.0, 2.0, 3.0], "y": [1.0, 2.0]}, {"y": "no"}, DEEP, [[[1.0]]], [DEEP],
)  # fmt: skip


def hostile(value, expected, text, kind, given=None):
    given = {text: value, "t": [0.0, 1.0, 2.0], "x": expected, "values": {text: text}} if given is None else given
    failing = Failing(given, value, expected, text, public=False)
    one = ExerciseReport(
        text, kind, text, points=2.0, answered=True, right=0, cases=3, words=text, slip=text, hint=text, ended=text,
        failing=failing,
        printed=text, text=text,
    )  # fmt: skip
    return Report(text, "02", text, text, text, cells=((3, text),), exercises=(one, replace(one, kind="function")))


@pytest.mark.parametrize(
    "value",
    [pytest.param(value, marks=[pytest.mark.wide] * (k % 3 > 0)) for k, value in enumerate(VALUES)],
    ids=lambda value: repr(value)[:20],
)
def test_no_report_however_strange_stops_the_pages_or_gets_out_of_its_text(value, tmp_path):
    begin = [id(one) for one in VALUES].index(id(value)) % 12
    texts = itertools.cycle(TEXTS[begin:] + TEXTS)
    kinds = itertools.cycle(("function", "scene", "value", "expression", "plot", "text"))
    reports = [hostile(value, expected, next(texts), next(kinds)) for expected in VALUES[begin::12]]
    reports += [replace(reports[0], problem=next(texts))]
    lab = Lab("02", "Walls", 90, (Exercise("wall", points=2, asks="<x [<b>]>", cases=(Case({}, 1.0),)),))
    for path in write_pages(reports, tmp_path, lab=lab):
        page = Page(path)
        assert set(page.tags) <= TAGS
        assert {name for name, _ in page.attributes} <= ATTRIBUTES
        assert page.source.isascii() or not [c for c in page.source if c in "\u202e\u2066\u2069\u200b\x1b\x00"]
        assert len(page.source) < 400_000
        drawn = re.findall(r'<path d="([^"]*)"|c[xy]="([^"]*)"', page.source)
        assert not re.search("nan|inf|e", "".join(itertools.chain(*drawn)))


def test_what_is_not_seen_is_shown_and_what_is_long_is_cut():
    assert clean("a\u202eb\x07\tc\n", lines=True) == "a[U+202E]b[U+0007]\tc\n"
    assert clean("a\nb\u00a0c") == "a b c"
    assert clean("x" * 705) == "x" * 700 + " ... (5 characters more)"
    assert clean("e" + "\u0301" * 50) == "e" + "\u0301" * 3
    assert clean("میخواهم\u200cها") == "میخواهم\u200cها"


CURVE = {
    "x": [0.0, 0.005, 0.01, 0.02], "y": [0.0, 1.0, 2.0, 3.0], "x_unit": "m", "y_unit": "N", "x_label": "way [cm]",
    "y_label": "F_e [mN]",
}  # fmt: skip
LAB = Lab("02", "Walls", 90, (
    Exercise("wall", points=2, asks="F [N] at k [N/m]", cases=(Case({}, 1.0),)), Exercise("n", points=2, asks="of b [N s/m]"),
))  # fmt: skip


@pytest.mark.parametrize(
    ("one", "across", "up", "difference"),
    [
        (
            Failing({"t": [0.0, 0.1, 0.2], "k": 1.0}, [1.0, 2.0, 3.5], [1.0, 2.0, 3.0], "N", True),
            "time t [ms]", "wall [N]", "The largest difference is at time t = 200 ms: yours is 3.5, and 3 is expected.",
        ),
        (
            Failing({"x": [0.01, 0.0, -0.01]}, [1.0, 2.0, 3.0], [2e-3, 2.0, 3.0], "m", True),
            "handle position x [mm]", "wall [mm]", "is at handle position x = 10 mm: yours is 1000, and 2 is expected.",
        ),
        (
            Failing({"x": [0.01, 0.0, 0.01]}, [1.0, "nan", 3.0], [1.0, 2.0, 4.0], "N", False),
            "sample", "wall [N]", "at sample 2: yours is 3, and 4 is expected. 1 of your 3 numbers are NaN",
        ),
        (
            Failing({"t": [0.0, 1.0, 2.0]}, [1.0, 2.0], [1.0, 2.0, 4.0], "N", False),
            "time t [ms]", "wall [N]", "You gave 2 numbers; 3 are expected.",
        ),
        (
            Failing({}, {"curve 1": {"x": [0.0, 0.02], "y": [90.0, 90.0], "x_unit": "m", "y_unit": "N"}, "curve 2": CURVE},
                    {"curve 1": {"x": [0.0, 0.01, 0.02], "y": [0.0, 2.0, 4.0], "x_unit": "m", "y_unit": "N"}}, "", False),
            "way [mm]", "F_e [N]", "The largest difference is at way = 20 mm: yours is 3, and 4 is expected.",
        ),
    ],
)  # fmt: skip
def test_a_figure_is_drawn_over_what_was_given(one, across, up, difference, tmp_path):
    exercise = ExerciseReport("wall", "function", "F [N] at k [N/m]", 2.0, answered=True, cases=1, words="w", failing=one)
    report = Report("ada", "02", "Walls", "w", exercises=(exercise,))
    page = Page(write_pages([report], tmp_path, lab=LAB)[1])
    labels = page.source[page.source.index("<figure") :]
    assert f">{across}</text>" in labels and f">{up}</text>" in labels
    assert difference in page.words
    assert f"{up} over {across}." in labels


def test_scalars_stand_in_a_table_with_units_and_what_differs_is_marked(tmp_path):
    failing = Failing({"k": 200.0, "b": 1.5, "T": 1e-3}, {"leak": 0.1 + 0.2, "loss": 2.0}, {"leak": 0.3, "loss": 1.0}, "J", False)
    exercise = ExerciseReport("wall", "function", "F [N] at k [N/m]", 2.0, answered=True, cases=1, words="w", failing=failing)
    page = Page(write_pages([Report("ada", "02", "Walls", "w", exercises=(exercise,))], tmp_path, lab=LAB)[1])
    assert "given value unit k 200 N/m b 1.5 N s/m T 0.001 answer" in page.words, "b by the words of the other exercise"
    assert "leak 0.3 0.3 J loss 2 ≠ 1 J" in page.words
    assert "<figure" not in page.source


@pytest.mark.parametrize(("came", "kind", "units"), [
    (True, "function", ("m", "s")), (False, "function", ("", "")), (False, "scene", ("m", "")),
])  # fmt: skip
def test_units_are_guessed_by_name_in_the_labs_that_came_with_the_package_alone(tmp_path, came, kind, units):
    lab = next(folder.lab() for folder in find_labs() if folder.number == "08")
    lab = lab if came else replace(lab, title="Heights", exercises=LAB.exercises)
    one = ExerciseReport(
        "q", kind, "", 2.0, answered=True, cases=1, words="w", failing=Failing({"x": 2.0, "h": 3.0}, 1, 2, "J", False)
    )
    page = Page(write_pages([Report("ada", "08", "Heights", "w", exercises=(one,))], tmp_path, lab=lab)[1])
    assert f"x 2 {units[0]} h 3 {units[1]} answer".replace("  ", " ") in page.words


def test_the_class_page_tells_of_a_stopped_answer_what_came_and_not_what_was_expected(tmp_path):
    one = ExerciseReport(
        "wall", "function", "", 2.0, answered=True, cases=1, words="-2 N, expected 2 N. It took 9 s", ended="time"
    )
    page = Page(write_pages([Report("ada", "02", "Walls", "w", exercises=(one,))], tmp_path, lab=LAB)[0])
    assert "ada wall -2 N. It took 9 s" in page.words and "expected" not in page.words.split("Stopped:")[1]


def test_of_a_value_the_answer_itself_is_not_told(tmp_path):
    failing = Failing({}, 0.5, None, "N s/m", False)
    exercise = ExerciseReport("damper", "value", "b", 1.0, answered=True, cases=1, words="0.5 N s/m: not yet", failing=failing)
    page = Page(write_pages([Report("ada", "02", "Walls", "w", exercises=(exercise,))], tmp_path, lab=LAB)[1])
    assert "You answered: 0.5" in page.words and "expected" not in page.words


def test_an_answer_in_a_cell_that_failed_is_told_from_none(tmp_path):
    none = (ExerciseReport("wall", "function", points=2.0, cases=1, words="no answer"),)
    failed = (3, "SyntaxError in line 2: invalid syntax")
    as_it_came = (4, "NotImplementedError in line 2"), (5, "TypeError in line 1: 'NoneType' object is not callable")
    cells = {"ada": as_it_came, "ned": (failed, *as_it_came)}
    reports = [Report(name, "02", "Walls", "w", cells=cells[name], exercises=none) for name in cells]
    of_class, ada, ned = map(Page, write_pages(reports, tmp_path, lab=LAB))
    words = "no answer, and a cell failed"
    assert f"wall 2 points right 0 (0 %); wrong 0 (0 %); no answer 1 (50 %); {words} 1 (50 %)" in of_class.words
    assert f"○ no answer; △ {words} student mark wall ada 0 of 2 ○ ned 0 of 2 △ Marks" in of_class.words
    ends = "Could not be graded None: every submission was graded. Stopped: out of time, memory or bounds None."
    assert of_class.words.endswith(f"No known mistake was found. {ends} {FOOT}")
    labels = [value for name, value in of_class.attributes if name == "aria-label"]
    figures = ["Number of students by points: 2 with 0.", f"wall: 0 right, 0 wrong, 1 no answer, 1 {words}"]
    assert labels == ["Marks of all students, exercise by exercise", "no answer", words, *figures]
    assert "Cells failed , and there is no answer: if it is in one of them, that is why." in ned.words
    assert ned.links == ["#e1", "#errors"] and ("id", "errors") in ned.attributes
    assert "there is no answer" not in ada.words


FOOT = "An exercise earns its points where every case is right. Shares are of those graded."


def test_a_class_of_which_nothing_could_be_graded_has_a_page(tmp_path):
    report = Report("ada", "02", "Walls", "w.docx", problem="w.docx is no notebook")
    page = Page(write_pages([report], tmp_path, lab=LAB)[0])
    assert "1 submission, 0 graded." in page.words and "ada w.docx w.docx is no notebook" in page.words
    assert "0 submissions, 0 graded." in Page(write_pages([], tmp_path, lab=LAB)[0]).words


def test_a_folder_that_cannot_be_written_is_named(tmp_path):
    (tmp_path / "file").write_text("here")
    with pytest.raises(CourseError, match="cannot write .*file.*; name a folder of your own"):
        write_pages([], tmp_path / "file", lab=LAB)


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="this system has no disk that is always full")
def test_a_full_disk_is_told_with_the_pages_name(written, tmp_path):
    (tmp_path / "students").mkdir()
    name = f"{file_name(written.reports[0].student)}.html"
    (tmp_path / "students" / name).symlink_to("/dev/full")
    with pytest.raises(CourseError, match=f"cannot write .*students/{name}: No space left on device; name a folder"):
        write_pages(written.reports, tmp_path, lab=written.lab)


def test_students_whose_names_differ_in_capitals_have_pages_that_no_system_takes_for_one(tmp_path):
    reports = [Report(name, "02", "Walls", f"{name}.ipynb") for name in ("ada", "Ada", "ADA", "adA", "Zoë", "ZOË", "con", "CON")]
    paths = write_pages(reports, tmp_path, lab=Lab("02", "Walls", 90, ()))
    assert len({path.name.casefold() for path in paths}) == len(reports) + 1
