"""`hapticlab labs`: what is copied, what is never touched, how JupyterLab is opened, and an instructor's table."""

import json
import os
import signal
import subprocess
import sys
from contextlib import contextmanager, suppress
from pathlib import Path

import pytest

from hapticlab.cli.main import main
from hapticlab.course import labs as course_labs
from hapticlab.course.labs import RECORD
from hapticlab.course.notebook import read, write

CHECKS = """
from hapticlab.course.exercise import Case, Exercise, Lab
LAB = Lab("{0}", "Springs {0}", 10, [Exercise("force", points=2, asks="a force", cases=[Case({{"k": 2.0}}, 6.0)])])
"""
UNTOUCHED = "def force(k):\n    raise NotImplementedError"
#: stands for JupyterLab: it writes down how it was called, and asks once before it ends
STAND_IN = """
import json, os, signal, sys
asked = []
signal.signal(signal.SIGINT, lambda *_: sys.exit(3) if asked else (asked.append(1), print("sure?", flush=True)))
open("called.json", "w").write(json.dumps([sys.argv[1:], os.environ.get("JUPYTER_PREFER_ENV_PATH")]))
print("serving", flush=True)
if os.environ.get("STAY"):
    while True:
        signal.pause()
sys.exit(int(os.environ.get("CODE", 0)))
"""


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    """Two small labs, their answers, a stand-in for JupyterLab, and an empty folder to be in."""
    for number in ("08", "09"):
        lab, answers = tmp_path / "labs" / f"{number}_springs", tmp_path / "answers" / f"{number}_springs"
        lab.mkdir(parents=True)
        answers.mkdir(parents=True)
        (lab / "checks.py").write_text(CHECKS.format(number))
        cell = {"cell_type": "code", "id": "a", "metadata": {}, "outputs": [], "execution_count": None, "source": UNTOUCHED}
        write(lab / f"{number}_springs.ipynb", {"cells": [cell], "metadata": {}, "nbformat": 4, "nbformat_minor": 5})
        (answers / "solution.py").write_text("def force(k):\n    return 3 * k")
        (answers / "hidden.py").write_text("def cases(random):\n    return {'force': lambda: [{'k': random.uniform()}]}")
    for junk in ("__pycache__/checks.pyc", ".ipynb_checkpoints/08.ipynb"):
        (tmp_path / "labs" / "08_springs" / junk).parent.mkdir()
        (tmp_path / "labs" / "08_springs" / junk).touch()
    (tmp_path / "labs" / "README.md").write_text("Labs")
    stand_in = tmp_path / "modules" / "jupyterlab"
    stand_in.mkdir(parents=True)
    (stand_in / "__init__.py").touch()
    (stand_in / "__main__.py").write_text(STAND_IN)
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    monkeypatch.setattr(course_labs, "PLACES", (tmp_path / "labs",))
    root = str(Path(course_labs.__file__).parents[2])
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([str(tmp_path / "modules"), root]))
    monkeypatch.syspath_prepend(tmp_path / "modules")
    return tmp_path


def files(folder):
    paths = (path for path in Path(folder).rglob("*") if path.is_file() and path.name != RECORD)
    return {str(path.relative_to(folder)): path.read_text() for path in paths}


def test_labs_are_copied_and_jupyterlab_of_this_environment_opens_on_them(place, capfd):
    assert main(["labs"]) == 0
    copied = files("hapticlab-labs")
    assert sorted(copied) == [
        "08_springs/08_springs.ipynb", "08_springs/checks.py", "09_springs/09_springs.ipynb", "09_springs/checks.py", "README.md",
    ]  # fmt: skip
    assert copied == {path: text for path, text in files(place / "labs").items() if path in copied}
    arguments, prefers_this_environment = json.loads(Path("called.json").read_text())
    assert arguments == ["hapticlab-labs", "--LabApp.default_url=/lab/tree/08_springs/08_springs.ipynb"]
    assert prefers_this_environment == "1"
    out = capfd.readouterr().out
    assert "  08  Springs 08" in out and f"labs in {Path('hapticlab-labs').resolve()}" in out
    assert f"{sys.executable} -m jupyterlab" in out
    assert "serving" in out
    for changed, opened in (("08", ["--LabApp.default_url=/lab/tree/09_springs/09_springs.ipynb"]), ("09", [])):
        Path(f"hapticlab-labs/{changed}_springs/{changed}_springs.ipynb").write_text("my work")
        assert main(["labs"]) == 0  # at the first that is not begun, else where the student left it
        assert json.loads(Path("called.json").read_text())[0] == ["hapticlab-labs", *opened]


def test_a_students_work_is_never_overwritten(place, capsys):
    assert main(["labs", "mine", "--no-open"]) == 0
    Path("mine/08_springs/08_springs.ipynb").write_text("my work")
    Path("mine/09_springs/checks.py").unlink()
    Path("mine/README.md").unlink()
    Path("mine/README.md").mkdir()
    Path("mine/notes.txt").write_text("also mine")
    capsys.readouterr()
    assert main(["labs", "mine", "--no-open"]) == 0
    out = capsys.readouterr().out
    assert "may hold your work:\n  08_springs/08_springs.ipynb, README.md\n" in out
    assert "name another folder: hapticlab labs mine-new\n" in out
    found = files("mine")
    assert (found["08_springs/08_springs.ipynb"], found["notes.txt"]) == ("my work", "also mine")
    assert found["09_springs/checks.py"] == CHECKS.format("09")  # what was missing is there again
    assert not Path("called.json").exists()


@pytest.mark.skipif(not hasattr(os, "symlink"), reason="no links here")
def test_a_link_leads_no_writing_elsewhere(place):
    Path("mine/08_springs").mkdir(parents=True)
    os.symlink(place / "elsewhere.ipynb", "mine/08_springs/08_springs.ipynb")
    assert main(["labs", "mine", "--no-open"]) == 0
    assert not (place / "elsewhere.ipynb").exists()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["labs", "file", "--no-open"], "file is a file; name a folder for the labs"),
        (["labs", "../labs", "--no-open"], "is where the labs come from"),
        (["labs", "new", "--no-open", "--instructor", "nowhere"], "nowhere contains no NN_name/solution.py; give the folder"),
        (["labs", "../labs/sub", "--no-open"], "is inside the folder where the labs come from"),
    ],
)
def test_a_folder_that_cannot_be_is_refused_before_anything_is_written(place, arguments, words, capsys):
    Path("file").touch()
    before = files(place)
    assert main(arguments) == 1
    assert words in capsys.readouterr().err
    assert files(place) == before


def test_a_lab_is_named_by_its_number_and_never_taken_for_a_folder(place, capfd):
    for given in (["labs", "9"], ["lab", "09"], ["labs", "--lab", "9"], ["lab", "mine", "9"]):
        assert main(given) == 0
        assert json.loads(Path("called.json").read_text())[0][-1].endswith("/09_springs/09_springs.ipynb"), given
        folder = "mine" if "mine" in given else "hapticlab-labs"
        assert [path.name for path in sorted(Path(folder).glob("0*"))] == ["09_springs"]
        assert not Path("9").exists() and not Path("09").exists()
    assert main(["labs", "7"]) == 1
    assert "there is no lab 07; there are 08, 09" in capfd.readouterr().err


def test_without_jupyterlab_the_labs_are_copied_and_the_cure_is_said(monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "jupyterlab", None)
    assert main(["labs"]) == 1
    assert f'{sys.executable} -m pip install "hapticlab[notebook]"' in capsys.readouterr().err
    assert Path("hapticlab-labs/08_springs/08_springs.ipynb").is_file()


def test_without_labs_it_is_said(place, monkeypatch, capsys):
    monkeypatch.setattr(course_labs, "PLACES", (place / "none",))
    assert main(["labs"]) == 1
    assert "no labs in" in capsys.readouterr().err


def test_jupyterlab_that_fails_is_reported(monkeypatch, capfd):
    monkeypatch.setenv("CODE", "5")
    assert main(["labs"]) == 1
    assert "JupyterLab ended with code 5" in capfd.readouterr().err


@contextmanager
def all_ended(group):
    """End a group of processes, whatever happens: JupyterLab's stand-in would stay for ever."""
    try:
        yield
    finally:
        with suppress(ProcessLookupError):
            os.killpg(group, signal.SIGKILL)


@pytest.mark.skipif(sys.platform == "win32", reason="no process groups here")
@pytest.mark.wide
def test_ctrl_c_is_answered_by_jupyterlab_alone(place):
    code = "import sys; from hapticlab.course import labs; from hapticlab.cli.main import main; from pathlib import Path\n"
    code += f"labs.PLACES = (Path({str(place / 'labs')!r}),); sys.exit(main(['labs']))"
    process = subprocess.Popen(
        [sys.executable, "-c", code], env={**os.environ, "STAY": "1"}, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        text=True, start_new_session=True,
    )  # fmt: skip
    with process, all_ended(process.pid):
        for words in ("serving\n", "sure?\n"):
            assert words in iter(process.stdout.readline, "")
            os.killpg(process.pid, signal.SIGINT)
        assert process.wait(30) == 1
        assert process.stderr.read().startswith("hapticlab: JupyterLab ended with code 3; what it said is above")


def test_an_erratum_arrives_and_checks_that_somebody_changed_survive(place, capsys):
    assert main(["labs", "my labs", "--no-open"]) == 0
    own = Path("my labs/09_springs/checks.py")
    own.write_text(own.read_text() + "# an instructor's own\n")
    for number in ("08", "09"):
        checks = place / "labs" / f"{number}_springs" / "checks.py"
        checks.write_text(CHECKS.format(number).replace("6.0", "8.0"))
    capsys.readouterr()
    assert main(["labs", "my labs", "--no-open"]) == 0
    out = capsys.readouterr().out
    assert "checks.py.old:\n  08_springs/checks.py\n" in out
    assert "may hold your work:\n  09_springs/checks.py\n" in out and "hapticlab labs 'my labs-new'" in out
    found = files("my labs")
    assert "8.0" in found["08_springs/checks.py"] and found["08_springs/checks.py.old"] == CHECKS.format("08")
    assert found["09_springs/checks.py"] == CHECKS.format("09") + "# an instructor's own\n"
    Path("my labs", RECORD).write_text("no record")  # then nothing is known, and nothing makes way
    (place / "labs" / "08_springs" / "checks.py").write_text(CHECKS.format("08"))
    assert main(["labs", "my labs", "--no-open"]) == 0
    assert files("my labs") == found


def test_labs_that_were_deleted_stay_away_and_some_can_be_asked_for(place, capsys):
    assert main(["labs", "mine", "--no-open", "--lab", "09"]) == 0
    out = capsys.readouterr().out
    assert "  09  Springs 09" in out and "  08  Springs" not in out
    assert "to have them: hapticlab labs mine --lab 08\n" in out
    Path("mine/11_own").mkdir()
    Path("mine/12_own").mkdir()
    Path("mine/12_own/12_own.ipynb").touch()
    Path("mine/12_own/checks.py").write_text(CHECKS.format(12))
    assert main(["labs", "mine", "--no-open"]) == 0
    out = capsys.readouterr().out
    assert not Path("mine/08_springs").exists()
    assert "  12  Springs 12" in out and "11_own is no lab: it needs 11_own.ipynb and checks.py" in out
    assert main(["labs", "mine", "--no-open", "--lab", "08"]) == 0
    assert Path("mine/08_springs/checks.py").is_file()
    assert main(["labs", "mine", "--no-open", "--lab", "13"]) == 1
    assert "there is no lab 13; there are 08, 09" in capsys.readouterr().err


def test_a_place_that_cannot_be_written_to_is_told_with_a_cure(capsys):
    Path("mine").mkdir()
    Path("mine/08_springs").touch()
    assert main(["labs", "mine", "--no-open"]) == 1
    err = capsys.readouterr().err
    assert "cannot write mine/08_springs: File exists; the files before it are copied. Give a folder of your own" in err


def test_an_instructor_gets_solved_notebooks_in_a_folder_of_their_own_and_their_marks(place, capsys):
    command = ["labs", "--no-open", "--instructor", str(place / "answers")]
    assert main(command) == 0
    rows, out = table(capsys)
    assert [row[:4] for row in rows] == [["08_springs", "2", "2", "0"], ["09_springs", "2", "2", "0"]]
    assert f"{Path('hapticlab-labs-solved').resolve()}: keep that folder from students" in out
    assert not [path for path in files("hapticlab-labs") if "solved" in path]
    solved = Path("hapticlab-labs-solved/09_springs-solved.ipynb")
    assert read(solved)["cells"][0]["source"] == "def force(k):\n    return 3 * k"
    solved.write_text("changed")
    assert main([*command, "--seed", "7", "--lab", "09"]) == 0
    rows, out = table(capsys)
    assert "09_springs-solved.ipynb left as it is" in out and "hidden cases of seed 7" in out
    assert [row[0] for row in rows] == ["09_springs"]
    assert solved.read_text() == "changed"


def test_no_notebook_of_the_folder_is_run_when_an_instructor_marks(place, capsys):
    assert main(["labs", "--no-open"]) == 0
    mine = Path("hapticlab-labs/08_springs/08_springs.ipynb")
    cell = {"cell_type": "code", "id": "a", "metadata": {}, "source": "open('was-run', 'w'); import os; os._exit(9)"}
    mine.write_text(json.dumps({"cells": [cell]}))
    assert main(["labs", "--no-open", "--instructor", str(place / "answers")]) == 0
    rows, out = table(capsys)
    assert rows[0][:4] == ["08_springs", "2", "2", "0"]
    assert "marked are the labs as they came with hapticlab, never the notebooks in hapticlab-labs" in out


def test_mistakes_in_answers_are_told(place, capsys):
    command = ["labs", "--no-open", "--instructor", str(place / "answers")]
    (place / "answers" / "09_springs" / "solution.py").write_text("def force(k):\n    return -3 * k")
    (place / "answers" / "08_springs").rename(place / "answers" / "08_spring")
    assert main(command) == 1
    rows, out = table(capsys)
    assert "solution, force: 1 of 2 cases; -6, expected 6. The sign is wrong." in out
    assert rows[0][:4] == ["08_springs", "no", "answers", "in"]
    assert rows[-1] == ["08_spring", "answers,", *"and no lab of that name came with hapticlab".split()]
    (place / "labs" / "08_springs" / "08_springs.ipynb").write_text("no notebook")
    (place / "answers" / "08_spring").rename(place / "answers" / "08_springs")
    assert main(command) == 1
    assert "08_springs.ipynb is not a notebook; it needs the JSON that Jupyter writes" in capsys.readouterr().out


@pytest.mark.parametrize("arguments", [["--seed", "3"], ["--seed", "x", "--instructor", "y"]])
def test_a_seed_that_says_nothing_is_a_wrong_command(arguments, capsys):
    with pytest.raises(SystemExit):
        main(["labs", "--no-open", *arguments])
    assert "--seed" in capsys.readouterr().err


def table(capsys):
    out = capsys.readouterr().out
    return [line.split() for line in out.splitlines() if line[:2].isdecimal()], out
