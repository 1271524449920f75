"""A design earns a part of the points for each reference point that it dominates, and nothing where it cannot run."""

import pytest

from hapticlab.course.check import checked
from hapticlab.course.design_answer import dominated, points_of
from hapticlab.course.evaluate import evaluate
from hapticlab.course.exercise import Case, Exercise, Lab
from hapticlab.course.judge import verdict
from hapticlab.course.marks import counted_cases, marks
from hapticlab.errors import CourseError

GOOD = {"T": 1e-3, "law": "half_sample", "velocity": "filtered", "tau": 2e-3}
PLAIN = {"T": 1e-3, "law": "zoh", "velocity": "backward"}
#: round numbers beside the figures of GOOD: 0.234 %, 34.5 %, 0.3 N s/m on the public scene
POINTS = {"A": [0.3, 40.0, 0.2], "B": [0.25, 36.0, 0.0], "C": [0.2, 60.0, 0.2], "D": [0.5, 20.0, -1.0]}
SLIP = "The backward difference passes every count."


def exercise(points=POINTS, full=2):
    case = Case({"task": "wall"}, points, slips=(({"velocity": "backward"}, SLIP),))
    return Exercise("wall", "design", points=3, full=full, cases=[case])


def earned(answer, own, hidden=None):
    (mark,) = marks(Lab("42", "Walls", 10, [own]), {"wall": answer}, hidden)
    return mark.earned


@pytest.mark.parametrize(("full", "points"), [(1, 3), (2, 3), (3, 2), (4, 1.5)])
def test_points_are_the_dominated_part_of_what_is_needed(full, points):
    assert earned(GOOD, exercise(full=full)) == pytest.approx(points), "A and B are dominated, C and D are not"


@pytest.mark.parametrize(
    ("figures", "names"),
    [
        ((0.3, 40.0, 0.2), ["A"]),  # its equal: none of the three is worse
        ((0.3005, 40.05, 0.199), ["A"]),  # as far as computers may round differently
        ((0.302, 40.0, 0.2), []),
        ((0.1, 10.0, 0.197), ["B", "D"]),
        ((0.1, 10.0, 9.0), ["A", "B", "C", "D"]),
        ((float("nan"), 10.0, 9.0), []),
    ],
)
def test_point_is_dominated_if_no_figure_is_worse(figures, names):
    assert dominated(figures, POINTS) == names


def test_worst_scene_decides():
    """A design that is good on the public scene alone earns nothing: that scene does not count where others do."""
    easy, hard = ({"A": [9.0, 90.0, -9.0], "B": [9.0, 90.0, -9.0]}, {"A": [0.001, 1.0, 9.0], "B": [9.0, 90.0, -9.0]})
    own = exercise()
    assert [case.given for case, _ in counted_cases(own, {"wall": [Case({"task": "wall", "K": 400.0}, easy)]})] == [
        {"task": "wall", "K": 400.0}
    ]
    hidden = [Case({"task": "wall", "K": 400.0}, easy), Case({"task": "wall", "K": 600.0}, hard)]
    assert earned(GOOD, own, {"wall": hidden}) == 1.5
    assert earned(GOOD, own, {"wall": [*hidden, Case({"task": "mass"}, easy)]}) == 0, "not even feasible on one scene"


class Lying(float):
    """A number that says something else to whoever asks twice."""

    asked = 0

    def __float__(self):
        Lying.asked += 1
        return 1e-3 if Lying.asked % 2 else 5.0


class Shifting(dict):
    def items(self):
        raise RuntimeError("look elsewhere")


@pytest.mark.parametrize(
    "answer",
    [
        "wall", {}, [], float("nan"), lambda: GOOD, {**GOOD, "T": float("nan")}, {**GOOD, "T": float("inf")},
        {**GOOD, "T": 1e308},
        {**GOOD, "T": "0.001"}, {**GOOD, "law": 1.0}, {**GOOD, "law": "zoh" * 10**6}, {**GOOD, "tau": -1.0},
        {**GOOD, "more": 1.0},
        {**GOOD, 7: 1.0}, {**GOOD, "T": {"T": 1e-3}}, {**GOOD, "T": [1e-3]}, {"error": 0.0, "load": 0.0, "margin": 9.0},
        Shifting(GOOD), {"wall": GOOD},
    ],
)  # fmt: skip
def test_what_is_no_design_earns_nothing_and_says_why(answer):
    own = exercise(full=1)
    found = verdict(own, own.cases[0], evaluate("design", answer, {}))
    assert (found.right, found.share) == (False, 0.0) and found.words and len(found.words) < 500
    assert earned(answer, own) == 0


def test_number_is_read_once():
    """What is measured is what was read, whatever the number says later."""
    plain = evaluate("design", {**GOOD, "T": Lying(7.0)}, {}).value
    assert type(plain["T"]) is float and plain["T"] in (1e-3, 5.0)


def test_card_names_the_nearest_points_and_the_slip():
    text = checked("42.wall", exercise(), PLAIN).text
    assert "dominates no reference point, 0 of 4; all points need 2" in text
    assert "A by 0.07 % of error and 1.4 N s/m of margin" in text and SLIP in text
    part = checked("42.wall", exercise(full=4), GOOD)
    assert not part.passed and "50% of the points in the public cases" in part.text and "dominates A, B, 2 of 4" in part.text


def test_slip_is_not_told_of_what_is_no_design_for_another_reason():
    assert SLIP in checked("42.wall", exercise(), PLAIN).text
    text = checked("42.wall", exercise(), {**PLAIN, "T": 0}).text
    assert "T = 0 s; it needs" in text and SLIP not in text


def test_reference_points_are_figures_of_feasible_designs():
    points = points_of({"task": "wall"}, {"good": GOOD, "fast": {**GOOD, "T": 2.5e-4}})
    assert list(points) == ["good"] and points["good"] == [0.237, 34.5, 0.3]


@pytest.mark.parametrize(
    ("kind", "full", "said"),
    [("design", 0, "a design needs full >= 1"), ("value", 2, "no other kind has it"), ("design", 9, "only 4 reference points")],
)
def test_exercise_is_checked(kind, full, said):
    with pytest.raises(CourseError, match=said):
        Exercise("wall", kind, points=1, full=full, cases=[Case({"task": "wall"}, POINTS)])
