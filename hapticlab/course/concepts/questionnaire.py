"""The notebook that asks a student's questions. It contains no right answer and no check."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .inventory import Occasion, form
from .question import Asked, fingerprint

if TYPE_CHECKING:
    from collections.abc import Sequence

MINUTES = 30
#: the line of the first cell that tells whose questions these are
QUESTIONS = "questions"
INTRODUCTION = """# What do you think? {number} questions {occasion} the course

**Time:** {minutes} minutes. **Needs:** this notebook; no paddle, no books, no calculator. Answer alone.

Each question has four options, and one is right. Write the letter of your answer between quotation marks, such as
`q01 = "b"`. If you have no idea, leave `None`: an honest gap is more useful to your instructor than a guess. Your answers are
saved, not marked. They show which concepts the course must explain better{later}.

Nothing is checked here. When you have finished, run all cells, save the notebook, and hand it in."""
WORDS = """## Words in the questions

You need no lab for these questions. Come back to this list when a word is new.

* A *paddle* is a *device* with one *handle*. A *motor* pushes the handle, and an *encoder* measures its position $x$ in small
  equal steps, the *counts*.
* At each *sample*, a program reads the position and computes a force. The motor *holds* this force until the next sample, one
  *period* $T$ later. This is *the hold*. At 1 kHz, the period is 1 ms.
* A *virtual wall* is computed by the program. Inside the wall the force grows with the depth, like the force of a spring. The
  *stiffness* in N/m says how fast.
* *Viscous damping* is a friction force that is proportional to the speed, $b\\,v$. *Dry friction* is the same at every speed. A
  *virtual damper* is a force $b\\,v$ of the motor against the motion. If $b$ is negative, the force acts with the motion.
* A *passive* hand never gives out more energy than it has received. A virtual wall is *passive* on a device if the device and
  the wall together never do so either. A wall is *unstable* if the handle begins to oscillate at it by itself.
* A simulation computes a motion in small *steps*. The *load* of a board is the part of its time in which it computes, and its
  computing time is counted in *cycles*.
* A difference is *just noticed* if the answers of a person are right in three of four trials. The *Weber fraction* is this
  difference in per cent."""
LATER = {"before": ", and after the course you will be asked again", "after": ""}
LAST = """answers = [{names}]
missing = [k for k, answer in enumerate(answers, start=1) if answer not in list("abcd")]
print("Not answered:", ", ".join(f"q{{k:02}}" for k in missing) or "none")"""


def notebook_of(seed: int, student: str, occasion: Occasion) -> dict[str, Any]:
    """Return the notebook of one student on one occasion.

    Parameters
    ----------
    seed : int
        Of the course.
    student : str
        Empty for questions that a whole class shares.
    occasion : {"before", "after"}

    Returns
    -------
    dict
        As :func:`hapticlab.course.notebook.text_of` writes it.

    Examples
    --------
    >>> made = notebook_of(3, "ada", "before")
    >>> made["cells"][4]["source"]
    'q01 = None  # "a", "b", "c" or "d"'
    """
    asked = form(seed, student, occasion)
    later = LATER[occasion]
    opening = INTRODUCTION.format(number=len(asked), occasion=occasion, minutes=MINUTES, later=later)
    first = f'import hapticlab as hl\n\n{QUESTIONS} = "{fingerprint(asked)}"  # which questions these are; leave it as it is'
    cells = [_cell("markdown", "introduction", opening), _cell("code", "first", first), _cell("markdown", "words", WORDS)]
    for one in asked:
        cells += _question_cells(one)
    cells += [_cell("markdown", "end", "## Hand in\n\nRun the last cell. It names the questions that have no answer.")]
    cells += [_cell("code", "last", LAST.format(names=_lines([one.identity for one in asked])))]
    kernel = {"display_name": "Python 3", "language": "python", "name": "python3"}
    metadata = {"kernelspec": kernel, "language_info": {"name": "python"}}
    return {"cells": cells, "metadata": metadata, "nbformat": 4, "nbformat_minor": 5}


def notebook_name(occasion: Occasion) -> str:
    """Return the name of the notebook's file."""
    return f"concepts_{occasion}.ipynb"


def _question_cells(one: Asked) -> list[dict[str, Any]]:
    options = "\n".join(f"* `{option.letter}`: {option.text}" for option in one.options)
    heading = f"## Question {int(one.identity[1:])}\n\n{one.text}"
    answer = _cell("code", one.identity, f'{one.identity} = None  # "a", "b", "c" or "d"')
    if not one.question.picture:
        return [_cell("markdown", f"{one.identity}-asks", f"{heading}\n\n{options}"), answer]
    return [
        _cell("markdown", f"{one.identity}-asks", heading),
        _cell("code", f"{one.identity}-picture", one.question.picture),
        _cell("markdown", f"{one.identity}-options", options),
        answer,
    ]


def _lines(names: Sequence[str]) -> str:
    """Names of a list, seven on a line."""
    rows = [", ".join(names[k : k + 7]) for k in range(0, len(names), 7)]
    return "\n    " + ",\n    ".join(rows) + ",\n"


def _cell(kind: str, name: str, source: str) -> dict[str, Any]:
    cell: dict[str, Any] = {"cell_type": kind, "id": name, "metadata": {}, "source": source}
    return cell | ({"execution_count": None, "outputs": []} if kind == "code" else {})
