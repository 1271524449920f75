"""The labs as a whole: numbered without a gap, each with notebook, checks and answers."""

import re
from pathlib import Path

from hapticlab.course.labs import CHECKS, find_labs, labs_folder
from hapticlab.course.marks import HIDDEN, SOLUTION, WRONG

ROOT = Path(__file__).parents[2]


def test_every_lab_is_whole():
    folders = sorted(path for path in (ROOT / "labs").iterdir() if path.is_dir() and path.name[0].isdecimal())
    assert [path.name[:3] for path in folders] == [f"{number:02d}_" for number in range(len(folders))]
    assert [lab.path for lab in find_labs(ROOT / "labs")] == folders
    for path in folders:
        assert {file.name for file in path.iterdir() if file.name[0] not in "_."} >= {CHECKS, f"{path.name}.ipynb"}
        assert (ROOT / "tests" / "instructor" / path.name / SOLUTION).is_file()
        assert (ROOT / "tests" / "instructor" / path.name / HIDDEN).is_file()
        assert (ROOT / "tests" / "instructor" / path.name / WRONG).is_file()


def test_every_lab_stands_in_the_list_with_its_minutes():
    rows = re.findall(r"^\| (\d\d) [^|]+\|[^|]+\|[^|]+\| (\d+) \|", (ROOT / "labs" / "README.md").read_text("utf-8"), re.M)
    assert rows == [(folder.number, str(folder.lab().minutes)) for folder in find_labs(ROOT / "labs")]


def test_paths_through_the_labs_add_up():
    text = (ROOT / "labs" / "README.md").read_text("utf-8")
    before = {
        lab: set(re.findall(r"\d\d", told.partition(";")[0]))
        for lab, told in re.findall(r"^\| (\d\d) [^|]+\|[^|]+\|([^|]+)\|", text, re.M)
    }
    minutes = {folder.number: folder.lab().minutes for folder in find_labs(ROOT / "labs")}
    paths = re.findall(r"^\| (\D[^|]+) \| (\d\d(?:, \d\d)*) \| (\d+) \|", text, re.M)
    assert len(paths) == 4
    for time, told, total in paths:
        labs = told.split(", ")
        missing = {lab: before[lab] - set(labs[:k]) for k, lab in enumerate(labs)}
        assert set().union(*missing.values()) <= (set() if "term" in time else {"01"}), (time, missing)
        assert sum(minutes[lab] for lab in labs) == int(total), time


def test_no_answer_comes_with_the_labs():
    assert labs_folder() == ROOT / "labs"
    assert not [path for path in (ROOT / "labs").rglob("*") if path.name in (SOLUTION, HIDDEN) or "solved" in path.name]
