"""The commands of the command line and their options.

Nothing here opens SymPy or NumPy, so that `hapticlab -h` answers at once: each command is named as "module.function", which
`cli.main` imports when the command runs.
"""

import argparse
import os
import sys

from .. import __version__
from ..compiler.boards.board_records import BOARDS
from ..grading.formats import FORMATS
from ..grading.sessions.limits import MIB, Limits
from .begin import Command, Parser, lab_number

#: `hapticlab tradeoff --targets`, `hapticlab calibrate --only` and `--practice`, `hapticlab grade --sandbox`: names that modules
#: define which take long to import; a test compares them
TARGETS = ("pc", *(name for name, given in BOARDS.items() if given.hz))
STEPS = ("wiring", "stops", "sensor", "sign", "force")
TROUBLES = ("motor wires", "wrong wiring", "loose wire", "sensor direction", "dead band")
#: name -> page of docs/paddle, which comes with the package
PAGES = {"owner": "owners_guide.md", "safety": "SAFETY.md", "faults": "faults.md", "card": "bring_up_card.md"}
#: `hapticlab wheels --for`: systems, then their less common machines
ROOM_SYSTEMS = ("windows", "macos", "linux", "windows-aarch64", "macos-x86_64", "linux-aarch64")
SYSTEMS = ("nbgrader", "otter", "gradescope", "prairielearn")
LEVELS = ("auto", "namespaces", "user", "landlock", "none")
#: of `hapticlab grade --memory` [MiB]: 16 TiB; systems take no more for a limit, and end each process where they are given more
MOST_MEMORY = 1 << 24


def parser():
    """Return the parser of all commands; its options have ``command``, as "module.function", and that command's ``parser``."""
    made = Parser(prog="hapticlab")
    made.add_argument("--version", action="version", version=f"hapticlab {__version__}")
    made.set_defaults(command=None, parser=made)
    commands = made.add_subparsers(title="commands", metavar="COMMAND", parser_class=Command)
    shared = argparse.ArgumentParser(add_help=False)
    shared.add_argument("--json", action="store_true", help="print the numbers, named with units, as JSON and nothing else")
    _add_demo(commands, shared)
    _add_labs(commands)
    _add_assign(commands)
    _add_grade(commands)
    _add_concepts(commands)
    for one in (_add_run(commands, shared), _add_tradeoff(commands, shared), _add_share(commands, shared)):
        one.add_argument("--set", type=_setting, action="append", metavar="NAME=VALUE", help="bind a parameter, SI or with unit")
        words = "use the paddle of a profile, by name or file, such as bench7.json, in the hand of the scene file's paddle"
        one.add_argument("--paddle", metavar="PROFILE", help=words)
    _add_board_commands(commands, shared)
    _add_site(commands)
    _add_wheels(commands)
    _add_guide(commands)
    made.commands = commands.choices
    return made


def _add_command(commands, function, text, parents=(), aliases=()):
    """Return the parser of one command, which `cli.main` runs by calling ``function``, "module.name"."""
    made = commands.add_parser(function.rpartition(".")[2], parents=parents, help=text, description=text, aliases=aliases)
    made.set_defaults(command=function, parser=made)
    return made


def _add_out(made, folder):
    made.add_argument("--out", metavar="DIR", default=folder, help="where figure and telemetry go (default: %(default)s)")


def _add_demo(commands, shared):
    text = "simulate virtual walls of growing stiffness until they chatter, and run an equation of motion, with figures"
    made = _add_command(commands, "cli.scenes.demo", text, [shared])
    made.add_argument("--quick", action="store_true", help="fewer stiffnesses, shorter runs")
    _add_out(made, "hapticlab-demo")


def _add_run(commands, shared):
    text = "run a Python file that defines `scene`, and optionally `paddle` and `duration`"
    made = _add_command(commands, "cli.scenes.run", text, [shared])
    made.add_argument("file", metavar="FILE.py")
    words = "run on the board at this port; sim://hapkit simulates the paddle that FILE.py defines, sim://FILE.json that profile"
    made.add_argument("--port", metavar="URL", help=words)
    made.add_argument("--yes", action="store_true", help="do not ask before the motor moves")
    made.add_argument("--every", type=_ticks, metavar="N", help="have the board send one sample in N ticks")
    made.add_argument("--duration", type=float, metavar="SECONDS", help="how long to run [s]")
    made.add_argument("--T", type=float, metavar="SECONDS", help="sampling period [s]")
    words = "integrator of the equations of motion; a name that is none lists them (default: rk4)"
    made.add_argument("--method", metavar="NAME", help=words)
    _add_out(made, "hapticlab-run")
    return made


def _add_tradeoff(commands, shared):
    text = "measure speed against accuracy of a scene file, and choose what is good enough at the least load"
    made = _add_command(commands, "cli.scenes.tradeoff", text, [shared])
    made.add_argument("file", metavar="FILE.py")
    words = "largest error, as a fraction of the greatest force (default: 0.01)"
    made.add_argument("--tolerance", type=_part, default=1e-2, metavar="PART", help=words)
    words = "largest load, as a fraction of the period (default: 0.5)"
    made.add_argument("--load", type=_part, default=0.5, metavar="PART", help=words)
    made.add_argument("--any-hand", action="store_true", help="do not ask for passivity in every hand")
    made.add_argument("--methods", nargs="+", metavar="NAME", help="integrators (default: all but forward Euler)")
    made.add_argument("--T", dest="periods", type=float, nargs="+", metavar="SECONDS", help="sampling periods [s]")
    made.add_argument("--targets", nargs="+", choices=TARGETS, help="this computer and boards (default: all)")
    made.add_argument("--live", nargs="+", default=(), metavar="NAME", help="parameters that stay settable (default: none)")
    made.add_argument("--every", type=_ticks, default=10, metavar="N", help="one sample of telemetry in N ticks (default: 10)")
    made.set_defaults(T=None, duration=None)
    _add_out(made, "hapticlab-tradeoff")
    return made


def _add_share(commands, shared):
    text = "write a scene file as one HTML file that runs in any browser, without Python and without a network"
    made = _add_command(commands, "cli.share.share", text, [shared])
    made.add_argument("file", metavar="FILE.py")
    made.add_argument("-o", "--out", metavar="FILE.html", help="the file to write (default: FILE.html in this folder)")
    made.add_argument("--T", type=float, metavar="SECONDS", help="sampling period [s]")
    made.add_argument("--method", metavar="NAME", help="integrator of the equations of motion (default: rk4)")
    made.add_argument("--let-go", action="store_true", help="a drag that ends lets go of the handle, so that it can be thrown")
    words = "let readers of the page copy the text of FILE.py, or not (default: ask; yes where nobody can be asked)"
    made.add_argument("--code", action=argparse.BooleanOptionalAction, help=words)
    made.set_defaults(duration=None)
    return made


def _add_labs(commands):
    text = "copy labs into a folder without overwriting files that you have changed, and open them in JupyterLab"
    made = _add_command(commands, "cli.labs.labs", text, aliases=["lab"])
    words = "numbers of labs, and the folder to copy them into (default: all labs, hapticlab-labs)"
    made.add_argument("wanted", metavar="NN or DIR", nargs="*", help=words)
    made.add_argument("--no-open", action="store_true", help="only copy, and say how to open them")
    words = "copy these labs; by default all, or those that are in the folder already"
    made.add_argument("--lab", type=lab_number, nargs="+", default=[], metavar="NN", help=words)
    words = "folder of answers: write solved notebooks into DIR-solved, and mark these and the labs as they came with hapticlab"
    made.add_argument("--instructor", metavar="PATH", help=words)
    made.add_argument("--seed", type=_seed, metavar="N", help="seed of an instructor's hidden cases (default: 0)")


def _add_assign(commands):
    text = "hand out labs: as nbgrader, otter, Gradescope or PrairieLearn take them, or with each student's own numbers"
    made = _add_command(commands, "cli.assign.assign", text)
    made.add_argument("target", metavar="DIR", help="folder to write into; of gradescope a FILE.zip")
    made.add_argument("--for", dest="system", choices=SYSTEMS, help="what grades or collects")
    made.add_argument("--personal", action="store_true", help="numbers of their own for the students of --roster")
    words = "these labs, by number, or own ones by folder (default: all that came with hapticlab)"
    made.add_argument("--lab", type=lab_number, nargs="+", default=[], metavar="NN", help=words)
    made.add_argument("--instructor", required=True, metavar="PATH", help="folder of answers, which holds NN_name/solution.py")
    made.add_argument("--seed", type=_seed, metavar="N", help="seed of hidden cases and of students' own numbers (default: 0)")
    made.add_argument("--roster", metavar="FILE.csv", help="the class, for --personal")
    made.add_argument("--column", metavar="NAME", help="column of the roster by which submissions will be named")
    made.add_argument("--wheel", metavar="FILE.whl", help="hapticlab as a file, where it is not to come from an index")
    made.add_argument("--image", metavar="NAME", help="image of PrairieLearn's grader (default: hapticlab-grader:VERSION)")


def _add_grade(commands):
    text = "grade submissions: run each in processes without the right answers, and judge what they return"
    made = _add_command(commands, "cli.grade_start.grade", text)
    words = "notebooks, scripts, archives, folders of these, or nbgrader's submitted tree"
    made.add_argument("submissions", metavar="SUBMISSION", nargs="+", help=words)
    words = "lab number, or folder of a lab of your own (default: detected from the submissions)"
    made.add_argument("--lab", type=lab_number, metavar="NN", help=words)
    made.add_argument("--instructor", metavar="PATH", help="folder of answers, for hidden cases; else public ones alone count")
    made.add_argument("--seed", type=_seed, default=0, metavar="N", help="seed of the hidden cases (default: 0)")
    made.add_argument("--personal", action="store_true", help="each student was handed numbers of their own, by this seed")
    made.add_argument("--format", choices=FORMATS, default="text", help="format of the results (default: text)")
    words = "write the results to this file; run the same command again to resume"
    made.add_argument("-o", "--output", metavar="FILE", help=words)
    made.add_argument("--pages", metavar="DIR", help="write an HTML page for each student and one of the class")
    made.add_argument("--roster", metavar="FILE.csv", help="who is in the class, by the names that another system has for them")
    made.add_argument("--assignment", default="", metavar="NAME", help="name of the column in Canvas, Moodle and nbgrader")
    made.add_argument("--gradebook", metavar="FILE.db", help="push the points into this gradebook of nbgrader")
    words = "number of processes, or the address of a Dask scheduler (default: one for each processor)"
    made.add_argument("--workers", type=_workers, default=os.cpu_count() or 1, metavar="N|tcp://...", help=words)
    words = f"time for a cell, and for an exercise (default: {Limits().seconds:g})"
    made.add_argument("--timeout", type=_amount, default=Limits().seconds, metavar="SECONDS", help=words)
    words = f"memory for a submission's processes together (default: {Limits().memory // MIB})"
    made.add_argument("--memory", type=_memory, default=Limits().memory // MIB, metavar="MIB", help=words)
    words = "processes that a submission may have at one time; from 2 on its code may also start programs (default: 1)"
    made.add_argument("--processes", type=_whole(1, "a number of processes"), default=1, metavar="N", help=words)
    made.add_argument("--sandbox", choices=LEVELS, default="auto", help="walls around students' code (default: the best)")
    made.add_argument("--fresh", action="store_true", help="grade all submissions again, also those already graded")


def _add_concepts(commands):
    text = "ask concept questions before and after a course, and write pages of what a class learned; answers are read, never run"
    made = _add_command(commands, "cli.concepts.concepts", text)
    made.add_argument(
        "target", metavar="DIR", help="folder for the notebooks to hand out, or, with --before and --after, for the pages"
    )
    words = "what students handed in before the course: folders, zip files or notebooks"
    made.add_argument("--before", metavar="PATH", nargs="+", default=[], help=words)
    made.add_argument("--after", metavar="PATH", nargs="+", default=[], help="what they handed in after the course")
    words = "seed of the numbers and the order of options (default: 0)"
    made.add_argument("--seed", type=_seed, default=0, metavar="N", help=words)
    made.add_argument("--roster", metavar="FILE.csv", help="the class, each of whom gets questions of their own")
    made.add_argument("--column", metavar="NAME", help="column of the roster by which notebooks will be named")
    words = "write a class of N simulated students and its pages, to look at (default: 40)"
    made.add_argument("--demo", type=_whole(2, "a number of students"), nargs="?", const=40, metavar="N", help=words)


def _add_board_commands(commands, shared):
    """Add what needs a board; each has its words, and the port where it has one."""
    words = {
        "ports": "list the serial ports, and which of them connect() asks",
        "doctor": "walk from the cable to the motor and say what is wrong",
        "flash": "write the firmware into a board, such as an Arduino Uno or a Raspberry Pi Pico",
        "calibrate": "confirm the wiring, measure stops, sensor, motor sign and force, and store them on the board",
        "bench": "try a paddle step by step, motor off first, and write one report of what was predicted and found",
    }
    made = {}
    for name, text in words.items():
        made[name] = _add_command(commands, f"cli.board.{name}", text, [shared] if name in ("ports", "doctor") else [])
        if name != "ports":
            made[name].add_argument("--port", metavar="URL", help="port of the board (default: the one that is plugged in)")
    made["doctor"].add_argument("--no-person", action="store_true", help="skip the checks that need a person at the handle")
    words = "also write what was found into this file, as JSON without names, to send with a question"
    made["doctor"].add_argument("--report", metavar="FILE", help=words)
    words = "try what works on this computer, without a board, in two minutes, and write one file to send"
    command = {"dest": "command", "action": "store_const", "const": "self_test.report.self_test"}
    made["doctor"].add_argument("--self-test", **command, help=words)
    words = "where the self-test writes what it found (default: %(default)s)"
    made["doctor"].add_argument("--out", metavar="FILE", default="hapticlab-self-test.json", help=words)
    words = "kind of board, uno or pico (default: as USB says, and uno where it does not)"
    made["flash"].add_argument("--board", metavar="NAME", help=words)
    made["flash"].add_argument("--image", metavar="FILE", help="firmware to write (default: the image that came with hapticlab)")
    made["flash"].add_argument("--yes", action="store_true", help="do not ask which paddle is built")
    words = "rehearse it on a simulated board with one thing wrong: " + ", ".join(TROUBLES)
    practice = {"nargs": "?", "const": TROUBLES[0], "choices": TROUBLES, "metavar": "TROUBLE"}
    made["calibrate"].add_argument("--practice", **practice, help=words)
    made["calibrate"].add_argument("--only", choices=STEPS, help="this step alone")
    for name in ("calibrate", "bench"):
        made[name].add_argument("--yes", action="store_true", help="do not ask before the motor moves")
    words = "write FILE.md, to read, and FILE.json, as data; a report that is there stays (default: %(default)s)"
    made["bench"].add_argument("--out", metavar="FILE", default="hapticlab-bench", help=words)
    words = "try nothing, but store the settings that this report has, if you agree"
    made["bench"].add_argument("--restore", metavar="FILE.json", help=words)


def _add_site(commands):
    text = "build a web site of the labs, in which Python runs in the browser, so that students install nothing"
    made = _add_command(commands, "cli.site.site", text)
    made.add_argument("folder", metavar="FOLDER", help="new or empty folder, or the site of an earlier build, which is replaced")
    words = "folder or .tar.bz2 of a distribution of Pyodide, so that no request leaves the site (default: its own address)"
    made.add_argument("--pyodide", metavar="ARCHIVE", help=words)
    made.add_argument("--wheel", metavar="FILE.whl", help="hapticlab for the site (default: made of this one)")


def _add_wheels(commands):
    text = "collect the wheels of hapticlab and of all that it needs in a folder, for a lab room without a network"
    made = _add_command(commands, "cli.wheels.wheels", text)
    made.add_argument(
        "folder", metavar="FOLDER", help="new or empty folder, or one of an earlier call, whose wheels are replaced"
    )
    words = f"systems of the room: {', '.join(ROOM_SYSTEMS)} (default: {' '.join(ROOM_SYSTEMS[:3])})"
    choices = {"choices": ROOM_SYSTEMS, "default": ROOM_SYSTEMS[:3], "metavar": "SYSTEM"}
    made.add_argument("--for", dest="systems", nargs="+", help=words, **choices)
    words = "its versions of Python, such as 3.12 (default: this one)"
    here = (f"3.{sys.version_info.minor}",)
    made.add_argument("--python", dest="pythons", type=_python, nargs="+", default=here, metavar="VERSION", help=words)
    words = "extras of hapticlab; --extra alone takes none (default: notebook, which the labs need)"
    made.add_argument("--extra", dest="extras", nargs="*", default=("notebook",), metavar="NAME", help=words)
    made.add_argument("--wheel", metavar="FILE.whl", help="hapticlab for the room (default: made of this one)")


def _add_guide(commands):
    text = "say where a page for owners of a paddle is: owner, safety, faults, or the card of the first power-up"
    made = _add_command(commands, "cli.guide.guide", text)
    made.add_argument(
        "page", nargs="?", choices=PAGES, default="owner", metavar="PAGE", help=f"the page: {', '.join(PAGES)} (default: owner)"
    )
    made.add_argument("--open", action="store_true", help="also open it")
    made.set_defaults(pages=PAGES)


def _whole(least, what):
    """A reader of a whole number; ``what`` names the number in an error."""

    def whole(text):
        if not text.isdecimal() or int(text) < least:
            raise argparse.ArgumentTypeError(f"{text!r} is not {what}; give a whole number, {least} or greater")
        return int(text)

    return whole


_seed, _ticks = _whole(0, "a seed"), _whole(1, "a number of ticks")


def _workers(text):
    return text if "://" in text else _whole(1, "a number of processes")(text)


def _memory(text):
    if not text.isdecimal() or not 64 <= int(text) <= MOST_MEMORY:
        words = f"give a whole number, 64 or greater, and {MOST_MEMORY} at most"
        raise argparse.ArgumentTypeError(f"{text!r} is not a number of MiB; {words}")
    return int(text)


def _python(text):
    major, _, minor = text.partition(".")
    if major != "3" or not minor.isdecimal():
        raise argparse.ArgumentTypeError(f"{text!r} is not a version of Python; give two numbers, such as 3.12")
    return text


def _amount(text):
    try:
        amount = float(text)
    except ValueError:
        amount = 0.0
    if not 0 < amount < 1e6:
        raise argparse.ArgumentTypeError(f"{text!r} is not a duration; give a number of seconds greater than 0 and below 1e6")
    return amount


def _part(text):
    try:
        part = float(text)
    except ValueError:
        part = 0.0
    if not part > 0:
        raise argparse.ArgumentTypeError(f"{text!r} is not a fraction; give a number greater than 0, such as 0.01")
    return part


def _setting(text):
    name, equals, value = text.partition("=")
    if not (name and equals and value):
        raise argparse.ArgumentTypeError(f"{text!r} sets nothing; write NAME=VALUE, such as k=300 or x_o='10 mm'")
    try:
        return name.strip(), float(value)
    except ValueError:
        return name.strip(), value
