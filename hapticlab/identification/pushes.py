"""Pushes of the motor against a hand that holds the handle: weak ones first, to see that somebody does."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import sympy as sp

from ..base.arguments import number
from ..device.board.serial_paddle import SerialPaddle
from ..errors import PaddleError
from ..measurement.leash import leashed
from ..measurement.trials import speed_limit
from ..scene.notation.parameters import parameters
from ..scene.notation.symbols import n, when
from ..scene.scene import Scene
from .paddle import after, given

if TYPE_CHECKING:
    from ..base.telemetry import Telemetry
    from ..device.simulated.simulated_paddle import SimulatedPaddle

#: s that a push lasts, and s from one push to the next: least and most
LASTS, APART = 0.015, (0.45, 0.75)
#: N, how far from where it began the handle may go [m], and how fast [m/s]
FORCE, TRAVEL, SPEED = 1.0, 0.03, 1.0
#: parts of the force that look whether a hand holds the handle: with the first at which it moves and comes back, one does
LOOKS = (1 / 8, 1 / 4, 1 / 2)
#: of its way out, what a handle may be off where it was once it came back
BACK = 0.5
#: encoder counts, below which a handle did not move; s of quiet after a look
STILL, QUIET = 2.5, 0.4


def push_hand(paddle: SimulatedPaddle | SerialPaddle, *, force: float = FORCE, pushes: int = 8, seed: int = 0) -> Telemetry:
    """Push a hand that holds the handle, at unpredictable times and in unpredictable directions, and return the record.

    Further than 30 mm from where it began, or faster than 1 m/s, the motor is off for good. On a board an eighth, a
    quarter and half of the force are tried before, until the handle comes back: a free one is not pushed harder.

    Parameters
    ----------
    paddle : SimulatedPaddle or SerialPaddle
        With a hand at its handle.
    force : float
        Of a push [N], > 0.
    pushes : int
        How many, >= 1.
    seed : int
        Of their times and directions.

    Raises
    ------
    PaddleError
        Where nothing brings the handle back, and where it went too far or too fast.
    """
    force, T = number("force", force, "N", "a push", above=0, error=PaddleError), paddle.T
    if not isinstance(pushes, (int, np.integer)) or isinstance(pushes, bool) or pushes < 1:
        raise PaddleError(f"pushes = {pushes!r}; hl.identify.hand needs a whole number >= 1.")
    if isinstance(paddle, SerialPaddle):
        if paddle.settings is None:
            raise PaddleError("hl.identify.hand: the board has no calibration: run `hapticlab calibrate` first.")
        most = min(paddle.settings.force_continuous, paddle.settings.force_max)
        if force > most:
            raise PaddleError(
                f"hl.identify.hand: force = {force:g} N; the motor can give {most:.3g} N continuously. Give a smaller force."
            )
        _look(paddle, force)
    draws = np.random.default_rng(seed)
    starts = np.cumsum(draws.uniform(*APART, pushes)) / T
    signs = draws.permutation(np.resize([1, -1], pushes))
    return _pushed(paddle, force, starts.astype(int), signs, float(starts[-1] * T + APART[0]))


def _pushed(paddle, force, starts, signs, duration):
    """Return the record of pushes at samples and of signs; raise where the motor was cut."""
    A, length = parameters("A", units="N", values=force), max(2, round(LASTS / paddle.T))
    on = [(sign, (n >= int(at)) & (n < int(at) + length)) for at, sign in zip(starts, signs, strict=True)]
    pushed = sp.S.Zero
    for sign in (-1, 1):  # a single push has one direction
        if during := [one for way, one in on if way == sign]:
            pushed = when(sp.Or(*during), sign * A, pushed)
    fastest = speed_limit(paddle, SPEED)
    scene = leashed(Scene(pushed, name="pushes"), TRAVEL, fastest)
    scene = replace(scene, watch={})  # x and v tell the cut as well; the slowest board has no time for one channel more
    if isinstance(paddle, SerialPaddle):
        log = after(paddle.run(scene, duration=duration, every=1, force_max=force, progress=False), "hl.identify.hand")
        log = replace(log, F=given(paddle, log.F))
    else:
        log = paddle.run(scene, duration=duration, progress=False)
    cut = (abs(log.x - log.x[0]) > TRAVEL) | (abs(log.v) > fastest)
    if cut.any():
        raise PaddleError(
            f"hl.identify.hand: the motor was switched off after {log.t[cut.argmax()]:.3g} s, because a push of {force:.3g} "
            f"N moved the handle further than {1e3 * TRAVEL:.3g} mm from where it began, or faster than {fastest:.3g} m/s. "
            "Hold the handle, or give a smaller force="
        )
    return log


def _look(paddle, force):
    """Raise unless a hand holds the handle: pushed by a part of the force, it comes back. A handle that sticks may."""
    count, way, pushed = abs(paddle.settings.metres_per_count), 0.0, 0.0
    for part, sign in zip(LOOKS, (1, -1, 1), strict=True):
        if 4 * way > TRAVEL:  # twice the force moves a handle with friction four times as far
            break
        length, pushed = max(2, round(LASTS / paddle.T)), part * force
        log = _pushed(paddle, pushed, [2], [sign], (2 + length) * paddle.T + QUIET)
        moved = log.x - log.x[0]
        way = float(abs(moved).max())
        if way > STILL * count and abs(moved[-1]) <= BACK * way + count:
            return
    if way > STILL * count:
        raise PaddleError(
            f"hl.identify.hand: pushed by {pushed:.3g} N for {1e3 * LASTS:g} ms, the handle moved {1e3 * way:.2g} mm and "
            "did not come back. A person must hold the handle in place; a hand without stiffness cannot be identified"
        )
