"""The bounds of the field by their authors' names: what each promises, what it assumes, and an error where that fails."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from ..base.arguments import choice, number
from ..base.grid import Grid
from ..base.shows_itself import ShowsItself, Tabular
from ..device.device import known
from ..errors import AnalysisError
from ..scene.laws.taps import LEAD, TAPS
from .limit import AnyHand, Limit, whole_and_fraction
from .passivity import passivity_limit, required_damping
from .plots import plot_bounds, plot_diolaiti
from .stability import stability_limit

if TYPE_CHECKING:
    from collections.abc import Callable

    from matplotlib.figure import Figure

    from ..device.device import AnyDevice
    from ..scene.laws.taps import LawName

#: numbers of a device whose hold viscous damping pays for, and whose encoder Coulomb friction
TWO_MODES = ("b", "T", "delay", "coulomb", "counts_per_metre")
#: what e of :func:`gil_limit` may be at most for Gil's formula
SLOW_ENOUGH = 0.1
PASSIVITY = AnyHand("passivity: any hand, sufficient")
SINUSOIDS = "for slow sinusoids only: not passivity, which ends at a lower stiffness"
STABILITY = "stability of this plant, to first order in the delay"
REGIONS = {
    (True, True): "passive: comes to rest from anywhere",
    (True, False): "limit cycles: large motions die away to a buzz of about a count",
    (False, True): "locally stable: comes to rest from small motions, large ones grow",
    (False, False): "unstable: small and large motions grow",
}
#: where friction is too weak for one count of the encoder, and an amplitude of so many counts tells small from large motions
FEW_COUNTS = 4
BUZZES = "unstable for large motions: they grow, and smaller ones die away to rest or to a buzz of about a count"
#: beta is large enough for slow sinusoids, and a delay of a fraction of a period lets a hand draw energy all the same
NOT_PASSIVE = "slow motions come to rest, not passive: a hand that moves faster before the force changes draws energy"


def abbott_okamura_limit(device: AnyDevice, *, B: float = 0.0, law: LawName = "zoh") -> Limit:
    """Largest stiffness that is passive with a quantised position: K <= min(2 b/T, 2 f_c/Delta) (Abbott and Okamura 2005).

    Two modes of their own: the hold, paid for by viscous damping, and the encoder, paid for by Coulomb friction alone.

    Parameters
    ----------
    device : Device or paddle
        Its b, T, coulomb, f_c of the equation, and counts_per_metre, 1/Delta, are read; its delay must be 0.
    B : float
        Virtual damper [N s/m], which must be 0.
    law : str
        Which must be "zoh".

    Returns
    -------
    Limit

    Raises
    ------
    AnalysisError
        With virtual damping, delay or a law other than Eq. (23.1), of which the bound knows nothing.

    Examples
    --------
    >>> import hapticlab as hl
    >>> print(hl.bounds.abbott_okamura(hl.Device(b=0.1, T="1 ms", coulomb=0.02, counts_per_metre=4000)).K)
    160.0
    """
    b, T, delay, coulomb, counts = known(device, *TWO_MODES)
    for name, value, unit in (("B", B, "N s/m"), ("delay", delay, "s")):
        if value:
            raise AnalysisError(
                f"{name} = {value:g} {unit}; the bound of Abbott and Okamura is for a plain spring without {name}"
            )
    _plain(law, "Abbott and Okamura")
    return _two_modes(b, T, coulomb, counts, 0.5, "Abbott and Okamura 2005")


def diolaiti_limit(device: AnyDevice, *, B: float = 0.0, law: LawName = "zoh") -> Limit:
    """Largest stiffness of the passive region of Diolaiti et al. (2006): b/(K T) >= 1/2 + delay/T and f_c/(K Delta) >= 1/2.

    With a whole number of periods of delay the first is exact. With a fraction it is what slow sinusoids ask for, and
    up to 8 % above what every motion allows (:func:`~hapticlab.limits.passivity.passivity_limit`): its kind then says
    that it is no passivity limit.

    Parameters
    ----------
    device : Device or paddle
        Its b, T, delay, coulomb and counts_per_metre are read.
    B, law
        As for :func:`abbott_okamura_limit`.

    Examples
    --------
    >>> import hapticlab as hl
    >>> print(hl.bounds.diolaiti(hl.Device(b=0.1, T="1 ms", delay="0.5 ms")).K)
    100.0
    """
    b, T, delay, coulomb, counts = known(device, *TWO_MODES)
    if B:
        raise AnalysisError(f"B = {B:g} N s/m; Diolaiti's regions are for a plain spring without virtual damping")
    _plain(law, "Diolaiti")
    found = _two_modes(b, T, coulomb, counts, 0.5 + delay / T, "Diolaiti et al. 2006")
    if not whole_and_fraction(delay, T)[1]:
        return found
    note = (
        "the delay has a fraction of a period: a hand that moves faster before the force changes can draw energy up to 8 "
        "% below this limit"
    )
    return replace(found, kind=SINUSOIDS, assumptions=(*found.assumptions, note))


@dataclass(frozen=True)
class DiolaitiPoint(ShowsItself):
    """One plain wall in the plane of Diolaiti et al. (2006): damping against the hold, Coulomb friction against the encoder.

    In a cycle of amplitude X at w the hold and the delay generate ``(1/2 + delay/T - beta) K T w X^2 pi`` more than
    damping dissipates, the encoder at most the work of one count each way, and friction dissipates ``4 f_c X``. So
    large motions die away if beta >= 1/2 + delay/T, and small motions if sigma >= 1/2. The four combinations are the
    regions. They are regions of slow sinusoids: with a delay of a fraction of a period a wall with both may still not
    be passive.

    With neither, the encoder's errors along a motion of many counts average out, and friction decides: a motion below
    ``amplitude`` dies away, to rest or to a buzz of about a count, and a larger one grows. This holds if the amplitude
    is at least 4 counts. In simulations of 114 such walls in contact, with w T from 0.02 to 0.25 and delays of up to
    one period, all motions of 0.8 of the amplitude died away, and all but one of 1.25 of it grew.

    Attributes
    ----------
    beta, sigma : float
        b/(K T) and f_c/(K Delta); sigma is inf without an encoder's counts.
    tau : float
        delay/T
    region : str
    amplitude : float
        Of a sinusoid at the natural frequency [m], in contact, above which the motion grows: ``4 f_c/(pi w (K (T/2 +
        delay) - b))``, by its describing function. inf where beta is large enough, 0 without friction; nan without a
        mass.
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


def diolaiti(device: AnyDevice, *, K: float) -> DiolaitiPoint:
    """Return where a plain wall of stiffness K lies in the beta-sigma plane (Diolaiti, Niemeyer, Barbagli, Salisbury 2006).

    Parameters
    ----------
    device : Device or paddle
        Its b, T, delay, coulomb and counts_per_metre are read; and where it has one its m, with that of its hand, for
        the amplitude above which a locally stable wall grows.
    K : float
        Stiffness [N/m], > 0.

    Returns
    -------
    DiolaitiPoint

    Examples
    --------
    >>> import hapticlab as hl
    >>> print(diolaiti(hl.Device(m=0.05, b=0.1, T="1 ms", coulomb=0.05, counts_per_metre=5000), K=300))
    beta = b/(K T) = 0.3333, sigma = f_c/(K Delta) = 0.8333: locally stable: comes to rest from small motions, large
    ones grow; \
motions above 16.44 mm grow
    """
    b, T, delay, coulomb, counts, hand, m = known(device, *TWO_MODES, "hand", or_none="m")
    K = number("K", K, "N/m", "a wall", above=0)
    M = m and m + (hand.m if hand else 0.0)
    beta, sigma = b / (K * T), coulomb / K * counts if counts else math.inf
    tau = delay / T
    calm, settled = beta >= 0.5 + tau, sigma >= 0.5
    region, amplitude = REGIONS[calm, settled], math.inf
    if calm and settled and required_damping(K=K, T=T, delay=delay) > b * (1 + 1e-9):
        region = NOT_PASSIVE
    if not calm:
        pull = K * T * (0.5 + tau) - b  # the negative damper of hold and delay that is left over [N s/m]
        amplitude = 4 * coulomb / (math.pi * math.sqrt(K / M) * pull) if M else math.nan
        if not settled and coulomb and not amplitude * counts < FEW_COUNTS:
            region = BUZZES
    return DiolaitiPoint(beta, sigma, tau, region, amplitude)


def gil_limit(device: AnyDevice, *, B: float = 0.0, law: LawName = "zoh") -> Limit:
    """Largest stable stiffness to first order in the delay, K < (b + B)/(T/2 + delay) (Gil et al. 2004, 2009).

    A stability claim for one plant, not a passivity claim; damping of the hand counts with the device's. It holds where
    ``e = ((K + k_h) tau^2/M + |B| tau/M) (b + |B|)/(b + B)`` is small, with ``tau = T/2 + delay``: it differs from the
    exact limit by up to 1.7 e, to either side, so it is no bound in the strict sense. The last factor is 1 for B >= 0;
    a negative damper leaves little of b, and what the formula neglects stays.

    Parameters
    ----------
    device : Device or paddle
        Its m, b, T, delay and hand are read.
    B : float
        Virtual damper of either sign [N s/m].
    law : {"zoh"}
        The plain spring, Eq. (23.1). The formula is for no other law, and any other name is refused.

    Raises
    ------
    AnalysisError
        e > 0.1: damping is not low, or sampling not fast, for this mass, or a negative B takes nearly all of b.

    Examples
    --------
    >>> import hapticlab as hl
    >>> print(round(hl.bounds.gil(hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3), B=0.05).K, 6))
    300.0
    """
    m, own, T, delay, hand = known(device, "m", "b", "T", "delay", "hand")
    B = number("B", B, "N s/m")
    _plain(law, "Gil")
    tau = T / 2 + delay
    b = own + (hand.b if hand else 0.0)
    M = number("m", m + (hand.m if hand else 0.0), "kg", "the handle", above=0, what="a mass m")
    K = max((b + B) / tau, 0.0)
    small = ((K + (hand.k if hand else 0.0)) * tau**2 / M + abs(B) * tau / M) * (b + abs(B))
    if small > SLOW_ENOUGH * (b + B):
        e = f"{small / (b + B):.3g}" if b + B > 0 else "inf"
        raise AnalysisError(
            f"((K + k_h) tau^2/M + |B| tau/M) (b + |B|)/(b + B) = {e} with K = {K:.4g} N/m, tau = T/2 + delay = "
            f"{1e3 * tau:g} ms, b + B = {b + B:.4g} N s/m; "
            f"Gil's formula needs at most {SLOW_ENOUGH:g}. Use hl.stability_limit, which is exact"
        )
    off = 100 * 1.7 * small / (b + B) if small else 0.0
    notes = (f"linear, slow against the sampling: up to {off:.2g} % off the exact limit, to either side",)
    return Limit(K, math.sqrt((K + (hand.k if hand else 0.0)) / M) / (2 * math.pi), STABILITY, "Gil et al. 2004, 2009", notes)


@dataclass(frozen=True)
class Bounds(Tabular):
    """The bounds of one paddle and law, each a Limit or the sentence that says why it does not apply.

    Attributes
    ----------
    law : str
        The one the bounds are of: "backward_difference" where "half_sample" was asked for on an estimated velocity.
    B : float
        Virtual damping [N s/m].
    found : dict of str to Limit or str
        By name.
    """

    law: LawName
    B: float
    found: dict[str, Limit | str]

    def __getitem__(self, name: str) -> Limit | str:
        return self.found[name]

    _hidden = ("found",)

    def _tables(self):
        rows = [
            (limit.K, limit.kind, limit.reason) if isinstance(limit, Limit) else (math.nan, "does not apply", limit)
            for limit in self.found.values()
        ]
        columns = dict(zip(("K", "kind", "reason"), zip(*rows, strict=True), strict=True))
        yield "", Grid({"bound": list(self.found), **columns}, {"K": "N/m"})

    def __str__(self) -> str:
        lines = [f"largest stiffness K, law {self.law}, B = {self.B:g} N s/m"]
        for name, limit in self.found.items():
            K = f"{limit.K:12.6g} N/m  {limit.kind}; {limit.reason}" if isinstance(limit, Limit) else f"           -      {limit}"
            lines.append(f"  {name:<20}{K}")
        return "\n".join(lines)

    def plot(self) -> Figure:
        """Draw the bounds side by side, those of passivity told apart from the others."""
        return plot_bounds(self)


def bounds(device: AnyDevice, *, law: LawName = "zoh", B: float = 0.0) -> Bounds:
    """Return every named bound on the stiffness of a wall, and the exact stability limit of this paddle.

    Parameters
    ----------
    device : Device or paddle
        Its m, b, T, delay, coulomb, counts_per_metre and hand are read.
    law : {"zoh", "half_sample", "backward_difference", "ellis"}
        Where the paddle estimates its velocity by backward difference, half_sample is backward_difference, in every
        row.
    B : float
        Virtual damper of either sign [N s/m].

    Returns
    -------
    Bounds

    Examples
    --------
    >>> import hapticlab as hl
    >>> found = bounds(hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3))
    >>> {name: round(limit.K, 2) for name, limit in found.found.items()}["exact stability"]
    200.07
    """
    choice("law", law, TAPS)
    *_, velocity = known(device, "m", "b", "T", "velocity")
    B = number("B", B, "N s/m")
    if LEAD[law] and velocity == "backward_difference":
        law = "backward_difference"  # Eq. (23.3) with the estimate is Eq. (23.5)
    asked: dict[str, Callable[..., Limit]] = {
        "Colgate, Schenkel": passivity_limit,
        "Abbott, Okamura": abbott_okamura_limit,
        "Diolaiti": diolaiti_limit,
        "Gil": gil_limit,
        "exact stability": stability_limit,
    }
    found: dict[str, Limit | str] = {}
    for name, limit in asked.items():
        try:
            found[name] = limit(device, law=law, B=B)
        except AnalysisError as refusal:
            found[name] = f"does not apply: {refusal}"
    return Bounds(law, B, found)


def _plain(law, author):
    choice("law", law, TAPS)
    if law != "zoh":
        eq = "uses a velocity, so it is not a position law" if law == "half_sample" else "predicts from past samples"
        raise AnalysisError(f"law {law} {eq}; {author}'s formula is for the plain spring, Eq. (23.1): law zoh")


def _two_modes(b, T, coulomb, counts, periods, source):
    """Return the lesser of what viscous damping pays for the hold and Coulomb friction for the encoder."""
    hold = b / (T * periods)
    encoder = 2 * coulomb * counts if counts else math.inf
    binds = (
        f"b = {b:g} N s/m dissipates at least the energy that the hold generates"
        if hold <= encoder
        else f"f_c = {coulomb:g} N dissipates at least the energy that the encoder generates"
    )
    notes = ("handle of mass, viscous and Coulomb friction, one encoder on the handle", "plain spring, no virtual damper")
    return Limit(min(hold, encoder), None, PASSIVITY, f"{source}: {binds}", notes)
