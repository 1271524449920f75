"""Excess and shortage of passivity of device, hold, delay and environment, as one ledger (after Miller, Colgate, Freeman).

With velocity in and force out a part is *input-strictly* passive with index nu where ``int F v >= nu int v^2`` less
what was stored; with force in and velocity out *output-strictly* passive with index eps where ``int F v >= eps int
v^2``. Both are dampers in N s/m, and joined at the handle they add: a device whose eps exceeds the shortage -nu of what
is rendered leaves a handle that is passive in every passive hand. The index is per velocity of the handle, so that over
a period ``int v^2 >= D^2/T``, D its displacement: that is all which the samples know.

How much the parts are short, each from Lipschitz's inequality alone and so for nonlinear ones too. A force F = U'(x)
with slopes from k_min to k_max, held: U(x + D) - U(x) <= U'(x) D + k_max D^2/2, hence a shortage of k_max T/2, whatever
k_min is, as long as U is bounded below. A sample of delay pairs the force with a displacement further on: |F(n) -
F(n-1)| <= k |D(n)| with k = max(|k_min|, |k_max|), and sum |D(n) D(n+1)| <= sum D^2, hence k T for each. A damper of
slopes up to B, of either sign, held: |B|, delayed or not.

A delay of d + f periods, 0 < f < 1, changes the force inside the period, and ``int v^2 >= (D1^2/f + D2^2/(1-f))/T`` for
the displacements before and after. With |D(n-d-1) D1| <= (h D(n-d-1)^2 + D1^2/h)/2 and the best h, the shortage of
spring and delay together is ``T (a + sqrt(a^2 + f (1-f) k^2))/2`` with a = k_max/2 + k (d + f): more than k_max T/2 + k
delay. For a linear spring it is exact, and :func:`~hapticlab.limits.passivity.required_damping` finds it another way.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..base.arguments import number
from ..base.drawing import STYLES, house_style, new_figure
from ..base.shows_itself import ShowsItself, Tabular
from ..device.device import known
from ..errors import AnalysisError
from .limit import whole_and_fraction

if TYPE_CHECKING:
    from collections.abc import Iterable

    from matplotlib.figure import Figure

    from ..device.device import AnyDevice


@dataclass(frozen=True)
class Entry(ShowsItself):
    """One part: its index, an excess where positive and a shortage where negative, and why.

    Attributes
    ----------
    name : str
    index : float
        [N s/m]
    reason : str
    """

    name: str
    index: float
    reason: str

    def __str__(self) -> str:
        return f"{self.name:<12}{self.index:+12.6g} N s/m   {self.reason}"


@dataclass(frozen=True)
class Ledger(Tabular):
    """Excess and shortage of passivity of the parts, and what is left.

    Attributes
    ----------
    entries : tuple of Entry
    assumptions : tuple of str
    bounded : bool
        Whether the environment's energy is bounded below, without which nothing is proved.
    """

    entries: tuple[Entry, ...]
    assumptions: tuple[str, ...] = ()
    bounded: bool = True

    @property
    def index(self) -> float:
        """What is left [N s/m]; the rendered handle is output-strictly passive with it where positive."""
        return sum(entry.index for entry in self.entries)

    @property
    def passive(self) -> bool:
        """Whether the ledger proves the handle passive in every passive hand; it is sufficient, not necessary."""
        return self.bounded and self.index >= 0

    @property
    def gain(self) -> float:
        """Most that the hand's force is amplified into velocity, in the mean of squares [m/(N s)]: 1/index."""
        return 1 / self.index if self.bounded and self.index > 0 else float("inf")

    def _sentence(self):
        return " ".join(str(self).split("\n")[len(self.entries)].split())

    def __str__(self) -> str:
        told = (
            "passive in every passive hand"
            if self.passive
            else ("passivity is not proved: the terms need more damping than there is")
        )
        if not self.bounded and self.index >= 0:
            told = "passivity is not proved, because the energy may have no lower bound. If it has one, give bounded=True"
        rows = [str(entry) for entry in self.entries]
        return "\n".join([*rows, f"{'left':<12}{self.index:+12.6g} N s/m   {told}", *(f"  {a}" for a in self.assumptions)])

    def plot(self) -> Figure:
        """Draw the parts as bars, one below the other, and what is left."""
        with house_style():
            figure = new_figure(height=1.2 + 0.45 * (len(self.entries) + 1))
            axes = figure.subplots()
            start = 0.0
            for row, entry in enumerate(self.entries):
                style = STYLES[2] if entry.index >= 0 else STYLES[1]
                axes.barh(row, entry.index, left=start, color=style["color"], hatch="" if entry.index >= 0 else "//")
                start += entry.index
                axes.text(start, row, f" {entry.index:+.4g}", va="center", ha="left" if entry.index >= 0 else "right")
            axes.barh(len(self.entries), start, color="#000000" if self.passive else "#8a8a8a")
            axes.set_yticks(range(len(self.entries) + 1), [*(e.name for e in self.entries), "left"])
            axes.invert_yaxis()
            axes.axvline(0, color="#000000", linewidth=0.8)
            axes.use_sticky_edges = False
            axes.margins(x=0.12)
            axes.set_xlabel("excess of passivity [N s/m]")
        return figure


def passivity_ledger(
    device: AnyDevice,
    *,
    K: float | tuple[float, float] | list[float] = 0.0,
    B: float | tuple[float, float] | list[float] = 0.0,
    delayed: bool = False,
    bounded: bool = False,
    parts: Iterable[tuple[str, float, str]] = (),
) -> Ledger:
    """Excess of passivity of the device minus the needs of hold, delay and environment: Eq. (23.10) as a ledger.

    For linear and nonlinear environments, with springs whose local stiffness and dampers whose local damping stay
    within bounds. Sufficient, and exact for a linear spring.

    Parameters
    ----------
    device : Device or paddle
        Its b, T and delay are read.
    K : float, or (k_min, k_max)
        Stiffness of the environment [N/m], or the range of its local stiffness dF/dx; a part of it may be negative, as
        of a latch or a detent, where its energy is ``bounded``; :func:`hapticlab.stability.local_stiffness` finds it. A
        unilateral wall has (0, K).
    B : float, or (B_min, B_max)
        Virtual damping [N s/m] by backward difference, of either sign, or the range of its local damping.
    delayed : bool
        The environment answers a sample late: the force of sample n comes from x(n-1), as an explicit integrator's
        does.
    bounded : bool
        The potential energy of the environment, the work of F(x) from anywhere, has a lower bound. No range of slopes
        tells; where a slope may be negative nothing is proved without it.
    parts : sequence of (name, index [N s/m], reason)
        What else is in the loop, such as a physical damper added to the device, or a part whose need was found
        elsewhere.

    Returns
    -------
    Ledger

    Raises
    ------
    AnalysisError
        Also where no slope is positive and some are negative: such an energy has no lower bound, and no damping keeps
        the handle.

    Examples
    --------
    >>> import hapticlab as hl
    >>> print(hl.passivity.ledger(hl.Device(b=0.2, T="1 ms"), K=200, B=0.05))
    device              +0.2 N s/m   output-strictly passive by its own damping b
    hold                -0.1 N s/m   local stiffness at most 200 N/m, held: k T/2
    damper             -0.05 N s/m   local damping at most 0.05 N s/m in magnitude, held: |B|
    left               +0.05 N s/m   passive in every passive hand
      device damping b alone: no encoder, no Coulomb friction
    """
    b, T, delay = known(device, "b", "T", "delay")
    (k_min, k_max), (B_min, B_max) = _range("K", K, "N/m"), _range("B", B, "N s/m")
    stiff, damped = max(abs(k_min), abs(k_max)), max(abs(B_min), abs(B_max))
    if k_max <= 0 > k_min:
        raise AnalysisError(
            f"K = {K} N/m; no slope is positive, so the energy has no lower bound, the handle moves away, and no damping "
            "can hold it. Give a largest stiffness > 0, such as that of a detent that ends, or K = 0"
        )
    late = delay + T * bool(delayed)
    entries = [Entry("device", b, "output-strictly passive by its own damping b")]
    if k_max > 0:
        entries.append(Entry("hold", -k_max * T / 2, f"local stiffness at most {k_max:g} N/m, held: k T/2"))
    if late and stiff:
        reason = f"{late:g} s late, |local stiffness| at most {stiff:g} N/m"
        entries.append(Entry("delay", max(k_max, 0.0) * T / 2 - _spring_shortage(k_max, stiff, T, late), reason))
    if damped:
        reason = f"local damping at most {damped:g} N s/m in magnitude, held: |B|"
        entries.append(Entry("damper", -damped, reason))
    entries += [Entry(str(name), number(name, index, "N s/m", what="index"), str(reason))
                for name, index, reason in parts]  # fmt: skip
    notes = ["device damping b alone: no encoder, no Coulomb friction"]
    if k_min < 0:
        notes.append(f"a local stiffness down to {k_min:g} N/m makes the hold generate no energy if the energy is bounded below")
    return Ledger(tuple(entries), tuple(notes), bool(bounded) or k_min >= 0)


def _spring_shortage(k_max, stiff, T, late):
    whole, f = whole_and_fraction(late, T)
    a = max(k_max, 0.0) / 2 + stiff * (whole + f)
    return T * (a + math.sqrt(a**2 + f * (1 - f) * stiff**2)) / 2


def _range(name, given, unit):
    pair = given if isinstance(given, (tuple, list)) else (given, given)
    if len(pair) != 2:
        raise AnalysisError(f"{name} = {given}; needs a number in {unit}, or (least, most)")
    low, high = (number(name, a, unit, what="number, or (least, most)") for a in pair)
    if low > high:
        raise AnalysisError(f"{name} = {given}; needs (least, most), least <= most")
    return (low, high) if isinstance(given, (tuple, list)) else (min(low, 0.0), max(high, 0.0))
