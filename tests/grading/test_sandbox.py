"""Walls hold against real attacks: in namespaces as whoever runs the tests and as nobody, and as another user without them."""

import json
import os
import subprocess
import sys

import pytest
from walls import ATTACKS, hidden, tried

from hapticlab.grading.starter import PACKAGE, start

EXPECTED = {name: expected for name, (_, expected) in ATTACKS.items()}
NOBODY = 65534
needs_root = pytest.mark.skipif(os.name != "posix" or os.geteuid() != 0, reason="needs root to become another user")


def elsewhere(level, user, *left_out):
    """Return what the attacks come to in another process."""
    here = os.path.dirname(__file__)
    command = [sys.executable, os.path.join(here, "walls.py"), level, str(user), *left_out]
    environment = {**os.environ, "PYTHONPATH": str(PACKAGE.parent)}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_namespaces_hold(tmp_path, monkeypatch):
    monkeypatch.setenv("SECRET", "seen")
    paths = hidden(tmp_path)
    with start("namespaces", hidden=paths) as starter:
        assert tried(starter, paths) == {"problem": "", **EXPECTED}


@needs_root
def test_namespaces_hold_where_the_grader_is_nobody():
    assert elsewhere("namespaces", NOBODY) == {"problem": "", **EXPECTED}


@needs_root
def test_another_user_keeps_to_itself():
    # nothing is masked at this level, /proc is the system's, and files are counted from outside
    without = {"masked_file", "masked_folder", "other_processes", "many_files"}
    expected = {name: words for name, words in EXPECTED.items() if name not in without}
    seen = {"answers": "PermissionError", "grader": "PermissionError", "site_packages": "OSError"}
    found = elsewhere("user", 0, *without)
    assert "chmod -R go=" in found.pop("refused")  # while the answers could be read
    assert found == {"problem": "", **expected, **seen}
