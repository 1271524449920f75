"""The parts of a recording in which the handle moves by itself: it coasts, or it is thrown against a force."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..base.telemetry import FLAGS, Telemetry, check_record
from ..errors import AnalysisError

#: samples over which a speed is taken, and the fewest that tell something of a motion
OVER, FEWEST = 10, 15
#: a handle that coasts a shorter distance [m], or for fewer samples, tells little
FAR, LONG = 2e-3, 50
#: a hand is taken to be near while the handle is faster than this part of its largest speed
NEAR = 0.8
CURE = "Record, flick the handle harder, release it while it moves, and let it come to rest"


def coasting(log: Telemetry | None) -> Telemetry:
    """The part of a recording in which the free handle coasts, from its fastest point to the end, with x rising from 0.

    Of a recording of ``hl.live`` it takes the longest part in which no hand holds the handle.

    Parameters
    ----------
    log : Telemetry
        Of a handle that was flicked and released, or began with a speed; ``view.log`` of a live view.

    Returns
    -------
    Telemetry
        It begins at t = 0 s and x = 0 m; where the handle moved to the left, x, v and F have changed sign.

    Raises
    ------
    AnalysisError
        If the handle was held throughout, or coasts for less than 2 mm or 50 samples.

    Examples
    --------
    >>> import hapticlab as hl
    >>> paddle = hl.SimulatedPaddle(m=0.03, b=0.1, T=1e-3, coulomb=0.05)
    >>> coast = hl.identify.coasting(paddle.run(hl.wall()(k=0), duration=0.3, v=-0.4))
    >>> round(1e3 * float(coast.x.max())), float(coast.x[0])
    (30, 0.0)
    """
    if log is None:
        raise AnalysisError(f"hl.identify.coasting: nothing was recorded yet. {CURE}")
    check_record(log, "hl.identify.coasting")
    log = _let_go(log)
    if len(log) <= OVER:
        raise AnalysisError(f"hl.identify.coasting: {len(log)} samples without a hand; needs {LONG} or more. {CURE}")
    moved = log.x[OVER:] - log.x[:-OVER]
    fastest = int(np.argmax(np.abs(moved)))
    sign = np.sign(moved[fastest])
    part = _cut(log, slice(fastest + OVER // 2, len(log)), sign)
    far = float(part.x.max())
    lasts = int(np.argmax(part.x > 0.99 * far))
    if far < FAR or lasts < LONG:
        raise AnalysisError(
            f"hl.identify.coasting: the handle coasts {1e3 * far:.2g} mm in {lasts} samples; needs {1e3 * FAR:g} mm and {LONG} "
            f"samples. {CURE}"
        )
    return part


def throw(log: Telemetry) -> tuple[Telemetry, Telemetry]:
    """The rise and the fall of a handle that was thrown to the right, against a constant force to the left.

    The samples near the hand are left out: where the handle is faster than 0.8 of its largest speed on that side.

    Parameters
    ----------
    log : Telemetry

    Returns
    -------
    rise, fall : Telemetry
        Times and positions as in the recording.

    Raises
    ------
    AnalysisError
        If there are fewer than 15 samples of either.

    Examples
    --------
    >>> import hapticlab as hl
    >>> paddle = hl.SimulatedPaddle(m=0.03, b=0.1, T=1e-3)
    >>> push = hl.Scene(hl.parameters("A", units="N", values=0.15))
    >>> rise, fall = hl.identify.throw(paddle.run(push, duration=0.16, v=0.4))
    >>> len(rise), len(fall)
    (49, 59)
    """
    check_record(log, "hl.identify.throw")
    top, moved = int(np.argmax(log.x)), log.x[OVER:] - log.x[:-OVER]
    up, down = moved[: max(top - OVER, 0)], moved[top:]
    first = last = top
    if len(up) and len(down):
        first = np.flatnonzero(up >= NEAR * up.max())[-1] + OVER
        last = top + np.flatnonzero(down <= NEAR * down.min())[0]
    if min(top - first, last - top) < FEWEST:
        raise AnalysisError(
            f"hl.identify.throw: {max(top - first, 0)} samples of rise and {max(last - top, 0)} of fall; needs {FEWEST} of each. "
            "Throw the handle to the right, harder, and catch it only after it has come back"
        )
    return _cut(log, slice(first, top)), _cut(log, slice(top + 1, last))


def _let_go(log):
    """Return the longest part in which the handle is not held, where the recording says who holds it."""
    if "intent" not in log.channels:
        return log
    ends = np.flatnonzero(np.diff(np.r_[0, np.isnan(log.intent), 0])).reshape(-1, 2)
    if not len(ends):
        raise AnalysisError(f"hl.identify.coasting: the handle is held throughout this recording. {CURE}")
    return _cut(log, slice(*max(ends, key=np.ptp)))


def _cut(log, part, sign=None):
    """Return some rows of a recording; with a sign the motion begins at t = 0 and x = 0 and goes that way."""
    flags = {name: getattr(log, name)[part] for name in FLAGS if getattr(log, name) is not None}
    t, x, v, F = (getattr(log, name)[part] for name in ("t", "x", "v", "F"))
    channels = {name: column[part] for name, column in log.channels.items()}
    if sign is not None:
        t, x, v, F, channels = t - t[0], sign * (x - x[0]) + 0.0, sign * v, sign * F, {}
    return replace(log, t=t, x=x, v=v, F=F, channels=channels, changes=(), **flags)
