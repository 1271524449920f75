"""The inventory as data: 28 questions, named misconceptions, own numbers and order for each student, no key in a notebook."""

import re
from collections import Counter
from string import Formatter

import nbformat
import pytest

from hapticlab.course.concepts.inventory import CONCEPTS, OCCASIONS, form, questions
from hapticlab.course.concepts.misconceptions import MISCONCEPTIONS
from hapticlab.course.concepts.question import LETTERS, Question, fingerprint
from hapticlab.course.concepts.questionnaire import MINUTES, WORDS, notebook_of
from hapticlab.course.labs import find_labs
from hapticlab.course.notebook import code_of, run, text_of
from hapticlab.errors import CourseError

NAMES = [question.name for _, question in questions().values()]


def test_every_concept_has_three_or_four_questions_and_every_name_is_there_once():
    assert len(CONCEPTS) == 8 and {len(concept.questions) for concept in CONCEPTS} == {3, 4}
    assert len(set(NAMES)) == len(NAMES) == 28
    assert list(questions()) == [f"q{number:02}" for number in range(1, 29)]


def test_every_wrong_option_is_a_misconception_that_labs_treat():
    used = {name for _, question in questions().values() for name in question.wrong}
    assert used == set(MISCONCEPTIONS)
    assert len({one.title for one in MISCONCEPTIONS.values()}) == len(MISCONCEPTIONS)
    there = {folder.number for folder in find_labs()}
    assert {lab for one in MISCONCEPTIONS.values() for lab in one.labs} <= there
    assert all(one.labs and one.belief.endswith(".") for one in MISCONCEPTIONS.values())
    assert {lab for one in MISCONCEPTIONS.values() for lab in one.labs} >= {f"{lab:02}" for lab in range(16)}


def test_options_differ_for_all_numbers_and_every_place_is_filled():
    for seed in range(60):
        for one in form(seed, "ada", "after"):
            assert len({option.text for option in one.options}) == len(LETTERS), (one.question.name, one.numbers)
            assert [option.letter for option in one.options] == list(LETTERS)
            assert not re.search(r"nan|inf|\{|e[-+]\d", " ".join([one.text, *(option.text for option in one.options)]))


def test_the_right_option_is_not_known_by_its_length():
    """Of the questions with options in words; by chance it would be the longest in a quarter of them."""
    lengths = []
    for _, question in questions().values():
        texts = [text.format(**question.numbers("any")) for text in (question.right, *question.wrong.values())]
        if max(map(len, texts)) > 25:
            lengths.append([len(text) for text in texts])
    longest = sum(one[0] > max(one[1:]) for one in lengths)
    assert len(lengths) >= 12 and longest <= len(lengths) / 3


def test_a_smaller_number_is_never_right_as_well():
    """What holds up to a stiffness also holds below it, so the question asks for the limit."""
    asks = {question.name: question.asks for _, question in questions().values()}
    for name in ("value_for_a_guarantee", "virtual_damper_in_the_wall", "compensation_everywhere"):
        assert "Up to which stiffness" in asks[name]
    assert "smallest viscous damping" in asks["damping_required"]


def test_words_of_the_course_are_explained_before_the_first_question():
    """The questions are also given before any lab."""
    cells = notebook_of(3, "ada", "before")["cells"]
    places = [cell["id"] for cell in cells]
    assert places.index("words") < places.index("q01-asks")
    words = cells[places.index("words")]["source"]
    asked = " ".join(cell["source"] for cell in cells[places.index("words") + 1 :])
    for word in (
        "virtual wall",
        "passive",
        "sample",
        "hold",
        "virtual damper",
        "count",
        "Weber fraction",
        "dry friction",
        "load",
    ):
        assert word.lower() in asked.lower() and re.search(rf"\*{word}s?\*", words, re.I), word


def test_all_numbers_that_are_drawn_are_used():
    for _, question in questions().values():
        texts = [question.asks, question.right, *question.wrong.values()]
        places = {name for text in texts for _, name, _, _ in Formatter().parse(text) if name}
        numbers = question.numbers("any")
        of_functions = {name for one in question.computes.values() for name in one.__code__.co_varnames}
        assert set(numbers) <= places | of_functions, question.name
        assert places <= set(numbers), question.name


def test_numbers_and_order_are_each_students_own_and_stay():
    forms = {(student, occasion): form(3, student, occasion) for student in ("ada", "bob", "") for occasion in OCCASIONS}
    assert len({fingerprint(one) for one in forms.values()}) == len(forms)
    assert forms["ada", "before"] != form(4, "ada", "before")
    assert fingerprint(forms["ada", "before"]) == "335eaf55c354"  # a release that changes it no longer reads what is handed out
    places = Counter(one.key for seed in range(60) for one in form(seed, "ada", "before"))
    expected = sum(places.values()) / len(LETTERS)
    assert all(abs(count - expected) < 4 * expected**0.5 for count in places.values())
    orders = [tuple(option.misconception for option in form(seed, "ada", "before")[0].options) for seed in range(200)]
    assert len(set(orders)) == 24  # every order of four options


def test_a_notebook_has_the_form_that_the_package_writes_and_no_key():
    notebook = notebook_of(3, "ada", "before")
    nbformat.validate(nbformat.reads(text_of(notebook), as_version=4))
    assert len({cell["id"] for cell in notebook["cells"]}) == len(notebook["cells"])
    text = "\n".join(cell["source"] for cell in notebook["cells"])
    secrets = [*MISCONCEPTIONS, *NAMES, *(one.title for one in MISCONCEPTIONS.values()), "hl.check(", "seed", "ada"]
    assert [word for word in secrets if re.search(rf"\b{re.escape(word)}", text)] == []
    assert [line for source in code_of(notebook) for line in source.splitlines() if len(line) > 88] == []
    formulas = [cell["source"] for cell in notebook["cells"] if cell["cell_type"] == "markdown"]
    assert not [one for one in formulas if one.count("$") % 2]


@pytest.mark.parametrize("pictures", [False, pytest.param(True, marks=pytest.mark.wide)])
def test_a_notebook_runs_and_names_what_has_no_answer(tmp_path, pictures):
    sources = [one for one in code_of(notebook_of(3, "", "after")) if pictures or one.count("hl.") == 0]
    _, problems, printed = run(sources, tmp_path)
    assert problems == [] and "Not answered: q01, q02, " in printed
    answered = [re.sub(r"^(q\d\d) = None", r'\1 = "b"', source) for source in sources]
    names, problems, printed = run(answered, tmp_path)
    assert problems == [] and printed.endswith("Not answered: none\n") and names["q28"] == "b"


def test_the_stated_time_is_that_of_reading_and_half_a_minute_of_thought():
    asked = form(3, "ada", "before")
    words = sum(len(text.split()) for one in asked for text in (one.text, *(option.text for option in one.options)))
    words += len(WORDS.split())
    assert 20 <= words / 200 + 0.5 * len(asked) <= MINUTES


@pytest.mark.parametrize("wrong", [{"a": "1"}, {"a": "1", "b": "2", "c": "3", "d": "4"}])
def test_a_question_has_four_options(wrong):
    with pytest.raises(CourseError, match="a question needs 3"):
        Question("one", "about", "?", "0", wrong)


def test_an_unknown_occasion_is_told():
    with pytest.raises(CourseError, match="it needs one of before, after"):
        form(0, "ada", "during")
