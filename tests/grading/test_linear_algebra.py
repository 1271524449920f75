"""A class is graded to the same bytes whatever code NumPy's linear algebra runs, in the grader and beside the students' code."""

import json
from pathlib import Path

import pytest
from hand_in import INSTRUCTOR, LABS, handed_in
from processors import on_each_processor

#: grades, the sessions on the same code as the grader, which they do not inherit
PROGRAM = """
import sys
from hapticlab.cli.main import main
from hapticlab.grading.sessions import preloaded

core, folder, lab, instructor = sys.argv[1:]
preloaded.ENVIRONMENT["OPENBLAS_CORETYPE"] = core
made = f"{folder}/{core}"
grade = ["grade", f"{folder}/class", "--lab", lab, "--instructor", instructor, "--workers", "1"]
sys.exit(main([*grade, "--format", "json", "-o", f"{made}.json", "--pages", f"{made} pages"]))
"""


def graded(folder, number):
    """Return what grading a class of a lab writes on each processor: the report, and the pages by name."""
    lab = LABS[number]
    released = json.loads(lab.notebook.read_text("utf-8"))
    (folder / "class").mkdir()
    graded = [exercise for exercise in lab.lab().exercises if exercise.judged]
    for student, wrong in {"ada": {}, "bob": {graded[-1].name: None}}.items():
        (folder / "class" / f"{student}.ipynb").write_text(json.dumps(handed_in(released, lab, wrong)), "utf-8")
    on_each_processor(PROGRAM, folder, number, INSTRUCTOR)
    pages = [
        {str(page.relative_to(made)): page.read_bytes() for page in made.rglob("*.*")} for made in sorted(folder.glob("* pages"))
    ]
    return [made.read_bytes() for made in sorted(folder.glob("*.json"))], pages


@pytest.mark.wide
@pytest.mark.parametrize("number", ["06", *(pytest.param(k, marks=pytest.mark.slow) for k in sorted(LABS) if k != "06")])
def test_a_class_report_has_the_same_bytes_on_several_processors(number, tmp_path):
    reports, pages = graded(Path(tmp_path), number)
    assert len(reports) == 3 and reports[0] == reports[1] == reports[2]
    assert len(pages) == 3 and len(pages[0]) > 2 and pages[0] == pages[1] == pages[2]
    earned = [sum(one["earned"] for one in report["exercises"]) for report in json.loads(reports[0])["reports"]]
    assert earned[0] > earned[1] > 0
