"""The page of a class: how the marks are spread, what was hard, which mistakes were common, and who needs a look."""

from collections import Counter
from statistics import mean, median

from ..formats.words import judged, state
from .page_figures import bars, shares
from .page_text import clean
from .student_page import STATES, broken

#: students named under one mistake
MOST_NAMED = 200
#: how an exercise went -> the word beside its sign, in the order of tables and bars
WORDS = {"right": "right", "wrong": "wrong", "no answer": "no answer", "cell failed": "no answer, and a cell failed"}


def class_body(pages, lab):
    """Return the body of a class's page.

    Parameters
    ----------
    pages : list of (str, Report)
        Address of each student's page, and the report.
    lab : Lab
    """
    graded = [(address, report) for address, report in pages if not report.problem]
    return "".join(
        [
            f"<header><p>Lab {clean(lab.number, 20)}</p><h1>{clean(lab.title)}: the class</h1>{_numbers(pages, graded)}</header>",
            "<main>",
            *([_marks(graded), _exercises(graded), _mistakes(graded)] if graded else []),
            _ungraded(pages),
            _stopped(graded),
            _students(pages),
            "</main><footer><p>An exercise earns its points where every case is right. Shares are of those graded.</p></footer>",
        ]
    )


def _numbers(pages, graded):
    """Return in a sentence how many there are and what they earned."""
    told = f"{len(pages)} submission{'' if len(pages) == 1 else 's'}, {len(graded)} graded."
    if graded:
        earned = [report.earned for _, report in graded]
        full = sum(report.earned == report.points for _, report in graded)
        told += f" Median {median(earned):.3g}, mean {mean(earned):.3g} of {graded[0][1].points:g} points; {full} earned all."
    return f'<p class="mark">{told}</p>'


def table(head, rows, caption=""):
    """Return a table; the first cell of each row is its header, and all cells are HTML."""
    top = "".join(f'<th scope="col">{word}</th>' for word in head)
    body = "".join(
        f'<tr><th scope="row">{first}</th>{"".join(f"<td>{cell}</td>" for cell in rest)}</tr>' for first, *rest in rows
    )
    told = f"<caption>{caption}</caption>" if caption else ""
    return f"<table>{told}<thead><tr>{top}</tr></thead><tbody>{body}</tbody></table>"


def _marks(graded):
    """Return how marks are spread: bands of a tenth of what can be earned, and those who earned all."""
    whole = max(report.points for _, report in graded) or 1.0
    bands = [int(max(0.0, min(10.0, 10 * report.earned / whole + 1e-9))) for _, report in graded]
    exact = all(10 * report.earned / whole % 1 == 0 for _, report in graded)
    names = [f"{k * whole / 10:g}" if exact or k == 10 else f"{k * whole / 10:g} to {(k + 1) * whole / 10:g}" for k in range(11)]
    counts = {name: bands.count(k) for k, name in enumerate(names)}
    told = ", ".join(f"{count} with {name}" for name, count in counts.items() if count)
    rows = [(name, count, f"{100 * count / len(graded):.0f} %") for name, count in counts.items()]
    return (
        f"<section><h2>Marks</h2><figure>{bars(counts, 'points', f'Number of students by points: {told}.')}</figure>"
        f"{table(('points', 'students', 'share'), rows, 'Students by points')}</section>"
    )


def _exercises(graded):
    """Return how each exercise went, the hardest one first in words."""
    rows = {}
    for _, report in graded:
        for one in judged(report):
            rows.setdefault(one.name, dict.fromkeys(WORDS, 0))[went(one, report)] += 1
    if not rows:
        return ""
    part = {name: counts["right"] / sum(counts.values()) for name, counts in rows.items()}
    hardest = [name for name in rows if part[name] == min(part.values())]
    told = f"{'Hardest' if part[hardest[0]] < 1 else 'Everybody is right in'}: "
    told += ", ".join(f"<strong><code>{clean(name, 60)}</code></strong>" for name in hardest)
    told += f", right in {rows[hardest[0]]['right']} of {sum(rows[hardest[0]].values())} submissions."
    alt = "; ".join(f"{name}: {', '.join(f'{n} {WORDS[word]}' for word, n in counts.items())}" for name, counts in rows.items())
    lines = [
        (f"<code>{clean(name, 60)}</code>", *(_share(count, sum(counts.values())) for count in counts.values()))
        for name, counts in rows.items()
    ]
    return (
        f"<section><h2>Exercises</h2><p>{told}</p><figure>{shares(rows, alt)}</figure>"
        f"{table(('exercise', *WORDS.values()), lines, 'Submissions by exercise')}</section>"
    )


def went(one, report):
    """Return how an exercise went: :func:`state`, or "cell failed" where there is no answer and a cell of the notebook failed.

    Which exercise that cell is of, nobody can tell of one that is no Python.
    """
    found = state(one)
    return "cell failed" if found == "no answer" and broken(report) else found


def _share(count, whole):
    return f'<span class="share">{count} ({100 * count / whole:.0f} %)</span>'


def _mistakes(graded):
    """Return what students get wrong alike, the most common first, and how many are wrong in ways of their own."""
    found, unknown, order = {}, Counter(), []
    for address, report in graded:
        for one in judged(report):
            order += [one.name] if one.name not in order else []
            if state(one) == "wrong" and one.slip:
                found.setdefault((one.name, one.slip), []).append(link(address, report))
            elif state(one) == "wrong" and not one.ended:
                unknown[one.name] += 1
    ranked = sorted(found.items(), key=lambda item: (-len(item[1]), order.index(item[0][0]), item[0][1]))
    rows = [(len(who), f"<code>{clean(name, 60)}</code>", clean(slip), _named(who)) for (name, slip), who in ranked]
    told = table(("how often", "exercise", "what it says", "who"), rows) if rows else "<p>No known mistake was found.</p>"
    if unknown:
        listed = ", ".join(f"{unknown[name]} in <code>{clean(name, 60)}</code>" for name in order if unknown[name])
        told += f"<p>Wrong in a way that no sentence knows: {listed}.</p>"
    return f"<section><h2>Common mistakes</h2>{told}</section>"


def link(address, report):
    """Return a link to a student's page."""
    return f'<a href="{address}"><bdi>{clean(report.student, 120)}</bdi></a>'


def _named(who):
    listed = ", ".join(who[:MOST_NAMED]) + (f" and {len(who) - MOST_NAMED} more" if len(who) > MOST_NAMED else "")
    return listed if len(who) <= 6 else f"<details><summary>{len(who)} students</summary>{listed}</details>"


def _ungraded(pages):
    rows = [
        (link(address, report), f"<code>{clean(report.submission, 120)}</code>", clean(report.problem))
        for address, report in pages
        if report.problem
    ]
    if not rows:
        return "<section><h2>Could not be graded</h2><p>None: every submission was graded.</p></section>"
    return f"<section><h2>Could not be graded</h2>{table(('student', 'handed in', 'why'), rows)}</section>"


def _stopped(graded):
    """Return whose code was stopped, in which exercise and why."""
    rows = [
        (link(address, report), f"<code>{clean(one.name, 60)}</code>", clean(one.words or one.ended))
        for address, report in graded
        for one in report.exercises
        if one.ended
    ]
    told = table(("student", "exercise", "why"), rows) if rows else "<p>None.</p>"
    return f"<section><h2>Stopped: out of time, memory or bounds</h2>{told}</section>"


def _students(pages):
    """Return everybody's mark and the way each exercise went."""
    names = list(dict.fromkeys(one.name for _, report in pages for one in judged(report)))
    rows = []
    for address, report in pages:
        found = {one.name: went(one, report) for one in judged(report)}
        marks = [_sign(found[name]) if name in found and not report.problem else "" for name in names]
        earned = "not graded" if report.problem else f"{report.earned:g} of {report.points:g}"
        rows.append((link(address, report), earned, *marks))
    head = ("student", "mark", *(f'<code class="upright">{clean(name, 60)}</code>' for name in names))
    key = "; ".join(f"{STATES[found]} {words}" for found, words in WORDS.items())
    return f'<section class="students"><h2>Students</h2><p>{key}</p>{table(head, rows)}</section>'


def _sign(found):
    return f'<span class="{found.split()[0]}" role="img" aria-label="{WORDS[found]}">{STATES[found]}</span>'
