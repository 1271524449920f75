"""Periodic test signals: multisines of low crest factor and periodic chirps, whole periods of whole samples, no leakage.

Random-phase multisines after Pintelon and Schoukens, *System Identification: A Frequency Domain Approach*; Schroeder's
phases (1970); peaks lowered by clipping and restoring the amplitudes (van der Ouderaa, Schoukens and Renneboog 1988).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

from ..errors import AnalysisError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from ..base.annotations import Array

#: rounds of clipping; most of the gain comes in the first hundred
ROUNDS = 150


def multisine(
    samples: int, lines: ArrayLike, *, phases: Literal["schroeder", "random", "low_crest"] = "schroeder", seed: int = 0
) -> Array:
    """One period of a sum of cosines of equal amplitude, peak 1.

    Parameters
    ----------
    samples : int
        N of the period.
    lines : sequence of int
        Cycles in the period, 0 < line < N/2.
    phases : {"schroeder", "random", "low_crest"}
        "schroeder": -pi j (j-1)/L, deterministic. "random": uniform, from the seed, crest factor 2 to 4. "low_crest":
        random, then clipped and restored until the peaks are low.
    seed : int

    Returns
    -------
    array, shape (samples,)

    Examples
    --------
    >>> lines = np.arange(1, 64, 2)
    >>> worst = max(crest_factor(multisine(1000, lines, phases="low_crest", seed=s)) for s in range(5))
    >>> crest_factor(multisine(1000, lines)) < 1.9, worst < 1.8, crest_factor(multisine(1000, lines, phases="random")) > 2
    (True, True, True)
    """
    lines = checked_lines(samples, lines)
    if phases == "schroeder":
        order = np.arange(1, len(lines) + 1)
        angles = -np.pi * order * (order - 1) / len(lines)
    elif phases in ("random", "low_crest"):
        angles = np.random.default_rng(seed).uniform(0, 2 * np.pi, len(lines))
    else:
        raise AnalysisError(f"phases = {phases!r}; needs 'schroeder', 'random' or 'low_crest'")
    signal = _sum(samples, lines, angles)
    if phases == "low_crest":
        signal = _lowered(signal, lines)
    return signal / abs(signal).max()


def chirp(samples: int, lines: ArrayLike) -> Array:
    """One period of a swept sine from the first to the last line, peak 1: sin of a phase that grows as t^2.

    A line of every cycle number between first and last gets much the same power, a little leaks beyond the ends.
    """
    lines = checked_lines(samples, lines)
    first, last = lines.min(), lines.max()
    part = np.arange(samples) / samples
    return np.sin(2 * np.pi * (first * part + (last - first) / 2 * part**2))


def crest_factor(signal: Array) -> float:
    """Peak over rms."""
    return float(abs(signal).max() / np.sqrt(np.mean(np.square(signal))))


def lines_of(frequency, T, period):
    """(samples, lines): the period in samples, and the odd lines nearest to the frequencies asked for [Hz].

    Odd lines alone, so that what a nonlinearity puts on the even ones is seen.
    """
    samples = round(period / T)
    if samples < 8:
        raise AnalysisError(f"period = {period:g} s is {samples} samples of T = {T:g} s; needs at least 8")
    asked = np.atleast_1d(np.asarray(frequency, float)) * samples * T
    if not asked.size or not np.isfinite(asked).all() or (asked <= 0).any() or (asked >= samples / 2).any():
        raise AnalysisError(
            f"frequency = {frequency} Hz; needs frequencies between 0 and half the sampling rate, {0.5 / T:g} Hz, each with "
            f"at least one cycle in the period of {period:g} s"
        )
    odd = 2 * np.floor(asked / 2).astype(int) + 1
    return samples, np.unique(odd[odd < samples / 2])


def checked_lines(samples: int, lines: ArrayLike) -> NDArray[np.int_]:
    """Return lines as whole numbers of cycles in a period of so many samples, or say what they have to be."""
    lines = np.asarray(lines, int)
    if lines.ndim != 1 or not lines.size or lines.min() < 1 or lines.max() >= samples / 2:
        raise AnalysisError(f"lines = {lines}; needs whole cycles from 1 to below half of the {samples} samples")
    return lines


def _sum(samples, lines, angles):
    spectrum = np.zeros(samples // 2 + 1, complex)
    spectrum[lines] = np.exp(1j * angles)
    return np.fft.irfft(spectrum, samples)


def _lowered(signal, lines):
    """The signal with phases changed so that its peaks are low: clip, keep the phases, restore the amplitudes."""
    best = signal
    for k in range(ROUNDS):
        level = (0.75 + 0.2 * k / ROUNDS) * abs(signal).max()
        signal = _sum(len(signal), lines, np.angle(np.fft.rfft(np.clip(signal, -level, level))[lines]))
        best = min(best, signal, key=crest_factor)
    return best
