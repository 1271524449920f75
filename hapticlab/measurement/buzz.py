"""What of a wall's force the hand feels as a buzz: the ripple that is left without the swing of handle and hand."""

from __future__ import annotations

import math

import numpy as np

from ..analysis.records.driven_motion import drive_of, following

#: nobody feels a force that changes faster [Hz]
FASTEST = 1000.0
#: a swing is fitted in pieces of so many cycles and samples at least; in the least that a record must have of it
CYCLES, FEWEST, SAMPLES = 4.0, 2.0, 32


def ripple(log, swing=None, driven=None):
    """Return the amplitude of the force's ripple at the end of a record [N]; nan where it cannot be told.

    It is that of a sinusoid of equal power, below 1 kHz. The mean and the drift of the force are not in it, nor is what
    follows the ``driven`` hand. While the handle swings, the force swings with it on an ideal wall too. So the swing, an
    exponential with the (frequency [Hz], growth [1/s]) given, which are refined, is fitted and subtracted, where the handle
    stays in the wall for long enough to do so.
    """
    from scipy.signal import butter, detrend, sosfiltfilt

    F = np.asarray(log.F, float)
    if FASTEST < 0.5 / log.T:
        F = sosfiltfilt(butter(2, FASTEST, fs=1 / log.T, output="sos"), F)
    last = F[-(len(F) // 2) :]
    if driven is not None and np.ptp(F) > 0:
        last = last - following(F, drive_of(log, driven))
    if swing is None:
        return _amplitude(detrend(last[len(last) // 2 :]))
    outside = np.flatnonzero(np.asarray(log.F)[-len(last) :] == 0)
    inside = last[outside[-1] + 1 if len(outside) else 0 :]
    cycles = len(inside) * log.T * (swing[0] or 0.0)
    if cycles < FEWEST or len(inside) < SAMPLES:
        return math.nan
    pieces = np.array_split(inside, max(1, int(min(cycles / CYCLES, len(inside) / SAMPLES))))
    return _amplitude(np.concatenate([_without_swing(piece, *swing, log.T) for piece in pieces]))


def _amplitude(y):
    return math.sqrt(2 * float(np.mean(y**2)))


def _without_swing(F, frequency, growth, T):
    """Return a force less its straight line and one exponential swing, whose rate and frequency are fitted."""
    from scipy.optimize import least_squares

    n = np.linspace(-1, 1, len(F))
    half = len(F) * T / 2

    def left(rates):
        wave = np.exp((rates[0] + 1j * rates[1]) * n)
        columns = np.c_[np.ones(len(F)), n, wave.real, wave.imag]
        return F - columns @ np.linalg.lstsq(columns, F, rcond=None)[0]

    growth = growth if math.isfinite(growth) else 0.0
    return left(least_squares(left, [growth * half, 2 * math.pi * frequency * half], method="lm", max_nfev=60).x)
