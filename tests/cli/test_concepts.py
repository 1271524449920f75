"""`hapticlab concepts`: questions handed out, answers read, and what is refused before anything is written."""

import pytest

from hapticlab.cli import exits, main
from hapticlab.course.concepts.inventory import form
from hapticlab.course.notebook import code_of, read


@pytest.fixture
def roster(tmp_path):
    path = tmp_path / "class.csv"
    path.write_text("Name;Email;Login\nAda L;ada@x.edu;al\nBob M;bob@x.edu;bm\n", "utf-8")
    return path


def concepts(*asked):
    return main.main(["concepts", *map(str, asked)])


def answer(folder, occasion, student, right):
    """Answer a student's notebook: so many questions right, and the others wrong."""
    path = folder / occasion / student / f"concepts_{occasion}.ipynb"
    text = path.read_text("utf-8")
    for k, one in enumerate(form(7, student, occasion)):
        letter = one.key if k < right else next(option.letter for option in one.options if option.misconception)
        text = text.replace(f"{one.identity} = None ", f"{one.identity} = '{letter}' ")
    path.write_text(text, "utf-8")


def test_a_class_from_the_roster_to_its_pages(tmp_path, roster, capsys):
    out, asked = tmp_path / "out", ["--seed", "7", "--roster", roster, "--column", "Login"]
    assert concepts(out, *asked) == 0
    said = capsys.readouterr().out
    assert "28 questions before and after the course, one for each of 2 students, seed 7" in said
    assert f"--before FIRST --after SECOND --seed 7 --roster {roster} --column Login" in said
    for student, before, after in (("al", 7, 21), ("bm", 14, 21)):
        answer(out, "before", student, before)
        answer(out, "after", student, after)
    kept = (out / "after" / "al" / "concepts_after.ipynb").read_bytes()
    assert concepts(out, *asked) == 0  # again: nothing that has answers is lost
    assert "may hold answers" in capsys.readouterr().out
    assert (out / "after" / "al" / "concepts_after.ipynb").read_bytes() == kept
    assert concepts(tmp_path / "pages", "--before", out / "before", "--after", out / "after", *asked) == 0
    said = capsys.readouterr().out
    assert "2 students on both occasions: 38% right before, 75% after, normalised gain 0.60" in said
    assert "Not validated" in said and "Only 2 students" in said and "simulated" not in said
    assert {path.name for path in (tmp_path / "pages" / "students").iterdir()} == {"al.html", "bm.html"}


def test_without_a_roster_all_share_one_notebook(tmp_path, capsys):
    assert concepts(tmp_path / "out") == 0
    assert "the same for all students" in capsys.readouterr().out
    for occasion in ("before", "after"):
        assert (
            len(code_of(read(tmp_path / "out" / occasion / f"concepts_{occasion}.ipynb"))) == 28 + 3 + 2
        )  # answers, pictures, the first and the last


def test_a_simulated_class(tmp_path, capsys):
    assert concepts(tmp_path / "try", "--demo", "3") == 0
    said = capsys.readouterr().out
    assert "The students are simulated." in said and "(95 %: – to –)" in said and "nan" not in said
    assert (tmp_path / "try" / "pages" / "concepts.html").is_file()
    assert concepts(tmp_path / "try", "--demo", "3") == exits.FAILED
    assert "is not empty" in capsys.readouterr().err


def test_what_cannot_be_read_is_named_and_the_command_fails(tmp_path, capsys):
    for occasion in ("before", "after"):
        (tmp_path / occasion).mkdir()
        (tmp_path / occasion / "eve.ipynb").write_text("{}")
    assert concepts(tmp_path / "pages", "--before", tmp_path / "before", "--after", tmp_path / "after") == exits.FAILED
    assert "left out: eve, before: eve.ipynb is not a notebook" in capsys.readouterr().err
    assert "nothing to compare" in (tmp_path / "pages" / "concepts.html").read_text("utf-8")


def test_a_wrong_seed_is_one_reason_and_not_one_line_for_each_student(tmp_path, capsys):
    concepts(tmp_path / "try", "--demo", "9")
    capsys.readouterr()
    both = ["--before", tmp_path / "try" / "before", "--after", tmp_path / "try" / "after"]
    assert concepts(tmp_path / "pages", *both, "--seed", "5") == exits.FAILED
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 2 and all(" more, " in line and "version of hapticlab" in line for line in lines)


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        (["--before", "a"], "gains need both occasions"),
        (["--demo", "--roster", "class.csv"], "--demo makes its own class"),
        (["--column", "Login"], "give --roster FILE.csv"),
        (["--demo", "1"], "a whole number, 2 or greater"),
    ],
)
def test_options_that_do_not_go_together_are_refused(tmp_path, capsys, asked, words):
    with pytest.raises(SystemExit) as ended:
        concepts(tmp_path / "out", *asked)
    assert ended.value.code == exits.USAGE and words in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_pages_among_the_answers_and_one_folder_for_both_are_refused(tmp_path, capsys):
    for occasion in ("before", "after"):
        (tmp_path / occasion).mkdir()
        (tmp_path / occasion / "eve.ipynb").write_text("{}")
    both = ["--before", tmp_path / "before", "--after", tmp_path / "after"]
    assert concepts(tmp_path / "before" / "pages", *both) == exits.FAILED
    assert "is in the submissions" in capsys.readouterr().err
    assert concepts(tmp_path / "pages", "--before", tmp_path, "--after", tmp_path / "after") == exits.FAILED
    assert "give a folder for each occasion" in capsys.readouterr().err
    other = tmp_path / "other"
    other.mkdir()
    (other / "concepts.html").write_text("my notes")
    assert concepts(other, *both) == exits.FAILED
    assert "would be overwritten" in capsys.readouterr().err and (other / "concepts.html").read_text() == "my notes"
