"""A response from whole periods: the ratio of two spectra against a known excitation, and how sure it is."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..base.shows_itself import ShowsItself

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ..base.annotations import Array

#: of the circle that is stated around every number
CONFIDENCE = 0.95


@dataclass(frozen=True, eq=False)
class Response(ShowsItself):
    """y/x at every line, from blocks of one period each.

    Attributes
    ----------
    value : complex array, shape (L,)
    radius : array, shape (L,)
        Of the circle around the value that holds the truth with 95 % confidence, for noise that differs between blocks.
    coherence : array, shape (L,)
        Of x and y over the blocks; 1 where every block repeats.
    """

    value: NDArray[np.complex128]
    radius: Array
    coherence: Array

    def __str__(self) -> str:
        return f"a ratio of spectra at {len(self.value)} lines, coherence {self.coherence.min():.3f} at the least"


def lines_in(blocks: Array, lines: NDArray[np.int_]) -> NDArray[np.complex128]:
    """The Fourier coefficients of real blocks, shape (B, N), at their lines, shape (B, L)."""
    return 2 / blocks.shape[1] * np.fft.rfft(blocks, axis=1)[:, lines]


def response(y: NDArray[np.complex128], x: NDArray[np.complex128], reference: NDArray[np.complex128]) -> Response:
    """y/x, each of shape (B, L), through what both have of the reference.

    Noise on x that comes round through the loop would pull a plain ratio of y and x towards the loop's inverse; the
    reference has none of it (Pintelon and Schoukens, joint input-output approach).
    """
    x, y = x / reference, y / reference
    blocks = len(x)
    value = y.mean(0) / x.mean(0)
    if blocks < 2:
        return Response(value, np.full(value.shape, np.nan), np.full(value.shape, np.nan))
    spread = (abs(y - value * x) ** 2).sum(0) / (blocks - 1)
    degrees = 2 * (blocks - 1)
    # the quantile of F(2, d) has a closed form
    quantile = degrees / 2 * ((1 - CONFIDENCE) ** (-2 / degrees) - 1)
    radius = np.sqrt(quantile * spread / blocks) / abs(x.mean(0))
    power = (abs(x) ** 2).sum(0) * (abs(y) ** 2).sum(0)
    coherence = abs((x.conj() * y).sum(0)) ** 2 / np.where(power > 0, power, 1.0)
    return Response(value, radius, coherence)


def held_transfer(s: NDArray[np.complex128], T: float, delay: float = 0.0) -> NDArray[np.complex128]:
    """Transfer function of a hold of T [s] and a delay [s] at s = 2 pi j f: (1 - e^(-sT))/(sT) e^(-s delay)."""
    return -np.expm1(-s * T) / (s * T) * np.exp(-s * delay)


def ramp_transfer(s: NDArray[np.complex128], T: float) -> Array:
    """Spectrum of a path that is straight between its samples, over the spectrum of the samples: sinc^2(f T)."""
    return np.sinc(s.imag * T / (2 * np.pi)) ** 2
