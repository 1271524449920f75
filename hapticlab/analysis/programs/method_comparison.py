"""The methods that hl.compile knows, as a table and a picture: order, cost, and where each is stable."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...base.drawing import house_style, new_figure, style_of
from ...base.grid import Grid
from ...base.shows_itself import Tabular
from ...compiler.ir.options import choice
from ...compiler.methods.method_table import METHODS

if TYPE_CHECKING:
    from collections.abc import Iterator

    from matplotlib.figure import Figure

    from ...compiler.methods.method_table import Method

#: damping ratios of the right picture, and omega h past which nothing is drawn
ZETA = np.geomspace(0.02, 5.0, 41)
#: omega h at which the table says how much energy a step adds to a spring
AT = (0.1, 0.5)


@dataclass(frozen=True)
class WithoutSteps:
    """A method whose error is rounding: the exact map of what is linear, or a Taylor series as long as it takes.

    Attributes
    ----------
    name : str
    order, evaluations, cost : str
        In words: there is no power of a step.
    real, imaginary : float
        The largest h b/m and omega h, as of :class:`~hapticlab.compiler.methods.method_table.Method`; inf where any is
        stable.
    """

    name: str
    order: str
    evaluations: str
    cost: str
    real: float
    imaginary: float

    def longest_step(self, zeta: float = 0.0) -> float:
        """The largest omega h of q'' = -omega^2 q - 2 zeta omega q'."""
        return self.imaginary / max(1.0, zeta + math.sqrt(max(zeta**2 - 1.0, 0.0)))

    def energy_gain(self, omega_h: float) -> float:
        """The part of its energy that a spring-mass gains in a step: none."""
        return 0.0


WITHOUT_STEPS = {
    m.name: m
    for m in (
        WithoutSteps(
            "exact", "rounding", "1 product",
            "a constant matrix on the S states, S^2 products; a series where a mode ends; only for scenes that are linear "
            "in each mode",
            math.inf, math.inf,
        ),
        WithoutSteps(
            "taylor", "rounding", "1 series",
            "terms of each operation up to rounding, many times the cost of rk4; events located inside the step",
            1.0, 1.0,
        ),
    )
}  # fmt: skip


class Methods(Tabular, Mapping[str, "Method | WithoutSteps"]):
    """Methods by name; printing them makes a table, :meth:`plot` a picture."""

    def __init__(self, known):
        self._known = known

    def __getitem__(self, name: str) -> Method | WithoutSteps:
        return self._known[choice("method", name, self._known)]

    def __iter__(self) -> Iterator[str]:
        return iter(self._known)

    def __len__(self) -> int:
        return len(self._known)

    def _sentence(self):
        return f"{len(self)} methods: order, cost, longest stable steps, and the energy that a step adds to a spring"

    def _tables(self):
        rows = [(m.order, m.evaluations, m.real, m.imaginary, *(_gain(m, y) for y in AT)) for m in self.values()]
        heads = ("order", "evaluations", "h b/m below", "w h below", *(f"gain at w h = {y:g}" for y in AT))
        yield "", Grid({"method": list(self), **dict(zip(heads, zip(*rows, strict=True), strict=True))})

    def __str__(self) -> str:
        gains = "".join(f"{f'gain at wh={y:g}':>15}" for y in AT)
        lines = [f"{'method':<28}{'order':>9}{'evaluations':>13}{'h b/m <':>10}{'wh <':>8}{gains}"]
        for name, m in self.items():
            gains = "".join(f"{_gain(m, y):>15}" for y in AT)
            lines.append(f"{name:<28}{m.order:>9}{m.evaluations:>13}{_shown(m.real):>10}{_shown(m.imaginary):>8}{gains}")
        return "\n".join([*lines, *_BESIDE])

    def plot(self, *names: str) -> Figure:
        """Draw where methods are stable: |R(z)| = 1 of y' = z y, and the largest omega h against the damping ratio.

        Parameters
        ----------
        *names : str
            All that take steps, unless given; "exact" and "taylor" have no boundary to draw.

        Returns
        -------
        matplotlib.figure.Figure

        Examples
        --------
        >>> import hapticlab as hl
        >>> figure = hl.methods.table().plot("rk4", "semi_implicit_euler_damped")
        >>> [axes.get_ylabel() for axes in figure.axes]
        ['Im(h λ)', 'largest stable ω h']
        """
        stepped = {name: m for name, m in self.items() if name not in WITHOUT_STEPS}
        chosen = {name: stepped[choice("method to draw", name, stepped)] for name in names or stepped}
        with house_style():
            figure = new_figure(height=4.6, width=10.0)
            left, right = figure.subplots(1, 2)
            for number, (name, method) in enumerate(chosen.items()):
                style = style_of(number)
                _draw_region(left, method, style)
                right.loglog(ZETA, [method.longest_step(zeta) or np.nan for zeta in ZETA], **style, label=name)
            left.set(xlabel="Re(h λ)", ylabel="Im(h λ)", aspect="equal", title="y' = λ y: stable inside the line")
            right.set(xlabel="damping ratio ζ", ylabel="largest stable ω h", title="q'' = -ω² q - 2 ζ ω q': stable below")
            figure.legend(loc="outside right center", fontsize="small")
        return figure


def _draw_region(axes, method, style):
    if method.order_with_velocity:
        return  # of y' = lambda y it has none: it knows no equations of first order
    z = np.linspace(-3.2, 1.0, 106)[None, :] + 1j * np.linspace(-3.2, 3.2, 161)[:, None]
    axes.contour(
        z.real[0], z.imag[:, 0], method.amplification(z), levels=[1.0], colors=[style["color"]], linestyles=[style["linestyle"]],
        linewidths=[1.6],
    )  # fmt: skip


_BESIDE = (
    "gain: fraction of its energy that a spring gains per step, in the long run; w: its frequency [rad/s]; h: step [s]",
    "nystrom4: only where accelerations are free of velocities (else its order would be 2)",
    "adams_bashforth: only without contacts and cases; with one step per period it uses samples alone, whatever the hold",
    *(f"{m.name}: {m.cost}" for m in WITHOUT_STEPS.values()),
)


def methods() -> Methods:
    """The methods by name: explicit fixed-step methods, with limits found from their steps, "exact" and "taylor".

    Returns
    -------
    Methods
        A mapping name -> Method: order, evaluations, real, imaginary, longest_step(zeta), energy_gain(omega_h).

    Examples
    --------
    >>> import hapticlab as hl
    >>> known = hl.methods.table()
    >>> known["rk4"].order, round(known["rk4"].imaginary, 3), known["semi_implicit_euler_damped"].real
    (4, 2.828, inf)
    """
    return Methods({**METHODS, **WITHOUT_STEPS})


def _shown(limit):
    return "-" if np.isnan(limit) else "any" if np.isinf(limit) else f"{limit:.3f}" if limit else "0"


def _gain(method, y):
    gain = method.energy_gain(y)
    return "unstable" if y > method.imaginary > 0 else "0 (bounded)" if abs(gain) < 1e-12 else f"{gain:+.1e}"
