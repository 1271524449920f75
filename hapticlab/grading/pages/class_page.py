"""Numbers of a class's page: how the marks are spread, what was hard, which mistakes were common, and who needs a look."""

import re
from collections import Counter
from statistics import mean, median

from ...course.exercise import NOTED
from ..formats.words import judged, state
from .fronts import class_fronts

#: how an exercise went -> the word beside its sign, in the order of tables and bars
WORDS = {
    "right": "right",
    "partly": "a part of the points",
    "wrong": "wrong",
    "no answer": "no answer",
    "cell failed": "no answer, and a cell failed",
}
#: what a cell raises that uses an answer as the notebook came: a function's body, or None
OPEN = re.compile("^NotImplementedError|'NoneType'")


def broken(report):
    """Whether a cell failed by more than the use of an answer that is still open, as the notebook came."""
    return any(not OPEN.search(words) for _, words in report.cells)


def class_facts(pages):
    """What class.html tells.

    Parameters
    ----------
    pages : list of (str, Report)
        Address of each student's page, and the report.
    """
    graded = [(address, report) for address, report in pages if not report.problem]
    facts = {
        "pages": pages,
        "graded": graded,
        "stopped": [(address, report, one) for address, report in graded for one in report.exercises if one.ended],
        "written": _written(graded),
        "names": list(dict.fromkeys(one.name for _, report in pages for one in judged(report))),
        "ways": ways(graded),
        "fronts": class_fronts([report for _, report in graded]),
        "students": [(address, report, {one.name: went(one, report) for one in judged(report)}) for address, report in pages],
    }
    return facts | _marks(graded) | _exercises(graded) | _mistakes(graded) if graded else facts


def _marks(graded):
    """How marks are spread: bands of a tenth of what can be earned, and those who earned all."""
    earned = [report.earned for _, report in graded]
    whole = max(report.points for _, report in graded) or 1.0
    bands = [int(max(0.0, min(10.0, 10 * mark / whole + 1e-9))) for mark in earned]
    exact = all(10 * mark / whole % 1 == 0 for mark in earned)
    names = [f"{k * whole / 10:g}" if exact or k == 10 else f"{k * whole / 10:g} to {(k + 1) * whole / 10:g}" for k in range(11)]
    counts = {name: bands.count(k) for k, name in enumerate(names)}
    told = ", ".join(f"{count} with {name}" for name, count in counts.items() if count)
    return {
        "median": median(earned),
        "mean": mean(earned),
        "full": sum(report.earned == report.points for _, report in graded),
        "marks": counts,
        "marks_told": f"Number of students by points: {told}.",
    }


def _exercises(graded):
    """How often each exercise went which way, and the hardest ones."""
    rows, all_ways = {}, ways(graded)
    for _, report in graded:
        for one in judged(report):
            rows.setdefault(one.name, dict.fromkeys(all_ways, 0))[went(one, report)] += 1
    part = {name: counts["right"] / sum(counts.values()) for name, counts in rows.items()}
    names = [name for name in rows if part[name] == min(part.values())]
    hardest = {"names": names, "right": rows[names[0]]["right"], "whole": sum(rows[names[0]].values())} if rows else {}
    told = "; ".join(f"{name}: {', '.join(f'{n} {WORDS[word]}' for word, n in counts.items())}" for name, counts in rows.items())
    asked = {one.name: one for _, report in graded for one in judged(report)}
    return {"questions": asked, "exercises": rows, "hardest": hardest, "exercises_told": told}


def ways(graded):
    """Return how exercises can go, with words: only a design can earn a part of its points."""
    parts = any(one.kind == "design" for _, report in graded for one in report.exercises)
    return {way: words for way, words in WORDS.items() if parts or way != "partly"}


def _written(graded):
    """What students wrote, side by side: exercise to what was asked for, and each student's text."""
    found = {}
    for address, report in graded:
        for one in report.exercises:
            if one.kind in NOTED and one.text.strip():
                found.setdefault(one.name, (one.asks, []))[1].append((address, report, one.text.strip()))
    return found


def went(one, report):
    """How an exercise went: :func:`state`, or "cell failed" where there is no answer and a cell of the notebook failed.

    Which exercise that cell is of, nobody can tell of one that is no Python.
    """
    found = state(one)
    return "cell failed" if found == "no answer" and broken(report) else found


def _mistakes(graded):
    """What students get wrong alike, the most common first, and how many are wrong in ways of their own."""
    found, unknown, order = {}, Counter(), []
    for address, report in graded:
        for one in judged(report):
            order += [one.name] if one.name not in order else []
            if state(one) in ("wrong", "partly") and one.slip:
                found.setdefault((one.name, one.slip), []).append((address, report))
            elif state(one) == "wrong" and not one.ended and one.kind != "design":
                unknown[one.name] += 1
    ranked = sorted(found.items(), key=lambda item: (-len(item[1]), order.index(item[0][0]), item[0][1]))
    return {"mistakes": ranked, "unknown": {name: unknown[name] for name in order if unknown[name]}}
