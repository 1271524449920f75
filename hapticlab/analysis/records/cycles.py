"""How fast a recorded quantity oscillates, from its upward crossings."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...base.arguments import number
from ...base.telemetry import check_record
from ...errors import AnalysisError

if TYPE_CHECKING:
    from ...base.telemetry import Telemetry

#: times the shortest cycle that the longest one of one oscillation may take
UNEVEN = 3.0


def frequency(log: Telemetry, name: str = "x", *, begin: float = 0.0) -> float:
    """Frequency [Hz] of a recorded oscillation: its cycles from the first to the last upward crossing of its mean.

    A crossing counts where the oscillation rises from half a standard deviation below the mean to half of one above it, so that
    noise about the mean adds none (O. H. Schmitt, A thermionic trigger, J. Sci. Instrum. 15, 1938). The crossings are
    interpolated between samples; an oscillation faster than a third of the sampling rate may lack some. The mean is that of the
    part from ``begin`` on, which should hold several cycles about a resting position. :func:`hapticlab.chatter` tells chatter
    of a wall from decay and from driven motion.

    Parameters
    ----------
    log : Telemetry
    name : str
        Of what was recorded: ``"x"``, ``"F"``, a watched state.
    begin : float
        Time after the start of the record from which on it is used [s], such as when the hand rests; or a text, "500 ms".

    Returns
    -------
    float

    Raises
    ------
    AnalysisError
        For a name that was not recorded, for a value that is not finite, for fewer than two upward crossings or three samples
        per cycle, and for cycles of which one takes more than three times as long as another: noise, or no oscillation.

    Examples
    --------
    >>> import numpy as np
    >>> from hapticlab.base.telemetry import Telemetry
    >>> t = np.arange(0, 2, 1e-3)
    >>> x = 0.01 * np.sin(2 * np.pi * 3 * t)
    >>> round(frequency(Telemetry(t=t, x=x, v=0 * t, F=0 * t, T=1e-3)), 3)
    3.0
    """
    check_record(log, "frequency", whole=False)
    if name not in log.columns:
        raise AnalysisError(
            f"{name} was not recorded; this log has {', '.join(log.columns)}. Watch it: hl.Scene(..., watch=[...])"
        )
    used = log.t >= number("begin", begin, "s", "frequency") + (log.t[0] if len(log) else 0.0)
    t, y = log.t[used], np.asarray(getattr(log, name), float)[used]
    if not np.isfinite(y).all():
        wrong = np.flatnonzero(~np.isfinite(y))
        raise AnalysisError(
            f"frequency of {name}: {name} = {y[wrong[0]]} at t = {t[wrong[0]]:.6g} s; a frequency needs finite values. "
            "Begin after that time, or record again."
        )
    crossings = _upward(t, y - y.mean()) if len(y) else []
    if len(crossings) < 2:
        raise AnalysisError(
            f"frequency of {name}: the record has {len(crossings)} upward crossing(s) of its mean and a frequency needs two. "
            "Record more cycles, and hold still while it oscillates."
        )
    cycles = np.diff(crossings)
    if cycles.max() > UNEVEN * cycles.min():
        raise AnalysisError(
            f"frequency of {name}: its cycles take {1e3 * cycles.min():.3g} to {1e3 * cycles.max():.3g} ms; a frequency needs "
            "cycles that are about equally long. Noise or a moving hand makes them unequal: hold still, or choose begin=."
        )
    if cycles.mean() < 3 * np.diff(t).mean():
        raise AnalysisError(
            f"frequency of {name}: fewer than three samples per cycle of {1e3 * cycles.mean():.3g} ms; some crossings may be "
            "missing. Record with a shorter sampling period."
        )
    return float(1 / cycles.mean())


def _upward(t, y):
    """Return the times at which y, of mean 0, crosses zero on its way from low to high."""
    level = 0.5 * y.std()
    outside = np.flatnonzero(abs(y) > level)
    high = y[outside] > 0
    arrived = outside[1:][high[1:] & ~high[:-1]]
    rising = np.flatnonzero((y[:-1] < 0) & (y[1:] >= 0))
    before = rising[np.searchsorted(rising, arrived) - 1]  # the last one before y is high
    return t[before] - y[before] * (t[before + 1] - t[before]) / (y[before + 1] - y[before])
