"""Marks do not depend on the file of a twin: a notebook that names one earns the same where the file is not."""

import json
from pathlib import Path

import pytest

from hapticlab.course.instructor import mark_notebook, solved_notebook
from hapticlab.course.labs import find_labs

ROOT = Path(__file__).parents[2]
LABS = {folder.number: folder for folder in find_labs(ROOT / "labs")}


@pytest.mark.parametrize("number", [pytest.param("03", marks=pytest.mark.wide), "10"])
def test_points_stay_where_the_file_of_a_twin_is_missing(number):
    folder, answers = LABS[number], ROOT / "tests" / "instructor" / LABS[number].name
    text = json.dumps(solved_notebook(folder, answers))
    named = 'profile(\\"hapkit\\")'
    assert text.count(named) == 1
    found = mark_notebook(folder, json.loads(text.replace(named, 'profile(\\"../benches/bench7.json\\")')), answers)
    assert "there is no such file" in found.problems[0].words
    assert found.earned == folder.lab().points
