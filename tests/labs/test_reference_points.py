"""The reference points of lab 12: they are measured, several methods and laws reach all points, and no design reaches all."""

import runpy
from pathlib import Path

import pytest

import hapticlab as hl
from hapticlab.course.design_answer import dominated, points_of
from hapticlab.course.labs import find_labs

ROOT = Path(__file__).parents[2]
(FOLDER,) = (folder for folder in find_labs(ROOT / "labs") if folder.number == "12")
ANSWERS = ROOT / "tests" / "instructor" / FOLDER.name
SOLUTION, HIDDEN = (runpy.run_path(str(ANSWERS / name)) for name in ("solution.py", "hidden.py"))
SCENES = {"wall": HIDDEN["WALLS"], "mass": HIDDEN["MASSES"], "bumper": HIDDEN["BUMPERS"]}


def wall(T, law, velocity, **more):
    return {"T": T, "law": law, "velocity": velocity, **more}


def steps(T, method, hold, substeps=1):
    return {"method": method, "T": T, "substeps": substeps, "hold": hold}


#: designs of different kinds that reach all points on every scene
REACH = {
    "wall": [
        wall(1e-3, "zoh", "filtered", tau=2e-3),
        wall(7.5e-4, "half_sample", "kalman"),
        wall(1e-3, "backward_difference", "filtered", tau=2e-3),
        wall(7.5e-4, "ellis", "filtered", tau=2e-3),
    ],
    "mass": [
        steps(1.5e-3, "semi_implicit_euler", "zoh"),
        steps(2e-3, "exact", "foh"),
        steps(2e-3, "verlet", "foh"),
        steps(2e-3, "adams_bashforth3", "foh"),
    ],
    "bumper": [
        steps(2e-3, "semi_implicit_euler", "foh", 2),
        steps(2.5e-3, "semi_implicit_euler_damped", "foh", 2),
        steps(2.5e-3, "heun", "foh", 2),
    ],
}
#: where a student begins, who learnt these in lab 07 or sees them first in the notebook
FALL_SHORT = {
    "wall": [wall(1e-3, "zoh", "backward"), wall(2e-3, "zoh", "backward"), wall(1e-3, "zoh", "window")],
    "mass": [steps(1e-3, "rk4", "foh"), steps(1e-3, "verlet", "zoh"), steps(1e-3, "semi_implicit_euler", "soh")],
    "bumper": [steps(1e-3, "verlet", "zoh"), steps(1e-3, "semi_implicit_euler", "soh")],
}


def reached(name, constants, designs):
    """Return how many reference points each design dominates on a scene, and how many there are."""
    points = points_of({"task": name, **constants}, SOLUTION[f"{name}_design_points"])
    found = [hl.design.measured(hl.design.task(name, **constants), design) for design in designs]
    assert all(one.feasible for one in found)
    return [len(dominated(one.figures, points)) for one in found], len(points)


@pytest.mark.always("mass")
@pytest.mark.parametrize("name", SCENES)
def test_public_points_are_those_of_the_reference_designs(name):
    (case,) = FOLDER.lab().exercise(f"{name}_design").cases
    assert case.expected == points_of(case.given, SOLUTION[f"{name}_design_points"])
    cells = FOLDER.notebook.read_text("utf-8")
    assert all(f'\\"{letter}\\": ({", ".join(f"{one:g}" for one in point)}),' in cells for letter, point in case.expected.items())


@pytest.mark.slow
@pytest.mark.parametrize(("name", "number"), [(name, k) for name, several in SCENES.items() for k in range(len(several))])
def test_any_method_may_win_and_none_wins_everything(name, number):
    full = FOLDER.lab().exercise(f"{name}_design").full
    counts, whole = reached(name, SCENES[name][number], [SOLUTION[f"{name}_design"], *REACH[name]])
    assert whole == 8 and min(counts) >= full and max(counts) < whole
    assert max(reached(name, SCENES[name][number], FALL_SHORT[name])[0]) < full
