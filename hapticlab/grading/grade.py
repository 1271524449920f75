"""One submission is graded: its answers are asked for in processes of their own, and judged in this one.

First the statements that the answers need run alone, which is quick; an exercise that is right there has earned its points.
For the others the whole notebook runs, cell by cell, as it did for its student: only then is an answer called wrong.

The answers of a session are evaluated in one process, one after another, so an answer may change what the next one finds. Wrong
counts where no other answer can have made it so: the same came when the answers were asked for in the opposite order, or nothing
was asked before. Right is right, but what was wrong before must be right twice: it may have been thrown with a die.

What a student may be told comes from sessions that have not heard of a hidden case yet: all that is shown is asked for
before all that is hidden, and what the quick way gave is told to nobody.
"""

from __future__ import annotations

import base64
import time
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from .handed_in.replies import Garbage, line_of, outcomes_of
from .marking import SHOWN, Found, ended_words, exercise_report
from .report import Report
from .sessions.starter import SessionEnded

if TYPE_CHECKING:
    from .assignment import Assignment
    from .handed_in.submission import Submission
    from .sessions.limits import Limits
    from .sessions.starter import Starter

#: what a session is charged for its start [s], and how much wall clock a submission has, in what it may be charged
START, MOST_WALL = 0.05, 3
#: the quick way's part of the time of a step: who needs more is graded by the whole notebook anyway
QUICK = 0.25


@dataclass(frozen=True)
class Deferred:
    """A limit of time was met in a turn that is not the last; it is decided in that."""

    student: str


class _Late(Exception):
    """A limit of time was met in a turn that is not the last."""


class _Spent(Exception):
    """The time of the whole submission is over."""


class _Unknown(Exception):
    """The code does not tell which statements the answers need."""


def grade(
    submission: Submission, assignment: Assignment, starter: Starter, limits: Limits, *, last: bool = True
) -> Report | Deferred:
    """Grade one submission.

    Parameters
    ----------
    submission : Submission
    assignment : Assignment
    starter : Starter
        Of the processes that the student's code runs in.
    limits : Limits
    last : bool
        Whether a limit of time that is met counts. It does not while others are at work who meet none and may be in its way.

    Returns
    -------
    Report or Deferred
    """
    if submission.problem:
        return refused(submission, assignment, submission.problem, limits)
    cases = assignment.cases(submission.student)
    work = _Work(submission, assignment, starter, limits, last, cases, time.monotonic() + MOST_WALL * limits.total)
    try:
        work.quick()
        work.whole()
    except _Late:
        return Deferred(submission.student)
    except _Spent:
        work.found |= {name: Found(ended="time") for name in work.undecided()}
    return _report(submission, assignment, cases, work.found, work.problems(), limits)


def refused(submission: Submission, assignment: Assignment, problem: str, limits: Limits) -> Report:
    """Return the report on a submission that cannot be graded, and why."""
    return _report(replace(submission, problem=problem), assignment, {}, {}, (), limits)


def _report(submission, assignment, cases, found, problems, limits):
    lab = assignment.lab
    return Report(
        student=line_of(submission.student),
        lab=lab.number,
        title=lab.title,
        submission=line_of(submission.name),
        sha256=submission.sha256,
        problem=line_of(submission.problem),
        cells=problems,
        exercises=tuple(
            exercise_report(one, cases.get(one.name, ()), found.get(one.name, Found()), limits, assignment.slips)
            for one in lab.exercises
        ),
    )


@dataclass(frozen=True, eq=False)
class _Ask:
    """Cases of an exercise that are asked for at once."""

    name: str
    kind: str
    givens: list


@dataclass
class _Work:
    """The way of a submission through its sessions."""

    submission: Submission
    assignment: Assignment
    starter: Starter
    limits: Limits
    last: bool
    cases: dict
    until: float
    spent: float = 0.0
    found: dict = field(default_factory=dict)
    raised: dict = field(default_factory=dict)
    left_out: dict = field(default_factory=dict)

    def __post_init__(self) -> None:
        self._untouched = tuple(self.submission.cells) == self.assignment.untouched
        self._told, self._step = False, self.limits.seconds

    def quick(self):
        """Ask for all answers where only the statements ran that they need."""
        names = [exercise.name for exercise in self.assignment.lab.exercises]

        def prepare(session):
            if not self._ask(session, {"do": "plan", "names": names}).get("known"):
                raise _Unknown
            self._ask(session, {"do": "run_pieces"})

        self._step = QUICK * self.limits.seconds
        with suppress(_Unknown):
            self._answers([_Ask(one.name, *self._asked(one, (True, False))) for one in self._ordered(names)], prepare)
        self._step = self.limits.seconds

    def whole(self):
        """Ask for the answers that are not right yet where the whole notebook ran."""
        self._told, pending = True, self.undecided()
        wrong = {name for name in pending if self._answered(name)}
        for step in (-1, 1):
            before = {name: _said(self.found.get(name)) for name in pending}  # of the quick way, which asks in the lab's order
            self._ask_whole(pending, step)
            left = [name for name in pending if name in self.undecided()]
            doubtful = [name for name in pending if name in wrong and name not in left]
            wrong |= {name for name in left if self._answered(name)}
            # what is no code to be called is asked for before all that is
            pending = [name for name in left if self._is_called(name) and _said(self.found.get(name)) != before[name]]
            for name in doubtful:
                self._ask_whole([name])
            if len(before) < 2:
                return
        for name in pending:
            self._ask_whole([name])
            if name in wrong and name not in self.undecided():
                self._ask_whole([name])

    def _is_called(self, name):
        exercise = self.assignment.lab.exercise(name)
        return exercise.judged and exercise.kind not in SHOWN

    def _ordered(self, names, step=1):
        """Return exercises: what is only noted, as it is told to the student, what is no code to be called, and the others."""
        asked = [self.assignment.lab.exercise(name) for name in names[::step]]
        return sorted(asked, key=lambda one: (one.judged, self._is_called(one.name)))

    def _ask_whole(self, names, step=1):
        """Ask for answers: all that is shown, then all that is hidden."""
        asked = self._ordered(names, step)
        self.found = {name: found for name, found in self.found.items() if name not in names}
        asks = [_Ask(one.name, *self._asked(one, (shown,))) for shown in (True, False) for one in asked]
        end = self._answers([one for one in asks if one.givens], self._run_cells)
        self.found |= {one.name: Found(ended=end) for one in self._left}

    def undecided(self):
        """Return the exercises that may be found otherwise when the whole notebook runs."""
        if all(self._decided(one) for one in self.assignment.lab.exercises if one.judged):
            return []
        return [one.name for one in self.assignment.lab.exercises if not self._decided(one)]

    def problems(self):
        """Return the cells that failed and what they raised, counted from 1."""
        ended = {cell: ended_words(reason, self.limits) for cell, reason in self.left_out.items()}
        words = {cell: said for cell, said in (self.raised | ended).items() if said}
        return tuple((cell + 1, words[cell]) for cell in sorted(words))

    def _decided(self, exercise):
        """Whether it is right, noted, or without an answer in the lab's own notebook."""
        found = self.found.get(exercise.name, Found(ended="nothing"))
        report = exercise_report(exercise, self.cases.get(exercise.name, ()), found, self.limits)
        if not exercise.judged and report.answered:
            return not report.ended
        return (exercise.judged and report.right == report.cases) or (self._untouched and not report.answered)

    def _answered(self, name):
        """Whether there was an answer, be it a wrong one."""
        return any(outcome.answered for outcome in self.found.get(name, Found()).outcomes)

    def _asked(self, exercise, shown):
        """Return the kind, and the givens of the cases that are shown, or hidden, or both."""
        if not exercise.judged:
            return "value", [{}] * (True in shown)
        cases = [case for case, public in self.cases[exercise.name] if (public or exercise.kind in SHOWN) in shown]
        if exercise.kind == "design":  # one answer to all scenes, which are measured in this process
            return exercise.kind, [{}] * len(cases)
        return exercise.kind, [dict(case.given) for case in cases]

    def _answers(self, asks, prepare):
        """Ask for answers in sessions that are prepared alike, a new one after each end; return why the last one ended."""
        self._left = asks
        while self._left:
            before = len(self._left), len(self.left_out)
            try:
                with self._session() as session:
                    self._ask(session, self._load())
                    prepare(session)
                    while self._left:
                        self._answer(session, self._left[0])
            except SessionEnded as end:
                if before == (len(self._left), len(self.left_out)):
                    return end.reason  # not by an answer, nor by a cell, which another session could leave out
        return ""

    def _answer(self, session, ask):
        """Ask for some cases of an answer; where it ends the session that is what was found, and no more of it is asked."""
        known = self.found.get(ask.name, Found()).outcomes
        try:
            reply = self._ask(session, {"do": "evaluate", "name": ask.name, "kind": ask.kind, "givens": ask.givens})
            found = Found((*known, *outcomes_of(reply, len(ask.givens), self.limits.printed)), told=self._told)
        except Garbage:
            found = Found(known, ended="garbage")
        except SessionEnded as end:
            found = Found(known, ended=end.reason)
        self.found[ask.name] = found
        self._left = [one for one in self._left[1:] if not (found.ended and one.name == ask.name)]
        if found.ended:
            raise SessionEnded(found.ended)

    def _run_cells(self, session):
        """Run the notebook cell by cell, without those that ended a session before."""
        for number in range(len(self.submission.cells)):
            if number in self.left_out:
                continue
            try:
                reply = self._ask(session, {"do": "run", "cell": number})
                self.raised.setdefault(number, line_of(reply.get("problem")))
            except Garbage:
                self.left_out[number] = "garbage"
                raise SessionEnded("garbage") from None
            except SessionEnded as end:
                self.left_out[number] = end.reason
                raise

    def _load(self):
        files = {name: base64.b64encode(content).decode() for name, content in self.assignment.files().items()}
        return {"do": "load", "cells": list(self.submission.cells), "files": files}

    @contextmanager
    def _session(self):
        with self.starter.session(self.limits) as session:
            try:
                yield session
            finally:
                self.spent += START + session.charged

    def _ask(self, session, request):
        left = self.limits.total - self.spent - session.charged
        if left <= 0 or time.monotonic() > self.until:
            raise _Spent if self.last else _Late
        try:
            return session.ask(request, min(self._step, left))
        except SessionEnded as end:
            if end.reason == "time" and not self.last:
                raise _Late from None
            raise


def _said(found):
    """The value of an answer, to be compared: NaN is NaN."""
    return repr(found and (found.ended, [(outcome.value, outcome.problem) for outcome in found.outcomes]))
