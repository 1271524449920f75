"""What the command line hands out: labs as nbgrader, otter, Gradescope or PrairieLearn take them, and a student's own numbers."""

import os
import shutil
from pathlib import Path

from .. import __version__
from ..course.instructor import check_tree
from ..course.labs import find_labs
from ..course.marks import own_numbers
from ..course.notebook import write
from ..course.personal import personal_labs
from ..errors import CourseError
from ..grading.assignment import find_assignment
from ..grading.export.gradescope_zip import gradescope_files, write_zip
from ..grading.export.nbgrader_source import config, nbgrader_notebook
from ..grading.export.otter_source import otter_assign
from ..grading.export.prairielearn_question import dockerfile, prairielearn_files
from ..grading.handed_in.roster import read_roster
from .labs import words_of
from .options import SYSTEMS

#: columns of a roster by which submissions are usually named
NAMES = ("student", "student_id", "login", "sis_login_id", "username", "id_number", "email", "email_address")


def assign(parser, options):
    """Write labs as another system takes them, or each student's own; say what was written and what to do next."""
    _check(parser, options)
    check_tree(options.instructor)
    if not options.system:
        return _personal(options)
    write_for = {"nbgrader": _nbgrader, "otter": _otter, "gradescope": _gradescope, "prairielearn": _prairielearn}
    labs = _labs(options)
    return write_for[options.system](labs, Path(options.target), options)


def _check(parser, options):
    """Refuse options that do not go together."""
    if not (options.personal or options.system):
        parser.error(f"name what the labs are written for, --for {{{','.join(SYSTEMS)}}}, or --personal with a roster")
    if options.personal and options.system not in (None, "gradescope"):
        parser.error(f"{options.system} cannot tell whose numbers a notebook has; --personal is of gradescope, or of folders")
    if options.personal and not options.system and not options.roster:
        parser.error("--personal needs --roster FILE.csv, the class")
    if options.roster and (options.system or not options.personal):
        parser.error("--roster is of --personal, for folders")
    if options.column and not options.roster:
        parser.error("--column is of --roster")
    if options.seed is not None and options.system in ("nbgrader", "otter"):
        parser.error(f"--seed is of hidden cases, which {options.system} does not get; give it to hapticlab grade")
    if options.wheel and options.system not in ("gradescope", "prairielearn"):
        parser.error("--wheel is of --for gradescope and prairielearn")
    if options.wheel and not (options.wheel.endswith(".whl") and Path(options.wheel).is_file()):
        parser.error(f"{options.wheel}: no such wheel; make one in a checkout of hapticlab with: pip wheel --no-deps .")
    if options.system == "gradescope" and (len(options.lab) != 1 or not options.target.endswith(".zip")):
        parser.error("an autograder of Gradescope is of one lab; give FILE.zip and --lab NN, such as wall.zip --lab 02")


def _labs(options):
    """Return the labs that were asked for."""
    return [*dict.fromkeys(find_assignment(lab).folder for lab in options.lab)] or find_labs()


def _called(lab):
    """The name by which `hapticlab grade` finds a lab: the number of one that came with hapticlab, or the folder."""
    return lab.number if lab in find_labs() else str(lab.path)


def _answers(lab, options):
    answers = Path(options.instructor) / lab.name
    if not answers.is_dir():
        raise CourseError(f"{options.instructor} holds no {lab.name}; name other labs with --lab, or write answers to it")
    return answers


def _nbgrader(labs, target, options):
    made = {lab: nbgrader_notebook(lab, _answers(lab, options)) for lab in labs}
    folders = {lab: target / "source" / lab.name for lab in made}
    _refuse_if_there(folders.values())
    _config(target)
    for lab, notebook in made.items():
        shutil.copytree(lab.path, folders[lab], ignore=shutil.ignore_patterns("__pycache__", ".*", "*.ipynb", "checks.py.*"))
        write(folders[lab] / lab.notebook.name, notebook)
        print(f"written: {folders[lab]}")
    first, tree = labs[0].name, str(Path(options.instructor).resolve())
    graded = ["hapticlab", "grade", "submitted", "--lab", _called(labs[0]), "--instructor", tree, "--gradebook", "gradebook.db"]
    return _next(
        f"cd {words_of([str(target)])}",
        f"nbgrader generate_assignment {first} --create",
        f"put what students hand in into submitted/STUDENT/{first}/{first}.ipynb, then",
        f"nbgrader autograde {first} --create",
        f"nbgrader generate_feedback {first}",
        "nbgrader trusts what students write. For a mark that stands, put hapticlab's over it:",
        words_of(graded),
    )


def _config(target):
    """Write nbgrader_config.py to where there is none."""
    target.mkdir(parents=True, exist_ok=True)
    path, text = target / "nbgrader_config.py", config(target.resolve().name)
    try:
        with path.open("x", encoding="utf-8") as file:
            file.write(text)
        print(f"written: {path}")
    except FileExistsError:
        stub = 'c.ClearSolutions.code_stub = {"python": ""}'
        if stub not in path.read_text("utf-8", "replace"):
            print(f"left as it is: {path}; it needs this line, or released answer cells raise an error:\n  {stub}")


def _otter(labs, target, options):
    folders = {lab: target / lab.name for lab in labs}
    _refuse_if_there(folders.values())
    answers = {lab: _answers(lab, options) for lab in labs}
    for lab, folder in folders.items():
        made = otter_assign(lab, answers[lab], folder, _package())
        print(f"written: {folder / 'student'}, for students\nwritten: {made}, for Gradescope, or for otter here", flush=True)
    name = labs[0].notebook.name
    return _next(
        "give students the folder student. Mark what comes back, without Docker one at a time:",
        words_of(["otter", "run", f"SUBMISSIONS/ada/{name}", "-a", str(made), "-o", "results"]),
        "otter trusts what students write. A mark that stands:",
        words_of(["hapticlab", "grade", "SUBMISSIONS", "--lab", _called(labs[-1]), "--instructor", options.instructor]),
    )


def _gradescope(labs, target, options):
    lab, wheel = labs[0], Path(options.wheel) if options.wheel else None
    files = gradescope_files(lab, _answers(lab, options), _package(), options.seed or 0, wheel, options.personal)
    if target.exists():
        raise CourseError(f"{target} is there already; name another file, or delete it first")
    target.parent.mkdir(parents=True, exist_ok=True)
    write_zip(target, files)
    print(f"written: {target}, {len(files)} files, with the answers: for Gradescope alone")
    return _next(
        "in Gradescope: new assignment, Programming Assignment, "
        f"{lab.lab().points:g} points; under Configure Autograder upload {target.name}",
        f"students hand in {lab.notebook.name}; which hidden cases they get goes by their e-mail and seed {options.seed or 0}",
    )


def _prairielearn(labs, target, options):
    image, wheel = options.image or f"hapticlab-grader:{__version__}", Path(options.wheel) if options.wheel else None
    made = {lab: prairielearn_files(lab, _answers(lab, options), image, options.seed or 0) for lab in labs}
    folders = {lab: target / lab.name for lab in labs}
    docker = target / "grader-image"
    _refuse_if_there([*folders.values(), docker])
    for lab, files in made.items():
        for name, content in files.items():
            path = folders[lab] / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content)
            path.chmod(0o755 if path.suffix == ".sh" else 0o644)
        print(f"written: {folders[lab]}, a question")
    docker.mkdir()
    (docker / "Dockerfile").write_text(dockerfile(image, _package(), wheel), "utf-8")
    if wheel:
        shutil.copy(wheel, docker)
    print(f"written: {docker}, the image in which these are graded")
    return _next(
        f"cd {words_of([str(docker)])} && docker build -t {image} . && docker push {image}",
        f"copy {', '.join(folder.name for folder in folders.values())} into the folder questions of your course, and sync it",
        "the folders tests hold answers: PrairieLearn shows them to no student; keep the repository private",
    )


def _personal(options):
    """Write each student's folder of labs."""
    roster, target, seed = read_roster(options.roster), Path(options.target), options.seed or 0
    labs = _labs(options)
    only = [lab.number for lab in labs] if options.lab else []
    column, students = _column(roster, options.column), students_of(roster, options.column)
    states = personal_labs(students, target, options.instructor, seed, only, labs)
    kept = sorted(path for path, state in states.items() if state == "kept")
    print(f"written: {target}, labs of {len(students)} students by {roster.columns[column]!r}, numbers of seed {seed}")
    handed_out = [lab for lab in labs if students and (target / students[0] / lab.name).is_dir()]
    alike = [lab.number for lab in handed_out if not own_numbers(lab.lab(), Path(options.instructor) / lab.name, seed, "")]
    if alike:
        print(f"the same for every student, because hidden.py defines no numbers(random): {', '.join(alike)}")
    if kept:
        print(f"left as they are, for they differ and may hold work:\n  {', '.join(kept)}")
    graded = ["--lab", _called(labs[0]) if only else "NN", "--instructor", options.instructor, "--personal", "--seed", str(seed)]
    return _next(
        f"give each student the folder {target}{os.sep}{students[0] if students else 'STUDENT'}, or the one named so",
        "what they hand in, named by the same names, is graded by the same seed:",
        words_of(["hapticlab", "grade", "SUBMISSIONS", *graded]),
    )


def students_of(roster, asked):
    """Return the names of a class, from the column that is asked for, or else from the one that names students."""
    column = _column(roster, asked)
    students = [row[column].strip() for row in roster.rows]
    if not all(students):
        raise CourseError(f"{roster.path}: row {students.index('') + 2} has no {roster.columns[column]}; name another --column")
    return students


def _column(roster, asked):
    """Return the column that names students."""
    if asked:
        named = {name: column for column, name in roster.columns.items()}
        if asked not in named:
            raise CourseError(f"{roster.path} has no column {asked!r}; it has {roster.told()}")
        return named[asked]
    known = [column for column in NAMES if column in roster.columns]
    if not known:
        raise CourseError(f"{roster.path}: which of {roster.told()} names a student's folder and submission? Say it by --column")
    return known[0]


def _package():
    return f"hapticlab=={__version__}"


def _refuse_if_there(folders):
    """Raise where a folder is there already: it may hold an instructor's own changes."""
    there = [str(folder) for folder in folders if folder.exists()]
    if there:
        raise CourseError(f"{there[0]} is there already, maybe with your changes; name another folder, or delete it first")


def _next(*lines):
    """Print what to do next."""
    print("\nnext:", *(f"  {line}" for line in lines), sep="\n")
    return 0
