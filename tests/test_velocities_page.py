"""docs/explanation/velocities.md holds what its script finds now: a quick table always, the whole page among the slow tests."""

import importlib.util
from pathlib import Path

import pytest

_SPEC = importlib.util.spec_from_file_location("velocities", Path(__file__).parent / "benchmarks" / "velocities.py")
script = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(script)


def test_the_page_has_the_table_of_pulses():
    assert script.pulses() in script.PAGE.read_text("utf-8")


@pytest.mark.slow
def test_the_page_is_fresh():
    assert script.PAGE.read_text("utf-8") == script.page()
