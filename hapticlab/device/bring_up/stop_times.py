"""The steps that try every way to stop, against a pull that a finger holds: switch, silence, STOP, Ctrl-C, bad scene, cable.

A board says at which tick it stopped, so times between two of its ticks are its own. No computer's clock is in them.
"""

import math

from ...errors import HapticlabError
from ...scene.notation.symbols import parameters
from ...scene.scene import Scene
from ..board.serial_paddle import is_refusal
from ..link.messages import FAULTS as WORDS
from ..link.messages import HOST_SILENCE_MS, STATES, row_of
from ..setup.person import agrees
from ..setup.stored_settings import lead_home
from .about import what_happened
from .report import Finding
from .steps import PULL

#: s that a person has for an act, and for the board to report a fault
ACT, REPORT = 20.0, 0.5
#: where the time of a STOP goes, beside a reply's way [s]
STOP_MOST = 0.01


def switch(bench):
    """The switch in the motor's supply ends a pull."""
    bench.person.ask("Hold the handle in the middle, with the other hand on the switch. Switch on, and press Enter.")
    with bench.pulled() as paddle:
        felt = agrees(bench.person, "Do you feel a light pull?")
        bench.person.ask("Switch the supply off, and press Enter.")
        ended = agrees(bench.person, "Has the pull ended?")
        log = paddle.stop()
    yield Finding.seen("switch", "pull felt", felt, "yes" if felt else "no", "the person")
    yield Finding.seen("switch", "pull ended by the switch", ended, "yes" if ended else "no", "the person")
    if log.fault:
        yield Finding.seen("switch", "the board meanwhile", False, log.fault, "no fault was provoked")
    bench.person.ask("Switch the supply on again, and press Enter.")


def host_silent(bench):
    """The computer falls silent."""
    bench.hold()
    with bench.pulled() as paddle:
        paddle.exchange.beating = False
        begun = paddle.exchange.refresh()["tick"]
        fault = bench.fault(REPORT)
    limit = HOST_SILENCE_MS * 1e-3
    yield from stopped(bench, "host silent", fault, "HOST_SILENT", begun, limit - paddle.T, limit + 2 * paddle.T)


def stop(bench):
    """The computer says STOP."""
    bench.hold()
    with bench.pulled() as paddle:
        begun = paddle.exchange.now()
        paddle.exchange.command("STOP")
        took = paddle.exchange.now() - begun
        paddle.stop()
    yield Finding.of("STOP", "stop time", took, "s", 0, STOP_MOST, "request and reply, and one tick", "by this computer's clock")


def interrupt(bench):
    """The person presses Ctrl-C in a run."""
    bench.hold(f"Press Enter, and then press Ctrl-C within {ACT:g} s.")
    try:
        with bench.pulled() as paddle:
            paddle.wait(ACT)
            paddle.stop()
    except KeyboardInterrupt:
        state = bench.paddle.state()["state"]
    else:
        yield Finding.skipped("Ctrl-C", f"Ctrl-C did not come within {ACT:g} s")
        return
    off = state != STATES["RUN"]
    yield Finding.seen("Ctrl-C", "motor off", off, "yes" if off else "no", "paddle.wait sends STOP before it gives way")


def not_finite(bench):
    """The scene divides by zero."""
    w, y = parameters("w y", units="N*m m")
    bench.hold()
    with bench.pulled(Scene(force=w / y, name="quotient")(w=PULL * 0.02, y=0.02)) as paddle:
        paddle.set(y=0.0)
        begun = round(paddle.under_way.changes[-1][0] / paddle.T) - 1
        fault = bench.fault(REPORT)
    yield from stopped(bench, "not finite", fault, "NOT_FINITE", begun, 0, 3 * paddle.T)


def cable(bench):
    """The cable is pulled out, and the board found again."""
    bench.hold(f"Press Enter, and then pull the USB cable out of the computer within {ACT:g} s.")
    try:
        with bench.pulled() as paddle:
            paddle.wait(ACT)
            paddle.stop()
    except HapticlabError as problem:
        if is_refusal(problem):
            raise
    else:
        yield Finding.skipped("cable", f"the cable stayed in for {ACT:g} s")
        return
    ended = agrees(bench.person, "Has the pull ended?")
    yield Finding.seen("cable", "pull ended", ended, "yes" if ended else "no", f"HOST_SILENCE_MS = {HOST_SILENCE_MS}")
    bench.person.ask("Plug the cable in again, and press Enter.")
    bench.plug_in()
    said = what_happened(bench.paddle) or "nothing: it lost its power with the cable, or opening the port reset it"
    yield Finding("cable", "the board afterwards", found=said)
    lead_home(bench.paddle, bench.person)


def stopped(bench, step, fault, name, begun, low, high):
    """Yield which fault came, and how long after a tick the motor was off [s]."""
    said = (row_of(WORDS, fault["fault"]) or ("?",))[0] if fault else "no fault"
    yield Finding.seen(step, "fault", said == name, said, f"{name} of messages.py")
    took = (fault["tick"] - begun) * bench.paddle.T if fault else math.inf
    source = "tests/firmware/faults.py, and one tick of reading"
    yield Finding.of(step, "stop time", took, "s", low, high, source, "by the board's ticks")
