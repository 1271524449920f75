"""What a card of a check says: its state, its rows and its figures, from the verdicts on the public cases."""

from .case_figures import WrongCase, figures

#: of what a student's code prints while it is checked
MOST_LINES, MOST_CHARACTERS = 10, 200
#: characters of what a case gives
MOST_GIVEN = 90
MOST_DRAWN = 2


def state(verdicts):
    """Return state and head of a card: what was judged is the public cases, and no more."""
    right, cases = sum(v.right for v in verdicts), len(verdicts)
    if right == cases:
        return "right", "right in the public cases"
    if right:
        return "partly", f"partly right, not right yet: {right} of {cases} public cases"
    part = min((v.share for v in verdicts), default=0)
    return ("partly", f"{part:.0%} of the points in the public cases") if part else ("wrong", "not right yet")


def drawn(exercise, outcomes, verdicts):
    """Return figures of the first wrong case that has lists or curves: what came beside what was expected, where that is told."""
    if exercise.kind in ("value", "choice", "design"):
        return ()
    for case, outcome, found in zip(exercise.cases, outcomes, verdicts, strict=True):
        if not found.right and outcome.value is not None:
            wrong = WrongCase(exercise.name, exercise.kind, case.given, outcome.value, case.expected, case.unit)
            return tuple(figures(wrong, lambda name, otherwise="": otherwise)[:MOST_DRAWN])
    return ()


def case_rows(exercise, verdicts):
    """Yield a row for what is wrong first, for each likely slip and the hint, then for the other cases."""
    told = {}
    for case, found in zip(exercise.cases, verdicts, strict=True):
        told.setdefault(("right" if found.right else "wrong", without_slip(found)), []).append(case)
    wrong = [row for row in told if row[0] == "wrong"]
    for row in wrong[:1]:
        yield row[0], row[1] + _at(exercise, told.pop(row))
        yield from dict.fromkeys(("likely slip", v.slip) for v in verdicts if v.slip)
        yield from [("hint", exercise.hint)] if exercise.hint else []
    for (state, words), cases in sorted(told.items(), key=lambda one: one[0][0] == "right"):
        yield "also wrong" if state == "wrong" else state, words + _at(exercise, cases)


def without_slip(found):
    """Return the words of a verdict without the sentence that teaches; one sentence alone loses its full stop."""
    words = " ".join(found.words.replace(found.slip, "", 1).split()) if found.slip else found.words
    return words.removesuffix(".") if ". " not in words and not words.endswith("...") else words


def _at(exercise, cases):
    """Return where words hold, in brackets: in a case, by what was given, or in several; of an expression they name the point."""
    if len(cases) > 1:
        return f" (in {len(cases)} cases)"
    shown = {} if exercise.kind == "expression" else cases[0].given
    given = ", ".join(f"{name} = {_brief(value)}" for name, value in shown.items())
    if len(given) > MOST_GIVEN:
        given = f"{given[:MOST_GIVEN].rpartition(', ')[0]}, ..."
    return f" ({given})" if given else ""


def _brief(value):
    """Return a given in a few characters."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{name}: {_brief(part)}" for name, part in value.items()) + "}"
    if isinstance(value, list | tuple):
        shown = ", ".join(_brief(part) for part in value[:4])
        return f"[{shown}]" if len(value) <= 4 else f"[{shown}, ... {len(value)} in all]"
    return f"{value:g}" if isinstance(value, float) else str(value)


def printed(outcomes):
    """First lines that a student's code printed."""
    lines = "".join(outcome.printed for outcome in outcomes).splitlines()
    more = len(lines) - MOST_LINES
    return [("printed", line[:MOST_CHARACTERS]) for line in lines[:MOST_LINES]] + [("printed", f"{more} lines more")] * (more > 0)
