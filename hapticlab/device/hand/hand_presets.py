"""Hands by name, each with where its numbers come from."""

from __future__ import annotations

from dataclasses import dataclass

ILLUSTRATIVE = "illustrative round numbers, not measured"


@dataclass(frozen=True)
class HandPreset:
    """A hand lumped on the handle: mass [kg], damping [N s/m], stiffness [N/m], its posture, and the source."""

    m: float
    b: float
    k: float
    posture: str
    source: str

    def __str__(self):
        damping = f", b = {self.b:g} N s/m" if self.b else ""
        return f"{self.posture}; m = {self.m:g} kg{damping}, k = {self.k:g} N/m ({self.source})"


PRESETS = {
    "pinch": HandPreset(0.02, 1.0, 200.0, "thumb and finger, relaxed", ILLUSTRATIVE),
    "grip": HandPreset(0.1, 5.0, 500.0, "the whole hand around the handle", ILLUSTRATIVE),
    "arm": HandPreset(
        0.554, 6.45, 135.0, "arm in a sling, holding a handle, keeping its posture",
        "one trial of one person: van Beek et al., Scientific Reports 5, 18004 (2015), Fig. 3",
    ),
    "test bed finger": HandPreset(
        0.006, 0.0, 500.0, "a finger on a plate, without damping",
        "the model of Gillespie and Cutkosky (1996), for a plate of 0.35 kg",
    ),
}  # fmt: skip


def hand_presets() -> str:
    """The hands that :class:`hapticlab.Hand` knows by name, as text, a line each: posture, numbers, source.

    Examples
    --------
    >>> print(hand_presets().splitlines()[0])
    pinch: thumb and finger, relaxed; m = 0.02 kg, b = 1 N s/m, k = 200 N/m (illustrative round numbers, not measured)
    """
    return "\n".join(f"{name}: {preset}" for name, preset in PRESETS.items())
