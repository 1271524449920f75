"""The command line: demo, labs, assign, grade, run FILE.py, tradeoff FILE.py, and of a paddle ports, doctor, flash, calibrate."""

import argparse
import json
import os
import sys
import tempfile
import traceback
from dataclasses import replace
from pathlib import Path

from . import __version__, assign_commands, grade_commands, lab_commands
from . import board_commands as board
from . import demo as demonstration
from .analysis.plots import plot
from .analysis.tradeoff import PC
from .analysis.tradeoff import tradeoff as measure_tradeoff
from .compiler.advance import Taylor
from .compiler.cost import BOARDS
from .compiler.exact import EXACT
from .compiler.methods import METHODS
from .device.calibrate import STEPS
from .errors import HapticlabError, SceneError
from .scenefile import describe, load_scene, report_of, run_scene

#: the last two are what a shell reports of a program that ended by Ctrl-C, or by writing to a closed pipe
FAILED, USAGE, INTERRUPTED, BROKEN_PIPE = 1, 2, 130, 141


def main(arguments=None):
    """Run the command line and return its exit code: 0, 1 for a run that failed, 2 for a wrong command.

    130 for one interrupted by Ctrl-C, 141 where the reader of its output went away.
    """
    parser = _parser()
    options = parser.parse_args(arguments)
    if options.command is None:
        parser.print_help()
        return USAGE
    try:
        code = options.command(options.parser, options)
        sys.stdout.flush()  # here, where a closed pipe can still be met
        return code
    except HapticlabError as problem:
        return _complain(problem)
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # for the flush when Python ends
        return BROKEN_PIPE
    except OSError as problem:
        return _complain(": ".join(str(a) for a in (problem.filename, problem.strerror or problem) if a))
    except KeyboardInterrupt:
        _complain("interrupted")
        return INTERRUPTED


def demo(parser, options):
    """Show where the chapter's wall chatters, and run a student's own scene."""
    folder = _folder(options)
    found = demonstration.study(quick=options.quick)
    facts = demonstration.report(found)
    files = demonstration.write(found, folder)
    return _tell(options, facts, files, demonstration.words(facts))


def run(parser, options):
    """Run a scene file, on its own paddle or on a board."""
    if options.port is None and (options.yes or options.every):
        parser.error(f"{'--yes' if options.yes else '--every'} is for a board; name its port with --port")
    file, path = _opened(parser, options), Path(options.file)
    folder = _folder(options)
    compiling = {"method": options.method} if options.method else {}
    if options.port is None:
        program, log = run_scene(file, **compiling)
        facts, loop = report_of(program, log), None
    else:
        try:
            program, log, loop = board.run_on_board(file, options, **compiling)
        except KeyboardInterrupt:
            _complain("interrupted; the motor is off. No samples are kept: a run is written at its end, after --duration")
            return INTERRUPTED
        facts = report_of(program, log) | {"loop": board.timing_facts(loop)}
    figure, names = folder / f"{path.stem}.png", [name for name in file.scene.watch if name in log.channels]
    plot(log, "x", *names, "F").savefig(figure)
    files = {"figure": figure, "telemetry": log.to_csv(folder / f"{path.stem}.csv")}
    _tell(options, facts, files, f"{log.paddle}\n{describe(facts)}" + (f"\nloop     {loop}" if loop else ""))
    return _complain(f"the run failed: {log.fault}") if log.fault else 0


def tradeoff(parser, options):
    """Measure speed against accuracy of a scene file, for its own paddle and the targets asked for."""
    file, path = _opened(parser, options), Path(options.file)
    folder = _folder(options)
    given = {"methods": options.methods, "T": options.periods, "targets": options.targets}
    given = {name: several for name, several in given.items() if several} | {"live": options.live, "every": options.every}
    found = measure_tradeoff(file.scene, file.paddle, tolerance=options.tolerance, **given)
    asked = {"load": options.load, "passive": not options.any_hand}
    figure = folder / f"{path.stem}-tradeoff.png"
    found.plot(**asked).savefig(figure)
    files = {"figure": figure, "table": found.table.to_csv(folder / f"{path.stem}-tradeoff.csv")}
    chosen = {target: found.choose(target=target, **asked).facts() for target in found.targets}
    facts = {"scene": found.name, "paddle": str(file.paddle), "rows": len(found.table), "chosen": chosen}
    return _tell(options, facts, files, found.summary(**asked))


def _opened(parser, options):
    """Return the scene file that was named, with what the command line sets."""
    path = Path(options.file)
    if path.is_dir():
        parser.error(f"{path} is a folder, needs a file; give a Python file that defines scene = hl.Scene(...)")
    if not path.is_file():
        parser.error(f"{path}: no such file; give a Python file that defines scene = hl.Scene(...)")
    try:
        file = load_scene(path)
    except Exception as problem:  # whatever the student's own code raises is theirs to read
        raise SceneError(_in_their_words(problem, path)) from None
    try:
        return _changed(file, options)
    except HapticlabError as problem:
        parser.error(str(problem))


def _folder(options):
    """Return the folder for the results, ready to be written to: asked for before anything is computed."""
    folder = Path(options.out)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return folder
    except OSError as problem:
        raise OSError(problem.errno, f"{problem.strerror}; choose another folder with --out", str(folder)) from None


def _tell(options, facts, files, text):
    if options.json:
        print(json.dumps({"hapticlab": __version__, **facts, "files": {k: str(p.resolve()) for k, p in files.items()}}, indent=1))
    else:
        print(text, "", *(f"{name.replace('_', ' ')}: {path.resolve()}" for name, path in files.items()), sep="\n")
    return 0


def _changed(file, options):
    """Return the scene file with what the command line sets."""
    paddle = file.paddle if options.T is None else replace(file.paddle, T=options.T)
    duration = file.duration if options.duration is None else options.duration
    paddle.ticks(duration)
    return replace(file, scene=file.scene(**dict(options.set or [])), paddle=paddle, duration=duration)


def _whole(text):
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{text!r} is no number of ticks; needs a whole number from 1 on")
    return int(text)


def _seed(text):
    if not text.isdecimal():
        raise argparse.ArgumentTypeError(f"{text!r} is no seed; needs a whole number from 0 on")
    return int(text)


def _part(text):
    try:
        part = float(text)
    except ValueError:
        part = 0.0
    if not part > 0:
        raise argparse.ArgumentTypeError(f"{text!r} is no part; needs a number > 0, such as 0.01")
    return part


def _setting(text):
    name, equals, value = text.partition("=")
    if not (name and equals and value):
        raise argparse.ArgumentTypeError(f"{text!r} sets nothing; write NAME=VALUE, such as k=300 or x_o='10 mm'")
    try:
        return name.strip(), float(value)
    except ValueError:
        return name.strip(), value


def _in_their_words(problem, path):
    """Return an error of a scene file: ours in one line, any other with the frames of that file and those beside it."""
    told = traceback.TracebackException.from_exception(problem)
    folder = path.resolve().parent
    frames = [frame for frame in told.stack if folder == Path(frame.filename).resolve().parent and frame.filename[0] != "<"]
    if isinstance(problem, HapticlabError):
        return f"{frames[-1].filename}, line {frames[-1].lineno}: {problem}" if frames else problem
    where = "".join(traceback.StackSummary.from_list(frames).format())
    return f"{path} failed\n{where}{''.join(told.format_exception_only())}".rstrip()


def _complain(problem):
    print(f"hapticlab: {problem}", file=sys.stderr)
    return FAILED


def _parser():
    parser = argparse.ArgumentParser(prog="hapticlab", description="From an equation of motion to a felt virtual wall.")
    parser.add_argument("--version", action="version", version=f"hapticlab {__version__}")
    parser.set_defaults(command=None, parser=parser)
    named = "{demo,labs,assign,grade,run,tradeoff,ports,doctor,flash,calibrate}"
    commands = parser.add_subparsers(title="commands", metavar=named)
    shared = argparse.ArgumentParser(add_help=False)
    shared.add_argument("--json", action="store_true", help="print the numbers, named with units, as JSON and nothing else")
    text = "show where the chapter's wall begins to chatter, and run a student's own equation of motion"
    shown = commands.add_parser("demo", parents=[shared], help=text, description=text)
    shown.add_argument("--quick", action="store_true", help="fewer stiffnesses, shorter runs")
    shown.set_defaults(command=demo, parser=shown)
    _add_labs(commands)
    assign_commands.add(commands, _seed)
    grade_commands.add(commands)
    text = "run a Python file that defines `scene`, and optionally `paddle` and `duration`"
    ran = commands.add_parser("run", parents=[shared], help=text, description=text)
    ran.add_argument("file", metavar="FILE.py")
    ran.add_argument("--port", metavar="URL", help="run on the board there; behind sim:// is the file's paddle")
    ran.add_argument("--yes", action="store_true", help="do not ask before the motor moves")
    ran.add_argument("--every", type=_whole, metavar="N", help="have the board send one sample in N ticks")
    ran.add_argument("--duration", type=float, metavar="SECONDS", help="how long to run [s]")
    ran.add_argument("--T", type=float, metavar="SECONDS", help="sampling period [s]")
    methods = [*sorted(METHODS), Taylor.name, EXACT]
    ran.add_argument("--method", choices=methods, help="integrator of the equations of motion (default: rk4)")
    ran.set_defaults(command=run, parser=ran)
    traded = _add_tradeoff(commands, shared)
    for one in (ran, traded):
        one.add_argument("--set", type=_setting, action="append", metavar="NAME=VALUE", help="bind a parameter, SI or with unit")
    for one, folder in ((shown, "hapticlab-demo"), (ran, "hapticlab-run"), (traded, "hapticlab-tradeoff")):
        one.add_argument("--out", metavar="DIR", default=folder, help="where figure and telemetry go (default: %(default)s)")
    _add_board_commands(commands, shared)
    return parser


def _add_labs(commands):
    """Add what a course opens."""
    text = "copy the labs into a folder, never over what was changed there, and open JupyterLab on them"
    made = commands.add_parser("labs", help=text, description=text)
    made.add_argument("folder", metavar="DIR", nargs="?", default="hapticlab-labs", help="(default: %(default)s)")
    made.add_argument("--no-open", action="store_true", help="only copy, and say how to open them")
    words = "copy these labs; by default all, or those that are in the folder already"
    made.add_argument("--lab", nargs="+", default=[], metavar="NN", help=words)
    words = "folder of answers: write solved notebooks into DIR-solved, and mark these and the labs as they came with hapticlab"
    made.add_argument("--instructor", metavar="PATH", help=words)
    made.add_argument("--seed", type=_seed, metavar="N", help="of an instructor's hidden cases (default: 0)")
    made.set_defaults(command=lab_commands.labs, parser=made)


def _add_tradeoff(commands, shared):
    """Add what measures speed against accuracy."""
    text = "measure speed against accuracy of a scene file, and choose what is good enough at the least load"
    made = commands.add_parser("tradeoff", parents=[shared], help=text, description=text)
    made.add_argument("file", metavar="FILE.py")
    made.add_argument("--tolerance", type=_part, default=1e-2, metavar="PART", help="of the greatest force (default: 0.01)")
    made.add_argument("--load", type=_part, default=0.5, metavar="PART", help="of the period at most (default: 0.5)")
    made.add_argument("--any-hand", action="store_true", help="do not ask for passivity in every hand")
    made.add_argument("--methods", nargs="+", metavar="NAME", help="integrators (default: all but forward Euler)")
    made.add_argument("--T", dest="periods", type=float, nargs="+", metavar="SECONDS", help="sampling periods [s]")
    targets = (PC, *(name for name, given in BOARDS.items() if given.hz))
    made.add_argument("--targets", nargs="+", choices=targets, help="this computer and boards (default: all)")
    made.add_argument("--live", nargs="+", default=(), metavar="NAME", help="parameters that stay settable (default: none)")
    made.add_argument("--every", type=_whole, default=10, metavar="N", help="one sample of telemetry in N ticks (default: 10)")
    made.set_defaults(command=tradeoff, parser=made, T=None, duration=None)
    return made


def _add_board_commands(commands, shared):
    """Add what needs a board; each has its words, and the port where it has one."""
    words = {
        "ports": "list the serial ports, and which of them connect() asks",
        "doctor": "walk from the cable to the motor and say what is wrong",
        "flash": "write the firmware into an Arduino Uno over its bootloader",
        "calibrate": "measure stops, motor sign and force constant, and store them on the board",
    }
    made = {}
    for name, text in words.items():
        parents = [shared] if name in ("ports", "doctor") else []
        made[name] = commands.add_parser(name, parents=parents, help=text, description=text)
        made[name].set_defaults(command=getattr(board, name), parser=made[name])
        if name != "ports":
            made[name].add_argument("--port", metavar="URL", help="by default the one known board that is plugged in")
    made["doctor"].add_argument("--no-person", action="store_true", help="skip what needs somebody at the handle")
    made["flash"].add_argument("--image", metavar="FILE.hex", help="by default the one that came with hapticlab")
    made["calibrate"].add_argument("--only", choices=STEPS, help="this step alone")
    made["calibrate"].add_argument("--yes", action="store_true", help="do not ask before the motor moves")
