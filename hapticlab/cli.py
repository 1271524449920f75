"""The command line: `hapticlab demo` and `hapticlab run FILE.py`."""

import argparse
import json
import sys
import traceback
from dataclasses import replace
from pathlib import Path

from . import __version__
from . import demo as demonstration
from .analysis.plots import plot
from .compiler.methods import METHODS
from .errors import HapticlabError
from .scenefile import describe, load_scene, report_of, run_scene

FAILED, USAGE, INTERRUPTED = 1, 2, 130


def main(arguments=None):
    """Run the command line and return its exit code: 0, 1 for a run that failed, 2 for a wrong command."""
    parser = _parser()
    options = parser.parse_args(arguments)
    if options.command is None:
        parser.print_help()
        return USAGE
    try:
        return options.command(parser, options)
    except HapticlabError as problem:
        return _complain(problem)
    except OSError as problem:
        return _complain(f"{problem.filename}: {problem.strerror}; choose another folder with --out")
    except KeyboardInterrupt:
        _complain("interrupted")
        return INTERRUPTED


def demo(parser, options):
    """Show where the chapter's wall chatters, and run a student's own scene."""
    found = demonstration.study(quick=options.quick)
    facts = demonstration.report(found)
    files = demonstration.write(found, options.out or "hapticlab-demo")
    return _tell(options, facts, files, demonstration.words(facts))


def run(parser, options):
    """Run a scene file."""
    path = Path(options.file)
    if not path.is_file():
        parser.error(f"{path}: no such file; give a Python file that defines scene = hl.Scene(...)")
    try:
        file = load_scene(path)
    except Exception as problem:  # whatever the student's own code raises is theirs to read
        return _complain(_in_their_words(problem, path))
    try:
        file = _changed(file, options)
    except HapticlabError as problem:
        parser.error(str(problem))
    program, log = run_scene(file, **({"method": options.method} if options.method else {}))
    facts = report_of(program, log)
    folder = Path(options.out or "hapticlab-run")
    folder.mkdir(parents=True, exist_ok=True)
    figure, names = folder / f"{path.stem}.png", [name for name in file.scene.watch if name in log.channels]
    plot(log, "x", *names, "F").savefig(figure)
    files = {"figure": figure, "telemetry": log.to_csv(folder / f"{path.stem}.csv")}
    _tell(options, facts, files, f"{log.paddle}\n{describe(facts)}")
    return _complain(f"the run failed: {log.fault}") if log.fault else 0


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


def _setting(text):
    name, equals, value = text.partition("=")
    if not (name and equals and value):
        raise argparse.ArgumentTypeError(f"{text!r} sets nothing; write NAME=VALUE, such as k=300 or x_o='10 mm'")
    try:
        return name.strip(), float(value)
    except ValueError:
        return name.strip(), value


def _in_their_words(problem, path):
    """Return an error of a scene file: ours in one line, any other with the frames of that file alone."""
    told = traceback.TracebackException.from_exception(problem)
    frames = [frame for frame in told.stack if frame.filename == str(path)]
    if isinstance(problem, HapticlabError):
        return f"{path}, line {frames[-1].lineno}: {problem}" if frames else problem
    where = "".join(traceback.StackSummary.from_list(frames).format())
    return f"{path} failed\n{where}{''.join(told.format_exception_only())}".rstrip()


def _complain(problem):
    print(f"hapticlab: {problem}", file=sys.stderr)
    return FAILED


def _parser():
    parser = argparse.ArgumentParser(prog="hapticlab", description="From an equation of motion to a felt virtual wall.")
    parser.add_argument("--version", action="version", version=f"hapticlab {__version__}")
    parser.set_defaults(command=None)
    commands = parser.add_subparsers(title="commands", metavar="{demo,run}")
    shared = argparse.ArgumentParser(add_help=False)
    shared.add_argument("--json", action="store_true", help="print the numbers as JSON and nothing else")
    shared.add_argument("--out", metavar="DIR", help="where figure and telemetry go (default: hapticlab-demo, hapticlab-run)")
    text = "show where the chapter's wall begins to chatter, and run a student's own equation of motion"
    shown = commands.add_parser("demo", parents=[shared], help=text, description=text)
    shown.add_argument("--quick", action="store_true", help="fewer stiffnesses, shorter runs")
    shown.set_defaults(command=demo)
    text = "run a Python file that defines `scene`, and optionally `paddle` and `duration`"
    ran = commands.add_parser("run", parents=[shared], help=text, description=text)
    ran.add_argument("file", metavar="FILE.py")
    ran.add_argument("--duration", type=float, metavar="SECONDS", help="simulated time [s]")
    ran.add_argument("--T", type=float, metavar="SECONDS", help="sampling period [s]")
    ran.add_argument("--method", choices=sorted(METHODS), help="integrator of the equations of motion (default: rk4)")
    ran.add_argument("--set", type=_setting, action="append", metavar="NAME=VALUE", help="bind a parameter, SI or with unit")
    ran.set_defaults(command=run)
    return parser
