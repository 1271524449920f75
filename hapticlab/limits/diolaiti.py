"""A plain wall in the plane of Diolaiti et al. (2006): damping against the hold, Coulomb friction against the encoder.

Two numbers without unit: beta = b/(K T) and sigma = f_c/(K Delta). The hold gains ``(1/2 + delay/T - beta) K T w X^2 pi`` from a
cycle of amplitude X at w, the encoder at most a count's work each way, friction takes ``4 f_c X``. So with beta >= 1/2 + delay/T
large motions die away and with sigma >= 1/2 small ones do; the four combinations are the regions. They are regions of slow
sinusoids: with a fraction of a period of delay a wall in the first may still not be passive, and is then not called so.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..arguments import number
from .bounds import diolaiti_limit
from .passivity import required_damping
from .plots import plot_diolaiti

if TYPE_CHECKING:
    from matplotlib.figure import Figure

REGIONS = {
    (True, True): "passive: comes to rest from anywhere",
    (True, False): "limit cycles: large motions die away to a buzz of about a count",
    (False, True): "locally stable: comes to rest from small motions, large ones grow",
    (False, False): "unstable: small and large motions grow",
}
#: beta is large enough for slow sinusoids, and a delay of a fraction of a period lets a hand draw energy all the same
NOT_PASSIVE = "slow motions come to rest, not passive: a hand that moves faster before the force changes draws energy"


@dataclass(frozen=True)
class DiolaitiPoint:
    """One wall in the plane of beta and sigma.

    Attributes
    ----------
    beta, sigma : float
        b/(K T) and f_c/(K Delta); sigma is inf without an encoder's counts.
    tau : float
        delay/T
    region : str
    amplitude : float
        Of a sinusoid at the natural frequency [m], in contact, above which the motion grows: ``4 f_c/(pi w (K (T/2 + delay) -
        b))``, by its describing function. inf where beta is large enough, 0 where small motions grow too or without friction;
        nan without a mass.
    """

    beta: float
    sigma: float
    tau: float
    region: str
    amplitude: float

    def plot(self) -> Figure:
        """Draw the four regions and the point."""
        return plot_diolaiti(self)

    def __str__(self) -> str:
        grow = f"; motions above {1e3 * self.amplitude:.4g} mm grow" if 0 < self.amplitude < math.inf else ""
        return f"beta = b/(K T) = {self.beta:.4g}, sigma = f_c/(K Delta) = {self.sigma:.4g}: {self.region}{grow}"


def diolaiti(
    *, K: float, b: float, T: float, coulomb: float = 0.0, resolution: float = 0.0, delay: float = 0.0, m: float | None = None
) -> DiolaitiPoint:
    """Return where a plain wall of stiffness K lies in the beta-sigma plane (Diolaiti, Niemeyer, Barbagli, Salisbury 2006).

    Parameters
    ----------
    K : float
        Stiffness [N/m], > 0.
    b, T, coulomb, resolution, delay : float
        As for :func:`~hapticlab.limits.bounds.diolaiti_limit`.
    m : float, optional
        Mass of handle and hand [kg], for the amplitude above which a locally stable wall grows.

    Returns
    -------
    DiolaitiPoint

    Examples
    --------
    >>> print(diolaiti(K=300, b=0.1, T=1e-3, coulomb=0.05, resolution=0.2e-3, m=0.05))
    beta = b/(K T) = 0.3333, sigma = f_c/(K Delta) = 0.8333: locally stable: comes to rest from small motions, large ones grow; \
motions above 16.44 mm grow
    """
    diolaiti_limit(b=b, T=T, coulomb=coulomb, resolution=resolution, delay=delay)  # refuses what is no device
    K = number("K", K, "N/m", "a wall", above=0)
    if m is not None:
        m = number("m", m, "kg", "the handle and hand", above=0, what="a mass m")
    beta, sigma = b / (K * T), coulomb / (K * resolution) if resolution else math.inf
    tau = delay / T
    calm, settled = beta >= 0.5 + tau, sigma >= 0.5
    region, amplitude = REGIONS[calm, settled], math.inf
    if calm and settled and required_damping(K=K, T=T, delay=delay) > b * (1 + 1e-9):
        region = NOT_PASSIVE
    if not calm:
        pull = K * T * (0.5 + tau) - b  # the negative damper of hold and delay that is left over [N s/m]
        amplitude = 4 * coulomb / (math.pi * math.sqrt(K / m) * pull) if m else math.nan
        amplitude = amplitude if settled else 0.0
    return DiolaitiPoint(beta, sigma, tau, region, amplitude)
