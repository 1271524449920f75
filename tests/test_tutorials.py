"""The three tutorials of docs/tutorial: their examples run, and their commands print what the pages show."""

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest
from builder.running.examples import run

from hapticlab.cli.main import main
from hapticlab.cli.options import parser
from hapticlab.course.labs import find_labs

ROOT = Path(__file__).parents[1]
TUTORIALS = ROOT / "docs" / "tutorial"
FIRST_WALL, GRADED_CLASS, PADDLE = (
    (TUTORIALS / f"{name}.md").read_text("utf-8") for name in ("first_wall", "graded_class", "paddle_on_the_desk")
)
#: a file that the reader writes, or a command, or what the last command printed
BLOCK = re.compile(r"(?:^`(?P<file>[\w./]+)`:\n\n)?^```(?P<language>\w+)\n(?P<text>.*?)^```$", re.M | re.S)


def blocks(page):
    """(file or None, language, text) of each block of a page, in order."""
    return [(found["file"], found["language"], found["text"]) for found in BLOCK.finditer(page)]


def commands(page):
    """The commands of a page for Linux and macOS."""
    return [line for _, language, text in blocks(page) if language == "sh" for line in text.splitlines()]


def files(page):
    """File -> its text, as the reader writes it."""
    return {file: text for file, _, text in blocks(page) if file}


def follow(page, folder, monkeypatch, capsys):
    """Do all that a page says in a folder; return (command, what it printed, what the page shows of that) of each command."""
    monkeypatch.chdir(folder)
    done = []
    for file, language, text in blocks(page):
        if file:
            Path(file).parent.mkdir(parents=True, exist_ok=True)
            Path(file).write_text(text, "utf-8")
        elif language == "sh":
            done += [[line, _printed(shlex.split(line), capsys), []] for line in text.splitlines()]
        elif language == "text":
            done[-1][2].append(text)
    return done


def _printed(words, capsys):
    if words[0] == "python":
        return subprocess.run([sys.executable, *words[1:]], capture_output=True, text=True, check=True).stdout
    assert words[0] == "hapticlab"
    assert main(words[1:]) == 0, words
    said = capsys.readouterr()
    return said.out + said.err


def words_of(text):
    """The text without the reader's folder, and without the numbers of a test that draws its signs at random."""
    text = re.sub(r"\(Z = [^)]*\)[^)]*\)", "(Z = ...)", text)
    return re.sub(r"^labs in .*(?=[/\\][\w-]+$)", "labs in ...", text, flags=re.M).replace("\\", "/")


@pytest.mark.interpreter
@pytest.mark.wide
def test_the_examples_of_the_first_wall_run():
    page = run(FIRST_WALL, "docs/tutorial/first_wall.md")
    assert "the wall gives 0.60 N at 7.00 mm" in page.printed  # 300 (x - 5e-3) = 2 - 200 x
    assert "4000 N/m: the handle oscillates by 0.9" in page.printed
    assert "the mass rests at 0.857 of x; K/(K + k) = 0.857" in page.printed
    assert "k_3*x(n)**2 is in N/m but k_1*x(n) is in N" in page.printed
    assert sum(len(example.views) for example in page.examples) == 3


@pytest.mark.interpreter
def test_the_first_four_lines_and_the_first_wall_on_a_simulated_board_run():
    (four,) = (text for _, language, text in blocks(FIRST_WALL) if language == "python" and "hl.__version__" in text)
    assert len(four.splitlines()) == 4
    assert "0.60 N at 7.00 mm" in run(f"```python\n{four}```\n", "four lines").printed
    printed = run(PADDLE, "docs/tutorial/paddle_on_the_desk.md").printed
    assert "0.43 N at 7.86 mm; fault: None" in printed  # 150 (x - 5e-3) = 2 - 200 x


def test_every_command_is_understood():
    told = [shlex.split(line) for page in (GRADED_CLASS, PADDLE) for line in commands(page)]
    parsed = [parser().parse_args(words[1:]).command for words in told if words[0] == "hapticlab"]
    assert len(parsed) >= 9 and len(parsed) == len(told) - 1  # one is hand_in.py


@pytest.mark.wide
@pytest.mark.skipif(sys.platform == "win32", reason="code of students runs without walls there")
def test_a_class_is_graded_as_the_page_shows(tmp_path, monkeypatch, capsys):
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")]))
    labs, hand_in, grade, table = follow(GRADED_CLASS, tmp_path, monkeypatch, capsys)
    assert words_of(labs[2][0]) in words_of(labs[1]) and hand_in[1] == ""
    marks, bob, cleo = grade[2]
    assert marks in grade[1]
    assert bob.strip() in (tmp_path / "pages" / "students" / "bob.html").read_text("utf-8")
    assert cleo.strip().replace("'", "&#x27;") in (tmp_path / "pages" / "students" / "cleo.html").read_text("utf-8")
    assert "numppy" not in (tmp_path / "pages" / "students" / "bob.html").read_text("utf-8")
    assert table[2] == [(tmp_path / "lab02.csv").read_text("utf-8-sig")]
    assert "no submission of: dora" in table[1]


def test_the_answers_of_the_class_are_judged_as_the_page_says():
    """Without a sandbox, and by the public cases alone: Ada is right, Bob forgot the factor, and Cleo's code stops."""
    (lab,) = (lab.lab() for lab in find_labs() if lab.number == "02")
    exercises = {exercise.name: exercise for exercise in lab.exercises}
    script = files(GRADED_CLASS)["hand_in.py"]
    known: dict = {}
    exec(script[: script.index("handed_out")], known)
    answers = {student: {} for student in known["ANSWERS"]}
    for student in ("ada", "bob"):
        exec(known["ANSWERS"][student], answers[student])
    with pytest.raises(ModuleNotFoundError, match="numppy"):
        exec(known["ANSWERS"]["cleo"], answers["cleo"])
    (case, *_) = exercises["period_leak"].cases
    assert answers["ada"]["period_leak"](**case.given) == pytest.approx(case.expected)
    given = answers["bob"]["period_leak"](**case.given)
    (sentence,) = [words for value, words in case.slips if value == pytest.approx(given)]
    assert sentence in GRADED_CLASS
    assert "held_work" not in answers["cleo"]


@pytest.mark.wide
def test_a_paddle_is_rehearsed_as_the_page_shows(tmp_path, monkeypatch, capsys):
    rehearsed = PADDLE.replace(SH_ON_THE_PADDLE, "")
    assert rehearsed != PADDLE
    done = follow(rehearsed, tmp_path, monkeypatch, capsys)
    assert [len(shown) for _, _, shown in done] == [1, 2, 1, 1, 1]
    for command, printed, shown in done:
        for text in shown:
            assert words_of(text) in words_of(printed), command


#: needs a board
SH_ON_THE_PADDLE = "```sh\nhapticlab bench\nhapticlab calibrate --only force\n```\n"


def test_commands_that_are_rehearsed_open_no_port_of_the_reader():
    """What needs a board is the one block that the test above leaves out."""
    rest = commands(PADDLE.replace(SH_ON_THE_PADDLE, ""))
    assert [line for line in rest if not re.search(r"sim://|--practice|hapticlab labs", line)] == []
    assert not any("--yes" in line for line in commands(PADDLE))
