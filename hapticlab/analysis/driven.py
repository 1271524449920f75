"""The part of a motion that follows what drives it: a hand's intent, a tremor, a vibration that a scene makes."""

import numpy as np

from ..device.hand import Hand
from ..errors import AnalysisError

#: samples of memory of the linear part, at most, and one in so many of the record that it may take
MEMORY, SHARE = 400, 8
#: harmonics of the drive that a contact may make, and the lags at which each is looked for
HARMONICS, LAGS = 8, 6


def drive_of(log, driven):
    """Return what drives, one number a sample, from a Hand, a function of t [s], a watched channel's name or an array."""
    if isinstance(driven, Hand):
        if not driven.moves:
            raise AnalysisError(f"driven by a hand with {driven}: it does not move; needs a hand whose intent is a function of t")
        return driven.samples(len(log) - 1, log.T, first=round(log.t[0] / log.T))
    if isinstance(driven, str):
        return np.asarray(getattr(log, driven), float)
    drive = np.asarray(driven(log.t) if callable(driven) else driven, float)
    if drive.shape != log.t.shape or not np.isfinite(drive).all():
        raise AnalysisError(
            f"driven: shape {drive.shape} for {len(log)} samples; needs one finite number a sample, a function of t, a hand or "
            "the name of a watched channel"
        )
    return drive


def following(x, drive):
    """Return the part of the last half of x that follows the drive, by least squares; about its own straight line.

    Linear with a memory of up to an eighth of that half, 400 samples at most, and harmonics of the drive up to the
    eighth, as Chebyshev polynomials of it: a tremor that leaves the wall and comes back makes those.
    """
    half, size = len(x) // 2, float(np.ptp(drive))
    if size == 0:
        raise AnalysisError("driven: the drive is constant; a handle that rests has nothing to follow")
    scaled = 2 * (drive - drive.min()) / size - 1
    memory = min(half // SHARE, MEMORY)
    columns = [scaled[len(x) - half - k : len(x) - k] for k in range(memory)]
    for order in range(2, HARMONICS + 1):
        harmonic = np.cos(order * np.arccos(np.clip(scaled, -1, 1)))
        columns += [harmonic[len(x) - half - k : len(x) - k] for k in range(LAGS)]
    line = np.column_stack([np.ones(half), np.linspace(-1, 1, half)])
    regressors = np.column_stack([line, *columns])
    fitted = np.linalg.lstsq(regressors, x[-half:], rcond=1e-10)[0]
    return regressors[:, 2:] @ fitted[2:]
