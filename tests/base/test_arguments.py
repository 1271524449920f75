"""Checks of arguments: what passes comes back as it is used, and a refusal is one sentence with cause and cure."""

import math
from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest

from hapticlab.base.arguments import choice, count, having, instance, number
from hapticlab.errors import AnalysisError, SceneError


@pytest.mark.parametrize("given", [2, 2.0, np.float32(2), np.int16(2), Fraction(2), Decimal(2)], ids=repr)
def test_numbers_of_any_library_pass_as_floats(given):
    found = number("K", given, "N/m", above=0)
    assert type(found) is float and found == 2.0


@pytest.mark.parametrize(
    ("given", "limits", "sentence"),
    [
        (-1, {"least": 0}, "b = -1 N s/m; a device needs b >= 0"),
        (0.0, {"above": 0}, "b = 0 N s/m; a device needs b > 0"),
        (math.nan, {}, "b = nan N s/m; a device needs a finite b"),
        (math.inf, {"least": 0}, "b = inf N s/m; a device needs b >= 0 and finite"),
        (
            "soft",
            {"least": 0},
            "b = 'soft'; a device needs b >= 0. Give a number in N s/m, or a text with its unit, such as '2 N s/m'",
        ),
        (
            "soft",
            {"least": 0, "why": "It pays."},
            "b = 'soft'; a device needs b >= 0. Give a number in N s/m, or a text with its unit, such as '2 N s/m'",
        ),
        (
            True,
            {"least": 0},
            "b = True; a device needs b >= 0. Give a number in N s/m, or a text with its unit, such as '2 N s/m'",
        ),
        (
            10**400,
            {},
            f"b = {10**400!r}; a device needs a finite b. Give a number in N s/m, or a text with its unit, such as '2 N s/m'",
        ),
        (3, {"above": 0, "most": 2, "what": "a part"}, "b = 3 N s/m; a device needs a part > 0 and <= 2"),
        (-1, {"least": 0, "why": "it pays"}, "b = -1 N s/m; a device needs b >= 0: it pays"),
        (-1, {"least": 0, "why": "It pays."}, "b = -1 N s/m; a device needs b >= 0. It pays."),
    ],
)
def test_a_number_out_of_range_is_refused_in_words(given, limits, sentence):
    with pytest.raises(AnalysisError) as refused:
        number("b", given, "N s/m", "a device", **limits)
    assert str(refused.value) == sentence


def test_a_bare_number_needs_neither_unit_nor_owner():
    with pytest.raises(SceneError, match=r"^mu = -0.1; needs mu >= 0$"):
        number("mu", -0.1, least=0, error=SceneError)


@pytest.mark.parametrize("given", [0, 10, 2.0, True, "2", None], ids=repr)
def test_a_count_is_a_whole_number_in_its_span(given):
    assert count("lines", np.int64(9), most=9) == 9
    with pytest.raises(AnalysisError, match=r"^lines = .*; a tremor needs a whole number of sinusoids, 1 to 9$"):
        count("lines", given, "a tremor", of="sinusoids", most=9)


@pytest.mark.parametrize("given", ["c", None, 1, ["a"], np.zeros(2)], ids=repr)
def test_a_choice_is_one_of_the_names_known(given):
    assert choice("law", "a", {"a": 1, "b": 2}) == "a" and choice("gate", None, ("a", None)) is None
    with pytest.raises(AnalysisError, match="needs one of a, b"):
        choice("law", given, {"a": 1, "b": 2})
    with pytest.raises(AnalysisError, match="needs 'a' .first. or 'b'"):
        choice("law", given, ("a", "b"), need="'a' (first) or 'b'")


def test_an_object_is_of_its_class_and_has_its_values():
    assert instance("n", 3, (int, float), "a number") == 3
    assert having(3 + 4j, "a complex number", "real", "imag") == 3 + 4j
    with pytest.raises(AnalysisError, match="^n = '3'; needs a number$"):
        instance("n", "3", (int, float), "a number")
    with pytest.raises(AnalysisError, match="^a str has no real; needs a number$"):
        having("3", "a number", "real")
