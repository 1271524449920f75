"""`hapticlab assign`: what it refuses, what it never overwrites, what it says to do next, and each student's own labs."""

import json
import shutil
import zipfile
from pathlib import Path

import pytest

from hapticlab.cli import exits, main
from hapticlab.course.labs import find_labs
from hapticlab.course.notebook import code_of, read

ROOT = Path(__file__).parents[2]
INSTRUCTOR = str(ROOT / "tests" / "instructor")
LAB = next(lab for lab in find_labs() if lab.number == "02")


def assign(*asked):
    return main.main(["assign", *map(str, asked), "--instructor", INSTRUCTOR])


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        (["labs"], "name what the labs are written for, --for {nbgrader,otter,gradescope,prairielearn}, or --personal"),
        (["labs", "--personal"], "--personal needs --roster FILE.csv"),
        (["labs", "--for", "otter", "--personal"], "otter cannot tell whose numbers a notebook has"),
        (["labs", "--for", "nbgrader", "--seed", "1"], "--seed is of hidden cases, which nbgrader does not get"),
        (["labs", "--for", "nbgrader", "--roster", "r.csv"], "--roster is of --personal"),
        (["labs", "--for", "nbgrader", "--column", "Login"], "--column is of --roster"),
        (["labs", "--for", "nbgrader", "--wheel", "h.whl"], "--wheel is of --for gradescope and prairielearn"),
        (["w.zip", "--for", "gradescope", "--lab", "02", "--wheel", "h.whl"], "h.whl: no such wheel; make one"),
        (["w.zip", "--for", "gradescope"], "of one lab; give FILE.zip and --lab NN"),
        (["folder", "--for", "gradescope", "--lab", "02"], "of one lab; give FILE.zip and --lab NN"),
    ],
)
def test_what_does_not_go_together_is_refused(asked, words, capsys):
    with pytest.raises(SystemExit) as ended:
        assign(*asked)
    assert ended.value.code == exits.USAGE
    assert words in capsys.readouterr().err


def test_a_strange_lab_and_missing_answers_are_told(tmp_path, capsys):
    assert assign(tmp_path / "course", "--for", "nbgrader", "--lab", "77") == exits.FAILED
    assert "there is no lab 77; there are 00, 01, 02" in capsys.readouterr().err
    (tmp_path / "01_motion_to_force").mkdir()
    (tmp_path / "01_motion_to_force" / "solution.py").write_text("k = 1\n")
    asked = ["assign", str(tmp_path / "course"), "--for", "nbgrader", "--lab", "02", "--instructor", str(tmp_path)]
    assert main.main(asked) == exits.FAILED
    assert "holds no 02_virtual_wall" in capsys.readouterr().err
    assert not (tmp_path / "course").exists()


@pytest.mark.parametrize("system", ["nbgrader", "gradescope", "prairielearn"])
def test_nothing_is_overwritten_and_the_next_command_is_said(system, tmp_path, capsys):
    target = tmp_path / ("wall.zip" if system == "gradescope" else "course")
    assert assign(target, "--for", system, "--lab", "02") == 0
    said = capsys.readouterr().out
    told = {
        "nbgrader": "nbgrader generate_assignment 02_virtual_wall --create",
        "gradescope": "10 points; under Configure Autograder upload wall.zip",
        "prairielearn": "docker build -t hapticlab-grader:",
    }
    assert f"written: {target}" in said and told[system] in said.partition("next:")[2]
    before = {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}
    assert assign(target, "--for", system, "--lab", "02") == exits.FAILED
    assert "is there already" in capsys.readouterr().err
    assert {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()} == before


def test_another_lab_joins_a_course_whose_config_stays(tmp_path, capsys):
    assert assign(tmp_path / "course", "--for", "nbgrader", "--lab", "02") == 0
    config = tmp_path / "course" / "nbgrader_config.py"
    config.write_text("c = get_config()\n")
    capsys.readouterr()
    assert assign(tmp_path / "course", "--for", "nbgrader", "--lab", "01") == 0
    assert "it needs this line" in capsys.readouterr().out
    assert config.read_text() == "c = get_config()\n"
    assert len(list((tmp_path / "course" / "source").iterdir())) == 2


def test_a_wheel_goes_into_the_autograder(tmp_path):
    wheel = tmp_path / "hapticlab-9.9-py3-none-any.whl"
    wheel.write_bytes(b"a wheel")
    assert assign(tmp_path / "w.zip", "--for", "gradescope", "--lab", "02", "--wheel", wheel) == 0
    with zipfile.ZipFile(tmp_path / "w.zip") as archive:
        assert archive.read(wheel.name) == b"a wheel"
        assert f'install --python /opt/hapticlab/bin/python "./{wheel.name}"' in archive.read("setup.sh").decode()
    assert assign(tmp_path / "q", "--for", "prairielearn", "--lab", "02", "--wheel", wheel, "--image", "us/grader:2") == 0
    assert (tmp_path / "q" / "grader-image" / wheel.name).read_bytes() == b"a wheel"
    info = json.loads((tmp_path / "q" / LAB.name / "info.json").read_text())
    assert info["externalGradingOptions"]["image"] == "us/grader:2"


@pytest.fixture
def own(tmp_path):
    """A lab of an instructor's own, 77_walls, and its answers: lab 02 under another number."""
    folder = tmp_path / "own" / "77_walls"
    folder.mkdir(parents=True)
    names = {LAB.notebook: "77_walls.ipynb", LAB.path / "checks.py": "checks.py"}
    for path, name in names.items():
        text = path.read_text("utf-8").replace('number="02"', 'number="77"')
        (folder / name).write_text(text.replace('check(\\"02.', 'check(\\"77.'), "utf-8")
    shutil.copytree(Path(INSTRUCTOR, LAB.name), tmp_path / "answers" / folder.name)
    return folder


def test_an_own_lab_is_handed_out_as_those_of_the_package_are(tmp_path, own, roster, capsys):
    asked = ["--lab", own, "--instructor", tmp_path / "answers"]

    def said(target, *more):
        assert main.main(["assign", str(tmp_path / target), *map(str, (*more, *asked))]) == 0
        return capsys.readouterr().out

    assert f"--lab {own.resolve()} --instructor" in said("course", "--for", "nbgrader")
    notebook = read(tmp_path / "course" / "source" / own.name / "77_walls.ipynb")
    checks = [cell["source"] for cell in notebook["cells"] if "HIDDEN TESTS" in cell["source"]]
    assert len(checks) == 7 and all('hl.check("77.' in source for source in checks)
    said("wall.zip", "--for", "gradescope")
    with zipfile.ZipFile(tmp_path / "wall.zip") as archive:
        assert {"labs/77_walls/checks.py", "answers/77_walls/solution.py"} <= set(archive.namelist())
    said("questions", "--for", "prairielearn")
    assert 'labs/77_walls"' in (tmp_path / "questions" / own.name / "tests" / "run.sh").read_text("utf-8")
    assert f"--lab {own.resolve()} --instructor" in said("class", "--personal", "--roster", roster)
    own_numbers = [own_lines(tmp_path / "class" / name, own.name) for name in ("al", "bm")]
    assert len(own_numbers[0]) == 2 and own_numbers[0] != own_numbers[1]


@pytest.fixture
def roster(tmp_path):
    path = tmp_path / "class.csv"
    path.write_text("Name;Email;Login\nAda L;ada@x.edu;al\nBob M;bob@x.edu;bm\n", "utf-8")
    return path


def own_lines(folder, name=LAB.name):
    code = "\n".join(code_of(read(folder / name / f"{name}.ipynb")))
    return [line for line in code.splitlines() if line.startswith(("K_OWN =", "T_OWN ="))]


def test_each_student_has_a_folder_with_own_numbers(tmp_path, roster, capsys):
    asked = ["--personal", "--roster", roster, "--lab", "02", "--seed", "7"]
    assert assign(tmp_path / "class", *asked) == 0
    said = capsys.readouterr().out
    assert f"hapticlab grade SUBMISSIONS --lab 02 --instructor {INSTRUCTOR} --personal --seed 7" in said
    ada, bob = (own_lines(tmp_path / "class" / name) for name in ("al", "bm"))
    assert len(ada) == len(bob) == 2 and ada != bob
    assert ada != [line for line in "\n".join(code_of(read(LAB.notebook))).splitlines() if line.startswith(("K_OWN", "T_OWN"))]
    work = tmp_path / "class" / "al" / LAB.name / LAB.notebook.name
    work.write_text(work.read_text("utf-8").replace("who_pays = None", "who_pays = 'd'"), "utf-8")
    assert assign(tmp_path / "class", *asked) == 0
    assert f"al/{LAB.name}/{LAB.notebook.name}" in capsys.readouterr().out.replace("\\", "/").partition("may hold work")[2]
    assert "who_pays = 'd'" in work.read_text("utf-8")
    assert assign(tmp_path / "other", *asked, "--column", "Email") == 0
    assert own_lines(tmp_path / "other" / "ada@x.edu") != ada and "the same for every student" not in said
    capsys.readouterr()
    assert assign(tmp_path / "two", *asked[:3], "--lab", "02", "12") == 0
    assert "the same for every student, because hidden.py defines no numbers(random): 12\n" in capsys.readouterr().out


def test_a_column_that_is_not_there_is_told(tmp_path, roster, capsys):
    assert assign(tmp_path / "class", "--personal", "--roster", roster, "--column", "Matr") == exits.FAILED
    assert "has no column 'Matr'; it has 'Name', 'Email', 'Login'" in capsys.readouterr().err
    roster.write_text("Who\nAda\n")
    assert assign(tmp_path / "class", "--personal", "--roster", roster) == exits.FAILED
    assert "Say it by --column" in capsys.readouterr().err
    assert not (tmp_path / "class").exists()
