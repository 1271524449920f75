"""The rule that a skip fails in CI, tried on a folder of its own."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

CONFTEST = Path(__file__).with_name("conftest.py")
SKIPPING = """
import pytest

def test_runs(): pass

def test_skips(): pytest.skip("needs llvmlite")
"""


@pytest.mark.parametrize(
    ("environment", "code"),
    [
        ({}, 0),
        ({"CI": "true"}, 1),
        ({"CI": "true", "HAPTICLAB_ALLOWED_SKIP": "llvmlite"}, 0),
        ({"CI": "true", "HAPTICLAB_ALLOWED_SKIP": "needs a board"}, 1),
    ],
)
def test_skip_is_a_failure_in_ci(tmp_path, environment, code):
    (tmp_path / "conftest.py").write_text(CONFTEST.read_text())
    (tmp_path / "test_it.py").write_text(SKIPPING)
    clean = {k: v for k, v in os.environ.items() if k not in ("CI", "HAPTICLAB_ALLOWED_SKIP", "PYTEST_ADDOPTS")}
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", str(tmp_path)]
    done = subprocess.run(command, env=clean | environment, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == code, done.stdout
    assert ("skipped in CI" in done.stdout) == bool(code)


def test_skip_of_a_whole_module_is_a_failure_in_ci(tmp_path):
    (tmp_path / "conftest.py").write_text(CONFTEST.read_text())
    (tmp_path / "test_it.py").write_text("import pytest\npytest.importorskip('no_such_module_at_all')\n")
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", str(tmp_path)]
    environment = {k: v for k, v in os.environ.items() if k != "HAPTICLAB_ALLOWED_SKIP"} | {"CI": "true"}
    done = subprocess.run(command, env=environment, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode != 0, done.stdout
    assert "skipped in CI" in done.stdout
