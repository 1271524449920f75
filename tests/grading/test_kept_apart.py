"""What an instructor may mistype, and where students' files may lie: refused in words before anything of theirs could run."""

import contextlib
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from attacks.small_lab import HONEST, notebook, write_lab
from submitted_files import fill

from hapticlab.cli.main import main
from hapticlab.course.labs import labs_folder
from hapticlab.grading.kept_apart import is_inside

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def course(tmp_path_factory):
    """A course's folder: labs, answers, a class of two, a roster, and whatever lies about."""
    place = tmp_path_factory.mktemp("course")
    write_lab(place)
    fill(place, {"class/ada.ipynb": notebook(HONEST.values()), "class/bob.ipynb": notebook(["k = 2"])})
    fill(place, {"class.csv": "id\nada\nbob\n", "site/class.html": "<p>mine", "note.txt": "x", "grades.csv": "id,points\n"})
    shutil.copytree(place / "instructor", place / "class" / "eve")
    shutil.copytree(place / "labs", place / "class" / "mal")
    return place


def grade(course, *words, submissions="class"):
    lab, answers = ("--lab", "labs/42_small_wall"), ("--instructor", "instructor")
    own = [pair for pair in (lab, answers) if pair[0] not in words]
    return ["grade", submissions, *(word for pair in own for word in pair), *words]


MISTYPED = {
    "answers are a student's": (["--instructor", "class/eve"], "class/eve is in the submissions"),
    "answers are the submissions": (["--instructor", "class"], "whose code must not grade"),
    "the lab is a student's": (["--lab", "class/mal/42_small_wall"], "class/mal/42_small_wall is in the submissions"),
    "results replace a submission": (["-o", "class/ada.ipynb"], "or replace one. Give a path outside"),
    "results among the submissions": (["-o", "class/grades.csv"], "where it would be treated as a submission"),
    "results over answers": (["-o", "instructor/42_small_wall/solution.py"], "would overwrite a file that is read"),
    "results over the roster": (["-o", "class.csv", "--roster", "class.csv"], "would overwrite a file that is read"),
    "results are a folder": (["-o", "labs"], "is a folder; give a file for the results, such as -o"),
    "pages among the submissions": (["--pages", "class/pages"], "class/pages is in the submissions"),
    "pages are a file": (["--pages", "note.txt"], "note.txt is a file; give a folder for the pages"),
    "pages over a page of somebody's": (["--pages", "site"], "class.html is not a page of hapticlab's and would be overwritten"),
    "the gradebook is a table": (["--gradebook", "grades.csv"], "grades.csv is not a database"),
    "no worker": (["--workers", "0"], "0"),
    "a time without end": (["--timeout", "1e9"], "1e9"),
    "memory without end": (["--memory", "99999999999999"], "99999999999999"),
    "a seed below zero": (["--seed", "-1"], "-1"),
    "a format of nobody's": (["--format", "xlsx"], "xlsx"),
}
TAKEN = {
    "the lab as submissions": "labs/42_small_wall",
    "all labs as submissions": "labs",
    "the answers as submissions": "instructor",
    "the answers of a lab as submissions": "instructor/42_small_wall",
    "a lab of the package as submissions": str(labs_folder() / "02_virtual_wall"),
}


@pytest.mark.parametrize("kind", MISTYPED)
def test_what_is_mistyped_is_refused_and_nothing_is_written(course, kind, capsys):
    extra, words = MISTYPED[kind]
    before = {path: path.read_bytes() for path in course.rglob("*") if path.is_file()}
    with contextlib.chdir(course), pytest.raises(SystemExit) as ended:
        main(grade(course, *extra))
    assert ended.value.code == 2 and words in capsys.readouterr().err
    assert {path: path.read_bytes() for path in course.rglob("*") if path.is_file()} == before


@pytest.mark.parametrize("kind", TAKEN)
def test_what_is_not_handed_in_is_no_submission(course, kind, capsys):
    with contextlib.chdir(course), pytest.raises(SystemExit) as ended:
        main(grade(course, submissions=TAKEN[kind]))
    told = capsys.readouterr().err
    assert ended.value.code == 2 and re.search(r"folder (of|that contains only) the submissions", told)


def test_a_course_in_nbgraders_tree_may_hold_marks_and_pages_beside_it(course, tmp_path, here, capsys):
    fill(tmp_path, {"submitted/ada/42_small_wall/42_small_wall.ipynb": notebook(HONEST.values()), "source/x.ipynb": "{}"})
    lab, answers = course / "labs/42_small_wall", course / "instructor"
    words = grade(course, "--lab", str(lab), "--instructor", str(answers), submissions=".")
    with here(), contextlib.chdir(tmp_path):
        assert main([*words, "-o", "new/grades.json", "--format", "json", "--pages", "pages", "--workers", "1"]) == 0
        assert Path.cwd() == tmp_path
        (one,) = json.loads(Path("new/grades.json").read_text())["reports"]
    assert (one["student"], one["earned"]) == ("ada", 10.0)
    told = capsys.readouterr().err
    assert "1 handed in: 1 graded, 0 not graded" in told and "left aside" not in told


def test_a_place_is_known_by_whatever_name(tmp_path):
    fill(tmp_path, {"class/ada/x.py": "", "classes/y.py": ""})
    assert is_inside(tmp_path / "classes/../class/ada", tmp_path / "class")
    assert not is_inside(tmp_path / "classes", tmp_path / "class")
    assert not is_inside(tmp_path, tmp_path / "class")
    if hasattr(os, "fork"):
        (tmp_path / "link").symlink_to(tmp_path / "class/ada")
        assert is_inside(tmp_path / "link/new.csv", tmp_path / "class")


#: names that Python or a library may import, or read as its settings, from the working folder
SHADOWS = ("multiprocessing", "numpy", "sympy", "random", "json", "argparse", "socket", "tqdm", "pint", "ctypes", "IPython")
FORGED = "import os\nopen(os.path.join(os.path.dirname(__file__), 'ran'), 'a').write(__name__ + '\\n')\nraise SystemExit(0)\n"


@pytest.fixture
def hostile(course, tmp_path):
    """The folder of a class in which a student's files have the names of modules."""
    files = {f"{name}.py": FORGED for name in SHADOWS} | {
        "sitecustomize.py": FORGED,
        "matplotlibrc": "backend: module://random\n",
    }
    return fill(tmp_path / "class", files | {"ada.ipynb": notebook(HONEST.values())})


def command(course, *before):
    lab, answers = course / "labs/42_small_wall", course / "instructor"
    return [*before, "grade", ".", "--lab", str(lab), "--instructor", str(answers), "--workers", "1", "--sandbox", "none"]


def run(words, cwd, **environment):
    given = {**os.environ, "PYTHONPATH": str(ROOT), **environment}
    return subprocess.run(words, cwd=cwd, env=given, capture_output=True, text=True, timeout=300, check=False)


@pytest.mark.wide
def test_files_in_the_working_folder_are_not_imported(course, hostile):
    started = "import sys; from hapticlab.cli.main import main; sys.exit(main(sys.argv[1:]))"
    done = run(command(course, sys.executable, "-P", "-c", started), hostile)
    assert not (hostile / "ran").exists(), (hostile / "ran").read_text()
    assert "ada: 10 of 10 points" in done.stdout, done.stderr


@pytest.mark.wide
def test_a_module_is_not_started_from_the_working_folder(course, hostile):
    done = run(command(course, sys.executable, "-m", "hapticlab"), hostile)
    assert not (hostile / "ran").exists(), (hostile / "ran").read_text()
    assert done.returncode == 2 and "which is in the submissions" in done.stderr
    assert "start with: python -P -m hapticlab grade" in done.stderr


@pytest.mark.wide
@pytest.mark.parametrize("folder", ["class", "class/ada"])
def test_an_import_path_among_the_submissions_is_refused(course, tmp_path, folder):
    fill(tmp_path / "class", {"ada/x.ipynb": notebook(HONEST.values())})
    path = os.pathsep.join([str(ROOT), str(tmp_path / folder)])
    done = run(command(course, sys.executable, "-P", "-m", "hapticlab"), tmp_path / "class", PYTHONPATH=path)
    assert done.returncode == 2 and f"imports modules from {tmp_path / folder}, which is in the submissions" in done.stderr
