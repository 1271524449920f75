"""Labs and studies give in Pyodide what they give here: the same verdicts, the same printed lines, the same bits."""

import json
import os
import subprocess
import sys

import both_ways
import numpy as np
import pytest
from both_ways import IN_PYODIDE, ROOT
from in_pyodide import run_in_pyodide

from hapticlab.course.labs import find_labs

LABS = [folder.number for folder in find_labs(ROOT / "labs")]
#: run by .ci/run, all others by .ci/full
WIDE = {("untouched_lab", "02"), ("solved_lab", "06"), ("sweep",)}
#: lab: beginnings of lines whose number is what remains when nearly equal numbers are subtracted. The gains of a dead-beat
#: wall come from LAPACK, and every build of it rounds in an order of its own.
ROUNDING = {"04": ("dead-beat: ",)}


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
