"""Two labs as assignments of a real otter-grader: made by one command, and marked by `otter run`."""

import importlib.util
import json
import shutil
import sys
import zipfile

import pytest
from hand_in import INSTRUCTOR, LABS, WRONG, earned, handed_in, start, text

from hapticlab import __version__
from hapticlab.cli import main
from hapticlab.course import notebook as notebooks
from hapticlab.course.instructor import solved_notebook
from hapticlab.course.notebook import code_of, read, write
from hapticlab.errors import CourseError, EngineMissingError
from hapticlab.grading.export.otter_source import otter_assign, otter_notebook

if importlib.util.find_spec("otter") is None:  # its commands run in a process of their own
    pytest.skip("needs otter-grader", allow_module_level=True)
TWO = ("01", "02")
#: otter needs five seconds to load: its commands are carried out by one process
COMMANDS = """
import json, sys
from otter.cli import cli
for line in sys.stdin:
    cli(json.loads(line), standalone_mode=False)
    print("\\ncarried out", flush=True)
"""


@pytest.fixture(scope="module")
def otter(tmp_path_factory):
    """Carry out a command of otter, given as its words."""
    with start(sys.executable, "-c", COMMANDS, cwd=tmp_path_factory.mktemp("otter")) as process:

        def carry_out(*words):
            print(json.dumps([*map(str, words)]), file=process.stdin, flush=True)
            said = []
            for line in process.stdout:
                said.append(line)
                if line == "carried out\n":
                    return
            pytest.fail("".join(said) + process.stderr.read()[-3000:])

        yield carry_out
        process.stdin.close()


@pytest.fixture(scope="module")
def made(otter, tmp_path_factory):
    """Folders of both labs: of one as our command has it made, of the other by otter, which need not run that solution."""
    target, scratch = tmp_path_factory.mktemp("made") / "labs", tmp_path_factory.mktemp("master")
    assert main.main(["assign", str(target), "--for", "otter", "--lab", "02", "--instructor", str(INSTRUCTOR)]) == 0
    lab, package = LABS["01"], f"hapticlab=={__version__}"
    shutil.copy(lab.path / "checks.py", scratch)
    write(scratch / lab.notebook.name, otter_notebook(lab, INSTRUCTOR / lab.name, ["checks.py"], package))
    otter("assign", "--no-pdfs", "--no-run-tests", scratch / lab.notebook.name, target / lab.name)
    return target


def archive(made, lab):
    (found,) = (made / lab.name / "autograder").glob("*.zip")
    return found


def students_notebook(made, lab):
    return read(made / lab.name / "student" / lab.notebook.name)


@pytest.mark.parametrize("number", TWO)
@pytest.mark.wide
def test_students_get_the_lab_with_otters_checks_and_no_solution(made, number):
    lab = LABS[number]
    came = [text(cell).rstrip() for cell in read(lab.notebook)["cells"]]
    given = [text(cell).rstrip() for cell in students_notebook(made, lab)["cells"]]
    names = [one.name for one in lab.lab().exercises if one.judged]
    added = [source for source in given if source not in came]
    assert [source for source in given if source in came] == came
    assert [source for source in added if source.startswith("grader.check(")] == [f'grader.check("{name}")' for name in names]
    answered = [cell for cell in solved_notebook(lab, INSTRUCTOR / lab.name)["cells"] if cell["id"] != "solution-imports"]
    solved = {text(cell).rstrip() for cell in answered} - set(came)
    assert len(solved) > len(names) and not [answer for answer in solved for source in given if answer in source]
    assert (made / lab.name / "student" / "checks.py").read_bytes() == (lab.path / "checks.py").read_bytes()
    given = [source for source in code_of(students_notebook(made, lab)) if "grader" not in source]
    _, problems, _ = notebooks.run(given, lab.path)
    assert problems == []


@pytest.mark.wide
def test_the_zip_installs_this_hapticlab_and_has_a_test_for_each_exercise(made):
    for number in TWO:
        lab = LABS[number]
        with zipfile.ZipFile(archive(made, lab)) as found:
            names = set(found.namelist())
            assert {"run_autograder", "setup.sh", "files/checks.py"} <= names
            tests = {name.removeprefix("tests/").removesuffix(".py") for name in names if name.startswith("tests/")}
            installed = found.read("environment.yml").decode()
        assert tests == {one.name for one in lab.lab().exercises if one.judged}
        assert f"hapticlab=={__version__}" in installed


@pytest.mark.parametrize("number, wrong", [pytest.param("01", {}, marks=pytest.mark.slow), ("02", WRONG["02"])])
@pytest.mark.wide
def test_otter_gives_what_was_right(otter, made, number, wrong, tmp_path):
    lab = LABS[number]
    write(tmp_path / lab.notebook.name, handed_in(students_notebook(made, lab), lab, wrong))
    otter("run", tmp_path / lab.notebook.name, "-a", archive(made, lab), "-o", tmp_path)
    results = {one["name"]: one for one in json.loads((tmp_path / "results.json").read_text("utf-8"))["tests"]}
    judged = {one.name: one.points for one in lab.lab().exercises if one.judged}
    assert {name: results[name]["score"] for name in judged} == {name: 0 if name in wrong else judged[name] for name in judged}
    assert {name: results[name]["max_score"] for name in judged} == judged
    assert sum(results[name]["score"] for name in judged) == earned(lab, wrong)
    assert ("a triangle, not a rectangle" in json.dumps(results)) == ("period_leak" in wrong)  # the sentence for k D^2


@pytest.mark.parametrize("lab", LABS.values(), ids=lambda lab: lab.name)
@pytest.mark.always("02_*", "12_*")
def test_questions_of_every_lab_have_their_points(lab):
    cells = otter_notebook(lab, INSTRUCTOR / lab.name)["cells"]
    raw = [text(cell) for cell in cells if cell["cell_type"] == "raw"]
    questions = [one.splitlines()[1:] for one in raw if one.startswith("# BEGIN QUESTION")]
    expected = [[f"name: {one.name}", f"points: {one.points:g}"] for one in lab.lab().exercises if one.judged]
    assert sorted(questions) == sorted(expected)
    for mark in ("QUESTION", "SOLUTION", "TESTS"):
        assert sum(one.startswith(f"# BEGIN {mark}") for one in raw) == sum(one.startswith(f"# END {mark}") for one in raw)
    assert len({cell["id"] for cell in cells}) == len(cells)


@pytest.mark.wide
def test_a_missing_otter_and_a_failing_solution_are_told(tmp_path, monkeypatch):
    lab = LABS["01"]
    (tmp_path / "solution.py").write_text("spring_damper = None\n")
    with pytest.raises(CourseError, match="has no answer to .*spring_damper_force.*; solution.py needs each exercise"):
        otter_assign(lab, tmp_path, tmp_path / "out")
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    with pytest.raises(EngineMissingError, match="pip install otter-grader"):
        otter_assign(lab, INSTRUCTOR / lab.name, tmp_path / "out")
