"""Whatever an answer is, for whatever kind of exercise and expected value: no error, no warning, no point for anything else."""

import math
import sys

import numpy as np
import pytest
import sympy as sp

import hapticlab as hl
from hapticlab.course.check import checked
from hapticlab.course.exercise import Case, Exercise


class Words(str):
    """A text that will not be asked."""

    def strip(self, *_):
        raise ValueError

    casefold = split = strip

    def __eq__(self, other):
        return True

    __hash__ = str.__hash__


class Row(list):
    def __iter__(self):
        raise KeyError

    def __len__(self):
        return -1


class Parts(dict):
    def items(self):
        raise ValueError


class NoNumber:
    def __float__(self):
        return "x"


class NamelessType(type):
    @property
    def __name__(cls):
        raise ValueError

    def __instancecheck__(cls, other):
        return True


class Nameless(metaclass=NamelessType):
    pass


class Mute(Exception):
    def __str__(self):
        raise Mute


def fails():
    raise Mute


ANSWERS = [
    0, 1, -1, 1e308, -1e308, math.nan, math.inf, -math.inf, True, False, "a", "2.4", "b" * 10**6, Words("c"), [], [[]], [1],
    [1, 2], [[1, 2], [3, 4]], [math.nan] * 3, [1, "a"], ["a", "b"], [None], np.array(2.4), np.zeros(0), np.zeros((3, 0)),
    np.ma.masked, np.ma.array([1.0, 2.0], mask=[0, 1]), np.datetime64("2020-01-01"), np.array(["2020"], dtype="M8"), sp.pi,
    sp.Symbol("k"), sp.zoo, sp.oo, sp.Matrix([1, 2]), sp.I, 1j, {}, {"F": 1}, {"F": None}, {1: 2}, {"F": {"F": 1}},
    {"F": [1, 2]}, {"F": "a"}, Parts(F=1), NoNumber(), Row([1, 2]), b"ab", memoryview(b"ab"), range(3), {1, 2}, iter([1]), len,
    type, Nameless, Nameless(), hl, hl.wall(), hl.wall, object(), NotImplemented, fails, np.float16(2.4), np.int8(3),
    np.bool_(True), np.str_("a"), np.void(b"a"), 10**400, sys.stdout, Exception("x"), np.array([1, 2], dtype=object),
    np.zeros((2, 2, 2)), np.array([object()], dtype=object), np.array([1 + 2j]),
]  # fmt: skip
EXPECTED = [
    2.4, True, False, "a", (1.0, 2.0), [[1.0, 2.0], [3.0, 4.0]], {"F": 1.0}, {"F": [1.0, 2.0]}, {"F": True, "G": "a"}, 1e308,
]  # fmt: skip
#: the right ones among them, by their places
RIGHT = {0: {23}, 1: {8, 64}, 2: {9}, 3: {10, 65}, 4: {17, 70}, 5: {18}, 6: {38}, 7: {42}, 8: set(), 9: {3}}


@pytest.mark.parametrize("kind", ["function", "value", "scene"])
@pytest.mark.parametrize("place", range(len(EXPECTED)))
def test_only_what_is_expected_is_right(kind, place):
    given = {"x": [0.0, 0.1]} if kind == "scene" else {}
    exercise = Exercise("q", kind, 1, cases=[Case(given, EXPECTED[place])])
    given = [(lambda answer=answer: answer) if kind == "function" else answer for answer in ANSWERS]
    results = [checked("98.q", exercise, answer) for answer in given]
    assert {i for i, result in enumerate(results) if result.passed} == (set() if kind == "scene" else RIGHT[place])
    assert max(len(result.text) for result in results) < 1000


@pytest.mark.parametrize("kind", ["prediction", "text"])
def test_what_is_noted_takes_anything_that_can_be_read(kind):
    assert {type(checked("98.q", Exercise("q", kind), answer).passed) for answer in ANSWERS} == {bool}
