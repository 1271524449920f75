"""The card of a wrong exercise on a student's page: the card of a check, without what was expected."""

import re

from ...course.cards.card import STYLES, Card

#: in the words on a case, what was expected: up to the end of the sentence
EXPECTED = re.compile(r",? expected [^;]*?(?=\.?$|\. [A-Z]|;)")
#: what words begin with where the code ended with an error: a hint about the physics would lead away from it
RAISED = "it raises "
#: the style sheet holds what the card in a notebook has in its elements: the page's policy allows no style there
SHEET = "".join(f".card-{part} {{ {look} }}\n" for part, look in STYLES.items())


def card(one):
    """Return the card of an ExerciseReport that is wrong, in HTML.

    Examples
    --------
    >>> from hapticlab.grading.report import ExerciseReport
    >>> words = "-2 N, expected 2 N. The sign is wrong."
    >>> one = ExerciseReport("F", "function", right=1, cases=3, words=words, slip="The sign is wrong.", hint="Who pushes?")
    >>> [line.partition(":</strong> ")[2] for line in card(one).split("</p>")[1:-1]]
    ['-2 N', 'The sign is wrong.', 'Who pushes?']
    """
    told = {"wrong": without_answer(one), "likely slip": one.slip, "hint": "" if one.words.startswith(RAISED) else one.hint}
    rows = tuple((label, words) for label, words in told.items() if words)
    return Card("", "partly" if one.right else "wrong", f"{one.right} of {one.cases} cases right", rows=rows).html(_classes)


def without_answer(one):
    """Return the words on a wrong answer without what was expected, and without the likely slip that is told beside them."""
    words = " ".join((one.words.replace(one.slip, "", 1) if one.slip else one.words).split())
    return EXPECTED.sub("", words).removesuffix(".").removesuffix(":")


def _classes(*parts):
    return f' class="{" ".join(f"card-{part}" for part in parts)}"'
