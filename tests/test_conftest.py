"""The rules of all tests, tried on a folder of its own: a skip fails in CI, no loop is left behind, nothing waits for ever."""

import importlib.util
import json
import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.machine_code

CONFTEST = Path(__file__).with_name("conftest.py")
SKIPPING = """
import pytest

def test_runs(): pass

def test_skips(): pytest.skip("needs llvmlite")
"""
SKIPPED_WHOLE = "import pytest\npytest.importorskip('no_such_module_at_all')\n"


LEAVES_A_LOOP = """
import asyncio

def test_leaves(): asyncio._set_running_loop(asyncio.new_event_loop())
"""
WAITS = "import threading\n\ndef test_waits(): threading.Event().wait()\n\ndef test_next(): pass\n"
WAITS_AT_ITS_END = """
import threading

def test_waits():
    try:
        threading.Event().wait()
    finally:
        threading.Event().wait()
"""


def run(folder, environment, *options):
    """Run the folder's tests by these rules, in an environment that says nothing else."""
    (folder / "conftest.py").write_text(CONFTEST.read_text("utf-8"), "utf-8")
    clean = {k: v for k, v in os.environ.items() if k not in ("CI", "HAPTICLAB_ALLOWED_SKIP", "PYTEST_ADDOPTS")}
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-p", "pytest_timeout", *options, str(folder)]
    alone = {"PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}  # the others take half of the time
    return subprocess.run(command, env=clean | alone | environment, cwd=folder, capture_output=True, text=True)


@pytest.mark.parametrize(
    ("environment", "code"),
    [
        ({}, 0),
        ({"CI": "true"}, 1),
        ({"CI": "true", "HAPTICLAB_ALLOWED_SKIP": "llvmlite"}, 0),
        ({"CI": "true", "HAPTICLAB_ALLOWED_SKIP": "needs a board"}, 1),
    ],
)
@pytest.mark.always("environment1-1", "environment2-0")
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


@pytest.mark.wide
@pytest.mark.skipif(not importlib.util.find_spec("xdist"), reason="needs pytest-xdist")
def test_both_are_failures_in_ci_where_other_processes_run_the_tests(tmp_path):
    (tmp_path / "test_it.py").write_text(SKIPPING)
    (tmp_path / "test_whole.py").write_text(SKIPPED_WHOLE)
    done = run(tmp_path, {"CI": "true"}, "-p", "xdist", "-n", "1")
    assert done.returncode != 0
    assert "1 failed, 1 passed, 1 error" in done.stdout, done.stdout
    assert "could not import" in done.stdout and "needs llvmlite" in done.stdout


@pytest.mark.wide
@pytest.mark.skipif(not importlib.util.find_spec("xdist"), reason="needs pytest-xdist")
def test_several_processes_begin_with_what_is_long(tmp_path):
    for name in "abc":
        (tmp_path / f"test_{name}.py").write_text("def test_runs(): pass\ndef test_too(): pass\n")
    (tmp_path / "test_d.py").write_text("import pytest\n@pytest.mark.long\ndef test_runs(): pass\n")
    done = run(tmp_path, {}, "-vv", "-p", "xdist", "-n", "1", "--dist", "loadfile", "--no-loadscope-reorder")
    ran = re.findall(r"PASSED .*test_(\w)\.py::", done.stdout)
    assert ran == [*"daabbcc"], done.stdout


def test_a_loop_that_a_module_leaves_running_is_an_error(tmp_path):
    (tmp_path / "test_it.py").write_text(LEAVES_A_LOOP)
    done = run(tmp_path, {})
    assert "1 passed, 1 error" in done.stdout and "still runs after this module" in done.stdout, done.stdout


@pytest.mark.wide
@pytest.mark.skipif(not hasattr(signal, "SIGALRM"), reason="without SIGALRM a limit ends the run, as in the next test")
def test_a_test_that_waits_for_ever_fails_where_nobody_can_interrupt_it(tmp_path):
    (tmp_path / "test_it.py").write_text(WAITS)
    done = run(tmp_path, {}, "--timeout=1")
    assert "1 failed, 1 passed" in done.stdout and "Timeout" in done.stdout, done.stdout


@pytest.mark.wide
def test_one_whose_clean_up_waits_too_ends_the_run_and_is_named(tmp_path):
    (tmp_path / "test_it.py").write_text(WAITS_AT_ITS_END)
    done = run(tmp_path, {}, "--timeout=1")
    assert done.returncode not in (0, None) and "test_waits" in done.stdout + done.stderr, done.stdout + done.stderr


def test_seconds_are_added_by_folder(tmp_path):
    (tmp_path / "tests" / "part").mkdir(parents=True)
    (tmp_path / "tests" / "part" / "test_it.py").write_text("def test_runs(): pass")
    file = tmp_path / "areas"
    file.write_text('{"tests/part": 100.0, "tests/other": 1.0}')
    done = run(tmp_path, {}, f"--areas={file}")
    assert "100.0  tests/part\n     1.0  tests/other\n   101.0  all\n" in done.stdout, done.stdout
    assert json.loads(file.read_text())["tests/part"] > 100
