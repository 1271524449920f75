"""The rule that a skip fails in CI, tried on a folder of its own."""

import importlib.util
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
SKIPPED_WHOLE = "import pytest\npytest.importorskip('no_such_module_at_all')\n"


def run(folder, environment):
    """Run the folder's tests by this rule, in an environment that says nothing else."""
    (folder / "conftest.py").write_text(CONFTEST.read_text())
    clean = {k: v for k, v in os.environ.items() if k not in ("CI", "HAPTICLAB_ALLOWED_SKIP", "PYTEST_ADDOPTS")}
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", str(folder)]
    return subprocess.run(command, env=clean | environment, cwd=folder, capture_output=True, text=True)


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
    (tmp_path / "test_it.py").write_text(SKIPPING)
    done = run(tmp_path, environment)
    assert done.returncode == code, done.stdout
    assert ("skipped in CI" in done.stdout) == bool(code)


def test_skip_of_a_whole_module_is_a_failure_in_ci(tmp_path):
    (tmp_path / "test_it.py").write_text(SKIPPED_WHOLE)
    done = run(tmp_path, {"CI": "true"})
    assert done.returncode != 0, done.stdout
    assert "skipped in CI" in done.stdout


@pytest.mark.skipif(not importlib.util.find_spec("xdist"), reason="needs pytest-xdist")
def test_both_are_failures_in_ci_where_other_processes_run_the_tests(tmp_path):
    (tmp_path / "test_it.py").write_text(SKIPPING)
    (tmp_path / "test_whole.py").write_text(SKIPPED_WHOLE)
    done = run(tmp_path, {"CI": "true", "PYTEST_ADDOPTS": "-n 1"})
    assert done.returncode != 0
    assert "1 failed, 1 passed, 1 error" in done.stdout, done.stdout
    assert "could not import" in done.stdout and "needs llvmlite" in done.stdout
