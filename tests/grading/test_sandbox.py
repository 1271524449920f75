"""Walls hold against real attacks: in namespaces as whoever runs the tests and as nobody, and as another user without them."""

import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest
from walls import ATTACKS

from hapticlab.grading.sessions.starter import PACKAGE

EXPECTED = {name: expected for name, (_, expected) in ATTACKS.items()}
NOBODY = 65534
needs_root = pytest.mark.skipif(os.name != "posix" or os.geteuid() != 0, reason="needs root to become another user")


def elsewhere(*arguments, package=PACKAGE):
    """Return what the attacks come to in another process."""
    command = [sys.executable, os.path.join(os.path.dirname(__file__), "walls.py"), *map(str, arguments)]
    environment = {**os.environ, "PYTHONPATH": str(package.parent), "SECRET": "seen"}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


@pytest.mark.slow  # .ci/run has everything below /tmp
def test_namespaces_hold_where_the_package_lies_below_tmp():
    with tempfile.TemporaryDirectory(dir="/tmp") as folder:
        package = Path(shutil.copytree(PACKAGE, f"{folder}/hapticlab"))
        (package / "labs" / "02_virtual_wall").mkdir(parents=True, exist_ok=True)
        assert elsewhere("namespaces", package=package) == {"level": "namespaces", "problem": "", **EXPECTED}


@needs_root
@pytest.mark.wide
def test_namespaces_hold_where_the_grader_is_nobody():
    assert elsewhere("namespaces", NOBODY) == {"level": "namespaces", "problem": "", **EXPECTED}


#: what is otherwise where there are no namespaces: files are there and refused, by Landlock or by their rights
FILES = {
    "answers": "PermissionError", "masked_folder": "PermissionError", "programs": "True", "parents_memory": "PermissionError",
    "parents_environment": "PermissionError", "other_processes": "PermissionError",
}  # fmt: skip
OTHERWISE = {name: words for name, words in (EXPECTED | FILES).items() if name != "many_files"}


@pytest.mark.wide
@needs_root
@pytest.mark.parametrize(("user", "level"), [(0, "user"), (NOBODY, "landlock")])
def test_landlock_holds_where_there_are_no_namespaces(user, level):
    found = elsewhere("auto", user, "unshare")
    assert found.pop("level") == level and "unshare: Operation not permitted" in found.pop("namespaces")
    assert level == "user" or "only root" in found.pop("user")
    found["local_files"] = found["local_files"].replace("FileNotFoundError", "False")  # nothing says that it is there
    assert found == {"problem": "", **OTHERWISE}


@pytest.mark.wide
@needs_root
def test_another_user_keeps_to_itself_where_there_is_no_landlock():
    found = elsewhere("auto", 0, "unshare", "landlock")
    assert found.pop("level") == "user" and "unshare: Operation not permitted" in found.pop("namespaces")
    assert "chmod -R go=" in found.pop("refused")  # while the answers could be read
    # nothing of what all may read is masked at this level, and /proc is the system's
    seen = {"masked_file", "masked_folder", "other_processes", "local_files"}
    assert {**found, **dict.fromkeys(seen)} == {"problem": "", **OTHERWISE, **dict.fromkeys(seen)}


@pytest.mark.wide
@needs_root
def test_where_nothing_hides_files_calls_are_refused_still():
    found = elsewhere("auto", NOBODY, "unshare", "landlock")
    assert found["level"] == "none" and "Landlock" in found["landlock"] and "only root" in found["user"]
    refused = ("fork", "program", "network", "ptrace", "datagrams", "vmsplice", "in_memory", "locks", "grader")
    assert {name: found[name] for name in refused} == {name: EXPECTED[name] for name in refused}
