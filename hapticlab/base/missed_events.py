"""What a run left out: events that were not located, and bodies that ended inside each other."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..errors import MissedEventWarning
from .unusual import warn_at_own_line

if TYPE_CHECKING:
    from .telemetry import Telemetry

#: depth [m or rad] from which bodies are said to be inside each other; rounding of bodies at rest stays below 1e-8
DEPTH = 1e-5


def warn_of_missed(log: Telemetry) -> Telemetry:
    """Return the record of a run; warn, at the user's own line, where it left events out."""
    if words := missed_words(log):
        warn_at_own_line(words, MissedEventWarning)
    return log


def missed_words(log: Telemetry) -> str:
    """Say what a run left out, when first, how deep bodies are inside each other, and what to do; "" where nothing was.

    Examples
    --------
    >>> from hapticlab.base.telemetry import Telemetry
    >>> still = {name: [0.0, 0.0] for name in ("x", "v", "F")}
    >>> missed_words(Telemetry(t=[0, 1e-3], **still, T=1e-3, channels={"unlocated": [0, 1]}))
    '1 of 2 samples left an event unlocated, the first at t = 0.001 s. The motion may be wrong after that. Locate more \
events per step, method=hl.methods.Taylor(events=8), or use a shorter T.'
    """
    none = np.zeros(len(log))
    missed, overlap = log.channels.get("unlocated", none) > 0, log.channels.get("overlap", none)
    if not missed.any() and not ends_inside(log):
        return ""
    deep, said, cure = overlap > DEPTH, [], "Locate more events per step, method=hl.methods.Taylor(events=8), or use a shorter T"
    if missed.any():
        first = log.t[np.argmax(missed)]
        said.append(f"{np.count_nonzero(missed)} of {len(log)} samples left an event unlocated, the first at t = {first:g} s")
    if deep.any():
        first, most, last = log.t[np.argmax(deep)], np.nanmax(overlap), overlap[-1]
        depths = f"{depth_words(log, most)} at most and by {depth_words(log, last)} at the end"
        said.append(f"From t = {first:g} s bodies overlapped, by {depths}")
    said.append("The motion may be wrong after that")
    said.append(f"{cure}, or use a contact that yields, hl.contact.penalty" if "overlap" in log.channels else cure)
    return f"{'. '.join(said)}."


def ends_inside(log: Telemetry) -> bool:
    """Whether bodies with located contacts are inside each other at the end of a run."""
    return bool(len(log) and "overlap" in log.channels and log.overlap[-1] > DEPTH)


def depth_words(log: Telemetry, depth: float) -> str:
    """A depth with its unit: [mm], or [rad] where joints went past their stops."""
    return f"{depth:.3g} rad" if log.units["overlap"] == "rad" else f"{1e3 * depth:.3g} mm"
