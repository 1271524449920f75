"""The page of one student: what each exercise earned, and why."""

import re

from ...course.exercise import NOTED
from ..formats.words import state
from .failing_case import failing_case
from .page_text import BLOCK, clean

#: how an exercise went -> the sign that is read with the word, or in its place
STATES = {"right": "&#10003;", "wrong": "&#10007;", "no answer": "&#9675;", "cell failed": "&#9651;", "noted": "&#9998;"}
MOST_CELLS = 40
#: what a cell raises that uses an answer as the notebook came: a function's body, or None
OPEN = re.compile("^NotImplementedError|'NoneType'")


def broken(report):
    """Return whether a cell failed by more than the use of an answer that is still open, as the notebook came."""
    return any(not OPEN.search(words) for _, words in report.cells)


def points(earned, of):
    """Return points in words, "7 of 10 points"."""
    return f"{earned:g} of {of:g} point{'' if of == 1 else 's'}"


def student_body(report, lab):
    """Return the body of a student's page.

    Parameters
    ----------
    report : Report
    lab : Lab
    """
    return "".join(
        [
            f"<header><p>Lab {clean(report.lab, 20)}</p><h1>{clean(report.title)}</h1>",
            f'<p class="who"><bdi>{clean(report.student, 120)}</bdi></p>',
            f'<p class="mark">{points(report.earned, report.points)}</p></header><main>',
            *_whole(report),
            *(_exercise(k, one, lab, report) for k, one in enumerate(report.exercises, 1)),
            _cells(report.cells),
            "</main>",
            f"<footer><p>Handed in: <bdi><code>{clean(report.submission, 120)}</code></bdi>, SHA-256 "
            f"<code>{clean(report.sha256[:16], 16)}</code>. An exercise earns its points where every case is right; predictions "
            "and discussions are noted and carry none.</p></footer>",
        ]
    )


def _whole(report):
    """Yield what is to say of the whole submission: why it could not be graded, else a table of the exercises."""
    if report.problem:
        yield f'<p class="problem"><strong>This could not be graded:</strong> {clean(report.problem)}</p>'
        return
    head = "".join(f'<th scope="col">{word}</th>' for word in ("exercise", "result", "cases right", "points"))
    rows = "".join(
        f'<tr><th scope="row"><a href="#e{k}"><code>{clean(one.name, 60)}</code></a></th><td>{badge(one)}</td>'
        f'<td class="number">{f"{one.right} of {one.cases}" if one.cases else ""}</td>'
        f'<td class="number">{f"{one.earned:g} of {one.points:g}" if one.points else ""}</td></tr>'
        for k, one in enumerate(report.exercises, 1)
    )
    yield f"<section><table><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table></section>"


def badge(one):
    """Return how an exercise went as a sign and a word."""
    found = state(one)
    return f'<span class="badge {found.split()[0]}">{STATES[found]} {found}</span>'


def _exercise(number, one, lab, report):
    whole = not report.problem
    told = [
        f'<section id="e{number}"><h2><code>{clean(one.name, 60)}</code> {badge(one) if whole else ""}'
        + (f'<span class="aside">{points(one.earned, one.points)}</span>' if one.points else "")
        + "</h2>",
        f'<p class="asks">Asked for: {clean(one.asks)}</p>' if one.asks else "",
    ]
    if one.kind in NOTED:
        told.append(_block(one.text, "written") if one.text.strip() else "")
        told.append(f"<p>{clean(one.words)}</p>" if one.words and one.answered else "")
    elif whole and state(one) != "right":
        told.append(_words(one, broken(report)))
        told.append(f'<p class="hint"><strong>Hint:</strong> {clean(one.hint)}</p>' if one.hint else "")
        told.append(failing_case(one, lab) if one.failing and state(one) == "wrong" else "")
    if one.printed.strip():
        told.append(f"<h3>What your code printed</h3>{_block(one.printed, 'printed')}")
    return "".join(told) + "</section>"


def _words(one, may_be_lost):
    """Return what is wrong in a sentence; where there is no answer, whether a cell that failed may be why."""
    if state(one) == "no answer":
        why = '<a href="#errors">Cells failed</a>, and there is no answer: if it is in one of them, that is why.'
        return f'<p class="words">{why}</p>' if may_be_lost else ""
    if not one.words:
        return ""
    return f'<p class="words"><strong>What is wrong:</strong> {clean(one.words)}</p>'


def _block(text, kind):
    return f'<pre class="{kind}" dir="auto">{clean(text.strip(), BLOCK, lines=True)}</pre>'


def _cells(cells):
    """Return a table of the cells that failed."""
    if not cells:
        return ""
    rows = "".join(
        f'<tr><th scope="row" class="number">{clean(str(cell), 20)}</th><td>{clean(words)}</td></tr>'
        for cell, words in cells[:MOST_CELLS]
    )
    more = f"<p>{len(cells) - MOST_CELLS} cells more failed.</p>" if len(cells) > MOST_CELLS else ""
    head = '<tr><th scope="col">code cell</th><th scope="col">what it raised</th></tr>'
    body = f"<table><thead>{head}</thead><tbody>{rows}</tbody></table>{more}"
    return f'<section id="errors"><h2>Cells that failed</h2>{body}</section>'
