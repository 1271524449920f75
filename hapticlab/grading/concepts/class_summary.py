"""What the papers of a class say: who is matched, gains of concepts, questions, misconceptions that remain, warnings."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ...base.annotations import Array
from ...course.concepts.inventory import CONCEPTS, questions
from ...course.concepts.misconceptions import MISCONCEPTIONS, Misconception
from .item_statistics import (
    DIFFICULTY,
    DISCRIMINATION,
    RELIABILITY,
    difficulty,
    discrimination,
    effect_size,
    gain,
    interval,
    reliability,
)
from .paper import Paper

#: students below which intervals are too wide to say anything, and questions cannot be judged
FEW = 20


@dataclass(frozen=True)
class Gain:
    """A concept, or all questions together, before and after; parts of 1, with 95 % intervals of change and gain."""

    title: str
    questions: int
    before: float
    after: float
    change: tuple[float, float]
    gain: float
    interval: tuple[float, float]


@dataclass(frozen=True)
class Item:
    """A question before and after: the part of the students who are right, its discrimination, what was chosen."""

    answer: str
    about: str
    concept: str
    difficulty: tuple[float, float]
    discrimination: tuple[float, float]
    chosen: Sequence[tuple[str, int, int]]
    remarks: Sequence[str]


@dataclass(frozen=True)
class Summary:
    """A class before and after.

    Attributes
    ----------
    matched : list of (Paper, Paper)
        Of each student who answered twice; all numbers are of these.
    only_before, only_after : list of str
    problems : list of (str, Paper)
        Occasion, and a paper that cannot be read.
    whole : Gain or None
        None if nobody is matched.
    effect : float
        Cohen's d of the totals.
    reliability : tuple of float
        Before and after.
    concepts, items : list
    remaining : list of (Misconception, before, after)
        Matched students who chose it at least once, the most frequent after the course first.
    warnings : list of str
    simulated : bool
        Whether any paper was answered by a program.
    """

    matched: Sequence[tuple[Paper, Paper]]
    only_before: Sequence[str]
    only_after: Sequence[str]
    problems: Sequence[tuple[str, Paper]]
    whole: Gain | None
    effect: float
    reliability: tuple[float, float]
    concepts: Sequence[Gain]
    items: Sequence[Item]
    remaining: Sequence[tuple[Misconception, int, int]]
    warnings: Sequence[str]
    simulated: bool


def summary(before: Sequence[Paper], after: Sequence[Paper], *, seed: int = 0) -> Summary:
    """Return what the papers of both occasions say together.

    Parameters
    ----------
    before, after : sequence of Paper
        Each student once.
    seed : int
        Of the intervals.

    Returns
    -------
    Summary

    Examples
    --------
    >>> found = summary([Paper("ada", problem="empty")], [])
    >>> len(found.matched), found.whole, found.warnings[0]
    (0, None, 'No student answered on both occasions, so there is nothing to compare.')
    """
    before, after = (sorted(papers, key=lambda paper: (paper.student.casefold(), paper.student)) for papers in (before, after))
    first, last = ({paper.student: paper for paper in papers if not paper.problem} for papers in (before, after))
    matched = [(first[student], last[student]) for student in first if student in last]
    problems = [(words, one) for words, papers in (("before", before), ("after", after)) for one in papers if one.problem]
    scores = _scores([one for one, _ in matched]), _scores([one for _, one in matched])
    some = bool(matched)
    reliable = (reliability(scores[0]), reliability(scores[1])) if some else (float("nan"), float("nan"))
    return Summary(
        matched,
        [student for student in first if student not in last],
        [student for student in last if student not in first],
        problems,
        _gain("All questions", list(questions()), scores, seed) if some else None,
        effect_size(*scores) if some else float("nan"),
        reliable,
        [_gain(concept.title, _of(concept.name), scores, seed) for concept in CONCEPTS] if some else [],
        _items(matched, scores) if some else [],
        _remaining(matched),
        _warnings(len(matched), reliable[1]),
        any(paper.simulated for paper in (*before, *after)),
    )


def misconceptions_of(paper: Paper) -> list[str]:
    """Return the names of the misconceptions that a student chose, the most frequent first."""
    return [name for name, _ in Counter(one for one in paper.picked.values() if one).most_common()]


def _scores(papers: Sequence[Paper]) -> Array:
    """Return 1 for each right answer; no answer is not right."""
    return np.array([[float(paper.picked[answer] == "") for answer in questions()] for paper in papers])


def _of(concept: str) -> list[str]:
    return [answer for answer, (one, _) in questions().items() if one.name == concept]


def _gain(title: str, answers: Sequence[str], scores: tuple[Array, Array], seed: int) -> Gain:
    names = list(questions())
    before, after = (array[:, [names.index(answer) for answer in answers]] for array in scores)
    first, last = float(before.mean()), float(after.mean())
    change = interval(lambda one, other: other - one, before, after, seed=seed)
    spread = interval(gain, before, after, seed=seed)
    return Gain(title, len(answers), first, last, change, float(gain(first, last)), spread)


def _items(matched: Sequence[tuple[Paper, Paper]], scores: tuple[Array, Array]) -> list[Item]:
    easy, telling = ([function(array) for array in scores] for function in (difficulty, discrimination))
    items = []
    for k, (answer, (concept, question)) in enumerate(questions().items()):
        counts = [Counter(pair[occasion].picked[answer] for pair in matched) for occasion in (0, 1)]
        wrong: dict[str | None, str] = {name: MISCONCEPTIONS[name].title for name in question.wrong}
        named = {"": "right", **wrong, None: "no answer"}
        chosen = [(words, counts[0][name], counts[1][name]) for name, words in named.items()]
        parts = float(easy[0][k]), float(easy[1][k])
        tells = float(telling[0][k]), float(telling[1][k])
        remarks = _remarks(parts[1], tells[1]) if len(matched) >= FEW else []
        items.append(Item(answer, question.about, concept.title, parts, tells, chosen, remarks))
    return items


def _remarks(part: float, telling: float) -> list[str]:
    """What is outside the ranges that Ding et al. want, after the course."""
    remarks = []
    if part < DIFFICULTY[0]:
        remarks.append(f"hard: fewer than {100 * DIFFICULTY[0]:g} % are right")
    if part > DIFFICULTY[1]:
        remarks.append(f"easy: more than {100 * DIFFICULTY[1]:g} % are right")
    if not telling >= DISCRIMINATION:
        remarks.append(f"discrimination below {DISCRIMINATION:g}")
    return remarks


def _remaining(matched: Sequence[tuple[Paper, Paper]]) -> list[tuple[Misconception, int, int]]:
    counts: list[Mapping[str, int]] = [
        Counter(name for pair in matched for name in set(misconceptions_of(pair[occasion]))) for occasion in (0, 1)
    ]
    order = sorted(MISCONCEPTIONS, key=lambda name: (-counts[1].get(name, 0), -counts[0].get(name, 0)))
    kept = [name for name in order if any(name in one for one in counts)]
    return [(MISCONCEPTIONS[name], counts[0].get(name, 0), counts[1].get(name, 0)) for name in kept]


def _warnings(students: int, reliable: float) -> list[str]:
    if not students:
        return ["No student answered on both occasions, so there is nothing to compare."]
    found = []
    if students < FEW:
        words = "The intervals are too wide to say anything about the course, and no question can be judged."
        found.append(f"Only {students} student{'s' * (students != 1)} answered on both occasions, fewer than {FEW}. {words}")
    if students >= FEW and not reliable >= RELIABILITY:
        found.append(f"The reliability after the course is below {RELIABILITY:g}: do not compare single students.")
    return found
