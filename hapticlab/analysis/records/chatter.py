"""Chatter: is there a sustained oscillation, how large, how fast, and has it settled."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ...base.telemetry import check_record
from ...errors import AnalysisError
from .chatter_end import swings_of
from .chatter_findings import Chatter
from .chatter_inside import inside
from .chatter_signs import (
    around_trend,
    contact_rate,
    leaves_its_drive,
    levels_off,
    runs_away,
    scatter,
    sinks_to_counts,
    strength,
    upward_crossings,
)
from .chatter_wall import OfTheWall, of_the_wall
from .driven_motion import drive_of, following

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike

    from ...base.annotations import Array
    from ...base.telemetry import Telemetry
    from ...device.hand.hand import Hand

#: amplitudes of the last two quarters within this ratio count as one sustained oscillation
LOCK = 0.01
#: fewer cycles in a quarter of the record than this do not tell a sustained oscillation from a growing one
CYCLES = 3
#: swings that differ by less are the same, turning points being located between samples
SAME = 5e-4
#: samples, below which a quarter of a record says nothing
SHORTEST = 32
#: a motion that turns round less often than this in the last half is no oscillation
REVERSALS = 2
#: what is left of a driven motion is its own below this part of it
FOLLOWS = 0.02
#: a handle that turned round once, and in the last quarter moves by more than this part of all its way, does not rest
RESTS = 0.01
#: a cycle repeats itself where it comes back within this part of its amplitude; it is looked for up to so many samples
REPEATS, LONGEST_CYCLE = 1e-4, 2000


def chatter(log: Telemetry, driven: Hand | Callable[[Array], ArrayLike] | str | ArrayLike | None = None) -> Chatter:
    """Find chatter, Section 23.4: sustained oscillation, often with repeated contact with the wall.

    The last half of a record is examined, and the position of the handle itself (``x_true``) if an encoder or noise
    hides it. An oscillation reverses at least twice in that half and is larger than a nanometre, a millionth of the
    travel, and single precision. It is called sustained if a quarter of the record has at least three cycles. If the
    handle leaves the wall, or the motor is at its limit, a constant plus an exponential is fitted to the amplitudes and
    shows whether they end in a cycle or at rest; a record that leaves both possible is "undecided". Motion that is
    driven by a hand's noise or moving intent, or by a vibration in the scene, looks like chatter unless ``driven``
    names the drive; the component that follows the drive is then subtracted. Chatter that has locked onto the frequency of its
    drive, or onto a harmonic of it up to the eighth, cannot be distinguished from the drive and is regarded as driven.

    Without ``x_true`` the record of a resting handle contains only the noise of the sensor: a signal that is white at
    every lag up to 40 samples is not chatter, and chatter below 0.6 standard deviations of that noise is not found.

    Parameters
    ----------
    log : Telemetry
        Uses t [s], x [m], F [N] and, where recorded, x_true [m]; at least 32 samples.
    driven : Hand, callable, str or array, optional
        The drive: a hand with a moving intent, a function of an array of times [s], the name of a watched channel, or
        one number per sample. Its size and unit do not matter.

    Returns
    -------
    Chatter

    Raises
    ------
    AnalysisError
        For a record that is too short or not finite.

    Examples
    --------
    >>> import numpy as np
    >>> from hapticlab.base.telemetry import Telemetry
    >>> t = np.arange(2000) * 1e-3
    >>> x = 1e-3 * np.sin(2 * np.pi * 20 * t)
    >>> found = chatter(Telemetry(t=t, x=x, v=0 * t, F=np.maximum(100 * x, 0), T=1e-3))
    >>> found.state, round(found.frequency, 2), round(found.contacts_per_second)
    ('chatter', 20.0, 20)
    """
    check_record(log, "chatter")
    return replace(_found(log, driven), record=log)


def _found(log, driven):
    """The chatter of the last half of a record."""
    t, x, F = (np.asarray(a, float) for a in (log.t, log.channels.get("x_true", log.x), log.F))
    if len(t) < SHORTEST:
        raise AnalysisError(f"the record has {len(t)} samples; chatter needs at least {SHORTEST}. Run longer")
    if not (np.isfinite(x).all() and np.isfinite(F).all()):
        raise AnalysisError(f"the record contains values that are not finite; fault: {log.fault or 'none recorded'}")
    half, quarter = len(t) // 2, len(t) // 4
    contacts = contact_rate(F[-half:], log.T)
    rest, travel = float(x[-quarter:].mean()), float(np.ptp(x[-quarter:]))
    least = max(1e-9, 1e-6 * np.ptp(x), 4 * np.finfo(np.float32).eps * abs(x).max())
    size = 0.0

    def still(state, scatter=0.0, amplitude=0.0, growth=0.0, inner=math.nan):
        found = (None, size, math.nan, scatter, False, None, None, travel / 2 if amplitude else 0.0, inner)
        return Chatter(state, amplitude, None, contacts, growth, False, False, rest, travel, *found)

    whole = float(np.ptp(x))
    if driven is not None:
        drive = drive_of(log, driven)
        if leaves_its_drive(x, drive, quarter):
            return still("runaway")
        follows = following(x, drive)
        size, x = float(np.ptp(follows)) / 2, x[-half:] - follows
        if strength(x) < max(least, FOLLOWS * strength(follows)):
            return still("driven")
    turns = _reversals(x[-half:])
    if turns == 1 and travel > RESTS * whole and not size and strength(x[-quarter:]) >= least:
        inner = inside(x[-half:], F[-half:]).growth if np.all(F[-quarter:] != 0) else math.nan
        state = "decaying" if inner < 0 else "growing" if inner > 0 else "undecided"
        return still(state, 0.0, float(np.ptp(x[-half:]) / 2), math.nan, inner / log.T)
    if strength(x[-quarter:]) < least or turns < REVERSALS:
        return still("runaway" if runs_away(x, quarter) else "none")
    y, _ = around_trend(x[-half:])
    if "x_true" not in log.channels and len(np.unique(log.x[-half:])) > 2 and (noise := scatter(y)):
        return still("none", noise)
    crossings = upward_crossings(y) * log.T
    frequency = float((len(crossings) - 1) / (crossings[-1] - crossings[0])) if len(crossings) > 1 else None
    clipped = bool(log.saturated is not None and np.any(log.saturated[-half:]))
    state, locked, ratio, uneven = _by_quarters(x[-half:], y, log.x[-half:], len(crossings), least)
    wall = OfTheWall(state, locked)
    if np.ptp(x[-(quarter // 4) :]) < least:  # it has come to rest
        wall = OfTheWall("decaying", False)
    elif driven is None:
        wall = of_the_wall(state, locked, x[-half:], F[-half:], log, clipped)
    state, locked, ends = wall.state, wall.locked, wall.ends
    dither, amplitude = len(np.unique(log.x[-half:])) == 2, float(np.ptp(y) / 2)
    period = cycle_length(x[-half:], amplitude) if locked else None
    growth, error = ratio / (quarter * log.T), uneven / (quarter * log.T)
    slower = state == "decaying" and (clipped or levels_off(_amplitudes(x[-half:], y, len(crossings)))) and ends is None
    slower = slower and math.isnan(wall.growth)
    longer = 2 * len(log.t) * log.T if state == "undecided" else None
    last = len(x) // 8 if frequency is None else min(half, math.ceil(1 / (frequency * log.T)) + 1)
    found = (period, size, error, 0.0, slower, ends, longer, float(np.ptp(x[-last:]) / 2), wall.growth / log.T)
    return Chatter(state, amplitude, frequency, contacts, growth, locked, dither, rest, travel, *found)


def _by_quarters(x, y, sensed, cycles, least):
    """The state by the two quarters of x, whether it has settled, the logarithm of their ratio and its standard error."""
    quarter = len(x) // 2
    if cycles <= 2 * CYCLES:
        state, ratio = _compare_swings(x, quarter)
        return state, False, ratio, math.nan
    ratio = math.log(strength(x[-quarter:]) / max(strength(x[-2 * quarter : -quarter]), least * 1e-3))
    uneven, falls = _irregularity(y)
    even = abs(ratio) < LOCK
    locked = even or (abs(ratio) < 2 * uneven and not falls and not sinks_to_counts(y, sensed))
    return "chatter" if locked else "growing" if ratio > 0 else "decaying", locked, ratio, uneven


def _amplitudes(x, y, cycles):
    """Return amplitudes one after the other: of four windows that hold three cycles each, or else of every swing."""
    size = len(y) // 4
    if cycles > 4 * CYCLES:
        return [strength(y[i * size : (i + 1) * size]) for i in range(4)]
    return swings_of(x)[1]


def cycle_length(x, amplitude):
    """Return the samples after which x repeats itself, three times over at least, or None."""
    for p in range(2, min(len(x) // 4, LONGEST_CYCLE) + 1):
        if abs(x[-1] - x[-1 - p]) < REPEATS * amplitude and abs(x[p:] - x[:-p])[-3 * p :].max() < REPEATS * amplitude:
            return p
    return None


def decaying(largest, least_before, largest_before):
    """Tell whether swings die out, from those of the last quarter and of the one before it.

    However slow a decay, all of the last quarter lie below all of the one before; where the difference is too small to
    be seen in neighbours, the largest lies at the bottom of the range before it, by 1 % in all. No limit cycle does
    that, regular or not. Where a beat hides a decay, the largest has lost a third.
    """
    bottom = least_before + 0.05 * (largest_before - least_before)
    slow = (largest <= bottom) & (largest < (1 - LOCK) * largest_before)
    return (largest < (1 - SAME) * least_before) | slow | (largest < 2 / 3 * largest_before)


def _compare_swings(x, quarter):
    """The state that a few swings show, and the logarithm of the ratio of the largest of the last two quarters."""
    ends, swings = swings_of(x)
    last = swings[ends >= len(x) - quarter]
    before = swings[(ends < len(x) - quarter) & (ends >= len(x) - 2 * quarter)]
    if not (len(last) and len(before)):
        return "undecided", math.nan
    ratio = math.log(last.max() / before.max())
    if decaying(last.max(), before.min(), before.max()):
        return "decaying", ratio
    return ("growing" if last.min() > (1 + SAME) * before.max() else "undecided"), ratio


def _reversals(x):
    """Number of turns of the handle; standing still between is no turn."""
    moves = np.sign(np.diff(x))
    moves = moves[moves != 0]
    return int(np.count_nonzero(moves[1:] != moves[:-1]))


def _irregularity(y):
    """Return the standard error of the logarithm of the amplitude's ratio between the two halves of y, and whether it falls.

    Four windows, a straight line through the logarithms of their amplitudes: exponential growth lies on it, the ups and
    downs of an irregular limit cycle (encoder, friction, contacts between samples) do not. An amplitude falls where
    each window has less than the one before, as friction makes it do, faster and faster.
    """
    size = len(y) // 4
    logs = np.log([strength(y[i * size : (i + 1) * size]) + 1e-300 for i in range(4)])
    at = np.array([-0.75, -0.25, 0.25, 0.75])  # so that the slope is the change from one half to the other
    slope = (at @ logs) / (at @ at)
    residual = logs - logs.mean() - slope * at
    return math.sqrt((residual @ residual) / 2 / (at @ at)), bool(np.all(np.diff(logs) < -LOCK))
