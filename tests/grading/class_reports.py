"""Reports of a class as a grader makes them: right answers, the wrong ones that students write, and none."""

import runpy
from dataclasses import replace
from pathlib import Path

import numpy as np

from hapticlab.course.evaluate import evaluate
from hapticlab.course.judge import verdict
from hapticlab.course.labs import find_labs
from hapticlab.course.marks import SOLUTION, WRONG, hidden_cases, instructor_names
from hapticlab.grading.report import ExerciseReport, Failing, Report

TESTS = Path(__file__).parents[1]
NAMES = ("ada", "Blaise", "Émilie du Châtelet", "زينب", "kovalevskaya", "o'neill", "sophie.germain", "Zoë")


def folder_of(number):
    """Return the folder of a lab, and that of its answers."""
    (folder,) = (lab for lab in find_labs() if lab.number == number)
    return folder, TESTS / "instructor" / folder.name


def exercise_report(exercise, answer, hidden):
    """Return what a grader finds of one answer."""
    blank = ExerciseReport(exercise.name, exercise.kind, exercise.asks, exercise.points)
    if not exercise.judged:
        return replace(blank, answered=bool(answer), text="" if answer is None else str(answer))
    cases = [(case, True) for case in exercise.cases] + [(case, False) for case in hidden]
    outcomes = [evaluate(exercise.kind, answer, case.given) for case, _ in cases]
    verdicts = [verdict(exercise, case, outcome) for (case, _), outcome in zip(cases, outcomes, strict=True)]
    right = sum(v.right for v in verdicts)
    blank = replace(blank, cases=len(cases), right=right, answered=any(o.answered for o in outcomes))
    if right == len(cases):
        return replace(blank, earned=exercise.points)
    k = [v.right for v in verdicts].index(False)
    (case, public), outcome = cases[k], outcomes[k]
    told = exercise.kind not in ("value", "choice")
    failing = Failing(dict(case.given), outcome.value, case.expected if told else None, case.unit, public)
    printed = "".join(o.printed for o in outcomes)
    return replace(blank, words=verdicts[k].words, slip=verdicts[k].slip, hint=exercise.hint, failing=failing, printed=printed)


def class_of(number, many, seed=1):
    """Return the reports of so many students, and the lab; some code was stopped, and some could not be graded."""
    folder, answers = folder_of(number)
    lab, random = folder.lab(), np.random.default_rng(seed)
    right, hidden = instructor_names(answers / SOLUTION), hidden_cases(lab, answers)
    written = runpy.run_path(str(answers / WRONG))["WRONG"]
    found = {
        exercise.name: [
            exercise_report(exercise, answer, hidden.get(exercise.name, ()))
            for answer in (
                right[exercise.name],
                None,
                *(wrong for name, wrong in written if name == exercise.name),
            )
        ]
        for exercise in lab.exercises
    }
    return [_report(k, lab, folder.notebook.name, found, random) for k in range(many)], lab


def _report(k, lab, name, found, random):
    student = f"{NAMES[k % len(NAMES)]}{k // len(NAMES) or ''}"
    blank = Report(student, lab.number, lab.title, name, sha256=f"{k:064x}")
    none = tuple(several[1] for several in found.values())
    if k % 23 == 7:
        return replace(blank, submission="wall.docx", problem="wall.docx is no notebook, script, folder or zip", exercises=none)
    skill = random.uniform(0.35, 1.0)
    exercises = []
    for several in found.values():
        wrong = several[2:] or [several[1]]
        draw = random.random()
        exercises.append(several[0] if draw < skill else several[1] if draw > 0.9 else wrong[int(random.integers(len(wrong)))])
    if k % 11 == 3:
        exercises[1] = replace(none[1], answered=True, ended="time", words="it ran out of time", printed="step 1\nstep 2\n")
    cells = ((4, "NameError in line 3: name 'k_wall' is not defined"),) if k % 5 == 2 else ()
    return replace(blank, exercises=tuple(exercises), cells=cells)
