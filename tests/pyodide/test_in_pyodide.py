"""hapticlab in Pyodide, by its wheel: what the helper gives, and that the wheel is complete there."""

import pytest
from in_pyodide import run_in_pyodide, wheel

pytestmark = pytest.mark.wide


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
    assert engine == "wasm 11"
    assert board.startswith("host 0000, firmware")
    assert "wheel for every target" in " ".join(missing)
