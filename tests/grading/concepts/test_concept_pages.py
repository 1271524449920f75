"""The pages of a class: what they say, to whom, how surely; the same bytes for the same answers."""

import csv
import io
import re

import numpy as np
import pytest

from hapticlab.course.concepts.inventory import CONCEPTS, NOT_VALIDATED, questions
from hapticlab.course.concepts.misconceptions import MISCONCEPTIONS
from hapticlab.errors import CourseError
from hapticlab.grading.concepts.class_summary import FEW, summary
from hapticlab.grading.concepts.pages import SIMULATED, write_concept_pages
from hapticlab.grading.concepts.paper import Paper, read_papers
from hapticlab.grading.concepts.simulated_students import GUESSED, SLOPE, probability, write_simulated_class


def paper(student, right, *, occasion="before", more=None):
    """A student whose first answers are right and whose others are the first misconception."""
    picked = {}
    for k, (name, (_, question)) in enumerate(questions().items()):
        picked[name] = "" if k < right else next(iter(question.wrong))
    return Paper(student, picked | (more or {}))


def klass(students=24):
    before = [paper(f"student{k:02}", 4 + k % 8) for k in range(students)]
    after = [paper(f"student{k:02}", 12 + (5 * k) % 16) for k in range(students)]
    return before, after


def test_gains_by_hand():
    before = [paper("ada", 7), paper("bob", 14)]
    after = [paper("bob", 21), paper("ada", 21), paper("cyd", 3)]
    found = summary([*before, paper("dan", 3), Paper("eve", problem="empty")], after)
    assert [one.student for one, _ in found.matched] == ["ada", "bob"]
    assert (found.only_before, found.only_after) == (["dan"], ["cyd"])
    assert [(occasion, one.student) for occasion, one in found.problems] == [("before", "eve")]
    assert found.whole.before == pytest.approx(10.5 / 28) and found.whole.after == pytest.approx(21 / 28)
    assert found.whole.gain == pytest.approx(10.5 / 17.5)
    assert sum(one.questions for one in found.concepts) == 28
    first = found.items[7]  # q08: ada wrong, bob right before, both right after
    assert first.difficulty == (0.5, 1.0)
    assert {words: counts for words, *counts in first.chosen}["right"] == [1, 2]


def test_no_answer_is_not_right_and_counts_apart():
    found = summary([paper("ada", 28)], [paper("ada", 28, more={"q01": None})])
    assert found.whole.after == pytest.approx(27 / 28)
    assert {words: counts for words, *counts in found.items[0].chosen}["no answer"] == [0, 1]
    assert np.isnan(found.whole.gain)  # nothing was left to learn


def test_misconceptions_are_counted_by_student_and_not_by_answer():
    found = summary([paper("ada", 28)], [paper("ada", 0)])
    counts = {one.title: (before, after) for one, before, after in found.remaining}
    assert set(counts.values()) == {(0, 1)}
    titles = {MISCONCEPTIONS[next(iter(question.wrong))].title for _, question in questions().values()}
    assert set(counts) == titles


def test_a_small_class_is_warned_and_its_questions_are_not_judged():
    before, after = klass()
    small, large = summary(before[: FEW - 1], after), summary(before, after)
    assert "too wide to say anything" in small.warnings[0] and not any(item.remarks for item in small.items)
    assert not any("too wide" in words for words in large.warnings)
    assert any(item.remarks for item in large.items)


def read_table(path):
    return list(csv.DictReader(io.StringIO(path.read_text("utf-8-sig"))))


def test_pages_and_tables_say_that_nothing_is_validated(tmp_path):
    before, after = klass(6)
    paths = write_concept_pages(summary(before, after), after, tmp_path)
    assert [path.relative_to(tmp_path).as_posix() for path in paths[:4]] == [
        "concepts.html", "students.csv", "questions.csv", "students/student00.html",
    ]  # fmt: skip
    assert len(paths) == 3 + 6
    for path in paths:
        text = path.read_text("utf-8")
        assert NOT_VALIDATED in text and SIMULATED not in text
        assert "<script" not in text and "http://" not in text and "https://" not in text
    rows = read_table(paths[1])
    assert rows[3]["student"] == "student03" and (rows[3]["all before"], rows[3]["all after"]) == ("7", "27")
    assert sum(int(rows[3][f"{concept.name} after"]) for concept in CONCEPTS) == 27
    items = read_table(paths[2])
    assert len(items) == 28 and items[0]["right after"] == "6" and items[0]["misconception 1"] == "Force on the wrong body"
    assert all(
        sum(int(row[f"{what} after"]) for what in ("right", "wrong 1", "wrong 2", "wrong 3", "no answer")) == 6 for row in items
    )


def test_the_page_says_how_far_its_numbers_carry(tmp_path):
    write_concept_pages(summary(*klass(26)), [], tmp_path)
    text = " ".join((tmp_path / "concepts.html").read_text("utf-8").split())
    assert "A negative gain means that fewer answers were right" in text
    independent = np.random.default_rng(1).standard_normal((2, 4000, 26))
    correlations = [np.corrcoef(one, other)[0, 1] for one, other in zip(*independent, strict=True)]
    stated = float(re.search(r"chance alone changes a discrimination by up to about (\d\.\d+)", text)[1])
    assert stated == pytest.approx(np.quantile(np.abs(correlations), 0.95), abs=0.02)


def test_a_students_page_names_nobody_else_and_no_marks(tmp_path):
    before = [paper("ada", 3), paper("bob", 3)]
    after = [paper("ada", 26), paper("bob", 28), paper("cyd", 27)]
    paths = write_concept_pages(summary(before, after), after, tmp_path)
    ada, bob, cyd = (path.read_text("utf-8") for path in paths[3:])
    assert "bob" not in ada and "ada" not in bob and "ada" not in cyd
    last = [MISCONCEPTIONS[next(iter(question.wrong))] for _, question in questions().values()][26:]
    now, _, overcome = ada.partition("Before the course, and no longer")
    assert overcome and not [one.title for one in last if one.title in overcome]
    assert all(one.title in now and f"lab {one.labs[0]} (" in now for one in last)
    assert "No option that you chose" in bob and "no longer" in bob and "no longer" not in cyd
    said = re.sub("<.*?>", " ", re.sub("<style>.*?</style>", "", ada, flags=re.S))
    assert not re.search(r"\b\d+ (of|right)\b|\bq\d\d\b|\b(26|3)\b", said)


def test_names_of_students_are_text_and_no_cell_is_a_formula(tmp_path):
    names = ["<script>alert(1)</script>", "=HYPERLINK(1)", "a" * 300, "../../x"]
    before, after = ([paper(name, right) for name in names] for right in (3, 20))
    paths = write_concept_pages(summary(before, after), after, tmp_path)
    assert all(tmp_path in path.resolve().parents for path in paths)
    assert "<script" not in paths[0].read_text("utf-8") and "&lt;script&gt;" in paths[0].read_text("utf-8")
    assert "'=HYPERLINK(1)" in [row["student"] for row in read_table(paths[1])]


def test_the_same_answers_give_the_same_bytes_in_any_order(tmp_path):
    before, after = klass(5)
    one, other = tmp_path / "one", tmp_path / "other"
    paths = sorted(write_concept_pages(summary(before, after), after, one))
    others = sorted(write_concept_pages(summary(before[::-1], after[::-1]), after[::-1], other))
    assert [path.read_bytes() for path in paths] == [path.read_bytes() for path in others]


def test_an_empty_class_has_a_page_that_says_so(tmp_path):
    (page, *_) = write_concept_pages(summary([], []), [], tmp_path)
    assert "nothing to compare" in page.read_text("utf-8")


def test_a_folder_that_cannot_be_written_is_told(tmp_path):
    (tmp_path / "file").touch()
    with pytest.raises(CourseError, match="cannot write"):
        write_concept_pages(summary([], []), [], tmp_path / "file" / "pages")


# ---------------------------------------------------------------- simulated students


def test_simulated_students_say_so_on_every_page(tmp_path):
    write_simulated_class(tmp_path, students=3, seed=2)
    before, after = (read_papers([tmp_path / occasion], occasion=occasion, seed=2) for occasion in ("before", "after"))
    assert not [one.problem for one in (*before, *after) if one.problem]
    found = summary(before, after)
    assert found.simulated
    for path in write_concept_pages(found, after, tmp_path / "pages"):
        assert SIMULATED in path.read_text("utf-8")


def test_the_model_of_simulated_students_is_the_three_parameter_one():
    assert probability(np.array([1.3]), 1.3)[0] == pytest.approx((1 + GUESSED) / 2)
    h = 1e-6
    slope = (probability(np.array([h]), 0.0) - probability(np.array([-h]), 0.0))[0] / (2 * h)
    assert slope == pytest.approx((1 - GUESSED) * SLOPE / 4, rel=1e-6)


@pytest.mark.wide
def test_what_simulated_students_learned_is_found_again(tmp_path):
    """Their abilities grow by 0.9 on average; a class whose answers are drawn of these models must show a gain near theirs."""
    write_simulated_class(tmp_path, students=150, seed=4)
    before, after = (read_papers([tmp_path / occasion], occasion=occasion, seed=4) for occasion in ("before", "after"))
    found = summary(before, after, seed=4)
    random = np.random.default_rng(4)
    ability = random.normal(size=150)
    after_it = ability + random.normal(0.9, 0.5, size=150)
    difficulty = random.normal(0.5, 0.8, size=28)
    means = [0.97 * np.mean(probability(one[:, None], difficulty)) for one in (ability, after_it)]
    assert (found.whole.before, found.whole.after) == (pytest.approx(means[0], abs=0.03), pytest.approx(means[1], abs=0.03))
    assert found.whole.interval[0] < (means[1] - means[0]) / (1 - means[0]) < found.whole.interval[1]
    easy = [item.difficulty[1] for item in found.items]
    assert np.corrcoef(easy, difficulty)[0, 1] < -0.9
