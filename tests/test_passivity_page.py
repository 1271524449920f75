"""docs/explanation/passivity_control.md holds what its script finds now, as far as a test has time for it."""

import importlib.util
from pathlib import Path

import pytest

BENCHMARKS = Path(__file__).parent / "benchmarks"


@pytest.fixture(scope="module")
def script():
    spec = importlib.util.spec_from_file_location("passivity_page", BENCHMARKS / "passivity_control.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_what_is_written_and_counted_is_word_for_word(script):
    page = script.PAGE.read_text("utf-8")
    assert script.costs() in page
    assert [line for line in page.splitlines() if len(line) > 125 and line[:1] != "|"] == []
    texts = [part.split("}")[-1] for part in script.TEXT.split("{")]
    assert all(text in page for text in texts)


def test_simulated_numbers_agree_to_the_last_digit_but_one(script):
    """Other machines may round an exponential otherwise."""
    page = script.PAGE.read_text("utf-8").splitlines()
    for row in script.bounces().splitlines()[2:]:
        name, *found = (cell.strip() for cell in row.strip("|").split("|"))
        written = next(line for line in page if line.startswith(f"| {name} |"))
        kept = [cell.strip() for cell in written.strip("|").split("|")][1:]
        for a, b in zip(found, kept, strict=True):
            assert float(a) == pytest.approx(float(b), abs=1.01 * 10.0 ** -len(b.partition(".")[2])), name
