"""What a hand needs to notice a difference of two forces: a part of the force, a least force, a least vibration."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...base.arguments import numbers
from ...base.shows_itself import ShowsItself
from ...errors import AnalysisError

_NEEDED = {
    "weber": {"unit": "", "least": 0.0, "most": 1.0},
    "force": {"unit": "N", "least": 0.0, "most": 10.0},
    "motion": {"unit": "m", "least": 1e-9, "most": 1e-2},
    "best": {"unit": "Hz", "least": 1.0, "most": 1e3},
    "slowest": {"unit": "Hz", "least": 1.0, "most": 1e3},
    "window": {"unit": "s", "least": 1e-2, "most": 10.0},
}


@dataclass(frozen=True, kw_only=True)
class Thresholds(ShowsItself):
    """Difference thresholds of a hand on a handle.

    The defaults are at the sensitive end of what is published, so that what is not noticed by them is hard to notice.
    People differ by a factor of two and more: where it matters, measure yours.

    Parameters
    ----------
    weber : float
        The difference that is noticed, as a part of the force, 0 to 1. About 0.07 from 2.5 to 10 N in X. D. Pang, H. Z. Tan
        and N. I. Durlach, Manual discrimination of force using active finger motion, Percept. Psychophys. 49 (1991) 531; for
        weaker forces illustrative.
    force : float or text
        The least force that is noticed at all [N]. 29 to 44 mN at finger tips in H. H. King, R. Donlin and B. Hannaford,
        Perceptual thresholds for single vs. multi-finger haptic interaction, Haptics Symposium (2010) 95.
    motion : float or text
        The least amplitude of a vibration of the handle that is noticed, at the frequency ``best`` [m].
    best : float or text
        Where the hand is most sensitive to vibration [Hz]. Away from it the least amplitude grows by the square of the
        frequency's ratio, 12 dB an octave. 0.1 um and 200 Hz are round numbers after S. J. Bolanowski et al., J. Acoust. Soc.
        Am. 84 (1988) 1680, and A. J. Brisben, S. S. Hsiao and K. O. Johnson, J. Neurophysiol. 81 (1999) 1548 (some of
        whose hands felt a tenth of that); illustrative.
    slowest : float or text
        Below it a change is felt as a force and not as a vibration [Hz]; illustrative.
    window : float or text
        Forces are compared by their rms over so long [s]; illustrative.

    Raises
    ------
    AnalysisError
        For a value that is not a number or is out of its range.

    Examples
    --------
    >>> hand = Thresholds()
    >>> round(1e6 * float(hand.amplitude(50.0)), 9)         # um at 50 Hz, two octaves below 200 Hz
    1.6
    """

    weber: float = 0.07
    force: float = 0.03
    motion: float = 0.1e-6
    best: float = 200.0
    slowest: float = 20.0
    window: float = 0.2

    def __post_init__(self) -> None:
        numbers(self, "thresholds", error=AnalysisError, **_NEEDED)

    def __str__(self) -> str:
        return (
            f"noticed from {self.weber:.0%} of the force and {1e3 * self.force:g} mN, or from a vibration of "
            f"{1e6 * self.motion:g} um at {self.best:g} Hz"
        )

    def amplitude(self, frequency: float | np.ndarray) -> np.ndarray:
        """Return the least amplitude of the handle that is noticed as a vibration [m], at a frequency [Hz].

        Parameters
        ----------
        frequency : float or array
            [Hz], > 0.
        """
        apart = np.maximum(self.best / np.asarray(frequency, float), np.asarray(frequency, float) / self.best)
        return self.motion * apart**2

    def shaking_force(self, frequency: float | np.ndarray, *, m: float, b: float, k: float) -> np.ndarray:
        """Return the least amplitude of a force that is noticed as a vibration [N], of handle and hand together.

        Parameters
        ----------
        frequency : float or array
            [Hz]
        m, b, k : float
            Mass [kg], damping [N s/m] and stiffness [N/m] of handle and hand together.

        Examples
        --------
        >>> round(1e3 * float(Thresholds().shaking_force(100.0, m=0.05, b=0.0, k=0.0)), 3)      # mN
        7.896
        """
        w = 2 * np.pi * np.asarray(frequency, float)
        return self.amplitude(frequency) * np.abs(k - m * w**2 + 1j * b * w)
