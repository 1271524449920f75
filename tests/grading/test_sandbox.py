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

from hapticlab.grading.starter import PACKAGE

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
        assert elsewhere("namespaces", package=package) == {"problem": "", **EXPECTED}


@needs_root
def test_namespaces_hold_where_the_grader_is_nobody():
    assert elsewhere("namespaces", NOBODY) == {"problem": "", **EXPECTED}


@needs_root
def test_another_user_keeps_to_itself():
    # nothing is masked at this level, /proc is the system's, and files are counted from outside
    without = {"masked_file", "masked_folder", "other_processes", "many_files", "zeros"}
    expected = {name: words for name, words in EXPECTED.items() if name not in without}
    seen = {"answers": "PermissionError", "grader": "PermissionError", "site_packages": "OSError"}
    found = elsewhere("auto", 0, *without)
    assert "unshare: Operation not permitted" in found.pop("namespaces")  # why it is not that level
    assert "chmod -R go=" in found.pop("refused")  # while the answers could be read
    assert found == {"problem": "", **expected, **seen}
