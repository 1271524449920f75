"""What a wrong number looks like, judged from numbers alone: the right guess fires, and no other."""

import numpy as np
import pytest

from hapticlab.course.diagnose import FACTORS, slip
from hapticlab.course.exercise import Case, Exercise
from hapticlab.course.judge import judge


def said(wanted, got, **given):
    return slip(Exercise("answer"), Case(given, wanted), np.array(wanted), np.array(got))


@pytest.mark.parametrize("wanted", [2.5e-6, 3.7e4, [0.0, 1e-7, -4e-6]])
def test_a_square_of_millimetres_is_named(wanted):
    assert said(wanted, np.multiply(1e6, wanted)).startswith("It is 1000000 times too large. Was a value in millimetres")
    assert said(wanted, np.multiply(1e-6, wanted)).startswith("It is 1000000 times too small. Was a value in millimetres")


def test_every_factor_is_named_in_its_own_words_at_any_size():
    wanted = np.array([0.7, -1.3, 0.0, 2.9])
    for size in (1e-9, 1e-3, 1.0, 1e6):
        assert [said(size * wanted, factor * size * wanted) for factor, _ in FACTORS] == [words for _, words in FACTORS]


@pytest.mark.parametrize("wanted", [1e-7, 2e-11, [3e-8, -1e-7]])
@pytest.mark.parametrize("got", [0.0, 3e-13, -4e-13])
def test_beside_a_small_number_zero_and_rounding_are_no_factor(wanted, got):
    assert said(wanted, np.full(np.shape(wanted), got)) == ""


def test_only_the_whole_answer_has_a_factor():
    assert said([1.0, 2.0, 3.0], [1e6, 2e6, 3.1e6]) == ""
    assert said([1.0, 2.0], [1e6, 2.0]) == ""


@pytest.mark.parametrize(
    "given, factor, words",
    [
        ({"T": 1e-3}, 1e-6, "In this case T^2 = 1e-06, so a factor T^2 may also be missing"),
        ({"T": 1e-3}, 1e6, "In this case T^2 = 1e-06, so a factor T^2 may also be missing"),
        ({"k": 500.0, "T": 1e-3}, 1e3, "In this case T = 0.001, so a factor T may also be missing"),
        ({"k": 2.0}, 0.5, "In this case k = 2, so a factor k may also be missing"),
    ],
)
def test_a_number_that_was_given_may_explain_the_factor_as_well(given, factor, words):
    assert words in said(0.25, factor * 0.25, **given)


@pytest.mark.parametrize("given", [{"T": 2e-3}, {"k": 500.0, "m": 0.05}, {"on": True}, {"x": [1e-3, 1e-3]}, {"m": 1.0}])
def test_other_numbers_that_were_given_are_not_blamed(given):
    assert "In this case" not in said(0.25, 250.0, **given)
    assert said(0.25, -0.25, **given) == "The sign is wrong."


@pytest.mark.parametrize(
    "given, words", [({"g": 9.81}, ""), ({"values": {"g": 9.81}}, "9.8 instead of 9.81"), ({"K": 100.0}, "a small term")]
)
def test_g_is_blamed_only_where_an_exercise_has_it(given, words):
    assert (words or "9.8 instead of 9.81") in said(9.0, 9.02, **given)


def test_a_condition_left_out_or_turned_is_told_of_a_force_alone():
    wanted, ungated, turned = np.array([0, 0, 0, 2.0, 1.0]), np.array([-3, -1, -0.5, 2, 1]), np.array([-3, -1, -0.5, 0, 0])
    for got, words in ((ungated, "hl.when(condition, force, 0)"), (turned, "reversed, such as <= instead of >=.")):
        assert words in slip(Exercise("f", "scene"), Case({}, wanted, unit="N"), wanted, got)
        assert slip(Exercise("f"), Case({}, wanted, unit="J"), wanted, got) == ""


def test_of_two_slips_near_each_other_the_exact_one_speaks_and_of_several_parts_the_known_one():
    case = Case(
        {}, {"z": 1.0, "w": 2.0}, slips=(({"z": 1.5}, "old velocity"), ({"w": 2.7}, "mass missing"), ({"w": 2.7001}, "other"))
    )
    exercise = Exercise("step", cases=[case])
    assert judge(exercise, case, {"z": 1.5, "w": 2.7001}).slip == "old velocity"
    assert judge(exercise, case, {"z": 1.5001, "w": 2.7}).slip == "mass missing"
    assert judge(exercise, case, {"z": 1.3, "w": 2.7001}).slip == "other"
