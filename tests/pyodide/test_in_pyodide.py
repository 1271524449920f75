"""hapticlab in Pyodide, by its wheel: the helper, bits, and labs and studies as they are here. One file, for one Pyodide.

The same verdicts, the same printed lines, the same bits as in Python of this computer.
"""

import json
import os
import re
import subprocess
import sys

import both_ways
import numpy as np
import pytest
from both_ways import IN_PYODIDE, ROOT
from in_pyodide import pytest_in_pyodide, run_in_pyodide, wheel
from test_golden import GOLDEN

from hapticlab.course.concepts.questionnaire import notebook_of
from hapticlab.course.labs import find_labs
from hapticlab.course.notebook import code_of

LABS = [folder.number for folder in find_labs(ROOT / "labs")]
#: run by .ci/run, all others by .ci/full
WIDE = {("untouched_lab", "02"), ("solved_lab", "06"), ("sweep",)}
#: lab: beginnings of lines whose number is what remains when nearly equal numbers are subtracted. SciPy's matrix exponential of
#: this handle in its hand differs in the last bit: every build of LAPACK rounds in an order of its own.
ROUNDING = {"04": ("dead-beat: ",), "11": ("dead-beat: ",)}


@pytest.mark.wide
def test_code_gets_values_and_a_folder_and_may_wait(tmp_path):
    (tmp_path / "given.txt").write_text("given")
    code = """
import asyncio
from pathlib import Path
await asyncio.sleep(0)
Path("made.txt").write_text(Path("given.txt").read_text() + word)
print("é", end="")
"""
    assert run_in_pyodide(code, tmp_path, word=" and made") == "é"
    assert (tmp_path / "made.txt").read_text() == "given and made"
    with pytest.raises(AssertionError, match="NameError: name 'word' is not defined"):
        run_in_pyodide("word")


@pytest.mark.wide
def test_what_a_run_leaves_on_the_event_loop_ends_with_it():
    code = """
import asyncio, sys
async def goes_on():
    while True:
        sys.counted = getattr(sys, "counted", 0) + 1
        await asyncio.sleep(0)
sys.kept = asyncio.ensure_future(goes_on())
await asyncio.sleep(0.01)
print(sys.counted > 0)
"""
    assert run_in_pyodide(code) == "True\n"
    assert run_in_pyodide("import sys\nprint(sys.kept.cancelled())") == "True\n"


@pytest.mark.wide
def test_the_wheel_for_a_browser_is_pure_and_brings_engines_labs_and_a_board():
    assert wheel().name.endswith("-py3-none-any.whl")
    code = """
import hapticlab as hl
from hapticlab.compiler.engines.engine import load
from hapticlab.compiler.engines import firmware_library
from hapticlab.course.labs import find_labs
from hapticlab.errors import EngineMissingError
program = hl.compile(hl.library.two_masses(), T=1e-3)
print(load(program).name, len(find_labs()))
with hl.connect("sim://hapkit") as paddle:
    print(paddle)
try:
    firmware_library.load_library(16, "-DHL_SLOTS=1")  # nothing can be built here
except EngineMissingError as missing:
    print(missing)
"""
    engine, board, *missing = run_in_pyodide(code).splitlines()
    assert engine == f"wasm {len(LABS)}"
    assert board.startswith("host 0000, firmware")
    assert "wheel for every target" in " ".join(missing)


@pytest.mark.wide
def test_a_notebook_of_questions_runs_and_names_what_has_no_answer():
    first, *others = code_of(notebook_of(3, "ada", "before"))
    cells = [first, *(re.sub("^(q1.) = None", '\\1 = "a"', source) for source in others)]
    code = "names = {'__name__': '__main__'}\nfor cell in cells:\n    exec(cell, names)"
    printed = run_in_pyodide(code, cells=cells).splitlines()[-1]
    assert printed.startswith("Not answered: q01, q02") and "q09, q20" in printed


@pytest.mark.wide
def test_a_request_that_would_leave_pyodide_fails_even_if_its_error_is_caught():
    code = "from js import fetch\ntry:\n    await fetch(url)\nexcept Exception as error:\n    print('refused')"
    with pytest.raises(AssertionError, match="requests that would have left Pyodide: .*127.0.0.1"):
        run_in_pyodide(code, url="http://127.0.0.1:50001/")
    assert run_in_pyodide("print('the next one is not blamed')")


# ---------------------------------------------------------------- bits


def passed(last):
    return int(re.match(r"(\d+) passed", last)[1])


@pytest.mark.wide
def test_every_engine_gives_the_committed_bits():
    """On the interpreter, on the firmware's machine with words of 8 and 16 bits, and as WebAssembly."""
    assert passed(pytest_in_pyodide("tests/compiler/test_golden.py", "-k", "every_engine")) == 4 * len(GOLDEN)


@pytest.mark.wide
def test_random_programs_and_linked_scenes_give_the_interpreters_bits_as_webassembly():
    chosen = "random_program and (3-mixed or 4-f32 or 5-f64) or linked_with_a_paddle or unlocated"
    assert passed(pytest_in_pyodide("tests/compiler/engines/test_wasm.py", "-k", f"not node and ({chosen})")) > 10


@pytest.mark.slow
def test_every_random_program_gives_the_interpreters_bits_as_webassembly():
    assert passed(pytest_in_pyodide("tests/compiler/engines/test_wasm.py", "-k", "a_random_program")) == 90


# ---------------------------------------------------------------- labs and studies


def there(name, *given):
    return json.loads(run_in_pyodide(IN_PYODIDE, ROOT, name=name, given=given).splitlines()[-1])


def here(name, *given):
    """In a process of its own, as a notebook's kernel is."""
    command = [sys.executable, both_ways.__file__, name, *given]
    done = subprocess.run(command, env={**os.environ, "MPLBACKEND": "agg"}, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout.splitlines()[-1])


def case(*words):
    return pytest.param(*words, id="-".join(words), marks=pytest.mark.wide if words in WIDE else pytest.mark.slow)


@pytest.mark.long
@pytest.mark.parametrize("state, number", [case(s, n) for n in LABS for s in ("untouched_lab", "solved_lab")])
def test_a_lab_earns_and_prints_the_same(state, number):
    browser, desktop = there(state, number), here(state, number)
    assert browser["raised"] == desktop["raised"] == []
    assert browser["marks"] == desktop["marks"]
    earned = sum(points for _, points, *_ in browser["marks"])
    assert earned == (0 if state == "untouched_lab" else 10)
    if number != "00":  # its simulated board runs by the clock
        skipped = ROUNDING.get(number, ())
        lines = [[line for line in found["printed"] if not line.startswith(skipped)] for found in (browser, desktop)]
        assert len(lines[0]) > 20
        assert lines[0] == lines[1]


@pytest.mark.parametrize("study", [case("readme_example"), case("sweep"), case("wall_map")])
def test_a_study_has_the_same_bits(study):
    browser, desktop = there(study), here(study)
    assert len("".join(browser["bits"])) > 16 * 500
    assert browser == desktop


@pytest.mark.slow
def test_a_tradeoff_has_the_same_rows():
    """Everything but errors of the force is equal. They are differences to a reference of SciPy, rounded otherwise there."""
    browser, desktop = (np.array(way("tradeoff")["rows"], dtype=object) for way in (there, here))
    assert browser.shape == desktop.shape and len(browser) > 500
    assert (browser[:, :-1] == desktop[:, :-1]).all()
    errors = [rows[:, -1].astype(float) for rows in (browser, desktop)]
    assert np.isfinite(errors[0]).sum() > 50
    np.testing.assert_allclose(*errors, rtol=1e-9)
