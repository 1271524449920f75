"""Nothing that was handed in is imported, or open, where marks are made."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from attacks.small_lab import HONEST, notebook, write_lab

#: modules that Python, this package and what it uses import late or in each process
SHADOWS = (
    "multiprocessing", "json", "types", "socket", "resource", "encodings", "site", "sitecustomize", "usercustomize", "numpy",
    "sympy", "hapticlab", "subprocess", "_bootsubprocess", "runpy", "pickle", "signal", "selectors", "tqdm", "ctypes", "ast",
)  # fmt: skip
TRAP = "open({mark!r}, 'a').write(__name__ + ' ')\n"


@pytest.fixture
def submissions(tmp_path):
    write_lab(tmp_path)
    folder = tmp_path / "submissions"
    folder.mkdir()
    (folder / "ada.ipynb").write_bytes(notebook(HONEST.values()))
    for name in SHADOWS:
        (folder / f"{name}.py").write_text(TRAP.format(mark=str(tmp_path / "mark")))
    return folder


def graded(submissions, *options, **environment):
    command = [shutil.which("hapticlab", path=str(Path(sys.executable).parent)), "grade", "ada.ipynb", *options]
    lab = ["--lab", str(submissions.parent / "labs" / "42_small_wall"), "--instructor", str(submissions.parent / "instructor")]
    env = {**os.environ, **environment}
    done = subprocess.run([*command, *lab, "--format", "json"], cwd=submissions, env=env, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)["reports"]


@pytest.mark.parametrize(("level", "workers"), [("auto", "1"), ("auto", "2"), ("none", "2")])
@pytest.mark.always("auto-1")
def test_no_process_imports_from_the_working_folder(submissions, level, workers):
    (report,) = graded(submissions, "--sandbox", level, "--workers", workers)
    assert sum(one["earned"] for one in report["exercises"]) == 10
    assert not (submissions.parent / "mark").exists(), (submissions.parent / "mark").read_text()


@pytest.mark.wide
@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
def test_what_grades_holds_nothing_that_was_handed_in_open(submissions):
    # a cell that looks at every process of its user, which at this level are those of the grader
    look = f"""
import os
from glob import glob
def links(kind):
    found = []
    for path in glob(f"/proc/[0-9]*/{{kind}}"):
        try:
            found.append(os.readlink(path))
        except OSError:
            pass
    return found
guess = str([path for kind in ("fd/*", "cwd", "root") for path in links(kind) if path.startswith({str(submissions)!r} + "/")])
"""
    cells = [*HONEST.values(), look]
    (submissions / "ada.ipynb").write_bytes(notebook(cells))
    (report,) = graded(submissions, "--sandbox", "none", "--workers", "1")
    (guess,) = [one["text"] for one in report["exercises"] if one["name"] == "guess"]
    assert guess == "[]"
