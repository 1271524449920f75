"""Velocity by a Kalman filter of position and velocity, with gains that are steady or run in from the start."""

from typing import Any

import sympy as sp

from ..notation.amount import amount
from ..notation.parameters import T
from ..notation.symbols import n, signal, when, x
from .estimators import VelocityEstimate, backward_velocity


def kalman_velocity(
    *, acceleration: Any, noise: Any, steady: bool = True, speed: Any = 1.0, name: str = "kalman"
) -> VelocityEstimate:
    """Kalman filter of position and velocity under white acceleration, held over each period.

    With the tracking index L = acceleration T^2/noise the steady gains are closed forms, Kalata, *The tracking index*,
    IEEE Trans. Aerospace and Electronic Systems 20 (1984) 174-182: alpha = 1 - r^2, beta = 2 (1 - r)^2,
    1 - r = 2 L/(L + sqrt(L^2 + 8 L)). The filter predicts a period ahead by Eq. (23.4) with its own velocity, and
    corrects the place by alpha and the speed by beta/T of what it missed.

    Parameters
    ----------
    acceleration : float, text or Parameter
        Standard deviation of the handle's acceleration [m/s^2], > 0: the greater, the quicker and the noisier.
    noise : float, text or Parameter
        Standard deviation of a position [m], > 0; an encoder's count D has D/sqrt(12).
    steady : bool
        ``False`` carries the covariance along, from a start at unknown speed: right from the second sample on, for
        about twice the work.
    speed : float, text or Parameter
        Standard deviation of the speed at the start [m/s], for ``steady=False``.
    name : str
        Of its signals.

    Returns
    -------
    VelocityEstimate

    Examples
    --------
    >>> import hapticlab as hl
    >>> estimate = hl.velocity.kalman(acceleration=50, noise="10 um")
    >>> [round(c, 6) for c in estimate.transfer(1e-3)[1]]
    [1.0, 0.117218, 0.05496]
    """
    sigma = amount(acceleration, "m/s^2", "acceleration", "the handle", above=0), amount(noise, "m", "noise", "a sensor", above=0)
    index = sigma[0] * T**2 / sigma[1]
    plainer = [] if steady else [kalman_velocity(acceleration=acceleration, noise=noise, name=name)]
    cheaper = (*plainer, backward_velocity())
    place, rate = signal(f"{name}_x", unit="m", initial=x(n)), signal(f"{name}_v", unit="m/s", instead=cheaper)
    if steady:
        lead = signal(f"{name}_lead", unit="1")
        eom: tuple[sp.Eq, ...] = (sp.Eq(lead(n), _lead(index)),)
        alpha, beta = _steady_gains(lead(n))
    else:
        start = (amount(speed, "m/s", "speed", "the handle", above=0) * T / sigma[1]) ** 2
        (alpha, beta), eom = _gains(index, start, name)
    missed, pull = signal(f"{name}_missed", unit="m"), signal(f"{name}_pull", unit="1/s")
    eom += (
        sp.Eq(missed(n), x(n) - (place(n - 1) + T * rate(n - 1))),
        sp.Eq(place(n), x(n) - (1 - alpha) * missed(n)),
        sp.Eq(pull(n), beta / T),  # a name of its own keeps it whole: one constant, or one division
        sp.Eq(rate(n), rate(n - 1) + pull(n) * missed(n)),
    )
    a, b = _steady_gains(_lead(index))
    transfer = ((b / T, -b / T), (1, a + b - 2, 1 - a)) if steady else ()
    title = "Kalman filter" + ("" if steady else " from the start")
    return VelocityEstimate(
        rate(n), eom, title, cheaper, transfer, T * (a / b - sp.Rational(1, 2)) if steady else None,
        "Kalata, IEEE Trans. Aerospace and Electronic Systems 20 (1984) 174-182",
        "an observer with a model of the paddle, as in hl.laws.predictive_wall: this filter uses neither mass nor force",
    )  # fmt: skip


def _lead(index):
    return 2 * index / (index + sp.sqrt(index**2 + 8 * index))  # 1 - r, without the difference


def _steady_gains(lead):
    return lead * (2 - lead), 2 * lead**2


def _gains(index, start, name):
    """Kalman gains by the recursion of the covariance, in units of the noise and the period."""
    p = [signal(f"{name}_p{part}", unit="1", initial=first) for part, first in (("xx", 1), ("xv", 0), ("vv", start))]
    ahead = [signal(f"{name}_a{part}", unit="1") for part in ("xx", "xv", "vv")]
    gain = [signal(f"{name}_g{part}", unit="1") for part in ("x", "v")]
    xx, xv, vv = (q(n - 1) for q in p)
    predicted = xx + 2 * xv + vv + index**2 / 4, xv + vv + index**2 / 2, vv + index**2
    eom = [sp.Eq(a(n), value) for a, value in zip(ahead, predicted, strict=True)]
    eom += [sp.Eq(g(n), a(n) / (ahead[0](n) + 1)) for g, a in zip(gain, ahead, strict=False)]
    updated = gain[0](n), gain[1](n), ahead[2](n) - gain[1](n) * ahead[1](n)
    # the first sample is a measurement alone: there is no prediction to weigh it against
    eom += [sp.Eq(q(n), when(n > 0, after, type(q(n)).initial)) for q, after in zip(p, updated, strict=True)]
    return (gain[0](n), gain[1](n)), tuple(eom)
