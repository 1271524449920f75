"""Autograders of Gradescope and PrairieLearn: their own scripts run in folders laid out as these systems do."""

import json
import os
import re
import shutil
import stat
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from hand_in import INSTRUCTOR, LABS, ROOT, WRONG, earned, handed_in

from hapticlab import __version__
from hapticlab.cli import main
from hapticlab.course.marks import own_numbers
from hapticlab.course.notebook import read, write

LAB = LABS["02"]
needs_bash = pytest.mark.skipif(shutil.which("bash") is None, reason="bash, in which these systems run their scripts")


def assigned(target, system, *more):
    asked = ["--for", system, "--lab", "02", "--instructor", str(INSTRUCTOR), "--seed", "4", *more]
    assert main.main(["assign", str(target), *asked]) == 0


def hand_in(folder, wrong):
    folder.mkdir()
    write(folder / LAB.notebook.name, handed_in(read(LAB.notebook), LAB, wrong))


def run_script(script, **variables):
    """Run a script, which must succeed."""
    code, said = done_by(script, **variables)
    assert code == 0, said


def done_by(script, **variables):
    """Run a script where its python is this one; return its code and what it said."""
    path = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
    own = {"PATH": path, "PYTHONPATH": str(ROOT), "HAPTICLAB_PYTHON": sys.executable}
    env = {**os.environ, **own, **{name: str(value) for name, value in variables.items()}}
    done = subprocess.run([str(script)], env=env, capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


def of_nobody_else(path):
    return not stat.S_IMODE(path.stat().st_mode) & 0o077


@pytest.fixture(scope="module")
def autograder(tmp_path_factory):
    """Gradescope's folder /autograder with the zip unpacked."""
    root = tmp_path_factory.mktemp("autograder")
    assigned(root / "wall.zip", "gradescope", "--personal")
    with zipfile.ZipFile(root / "wall.zip") as archive:
        for entry in archive.infolist():  # as unzip does it, with the rights
            path = Path(archive.extract(entry, root / "source"))
            path.chmod(entry.external_attr >> 16 & 0o777)
    return root


def test_the_zip_is_what_gradescope_asks_for(autograder, tmp_path):
    scripts = [autograder / "source" / name for name in ("setup.sh", "run_autograder")]
    for script in scripts:
        assert script.read_bytes().startswith(b"#!/usr/bin/env bash\n") and b"\r" not in script.read_bytes()
    assert all(os.access(script, os.X_OK) for script in scripts)
    assert f'"hapticlab=={__version__}"' in scripts[0].read_text("utf-8")
    inside = {path.relative_to(autograder / "source").as_posix() for path in (autograder / "source").rglob("*") if path.is_file()}
    lab, answers = f"labs/{LAB.name}", f"answers/{LAB.name}"
    assert inside == {"setup.sh", "run_autograder", f"{lab}/{LAB.notebook.name}", f"{lab}/checks.py"} | {
        f"{answers}/{name}" for name in ("solution.py", "hidden.py")
    }
    assigned(tmp_path / "again.zip", "gradescope", "--personal")
    assert (tmp_path / "again.zip").read_bytes() == (autograder / "wall.zip").read_bytes()


@needs_bash
@pytest.mark.wide
def test_run_autograder_writes_what_a_submission_earned(autograder):
    numbers = own_numbers(LAB.lab(), INSTRUCTOR / LAB.name, 4, "ada@x.edu")
    assert numbers["K_OWN"] != 500.0, "as everybody has it; take another seed"
    own = f"damping_that_pays = {numbers['K_OWN'] * numbers['T_OWN'] / 2}"  # right for the student whom the metadata name
    hand_in(autograder / "submission", {"period_leak": WRONG["02"]["period_leak"], "damping_that_pays": own})
    users = {"users": [{"email": "ada@x.edu", "id": 12, "name": "Ada"}], "previous_submissions": []}
    (autograder / "submission_metadata.json").write_text(json.dumps(users), "utf-8")
    run_script(autograder / "source" / "run_autograder", AUTOGRADER_ROOT=autograder)
    results = json.loads((autograder / "results" / "results.json").read_text("utf-8"))
    scores = {one["name"]: one["score"] for one in results["tests"]}
    judged = {one.name: one.points for one in LAB.lab().exercises if one.judged}
    assert scores == {**judged, "period_leak": 0}
    assert results["score"] == 10 - judged["period_leak"]
    assert [path.name for path in (autograder / "results").iterdir()] == ["results.json"]
    assert all(map(of_nobody_else, (autograder / "source" / "answers").rglob("*")))


@pytest.fixture(scope="module")
def course(tmp_path_factory):
    """A folder with a question of PrairieLearn."""
    target = tmp_path_factory.mktemp("prairielearn") / "questions"
    assigned(target, "prairielearn")
    return target


#: schemas/infoQuestion.json and docs/externalGrading.md of PrairieLearn: key to what its value must be
INFO = {
    "uuid": lambda v: re.fullmatch(r"[0-9a-f]{8}-[0-9a-f]{4}-4[0-9a-f]{3}-[89ab][0-9a-f]{3}-[0-9a-f]{12}", v),
    "title": lambda v: isinstance(v, str) and v,
    "topic": lambda v: isinstance(v, str) and v,
    "type": lambda v: v == "v3",
    "gradingMethod": lambda v: v == "External",
    "singleVariant": lambda v: isinstance(v, bool),
    "externalGradingOptions": lambda v: isinstance(v, dict),
}
OPTIONS = {
    "enabled": lambda v: v is True,
    "image": lambda v: re.fullmatch(r"[a-z0-9][a-z0-9._/-]*(:[\w.-]+)?", v),
    "entrypoint": lambda v: v == "/grade/tests/run.sh",
    "timeout": lambda v: isinstance(v, int) and 0 < v <= 600,
    "enableNetworking": lambda v: v is False,
}


def test_the_question_has_the_fields_of_prairielearn(course):
    folder = course / LAB.name
    info = json.loads((folder / "info.json").read_text("utf-8"))
    assert set(info) == set(INFO) and all(INFO[key](value) for key, value in info.items())
    options = info["externalGradingOptions"]
    assert set(options) == set(OPTIONS) and all(OPTIONS[key](value) for key, value in options.items())
    page = (folder / "question.html").read_text("utf-8")
    assert f'<pl-file-upload file-names="{LAB.notebook.name}">' in page and "<pl-external-grader-results>" in page
    assert (folder / "clientFilesQuestion" / LAB.notebook.name).read_bytes() == LAB.notebook.read_bytes()
    assert not [path for path in folder.rglob("solution.py") if "tests" not in path.relative_to(folder).parts]
    assert f'"hapticlab=={__version__}"' in (course / "grader-image" / "Dockerfile").read_text("utf-8")


def graded_there(course, root, wrong, **variables):
    """Return the results of a submission in PrairieLearn's folder /grade."""
    shutil.copytree(course / LAB.name / "tests", root / "tests")
    if wrong is not None:
        hand_in(root / "student", wrong)
    else:
        (root / "student").mkdir()
        (root / "student" / LAB.notebook.name).write_text("{broken", "utf-8")
    (root / "data").mkdir()
    (root / "data" / "data.json").write_text(json.dumps({"variant_seed": "1kx9", "submitted_answers": {}}), "utf-8")
    run_script(root / "tests" / "run.sh", GRADE_ROOT=root, **variables)
    assert all(map(of_nobody_else, (root / "tests" / "answers").rglob("*")))
    return json.loads((root / "results" / "results.json").read_text("utf-8"))


@needs_bash
@pytest.mark.wide
def test_the_entrypoint_writes_what_a_submission_earned(course, tmp_path):
    results = graded_there(course, tmp_path, WRONG["02"])
    assert results["gradable"] is True
    assert results["score"] == pytest.approx(earned(LAB, WRONG["02"]) / 10)
    points = {one["name"]: one["points"] for one in results["tests"]}
    assert points["period_leak"] == 0 and points["two_walls"] == LAB.lab().exercise("two_walls").points


@needs_bash
@pytest.mark.wide
def test_a_broken_upload_costs_no_attempt(course, tmp_path):
    results = graded_there(course, tmp_path, None)
    assert results["gradable"] is False and "is not a notebook; it needs the JSON that Jupyter writes" in str(
        results["format_errors"]
    )


@needs_bash
@pytest.mark.slow
@pytest.mark.skipif(shutil.which("timeout") is None, reason="timeout, by which the scripts end what takes too long")
def test_what_takes_too_long_is_told_before_the_system_ends_it(autograder, course, tmp_path):
    results = graded_there(course, tmp_path / "grade", {}, GRADE_SECONDS=0.1)
    assert results == {"gradable": False, "format_errors": ["The grader failed, or took too long. Tell your instructor."]}
    (tmp_path / "submission").mkdir()
    shutil.copytree(autograder / "source", tmp_path / "source")
    code, said = done_by(tmp_path / "source" / "run_autograder", AUTOGRADER_ROOT=tmp_path, GRADE_SECONDS=0.1)
    assert code == 124 and "Grading took too long" in said
    assert list((tmp_path / "results").iterdir()) == [], "no points are written down"
