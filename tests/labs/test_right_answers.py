"""A right answer written another way than the solution earns the same."""

from pathlib import Path

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.course.check import checked
from hapticlab.course.labs import find_lab, find_labs
from hapticlab.course.marks import SOLUTION, hidden_cases, instructor_names, marks

ROOT = Path(__file__).parents[2]
FOLDERS = {folder.number: folder for folder in find_labs(ROOT / "labs")}


@pytest.mark.parametrize("closed", [np.less, np.less_equal])
def test_a_gap_of_exactly_zero_may_count_as_open_or_closed(closed):
    def penalty_force(gap, rate, k, b):
        return np.maximum(0, np.where(closed(gap, 0), -k * gap - b * rate, 0))

    assert checked("08.penalty_force", find_lab("08").exercise("penalty_force"), penalty_force).passed


def test_a_limit_may_be_drawn_by_the_package():
    def limit_over_delay(b, T):
        delay = np.linspace(0, 3, 60)
        return hl.plot({"": (delay, b / (T / 2 + 1e-3 * delay))}, xlabel="delay [ms]", ylabel="stiffness k [N/m]")

    lab = find_lab("03")
    hidden = hidden_cases(lab, ROOT / "tests" / "instructor" / FOLDERS["03"].name)
    assert checked("03.limit_over_delay", lab.exercise("limit_over_delay"), limit_over_delay).passed
    (found,) = (
        mark for mark in marks(lab, {"limit_over_delay": limit_over_delay}, hidden) if mark.exercise == "limit_over_delay"
    )
    assert found.earned == found.points


@pytest.mark.wide
@pytest.mark.parametrize("seed", range(40))
def test_the_momentum_that_a_heavy_plate_gains_is_the_impulse(seed):
    def impact(v, w, m, M, e):
        momentum, mass = m * v + M * w, m + M
        after = {"v": (momentum - M * e * (v - w)) / mass, "w": (momentum + m * e * (v - w)) / mass}
        return {**after, "p": M * (w - after["w"])}

    lab = find_lab("08")
    hidden = hidden_cases(lab, ROOT / "tests" / "instructor" / FOLDERS["08"].name, seed)
    (found,) = (mark for mark in marks(lab, {"impact": impact}, hidden) if mark.exercise == "impact")
    assert found.earned == found.points


@pytest.mark.parametrize(("number", "name", "missing"), [("01", "mass_on_coupler", "z"), ("06", "pendulum", "theta")])
def test_a_scene_that_watches_nothing_is_told_so_before_it_is_handed_in(number, name, missing):
    """Whether it is watched was once asked in hidden cases alone."""
    right = instructor_names(ROOT / "tests" / "instructor" / FOLDERS[number].name / SOLUTION)[name]
    unwatched = type(right)(force=right.force, eom=right.eom, values=right.values)
    found = checked(f"{number}.{name}", find_lab(number).exercise(name), unwatched)
    assert not found.passed and f"the scene does not watch {missing}; it watches" in found.text
