"""The part of a motion that follows what drives it: a hand's intent, a tremor, a vibration that a scene makes."""

import numpy as np

from ...device.hand.hand import Hand
from ...errors import AnalysisError

#: samples of memory of the linear part, at most, and one in so many of the record that it may take
MEMORY, SHARE = 120, 8
#: harmonics of the drive that a contact may make, and the lags at which each is looked for
HARMONICS, LAGS = 8, 4
#: order of the linear loop that is looked for where no finite memory is long enough: handle, law and delay
ORDER = 6


def drive_of(log, driven):
    """The drive, one number a sample, from a Hand, a function of t [s], a watched channel's name or an array."""
    if isinstance(driven, Hand):
        if not driven.moves:
            raise AnalysisError(
                f"driven by a hand with {driven}, which does not move; needs a hand whose intent is a function of t"
            )
        return driven.samples(len(log) - 1, log.T, first=round(log.t[0] / log.T))
    if isinstance(driven, str):
        return np.asarray(getattr(log, driven), float)
    drive = np.asarray(driven(log.t) if callable(driven) else driven, float)
    if drive.shape != log.t.shape or not np.isfinite(drive).all():
        raise AnalysisError(
            f"driven: shape {drive.shape} for {len(log)} samples; needs one finite number per sample, a function of t, a "
            "hand or the name of a watched channel"
        )
    return drive


def following(x, drive):
    """Return the part of the last half of x that follows the drive: the better of two descriptions, by what they leave.

    Of a finite memory (:func:`by_memory`), which harmonics may belong to; or of a stable linear loop of sixth order
    (:func:`by_loop`), whose resonance may remember for long.
    """
    size, half = float(np.ptp(drive)), len(x) // 2
    if size == 0:
        raise AnalysisError("driven: the drive is constant, so the handle has no excitation to follow; give a drive that changes")
    scaled = 2 * (drive - drive.min()) / size - 1
    found = [part for part in (by_memory(x, scaled), by_loop(x, scaled)) if part is not None]
    return min(found, key=lambda part: np.std(x[-half:] - part))


def by_memory(x, drive):
    """Return the part of the last half of x that is a sum over past samples of the drive, -1 to 1, and its harmonics.

    The memory is an eighth of that half, 120 samples at most; harmonics are up to the eighth, as Chebyshev polynomials
    of the drive: a tremor that leaves the wall and comes back makes those.
    """
    half = len(x) // 2
    columns = [drive[len(x) - half - k : len(x) - k] for k in range(min(half // SHARE, MEMORY))]
    for order in range(2, HARMONICS + 1):
        harmonic = np.cos(order * np.arccos(np.clip(drive, -1, 1)))
        columns += [harmonic[len(x) - half - k : len(x) - k] for k in range(LAGS)]
    line = np.column_stack([np.ones(half), np.linspace(-1, 1, half)])
    regressors = np.column_stack([line, *columns])
    fitted = np.linalg.lstsq(regressors, x[-half:], rcond=1e-10)[0]
    return regressors[:, 2:] @ fitted[2:]


def by_loop(x, drive):
    """Response of a linear loop to the drive in the last half, from rest at its first sample; None if unstable.

    x[n] = a_1 x[n-1] + ... + b_0 d[n] + ... by least squares; its own past then comes from the model alone.
    """
    first = len(x) // 2

    def lags(signal, low, high):
        return np.column_stack([signal[first - k : len(x) - k] for k in range(low, high + 1)])

    y = x - x[first:].mean()
    regressors = np.column_stack([lags(y, 1, ORDER), lags(drive, 0, ORDER), np.ones(len(x) - first)])
    fitted = np.linalg.lstsq(regressors, y[first:], rcond=1e-13)[0]
    a, b = fitted[:ORDER], fitted[ORDER:-1]
    if abs(np.roots(np.r_[1, -a])).max() > 1 - 4 / len(x):
        return None
    forced, made = np.convolve(drive - drive.mean(), b)[: len(x)], np.zeros(len(x) + ORDER)
    for n, push in enumerate(forced.tolist()):
        made[n + ORDER] = push + a @ made[n + ORDER - 1 : n - 1 if n else None : -1]
    return made[ORDER + first :]
