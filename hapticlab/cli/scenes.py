"""What the command line does with scenes: the demonstration, and a scene file run, or measured for speed against accuracy."""

import json
import tempfile
import traceback
from dataclasses import replace
from pathlib import Path

from .. import __version__
from ..analysis.accuracy.tradeoff import tradeoff as measure_tradeoff
from ..analysis.accuracy.tradeoff_asked import Conditions, Tried
from ..analysis.records.plot import plot
from ..compiler.events.taylor_method import Taylor
from ..compiler.methods.chosen_method import EXACT
from ..compiler.methods.method_table import METHODS
from ..errors import HapticlabError, SceneError
from ..slips.shown import one_breath, whole
from . import board
from . import demo as demonstration
from .exits import INTERRUPTED, complain
from .scene_file import describe, held_alike, load_scene, report_of, run_scene

_METHODS = (*sorted(METHODS), Taylor.name, EXACT)


def demo(parser, options):
    """Show where virtual walls begin to chatter, and run an equation of motion."""
    folder = _folder(options)
    found = demonstration.study(quick=options.quick)
    facts = demonstration.report(found)
    files = demonstration.write(found, folder)
    return tell(options, facts, files, demonstration.words(facts))


def run(parser, options):
    """Run a scene file, on its own paddle or on a board."""
    if options.port is None and (options.yes or options.every):
        parser.error(f"{'--yes' if options.yes else '--every'} is for a board; name its port with --port")
    chosen = compiling(parser, options)
    file, path = opened(parser, options), Path(options.file)
    folder = _folder(options)
    if options.port is None:
        program, log = run_scene(file, **chosen)
        facts, loop = report_of(program, log), None
    else:
        try:
            program, log, loop = board.run_on_board(file, options, **chosen)
        except KeyboardInterrupt:
            complain("interrupted; the motor is off. No samples are kept: a run is written at its end, after --duration")
            return INTERRUPTED
        facts = report_of(program, log) | {"loop": board.timing_facts(loop)}
    figure, names = folder / f"{path.stem}.png", [name for name in file.scene.watch if name in log.channels]
    plot(log, "x", *names, "F").savefig(figure)
    files = {"figure": figure, "telemetry": log.to_csv(folder / f"{path.stem}.csv")}
    tell(options, facts, files, f"{log.paddle}\n{describe(facts)}" + (f"\nloop     {loop}" if loop else ""))
    return complain(f"the run failed: {log.fault}") if log.fault else 0


def tradeoff(parser, options):
    """Measure speed against accuracy of a scene file, for its own paddle and the targets asked for."""
    file, path = opened(parser, options), Path(options.file)
    folder = _folder(options)
    given = {name: several for name, several in {"methods": options.methods, "T": options.periods}.items() if several}
    targets = {"targets": options.targets} if options.targets else {}
    conditions = Conditions(live=options.live, every=options.every)
    found = measure_tradeoff(
        file.scene, file.paddle, tried=Tried(**given), conditions=conditions, tolerance=options.tolerance, **targets
    )
    asked = {"load": options.load, "passive": not options.any_hand}
    figure = folder / f"{path.stem}-tradeoff.png"
    found.plot(**asked).savefig(figure)
    files = {"figure": figure, "table": found.table.to_csv(folder / f"{path.stem}-tradeoff.csv")}
    chosen = {target: found.choose(target=target, **asked).facts() for target in found.targets}
    facts = {"scene": found.name, "paddle": str(file.paddle), "rows": len(found.table), "chosen": chosen}
    return tell(options, facts, files, found.summary(**asked))


def compiling(parser, options):
    """Return the options of hl.compile that the command line names."""
    if options.method not in (None, *_METHODS):
        parser.error(f"argument --method: invalid choice: {options.method!r} (choose from {', '.join(_METHODS)})")
    return {"method": options.method} if options.method else {}


def opened(parser, options):
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


def tell(options, facts, files, text):
    """Print the text and the files, or all facts as JSON; return the exit code."""
    if options.json:
        print(json.dumps({"hapticlab": __version__, **facts, "files": {k: str(p.resolve()) for k, p in files.items()}}, indent=1))
    else:
        print(text, "", *(f"{name.replace('_', ' ')}: {path.resolve()}" for name, path in files.items()), sep="\n")
    return 0


def _changed(file, options):
    """Return the scene file with what the command line sets."""
    paddle = held_alike(file.paddle, options.paddle) if options.paddle else file.paddle
    paddle = paddle if options.T is None else replace(paddle, T=options.T)
    duration = file.duration if options.duration is None else options.duration
    paddle.ticks(duration)
    return replace(file, scene=file.scene(**dict(options.set or [])), paddle=paddle, duration=duration)


def _in_their_words(problem, path):
    """Return an error of a scene file: in one breath, or with the frames of that file and those beside it."""
    if said := one_breath(problem, whole(problem)):
        return said
    told = traceback.TracebackException.from_exception(problem)
    folder = path.resolve().parent
    frames = [frame for frame in told.stack if folder == Path(frame.filename).resolve().parent and frame.filename[0] != "<"]
    if isinstance(problem, HapticlabError):
        return problem
    where = "".join(traceback.StackSummary.from_list(frames).format())
    return f"{path} failed\n{where}{''.join(told.format_exception_only())}".rstrip()
