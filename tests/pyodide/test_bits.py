"""The tests of bits themselves, run in Pyodide: committed programs, random ones and linked scenes on the engines there."""

import re

import pytest
from in_pyodide import pytest_in_pyodide

pytestmark = pytest.mark.wide


def passed(last):
    return int(re.match(r"(\d+) passed", last)[1])


def test_every_engine_gives_the_committed_bits():
    """On the interpreter, on the firmware's machine with words of 8 and 16 bits, and as WebAssembly."""
    assert passed(pytest_in_pyodide("tests/compiler/test_golden.py", "-k", "every_engine")) == 4 * 9


def test_random_programs_and_linked_scenes_give_the_interpreters_bits_as_webassembly():
    chosen = "random_program and (3-mixed or 4-f32 or 5-f64) or linked_with_a_paddle or unlocated"
    assert passed(pytest_in_pyodide("tests/compiler/engines/test_wasm.py", "-k", f"not node and ({chosen})")) > 10


@pytest.mark.slow
def test_every_random_program_gives_the_interpreters_bits_as_webassembly():
    assert passed(pytest_in_pyodide("tests/compiler/engines/test_wasm.py", "-k", "a_random_program")) == 90
