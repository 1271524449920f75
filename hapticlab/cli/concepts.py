"""What the command line does with the concept inventory: questions handed out, answers read, and a simulated class."""

import os
import sys
from contextlib import chdir
from pathlib import Path

from ..course.concepts.inventory import NOT_VALIDATED, OCCASIONS, questions
from ..course.concepts.questionnaire import notebook_name, notebook_of
from ..course.notebook import text_of, write_new
from ..course.personal import folder_name
from ..errors import CourseError
from ..grading.concepts.class_summary import summary
from ..grading.concepts.pages import CLASS, number, write_concept_pages
from ..grading.concepts.paper import read_papers
from ..grading.concepts.simulated_students import write_simulated_class
from ..grading.formats.words import clean
from ..grading.handed_in.roster import read_roster
from ..grading.kept_apart import check_places, is_inside
from ..grading.pages.pages import check_folder
from .assign import students_of
from .labs import words_of

#: students that share a reason and are named; the page names all
MOST_NAMED = 5


def concepts(parser, options):
    """Hand out questions, or read the answers of both occasions; 1 if answers could not be read."""
    if bool(options.before) != bool(options.after):
        parser.error("gains need both occasions: give --before PATH and --after PATH")
    if options.demo is not None and (options.before or options.roster):
        parser.error("--demo makes its own class; leave out --before, --after and --roster")
    if options.column and not options.roster:
        parser.error("--column is a column of a roster; give --roster FILE.csv")
    target = Path(options.target).absolute()
    if target.exists() and not target.is_dir():
        raise CourseError(f"{target} is a file; give a folder")
    if options.demo is not None:
        return _demo(target, options.demo, options.seed)
    names = students_of(read_roster(options.roster), options.column) if options.roster else []
    if not options.before:
        return _hand_out(target, names, options)
    before, after = ([Path(path).absolute() for path in paths] for paths in (options.before, options.after))
    return _read(before, after, target, names, options.seed)


def _hand_out(target, names, options):
    """Write the notebooks of both occasions: one for each student, or one that all share."""
    states = {}
    for occasion in OCCASIONS:
        for name in names or [""]:
            path = Path(occasion, folder_name(name) if name else "", notebook_name(occasion))
            states[str(path)] = write_new(target / path, text_of(notebook_of(options.seed, name, occasion)).encode())
    whose = f"one for each of {len(names)} students" if names else "the same for all students"
    print(f"written: {target}, {len(questions())} questions before and after the course, {whose}, seed {options.seed}")
    kept = sorted(path for path, state in states.items() if state == "kept")
    if kept:
        print(f"left as they are, for they differ and may hold answers:\n  {', '.join(kept)}")
    roster = ["--roster", options.roster, *(["--column", options.column] if options.column else [])] if names else []
    again = ["hapticlab", "concepts", "PAGES", "--before", "FIRST", "--after", "SECOND", "--seed", str(options.seed), *roster]
    print("\nnext:")
    print(f"  give students {target}{os.sep}before before the course and {target}{os.sep}after after it; answers carry no points")
    print(f"  collect what they hand in, in two folders, and read both:\n  {words_of(again)}")
    return 0


def _read(before, after, target, names, seed):
    """Read the answers and write the pages."""
    both = [(one, other) for one in before for other in after if is_inside(one, other) or is_inside(other, one)]
    if both:
        raise CourseError(f"{both[0][0]} and {both[0][1]} contain the same answers; give a folder for each occasion")
    check_places([*before, *after], written={"the folder for the pages": target}, imported=sys.path)
    check_folder(target, CLASS)
    with chdir(sys.base_prefix):  # away from what students handed in: libraries read settings from the working folder
        papers = {
            occasion: read_papers(paths, occasion=occasion, seed=seed, names=names)
            for occasion, paths in zip(OCCASIONS, (before, after), strict=True)
        }
        found = summary(papers["before"], papers["after"], seed=seed)
        written = write_concept_pages(found, papers["after"], target)
    print(f"page of the class: {written[0]}")
    print(f"tables: {written[1]}, {written[2]}; pages of {len(written) - 3} students: {target / 'students'}")
    whole = found.whole
    if whole:
        low, high = whole.interval
        gained = f"normalised gain {number(whole.gain)} (95 %: {number(low)} to {number(high)})"
        print(
            f"{len(found.matched)} students on both occasions: {whole.before:.0%} right before, {whole.after:.0%} after, {gained}"
        )
    for words in (NOT_VALIDATED, *["The students are simulated."] * found.simulated, *found.warnings):
        print(words)
    reasons = {}
    for occasion, paper in found.problems:
        reasons.setdefault((occasion, paper.problem), []).append(clean(paper.student, 80))
    for (occasion, problem), names in reasons.items():  # a wrong seed is one reason, not one for each student
        more = f" and {len(names) - MOST_NAMED} more" if len(names) > MOST_NAMED else ""
        print(f"hapticlab: left out: {', '.join(names[:MOST_NAMED])}{more}, {occasion}: {clean(problem, 400)}", file=sys.stderr)
    return 1 if found.problems else 0


def _demo(target, students, seed):
    """Write a simulated class, and read it as a class is read."""
    if target.exists() and any(target.iterdir()):
        raise CourseError(f"{target} is not empty; give a new folder for the simulated class")
    write_simulated_class(target, students=students, seed=seed)
    print(f"{students} simulated students answered: {target}{os.sep}before, {target}{os.sep}after")
    return _read([target / "before"], [target / "after"], target / "pages", [], seed)
