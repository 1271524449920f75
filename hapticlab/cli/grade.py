"""What the command line does with submissions: `hapticlab grade` grades them, and writes what other systems read."""

import re
import statistics
import sys
from contextlib import chdir
from pathlib import Path

from ..errors import CourseError
from ..grading import formats
from ..grading.assignment import find_assignment
from ..grading.export.gradebook import push
from ..grading.formats.words import clean
from ..grading.handed_in.roster import read_roster
from ..grading.handed_in.submission import find_submissions, lab_of, left_aside, read
from ..grading.kept_apart import check_places, check_written
from ..grading.pages.pages import check_folder, write_pages
from ..grading.run import run
from ..grading.sessions.limits import MIB, Limits

#: where the cells of a submission say which lab they are of
CHECKED = re.compile(r"""\bcheck\(\s*['"]([0-9]{2})\.""")
#: files beside the submissions that are named
MOST_BESIDE = 20
#: how often a submission may take the time of a step, beside once for each exercise
MORE_STEPS = 4


def grade(parser, options, preloaded=None):
    """Grade submissions; 1 where some could not be."""
    for name in ("instructor", "output", "pages", "roster", "gradebook"):
        path = getattr(options, name)
        setattr(options, name, Path(path).absolute() if path else None)
    options.submissions = [Path(path).absolute() for path in options.submissions]
    if options.lab and not options.lab.isdigit() and Path(options.lab).is_dir():
        options.lab = Path(options.lab).absolute()
    try:
        _check(parser, options)
    except CourseError as problem:
        parser.error(str(problem))
    with chdir(sys.base_prefix):  # away from what students handed in: libraries read settings from the working folder
        return _grade(options, preloaded)


def _check(parser, options):
    """Refuse what cannot be meant, before anything is read."""
    if options.fresh and not options.output:
        parser.error("--fresh forgets what is beside the results; it needs -o FILE")
    if formats.FORMATS[options.format].needs_roster and not options.roster:
        parser.error(f"{options.format} knows students by its own ids; name a CSV file that it gave out: --roster FILE.csv")
    if options.gradebook and not options.gradebook.is_file():
        parser.error(f"{options.gradebook}: no such file; name the gradebook.db of a course of nbgrader")
    if options.gradebook and not options.gradebook.read_bytes().startswith(b"SQLite format 3"):
        parser.error(f"{options.gradebook} is not a database; name the gradebook.db of a course of nbgrader")
    judging = {"--instructor": options.instructor, "--lab": options.lab if isinstance(options.lab, Path) else None}
    written = {"-o": options.output, "--pages": options.pages}
    check_places(options.submissions, judging=judging, written=written, imported=_import_path())
    check_written(options.output, options.pages, [path for path in (options.roster, options.gradebook) if path])
    if options.pages:
        check_folder(options.pages)


def _import_path():
    """Return where Python imports from, or did before `python -m hapticlab` took the working folder away."""
    started = getattr(sys.modules["__main__"], "__spec__", None)
    by_module = started is not None and started.name == "hapticlab.__main__" and not sys.flags.safe_path
    return [*sys.path, ""] if by_module else sys.path


def _grade(options, preloaded):
    roster = read_roster(options.roster) if options.roster else None
    lab = options.lab or lab_asked(options.submissions)
    assignment = find_assignment(lab, options.instructor, options.seed, options.personal)
    if options.instructor is None:
        _say("warning: without --instructor only the public cases count, whose answers can be learnt by heart")
    if roster:  # a roster that fits nobody is told before a class is graded
        roster.match([source.student for source in find_submissions(options.submissions, assignment.folder.name)])
    limits = limits_of(assignment.lab, options.timeout, options.memory * MIB, options.processes)
    output = options.output
    hidden = (options.roster, options.gradebook, options.pages, options.instructor, output)
    journal = output and output.with_name(f"{output.name}.journal.jsonl")
    began = bool(journal) and not options.fresh and journal.is_file() and journal.stat().st_size > 0
    try:
        done = run(
            options.submissions, assignment, limits, workers=options.workers, sandbox=options.sandbox, journal=journal,
            fresh=options.fresh, hidden=[path for path in hidden if path], progress=True, preloaded=preloaded, begun=_tell_walls,
        )  # fmt: skip
    except KeyboardInterrupt:
        again = f"what was graded is in {journal}; the same command again goes on" if journal else "with -o FILE a run can go on"
        _say(again)
        raise
    _write(options, assignment, done.reports, roster)
    if began and done.seconds and not done.known:
        _say(f"nothing in {journal} was used: lab, seed, answers, limits or version differ; all was graded again")
    _tell(done, roster, left_aside(options.submissions, assignment.folder.name))
    return 1 if done.failed else 0


def limits_of(lab, seconds, memory, processes=1):
    """Return the limits of a lab's submissions, with time in all for every exercise and for some cells that take all theirs.

    Parameters
    ----------
    lab : Lab
    seconds : float
        Of a step.
    memory : int
        Of all processes [bytes].
    processes : int

    Examples
    --------
    >>> lab = find_assignment("03").lab
    >>> sum(one.judged for one in lab.exercises), limits_of(lab, 10.0, 2**30).total, limits_of(lab, 20.0, 2**30).total
    (8, 120.0, 240.0)
    """
    steps = MORE_STEPS + sum(one.judged for one in lab.exercises)
    return Limits(seconds=seconds, total=max(Limits().total, steps * seconds), memory=memory, processes=processes)


def lab_asked(paths):
    """Return the number of the lab that submissions are of, as the names of their files tell, or else their checks.

    Parameters
    ----------
    paths : sequence of str or Path

    Returns
    -------
    str
    """
    sources = find_submissions(paths)
    try:
        return lab_of(sources)
    except CourseError:
        found = {number for source in sources for cell in read(source).cells for number in CHECKED.findall(cell)}
        if len(found) != 1:
            raise
        return found.pop()


def _write(options, assignment, reports, roster):
    """Write the results in all the ways asked for."""
    text = formats.write(options.format, reports, roster, options.assignment, assignment.folder.name)
    try:
        _write_text(text, options.output)
    except BrokenPipeError:
        raise
    except OSError as problem:
        place = options.output or "the results to the terminal"
        words = "What was graded is kept; make room and give the same command again" if options.output else "Name a file: -o FILE"
        raise CourseError(f"cannot write {place}: {problem.strerror}. {words}") from None
    if options.pages:
        of_class, *others = write_pages(reports, options.pages, lab=assignment.lab)
        students = f"; {len(others)} of students in {of_class.parent / 'students'}" if others else ""
        _say(f"page of the class: {of_class}{students}")
    if options.gradebook:
        lost = push(reports, options.gradebook, options.assignment or None)
        for said in lost:
            _say(said)
        students = len({report.student for report in reports if not report.problem})
        whose = f"{students} student{'s' * (students != 1)}"
        _say(f"pushed marks of {whose} into {options.gradebook}{', but for what is said above' * bool(lost)}")


def _write_text(text, output):
    """Write results to a file, whole or not at all, or to the terminal."""
    if output is None:
        sys.stdout.write(text)
        sys.stdout.flush()
        return
    part = output.with_name(f"{output.name}.part")
    try:
        part.write_text(text, "utf-8", newline="")
        part.replace(output)
    finally:
        part.unlink(missing_ok=True)


def _tell_walls(walls):
    """Say what stands around the students' code, before any of it runs."""
    if walls.weakness:
        _say(f"warning: {walls.weakness}")
    for level, reason in walls.refused.items():
        _say(f"no {level} here: {reason}")


def _tell(done, roster, beside=()):
    """Say who was graded, who could not be graded, and who handed in nothing."""
    graded = f"{len(done.seconds)} graded" + (f", {done.known} known from before" if done.known else "")
    if done.seconds:
        graded += f"; sandbox: {done.walls.level}; {statistics.median(done.seconds):.2f} s each (median)"
    _say(graded)
    for report in done.failed:
        again = "; the same command tries it again" if report.grader_failed else ""
        _say(f"not graded: {report.student}, {report.submission}: {report.problem}{again}")
    for words in done.foreign:
        _say(f"warning: {words}")
    if roster:
        matched = roster.match([report.student for report in done.reports])
        alike = f"in one row of {roster.path}, so without a mark in its tables; rename one"
        told = {"not in the roster": matched.unknown, alike: matched.alike, "no submission of": matched.missing}
        for words, names in told.items():
            if names:
                _say(f"{words}: {', '.join(names)}")
    if beside:
        more = f" and {len(beside) - MOST_BESIDE} more" if len(beside) > MOST_BESIDE else ""
        _say(f"left aside, as no submission: {', '.join(beside[:MOST_BESIDE])}{more}")
    number = len(done.reports)
    _say(f"{number} handed in: {number - len(done.failed)} graded, {len(done.failed)} not graded")


def _say(words):
    print(f"hapticlab: {clean(words, 2000)}", file=sys.stderr)
