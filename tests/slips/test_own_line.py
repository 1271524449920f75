"""Which line is the student's own, and what of it is looked at."""

import ast

import numpy as np
import sympy as sp

import hapticlab as hl
from hapticlab.slips.foreign import in_our_words
from hapticlab.slips.own_line import code_of, of_call, of_error, ours
from hapticlab.slips.shown import one_breath
from hapticlab.slips.swallowed import swallowed


def caught(call):
    try:
        call()
    except Exception as problem:
        return problem
    raise AssertionError("it raised nothing")


def test_the_last_own_line_is_told_whoever_called_it():
    def force():
        return hl.Scene(
            force=hl.x(hl.n),
        )

    own = of_error(caught(lambda: hl.sweep(force(), None, k=[1])).__traceback__)
    assert own.text == "return hl.Scene(\n    force=hl.x(hl.n),\n)"
    assert own.where.startswith("test_own_line.py, line ")


def test_of_a_statement_with_a_body_the_head_is_told():
    a = sp.Symbol("a")

    def ask():
        if a > 1:
            return 1
        return 0

    own = of_error(caught(ask).__traceback__)
    assert own.text == "if a > 1:"
    assert {one.id for one in own.walk() if isinstance(one, ast.Name)} == {"a"}


def test_an_error_without_an_own_line_has_none():
    assert of_error(None) is None
    problem = caught(lambda: compile("x(", "cell", "exec"))
    assert one_breath(problem) == "" == one_breath(ValueError("never raised"))


def test_what_hapticlab_made_is_known_however_deep():
    k = hl.parameters("k", units="N/m")
    for value in (hl, hl.laws, hl.Scene, hl.wall, hl.x, hl.wall(), k**2 + 1, [1, {"a": (k,)}], np.array([k, 1]), hl.x(hl.n) > 1):
        assert ours(value), value
    for value in (np, sp, np.sin, sp.Symbol("k") ** 2, [1, {"a": (2,)}], np.ones(3), "hl", None, sp.Symbol, len):
        assert not ours(value), value


def test_another_librarys_attribute_is_never_computed():
    """A property may take long, or do something."""

    class Device:
        @property
        def motor(self):
            raise AssertionError("it was read")

    own_device = Device()
    node = ast.parse("own_device.motor", mode="eval").body
    own = of_call()
    assert own.value(node.value) is own_device and own.value(node) is None


def test_an_answer_whose_error_raises_when_it_is_read_is_shown_as_ever():
    class Wicked(Exception):
        def __str__(self):
            raise ValueError("no words")

    def call():
        hl.wall()
        raise Wicked

    assert one_breath(caught(call)) == ""


def test_what_python_computed_is_found_in_this_statement_and_where_its_names_come_from():
    half = 1 // 2
    energy = half * 3
    assert energy == 0
    own = of_call()
    assert swallowed(own, "") == ""  # of_call() uses neither
    assert swallowed(of_call() if energy == 0 else own, "") == "Your code has 1//2, which rounds down to 0. Write 1/2."
    whole = 4 // 2
    assert swallowed(of_call() if whole else own, "") == ""


def test_code_is_written_as_students_do():
    assert code_of(ast.parse("k * (x(n) - x_o) / m ** 2 // 3")) == "k*(x(n) - x_o)/m**2//3"


def test_a_message_that_the_table_does_not_know_has_no_words():
    problem = caught(lambda: int("a"))
    assert in_our_words(problem, of_error(problem.__traceback__)) == ""


def test_a_loop_over_what_is_no_expression_is_not_called_one():
    wrong = [lambda: list(hl.Hand("pinch")), lambda: list(hl.library), lambda: [hl.Scene(force=0) for _ in None]]
    for call in wrong:
        problem = caught(call)
        assert "one expression" not in in_our_words(problem, of_error(problem.__traceback__))
    problem = caught(lambda: list(hl.x(hl.n)))
    assert "one expression" in in_our_words(problem, of_error(problem.__traceback__))
