"""Velocity from sampled positions: the backward difference, and through a first-order filter.

A board measures positions. Each estimator is a few difference equations, so that it runs wherever a scene does; windows
that adapt and Kalman filters are in adaptive_window.py and kalman.py. What answers less to a count is later:

=================  =========================  ============================
estimator          lag of slow motion         first answer to one count D
=================  =========================  ============================
backward           T/2                        D/T
filtered           T/2 + tau                  D/(T + tau)
window             i T/2, over i periods      D/(i T)
kalman             T (alpha/beta - 1/2)       beta D/T
=================  =========================  ============================

:func:`~hapticlab.rendering.velocity_errors.velocity_errors` compares them on a record.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import sympy as sp

from ...base.facts import card
from ...base.shows_itself import ShowsItself
from ...errors import SceneError
from ..notation.amount import amount, number_of
from ..notation.parameters import T
from ..notation.symbols import n, signal, x

if TYPE_CHECKING:
    from ...base.annotations import Term


AN_ESTIMATE = "an estimate, as in velocity=hl.velocity.filtered(tau='4 ms')"


@dataclass(frozen=True)
class VelocityEstimate(ShowsItself):
    """An estimate of the handle's velocity, for :func:`~hapticlab.scene.laws.chapter_laws.wall` or any scene.

    Attributes
    ----------
    velocity : sympy expression [m/s]
    eom : tuple of sympy.Eq
        Its difference equations; a scene that uses ``velocity`` takes them along: ``Scene(force, eom=estimate.eom)``.
    name : str
    cheaper : tuple of VelocityEstimate
        Estimates of less work, dearest first, for a board that has no time for this one.
    lag : sympy expression [s], optional
        How late it is in slow motion; None where that changes.
    source : str
        Where it is from.
    confused_with : str
        A law with which it is confused, and the difference.

    Examples
    --------
    >>> import hapticlab as hl
    >>> estimate = hl.velocity.filtered(tau="4 ms")
    >>> B = hl.parameters("B", units="N*s/m")
    >>> damper = hl.Scene(force=B * estimate.velocity, eom=estimate.eom)
    """

    velocity: sp.Expr
    eom: tuple[sp.Eq, ...] = ()
    name: str = "velocity"
    cheaper: tuple[VelocityEstimate, ...] = ()
    _transfer: tuple[Any, ...] = field(default=(), repr=False)
    lag: sp.Expr | None = None
    source: str = ""
    confused_with: str = ""

    @property
    def is_linear(self) -> bool:
        """Whether it has a transfer function."""
        return bool(self._transfer)

    def transfer(self, period: float) -> tuple[list[float], list[float]]:
        """(Numerator, denominator) in powers of 1/z, from positions [m] to the estimate [m/s], at T = period [s].

        Parameters
        ----------
        period : float
            Sampling period T [s], > 0.

        Raises
        ------
        SceneError
            For an estimate that is not linear, or changes with time.

        Examples
        --------
        >>> import hapticlab as hl
        >>> hl.velocity.backward().transfer(1e-3)
        ([1000.0, -1000.0], [1.0])
        """
        if not self._transfer:
            raise SceneError(
                f"{self.name} has no transfer function: it is not linear, or its gains change; use hl.velocity.backward, "
                "hl.velocity.filtered or hl.velocity.kalman(steady=True), or simulate it"
            )
        over, under = ([number_of(sp.sympify(c)).subs(T, period) for c in part] for part in self._transfer)
        free = sorted({str(s) for c in (*over, *under) for s in c.free_symbols})
        if free:
            raise SceneError(f"{self.name}: {', '.join(free)} has no number; make the estimate with one, as in tau='4 ms'")
        return [float(c) for c in over], [float(c) for c in under]

    def __str__(self) -> str:
        lines = [f"{self.name}: v = {self.velocity}", *(f"  {e.lhs} = {e.rhs}" for e in self.eom)]
        lag = "" if self.lag is None else f"{self.lag}"
        return card("\n".join(lines), {"lag": lag, "source": self.source, "not to be confused with": self.confused_with})


def backward_velocity() -> VelocityEstimate:
    """Backward difference (x(n) - x(n-1))/T, the estimate of Eq. (23.4), whatever the paddle measures.

    Examples
    --------
    >>> import hapticlab as hl
    >>> print(hl.velocity.backward())
    backward difference: v = (x(n) - x(n - 1))/T
      lag                      T/2
      source                   chapter 23, Eq. (23.4)
      not to be confused with  the wall law 'backward_difference', a spring that uses this velocity
    """
    return VelocityEstimate(
        _difference(), (), "backward difference", (), ((1 / T, -1 / T), (1,)), T / 2, "chapter 23, Eq. (23.4)",
        "the wall law 'backward_difference', a spring that uses this velocity",
    )  # fmt: skip


def _difference():
    return (x(n) - x(n - 1)) / T


def filtered_velocity(*, tau: Term, name: str = "v_filtered") -> VelocityEstimate:
    """Backward difference through a first-order filter, tau v' + v = x', mapped by s = (1 - 1/z)/T.

    v(n) = (tau v(n-1) + x(n) - x(n-1))/(tau + T). For a virtual damper B behind it Eq. (23.10) becomes
    b > K T/2 + B/(1 + 2 tau/T) for B >= 0, and stays b > K T/2 + \\|B\\| for B < 0 (after Brown 1995).

    Parameters
    ----------
    tau : float, text or Parameter
        Time constant [s], >= 0; its corner is at 1/(2 pi tau) Hz. A number is compiled in, a Parameter may be live.
    name : str
        Of its signal; a scene with two such estimates needs two names.

    Returns
    -------
    VelocityEstimate

    Examples
    --------
    >>> import hapticlab as hl
    >>> print(hl.velocity.filtered(tau="4 ms"))
    filtered difference: v = v_filtered(n)
      v_filtered(n) = (v_filtered(n - 1)*(0.004 s) + x(n) - x(n - 1))/(T + (0.004 s))
      lag                      T/2 + (0.004 s)
      source                   Brown (1995)
      not to be confused with  hl.laws.force_filter, which filters the force of the spring as well
    """
    tau = amount(tau, "s", "tau", "a filter", least=0)
    cheaper = (backward_velocity(),)
    v = signal(name, unit="m/s", instead=cheaper)
    step = sp.Eq(v(n), (tau * v(n - 1) + x(n) - x(n - 1)) / (tau + T))
    transfer = (1 / (tau + T), -1 / (tau + T)), (1, -tau / (tau + T))
    return VelocityEstimate(
        v(n), (step,), "filtered difference", cheaper, transfer, T / 2 + tau, "Brown (1995)",
        "hl.laws.force_filter, which filters the force of the spring as well",
    )  # fmt: skip
