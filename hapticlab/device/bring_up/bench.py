"""Walk an owner through the first power-up of a paddle, motor off first, and report what was predicted and found."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ...errors import HapticlabError, PaddleError
from ..board.serial_paddle import is_refusal
from ..link.messages import HOST_SILENCE_MS, STATES
from ..setup.stored_settings import lead_home
from . import forces, motor_off, stop_times
from .about import about_board, about_settings
from .limits import limits
from .report import BenchReport, Finding
from .shared import Bench
from .steps import STEPS

if TYPE_CHECKING:
    from collections.abc import Callable

    from ..board.serial_paddle import SerialPaddle
    from ..setup.person import Person

#: in order; "over-speed" lowers the limit of the speed, then that of the travel
OFF = {
    "calibration": motor_off.calibration,
    "link": motor_off.link,
    "sensor at rest": motor_off.sensor_at_rest,
    "sensor moved": motor_off.sensor_moved,
}
ON = {
    "switch": stop_times.switch,
    "host silent": stop_times.host_silent,
    "STOP": stop_times.stop,
    "Ctrl-C": stop_times.interrupt,
    "not finite": stop_times.not_finite,
    "over-speed": limits,
    "cable": stop_times.cable,
    "sign": forces.sign,
    "lag": forces.lag,
    "force": forces.force,
}
WITH = {"over-speed": ("over-speed", "over-travel")}
STILL_LOWERED = (
    "The board still stores the lower limits of the test. `hapticlab bench --restore FILE.json` stores the limits from before"
)


def bench(paddle: SerialPaddle, person: Person, *, tell: Callable[[Any], Any] = lambda finding: None) -> BenchReport:
    """Walk through the first power-up of a paddle and return what was found; the motor is off afterwards, always.

    Parameters
    ----------
    paddle : SerialPaddle
        Connected. One without settings is watched with its motor off only.
    person : Person
        The person who holds the handle, with a hand on the switch of the motor's supply.
    tell : callable
        Called with every Finding as it is made.

    Returns
    -------
    BenchReport
        Partial where Ctrl-C, the link or a switch that does not work ended it: ``ended`` then says where.

    Notes
    -----
    The motor gives at most 0.4 N until the last step, which asks first. For two steps the limits of speed and travel that the
    board stores are lowered, and put back. The position of the handle is asked for again where one of them lost it. A
    paddle whose cable was pulled is closed.

    Examples
    --------
    >>> import hapticlab as hl
    >>> from hapticlab.device.bring_up.bench import bench
    >>> from hapticlab.device.setup.person import Person
    >>> class Leaves(Person):
    ...     def say(self, text):
    ...         print(text.split("\\n")[1])
    ...     def ask(self, question):
    ...         raise KeyboardInterrupt
    >>> with hl.connect("sim://hapkit") as board:
    ...     report = bench(board, Leaves())
    == supply off
    >>> report.ended
    "interrupted in the step 'supply off'; the motor is off"
    """
    shared, made, ended, name = Bench(paddle, person), [], "whole", "supply off"
    about = about_board(paddle)
    try:
        person.say(str(STEPS[name]))
        person.ask("Switch off the supply of the motor, and press Enter.")
        for name, measure in {**OFF, **ON}.items():
            for finding in _findings(shared, name, measure):
                made.append(finding)
                tell(finding)
            if name == "switch" and any(f.step == name and f.verdict == "differs" for f in made):
                ended = "ended in the step 'switch': no step that needs the switch was done"
                break
    except KeyboardInterrupt:
        ended = f"interrupted in the step {name!r}; {_motor_off(shared.paddle)}"
    except HapticlabError as problem:
        ended = f"ended in the step {name!r}: {problem}; {_motor_off(shared.paddle)}"
    finally:
        shared.paddle.abandon()
        if shared.paddle is not paddle:
            shared.paddle.close()  # found again after the cable was pulled; the caller's own is closed
    if shared.lowered:
        ended += f". {STILL_LOWERED}"
    return BenchReport(about | about_settings(shared.lowered or shared.paddle.settings), tuple(made), ended)


def _motor_off(paddle):
    """Switch the motor off, and return in words what the board says of it."""
    paddle.abandon()
    try:
        state = paddle.state()["state"]
    except HapticlabError:
        return f"the board does not answer, and stops its motor {HOST_SILENCE_MS} ms after the last word. Switch the supply off"
    return "the motor is off" if state != STATES["RUN"] else "the board says that its motor is ON: switch the supply off"


def _why_no_force(bench):
    """Return why a board gives no force now, or "" once the handle was led to both stops."""
    if bench.paddle.settings is None:
        return "the board has no settings: run `hapticlab calibrate`"
    try:
        lead_home(bench.paddle, bench.person)
    except PaddleError as problem:
        if not is_refusal(problem):
            raise
        return str(problem)
    return ""


def _findings(bench, name, measure):
    """Yield what one step finds; where the board or the package refuses it, that is what was found."""
    why = _why_no_force(bench) if name in ON else ""
    if why:
        yield Finding.skipped(name, why)
        return
    for shown in WITH.get(name, (name,)):
        bench.person.say(str(STEPS[shown]))
    try:
        yield from measure(bench)
    except HapticlabError as problem:
        bench.paddle.abandon()
        if not is_refusal(problem):
            raise
        yield Finding.seen(name, "the step", False, str(problem), "the board takes it")
