"""The card of a check: the same words in text and in HTML, no script, no id; and the progress of a lab beside the notebook."""

import json
from html.parser import HTMLParser

import pytest

import hapticlab as hl
from hapticlab.course import check as checks
from hapticlab.course.cards.card import SIGNS, Card
from hapticlab.course.cards.progress import FILE, remember
from hapticlab.course.check import checked
from hapticlab.course.exercise import Case, Exercise

SLIP = "The sign is wrong: <F_e> is the force on the wall."
CASES = [Case({"x": 0.5 * i}, 1.0 * i, unit="N", slips={-1.0 * i: SLIP}) for i in (1, 2, 3)]
FORCE = Exercise("force", points=2, asks="F", cases=CASES, hint="Which way?", matters="It is in every lab.")


class Reader(HTMLParser):
    """What a page has: its text, and each element with its attributes."""

    def __init__(self, page):
        super().__init__()
        self.words, self.elements, self.open = [], [], []
        self.feed(page)

    def handle_starttag(self, tag, attributes):
        self.elements.append((tag, dict(attributes)))
        self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.words.append(data)

    @property
    def text(self):
        return " ".join("".join(self.words).split())


def stated(answer):
    """The card of an answer, and its HTML as it is read with every style removed."""
    card = checked("98.force", FORCE, answer).card
    page = Reader(card.html())
    assert page.open == []
    assert {tag for tag, _ in page.elements} <= {"div", "p", "span", "strong", "code"}
    assert {name for _, attributes in page.elements for name in attributes} <= {"style", "aria-hidden"}
    for line in (card.head, *(f"{label}: {words}" for label, words in card.rows)):
        assert " ".join(line.split()) in page.text
    assert SIGNS[card.state] in page.text
    return card, page.text


@pytest.mark.parametrize(
    "answer, state, head",
    [
        (lambda x: 2 * x, "right", "right in the public cases"),
        (lambda x: 2 * x if x < 1 else 0.0, "partly", "partly right, not right yet: 1 of 3 public cases"),
        (lambda x: -2 * x, "wrong", "not right yet"),
        (None, "open", "not answered yet: F"),
    ],
)
def test_a_card_says_its_state_in_words_and_a_sign(answer, state, head):
    card, _ = stated(answer)
    assert (card.state, card.head) == (state, head)


def test_of_a_wrong_answer_the_slip_and_the_hint_come_once_after_the_first_wrong_case():
    card, page = stated(lambda x: -2 * x)
    assert [label for label, _ in card.rows] == ["wrong", "likely slip", "hint", "also wrong", "also wrong"]
    assert page.count(SLIP) == card.text().count(SLIP) == 1
    assert "It is in every lab." not in page


def test_what_goes_wrong_alike_in_all_cases_is_told_once():
    card, _ = stated(lambda x: missing)  # noqa: F821
    assert [label for label, _ in card.rows] == ["wrong", "hint"] and card.rows[0][1].endswith("(in 3 cases)")


def test_after_a_right_answer_a_sentence_says_why_it_matters():
    card, _ = stated(lambda x: 2 * x)
    assert card.rows[-1] == ("why it matters", "It is in every lab.")


def test_what_was_given_is_short():
    given = {f"a_long_name_{i}": [0.1] * 9 for i in range(5)}
    card = checked("98.many", Exercise("many", cases=[Case(given, 1.0)]), lambda **_: 2.0).card
    assert card.rows[0][1].endswith(", ...)") and len(card.rows[0][1]) < 130


def test_every_text_of_a_card_is_escaped():
    card = Card("<b>", "wrong", "<i>", "<u>", (("<s>", "<script>alert(1)</script>"),))
    assert {tag for tag, _ in Reader(card.html()).elements} <= {"div", "p", "span", "strong", "code"}


TABLE = Exercise("table", cases=[Case({"x": [0.0, 0.01, 0.02, 0.04]}, [0.0, 2.0, 4.0, 8.0], unit="N")])


def test_where_lists_differ_both_are_drawn_with_their_words():
    page = Reader(checked("98.table", TABLE, lambda x: 100 * x).card.html())
    drawn = [attributes for tag, attributes in page.elements if tag == "svg"]
    assert len(drawn) == 1 and drawn[0]["role"] == "img" and drawn[0]["aria-label"].startswith("table: ")
    assert "The largest difference is at handle position x = 40 mm: yours is 4, and 8 is expected." in page.text
    assert not {name for _, attributes in page.elements for name in attributes} & {"id", "onload", "href", "src"}
    assert checked("98.table", TABLE, lambda x: 200 * x).card.figures == ()


def test_what_is_the_answer_itself_is_never_drawn():
    value = Exercise("k", "value", 1, cases=[Case({}, [1.0, 2.0, 3.0, 4.0])])
    assert checked("98.k", value, [1.0, 2.0, 3.0, 5.0]).card.figures == ()


@pytest.fixture
def notebook(monkeypatch, tmp_path):
    """A folder as a notebook's, and the outputs that a front end gets."""
    shown = []
    monkeypatch.setattr(checks, "in_a_notebook", lambda: True)
    monkeypatch.setattr(checks, "display", shown.append)
    monkeypatch.chdir(tmp_path)
    return shown


def test_a_notebook_is_shown_both_forms_and_the_progress_of_the_lab(notebook, tmp_path, capsys):
    hl.check("02.period_leak", lambda k, D: k * D**2 / 2)
    hl.check("02.who_pays", "d")
    (first, second), said = notebook, capsys.readouterr().out
    assert said == "" and set(first) == {"text/plain", "text/html"}
    assert "this lab: 1 of 7 exercises right in the public cases (counts for no mark)\n  next: bounce_gain" in first["text/plain"]
    assert "2 of 7 exercises" in Reader(second["text/html"]).text and "next: held_work" in second["text/plain"]
    hl.check("02.who_pays", "a")  # the last check counts
    hl.check("01.thousand", "a")  # another lab in the same folder
    hl.check("02.period_leak", None)
    assert json.loads((tmp_path / FILE).read_text("utf-8")) == {"01": ["thousand"], "02": []}
    assert "1 of 7" in notebook[2]["text/plain"] and "1 of 8" in notebook[3]["text/plain"]


def test_without_a_notebook_nothing_is_written(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    hl.check("02.who_pays", "d")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("held", ["", "[]", "{", '{"02": 3}', '{"02": [[1], 2, "a"]}', "[" * 100_000, "\xff"])
def test_a_file_of_anything_is_read_as_far_as_it_goes(held, tmp_path):
    (tmp_path / FILE).write_text(held, "latin-1")
    assert remember(tmp_path, "02", "b", True)[-1] == "b"
    assert [path.name for path in tmp_path.iterdir()] == [FILE]


def test_where_nothing_can_be_written_the_session_remembers(tmp_path):
    (tmp_path / FILE).mkdir()  # no file can take its place, whoever runs this
    assert remember(tmp_path, "02", "a", True) == ["a"]
    assert remember(tmp_path, "02", "b", True) == ["a", "b"]
    assert [path.name for path in tmp_path.iterdir()] == [FILE]
    assert remember(tmp_path / "missing", "02", "a", True) == ["a"]
