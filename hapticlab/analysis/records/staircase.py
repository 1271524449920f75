"""The staircase of Fig. 23.6: held force against displacement, the spring law through it, and the area between."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...base.drawing import FRAME, STYLES, house_style, new_figure
from ...base.shows_itself import ShowsItself, Tabular
from ...base.telemetry import check_record
from ...errors import AnalysisError
from ...limits.limit import whole_and_fraction
from .energy import energy

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ...base.annotations import Array
    from ...base.telemetry import Telemetry

#: periods of a penetration up to which each step's leak is written beside it
NUMBERED = 16


@dataclass(frozen=True)
class Bounce(ShowsItself):
    """One completed penetration.

    Attributes
    ----------
    first, last : int
        The samples before and after it, both outside and without a force: with a delay the force comes after the entry.
    depth : float
        Deepest sample beyond x_o [m].
    generated : float
        Work given back beyond what was put in [J]; negative where it was dissipated.
    v_in, v_out : float
        Speeds at those samples [m/s]; exact where the handle's true velocity is known.
    """

    first: int
    last: int
    depth: float
    generated: float
    v_in: float
    v_out: float

    def __str__(self) -> str:
        verb = "generated" if self.generated >= 0 else "dissipated"
        ratio = f", rebound {self.v_out / self.v_in:.4g} of the entry speed" if self.v_in > 0 else ""
        return f"{1e3 * self.depth:.3g} mm deep: {verb} {1e3 * abs(self.generated):.4g} mJ{ratio}"


@dataclass(frozen=True, eq=False)
class Staircase(Tabular):
    """The force that acted, against where the handle was, and what the steps leaked.

    Attributes
    ----------
    x, F : array, shape (M,)
        The corners of the staircase [m], [N].
    K, x_o : float
        The spring law of Fig. 23.6 [N/m], [m].
    leak : array, shape (N - 1,)
        Energy generated in each period against that spring [J]; K D^2/2 for the plain law inside the wall, D the
        displacement of the period. Their sum over a penetration is what it generated.
    moved : array, shape (N - 1,)
        D [m].
    bounces : tuple of Bounce
    """

    x: Array
    F: Array
    K: float
    x_o: float
    leak: Array
    moved: Array
    bounces: tuple[Bounce, ...]

    def _sentence(self):
        generated = sum(bounce.generated for bounce in self.bounces)
        verb = "generated" if generated >= 0 else "dissipated"
        penetrations = f"{len(self.bounces)} penetration{'s' * (len(self.bounces) != 1)}"
        against = f"{verb} {1e3 * abs(generated):.4g} mJ against a spring of {self.K:g} N/m"
        return f"{penetrations} {against}" if self.bounces else str(self)

    def __str__(self) -> str:
        lines = [f"{number}: {bounce}" for number, bounce in enumerate(self.bounces, 1)]
        return "\n".join(lines or ["no completed penetration"])

    def plot(self, bounce: int = 1) -> Figure:
        """Draw one penetration, counted from 1, as Fig. 23.6: the area between spring line and staircase is the leak.

        Where there are few steps, each has its leak beside it in mJ.
        """
        if not 1 <= bounce <= len(self.bounces):
            raise AnalysisError(f"bounce = {bounce}; the record has {len(self.bounces)} completed penetration(s)")
        one = self.bounces[bounce - 1]
        per = (len(self.x) - 1) // len(self.moved)  # corners a period
        part = slice(per * one.first, per * one.last + 1)
        x, F = 1e3 * self.x[part], self.F[part]
        with house_style():
            figure = new_figure(height=4.6)
            axes = figure.subplots()
            axes.fill(x, F, color=STYLES[5]["color"], alpha=0.3, linewidth=0)
            axes.plot(x, F, label="sampled and held", **STYLES[0])
            line = np.array([min(x.min(), 1e3 * self.x_o), 1e3 * self.x_o, x.max()])
            law = self.K * np.maximum(line / 1e3 - self.x_o, 0)
            axes.plot(line, law, label=f"spring law, {self.K:g} N/m", **STYLES[1])
            verb = "generated" if one.generated >= 0 else "dissipated"
            shaded = f"between the staircases: {1e3 * abs(one.generated):.4g} mJ {verb}"
            _arrows(axes, x, F)
            if per == 2 and one.last - one.first <= NUMBERED:
                shaded += "; of each step in mJ"
                _numbers(axes, x, F, self.leak[one.first : one.last])
            axes.set(xlabel="handle position x [mm]", ylabel="force F [N]", title=shaded)
            axes.legend(loc="upper left", **FRAME)
        return figure


def _arrows(axes, x, F):
    """Show the way round on the step in and the step out nearest to half the depth."""
    steps, middle = np.diff(x), (x[1:] + x[:-1]) / 2
    for way in (1, -1):
        along = np.flatnonzero(way * steps > 0)
        if len(along):
            at = along[np.argmin(abs(middle[along] - x.max() / 2))]
            ends = (middle[at] + 0.1 * steps[at], F[at]), (middle[at] - 0.1 * steps[at], F[at])
            axes.annotate("", *ends, arrowprops={"arrowstyle": "-|>", "color": "#000000", "mutation_scale": 16})


def _numbers(axes, x, F, leak):
    """Write what each period leaked beside its step, in millijoules; less than a hundredth has no room."""
    for k, energy_leaked in enumerate(leak):
        if abs(energy_leaked) > 0.01 * abs(leak).sum():
            inwards = x[2 * k + 1] > x[2 * k]
            axes.annotate(
                f"{1e3 * energy_leaked:.2g}", ((x[2 * k] + x[2 * k + 1]) / 2, F[2 * k]), (0, -4 if inwards else 4),
                textcoords="offset points", ha="center", va="top" if inwards else "bottom", fontsize="x-small",
            )  # fmt: skip


def staircase(log: Telemetry, *, K: float | None = None, x_o: float | None = None) -> Staircase:
    """Return the staircase of Fig. 23.6 of a record, and the energy generated in each penetration.

    Parameters
    ----------
    log : Telemetry
        Every sample of it; with a delay, of a simulated paddle.
    K, x_o : float, optional
        The spring law to compare with [N/m], [m]; the record's parameters k and x_o unless given (x_o is 0 without one).

    Returns
    -------
    Staircase
        Its ``plot()`` draws one penetration.

    Raises
    ------
    AnalysisError

    Examples
    --------
    >>> import numpy as np
    >>> from hapticlab.base.telemetry import Telemetry
    >>> x = 1e-3 * np.array([-1, 1, 3, 5, 4, 2, -1])
    >>> log = Telemetry(t=np.arange(7) * 1e-3, x=x, v=0 * x, F=np.maximum(100 * x, 0), T=1e-3)
    >>> print(staircase(log, K=100))
    1: 5 mm deep: generated 1.1 mJ
    """
    check_record(log, "staircase")
    K, x_o = _spring(log, K, x_o)
    W = energy(log).W
    x = np.asarray(log.channels.get("x_true", log.x), float)
    v = np.asarray(log.channels.get("v_true", log.v), float)
    (along, acted), held = _corners(log, x)
    U = K * np.maximum(x - x_o, 0) ** 2 / 2
    contacts = (_bounce(first, last, x - x_o, v, W) for first, last in _contacts((held != 0) | (x > x_o)))
    bounces = tuple(one for one in contacts if one.depth > 0)  # a damper may act outside
    return Staircase(along, acted, K, x_o, np.diff(U) - np.diff(W), np.diff(x), bounces)


def _spring(log, K, x_o):
    K = log.parameters.get("k", log.parameters.get("K")) if K is None else K
    if K is None:
        known = ", ".join(log.parameters) or "none"
        raise AnalysisError(f"staircase: the record has no parameter k (it has {known}); give K= of the spring line in N/m")
    return float(K), float(log.parameters.get("x_o", 0.0) if x_o is None else x_o)


def _corners(log, x):
    """Return the corners (positions, forces) of what acted, as many a period, and the forces felt at the samples."""
    whole, fraction = whole_and_fraction(log.delay, log.T)
    F = log.channels.get("F_applied")
    F = np.r_[np.zeros(whole), log.F][: len(x)] if F is None else F
    if not fraction:
        places = np.c_[x[:-1], x[1:]].ravel()
        forces = np.c_[F[:-1], F[:-1]].ravel()
        return (np.r_[places, x[-1]], np.r_[forces, F[-1]]), F
    if "x_switch" not in log.channels:
        raise AnalysisError(
            f"staircase: with a delay of {log.delay:g} s the force changes inside the periods, and the record does not show "
            "where; needs a record of a simulated paddle, or whole periods of delay"
        )
    switch, before = log.channels["x_switch"][:-1], np.r_[0.0, F[:-2]]
    places = np.c_[x[:-1], switch, switch, x[1:]].ravel()
    forces = np.c_[before, before, F[:-1], F[:-1]].ravel()
    return (np.r_[places, x[-1]], np.r_[forces, F[-2]]), np.maximum(abs(F), abs(np.r_[0.0, F[:-1]]))


def _contacts(on):
    """Yield the samples around every stretch of contact that begins and ends inside the record."""
    begins = np.flatnonzero(on[1:] & ~on[:-1])
    ends = np.flatnonzero(on[:-1] & ~on[1:]) + 1
    for first in begins:
        later = ends[ends > first]
        if len(later):
            yield int(first), int(later[0])


def _bounce(first, last, depth, v, W):
    inside = slice(first, last + 1)
    return Bounce(first, last, float(depth[inside].max()), float(W[first] - W[last]), float(abs(v[first])), float(abs(v[last])))
