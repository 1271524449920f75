"""Identify the hand that holds the handle, as a mass, a damper and a spring, from how it yields to pushes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from ..base.telemetry import Telemetry, check_record
from ..device.board.serial_paddle import SerialPaddle
from ..device.hand.hand import Hand
from ..device.simulated.simulated_paddle import SimulatedPaddle
from ..errors import AnalysisError
from .fit_result import Found, told
from .hand_motion import hand_positions
from .known_handle import KnownHandle, widened
from .paddle import counts_per_metre_of
from .pushes import FORCE, push_hand
from .scoring import fit
from .start import heading

if TYPE_CHECKING:
    from ..base.annotations import File
    from ..base.profile.paddle_profile import PaddleProfile

#: s that a hand is taken not to react; a stretch reflex begins after 25 to 50 ms, the will after 100 and more
WINDOW = 0.06
#: s of rest before a push that a window takes in
BEFORE = 0.02
#: what is sought, and parts of its first values that a fit may begin with; stiffnesses [N/m] where friction hides it
SOUGHT = ("m", "b", "k")
PARTS = tuple((m, b) for m in (1.0, 0.7, 1.3) for b in (1.0, 0.7, 0.4))
STIFF = (60.0, 120.0, 240.0, 480.0, 960.0, 1920.0)


@dataclass(frozen=True, eq=False)
class HandFit(Found):
    """Mass, damping and stiffness of a hand; ``found["k"]`` is an Estimate. Print it, or plot what it left."""

    about = "hand"
    lacking = "a reflex within the window, tremor, a grip that changes or slips"
    advice = "harder pushes in both directions on a hand that holds still (hl.identify.pushes does this)"
    above = ()
    bounded = ("m", "b", "k")
    constants: ClassVar = {"m": ("mass", "kg"), "b": ("viscous damping", "N s/m"), "k": ("stiffness", "N/m")}

    def hand(self, **changes: Any) -> Hand:
        """A Hand with what was found; a value below zero within its interval becomes zero."""
        return Hand(**{**{name: max(self[name].value, 0.0) for name in ("m", "b", "k")}, **changes})

    def __str__(self) -> str:
        m, b, k = (self[name].value for name in ("m", "b", "k"))
        lines = [super().__str__()]
        if m > 0 and k > 0:
            lines.append(
                f"  alone it oscillates at {np.sqrt(k / m) / 2 / np.pi:.3g} Hz, damping ratio {b / 2 / np.sqrt(k * m):.2g}"
            )
        return "\n".join(lines)


def identify_hand(
    source: Telemetry | SimulatedPaddle | SerialPaddle,
    device: PaddleProfile | SimulatedPaddle | SerialPaddle | File | None = None,
    *,
    window: float = WINDOW,
    force: float = FORCE,
    pushes: int = 8,
    seed: int = 0,
    counts_per_metre: float | None = None,
    confidence: float = 0.95,
) -> HandFit:
    """The second-order model of the hand on a handle, from its responses to pushes, each before the hand can react.

    (m_device + m) x'' = -F - b_device x' - coulomb sign(x') - b x' - k (x - rest). Valid for some 30 to 60 ms after
    each push: then reflexes, later intent, and the hand is another one. ``explained`` says whether the model does.

    Parameters
    ----------
    source : Telemetry or Paddle
        A record with ``F`` zero but for pushes; or a paddle, which then pushes the hand that holds it, at random times:
        on a board weaker first, until the handle is seen to come back (:func:`push_hand`).
    device : PaddleProfile, paddle, or a name or file of hl.devices.profile, optional
        What is known of the handle alone: m, b, coulomb and the delay from sensor to force. :func:`identify_paddle`
        finds them from a free handle. If the delay of a profile was not identified, the record says how long the
        computation took. By default the paddle itself.
    window : float
        How long after the begin of a push the hand is taken not to react [s].
    force : float
        Of a push [N].
    pushes, seed : int
        How many, and what draws their times and directions.
    counts_per_metre : float, optional
        Of the encoder [1/m]; a paddle knows its own.
    confidence : float
        Of the intervals. They contain those of the handle's constants, as far as the estimate depends on these, and take
        the intervals of a profile as those of the same confidence.

    Returns
    -------
    HandFit

    Raises
    ------
    AnalysisError
        If the record has no push, or the mass of the handle is not known.

    Examples
    --------
    >>> import hapticlab as hl
    >>> pinch = hl.Hand(m=0.02, b=1, k=200)
    >>> found = hl.identify.hand(hl.SimulatedPaddle(m=0.03, b=0.1, T=1e-3, noise=2e-6, hand=pinch), pushes=2)
    >>> 0.02 in found["m"], 1.0 in found["b"], 200.0 in found["k"]
    (True, True, True)
    """
    if isinstance(source, (SimulatedPaddle, SerialPaddle)):
        device = source if device is None else device
        counts_per_metre = counts_per_metre_of(source) if counts_per_metre is None else counts_per_metre
        source = push_hand(source, force=force, pushes=pushes, seed=seed)
    check_record(source, "hl.identify.hand")
    handle, windows = KnownHandle.of(device, source), _windows(source, window)
    quantum = 0.0 if counts_per_metre is None else 1 / abs(counts_per_metre)
    y = np.concatenate([source.x[a:b] for a, b in windows])
    start, scales = _start(source, windows, handle)
    low = np.where(np.arange(len(start)) < len(SOUGHT), 0.0, -np.inf)
    starts = [np.stack([start, *_guesses(start, source.x, windows)], axis=1)[:, :, None], start[:, None, None]]
    held = round(BEFORE / source.T) if handle.coulomb else 0

    def motion(handle):
        return _motion(source, windows, handle, held)

    fitted = fit(motion(handle), y[:, None], starts, lambda p: scales[:, None], quantum=quantum, low=low)
    fitted = widened(fitted, y[:, None], motion, scales[:, None], handle, confidence)
    return told(HandFit, y, fitted, SOUGHT, quantum=quantum, T=source.T, confidence=confidence)


def _guesses(start, x, windows):
    """Yield starts with parts of its m and b, other k, and the hand at rest where the handle was pushed, or about the middle."""
    each = (len(start) - len(SOUGHT)) // len(windows)
    for middle in (None, np.median(x)):
        guess = start.copy()
        guess[len(SOUGHT) :: each] = [x[a] if middle is None else middle for a, _ in windows]
        for k in (start[2], *STIFF):
            for m, b in PARTS:
                guess[: len(SOUGHT)] = start[0] * m, start[1] * b, k
                yield guess.copy()


def _windows(log, window):
    """(first, stop) of each push with what comes before it and until a hand may react."""
    on = np.flatnonzero((log.F[1:] != 0) & (log.F[:-1] == 0)) + 1
    before, long = round(BEFORE / log.T), round(window / log.T)
    found, free = [], 0
    for at in on:
        if at - before >= free and at + long <= len(log):
            found.append((at - before, at + long))
            free = at + long
    if not found:
        raise AnalysisError(
            f"hl.identify.hand: no push in {len(log)} samples with {BEFORE:g} s of F = 0 before it and {window:g} s after "
            "its beginning. Run hl.identify.pushes(paddle), or a scene whose force is 0 N apart from short pushes"
        )
    return found


def _motion(log, windows, handle, held):
    """The model: m, b, k of the hand, then the resting place, x and v at the begin of each window.

    A handle with friction is held by it before a push, for so many samples, wherever within the friction's reach the hand
    would rest: it stays at x until the push, and has no v.
    """

    def motion(p):
        body = {"m": handle.m + p[0], "b": handle.b + p[1], "k": p[2], "coulomb": handle.coulomb, "delay": handle.delay}
        begun, found = iter(p[3:]), []
        for a, z in windows:
            rest, x0 = next(begun), next(begun)
            v0 = 0.0 if held else next(begun)
            found += [x0[None]] * held
            found.append(hand_positions(log.F[a + held : z], log.T, **body, rest=rest, x0=x0, v0=v0))
        return np.concatenate(found)

    return motion


def _start(log, windows, handle):
    """First values and scales: the equation of motion integrated twice, least squares in every window."""
    T, told = log.T, []
    lag = round(handle.delay / T)
    for a, z in windows:
        y, t = log.x[a:z] - log.x[a], np.arange(z - a) * T
        felt = np.concatenate([np.zeros(lag), log.F[a : z - lag]]) + handle.coulomb * heading(y, 0.0)
        once = [np.cumsum(values) * T for values in (y, felt)]
        columns = [np.ones_like(t), t, t**2, -once[0], -np.cumsum(once[0]) * T, -np.cumsum(once[1]) * T]
        A = np.column_stack(columns)
        size = np.linalg.norm(A, axis=0) + 1e-300
        told.append((np.linalg.lstsq(A / size, y, rcond=1e-9)[0] / size)[3:])
    damping, stiffness, mobility = np.median(told, axis=0)
    m = 1 / max(mobility, 1e-3)
    hand = np.array([m - handle.m, damping * m - handle.b, stiffness * m])
    hand = np.maximum(hand, [0.01 * handle.m, 0.0, 1.0])
    moved = np.ptp(log.x)
    count = 2 if handle.coulomb else 3
    begun = [value for a, _ in windows for value in (log.x[a], log.x[a], 0.0)[:count]]
    scales = (moved, moved, moved / WINDOW)[:count] * len(windows)
    return np.array([*hand, *begun]), np.array([0.1 * m, 1.0, 100.0, *scales])
