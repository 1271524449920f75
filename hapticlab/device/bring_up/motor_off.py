"""The steps with the motor's supply off: the link, the loop, the sensor at rest and moved."""

import secrets

import numpy as np

from ...compiler.boards.board_records import BOARDS
from ...compiler.boards.cost import cost
from ..link.messages import SENSORS
from ..setup.calibrate import STEPS, calibrate
from ..setup.person import agrees
from ..setup.sensor_readings import JUMP, NOISY, REST, readings, watched_scene
from ..setup.stored_settings import lead_home
from .about import is_simulated
from .report import Finding

#: requests timed; watching [s]: loop, motion
PINGS, LOOP, MOVED = 100, 2.0, 8.0
#: bytes of a PING and its answer, and 2 ms that a board may take; a USB frame either way [s]
PING_BYTES, ANSWER, USB = 22, 2e-3, 2e-3
#: part of the travel by which a sweep may miss it: as in homing
MISS = 1 / 32


def calibration(bench):
    """Calibrate what needs no force, on a board that is new or whose wiring nobody confirmed."""
    paddle, person = bench.paddle, bench.person
    question = "This paddle is not calibrated. Do it now, with the supply of the motor off?"
    if not all(_confirmed_and_measured(paddle)) and agrees(person, question):
        for step in STEPS[: STEPS.index("sign")]:
            calibrate(paddle, person, only=step)
            if not _confirmed_and_measured(paddle)[0]:
                break  # a person who does not confirm the wiring is not asked for it by every step
    kept = paddle.settings
    wired, good = _confirmed_and_measured(paddle)
    measured = bool(kept and kept.date)
    yield Finding.seen("calibration", "wiring confirmed", wired, "yes" if wired else "no", "a person compared the wires")
    yield Finding.seen("calibration", "stops measured", good, str(kept.date) if measured else "nominal", "a person measured them")


def _confirmed_and_measured(paddle):
    """Return whether a person has confirmed the wiring, and measured the stops: a simulated board is what its settings say."""
    kept = paddle.settings
    return bool(kept and kept.wired), bool(kept and (kept.date or is_simulated(paddle)))


def link(bench):
    """Time requests there and back, and watch the loop with the motor off."""
    paddle, times = bench.paddle, []
    for _ in range(PINGS):
        begun = paddle.exchange.now()
        paddle.exchange.ask("PING", secrets.randbits(32))
        times.append(paddle.exchange.now() - begun)
    most = PING_BYTES / getattr(paddle.exchange.port, "bytes_per_second", paddle.exchange.port.baudrate / 10) + ANSWER + USB
    source = "bytes of the request at the port's rate, 2 ms on the board, 2 ms of USB"
    yield Finding.of("link", "latency, median", float(np.median(times)), "s", 0.0, most, source, f"worst {max(times):.4g} s")
    program = paddle.program(watched_scene())
    log = paddle.run(program, LOOP, passive=True, progress=False)
    yield from _loop(paddle, program, log)


def _loop(paddle, program, log):
    timing, name = paddle.timing, paddle.board["board"]
    wide = max(timing.period_max - timing.T, timing.T - timing.period_min)
    yield Finding.of("link", "jitter of the period", wide, "s", 0.0, 0.05 * paddle.T, "5 % of the period, as in the doctor")
    yield Finding.of("link", "overruns", timing.overruns, "", 0, 0, "the scene fits the period")
    lost = int(np.sum(log.gap)) + timing.lost if log.gap is not None else timing.lost
    yield Finding.of("link", "samples lost", lost, "", 0, 0, "the link carries what was asked of it")
    if name in BOARDS and BOARDS[name].hz and timing.worst:
        most = cost(program, board=name, every=log.every).longest(promise=True) / BOARDS[name].hz
        source = f"hapticlab.compiler.boards.cost of {name}, the worst case"
        yield Finding.of("link", "step, worst", timing.worst, "s", 0.0, most, source, f"mean {timing.mean:.4g} s")
    else:
        yield Finding("link", "step, worst", "s", timing.worst, note="the time of this board is not predicted")


def sensor_at_rest(bench):
    """Noise of a handle that nobody touches."""
    bench.person.ask("Release the handle, and press Enter.")
    seen = readings(bench.paddle, REST)
    noise = bench.paddle.settings.sensor_noise / bench.metres_per_count if bench.paddle.settings else 0.0
    source = f"sensor_noise of the settings and {NOISY} counts"
    yield Finding.of("sensor at rest", "width", seen.sweep, "counts", 0, NOISY + 8 * noise, source)
    yield Finding("sensor at rest", "rms", "counts", float(np.std(seen.counts)))


def sensor_moved(bench):
    """Whether the sensor follows the handle over its whole travel, and the board finds where it is."""
    bench.person.ask(f"Press Enter, then move the handle slowly from stop to stop and back, twice, for {MOVED:g} s.")
    seen = readings(bench.paddle, MOVED)
    settings, span = bench.paddle.settings, seen.sweep
    if settings is None:
        yield Finding("sensor moved", "range", "counts", span, note="nothing is calibrated to compare it with")
        return
    travel = (settings.travel_max - settings.travel_min) / bench.metres_per_count
    source = "travel of the settings, within 1/32, as homing takes it"
    yield Finding.of("sensor moved", "range", span, "counts", (1 - MISS) * travel, (1 + MISS) * travel, source)
    source = f"{JUMP} counts, as in the doctor"
    yield Finding.of("sensor moved", "largest jump", seen.jump, "counts", 0, JUMP, source)
    if settings.sensor != SENSORS["QUADRATURE"]:
        yield Finding("sensor moved", "wraps of the sensor", "", span / settings.wrap)
    lead_home(bench.paddle, bench.person)
    where, source = bench.paddle.state()["x"], "travel of the settings"
    yield Finding.of("sensor moved", "position found", where, "m", settings.travel_min, settings.travel_max, source)
