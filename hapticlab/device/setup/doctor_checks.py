"""The steps of hapticlab.device.setup.doctor: each looks at one thing and returns a Check."""

import secrets
import shutil
import sys
import textwrap
from contextlib import closing, suppress
from dataclasses import dataclass

import numpy as np

from ...errors import HapticlabError, LinkError, PaddleError, PortError
from ..board.homing import state_flag
from ..board.settings import day_in_words, pins_of
from ..link.messages import RESET_CAUSES, SENSORS, row_of, table_hash
from ..link.serial_ports import open_port
from ..wiring import Wiring
from ..wirings import built_as
from .built import ask_built, board_with_pins
from .flash import FLASHED, find_bootloader
from .person import agrees
from .sensor_readings import JUMP, LEAST_SWEEP, REST, most_at_rest, readings, watch
from .sign_check import check_sign
from .stored_settings import lead_home

#: requests timed, and medians [s] from which the link is slow and from which it is an FTDI left as its driver starts it
PINGS, SLOW, LAZY = 200, 4e-3, 8e-3
#: s of watching: the loop, the handle moved
LOOP, MOVED = 2.0, 6.0
#: part of the period by which it may vary
JITTER = 0.05


@dataclass(frozen=True)
class Check:
    """One step: name, state ("ok", "attention", "fault", "no board", "skipped"), what was found, what to do in lines."""

    name: str
    state: str
    found: str
    cure: str = ""

    def __str__(self):
        lines = _short(f"{self.state:<10} {self.name:<10} {self.found}", "", " " * 22)
        for cure in self.cure.splitlines():
            lines += [f"{COMMAND}{cure}"] if cure.startswith("sudo ") else _short(cure, f"{'':<10} -> ", " " * 14)
        return "\n".join(lines)


#: before a command that is to be typed: never wrapped, so that it can be copied
COMMAND = " " * 17


def _short(words, first, next_ones):
    """Lines that fit the terminal, broken between words alone."""
    width = max(60, min(shutil.get_terminal_size().columns, 110))
    fitting = {"break_long_words": False, "break_on_hyphens": False}
    return textwrap.wrap(words, width, initial_indent=first, subsequent_indent=next_ones, **fitting)


def firmware(port, url, connected):
    """Return the Checks of what runs on the board, and the paddle made by ``connected`` or None."""
    try:
        paddle = connected(url, port=port)
    except PortError as problem:
        return [Check("firmware", "fault", "the port failed", str(problem))], None
    except LinkError as problem:
        return [_other_firmware(url, problem)], None
    same = f"messages {table_hash():08x}, the same as in this package; {paddle}"
    return [Check("firmware", "ok", same), _reset_cause(paddle.board["reset_cause"]), *_pending(paddle)], paddle


def _other_firmware(url, problem):
    if problem.result == "VERSION":
        return Check("firmware", "fault", "hapticlab firmware of another version", str(problem))
    if "://" in url or not _bootloader_answers(url):
        return Check("firmware", "fault", "neither a paddle nor a bootloader answers", str(problem))
    cure = f"install the firmware: hapticlab flash --port {url}"
    return Check("firmware", "fault", "a board with a bootloader, but no hapticlab firmware", cure)


def _bootloader_answers(url):
    for how in FLASHED.values():
        with suppress(HapticlabError), closing(open_port(url, baudrate=how.bootloaders[0].baudrate)) as port:
            find_bootloader(port, how)
            return True
    return False


def _reset_cause(number):
    name, meaning = row_of(RESET_CAUSES, number) or ("?", "unknown")
    if name in ("BROWN_OUT", "WATCHDOG"):
        return Check("reset", "attention", f"the last reset was {name}", meaning)
    return Check("reset", "ok", f"last reset: {meaning}")


def _pending(paddle):
    """Return a Check of a fault that stood when the doctor came, if there was one."""
    faults = [notice for notice in paddle.notices if "fault was pending" in notice]
    cure = "find its cause before the motor moves again; `hapticlab guide faults --open` lists causes of each fault"
    return [Check("fault", "attention", fault, cure) for fault in faults]


def settings(paddle):
    """Whether the board has settings, and whether anything in them was measured."""
    kept = paddle.settings
    if kept is None:
        return Check("settings", "attention", "none, so this board gives no force", "run `hapticlab calibrate`")
    sensor = next(name for name, k in SENSORS.items() if k == kept.sensor).lower()
    words = f"{abs(kept.metres_per_count) * 1e6:.4g} um per count, {sensor}, force_full = {kept.force_full:.4g} N"
    if kept.is_nominal and paddle.url.startswith("sim://"):
        return Check("settings", "ok", f"as simulated: {words}")
    if kept.is_nominal:
        return Check(
            "settings",
            "attention",
            f"nominal: {words}",
            "run `hapticlab calibrate`, because no value was measured on this paddle",
        )
    return Check("settings", "ok", f"{words}, calibrated {day_in_words(kept.date)}")


def wiring(paddle, person):
    """Whether the board is told the wiring that is built, and whether a person has confirmed it."""
    kept = paddle.settings
    if kept is None:
        return Check("wiring", "skipped", "whether it is confirmed: needs a calibration")
    if not pins_of(kept.motor_pins):
        return Check("wiring", "ok", "none: a simulated paddle has no pins")
    board = board_with_pins(paddle.board["board"])
    told = built_as(board, Wiring.of(kept))
    if person is not None:
        built = ask_built(person, board)
        if built.wiring != told.wiring:
            words = f"the board is set to {told.in_short()}, but {built.in_short()} is built"
            cure = "switch the supply of the motor off\nrun `hapticlab calibrate --only wiring`"
            return Check("wiring", "fault", words, cure)
    if not kept.wired:
        cure = "run `hapticlab calibrate --only wiring`"
        return Check("wiring", "attention", f"not confirmed, so the motor stays off: {told.in_short()}", cure)
    return Check("wiring", "ok", f"confirmed: {told.in_short()}")


def latency(paddle):
    """Time requests there and back."""
    exchange, times = paddle.exchange, []
    for _ in range(PINGS):
        begun = exchange.now()
        exchange.ask("PING", secrets.randbits(32))
        times.append(exchange.now() - begun)
    median, worst = float(np.median(times)), max(times)
    words = f"{median * 1e3:.2f} ms median, {worst * 1e3:.2f} ms worst of {PINGS} requests"
    if median < SLOW:
        return Check("latency", "ok", words)
    return Check("latency", "attention", words, _latency_cure(median))


def _latency_cure(median):
    if median < LAZY:
        return "use a USB socket of the computer itself, not a hub; walls run on the board, so this does not affect them"
    where = {
        "win32": "Device Manager > Ports > properties > Port Settings > Advanced > Latency Timer: 1 ms",
        "linux": "a shorter time was requested when the port was opened, but the driver ignored it: echo 1 | sudo tee "
        "/sys/bus/usb-serial/devices/ttyUSB*/latency_timer",
    }.get(sys.platform, "the system's FTDI driver sets it; Apple's driver uses 1 ms to 16 ms, depending on its version")
    return f"an FTDI adapter waits 16 ms by default: {where}. Walls run on the board, so this does not affect them"


def loop_and_link(paddle):
    """Watch the loop for two seconds with the motor off; return its Check and the link's."""
    before = _damaged(paddle)  # the first hello of a board that has just been reset comes to it in part
    log = watch(paddle, LOOP)
    timing, expected = paddle.timing, round(LOOP / paddle.T)
    jitter = max(timing.period_max - timing.T, timing.T - timing.period_min)
    bad = timing.overruns or jitter > JITTER * timing.T
    loop = Check("loop", "attention" if bad else "ok", str(timing), "report this with the board's name" if bad else "")
    missing = int(np.sum(log.gap)) if log.gap is not None else 0
    damaged = _damaged(paddle) - before
    words = f"{len(log)} samples of {expected // round(log.T / paddle.T)}, {missing} gaps, {timing.lost} lost, {damaged} damaged"
    cure = "use a different, short cable away from the motor's wires, and no hub" if missing or damaged or timing.lost else ""
    return [loop, Check("link", "attention" if cure else "ok", words, cure)]


def _damaged(paddle):
    """Damaged frames so far, both ways."""
    return paddle.state()["damaged"] + paddle.exchange.decoder.damaged


def sensor_at_rest(paddle):
    """Noise of a handle that nobody touches, in counts."""
    counts = readings(paddle, REST).counts
    wide = float(np.ptp(counts))
    words = f"at rest {wide:.0f} counts wide, {np.std(counts):.2f} rms"
    if wide <= most_at_rest(paddle.settings):
        return Check("noise", "ok", words)
    cure = (
        "release the handle; if it still moves, check the supply and ground of the sensor, and keep its wires away from "
        "those of the motor"
    )
    return Check("noise", "attention", words, cure)


def sensor_moved(paddle, person):
    """Whether the sensor follows the handle, over its wraps, without jumps."""
    if person is None:
        return Check("sensor", "skipped", "whether it follows the handle: needs a person")
    person.ask(f"Press Enter, then move the handle slowly from stop to stop and back, for {MOVED:g} s. The motor is off.")
    seen = readings(paddle, MOVED)
    sweep, jump = seen.sweep, seen.jump
    if sweep < LEAST_SWEEP:
        cure = f"check the sensor's wires{_sensor_wires(paddle)}, that its magnet is there and turns, and the kind of sensor"
        return Check("sensor", "fault", f"{sweep:.0f} counts while the handle was moved back and forth", cure)
    kept = paddle.settings
    wraps = f", {sweep / kept.wrap:.1f} turns of {kept.wrap}" if kept and kept.sensor != SENSORS["QUADRATURE"] else ""
    words = f"{sweep:.0f} counts from end to end{wraps}, largest jump {jump:.0f}"
    if jump <= JUMP:
        return Check("sensor", "ok", words)
    cure = (
        "move the handle slowly and try again; if it fails again, the magnet is loose or too far away, or counts are "
        "lost where the sensor wraps"
    )
    return Check("sensor", "attention", words, cure)


def _sensor_wires(paddle):
    """Return the sensor's pins in words, or nothing where the board has no wiring."""
    kept = paddle.settings
    if kept is None or not pins_of(kept.motor_pins):
        return ""
    built = built_as(board_with_pins(paddle.board["board"]), Wiring.of(kept))
    return f" ({', '.join(f'{role} on {built.pins.name(built.wiring.pins()[role])}' for role in built.wiring.sensor_roles)})"


def home(paddle, person):
    """Whether the board knows where the handle is, or learns it from both stops."""
    if paddle.settings is None:
        return Check("home", "skipped", "whether both stops are found: needs a calibration")
    if state_flag(paddle.exchange, "HOMED"):
        return Check("home", "ok", f"the position is known: x = {paddle.state()['x'] * 1e3:.2f} mm")
    if person is None:
        return Check("home", "skipped", "unknown since the last reset; a person must move the handle to both stops")
    try:
        lead_home(paddle, person)
    except PaddleError as problem:
        return Check("home", "fault", "not found between the stops", str(problem))
    return Check("home", "ok", f"found from both stops: x = {paddle.state()['x'] * 1e3:.2f} mm")


def sign(paddle, person):
    """Whether the motor pulls the way it is told."""
    kept = paddle.settings
    if kept is None or not state_flag(paddle.exchange, "HOMED"):
        return Check("motor", "skipped", "its sign: needs a calibration and a known position")
    before = "checked, as stored on the board" if kept.checked else "not checked, so at most 0.5 N"
    cure = "" if kept.checked else "run `hapticlab calibrate --only sign`"
    if person is None or not agrees(person, f"The motor's sign is {before}. Check it now, with at most 0.5 N?"):
        return Check("motor", "ok" if kept.checked else "attention", f"its sign is {before}", cure)
    found = check_sign(paddle, person)
    state = {"right": "ok", "wrong": "fault"}.get(found.verdict, "attention")
    return Check("motor", state, str(found), "" if state == "ok" else "run `hapticlab calibrate --only sign`")
