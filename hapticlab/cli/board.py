"""What the command line does with a board: ports, doctor, flash, calibrate, bench, and a scene run on it."""

import json
import platform
import sys
import tempfile
from contextlib import nullcontext, redirect_stdout
from functools import partial
from itertools import chain, count
from pathlib import Path

from .. import __version__
from ..base.in_notebook import is_in_browser
from ..base.profile.profile_file import SUFFIX
from ..course.drawings.wiring_files import wiring_svg
from ..device.bring_up.about import restorable, settings_of
from ..device.bring_up.bench import bench as first_power_up
from ..device.bring_up.practised import PractisingOwner
from ..device.link.serial_ports import IN_A_BROWSER, available_ports
from ..device.setup.before_flash import before_flash
from ..device.setup.calibrate import calibrate as calibrate_paddle
from ..device.setup.connect import connect
from ..device.setup.doctor import doctor as walk
from ..device.setup.drive.copy_firmware import COPIED, copy_firmware, usb_numbers, waiting_boards
from ..device.setup.flash import FLASHED
from ..device.setup.flash import flash as write_firmware
from ..device.setup.person import Person, agrees
from ..device.setup.practice import practice_board
from ..device.setup.stored_settings import offer
from ..device.simulated.simulated_paddle import SimulatedPaddle
from ..errors import PaddleError, PortError
from .exits import INTERRUPTED
from .scene_file import held_alike

#: a simulated board has no motor that could hurt and no handle that a person could lead
SIMULATED = "sim://"


class PersonWithPictures(Person):
    """The person at this terminal, who gets each drawing as a file."""

    def picture(self, build):
        """Write the drawing of a wiring, and return where it is."""
        name = {"prefix": f"hapticlab-wiring-{build.name}-", "suffix": ".svg"}  # its own, where people share a folder
        with tempfile.NamedTemporaryFile("w", encoding="utf-8", delete=False, **name) as file:
            file.write(wiring_svg(build))
        return file.name


def ports(parser, options):
    """List the serial ports of this computer."""
    found = available_ports()
    if options.json:
        print(json.dumps([vars(port) for port in found], indent=1))
        return 0
    for port in found:
        asked = "asked by connect()" if port.known else "left alone unless named: it may drive something else"
        print(f"{port.device:<16} {port.known or port.description or 'unknown':<36} {asked}")
    if is_in_browser():
        print(IN_A_BROWSER, file=sys.stderr)
    elif not any(port.known for port in found):
        print("No known board is plugged in; everything else works without one: hapticlab labs", file=sys.stderr)
        print("If you have a board, this says what to look at: hapticlab doctor", file=sys.stderr)
    return 0


def doctor(parser, options):
    """Walk from the cable to the motor; 1 if anything is a fault, or no board is there."""
    alone = options.no_person or options.json or _is_simulated(options.port) or not sys.stdin.isatty()
    with _words_apart(options):
        report = walk(options.port, None if alone else PersonWithPictures(), tell=print)
    if options.report:
        Path(options.report).write_text(_for_a_stranger(report), "utf-8")
    if options.json:
        print(json.dumps(report.records(), indent=1))
    else:
        print(str(report).splitlines()[-1] + ("; what needs a person at the handle was skipped" if alone else ""))
    return report.exit_code


def _for_a_stranger(report):
    """Return the report as JSON to send: what was found here, without the user's folder."""
    system = {"hapticlab": __version__, "python": platform.python_version(), "platform": platform.platform(terse=True)}
    text = json.dumps(system | {"checks": report.records()}, indent=1)
    return text.replace(json.dumps(str(Path.home()))[1:-1], "HOME") + "\n"


def flash(parser, options):
    """Write the firmware into a board."""
    if is_in_browser():
        raise PortError(IN_A_BROWSER, "missing")
    tell, board = partial(print, file=sys.stderr), options.board or _likely_board(options.port)
    if board not in FLASHED | COPIED:
        raise PaddleError(f"board = {board!r}; this package has firmware for {', '.join(FLASHED | COPIED)}. Give one of them")
    if board in COPIED:
        port = options.port or _port_of(board)
        before_flash(port, board, _who(options), tell=tell)
        print(copy_firmware(options.image, board, port, tell=tell))
        return 0
    port = options.port or _only_port()
    before_flash(port, board, _who(options), tell=tell)
    print(write_firmware(port, options.image, board, tell=tell))
    return 0


def calibrate(parser, options):
    """Measure what a paddle is, with a person at it, and store it on the board."""
    if options.practice:
        board, simulated_person = practice_board(options.practice)
        with board:
            return 0 if calibrate_paddle(board, simulated_person, only=options.only) is not None else 1
    if _is_simulated(options.port):
        raise PaddleError(
            f"{options.port} has no handle to lead. Calibrate a board that is plugged in, or rehearse it on a simulated one: "
            "hapticlab calibrate --practice"
        )
    person = PersonWithPictures()
    _agree(options, person, "The motor will pull the handle by 0.5 N at first, by up to 2 N after its sign is checked.")
    with connect(options.port) as paddle:
        _tell_notices(paddle)
        kept = calibrate_paddle(paddle, person, only=options.only)
    return 0 if kept is not None else 1


def bench(parser, options):
    """Walk an owner through the first power-up and write one report; 0 only if it is whole and all came as predicted."""
    person, simulated = PersonWithPictures(), _is_simulated(options.port)
    if options.restore:
        kept = settings_of(options.restore)
        with connect(options.port) as paddle:
            kept = restorable(kept, paddle.settings)
            return int(not offer(paddle, person, kept, [str(kept)]))
    _agree(
        options,
        person,
        "The motor will pull the handle by 0.4 N, and by up to 2 N in a last step that asks again. "
        "Before you go on, read what nothing switches off: `hapticlab guide safety --open`.",
    )
    with connect(options.port) as paddle:
        _tell_notices(paddle)
        report = first_power_up(paddle, PractisingOwner(paddle) if simulated else person, tell=print)
        page, data = report.save(_unused(options.out))
    print(f"{report.sentence}\nThe report is in {page}, and as data in {data}")
    return INTERRUPTED if report.ended.startswith("interrupted") else int(not report.is_whole)


def _tell_notices(paddle):
    """Print what the board went through before, if anything, where it hides no JSON."""
    for sentence in paddle.notices:
        print(sentence, file=sys.stderr)


def run_on_board(file, options, **compiling):
    """Run a scene file on the board at options.port; return program, Telemetry and timing.

    The file's paddle is the mechanics of a simulated board, unless the port names the file of a profile, whose paddle is held
    by the same hand; on another board it is not used.
    """
    with _words_apart(options):
        moves = f"The motor of {options.port} will move the handle for {file.duration:g} s; hold it lightly."
        _agree(options, Person(), moves)
        mechanics = file.paddle if _is_simulated(options.port) and isinstance(file.paddle, SimulatedPaddle) else None
        at = options.port.partition("?")[0].removeprefix(SIMULATED)
        if mechanics is not None and at.endswith(SUFFIX):
            mechanics = held_alike(mechanics, at, T=mechanics.T)
        with connect(options.port, T=file.paddle.T, paddle=mechanics) as paddle:
            _tell_notices(paddle)
            if mechanics is None:
                print(f"The scene file's paddle is not used, but for its T = {paddle.T:g} s: {options.port} has its own.")
            log = paddle.run(file.scene, duration=file.duration, every=options.every, **compiling)
            return paddle.program(file.scene, **compiling), log, paddle.timing


def timing_facts(timing):
    """The board's measurements of its own steps, as a dictionary for JSON."""
    return {
        "step_mean_s": timing.mean,
        "step_worst_s": timing.worst,
        "period_min_s": timing.period_min,
        "period_max_s": timing.period_max,
        "overruns": timing.overruns,
        "lost": timing.lost,
    }


def _who(options):
    """The person at this terminal who can be asked, or None."""
    return PersonWithPictures() if sys.stdin.isatty() and not options.yes else None


def _is_simulated(port):
    return (port or "").startswith(SIMULATED)


def _words_apart(options):
    """Send what is told on the way to stderr where stdout is for JSON alone."""
    return redirect_stdout(sys.stderr) if options.json else nullcontext()


def _agree(options, person, what):
    """Say what a motor will do, and go on only with a yes."""
    if options.yes or _is_simulated(options.port):
        return
    if not sys.stdin.isatty():
        raise PaddleError(f"{what} Nobody can be asked here: give --yes")
    if not agrees(person, f"{what} Go on?"):
        raise PaddleError("nothing was done")


def _unused(path):
    """Return a path without a report, with a number if need be: an earlier report is evidence, and has settings to restore."""
    stem = Path(path).with_suffix("")
    names = chain([stem], (stem.with_name(f"{stem.name}-{k}") for k in count(2)))
    return next(name for name in names if not any(name.with_suffix(end).exists() for end in (".md", ".json")))


def _likely_board(port):
    """The board that is meant where nobody said: by the USB numbers of its port, or by its drive; else an Uno."""
    found = [one for one in available_ports() if (one.device == port if port else one.known)]
    copied = [name for name in COPIED for one in found if (one.vid, one.pid) in usb_numbers(name)]
    if not copied and not found and not port:
        copied = [name for name in COPIED if waiting_boards(name)]
    return copied[0] if copied and len(copied) >= len(found) else "uno"


def _port_of(board):
    """The only port with the USB numbers of a board, or None."""
    found = [port.device for port in available_ports() if (port.vid, port.pid) in usb_numbers(board)]
    return found[0] if len(found) == 1 else None


def _only_port():
    known = [port.device for port in available_ports() if port.known]
    if not known:
        raise PaddleError(
            "no known board is plugged in. Use a USB cable that carries data, or name the port: hapticlab flash --port PORT. For "
            "a new Pico: hapticlab flash --board pico"
        )
    if len(known) > 1:
        raise PaddleError(f"known boards: {', '.join(known)}; say which port to write to: hapticlab flash --port PORT")
    return known[0]
