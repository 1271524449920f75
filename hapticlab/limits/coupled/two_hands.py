"""Two handles coupled over a link, as one sampled loop: largest stiffness in these two hands, exactly.

Handle i has x_i = -X_i(z) F_i and a sensed velocity v_i = -W_i(z) F_i, hold, hand and delays of its paddle included. A link that
is late by d ticks, w = z^-d, gives F = E(z) (k x + b v), where E is

    position-position  [[1, -w], [-w, 1]]
    position-force     [[w^2, -w], [-w, 1]], the leader first
    wave               [[1 + w^2, -2 w], [-2 w, 1 + w^2]]/(1 - w^2), with k = 0, and w the filter of the waves too

so that poles are the roots of 1 + E11 Q1 + E22 Q2 + det(E) Q1 Q2, with Q = k X + b W: a quadratic in what is sought. A pole can
reach the unit circle only where this has a real root, which is where the resultant of its real and imaginary parts is zero.
The poles outside are counted by how often the phase turns along the circle.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...base.arguments import choice, number
from ...base.roots import root
from ...device.device import known
from ...errors import AnalysisError
from ...scene.laws.bilateral import ARCHITECTURES, CUTOFF
from ..limit import MOST_PERIODS, Limit
from ..loop import Loop

if TYPE_CHECKING:
    from ...base.annotations import Number
    from ...device.device import AnyDevice

NOTES = (
    "both handles, both hands, the link and the coupling alone, every message used at the next sample",
    "does not account for encoders, noise, Coulomb friction, force limits, jitter and lost messages; other hands may be unstable "
    "at a lower stiffness",
)
#: least angle looked at, beside 0 [rad]
SLOWEST = 1e-10
#: slow angles, and evenly spaced ones in half a turn of the longest delay, there and back
POINTS, PER_TURN = 4000, 50
#: poles are outside beyond the circle of this log radius; a pair of free handles has one at 1, where both rest
OUTSIDE = 1e-8


def coupling_limit(
    left: AnyDevice, right: AnyDevice, *, architecture: str = "position-position", delay: Number = 0.0, b: Number = 0.0
) -> Limit:
    """Largest stiffness of the coupling at which two handles in these two hands are stable; exact, linear.

    Two like handles with position-position move against each other on a spring 2 k, half of which is late, and lose it
    at about (b_handle + 2 b)/(delay + T).

    Parameters
    ----------
    left, right : Device or paddle
        Their m, b, T, delay, hand and velocity are used. In position-force the left one is the leader.
    architecture : {"position-position", "position-force"}
        As for :func:`hapticlab.laws.bilateral_coupling`; for waves see :func:`wave_impedance_limit`.
    delay : float or text [s]
        Of the link in each direction, rounded to whole ticks, one at least, as :class:`hapticlab.devices.TwoPaddles`
        does.
    b : float or text [N s/m]
        Damping of the coupling.

    Returns
    -------
    Limit
        Infinite where no stiffness is unstable, 0 where the smallest one is.

    Raises
    ------
    AnalysisError

    Examples
    --------
    >>> import hapticlab as hl
    >>> handle = hl.Device(m=0.05, b=0.5, T="1 ms")
    >>> round(coupling_limit(handle, handle, delay="9 ms").K, 2), round(0.5 / 0.010, 2)
    (51.44, 50.0)
    """
    choice("architecture", architecture, ARCHITECTURES[:2])
    b = number("b", b, "N s/m", "a coupling", least=0)
    link = link_of(left, right, delay)
    K, theta, stable = _limit(lambda theta: link.terms(theta, architecture, b))
    kind = f"exact linear stability of {architecture} coupling, late by {1e3 * link.delay:g} ms"
    reason = _why(K, stable)
    return Limit(K, None if theta is None else theta / (2 * math.pi * link.T), kind, reason, NOTES)


def wave_impedance_limit(left: AnyDevice, right: AnyDevice, *, delay: Number = 0.0, cutoff: Number = CUTOFF) -> float:
    """Largest wave impedance b [N s/m] of a coupling by waves at which two handles in these two hands are stable.

    In continuous time every b is stable, whatever the delay. Here the force is held while the handle moves on, so that a
    handle reflects fast waves with a gain slightly above 1, which the filter of the waves has to take away.

    Parameters
    ----------
    left, right, delay
        As for :func:`coupling_limit`.
    cutoff : float or text [Hz]
        Of the filter, as for :func:`hapticlab.laws.bilateral_coupling`.

    Returns
    -------
    float

    Examples
    --------
    >>> import hapticlab as hl
    >>> handle = hl.Device(m=0.05, b=0.5, T="1 ms")
    >>> [round(wave_impedance_limit(handle, handle, delay=delay), 1) for delay in ("5 ms", "50 ms")]
    [52.8, 51.9]
    """
    link, cutoff = link_of(left, right, delay), number("cutoff", cutoff, "1/s", "a coupling", above=0)
    return _limit(lambda theta: link.wave_terms(theta, cutoff))[0]


@dataclass(frozen=True)
class Link:
    """Two handles and the ticks of delay between them.

    Attributes
    ----------
    loops : (Loop, Loop)
    measured : (bool, bool)
        Whether a side has the exact velocity.
    ticks : int
    """

    loops: tuple[Loop, Loop]
    measured: tuple[bool, bool]
    ticks: int

    @property
    def T(self) -> float:
        """Sampling period [s]."""
        return self.loops[0].T

    @property
    def delay(self) -> float:
        """Of the link, as rounded [s]."""
        return self.ticks * self.T

    def handles(self, theta):
        """Numerators of X and W of both handles at z = e^(j theta), their denominators, w and z."""
        offset, z = np.expm1(1j * theta), np.exp(1j * theta)
        X, W, bottoms = [], [], []
        for loop, exact in zip(self.loops, self.measured, strict=True):
            bottom, x, v = loop.plant
            position, speed = ((_at(newer, offset) + _at(older, offset) / z) * z**-loop.whole for newer, older in (x, v))
            X.append(position)
            W.append((speed if exact else position * offset / z) / loop.T)
            bottoms.append(_at(bottom, offset))
        return X, W, bottoms, z**-self.ticks, z

    def terms(self, theta, architecture, b):
        """The quadratic in k at these angles, times what makes it finite: (constant, k, k^2), each of the shape of theta."""
        (X1, X2), (W1, W2), (n1, n2), w, z = self.handles(theta)
        E11, det = (w**2, 0 * w) if architecture == "position-force" else (1 + 0 * w, 1 - w**2)
        constant = n1 * n2 + b * (E11 * W1 * n2 + W2 * n1) + b**2 * det * W1 * W2
        linear = E11 * X1 * n2 + X2 * n1 + b * det * (X1 * W2 + X2 * W1)
        return np.array([constant, linear, det * X1 * X2]) / z**4

    def wave_terms(self, theta, cutoff):
        """The quadratic in b of waves, as :meth:`terms`, behind their filter."""
        _, (W1, W2), (n1, n2), w, z = self.handles(theta)
        w = w / (1 + (1 - 1 / z) / (2 * math.pi * cutoff * self.T))
        return np.array([(1 - w**2) * n1 * n2, (1 + w**2) * (W1 * n2 + W2 * n1), (1 - w**2) * W1 * W2]) / z**4


def link_of(left: AnyDevice, right: AnyDevice, delay: Number) -> Link:
    """The two handles with a link of this delay [s]."""
    loops = Loop.of(left, "zoh"), Loop.of(right, "zoh")
    exact = known(left, "velocity") == ("measured",), known(right, "velocity") == ("measured",)
    return Link(loops, exact, ticks_of(delay, loops[0].T, loops[1].T))


def ticks_of(delay: Number, T: float, other: float) -> int:
    """The delay of a link [s] in whole ticks of both paddles, one at least."""
    if not math.isclose(T, other, rel_tol=1e-9):
        raise AnalysisError(f"T = {T:g} s and {other:g} s; two coupled paddles need the same T here")
    ticks = max(1, round(number("delay", delay, "s", "a link", least=0) / T))
    if ticks > MOST_PERIODS:
        raise AnalysisError(f"delay = {ticks * T:g} s is {ticks} periods; needs at most {MOST_PERIODS}")
    return ticks


def angles():
    """Angles from 0 to pi, close enough together for the phase of the longest delay."""
    return np.unique(np.r_[0.0, np.geomspace(SLOWEST, 0.1, POINTS), np.linspace(0.01, math.pi, PER_TURN * MOST_PERIODS)])


def _limit(terms):
    """Return (value, theta, stable): the first value above 0 from which on a pole is outside, and whether it is stable below."""
    theta = angles()
    crossings = _crossings(terms, theta)
    values = [value for value, _ in crossings]
    between = [value / 2 for value in values[:1]] + [math.sqrt(a * b) for a, b in zip(values, values[1:], strict=False)]
    between.append(2 * values[-1] if values else 1.0)
    table = terms(theta - 1j * OUTSIDE)
    unstable = [poles_outside(table[0] + value * (table[1] + value * table[2])) > 0 for value in between]
    if not any(unstable):
        return math.inf, None, True
    first = unstable.index(True)
    return (*crossings[first - 1], True) if first else (0.0, None, False)


def _crossings(terms, theta):
    """Values > 0 with a pole on the circle, each with its angle, by rising value."""
    sizes = np.abs(terms(theta))
    scale = float(np.median(sizes[0] / np.maximum(sizes[1], 1e-300)))  # a value of the size of what is sought

    def resultant(at):
        c, b, a = terms(np.atleast_1d(at)) * np.array([[1.0], [scale], [scale**2]])
        minors = [_minor(a, c), _minor(a, b), _minor(b, c)]
        return minors[0] ** 2 - minors[1] * minors[2] if a.any() else minors[2]

    values = resultant(theta)
    ends = [root(lambda at: float(resultant(at)[0]), *theta[i : i + 2]) for i in np.flatnonzero(values[1:] * values[:-1] < 0)]
    found = [(value, float(at)) for at in [*ends, math.pi] for value in _real_roots(terms(np.array([at]))[:, 0])]
    return sorted(found)


def _minor(p, q):
    return p.real * q.imag - p.imag * q.real


def _real_roots(terms):
    """The roots > 0 of a quadratic, constant first, that are real but for rounding."""
    return [float(one.real) for one in np.roots(terms[::-1]) if one.real > 0 and abs(one.imag) < 1e-5 * abs(one)]


def poles_outside(values):
    """How many zeros a function of z has outside the unit circle that is 1 at infinity: turns of its phase.

    Parameters
    ----------
    values : array
        At :func:`angles`, on a circle of log radius OUTSIDE.
    """
    phase = np.unwrap(np.angle(values))
    return -round((phase[-1] - phase[0]) / math.pi)  # both halves of the circle turn alike


def _why(K, stable):
    if not stable:
        return "unstable at the smallest stiffness"
    return "no stiffness moves a pole out of the unit circle" if math.isinf(K) else "a pole crosses the unit circle"


def _at(c, w):
    """Evaluate a polynomial by Horner's rule, lowest power first."""
    total = c[-1] + 0 * w
    for a in c[-2::-1]:
        total = total * w + a
    return total
