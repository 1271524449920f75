"""Two coupled paddles between two hands, as a two-port: which coupling is stable in every pair of passive hands.

In the sense of Colgate and Schenkel device and hand stay in continuous time: over a period in which F is held, a device of
damping b takes at least b u^2 T, u its mean velocity, beside the work F u T. With x = T u/(z - 1) the two handles are

    Z = diag(b_1, b_2) + E(z) (k + b_c (1 - 1/z)/T) T/(z - 1)    from the mean velocities to the forces of the hands,

with E of :mod:`~hapticlab.limits.coupled.two_hands`. Llewellyn's criterion on it is exact where the paddles have no delay of
their own.
Slow motion alone asks for k <= b/(delay + T) of two like paddles with position-position, delay that of the link.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from ...base.arguments import choice, number
from ...device.device import known
from ...errors import AnalysisError
from ...scene.laws.bilateral import ARCHITECTURES, CUTOFF
from ..limit import AnyHand, Limit
from ..two_port import TwoPort, frequencies, hertz
from .two_hands import OUTSIDE, angles, poles_outside, ticks_of

if TYPE_CHECKING:
    from ...base.annotations import Number
    from ...device.device import AnyDevice

NOTES = (
    "does not account for encoders, force limits, jitter and lost messages",
    "a paddle's own delay counts as whole periods, rounded up",
)
KIND = AnyHand("stability in every pair of passive hands")
#: relative accuracy of a limit
ACCURACY = 1e-9


def coupled_paddles(
    left: AnyDevice,
    right: AnyDevice,
    *,
    architecture: str = "position-position",
    delay: Number = 0.0,
    k: Number = 0.0,
    b: Number = 0.0,
    cutoff: Number = CUTOFF,
) -> TwoPort:
    """The two-port of two coupled paddles between their hands, by Llewellyn's criterion.

    Parameters
    ----------
    left, right : Device or paddle
        Their b, T and delay are read; a passive hand may take any mass away. In position-force the left one leads.
    architecture, delay, b, cutoff
        As for :func:`hapticlab.stability.coupling_limit`; for "wave" b is the wave impedance, and k has to be 0.
    k : float or text [N/m]

    Returns
    -------
    TwoPort
        ``absolutely_stable`` says whether every pair of passive hands is stable.

    Raises
    ------
    AnalysisError

    Examples
    --------
    >>> import hapticlab as hl
    >>> paddle = hl.Device(b=0.5, T="1 ms")
    >>> [coupled_paddles(paddle, paddle, k=k, delay="9 ms").absolutely_stable for k in (49, 51)]
    [True, False]
    """
    choice("architecture", architecture, ARCHITECTURES)
    k, b = number("k", k, "N/m", "a coupling", least=0), number("b", b, "N s/m", "a coupling", least=0)
    cutoff = number("cutoff", cutoff, "1/s", "a coupling", above=0)
    if architecture == "wave" and k:
        raise AnalysisError(f"k = {k:g} N/m beside waves is not passive under any delay; needs k = 0")
    (b1, T, own), (b2, its, other) = (known(one, "b", "T", "delay") for one in (left, right))
    ticks, late = ticks_of(delay, T, its), [math.ceil(time / T - 1e-9) for time in (own, other)]

    def impedances(z):
        q = (k + b * (1 - 1 / z) / T) * T / (z - 1)
        w = z**-ticks
        if architecture == "wave":
            w = w / (1 + (1 - 1 / z) / (2 * math.pi * cutoff * T))
            return [[c / (1 - w**2) * q for c in row] for row in ((1 + w**2, -2 * w), (-2 * w, 1 + w**2))]
        return [[(w**2 if architecture == "position-force" else 1) * q, -w * q], [-w * q, q]]

    def h(theta):
        z = np.exp(1j * theta)
        (Z11, Z12), (Z21, Z22) = impedances(z)
        (Z11, Z12), (Z21, Z22) = (Z11 * z ** -late[0] + b1, Z12 * z ** -late[0]), (Z21 * z ** -late[1], Z22 * z ** -late[1] + b2)
        return np.moveaxis(np.array([[Z11 - Z12 * Z21 / Z22, Z12 / Z22], [-Z21 / Z22, 1 / Z22]]), 2, 0)

    def alone(theta):
        z = np.exp(1j * theta + OUTSIDE)
        return (impedances(z)[1][1] * z ** -late[1] + b2) * (1 - 1 / z)

    name = f"{architecture} coupling, k = {k:g} N/m, b = {b:g} N s/m, late by {1e3 * ticks * T:g} ms"
    return TwoPort(h, T, name, stable=poles_outside(alone(angles())) == 0)


def coupling_any_hand(
    left: AnyDevice, right: AnyDevice, *, architecture: str = "position-position", delay: Number = 0.0, b: Number = 0.0
) -> Limit:
    """Largest stiffness of the coupling of two paddles at which every pair of passive hands is stable.

    For two like paddles with position-position it is about b_device/(delay + T): what Eq. (23.10) is for a wall.

    Parameters
    ----------
    left, right, architecture, delay, b
        As for :func:`hapticlab.stability.coupling_limit`; their hands are not read.

    Returns
    -------
    Limit

    Examples
    --------
    >>> import hapticlab as hl
    >>> paddle = hl.Device(b=0.5, T="1 ms")
    >>> round(coupling_any_hand(paddle, paddle, delay="9 ms").K, 2)
    50.0
    """
    choice("architecture", architecture, ARCHITECTURES[:2])

    def port(k):
        return coupled_paddles(left, right, architecture=architecture, delay=delay, k=k, b=b)

    low, high = 0.0, sum(known(one, "b")[0] for one in (left, right)) / known(left, "T")[0]
    if not high or not port(ACCURACY * high).absolutely_stable:
        return Limit(0.0, None, KIND, "the smallest stiffness is unstable in some pair of hands", NOTES)
    while high - low > ACCURACY * high:
        middle = (low + high) / 2
        low, high = (middle, high) if port(middle).absolutely_stable else (low, middle)
    beyond = port(high)
    theta = frequencies()
    worst = float(theta[beyond.criterion(theta).argmin()])
    return Limit(low, hertz(beyond.criterion, worst, beyond.T, size=1.0), KIND, "Llewellyn's criterion", NOTES)
