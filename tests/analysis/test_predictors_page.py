"""The page on predictors says what the code does: some of its cells are computed again."""

import re
import sys
from pathlib import Path

import pytest

from hapticlab.rendering.wall_laws import LAWS

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "tests" / "benchmarks"))
import predictors  # noqa: E402

PAGE = (ROOT / "docs" / "explanation" / "predictors.md").read_text("utf-8")


def cells(name):
    """Return a table of the page as {row: {column: text}}."""
    text = re.search(f"<!-- {name} -->\n(.*?)\n<!-- end {name} -->", PAGE, re.S)[1]
    head, _, *rows = [[cell.strip() for cell in line.strip("| ").split(" | ")] for line in text.splitlines()]
    return {row[0]: dict(zip(head[1:], row[1:], strict=True)) for row in rows}


@pytest.mark.parametrize(("condition", "law"), [("plain", "zoh"), ("delay T/2", "half_sample"), ("10 times K", "ellis")])
def test_energy_generated_is_what_the_page_says(condition, law):
    result = predictors.bounce(condition, laws=[law])
    made = result[law]
    said = cells("conditions")[law][condition], cells("worst")[law][condition]
    assert [float(text) for text in said] == pytest.approx(
        [100 * made.generated / result.incoming, 100 * made.worst / result.incoming], abs=0.02
    )


def test_a_limit_is_what_the_page_says():
    found = predictors.limit("delay T", laws=["half_sample"])["half_sample"].K
    assert float(cells("limits")["half_sample"]["delay T"]) == pytest.approx(found, rel=0.01)
    assert found == pytest.approx(0.1 / 1e-3, rel=0.04)  # b/T: at low frequency a period of delay leaves K T/2 of -damping


def test_the_swing_of_the_force_is_what_the_page_says():
    found = predictors.swings(laws=["ellis"], stiffnesses=(4000, 16000))["ellis"]
    said = cells("swings")["ellis"]
    assert [float(said["4000 N/m"]), float(said["16000 N/m"])] == pytest.approx(found, rel=0.01)
    assert found[0] == 0 and found[1] <= 4 * 16000 * 1e-5 * 1.01  # K count times 2 + 1.5 + 0.5; the soft wall is held by friction


@pytest.mark.slow
def test_the_costs_are_what_the_page_says():
    assert predictors.costs() in PAGE


def test_every_law_is_in_every_table():
    for name in ("plain", "bed", "conditions", "worst", "limits", "swings", "costs"):
        assert list(cells(name))[: len(LAWS)] == list(LAWS)
    assert list(cells("conditions")["zoh"]) == list(predictors.CONDITIONS)
    assert (ROOT / "docs" / "explanation" / "predictors.png").exists() and "predictors.png" in PAGE
