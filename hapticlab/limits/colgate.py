"""Colgate and Schenkel's condition for any linear law, frequency by frequency: who makes energy, and where.

A force ``F = H(z) x`` held over each period is passive on a device of damping b where, at every theta = w T up to pi,

    b > (T/2) Re{(1 - e^(-j theta)) H(e^(j theta))} / (1 - cos theta).

The right side is what the cheapest motion through the samples asks for: straight lines from sample to sample. A pure
sinusoid feels the held force as a damper of its own,

    b_eq(theta) = -(T/theta^2) Re{(1 - e^(-j theta)) H(e^(j theta))},

negative where the law makes energy. The two are one below a tenth of the sampling rate; near Nyquist the straight lines
ask for up to pi^2/4 of what the sinusoid asks for.

Averaged over theta from 0 to pi the right side is ``K T/2``, with K = H(1) the stiffness at rest, for every stable law
and every delay of whole periods: of ``z^-k`` it is Dirichlet's kernel, whose mean is one. A law that asks for less
somewhere asks for more elsewhere, so none is passive with K > 2 b/T, and without delay nothing is better than the plain
spring, Eq. (23.1).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from ..base.arguments import instance, number
from ..base.roots import root
from ..base.shows_itself import ShowsItself
from ..device.device import known
from ..errors import AnalysisError
from .limit import MOST_PERIODS, whole_and_fraction
from .linear_law import LinearLaw
from .plots import plot_passivity_margin
from .port import ALIKE, SLOWEST, asked, negative, required, unstable_pole

if TYPE_CHECKING:
    from collections.abc import Callable

    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike

    from ..base.annotations import Array
    from ..base.facts import Fact
    from ..device.device import AnyDevice

#: a stiffness beside which the next cut has nothing to add
SETTLED = 1e-13


@dataclass(frozen=True)
class PassivityMargin(ShowsItself):
    """What a law asks of a device's damping at every frequency, and what is left.

    Attributes
    ----------
    law : LinearLaw
    b : float
        Damping of the device [N s/m].
    delay : float
        [s]
    required : float
        Least damping [N s/m] with which the law is passive in every passive hand; inf where none is enough.
    frequency : float
        Frequency that needs this damping [Hz]; 0 for slow motion, the slower the more, and where all frequencies need it alike
        (``flat``).
    """

    law: LinearLaw = field(repr=False)
    b: float
    delay: float
    required: float
    frequency: float

    @property
    def margin(self) -> float:
        """Damping of the device that is left over [N s/m]."""
        return self.b - self.required

    @property
    def passive(self) -> bool:
        """Whether the damping of the device is at least the damping required."""
        return self.b >= self.required

    def asked(self, theta: ArrayLike) -> Array:
        """Return the damping [N s/m] that motion at theta = w T asks of the device, 0 < theta <= pi; shape (P,)."""
        law = self.law
        return asked(law.A, law.B, law.C, law.D, law.T, np.atleast_1d(np.asarray(theta, dtype=float)), self.delay)

    def equivalent_damper(self, theta: ArrayLike) -> Array:
        """Return the damper [N s/m] as which a sinusoid of theta = w T feels the law; negative: it draws energy."""
        return _felt_damper(self.law, theta, self.delay)

    @property
    def flat(self) -> bool:
        """Whether every frequency asks for the same."""
        return _flat(self.law, self.required, self.delay)

    def plot(self) -> Figure:
        """Draw what each frequency asks for, what a pure sinusoid asks for, and what the device has."""
        return plot_passivity_margin(self)

    def _facts(self) -> list[Fact]:
        return [fact for fact in super()._facts() if fact.name != "frequency" or self.frequency]

    def __str__(self) -> str:
        verdict = "passive in every passive hand" if self.passive else "not passive"
        at = f"at {self.frequency:.4g} Hz" if self.frequency else "at every frequency alike" if self.flat else "for slow motion"
        return (
            f"{self.law.name}: {verdict}. It needs b = {self.required:.6g} N s/m, {at}; the device has {self.b:.6g} N s/m, "
            f"{abs(self.margin):.3g} {'to spare' if self.passive else 'too little'}"
        )


def passivity_margin(device: AnyDevice, law: LinearLaw) -> PassivityMargin:
    """Passivity of a linear law on a device of damping b, frequency by frequency (Colgate and Schenkel 1997).

    Necessary and sufficient for a law that always acts; for a unilateral wall it says nothing about the switching,
    except for the plain law of Eq. (23.1) without delay.

    Parameters
    ----------
    device : Device or paddle
        Its b and delay are read, the delay in whole and fractional periods alike; its T must be that of the law.
    law : LinearLaw
        Of a name, of taps or of a scene.

    Returns
    -------
    PassivityMargin

    Raises
    ------
    AnalysisError
        The law is unstable with the handle held, or of negative stiffness, with which no damping is enough.

    Examples
    --------
    >>> import hapticlab as hl
    >>> margin = hl.passivity.margin(hl.Device(b=0.15), LinearLaw.of("backward_difference", K=100.0, T=1e-3))
    >>> round(margin.required, 9), round(margin.frequency, 3), round(margin.margin, 9)
    (0.1, 500.0, 0.05)
    """
    instance("law", law, LinearLaw, "a LinearLaw: hl.laws.LinearLaw.of('zoh', K=200, T=1e-3) or .of_scene(scene)")
    b, delay, T = known(device, "b", "delay", or_none="T")
    law.require_period(T)
    whole_and_fraction(delay, law.T, most=MOST_PERIODS)
    pole = unstable_pole(law.A, law.B, law.C)
    if pole is not None:
        raise AnalysisError(f"{law.name}: unstable with the handle held (a pole at {pole:.6g}); needs a stable law")
    if law.stiffness < 0:
        raise AnalysisError(f"{law.name}: {negative(law.stiffness)}, and no device damping can hold it; needs H(1) >= 0")
    most, theta = required(law.A, law.B, law.C, law.D, law.T, delay)
    return PassivityMargin(law, b, delay, most, theta / (2 * math.pi * law.T))


def equivalent_damper(device: AnyDevice, law: LinearLaw, theta: ArrayLike) -> Array:
    """Return the equivalent damper [N s/m] of a held law for a sinusoid x at theta = w T > 0, also above Nyquist.

    The part of the held force in phase with the velocity, over the velocity: at whole multiples of theta = pi averaged
    over the phase between motion and samples. Of the device the delay is read; its T must be that of the law.

    Parameters
    ----------
    device : Device or paddle
        Its delay and T are read.
    law : LinearLaw
        For the same T.
    theta : array_like
        Frequency times period, w T [rad], > 0.

    Examples
    --------
    >>> law = LinearLaw.of("zoh", K=100.0, T=1e-3)
    >>> import hapticlab as hl
    >>> round(float(equivalent_damper(hl.Device(T="1 ms"), law, 1e-3)), 6)  # slow motion feels -K T/2
    -0.05
    """
    delay, T = known(device, "delay", or_none="T")
    law.require_period(T)
    return _felt_damper(law, theta, delay)


def _felt_damper(law, theta, delay):
    theta = np.asarray(theta, dtype=float)
    late = np.exp(-1j * theta * delay / law.T)
    return -law.T / theta**2 * ((1 - np.exp(-1j * theta)) * law.at(theta) * late).real


def wall_damping(device: AnyDevice, *, K: float, B: float = 0.0, velocity_filter: float = 0.0) -> float:
    """Least device damping [N s/m] of a wall with a damper on a filtered velocity: Eq. (23.10) and its extension.

    ``K T/2 + |B|`` for a damper on the plain backward difference. A first-order filter of time constant tau leaves
    ``K T/2 + B/(1 + 2 tau/T)`` for B >= 0, which asks at Nyquist where the filter is small; for B < 0 it changes
    nothing, as slow motion asks (after Brown 1995). With a delay it is what :func:`passivity_margin` finds.

    Parameters
    ----------
    device : Device or paddle
        Its T and delay are read.
    K : float
        Stiffness [N/m], >= 0.
    B : float
        Virtual damper of either sign [N s/m].
    velocity_filter : float
        Time constant tau [s], >= 0.

    Examples
    --------
    >>> import hapticlab as hl
    >>> round(wall_damping(hl.Device(T="1 ms"), K=100, B=0.3, velocity_filter=1e-3), 9)
    0.15
    >>> round(wall_damping(hl.Device(T="1 ms", delay="1 ms"), K=100), 9)
    0.15
    """
    T, delay = known(device, "T", "delay")
    K = number("K", K, "N/m", "a wall", least=0, why="A negative spring pushes the handle away and is not passive.")
    tau = number("velocity_filter", velocity_filter, "s", least=0, what="a time constant")
    B = number("B", B, "N s/m", "a virtual damper")
    if delay:
        return _required(LinearLaw.of("zoh", K=K, T=T, B=B, velocity_filter=tau), delay)[0]
    return K * T / 2 + (B / (1 + 2 * tau / T) if B >= 0 else -B)


def largest_passive_stiffness(law: Callable[[float], LinearLaw], *, b: float, delay: float = 0.0) -> tuple[float, float | None]:
    """Return (K, frequency [Hz]): the largest K for which a law affine in K is passive on a device of damping b.

    ``frequency`` is 0.0 for slow motion and None where every frequency asks alike.

    What one frequency asks for is convex in K, so the K that satisfies the worst frequency of one K is an upper bound,
    and the sequence of such cuts falls to the answer. K = 0 where the law is active without its spring: at
    :func:`least_passive_stiffness`, below which a constant negative stiffness beside K is left.

    Parameters
    ----------
    law : callable
        K [N/m] -> LinearLaw, affine in K, whose stiffness at rest is K times a positive number and a constant.

    Examples
    --------
    >>> K, hertz = largest_passive_stiffness(lambda K: LinearLaw.of("ellis", K=K, T=1e-3), b=0.1)
    >>> round(K, 9), round(hertz, 3)
    (50.0, 500.0)
    """
    least, rise = least_passive_stiffness(law), law(1.0).stiffness - law(0.0).stiffness
    T, (most, theta) = law(least).T, _required(law(least), delay)
    if most > b:
        return 0.0, theta / (2 * math.pi * T)
    K = least + 4 * (b + most) / (T * rise)  # no law allows more than 2 b/T (module), nor its damper more than b
    for _ in range(60):
        most, theta = _required(law(K), delay)
        if most <= b * (1 + SETTLED):
            break
        lower = _cut(law, b, max(theta, SLOWEST), delay, least, K)
        if lower >= K * (1 - SETTLED):
            break
        K = lower
    return K, None if _flat(law(K), most, delay) else theta / (2 * math.pi * T)


def least_passive_stiffness(law: Callable[[float], LinearLaw]) -> float:
    """Return the K from which on the stiffness at rest is not negative, for a law as above; mostly 0.

    Examples
    --------
    >>> least_passive_stiffness(lambda K: LinearLaw.of("zoh", K=K - 500, T=1e-3))
    500.0
    """
    own = law(0.0).stiffness
    rise = law(1.0).stiffness - own
    if not rise > 0:
        raise AnalysisError(
            f"{law(1.0).name}: its stiffness at rest does not grow with K, so there is no largest K; give a "
            "law whose stiffness grows with K"
        )
    return max(-own / rise, 0.0)


def _flat(law, most, delay):
    """Whether all frequencies ask for ``most``."""
    values = asked(law.A, law.B, law.C, law.D, law.T, np.linspace(0.01, np.pi, 101), delay)
    return bool(math.isfinite(most) and (abs(values - most) <= ALIKE * abs(most)).all())


def _required(law, delay):
    return required(law.A, law.B, law.C, law.D, law.T, delay)


def _cut(law, b, theta, delay, least, K):
    """Return the stiffness from least to K at which theta asks for exactly b: a convex function crosses once, or at an end."""

    def excess(K):
        here = law(K)
        return float(asked(here.A, here.B, here.C, here.D, here.T, np.array([theta]), delay)[0]) - b

    if excess(K) <= 0:
        return K
    return root(excess, least, K) if excess(least) < 0 else least
