"""The ball of lab 08 can be kept up by eye: a hand that sees late and strikes unevenly, as a person with a mouse does."""

import re
from pathlib import Path

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.course.notebook import code_of, read
from hapticlab.widgets.session import Session

LAB = code_of(read(Path(__file__).parents[2] / "labs/08_contact/08_contact.ipynb"))
SLOW, LATE, STROKE, LASTS = 0.2, 0.15, 0.010, 0.35  # slow motion; s that a hand sees late; its stroke [m], and its time [s]


def view_of_the_lab():
    """Return the scene of the lab's last view, and how slowly it runs."""
    cell = next(code for code in LAB if "time_scale" in code and "light" in code)
    names = {"hl": hl, "balls": {"impulse": hl.library.ball_on_the_paddle(hl.contact.impulse(e=0.8))}}
    exec(re.search(r"^light = .*$", cell, re.M)[0], names)
    return names["light"], float(re.search(r"time_scale=([0-9.]+)", cell)[1])


@pytest.mark.wide
@pytest.mark.parametrize("seed", range(3))
def test_one_stroke_a_flight_keeps_the_ball_up(seed):
    ball, speed = view_of_the_lab()
    assert speed == SLOW
    hand, now, seen = np.random.default_rng(seed), [10.0], []
    paddle = hl.SimulatedPaddle.from_profile("hapkit", hand=hl.Hand("grip"))
    session = Session(paddle, ball, speed=speed, clock=lambda: now[0], in_thread=False, method="taylor")
    session.ready("page")
    session.turn()
    session.press("record")
    struck, early = None, 0.25
    while now[0] < 24.0:
        now[0] += 1 / 60
        session.alive("page")
        known = session.motion.values()
        seen.append((now[0], known.get("y", 0.06) - known.get("z", 0.0)))
        if struck is None and _arrives(seen, now[0]) < early:
            struck = now[0]
        part = 0.0 if struck is None else (now[0] - struck) / LASTS
        session.intend(STROKE * (1 - np.cos(np.pi * min(part, 2.0))) / 2)
        if part > 2.2:
            struck, early = None, 0.25 + 0.05 * hand.standard_normal()
        session.turn()
    log = session.recorded()
    low = np.flatnonzero((log.y[1:-1] < log.y[:-2]) & (log.y[1:-1] <= log.y[2:])) + 1
    heights = [1e3 * np.ptp(log.y[a : b + 1]) for a, b in zip(low[:-1], low[1:], strict=True)]
    assert len(heights) >= 10 and min(heights[:10]) > 15, np.round(heights)  # one that falls alone: 34, 17, 9, 5, 3 mm


def _arrives(seen, now):
    """Return in how many seconds of the clock a hand expects the ball, from what it saw a moment ago."""
    past = [one for one in seen if one[0] <= now - LATE][-2:]
    if len(past) < 2:
        return np.inf
    (t_0, gap_0), (t_1, gap) = past
    v = (gap - gap_0) / (t_1 - t_0) / SLOW
    if v >= 0:
        return np.inf
    return (v + np.sqrt(v**2 + 2 * 9.81 * max(gap, 0.0))) / 9.81 / SLOW - LATE
