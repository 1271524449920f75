"""What the command line does with submissions: `hapticlab grade` grades them, and writes what other systems read."""

import re
import statistics
import sys
from pathlib import Path

from .errors import CourseError
from .grading import formats
from .grading.assignment import find_assignment
from .grading.formats.gradescope import GRADER_FAILED
from .grading.formats.words import clean
from .grading.gradebook import push
from .grading.limits import MIB, Limits
from .grading.pages import write_pages
from .grading.roster import read_roster
from .grading.run import run
from .grading.submission import find_submissions, lab_of, read

#: where the cells of a submission say which lab they are of
CHECKED = re.compile(r"""\bcheck\(\s*['"]([0-9]{2})\.""")
#: how often a submission may take the time of a step, beside once for each exercise
MORE_STEPS = 4


def grade(parser, options, preloaded=None):
    """Grade submissions; 1 where some could not be."""
    if options.fresh and not options.output:
        parser.error("--fresh forgets what is beside the results; it needs -o FILE")
    if formats.WRITERS[options.format][1] and not options.roster:
        parser.error(f"{options.format} knows students by its own ids; name a CSV file that it gave out: --roster FILE.csv")
    if options.gradebook and not Path(options.gradebook).is_file():
        parser.error(f"{options.gradebook}: no such file; name the gradebook.db of a course of nbgrader")
    roster = read_roster(options.roster) if options.roster else None
    lab = options.lab or lab_asked(options.submissions)
    assignment = find_assignment(lab, options.instructor, options.seed, options.personal)
    if options.instructor is None:
        _say("warning: without --instructor only the public cases count, whose answers can be learnt by heart")
    if roster:  # a roster that fits nobody is told before a class is graded
        roster.match([source.student for source in find_submissions(options.submissions, assignment.folder.name)])
    limits = limits_of(assignment.lab, options.timeout, options.memory * MIB, options.processes)
    output = Path(options.output) if options.output else None
    hidden = (options.roster, options.gradebook, options.pages, options.instructor, output)
    journal = output and output.with_name(f"{output.name}.journal.jsonl")
    try:
        done = run(
            options.submissions, assignment, limits, workers=options.workers, sandbox=options.sandbox, journal=journal,
            fresh=options.fresh, hidden=[path for path in hidden if path], progress=True, preloaded=preloaded, begun=_tell_walls,
        )  # fmt: skip
    except KeyboardInterrupt:
        again = f"what was graded is in {journal}; the same command again goes on" if journal else "with -o FILE a run can go on"
        _say(again)
        raise
    _write(options, assignment, done.reports, roster, output)
    _tell(done, roster)
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


def _write(options, assignment, reports, roster, output):
    """Write the results in all the ways asked for."""
    text = formats.write(options.format, reports, roster, options.assignment, assignment.folder.name)
    if output is None:
        sys.stdout.write(text)
    else:
        part = output.with_name(f"{output.name}.part")
        output.parent.mkdir(parents=True, exist_ok=True)
        part.write_text(text, "utf-8", newline="")
        part.replace(output)  # whole, or as it was
    if options.pages:
        write_pages(reports, options.pages, lab=assignment.lab)
    if options.gradebook:
        lost = push(reports, options.gradebook, options.assignment or None)
        for said in lost:
            _say(said)
        students = len({report.student for report in reports if not report.problem})
        whose = f"{students} student{'s' * (students != 1)}"
        _say(f"pushed marks of {whose} into {options.gradebook}{', but for what is said above' * bool(lost)}")


def _tell_walls(walls):
    """Say what stands around the students' code, before any of it runs."""
    if walls.weakness:
        _say(f"warning: {walls.weakness}")
    for level, reason in walls.refused.items():
        _say(f"no {level} here: {reason}")


def _tell(done, roster):
    """Say what it cost, who could not be graded, and who handed in nothing."""
    graded = f"{len(done.seconds)} graded, {done.known} known from before"
    if done.seconds:
        each = done.processor / len(done.seconds)
        graded += f"; sandbox: {done.walls.level}"
        graded += f"; {statistics.median(done.seconds):.2f} s each (median), {each:.2f} s of a processor (mean, start included)"
    _say(graded)
    for report in done.failed:
        again = "; the same command tries it again" if report.problem.startswith(GRADER_FAILED) else ""
        _say(f"not graded: {report.student}, {report.submission}: {report.problem}{again}")
    for words in done.foreign:
        _say(f"warning: {words}")
    if roster:
        matched = roster.match([report.student for report in done.reports])
        for words, names in (("not in the roster", matched.unknown), ("no submission of", matched.missing)):
            if names:
                _say(f"{words}: {', '.join(names)}")


def _say(words):
    print(f"hapticlab: {clean(words, 2000)}", file=sys.stderr)
