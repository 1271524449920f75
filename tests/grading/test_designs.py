"""A class of designs: graded end to end, measured by the grader alone, and shown to the class without names."""

import re
from dataclasses import replace

import pytest
from attacks.small_lab import notebook
from page_reader import Page

from hapticlab.course import design_answer
from hapticlab.course.exercise import Case
from hapticlab.grading.assignment import find_assignment
from hapticlab.grading.formats import write
from hapticlab.grading.formats.words import for_student, state
from hapticlab.grading.pages.fronts import class_fronts
from hapticlab.grading.pages.pages import write_pages
from hapticlab.grading.report import ExerciseReport, Failing, Report
from hapticlab.grading.run import run
from hapticlab.grading.sessions.limits import Limits

CHECKS = """
from hapticlab.course.exercise import Case, Exercise, Lab

LAB = Lab("43", "A budget", 10, (
    Exercise("design", "design", points=3, full=2, asks="a design of the wall", cases=(
        Case({"task": "wall"}, {"A": [0.3, 40.0, 0.2], "B": [0.4, 36.0, 0.0], "C": [0.2, 60.0, 0.2]}),)),
))
"""
GOOD = {"T": 1e-3, "law": "half_sample", "velocity": "filtered", "tau": 2e-3}
SOLUTION = f"""
design = {GOOD}
design_points = {{
    "A": {{"T": 1e-3, "law": "zoh", "velocity": "kalman"}},
    "B": {{"T": 7.5e-4, "law": "half_sample", "velocity": "backward"}},
    "C": {{"T": 2e-3, "law": "zoh", "velocity": "filtered", "tau": 2e-3}},
}}
"""
HIDDEN = """
def cases(random):
    return {"design": lambda: [{"task": "wall", "K": 450.0, "B": 2.4}, {"task": "wall", "K": 380.0, "B": 1.5}]}
"""
#: student to the code of the answer and the points that it earns
CLASS = {
    "ada": (f"design = {GOOD}", 3.0),
    "blaise": ("design = {'T': 1e-3, 'law': 'zoh', 'velocity': 'backward'}", 1.5),
    "carl": ("design = {'T': 2e-3, 'law': 'zoh', 'velocity': 'backward'}", 0.0),
    "nan": ("design = {'T': float('nan'), 'law': 'zoh', 'velocity': 'backward'}", 0.0),
    # measures, judges and patches in its own process, where nothing counts
    "forger": (
        "from hapticlab.analysis.budget import measured as m\nfrom hapticlab.course import design_answer as d, judge as j\n"
        "m._figures = lambda *_: (0, 0, 0, 9, '')\nd.share = lambda *_: 1.0\n"
        "j.judge = lambda *_: j.Verdict(True, '', share=1.0)\n"
        "design = {'T': 2e-3, 'law': 'zoh', 'velocity': 'backward'}",
        0.0,
    ),
    "boaster": ("design = {'error': 0.0, 'load': 0.0, 'margin': 9.0}", 0.0),
    # another design each time that it is read, and one for each scene that a spy could be told of
    "turncoat": (
        "class Turn(dict):\n    asked = 0\n    def items(self):\n        Turn.asked += 1\n"
        f"        return ({GOOD} if Turn.asked > 1 else {{'T': 9.0}}).items()\ndesign = Turn(T=1)",
        0.0,
    ),
    "spy": (
        "import sys\nclass Spy(dict):\n    def items(self):\n        frame = sys._getframe()\n"
        "        while 'request' not in frame.f_locals:\n"
        "            frame = frame.f_back\n        told = frame.f_locals['request']['givens']\n"
        f"        return {{**{GOOD}, 'law': str(told)}}.items()\ndesign = Spy(T=1)",
        0.0,
    ),
    "none": ("design = None", 0.0),
}


@pytest.fixture(scope="module")
def graded(tmp_path_factory):
    """Return the reports of the class and its assignment."""
    place = tmp_path_factory.mktemp("budget")
    lab, answers, handed_in = place / "43_budget", place / "answers" / "43_budget", place / "submissions"
    for folder in (lab, answers, handed_in):
        folder.mkdir(parents=True)
    (lab / "checks.py").write_text(CHECKS, "utf-8")
    (lab / "43_budget.ipynb").write_bytes(notebook(["import hapticlab as hl", "design = None"]))
    (answers / "solution.py").write_text(SOLUTION, "utf-8")
    (answers / "hidden.py").write_text(HIDDEN, "utf-8")
    for student, (code, _) in CLASS.items():
        (handed_in / f"{student}.ipynb").write_bytes(notebook(["import hapticlab as hl", code]))
    assignment = find_assignment(lab, answers.parent, seed=3)
    return run([handed_in], assignment, Limits(seconds=10.0)), assignment


@pytest.mark.wide
def test_designs_earn_what_they_reach_whatever_their_code_does(graded):
    reports = {report.student: report for report in graded[0].reports}
    assert {name: reports[name].earned for name in CLASS} == {name: points for name, (_, points) in CLASS.items()}
    assert "law is '[{}, {}]'" in reports["spy"].exercises[0].words, "no session is told the scenes"


@pytest.mark.parametrize(("earned", "word"), [(3.0, "right"), (1.5, "partly"), (0.0, "wrong")])
def test_part_of_the_points_is_told_from_wrong(earned, word):
    one = ExerciseReport("design", "design", points=3.0, earned=earned, answered=True, words="it misses A", cases=2)
    report = Report("ada", "43", "A budget", "ada.ipynb", exercises=(one,))
    assert f"  {word:<10} design (3)" in write("text", [report])
    assert state(one) == word and Report.from_json(report.to_json()) == report
    hidden = replace(one, failing=Failing({"task": "wall", "K": 450.0}, {"T": 1e-3}, None, "", public=False))
    assert "450" not in for_student(hidden) and ("right" == word or "too few reference points" in for_student(hidden))


@pytest.mark.parametrize("design", [{**GOOD, "law": 'Ada\'s "zoh" is mine; it needs'}, {**GOOD, "Ada is not chosen in": 1}])
def test_class_page_does_not_repeat_what_a_student_wrote(design):
    row = {**design_answer.row(Case({"task": "wall"}, {"A": [0.3, 40.0, 0.2]}), design), "public": True}
    one = ExerciseReport("design", "design", points=3.0, answered=True, designs=(row,))
    ((why, count),) = class_fronts([Report("ada", "43", "A budget", "ada.ipynb", exercises=(one,))])[0]["failed"]
    assert "Ada" in row["why"] and "Ada" not in why and count == 1 and why.endswith(row["why"][-30:])


@pytest.mark.wide
def test_class_page_of_designs_names_nobody_and_has_every_number(graded, tmp_path):
    reports, assignment = graded[0].reports, graded[1]
    write_pages(reports, tmp_path, lab=assignment.lab)
    page, text = Page(tmp_path / "fronts.html"), (tmp_path / "fronts.html").read_text("utf-8")
    assert not [name for name in CLASS if re.search(rf"\b{name}\b", text.replace("none", ""))]
    assert 'href="fronts.html"' in (tmp_path / "class.html").read_text("utf-8")
    for report in reports:
        for row in (row for one in report.exercises for row in one.designs if row["public"] and row["figures"]):
            assert "{:g} % {:g} % {:g} N s/m".format(*row["figures"]) in page.words
    assert "4 feasible designs" in text and "0.3 % 40 % 0.2 N s/m" in page.words
    assert "T is not a finite number" in page.words
    student = Page(tmp_path / "students" / "blaise.html").words
    assert "1.5 of 3 points" in student and "partly" in student and "drawn for this grading" in student
    again = tmp_path / "again"
    write_pages(reports[::-1], again, lab=assignment.lab)
    assert (again / "fronts.html").read_bytes() == (tmp_path / "fronts.html").read_bytes()
    assert all(Report.from_json(one.to_json()) == one for one in reports)


def test_front_of_a_class_is_what_no_other_design_beats():
    designs = {"a": (1.0, 20.0, 0.5), "b": (0.5, 30.0, 0.5), "c": (1.0, 20.0, 0.4), "b again": (0.5, 30.0, 0.5)}
    rest = {"scene": {}, "why": "", "points": {}, "dominates": [], "public": True}
    rows = [{**rest, "design": {"law": name.split()[0]}, "figures": figures} for name, figures in designs.items()]
    made = [ExerciseReport("design", "design", points=3.0, answered=True, designs=(row,)) for row in rows]
    (scene,) = class_fronts([Report(f"student {k}", "43", "A budget", "", exercises=(one,)) for k, one in enumerate(made)])
    told = {one["design"]: (one["number"], one["students"], one["front"]) for one in scene["answers"]}
    assert told == {"law: c": (1, 1, False), "law: a": (2, 1, True), "law: b": (3, 2, True)}
    assert scene["figure"].count("<circle") == 2 * 3 and scene["figure"].count(">3</text>") >= 2
