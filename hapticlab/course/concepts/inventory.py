"""All questions of the inventory in their order, and the form of one student: the same questions with own numbers."""

from __future__ import annotations

import itertools
from typing import Literal, get_args

from ...errors import CourseError
from . import delay, hand, leak, measurement, passivity, real_paddle, signs, simulation
from .question import Asked, Concept, Question

Occasion = Literal["before", "after"]
OCCASIONS: tuple[Occasion, ...] = get_args(Occasion)
#: what every page and every table says of the inventory
NOT_VALIDATED = "Not validated: no class has answered these questions yet."

CONCEPTS: tuple[Concept, ...] = tuple(
    module.CONCEPT for module in (signs, leak, passivity, delay, real_paddle, simulation, measurement, hand)
)


def questions() -> dict[str, tuple[Concept, Question]]:
    """Return every question by the name of its answer, ``q01`` and so on, with its concept.

    The first question of each concept comes first, then the second of each, so that neighbours are about different things.

    Examples
    --------
    >>> [(answer, concept.name) for answer, (concept, _) in questions().items()][:3]
    [('q01', 'signs'), ('q02', 'leak'), ('q03', 'passivity')]
    """
    rows = itertools.zip_longest(*([(concept, one) for one in concept.questions] for concept in CONCEPTS))
    return {f"q{number:02}": one for number, one in enumerate((one for row in rows for one in row if one), start=1)}


def form(seed: int, student: str, occasion: Occasion) -> tuple[Asked, ...]:
    """Return the questions as one student is asked them on one occasion.

    Parameters
    ----------
    seed : int
        Of the course.
    student : str
        By the name that answers are handed in under; empty for questions that a whole class shares.
    occasion : {"before", "after"}
        Both have the same questions, with other numbers and another order of options.

    Returns
    -------
    tuple of Asked

    Raises
    ------
    CourseError
        For an unknown occasion.

    Examples
    --------
    >>> ada, bob = form(3, "ada", "before"), form(3, "bob", "before")
    >>> len(ada), ada == form(3, "ada", "before"), ada == bob
    (28, True, False)
    """
    if occasion not in OCCASIONS:
        raise CourseError(f"occasion = {occasion!r}; it needs one of {', '.join(OCCASIONS)}")
    key = f"seed {seed}, {occasion}, {student}"
    return tuple(question.asked(answer, key) for answer, (_, question) in questions().items())
