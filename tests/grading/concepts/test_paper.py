"""What students hand in is data: read as text, whatever it contains, and never run."""

import json
import sys

import pytest

from hapticlab.course.concepts.inventory import form
from hapticlab.course.concepts.questionnaire import notebook_of
from hapticlab.course.notebook import text_of
from hapticlab.grading.concepts.paper import answered, read_papers

ASKED = form(3, "ada", "before")


def hand_in(folder, student="ada", *, changed=None, lines=(), seed=3, of=None, occasion="before"):
    """Write the notebook of a student: every answer "b" but for what is changed, and more lines in a cell at the end."""
    notebook = notebook_of(seed, student if of is None else of, occasion)
    for cell in notebook["cells"]:
        if cell["id"] in {one.identity for one in ASKED}:
            cell["source"] = f"{cell['id']} = {(changed or {}).get(cell['id'], repr('b'))}"
    notebook["cells"].append({**notebook["cells"][-1], "id": "more", "source": "\n".join(lines)})
    path = folder / student / f"concepts_{occasion}.ipynb"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text_of(notebook), "utf-8")
    return path


def papers(folder, **more):
    return read_papers([folder], **{"occasion": "before", "seed": 3} | more)


def test_the_chosen_options_are_their_misconceptions(tmp_path):
    hand_in(tmp_path)
    hand_in(tmp_path, "bob", changed={one.identity: repr(one.key) for one in form(3, "bob", "before")})
    ada, bob = papers(tmp_path)
    assert (ada.student, bob.student) == ("ada", "bob") and not ada.problem
    assert ada.picked == {one.identity: one.options[1].misconception for one in ASKED}
    assert set(bob.picked.values()) == {""}


@pytest.mark.parametrize(
    ("text", "letter"),
    [
        ('"c"', "c"),
        ("'C'", "c"),
        ("c", "c"),
        (' "c" ', "c"),
        ("None", ""),
        ('""', ""),
        ("", ""),
        ('"e"', "?"),
        ("[1", "?"),
        ('"c', "?"),
        ("__import__('os').abort()", "?"),
        ('"c" if 1 else "d"', "?"),
        ("= 'c'", "?"),
        ('"ab"', "?"),
    ],
)
def test_an_answer_is_one_of_four_letters(text, letter):
    paper = answered(ASKED, "ada", {"q01": text})
    picked = {option.letter: option.misconception for option in ASKED[0].options}
    assert paper.picked["q01"] == picked.get(letter)
    assert paper.unreadable == (("q01",) if letter == "?" else ())


def test_comments_stay_out_and_the_last_line_counts(tmp_path):
    lines = ['q02 = "a"  # or "b"', 'q02 = "d";', '  q03 = "a"', '# q04 = "a"', 'q05 == "a"', 'print("q06 = a")']
    hand_in(tmp_path, lines=lines)
    (paper,) = papers(tmp_path)
    letters = {one.identity: {option.misconception: option.letter for option in one.options} for one in ASKED}
    found = {name: letters[name][paper.picked[name]] for name in ("q02", "q03", "q04", "q05", "q06")}
    assert found == {"q02": "d", "q03": "b", "q04": "b", "q05": "b", "q06": "b"}


HOSTILE = {
    "runs": "open('RAN', 'w').write('x')",
    "raises": "raise SystemExit(3)",
    "no Python": "def ((( :::",
    "deep": "(" * 50_000,
    "long line": "q01 = " + "9" * 1_000_000,
    "many lines": 'q07 = "a"\n' * 50_000,
    "of a regular expression": "q08 = " + " " * 200_000 + "x",
    "null": "q09 = 'a'\0\u202e",
    "html": "q10 = '<script>alert(1)</script>'",
}


@pytest.mark.parametrize("name", HOSTILE)
def test_a_hostile_notebook_is_data(tmp_path, monkeypatch, name):
    monkeypatch.chdir(tmp_path)
    hand_in(tmp_path / "class", "eve", lines=[HOSTILE[name]])
    hand_in(tmp_path / "class")
    before = {*sys.modules}
    ada, eve = papers(tmp_path / "class")
    assert not ada.problem and sum(one is not None for one in ada.picked.values()) == 28
    assert eve.problem or sum(one is not None for one in eve.picked.values()) >= 26
    assert not (tmp_path / "RAN").exists() and {*sys.modules} == before


@pytest.mark.parametrize(
    ("raw", "words"),
    [
        (b"{}", "not a notebook"),
        (b'{"cells": 3}', "not a notebook"),
        (b"[" * 600_000, "too many parts"),
        (b"\xff\xfe\x00", "not a notebook"),
        (json.dumps({"cells": [{"cell_type": "code", "source": "questions = 'x'"}]}).encode(), "it has no line questions"),
    ],
)
def test_what_is_no_questionnaire_is_left_out_with_a_reason(tmp_path, raw, words):
    path = hand_in(tmp_path, "eve")
    path.write_bytes(raw)
    hand_in(tmp_path)
    ada, eve = papers(tmp_path)
    assert not ada.problem and words in eve.problem and not eve.picked


def test_questions_of_someone_else_are_told(tmp_path):
    hand_in(tmp_path, "bob", of="ada")
    hand_in(tmp_path, "cyd", seed=4)
    hand_in(tmp_path, "dan", of="")  # shared by the class
    path = hand_in(tmp_path, "eve", occasion="after")
    path.rename(path.with_name("concepts_before.ipynb"))
    bob, cyd, dan, eve = papers(tmp_path)
    assert "of a different student" in bob.problem and "of a different seed" in cyd.problem
    assert not dan.problem
    assert eve.problem == "it has the questions of after the course, and was handed in as before the course"


def test_a_roster_knows_a_notebook_by_its_questions(tmp_path):
    path = hand_in(tmp_path, "ada")
    path.parent.rename(tmp_path / "Ada Lovelace_4217_assignsubmission_file_")
    (paper,) = papers(tmp_path, names=["ada", "bob"])
    assert paper.student == "ada" and not paper.problem
    hand_in(tmp_path, "bob", of="ada")
    (paper,) = papers(tmp_path, names=["ada", "bob"])
    assert "several notebooks" in paper.problem


def test_few_answers_are_no_paper(tmp_path):
    hand_in(tmp_path, changed={f"q{number:02}": "None" for number in range(1, 16)})
    (paper,) = papers(tmp_path)
    assert paper.problem == "13 of 28 questions are answered; at least half are needed"
