"""The designs of a class on the scene that all share: without names, with the reference points, as a figure and as tables."""

import re
from collections import Counter
from math import nan

import numpy as np

from ...analysis.budget.measured import MeasuredDesign
from ...base.drawing import COLD
from ...course.cards.chart import GREY, axis_ticks, cross, disc, picture, span, words
from ...course.cards.page_text import clean, shown
from ..formats.words import points

#: of the figure, of one panel, and the room of a panel for its labels, in pixels
WIDTH, HEIGHT, PANEL, LEFT, BELOW, ABOVE = 860, 380, 430, 62, 48, 40
#: place among (error, load, margin), the label and what is better, of each panel
PANELS = ((0, "error [%]", "below and left is better"), (2, "passivity margin [N s/m]", "above and left is better"))
#: so many different designs have their numbers in the figure
NUMBERED = 40
#: reasons that repeat what a student wrote, which may be a name; the page of a class does not
WRITTEN = (
    (re.compile(r"^.* is not chosen in", re.S), "a name is not chosen in"),
    (re.compile(r" is .*; it needs one of", re.S), " is not known; it needs one of"),
)


def class_fronts(graded):
    """What fronts.html tells: for each exercise and each public scene its reference points and the answers, by load.

    Parameters
    ----------
    graded : list of Report

    Returns
    -------
    list of dict
        ``name``, ``scene``, ``points``, ``answers`` (number, of how many students, design, figures, dominated, whether on the
        front, mark; equal ones are one), ``failed`` (reason, how many), ``figure``.
    """
    found = {}
    for report in graded:
        for one in report.exercises:
            for number, row in enumerate(row for row in one.designs if row["public"]):
                found.setdefault((one.name, number), []).append((row, one))
    return [_scene(name, several) for (name, _), several in found.items()]


def _scene(name, several):
    first = several[0][0]
    feasible = [(row, one) for row, one in several if row["figures"]]
    same = Counter(
        (tuple(row["figures"]), shown(dict(sorted(row["design"].items())))[1:-1], tuple(row["dominates"]), points(one.earned))
        for row, one in feasible
    )
    measured = {line: MeasuredDesign({}, line[0][0], nan, *line[0][1:]) for line in same}
    answers = []
    for number, line in enumerate(sorted(same, key=lambda line: (line[0][1], line)), start=1):
        front = not any(other.dominates(measured[line]) for other in measured.values())
        told = dict(zip(("figures", "design", "dominates", "earned"), line, strict=True))
        answers.append({"number": number, "students": same[line], "front": front, **told})
    failed = Counter(_without_words(row["why"]) for row, _ in several if not row["figures"])
    found = {"name": name, "scene": first["scene"], "points": first["points"], "answers": answers, "of": several[0][1].points}
    return {**found, "failed": failed.most_common(), "figure": figure(name, first["points"], answers)}


def _without_words(why):
    """Return a reason without what a student wrote."""
    for written, told in WRITTEN:
        why = written.sub(told, why)
    return why


def figure(name, reference, answers):
    """Both panels as SVG: circles are answers, filled on the front; crosses with letters are reference points."""
    inside = [_panel(k, *PANELS[k], reference, answers) for k in range(len(PANELS))]
    front = sum(one["front"] for one in answers)
    students = sum(one["students"] for one in answers)
    alt = (
        f"{name}: {students} feasible designs of the class, {len(answers)} different ones, and {len(reference)} reference "
        f"points, error and passivity margin against load; {front} designs are on the front of the class. The tables below "
        "have all numbers."
    )
    return picture(WIDTH, HEIGHT, "".join(inside), alt)


def _panel(number, place, label, better, reference, answers):
    left, right = number * PANEL + LEFT, (number + 1) * PANEL - 14
    drawn = [*(one["figures"] for one in answers), *reference.values()]
    ends = [span([np.array([figures[axis] for figures in drawn])]) for axis in (1, place)]

    def at(load, up):
        across, high = ((value - low) / (top - low) for value, (low, top) in zip((load, up), ends, strict=True))
        return left + across * (right - left), HEIGHT - BELOW - high * (HEIGHT - BELOW - ABOVE)

    parts = [words((left + right) / 2, 20, better), words((left + right) / 2, HEIGHT - 8, "load of the board [%]")]
    parts.append(words(left - 48, (ABOVE + HEIGHT - BELOW) / 2, label, turned=True))
    for tick, text in axis_ticks(*ends[1]):
        y = at(ends[0][0], tick)[1]
        parts += [f'<path d="M{left},{y:.1f}H{right}" stroke="#ddd"/>', words(left - 6, y + 4, text, anchor="end")]
    for tick, text in axis_ticks(*ends[0]):
        x = at(tick, ends[1][0])[0]
        parts += [f'<path d="M{x:.1f},{HEIGHT - BELOW}v5" stroke="{GREY}"/>', words(x, HEIGHT - BELOW + 18, text)]
    for one in sorted(answers, key=lambda one: one["front"]):
        x, y = at(one["figures"][1], one["figures"][place])
        parts.append(disc(x, y, COLD if one["front"] else "#fff", 4.5))
        if len(answers) <= NUMBERED:
            parts.append(words(x, y - 8, one["number"]))
    for letter, figures in reference.items():
        x, y = at(figures[1], figures[place])
        parts += [cross(x, y, 5), words(x + 8, y + 5, clean(letter, 12), anchor="start")]
    return "".join(parts)
