"""A class of simulated students, who answer by a model of item response theory: for trying the pages, never for a result."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ...course.concepts.inventory import OCCASIONS, Occasion, form
from ...course.concepts.question import Asked
from ...course.concepts.questionnaire import notebook_name, notebook_of
from ...course.notebook import text_of, write_new
from .paper import SIMULATED

if TYPE_CHECKING:
    from ...base.annotations import Array, File

#: of the three-parameter model: slope, and how often a student who knows nothing is right
SLOPE, GUESSED = 1.5, 0.2
#: means and deviations: of the difficulty of questions, of the ability before the course, of what the course adds
DIFFICULTY, ABILITY, LEARNED = (0.5, 0.8), (0.0, 1.0), (0.9, 0.5)
#: parts of the answers that are missing, and of the students who are missing on one of the occasions
UNANSWERED, ABSENT = 0.03, 0.06


def probability(ability: Array, difficulty: Array) -> Array:
    """Probability of a right answer by the three-parameter logistic model.

    Wang and Bao (2010), Am. J. Phys. 78, 1064, doi:10.1119/1.3443565, fitted it to the Force Concept Inventory. The constants
    here are illustrative.

    Examples
    --------
    >>> round(float(probability(0.0, 0.0)), 3), round(float(probability(-50.0, 0.0)), 3)
    (0.6, 0.2)
    """
    return GUESSED + (1 - GUESSED) / (1 + np.exp(-SLOPE * (np.asarray(ability) - difficulty)))


def write_simulated_class(folder: File, *, students: int = 40, seed: int = 0) -> None:
    """Write the notebooks of simulated students, in folders ``before`` and ``after``; each says that it is simulated.

    Parameters
    ----------
    folder : str or Path
    students : int
    seed : int
        Of the class, and of the questions.
    """
    random = np.random.default_rng(seed)
    ability = random.normal(*ABILITY, size=students)
    abilities = dict(zip(OCCASIONS, (ability, ability + random.normal(*LEARNED, size=students)), strict=True))
    count = len(form(seed, "", "before"))
    difficulty = random.normal(*DIFFICULTY, size=count)
    tempting = random.dirichlet(np.ones(3), size=count)  # how often each wrong option is chosen
    for occasion in OCCASIONS:
        for k in range(students):
            if random.random() < ABSENT:
                continue
            name = f"simulated-{k + 1:03}"
            right = random.random(count) < probability(abilities[occasion][k], difficulty)
            asked = form(seed, name, occasion)
            letters = {one.identity: _letter(one, right[i], tempting[i], random) for i, one in enumerate(asked)}
            path = Path(folder, occasion, name, notebook_name(occasion))
            write_new(path, text_of(_answered(seed, name, occasion, letters)).encode())


def _letter(one: Asked, right: bool, tempting: Array, random: np.random.Generator) -> str:
    """Return the answer of a simulated student, or an empty text for none."""
    wrong = [option.letter for name in one.question.wrong for option in one.options if option.misconception == name]
    chosen = one.key if right else str(random.choice(wrong, p=tempting))
    return "" if random.random() < UNANSWERED else chosen


def _answered(seed: int, name: str, occasion: Occasion, letters: dict[str, str]) -> dict[str, object]:
    notebook = notebook_of(seed, name, occasion)
    for cell in notebook["cells"]:
        if cell["id"] == "first":
            cell["source"] += f"\n{SIMULATED}"
        if letters.get(cell["id"]):
            cell["source"] = f'{cell["id"]} = "{letters[cell["id"]]}"'
    return notebook
