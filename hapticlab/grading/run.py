"""A class is graded: many submissions at once, each report kept as soon as it is known."""

from __future__ import annotations

import itertools
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from ..base.in_notebook import require_processes
from ..course.personal import foreign_numbers
from ..device.progress import progress_bar
from ..errors import CourseError
from .bench import Task
from .cluster import ClusterWorkers
from .grade import refused
from .handed_in.submission import find_submissions, read
from .journal import Journal, key_of
from .sessions.limits import Limits
from .sessions.starter import Walls
from .workers import Workers, processor_seconds

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from ..base.annotations import File
    from .assignment import Assignment
    from .report import Report
    from .sessions.preloaded import Preloaded


@dataclass(frozen=True)
class Graded:
    """What grading a class gave.

    Attributes
    ----------
    reports : tuple of Report
        By student.
    walls : Walls
        What stood around the students' code.
    seconds : tuple of float
        Wall clock of each submission that was graded in this run [s]; those of the journal are not among them.
    known : int
        How many reports the journal had already.
    processor : float
        Processor time of this process during the run and of all that it began, their start included [s].
    foreign : tuple of str
        Whose submission has other numbers than it is graded by, in a sentence each.
    failed : tuple of Report
        Those that could not be graded.
    """

    reports: tuple[Report, ...]
    walls: Walls
    seconds: tuple[float, ...]
    known: int
    processor: float
    foreign: tuple[str, ...] = ()

    @property
    def failed(self) -> tuple[Report, ...]:
        """Reports with a problem."""
        return tuple(report for report in self.reports if report.problem)


def run(
    paths: Sequence[File],
    assignment: Assignment,
    limits: Limits | None = None,
    *,
    workers: int | str = 1,
    sandbox: str = "auto",
    journal: File | None = None,
    fresh: bool = False,
    hidden: Sequence[File] = (),
    progress: bool = False,
    preloaded: Preloaded | None = None,
    begun: Callable[[Walls], None] | None = None,
) -> Graded:
    """Grade submissions.

    Parameters
    ----------
    paths : sequence of str or Path
        Notebooks, scripts, archives, folders of these, or nbgrader's tree.
    assignment : Assignment
    limits : Limits, optional
    workers : int or str
        So many processes, or the address of a Dask scheduler, "tcp://...". The reports do not depend on it.
    sandbox : {"auto", "namespaces", "user", "landlock", "none"}
    journal : str or Path, optional
        Where reports are written as they are made; those that are there already are taken.
    fresh : bool
        Forget what the journal holds.
    hidden : sequence of str or Path
        Which a student's code must not see, beside submissions, answers and journal.
    progress : bool
        Show a bar on stderr.
    preloaded : Preloaded, optional
        Which began to load while submissions and answers were looked for.
    begun : callable, optional
        Called with the Walls before any student's code runs.

    Returns
    -------
    Graded
    """
    require_processes("Grading", CourseError)
    limits, before = limits or Limits(), processor_seconds()
    sources = find_submissions(paths, assignment.folder.name)
    secrets = tuple(str(Path(path).resolve()) for path in (*paths, *hidden, *([journal] if journal else [])))
    crew: Workers | ClusterWorkers
    if isinstance(workers, str):
        crew = ClusterWorkers(workers, assignment, limits, sandbox, secrets)
    else:
        crew = Workers(min(workers, len(sources)), assignment, limits, sandbox, secrets, preloaded=preloaded)
    with Journal(journal, fresh) as kept, progress_bar(len(sources), progress, unit="submission") as bar:
        work = _Run(assignment, limits, sandbox, kept, bar)
        work.all(sources, crew, begun)
    reports = sorted(work.reports, key=lambda report: (report.student, report.submission, report.sha256))
    seconds, foreign = tuple(work.seconds), tuple(work.foreign)
    processor = processor_seconds() - before + crew.seconds
    return Graded(tuple(reports), crew.walls, seconds, work.known, processor, foreign)


class _Run:
    def __init__(self, assignment, limits, sandbox, journal, bar):
        self.assignment, self.limits, self.sandbox, self.journal, self.bar = assignment, limits, sandbox, journal, bar
        self.reports, self.seconds, self.known, self.foreign = [], [], 0, []

    def all(self, sources, crew, begun=None):
        """Grade all; at the end, side by side, those that a limit of time or the end of a worker left open."""
        tasks, left = self._tasks(sources), []
        first = next(tasks, None)
        if first is None:
            return  # all is known: no worker needs to begin
        with crew:
            if begun:
                begun(crew.walls)
            for task, reply in crew.graded(itertools.chain([first], tasks), last=crew.number == 1):
                if reply.report or reply.problem:
                    self._take(task, reply)
                else:
                    left.append(task)
            left.sort(key=lambda task: task.key)
            for task, reply in crew.graded(left, last=True):
                self._take(task, reply)

    def _tasks(self, sources):
        """Yield what can be graded and the journal does not know, read when a worker is free for it."""
        for source in sources:
            submission = read(source, self.assignment.untouched)
            self._look_at_numbers(submission)
            key = key_of(submission, self.assignment, self.limits, self.sandbox)
            if submission.problem:
                self._know(refused(submission, self.assignment, submission.problem, self.limits))
            elif key in self.journal.reports:
                self._know(self.journal.reports[key])
                self.known += 1
            else:
                yield Task(submission, key)

    def _look_at_numbers(self, submission):
        own = self.assignment
        said = foreign_numbers(submission.cells, own.folder, own.answers, own.seed, submission.student, own.personal)
        if said:
            self.foreign.append(f"{submission.student}, {submission.name}: {said}")

    def _take(self, task, reply):
        self.seconds.append(reply.seconds)
        if reply.report:
            self.journal.write(task.key, reply.report)
            self._keep(reply.report)
        else:  # not into the journal: another run may have more luck
            problem = reply.problem or "the process that graded it ended twice; is there enough memory?"
            report = refused(task.submission, self.assignment, problem, self.limits)
            self._keep(replace(report, grader_failed=bool(reply.problem)))

    def _know(self, report):
        """Keep a report that takes no time, which would make the time left of the bar too short."""
        self.reports.append(report)
        self.bar.total -= 1

    def _keep(self, report):
        self.reports.append(report)
        self.bar.update(1)
