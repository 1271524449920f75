"""The steps that try the limits of speed and travel: both are lowered for the step, and put back after it."""

import math
from contextlib import contextmanager

import numpy as np

from ..board.homing import state_flag
from ..board.settings import changed
from ..link.messages import SENSORS
from ..setup.stored_settings import lead_home, store
from .report import Finding
from .steps import TRIED_SPEED, TRIED_TRAVEL
from .stop_times import ACT, stopped

#: part of the span beyond the travel that a stop may give: firmware/core/handle.c
GIVES = 1 / 20
#: counts per period that a limit on speed needs, to be seen, and the longest period for that [s]
SEEN, T_MOST = 3, 10e-3


def limits(bench):
    """A flick, then a slow move: both end the pull. The flick may look like a sensor that fails, which loses the position."""
    bench.person.ask("Hold the handle still in the middle, and press Enter.")
    kept = bench.paddle.settings
    with lowered(bench, speed_max=min(TRIED_SPEED, kept.speed_max)):
        yield from _over_speed(bench)
    lead_home(bench.paddle, bench.person)
    middle = (kept.travel_min + kept.travel_max) / 2
    low, high = (middle + TRIED_TRAVEL * (stop - middle) for stop in (kept.travel_min, kept.travel_max))
    with lowered(bench, travel_min=low, travel_max=high):
        yield from _over_travel(bench)
    lead_home(bench.paddle, bench.person)


@contextmanager
def lowered(bench, **lower):
    """Store lower limits, and the former ones again whatever happens, as far as the link allows."""
    kept = bench.lowered = bench.paddle.settings
    _store_held(bench.paddle, changed(kept, **lower))
    try:
        yield
    finally:
        _store_held(bench.paddle, kept)
        bench.lowered = None


def _store_held(paddle, settings):
    """Store settings, and tell the board its position again, if it had one: its running count of the sensor goes on."""
    before, known = paddle.state(), state_flag(paddle.exchange, "HOMED")
    store(paddle, settings)
    moved = paddle.state()["counts"] - before["counts"]
    at = before["x"] + moved * settings.metres_per_count
    if known and settings.travel_min <= at <= settings.travel_max:
        paddle.home(at=at)


@contextmanager
def _speeds_seen(bench):
    """Lengthen the period where a coarse encoder shows no such low speed as a limit, and yield the paddle."""
    paddle, kept = bench.paddle, bench.paddle.T
    slow = math.ceil(1e4 * SEEN * bench.metres_per_count / TRIED_SPEED) * 1e-4
    paddle.T = min(max(kept, slow), max(kept, T_MOST))
    try:
        yield paddle
    finally:
        paddle.T = kept


def _over_speed(bench):
    bench.hold(f"Press Enter, and then flick it to one side within {ACT:g} s.")
    with _speeds_seen(bench) as paddle:
        with bench.pulled():
            fault, run = bench.fault(ACT), bench.ended
        yield from stopped(bench, "over-speed", fault, "OVER_SPEED", run.last_tick, 0, (run.every + 2) * paddle.T)
        step = bench.metres_per_count / paddle.T
    limit = paddle.settings.speed_max
    fastest = float(np.max(np.abs(bench.log.v), initial=0.0)) if fault else math.inf
    # a reading of an angle sensor that is too fast is doubted once: the step after it may be two periods of motion
    most = limit if paddle.settings.sensor == SENSORS["QUADRATURE"] else 2.25 * limit + 8 * step
    source = "the limit, twice where an angle sensor is doubted once, and counts per period"
    yield Finding.of("over-speed", "fastest sample before it", fastest, "m/s", 0, most + step, source)


def _over_travel(bench):
    bench.hold(f"Press Enter, and then move it slowly towards a stop within {ACT:g} s.")
    with bench.pulled() as paddle:
        fault, run = bench.fault(ACT), bench.ended
    yield from stopped(bench, "over-travel", fault, "OVER_TRAVEL", run.last_tick, 0, (run.every + 2) * paddle.T)
    s = paddle.settings
    most = (s.travel_max - s.travel_min) * (0.5 + GIVES) + s.speed_max * paddle.T
    middle = (s.travel_min + s.travel_max) / 2
    furthest = float(np.max(np.abs(bench.log.x - middle), initial=0.0)) if fault else math.inf
    yield Finding.of("over-travel", "furthest sample before it", furthest, "m", 0, most, "the limit, and 1/20 that a stop gives")
