"""Root locus of the sampled loop: where its poles go as the stiffness grows, and where the first one leaves."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..base.drawing import HATCHED, STYLES, house_style, new_figure
from ..base.shows_itself import ShowsItself
from ..errors import AnalysisError
from .limit import Limit
from .loop import Loop
from .stability import crossings, stability_limit

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike, NDArray

    from ..base.annotations import Array
    from ..device.device import AnyDevice
    from .affine_law import StiffnessLaw

#: damping ratios of the grid; and natural frequencies, in parts of the Nyquist frequency
GRID_DAMPING, GRID_FREQUENCY = (0.1, 0.3, 0.5, 0.7, 0.9), (0.2, 0.4, 0.6, 0.8)
#: a stiffness is put in where a pole moves further than this between two others
STEP = 0.03
MOST_POINTS = 4000


@dataclass(frozen=True, eq=False)
class RootLocus(ShowsItself):
    """The poles of handle, hand, delay and law at many stiffnesses.

    Attributes
    ----------
    K : array of shape (P,)
        [N/m], rising.
    poles : complex array of shape (P, n)
        Each column follows one pole.
    zeros : complex array
        Where poles end as K grows without bound.
    limit : Limit
        The largest stable stiffness, exact; and the frequency at which stability is lost.
    crossings : tuple of (float, float)
        Every K [N/m] below the largest of ``K`` at which poles lie on the unit circle, and their frequency [Hz].
    T : float
        [s]
    name : str
        The law.
    """

    K: Array
    poles: NDArray[np.complex128]
    zeros: NDArray[np.complex128]
    limit: Limit
    crossings: tuple[tuple[float, float], ...]
    T: float
    name: str

    @property
    def radius(self) -> Array:
        """Largest |pole| at each stiffness, array of shape (P,)."""
        return np.abs(self.poles).max(axis=1)

    def plot(self) -> Figure:
        """Draw the locus in the z-plane, with the unit circle and lines of equal damping and frequency."""
        return plot_root_locus(self)

    def __str__(self) -> str:
        lines = [
            f"root locus of law {self.name}: {self.poles.shape[1]} poles, K from {self.K[0]:g} to {self.K[-1]:g} N/m",
            f"  stable up to {self.limit}",
        ]
        lines += [f"  poles on the unit circle at K = {K:.6g} N/m, {f:.4g} Hz" for K, f in self.crossings]
        return "\n".join(lines)


def root_locus(
    device: AnyDevice, *, law: StiffnessLaw = "zoh", K: ArrayLike | None = None, B: float = 0.0, parameter: str = "k"
) -> RootLocus:
    """Root locus of a paddle in a hand under a law against the stiffness K, in the z-plane.

    Parameters
    ----------
    device : Device or paddle
        Its m, b, T, delay, hand and velocity are read.
    law : str, Scene or callable
        As :func:`~hapticlab.limits.stability.stability_limit` takes it.
    K : array of shape (P,), optional
        Stiffnesses [N/m] >= 0, two or more; more are put in between where a pole moves far. By default from 0 to three
        times the limit.
    B : float
        Virtual damper of either sign [N s/m] beside a named law.
    parameter : str
        The scene's parameter that is K.

    Returns
    -------
    RootLocus

    Raises
    ------
    AnalysisError
        For stiffnesses that are none, and what :func:`~hapticlab.limits.stability.stability_limit` refuses.

    Examples
    --------
    >>> import hapticlab as hl
    >>> locus = root_locus(hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3))
    >>> round(locus.limit.K, 3), round(locus.limit.frequency, 2)
    (200.067, 10.06)
    >>> bool(abs(np.interp(locus.limit.K, locus.K, locus.radius) - 1) < 1e-6)
    True
    """
    limit = stability_limit(device, law=law, B=B, parameter=parameter)
    loop = Loop.of(device, law, B, parameter)
    found = [(k, theta / (2 * math.pi * loop.T)) for k, theta in crossings(loop)]
    given = _stiffnesses(K, limit, found, loop)
    inside = [k for k, _ in found if given[0] < k < given[-1]]
    stiffness, poles = _followed(loop, np.unique(np.r_[given, inside]))
    return RootLocus(
        K=stiffness,
        poles=poles,
        zeros=_zeros(loop),
        limit=limit,
        crossings=tuple(one for one in found if one[0] <= given[-1]),
        T=loop.T,
        name=loop.law.name,
    )


def _stiffnesses(K, limit, found, loop):
    if K is None:
        ends = [k for k, _ in found] or [loop.scale / 10]
        top = 3 * (limit.K if 0 < limit.K < math.inf else ends[0])
        return np.linspace(0.0, top, 100)
    try:
        given = np.unique(np.asarray(K, float))
    except (TypeError, ValueError):
        given = np.array([])
    if len(given) < 2 or not np.isfinite(given).all() or given[0] < 0:
        raise AnalysisError(
            f"K = {K!r}; a root locus needs two or more finite stiffnesses >= 0 N/m, such as np.linspace(0, 500, 50)"
        )
    return given


def _followed(loop, K):
    """Return stiffnesses and poles, a column a pole; with K put in until no pole moves further than a step."""
    stiffness, poles = [K[0]], [_sorted(loop, K[0])]
    ahead = list(K[:0:-1])
    while ahead:
        new = _matched(poles[-1], 1 + loop.poles(ahead[-1]))
        narrow = ahead[-1] - stiffness[-1] <= 1e-6 * K[-1]
        if not narrow and len(stiffness) + len(ahead) < MOST_POINTS and _far(poles[-1], new):
            ahead.append((stiffness[-1] + ahead[-1]) / 2)
            continue
        stiffness.append(ahead.pop())
        poles.append(new)
    return np.array(stiffness), np.array(poles)


def _far(before, after):
    near = np.minimum(np.abs(before), np.abs(after)) < 2  # what has gone far out is not drawn
    return bool((np.abs(after - before)[near] > STEP).any())


def _sorted(loop, K):
    poles = 1 + loop.poles(K)
    return poles[np.lexsort((poles.imag, -np.abs(poles)))]


def _matched(before, after):
    """Return the poles in the order of those before: always the nearest pair that is left."""
    apart = np.abs(before[:, None] - after[None, :])
    order = np.empty(len(before), int)
    for _ in before:
        row, column = np.unravel_index(np.argmin(apart), apart.shape)
        order[row] = column
        apart[row, :] = apart[:, column] = np.inf
    return after[order]


def _zeros(loop):
    """Return the roots of p1: of law and plant together, without those that past samples add at z = 0."""
    _, p1 = loop.polynomials()
    kept = np.trim_zeros(np.where(np.abs(p1) > 1e-13 * np.abs(p1).max(), p1, 0.0))
    return np.roots(kept[::-1])


def plot_root_locus(locus: RootLocus) -> Figure:
    """Draw a root locus; see :meth:`RootLocus.plot`."""
    with house_style():
        figure = new_figure(height=5.0)
        axes = figure.subplots()
        _draw_grid(axes, locus.T)
        _draw_poles(axes, locus)
        axes.set(xlim=(-1.4, 2.9), ylim=(-1.2, 1.2), aspect="equal", xlabel="Re z", ylabel="Im z", xticks=(-1, 0, 1))
        _draw_inset(axes, locus)
        grid = "dotted: equal damping ratio, equal natural frequency"
        axes.set_title(f"law {locus.name}, T = {1e3 * locus.T:g} ms; {grid}", fontsize="small")
        figure.legend(fontsize="small", loc="outside lower center", ncols=2)
    return figure


def _draw_poles(axes, locus):
    """Draw the way of each pole, where it begins, where it goes, and where the first one leaves the circle."""
    for number in range(locus.poles.shape[1]):
        label = f"poles, K = {locus.K[0]:.3g} to {locus.K[-1]:.3g} N/m" if number == 0 else None
        z = locus.poles[:, number]
        axes.plot(z.real, z.imag, color=STYLES[0]["color"], linewidth=1.8, label=label)
    start = {"color": STYLES[2]["color"], "linestyle": "none", "markersize": 9, "markeredgewidth": 2}
    axes.plot(locus.poles[0].real, locus.poles[0].imag, marker="x", label=f"K = {locus.K[0]:.3g} N/m", **start)
    zeros = {**start, "marker": "o", "markerfacecolor": "none"}
    axes.plot(locus.zeros.real, locus.zeros.imag, label="K without bound", **zeros)
    if locus.limit.frequency is not None:
        z = _leaving(locus)
        text = f"leaves at K = {locus.limit.K:.6g} N/m, {locus.limit.frequency:.4g} Hz"
        mark = {"marker": "D", "linestyle": "none", "color": STYLES[1]["color"], "markersize": 8}
        axes.plot([z.real, z.real], [z.imag, -z.imag], label=text, **mark)


def _leaving(locus):
    return np.exp(2j * np.pi * locus.limit.frequency * locus.T)


def _draw_inset(axes, locus):
    """Draw what happens at the circle larger beside it: from where the leaving pole begins to where it leaves."""
    begin = locus.poles[0][np.argmax(np.abs(locus.poles[0]))]
    end = begin if locus.limit.frequency is None else _leaving(locus)
    begin = complex(begin.real, abs(begin.imag))
    middle, half = (begin + end) / 2, max(0.75 * abs(end - begin), 0.02)
    inset = axes.inset_axes([0.655, 0.17, 0.335, 0.72], xlim=(middle.real - half / 1.2, middle.real + half / 1.2))
    inset.set(ylim=(middle.imag - half, middle.imag + half), aspect="equal", xlabel="Re z", title="where it leaves")
    turn = np.exp(1j * np.linspace(-np.pi, np.pi, 4000))
    inset.fill(np.r_[turn.real, 3 * turn.real[::-1]], np.r_[turn.imag, 3 * turn.imag[::-1]], label="outside: unstable", **HATCHED)
    inset.plot(turn.real, turn.imag, color="#4d4d4d", linewidth=1.0)
    _draw_poles(inset, locus)
    inset.title.set_fontsize("small")
    inset.tick_params(labelsize="small")
    inset.locator_params(nbins=3)
    axes.indicate_inset_zoom(inset, edgecolor="#4d4d4d")
    axes.fill_between([], [], label="outside the circle: unstable", **HATCHED)


def _draw_grid(axes, T):
    """Draw the unit circle, and lines of equal damping ratio and of equal natural frequency, named on its edge."""
    thin = {"color": "#9a9a9a", "linewidth": 1.0, "linestyle": ":"}
    angle = np.linspace(0, np.pi, 200)
    axes.plot(np.cos(2 * angle), np.sin(2 * angle), color="#4d4d4d", linewidth=1.0)
    for ratio in GRID_DAMPING:  # s = w (-ratio + j sqrt(1 - ratio^2)), up to where Im s T = pi
        z = np.exp(angle * (-ratio / math.sqrt(1 - ratio**2) + 1j))
        axes.plot(np.r_[z.real, np.nan, z.real], np.r_[z.imag, np.nan, -z.imag], **thin)
        axes.annotate(f"{ratio:g}", (z[70].real, z[70].imag), fontsize="small", color="#4d4d4d")
    for part in GRID_FREQUENCY:
        phi = np.linspace(0, np.pi / 2, 100)
        z = np.exp(np.pi * part * (-np.sin(phi) + 1j * np.cos(phi)))
        axes.plot(np.r_[z.real, np.nan, z.real], np.r_[z.imag, np.nan, -z.imag], **thin)
        place = {"ha": "left" if z[0].real > 0 else "right", "va": "top", "fontsize": "small", "color": "#4d4d4d"}
        axes.annotate(f"{part / (2 * T):.4g} Hz", (1.02 * z[0].real, -1.02 * z[0].imag), **place)
    axes.grid(False)
