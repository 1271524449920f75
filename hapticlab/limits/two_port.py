"""Absolute stability of a two-port, by Llewellyn's criterion: stable whatever passive hand and environment hang on it.

A haptic display lies between the hand and the virtual environment (Adams and Hannaford 1999). In hybrid form

    [F_1, -v_2] = h [v_1, F_2],    h a 2 x 2 matrix at every theta = w T,

with the hand at port 1 and the environment at port 2; an admittance display exchanges v_1 and F_1, v_2 and F_2, and reads the
same. It is stable with every pair of passive terminations where, at every frequency up to Nyquist,

    Re h11 >= 0,  Re h22 >= 0,  2 Re h11 Re h22 >= |h12 h21| + Re(h12 h21),

and where h itself is stable. That is no matter of its values at frequencies, so who builds a two-port has to say it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from ..base.shows_itself import ShowsItself
from .plots import plot_two_port

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike, NDArray

    from ..base.annotations import Array

#: relative rounding of the criterion
ROUNDING = 1e-9
#: slow motion is looked at down to this w T
SLOW = 1e-5
#: relative difference of values that count as the same
ALIKE = 1e-9


def frequencies(points: int = 2000) -> Array:
    """Return theta = w T, close together at both ends, shape (P,)."""
    return np.unique(np.r_[np.geomspace(SLOW, np.pi, points), np.linspace(SLOW, np.pi, points)])


def hertz(curve: Callable[[Array], Array], theta: float, T: float, size: float = 0.0) -> float | None:
    """Return in Hz where a function of w T is least, from the theta that was found: None where flat, 0.0 for slow motion."""
    values = curve(np.r_[theta, frequencies()])
    alike = np.abs(values - values[0]) <= ALIKE * max(abs(values[0]), size)
    if alike.all():
        return None
    return 0.0 if alike[1] else float(theta / (2 * math.pi * T))


def stopped(frequency: float | None) -> str:
    """Return in words what stops a coupler."""
    if frequency is None:
        return "by all frequencies alike"
    return f"at {frequency:.4g} Hz" if frequency else "by slow motion"


@dataclass(frozen=True)
class TwoPort(ShowsItself):
    """A display between a hand and a virtual environment.

    Attributes
    ----------
    h : callable
        theta of shape (P,) -> complex array of shape (P, 2, 2).
    T : float
        Sampling period [s].
    name : str
    stable : bool
        Whether h has no pole outside the unit circle: stable with a hand that holds nothing (v_1 given) and no environment
        (F_2 given). Without that the criterion says nothing.

    Examples
    --------
    >>> h = lambda theta: np.tile([[0.1, 1.0], [-1.0, 0.0]], (len(theta), 1, 1)) + 0j
    >>> damper = TwoPort(h, T=1e-3, name="a damper", stable=True)
    >>> damper.absolutely_stable
    True
    """

    h: Callable[[Array], NDArray[np.complex128]] = field(repr=False)
    T: float
    name: str
    stable: bool

    def criterion(self, theta: ArrayLike) -> Array:
        """Return ``2 Re h11 Re h22 - |h12 h21| - Re(h12 h21)``, a number without unit that has to be >= 0.

        Parameters
        ----------
        theta : array_like
            Frequency times period, w T [rad], shape (P,).
        """
        h = self.h(np.atleast_1d(np.asarray(theta, dtype=float)))
        product = h[:, 0, 1] * h[:, 1, 0]
        # |p| + Re p, without loss where p is near a negative number
        return 2 * h[:, 0, 0].real * h[:, 1, 1].real - 2 * np.abs(product) * np.sin(np.angle(-product) / 2) ** 2

    @property
    def absolutely_stable(self) -> bool:
        """Whether every pair of passive terminations is stable."""
        if not self.stable:
            return False
        h = self.h(theta := frequencies())
        own = np.minimum(_part(h[:, 0, 0]), _part(h[:, 1, 1]))
        return bool(own.min() >= -ROUNDING and self.criterion(theta).min() >= -ROUNDING)

    @property
    def worst(self) -> float | None:
        """Frequency [Hz] at which the criterion is least; 0 where slow motion is as bad to 1e-9, None where all are."""
        return hertz(self.criterion, frequencies()[self.criterion(frequencies()).argmin()], self.T, size=1.0)

    def plot(self) -> Figure:
        """Return a figure: Llewellyn's criterion over frequency."""
        return plot_two_port(self)

    def felt(self, theta: ArrayLike, environment: ArrayLike) -> NDArray[np.complex128]:
        """Return F_1/v_1 at theta of shape (P,) with ``F_2 = environment v_2`` at the other port, complex (P,).

        Parameters
        ----------
        theta : array_like
            Frequency times period, w T [rad], shape (P,).
        environment : array_like
            Impedance of the environment [N s/m], complex, shape (P,) or a number.
        """
        h, Z = self.h(np.atleast_1d(np.asarray(theta, dtype=float))), np.asarray(environment)
        return h[:, 0, 0] - h[:, 0, 1] * h[:, 1, 0] * Z / (1 + h[:, 1, 1] * Z)

    def least_resistance(self, theta: ArrayLike) -> Array:
        """Return the least Re F_1/v_1 that a passive environment can make the hand feel, theta of shape (P,).

        A passive environment fills a half plane, which the fractional map of the two-port turns into a disk.

        Parameters
        ----------
        theta : array_like
            Frequency times period, w T [rad], shape (P,).
        """
        h = self.h(np.atleast_1d(np.asarray(theta, dtype=float)))
        product = h[:, 0, 1] * h[:, 1, 0]
        return h[:, 0, 0].real - (np.abs(product) + product.real) / (2 * h[:, 1, 1].real)


def _part(z):
    """Return the cosine of the angle of an immittance; 0 where there is none."""
    return z.real / np.maximum(np.abs(z), 1e-300)
