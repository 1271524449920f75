"""Hands by name, each with where its numbers come from, and how a grip changes them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from ...errors import PaddleError
from .hand import Hand, require

ILLUSTRATIVE = "illustrative round numbers, measured on nobody"


@dataclass(frozen=True)
class HandPreset:
    """A hand lumped on the handle, and its source."""

    name: str
    hand: Hand
    posture: str
    source: str

    def __str__(self):
        return f"{self.name}: {self.posture}; {self.hand} ({self.source})"


PRESETS = {
    preset.name: preset
    for preset in (
        HandPreset("pinch", Hand(m=0.02, b=1.0, k=200.0), "thumb and finger, relaxed", ILLUSTRATIVE),
        HandPreset("grip", Hand(m=0.1, b=5.0, k=500.0), "the whole hand around the handle", ILLUSTRATIVE),
        HandPreset(
            "arm", Hand(m=0.554, b=6.45, k=135.0), "arm in a sling, holding a handle, keeping its posture",
            "one trial of one person: van Beek et al., Scientific Reports 5, 18004 (2015), Fig. 3",
        ),
        HandPreset(
            "test bed finger", Hand(m=0.006, k=500.0), "a finger on a plate, without damping",
            "the model of Gillespie and Cutkosky (1996), for a plate of 0.35 kg",
        ),
    )
}  # fmt: skip


def hand(name: str, *, grip: float = 1.0, **changes: Any) -> Hand:
    """Return a hand by name: a second-order model of a grip and posture, with its source in ``hl.hand_presets()``.

    A firmer grip stiffens and damps and leaves the mass as it is (found for a pinched knob by Hasser and Cutkosky, 2002).
    Here stiffness and damping both grow in proportion to ``grip``: the simplest law of that kind, fitted to nobody.
    Identify your own hand where it matters.

    Parameters
    ----------
    name : {"pinch", "grip", "arm", "test bed finger"}
    grip : float
        Times as firm as the preset, > 0.
    **changes
        Of :class:`Hand`, such as push [N] or intent [m].

    Examples
    --------
    >>> print(hand("pinch", grip=2.0, push=1.5))
    m = 0.02 kg, b = 2 N s/m, k = 400 N/m, push = 1.5 N
    """
    if name not in PRESETS:
        raise PaddleError(f"no hand {name!r}; there are {', '.join(PRESETS)}. Others: hl.Hand(m=..., b=..., k=...)")
    grip = require("grip", grip, "times the preset's", "a hand", "It is the firmness beside the preset's.", above=0)
    known = PRESETS[name].hand
    unknown = sorted(set(changes) - set(Hand.__dataclass_fields__))
    if unknown:
        raise PaddleError(f"{unknown[0]} is not of a hand; it has {', '.join(Hand.__dataclass_fields__)}.")
    return replace(known, **{"b": grip * known.b, "k": grip * known.k, **changes})


def hand_presets() -> str:
    """Return the presets as text, a line each: posture, numbers, source.

    Examples
    --------
    >>> print(hand_presets().splitlines()[0])
    pinch: thumb and finger, relaxed; m = 0.02 kg, b = 1 N s/m, k = 200 N/m (illustrative round numbers, measured on nobody)
    """
    return "\n".join(map(str, PRESETS.values()))
