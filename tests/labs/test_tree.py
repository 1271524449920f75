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


def test_no_answer_comes_with_the_labs():
    assert labs_folder() == ROOT / "labs"
    assert not [path for path in (ROOT / "labs").rglob("*") if path.name in (SOLUTION, HIDDEN) or "solved" in path.name]
