"""Every passive hand as one disk in the Nyquist plane, and the fractional map that turns it into the unit disk.

Colgate and Schenkel's way to Eq. (23.10). A handle of damping b in a passive hand has an admittance Y(jw) in the disk about
1/(2b) of radius 1/(2b). Held, integrated and sampled, its response G to the force is a sum of Y over all aliases w_k with
weights -1/w_k^2 of one sign, so at each theta = w T it lies in a disk again:

    G = c + rho Delta, |Delta| <= 1,    rho = |r|/(2b),    r = -(T/2) (1 + j cot(theta/2)).

Without delay c = r/(2b). A delay of d + f periods turns the terms of the sum against each other; their sum is a straight
line in f, and c = (r/(2b)) ((1-f) + f/z) / z^d, with the same radius. The loop 1 + H G = 0 cannot close in any hand where
|M| < 1, M = H rho/(1 + H c): the small gain theorem after a linear fractional map, which here loses nothing.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from ..base.arguments import number
from ..base.shows_itself import ShowsItself
from ..errors import AnalysisError
from .colgate import passivity_margin
from .limit import whole_and_fraction
from .linear_law import LinearLaw
from .plots import plot_nyquist_disk
from .two_port import SLOW

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike, NDArray

    from ..base.annotations import Array
    from ..device.device import AnyDevice

#: |M| past which 1 + H c is rounding
INFINITE = 1e9


@dataclass(frozen=True)
class NyquistDisk(ShowsItself):
    """The disk of passive hands at each theta = w T, 0 < theta <= pi, and where a law lies against it.

    Attributes
    ----------
    law : LinearLaw
    b : float
        Damping of the device [N s/m].
    delay : float
        [s]
    worst : float
        theta that asks for the most damping: which shrinks its disk last; pi where it is one of several. Slow motion, given
        as 1e-5, has |M| near 1 with any spring.
    passive : bool
        Whether the mapped law stays inside.
    """

    law: LinearLaw = field(repr=False)
    b: float
    delay: float
    worst: float
    passive: bool

    def centre(self, theta: ArrayLike) -> NDArray[np.complex128]:
        """Return the centre [m/N] of the disk of G(e^(j theta))."""
        whole, f = whole_and_fraction(self.delay, self.law.T)
        z = np.exp(1j * np.asarray(theta, dtype=float))
        return self._hold(theta) * ((1 - f) + f / z) * z ** -float(whole)

    def radius(self, theta: ArrayLike) -> Array:
        """Return the radius [m/N] of that disk."""
        return np.abs(self._hold(theta))

    def mapped(self, theta: ArrayLike) -> NDArray[np.complex128]:
        """Return the law M(theta) after the map that makes the disk the unit disk; a passive rendering has |M| < 1."""
        H = self.law.at(theta)
        with np.errstate(divide="ignore", invalid="ignore"):
            return H * self._hold(theta) / (1 + H * self.centre(theta))

    @property
    def size(self) -> str:
        """The worst |M| in words: "= 0.857143", or "infinite" where the map divides by nothing but rounding."""
        worst = float(np.abs(self.mapped(self.worst)))
        return f"= {worst:.6g}" if worst < INFINITE else "infinite"

    def _hold(self, theta):
        return -self.law.T / (4 * self.b) * (1 + 1j / np.tan(np.asarray(theta, dtype=float) / 2))  # r/(2b)

    def plot(self) -> Figure:
        """Draw both planes."""
        return plot_nyquist_disk(self)

    def __str__(self) -> str:
        at = "for slow motion" if self.worst < 2 * SLOW else f"at {self.worst / (2 * math.pi * self.law.T):.4g} Hz"
        inside = "inside the unit circle: passive in every passive hand" if self.passive else (
            "outside the unit circle: some passive hand closes an unstable loop"
        )  # fmt: skip
        return f"{self.law.name} on b = {self.b:g} N s/m: |M| {self.size} {at}, {inside}"


def nyquist_disk(device: AnyDevice, law: LinearLaw) -> NyquistDisk:
    """Return the disk of passive hands and the law against it (Colgate and Schenkel 1997; Eq. 23.10 is its result).

    Parameters
    ----------
    device : Device or paddle
        Its b > 0 and its delay are read, whole and fractional periods alike; its T must be that of the law.
    law : LinearLaw

    Returns
    -------
    NyquistDisk

    Raises
    ------
    AnalysisError
        b = 0, where the disk is a half plane, and for what :func:`~hapticlab.limits.colgate.passivity_margin` refuses.

    Examples
    --------
    >>> import hapticlab as hl
    >>> disk = nyquist_disk(hl.Device(b=0.1), LinearLaw.of("zoh", K=100.0, T=1e-3))
    >>> disk.passive, round(abs(complex(disk.mapped(3.141592653589793))), 9)
    (True, 0.333333333)
    """
    margin = passivity_margin(device, law)
    number("b", margin.b, "N s/m", "a disk of finite size", above=0)
    if math.isinf(margin.required):
        raise AnalysisError(
            f"{law.name}: a resonance without damping reaches every circle; needs a law whose resonances are damped"
        )
    if float(margin.asked([math.pi])[0]) >= margin.required * (1 - 1e-9):  # all alike, or there alone
        worst = math.pi
    else:
        worst = max(2 * math.pi * (margin.frequency or 0.0) * law.T, SLOW)
    return NyquistDisk(law, margin.b, margin.delay, worst, margin.passive)
