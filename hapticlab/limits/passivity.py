"""Passivity of a rendered wall in the hands of any passive user, with delay and virtual damping; exact, no grid.

Colgate and Schenkel (1997): a force ``H(z) x`` held over each period is made passive by the device's damping b where
``b > (T/2) Re{(1 - 1/z) H} / (1 - cos wT)`` at every w. For ``H = z^-k`` the fraction is Dirichlet's kernel
``D_k = 1 + 2 cos wT + ... + 2 cos kwT``, a polynomial in u = cos wT, so the worst frequency is a root of a derivative.

A delay of d + f periods, 0 < f < 1, changes the force f*T after each sample. Let the hand split its motion over a
period into D1 before and D2 after the change; the cheapest split of ``(b/T)(D1^2/f + D2^2/(1-f)) + F[n-1] D1 + F[n]
D2`` leaves the condition used below,

    b - R(u) - T^2 f (1-f) |H|^2 / (4b) >= 0    for all u in [-1, 1],

with R Colgate's expression for the averaged law ``((1-f) + f/z) H``. It is linear or concave in K at each u, so cutting
at the worst u of one K gives the next K, and that sequence falls to the limit faster than linearly.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.polynomial import chebyshev

from ..base.arguments import choice, number, period
from ..device.device import known
from ..errors import AnalysisError
from ..scene.laws.taps import LEAD, TAPS
from .affine_law import affine_law
from .colgate import largest_passive_stiffness, least_passive_stiffness
from .limit import MOST_PERIODS, AnyHand, Limit, whole_and_fraction
from .linear_law import LinearLaw
from .port import unstable_pole

if TYPE_CHECKING:
    from ..device.device import AnyDevice
    from ..scene.laws.taps import LawName
    from .affine_law import StiffnessLaw

KIND = AnyHand("passivity: any passive hand, sufficient")
SWITCHING_NOT_COVERED = "the spring always acts; the switching of a unilateral wall is not accounted for"
NO_DAMPING = "b = 0: without device damping nothing dissipates the energy that the hold generates"
NO_VELOCITY = "its exact velocity jumps at the samples, so a hand that moves only there draws energy at any stiffness"


def passivity_limit(
    device: AnyDevice,
    *,
    B: float = 0.0,
    law: StiffnessLaw = "zoh",
    velocity_filter: float = 0.0,
    parameter: str = "k",
) -> Limit:
    """Largest stiffness at which no passive hand can make the wall chatter, Eq. (23.10) and its general form.

    The limit is necessary and sufficient if the spring always acts. For a unilateral wall it is sufficient with law
    "zoh" and no delay. If the law or the delay uses past samples, it does not account for the switching at the
    boundary.

    Parameters
    ----------
    device : Device or paddle
        Its b, T and delay are used; the delay can have whole and fractional periods.
    B : float
        Virtual damper of either sign [N s/m]: its force is ``B*(x[n] - x[n-1])/T``, in addition to the law, not through
        it.
    law : str, Scene or callable
        Eqs. (23.1), (23.3), (23.5), (23.7) by name: "zoh", "half_sample", "backward_difference", "ellis". Or a linear
        scene with its stiffness unbound, velocity by backward difference; or a function of K [N/m] that returns a
        LinearLaw.
    velocity_filter : float
        With a named law, as for B: time constant tau [s] >= 0 of a first-order filter of the damper's velocity: ``v[n]
        = (tau v[n-1] + x[n] - x[n-1])/(tau + T)``. With a damper B > 0 it reduces the device damping that is needed;
        with B < 0 it does not.
    parameter : str
        The scene's parameter that is K; its force must be affine in it.

    Returns
    -------
    Limit
        K = 0 with the reason if no stiffness is passive; ``frequency`` is 0.0 if slow motion decides. If the law has a
        negative stiffness in addition to K, the reason gives the K above which it is passive.

    Raises
    ------
    AnalysisError
        For a value that is not finite or out of range, an unknown law, and B or velocity_filter with a law of your own.

    Examples
    --------
    >>> from hapticlab.device.device import Device
    >>> device = Device(b=0.1, T="1 ms")
    >>> float(passivity_limit(device))
    200.0
    >>> round(float(passivity_limit(device, B=0.05)), 9)
    100.0
    >>> passivity_limit(device, law="half_sample").K
    0.0
    """
    B = number("B", B, "N s/m")
    b, T, delay = known(device, "b", "T", "delay")
    tau = number("velocity_filter", velocity_filter, "s", least=0, what="a time constant")
    notes = ("device damping b alone: no encoder, no Coulomb friction",)
    if not isinstance(law, str):
        if tau:
            raise AnalysisError(
                f"velocity_filter = {tau:g} s with a law of your own; only a named law has a velocity filter. Put the "
                "filter into the law, "
                'as hl.wall(velocity=hl.velocity.filtered(tau="4 ms"), unilateral=None)'
            )
        _checked(T, B, delay, "zoh")
        if b == 0:
            return Limit(0.0, None, KIND, NO_DAMPING, notes)
        return _of_own_law(law, b, T, B, delay, parameter, notes)
    whole, fraction = _checked(T, B, delay, law)
    if LEAD[law]:
        return Limit(0.0, None, KIND, f"law {law}: {NO_VELOCITY}", notes)
    if b == 0:
        return Limit(0.0, None, KIND, NO_DAMPING, notes)
    if tau and B:
        name = f"with B = {B:g} N s/m on a velocity filtered over {1e3 * tau:g} ms"
        filtered = lambda K: LinearLaw.of(law, K=K, T=T, B=B, velocity_filter=tau)  # noqa: E731
        return _of_any_law(filtered, b, delay, name, notes)
    beta = B / b
    _, margin = _worst(_law_taps(0.0, beta, law), whole, fraction, 1.0)
    if margin < 0:
        return Limit(
            0.0, None, KIND, f"B = {B:g} N s/m is not passive even without the spring: it needs more than b = {b:g} N s/m", notes
        )
    kappa, u = _falling_cuts(lambda k: _law_taps(k, beta, law), whole, fraction)
    frequency = None if u is None else math.acos(u) / (2 * math.pi * T)
    reason = f"b = {b:g} N s/m is just enough, {_place(frequency, T)}"
    return Limit(float(kappa * b / T), frequency, KIND, reason, (*notes, _unilateral(law, delay)))


def required_damping(*, K: float, T: float, B: float = 0.0, delay: float = 0.0, law: LawName = "zoh") -> float:
    """Least device damping b [N s/m] that makes a wall passive: Eq. (23.10) read as a design directive.

    Parameters
    ----------
    K : float
        Stiffness [N/m], >= 0. The other arguments are as for :func:`passivity_limit`.

    Returns
    -------
    float
        ``inf`` for law "half_sample", which no damping makes passive.

    Examples
    --------
    >>> round(required_damping(K=200, T=1e-3, B=0.05), 12)
    0.15
    """
    K = number("K", K, "N/m", "a wall", least=0, why="A negative spring pushes the handle away and is not passive.")
    whole, fraction = _checked(T, B, delay, law)
    if LEAD[law] and K:
        return math.inf
    taps = _law_taps(K * T, B, law)
    if not taps.any():
        return 0.0
    b = 1e-9 * abs(taps).sum()  # below every answer but zero
    for _ in range(60):  # rising cuts: the u that is worst at this b, then the b that u asks for
        u, margin = _worst(taps, whole, fraction, b)
        linear, square = (chebyshev.chebval(0.0 if u is None else u, c) for c in _parts(taps, whole, fraction))
        asked = float(linear + math.sqrt(linear**2 + square)) / 2
        if margin >= 0 or asked <= b:
            break
        b = asked
    return b


def _of_any_law(law, b, delay, name, notes):
    """The limit by a search over frequencies, of a function of K that gives a LinearLaw."""
    K, hertz = largest_passive_stiffness(law, b=b, delay=delay)
    if not K:
        return Limit(0.0, None, KIND, f"{name}: not passive even without its spring, with b = {b:g} N s/m", notes)
    least = least_passive_stiffness(law)
    from_on = f", passive only above K = {least:.6g} N/m, because below it the stiffness at rest is negative" if least else ""
    reason = f"b = {b:g} N s/m is just enough, {_place(hertz, law(K).T)}; {name}{from_on}"
    return Limit(K, hertz, KIND, reason, (*notes, _unilateral(name, delay)))


def _place(frequency, T):
    """Return in words which frequency [Hz] decides."""
    if frequency is None:
        return "all frequencies alike"
    return f"worst at {2 * T * frequency:.4g} of the Nyquist frequency" if frequency else "worst for slow motion"


def _of_own_law(law, b, T, B, delay, parameter, notes):
    """The limit of a scene or a function of K."""
    parts = affine_law(law, T=T, B=B, parameter=parameter)
    if any(part.any() for part in (parts.B0[:, 1], parts.B1[:, 1], parts.D0[1:], parts.D1[1:])):
        return Limit(0.0, None, KIND, f"{parts.name}: {NO_VELOCITY}", notes)

    def at(K):
        enters, C, D = parts.at(K)
        return LinearLaw(parts.A, enters[:, 0], C, float(D[0]), T, parts.name)

    pole = unstable_pole(parts.A, at(1.0).B, at(1.0).C)
    if pole is not None:
        raise AnalysisError(f"{parts.name}: unstable with the handle held (a pole at {pole:.6g}); needs a stable law")
    return _of_any_law(at, b, delay, parts.name, notes)


def _checked(T, B, delay, law):
    choice("law", law, TAPS)
    T = period(T)
    number("B", B, "N s/m", "a virtual damper")
    delay = number("delay", delay, "s", least=0, why="a force cannot come before its sample")
    return whole_and_fraction(delay, T, most=MOST_PERIODS)


def _unilateral(law, delay):
    if law == "zoh" and not delay:
        return "sufficient for the unilateral wall too"
    return SWITCHING_NOT_COVERED


def _law_taps(K, B, law):
    """Weights of H on past samples; with K and B in units of one force, so that K stands for K*T."""
    taps = np.zeros(4)
    taps[: len(TAPS[law])] = K * np.array(TAPS[law])
    taps[:2] += (B, -B)
    return taps


def _parts(taps, whole, fraction):
    """Chebyshev coefficients of R(u) and of f(1-f)|H|^2, where the condition reads b - R - f(1-f)|H|^2/(4b) >= 0."""
    averaged = np.convolve(np.r_[np.zeros(whole), taps], [1 - fraction, fraction])
    tail = np.cumsum(averaged[::-1])[::-1]  # T_j appears twice in every D_k with k >= j
    linear = np.r_[tail[0] / 2, tail[1:]]
    lags = np.correlate(taps, taps, "full")[len(taps) - 1 :]
    square = fraction * (1 - fraction) * np.r_[lags[0], 2 * lags[1:]]
    return linear, square


def _worst(taps, whole, fraction, b):
    """Return u in [-1, 1] of the least margin and that margin; u is None where the margin is flat."""
    linear, square = _parts(taps, whole, fraction)
    margin = chebyshev.chebsub([b], chebyshev.chebadd(linear, square / (4 * b)))
    size = abs(margin).max()
    while len(margin) > 1 and abs(margin[-1]) <= 1e-15 * size:  # a tap of zero is no degree
        margin = margin[:-1]
    if len(margin) == 1:
        return None, margin[0]
    stationary = chebyshev.chebroots(chebyshev.chebder(margin)) if len(margin) > 2 else []
    u = np.clip(np.r_[-1.0, 1.0, np.real(stationary)], -1, 1)  # every u is a true condition, so extra ones do no harm
    margins = chebyshev.chebval(u, margin)
    return u[np.argmin(margins)], margins.min()


def _falling_cuts(taps_of, whole, fraction):
    """Return the largest K*T/b and the u that sets it, with b = 1."""
    kappa, at = 8.0, None  # above every limit: at most 4 with the delay under half a period, at most 4 beyond
    intercept, slope = taps_of(0.0), taps_of(1.0) - taps_of(0.0)
    for _ in range(60):
        u, margin = _worst(taps_of(kappa), whole, fraction, 1.0)
        if margin >= -1e-15:
            break
        at = u
        kappa_next = _root(intercept, slope, whole, fraction, 0.0 if u is None else u)
        if kappa_next >= kappa:
            break
        kappa = kappa_next
    return kappa, at


def _root(intercept, slope, whole, fraction, u):
    """Return the positive K at which the margin 1 - R - f(1-f)|H|^2/4, a quadratic in K, is zero at u."""
    margins = []
    for k in (0.0, 1.0, -1.0):
        linear, square = _parts(intercept + k * slope, whole, fraction)
        margins.append(1 - chebyshev.chebval(u, linear) - chebyshev.chebval(u, square) / 4)
    c, one, minus = margins
    a, half = min((one + minus) / 2 - c, 0.0), (one - minus) / 4
    denominator = math.sqrt(half**2 - a * c) - half
    return max(c / denominator, 0.0) if denominator > 0 else math.inf
