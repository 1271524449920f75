"""The virtual coupler that keeps an impedance display stable with every passive hand and every passive environment.

The coupler is a spring and a damper from handle to proxy at the sample rate, ``F[n] = k_c e[n] + b_c (e[n] - e[n-1])/T`` with
``e = x - z``; the environment at its far end is anything that is passive at the sample rate in F[n] and (z[n] - z[n-1])/T. The
hold makes the force work on the *next* step of the handle, so sampling is one period of delay between the two velocities.
Without delay the display is the two-port

    h = [[b, 1], [-1/z, 1/Z_c]],

exact in the sense of Colgate and Schenkel: device and hand stay in continuous time. A delay of d + f periods makes h12 the
mean force A z^-d of a period, A = (1-f) + f/z, and lets a hand win ``f (1-f) (1 - cos theta) |F|^2/(2b)`` by moving faster
before or after the force changes. Over all environments both together are an h12 of size one, with Re(h12 h21) unchanged:

    2 b Re(1/Z_c) >= 1 - Re(A z^-(d+1)) = (1-f) (1 - cos((d+1) theta)) + f (1 - cos((d+2) theta)),

because ``|A|^2 + 2 f (1-f) (1 - cos theta) = 1``. At each frequency this is a convex set of pairs (b_c, k_c). Without delay all
of it is ``k_c T/2 + b_c <= b``, which is Eq. (23.10) again.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..base.arguments import number
from ..base.roots import minimum
from ..base.shows_itself import ShowsItself
from ..device.device import known
from ..errors import AnalysisError
from .limit import MOST_PERIODS, whole_and_fraction
from .plots import plot_coupler
from .two_port import TwoPort, frequencies, hertz, stopped

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..base.annotations import Array
    from ..device.device import AnyDevice


@dataclass(frozen=True)
class CouplerDesign(ShowsItself):
    """The stiffest spring of a virtual coupler beside a damper, absolutely stable on one device.

    Attributes
    ----------
    k_c : float
        Stiffness [N/m].
    b_c : float
        Damping [N s/m].
    frequency : float or None
        That stops a stiffer one [Hz]; 0 for slow motion, None where all frequencies are alike.
    b, T, delay : float
        Of the device [N s/m, s, s].
    """

    k_c: float
    b_c: float
    frequency: float | None
    b: float
    T: float
    delay: float

    @property
    def two_port(self) -> TwoPort:
        """The display with this coupler, as a TwoPort between hand and environment."""
        return impedance_display(k_c=self.k_c, b_c=self.b_c, b=self.b, T=self.T, delay=self.delay)

    def border(self, points: int = 60) -> Array:
        """Return (b_c, k_c) of shape (2, points): the stiffest spring beside every damper the device can carry."""
        dampers = np.linspace(0.0, _most_damping(self.b, self.T, self.delay), points)
        return np.array([dampers, [_stiffest(b_c, self.b, self.T, self.delay)[0] for b_c in dampers]])

    def plot(self) -> Figure:
        """Draw the pairs that are absolutely stable, and the criterion of this pair against frequency."""
        return plot_coupler(self)

    def __str__(self) -> str:
        late = f", delay {1e3 * self.delay:g} ms" if self.delay else ""
        at = stopped(self.frequency)
        return (
            f"coupler k_c = {self.k_c:.6g} N/m, b_c = {self.b_c:.6g} N s/m: stable with every passive hand and every "
            f"environment that is passive at the sample rate, on a device of b = {self.b:g} N s/m, T = {1e3 * self.T:g} "
            f"ms{late}; stopped {at}"
        )


def coupler_design(device: AnyDevice, *, b_c: float | None = None) -> CouplerDesign:
    """Design a virtual coupler for an impedance display by Llewellyn's criterion (after Adams and Hannaford 1999).

    Exact for the sampled device in any passive hand, if the environment is passive at the sample rate, as bodies are that are
    stepped by backward Euler together with their coupler. A compiled scene is not, not even one solved without error: its force
    is late, and where a body resonates on the coupler a device needs about k_c**2 tau**2/(4 b_c), tau = T/2 and the delay. The
    larger of both needs counts; :func:`hapticlab.passivity.port` has that of a scene.

    Parameters
    ----------
    device : Device or paddle
        Its b, T and delay are read. Its mass does not matter: a passive hand may take it away.
    b_c : float, optional
        Damping of the coupler [N s/m], >= 0. Without it the damper beside which the spring can be stiffest.

    Returns
    -------
    CouplerDesign

    Raises
    ------
    AnalysisError
        The device has no damping, or less than b_c needs.

    Examples
    --------
    >>> import hapticlab as hl
    >>> paddle = hl.SimulatedPaddle(m=0.05, b=0.2, T=1e-3)
    >>> design = hl.design.coupler(paddle, b_c=0.05)
    >>> round(design.k_c, 6)  # 2 (b - b_c)/T
    300.0
    """
    b, T, delay = known(device, "b", "T", "delay")
    b = number(
        "b", b, "N s/m", "a coupler", above=0, what="a device of b", why="it dissipates the energy that the hold generates"
    )
    most = _most_damping(b, T, delay)
    if b_c is None:
        b_c = _best_damping(b, T, delay, most)
    b_c = number("b_c", b_c, "N s/m", "a coupler's damper", least=0)
    if b_c > most:
        raise AnalysisError(
            f"b_c = {b_c:g} N s/m; with a device damping of b = {b:g} N s/m the coupler's damping needs to "
            f"be at most {most:.6g} N s/m, because the device must dissipate the energy that it generates"
        )
    k_c, theta = _stiffest(b_c, b, T, delay)
    return CouplerDesign(k_c, b_c, hertz(_stops(b_c, b, T, delay), theta, T), b, T, delay)


def impedance_display(*, k_c: float, b_c: float, b: float, T: float, delay: float = 0.0) -> TwoPort:
    """Return the two-port of a device of damping b that shows an environment through a coupler.

    Examples
    --------
    >>> impedance_display(k_c=300, b_c=0.05, b=0.2, T=1e-3).absolutely_stable
    True
    >>> impedance_display(k_c=310, b_c=0.05, b=0.2, T=1e-3).absolutely_stable
    False
    """
    whole, f = whole_and_fraction(delay, T, most=MOST_PERIODS)

    def h(theta):
        z = np.exp(1j * theta)
        product = -(((1 - f) + f / z) * z ** -float(whole + 1)).real  # Re(h12 h21)
        turned = -z * (product + 1j * np.sqrt(np.maximum(1 - product**2, 0.0)))
        rows = [np.full(theta.shape, b + 0j), turned], [-1 / z, 1 / (b_c + k_c * T / (1 - 1 / z))]
        return np.moveaxis(np.array(rows), 2, 0)

    stable = abs(b_c) < abs(b_c + k_c * T)  # the pole of h22 = 1/Z_c
    return TwoPort(h, T, f"impedance display, k_c = {k_c:g} N/m, b_c = {b_c:g} N s/m", stable or k_c == 0 < b_c)


def _needed(theta, T, delay):
    """Return the part Re(1/Z_c) that the criterion needs of the coupler, times b, over sin^2(theta/2)."""
    whole, f = whole_and_fraction(delay, T, most=MOST_PERIODS)
    now, later = (np.sin(periods * theta / 2) ** 2 for periods in (whole + 1, whole + 2))
    return ((1 - f) * now + f * later) / np.sin(theta / 2) ** 2


def _stiffest(b_c, b, T, delay):
    """Return (k_c, theta): the stiffest spring beside b_c, and what stops it."""
    q, theta = _least(_stops(b_c, b, T, delay))
    return 2 * q / T, theta


def _stops(b_c, b, T, delay):
    """Return the function of theta that is the largest k_c T/2 which it allows beside b_c.

    With q = k_c T/2 and G the need above, over b: ``G q^2 + (2 G s b_c - 1) q + (G s b_c - 1) b_c <= 0``, s = sin^2(theta/2).
    """

    def largest(theta):
        G, s = _needed(theta, T, delay) / b, np.sin(theta / 2) ** 2
        half, rest = 0.5 - G * s * b_c, np.maximum((1 - G * s * b_c) * b_c, 0.0)
        root = np.sqrt(half**2 + G * rest)
        return np.where(half >= 0, (half + root) / G, rest / np.maximum(root - half, 1e-300))

    return largest


def _most_damping(b, T, delay):
    """Return the largest b_c [N s/m] that stands without any spring."""
    return _least(lambda theta: b / np.maximum(_needed(theta, T, delay) * np.sin(theta / 2) ** 2, 1e-300))[0]


def _least(curve):
    """Return the least value of a function of theta and where it is."""
    theta = frequencies()
    for _ in range(5):  # look closer around the least
        values = curve(theta)
        least = int(values.argmin())
        found, at = float(values[least]), float(theta[least])
        theta = np.linspace(theta[max(least - 1, 0)], theta[min(least + 1, len(theta) - 1)], 80)
    return found, at


def _best_damping(b, T, delay, most):
    """Return the damper beside which the spring can be stiffest: k_c is a concave function of b_c."""

    def stiffness(b_c):
        return _stiffest(b_c, b, T, delay)[0]

    best = minimum(lambda b_c: -stiffness(b_c), 0.0, most)
    return best if stiffness(best) > stiffness(0.0) else 0.0
