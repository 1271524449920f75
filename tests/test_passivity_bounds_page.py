"""docs/explanation/passivity_bounds.md holds what its script finds now: quick tables always, the page among the slow tests."""

import importlib.util
from pathlib import Path

import pytest

_SPEC = importlib.util.spec_from_file_location("passivity_bounds", Path(__file__).parent / "benchmarks" / "passivity_bounds.py")
script = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(script)


@pytest.mark.parametrize("part", ["laws", "between"])
def test_the_page_has_this_table(part):
    assert getattr(script, part)() in script.PAGE.read_text("utf-8")


@pytest.mark.slow
def test_the_page_is_fresh():
    assert script.PAGE.read_text("utf-8") == script.page()
