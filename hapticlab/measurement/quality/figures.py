"""The quality of a paddle as pictures: its borders, what it renders beside what a hand can tell apart, and a class of both."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from ...base.drawing import COLD, WARM, house_style, new_figure, plain_log, style_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.figure import Figure

    from .record import PaddleQuality, Rendered

#: part of the ideal within which a hand notices nothing: as in ``record``
BAND = {"facecolor": "0.5", "alpha": 0.25, "linewidth": 0}
#: paddles of which a picture of a class names every line
NAMED = 8
#: the largest difference from an ideal impedance that is drawn [%]
MOST_OFF = 120


def plain(text: str) -> str:
    """Return a text that matplotlib draws as it is, without formulas."""
    return text.replace("$", r"\$")


def plot_quality(quality: PaddleQuality) -> Figure:
    """Draw the borders where they were measured, else the impedance."""
    if quality.widths or quality.rendered is None:
        return plot_widths(quality)
    return plot_rendered(quality.rendered, quality.profile.b, quality.fractions)


def plot_widths(quality: PaddleQuality) -> Figure:
    """Draw both borders over virtual damping, a panel for each velocity, with the range that both allow filled."""
    shown = quality.widths
    with house_style():
        rows = max(1, math.ceil(len(shown) / 2))
        figure = new_figure(height=1.0 + 2.7 * rows)
        panels = np.atleast_1d(figure.subplots(rows, 2 if len(shown) > 1 else 1, sharey=True, squeeze=False)).ravel()
        floor, top = _ends([K for w in shown for K in (*w.rest, *w.quiet, quality.passive)])
        for number, (axes, width) in enumerate(zip(panels, shown, strict=False)):
            at = np.arange(len(width.B))
            K, rest, quiet = (np.clip(getattr(width, name), floor, None) for name in ("K", "rest", "quiet"))
            axes.fill_between(at, floor, K, **BAND)
            axes.plot(at, rest, "-", color=WARM, marker="X", label="comes to rest up to here")
            axes.plot(at, quiet, "--", color=COLD, marker="o", label="no buzz felt up to here")
            if quality.passive > 0:
                axes.axhline(quality.passive, color="black", linestyle=":", label="Eq. (23.10), B = 0, any passive hand")
            axes.set_xticks(at, [f"{b:.3g}" for b in width.B])
            axes.set_title(plain(width.velocity), fontsize="medium")
            plain_log(axes, "y", (floor, top))
            axes.set_ylim(floor, top)
            axes.set(xlabel="virtual damping B [N s/m]", ylabel="" if number % 2 else "stiffness K [N/m]")
        for axes in panels[len(shown) :]:
            axes.set_visible(False)
        if shown:
            handles, labels = panels[0].get_legend_handles_labels()
            figure.legend(handles, labels, loc="outside lower center", ncols=2, fontsize="small")
    return figure


def _ends(values):
    """Ends of a logarithmic axis of stiffness, in decades."""
    seen = [K for K in values if math.isfinite(K) and K > 0]
    low, high = (min(seen), max(seen)) if seen else (10.0, 1000.0)
    return 10 ** math.floor(math.log10(0.9 * low)), 10 ** math.ceil(math.log10(1.1 * high))


def plot_rendered(one: Rendered, b: float, fractions: tuple[float, float]) -> Figure:
    """Draw magnitude, effective stiffness and damping of a rendered wall, with the band that a hand cannot tell apart.

    ``b`` is the paddle's own damping [N s/m], and ``fractions`` are those of stiffness and of damping.
    """
    stiffness, damping = fractions
    f, magnitude = np.array(one.frequency), np.abs(one.ideal)
    radius = np.array(one.radius)
    band = f"a hand tells nothing apart: {100 * stiffness:.0f} %, of damping {100 * damping:.0f} %"
    with house_style():
        figure = new_figure(height=7.4)
        size, spring, damper = figure.subplots(3, 1, sharex=True)
        size.fill_between(f, (1 - stiffness) * magnitude, (1 + stiffness) * magnitude, label=band, **BAND)
        size.plot(f, magnitude, **style_of(1), label="ideal wall (damping: with the paddle's b)")
        size.plot(f, np.abs(one.Z), "o", color="black", markersize=4, label="rendered")
        size.set(ylabel="|Z| [N s/m]")
        plain_log(size, "y", (magnitude.min(), magnitude.max()))
        spring.axhspan((1 - stiffness) * one.K, (1 + stiffness) * one.K, **BAND)
        spring.axhline(one.K, **style_of(1))
        spring.errorbar(f, one.stiffness, 2 * np.pi * f * radius, fmt="o", color="black", markersize=4, capsize=2)
        spring.set(ylabel="stiffness [N/m]", ylim=(min(0.0, 1.2 * one.stiffness.min()), max(1.6 * one.K, 1e-3)))
        whole = b + one.B
        damper.axhspan((1 - damping) * whole, (1 + damping) * whole, **BAND)
        damper.axhline(whole, **style_of(1))
        damper.errorbar(f, b + np.array(one.real), radius, fmt="o", color="black", markersize=4, capsize=2)
        damper.axhline(0, color="0.5", linewidth=0.8)
        damper.set(ylabel="damping [N s/m]", xlabel="frequency [Hz]")
        plain_log(damper, "x", (f.min(), f.max()))
        figure.legend(loc="outside lower center", ncols=2, fontsize="small")
    return figure


def plot_class(qualities: Sequence[PaddleQuality], numbers: Sequence[int]) -> Figure:
    """Draw each paddle in a row: its borders, and where a wall was measured, up to which frequency it is as meant."""
    same = _positive([one.rendered.same_up_to if one.rendered else math.nan for one in qualities])
    rendered = any(one.rendered for one in qualities)
    with house_style():
        figure = new_figure(height=1.6 + 0.24 * len(qualities), width=8.6)
        axes, *beside = np.atleast_1d(figure.subplots(1, 1 + rendered, sharey=True, width_ratios=(5, 2)[: 1 + rendered]))
        rows = np.arange(len(qualities))[::-1]
        at_zero = [_at_zero(one) for one in qualities]
        columns = {
            "Eq. (23.10), any passive hand": ([one.passive for one in qualities], "|", "black"),
            "comes to rest, B = 0": ([rest for rest, _ in at_zero], "X", WARM),
            "no buzz felt, B = 0": ([quiet for _, quiet in at_zero], "o", COLD),
            "stiffest quiet wall, any B and velocity": ([one.stiffest[0] for one in qualities], "D", "#7d9e30"),
        }
        for label, (K, marker, colour) in columns.items():
            size = 11 if marker == "|" else 5.5
            look = {"linestyle": "", "marker": marker, "color": colour, "markersize": size, "markeredgewidth": 1.3}
            axes.plot(_positive(K), rows, **look, label=label)
        for upto in beside:
            upto.plot(same, rows, linestyle="", marker="s", color="black", markersize=5)
            upto.set(xlabel="same up to [Hz]", xlim=(0, 1.15 * np.nanmax([*same, 1.0])))
        names = [f"{number}  {plain(_cut(one.name))}" for number, one in zip(numbers, qualities, strict=True)]
        axes.set_yticks(rows, names, fontsize="small")
        axes.set(xlabel="stiffness K [N/m]", ylim=(-0.7, len(qualities) - 0.3))
        plain_log(axes, "x", _ends([value for K, *_ in columns.values() for value in K]))
        figure.legend(loc="outside upper center", ncols=2, fontsize="small")
    return figure


def _positive(values):
    return np.array([value if value > 0 else math.nan for value in values])


def _cut(name):
    return name if len(name) <= 24 else f"{name[:22]} ..."


def _at_zero(one):
    """Both borders of the plain spring, from the first width that has one."""
    found = ((w.rest[k], w.quiet[k]) for w in one.widths for k, B in enumerate(w.B) if B == 0)
    return next(found, (math.nan, math.nan))


def plot_overlay(qualities: Sequence[PaddleQuality], numbers: Sequence[int]) -> Figure:
    """Draw over frequency how far each paddle's rendered wall is from the ideal one; of many, name the best and the worst."""
    shown = [(f"{n}  {plain(_cut(q.name))}", q.rendered) for n, q in zip(numbers, qualities, strict=True) if q.rendered]
    order = sorted(shown, key=lambda pair: -pair[1].same_up_to)
    named = order if len(shown) <= NAMED else [order[0], order[-1]]
    with house_style():
        figure = new_figure(height=4.6)
        axes = figure.add_subplot()
        limit = qualities[0].fractions[0]
        for pair in order:
            if pair not in named:
                axes.plot(*_course(pair[1]), color="0.6", linewidth=0.8)
        for k, (name, one) in enumerate(named):
            axes.plot(*_course(one), **style_of(k), linewidth=1.8, label=name)
        axes.axhspan(0, 100 * limit, label=f"not told apart by a hand, {100 * limit:.0f} %", **BAND)
        axes.set(xlabel="frequency [Hz]", ylabel="|Z/ideal - 1| [%]", ylim=(0, MOST_OFF))
        ends = [frequency for _, one in shown for frequency in one.frequency]
        plain_log(axes, "x", (min(ends), max(ends)))
        figure.legend(loc="outside lower center", ncols=3, fontsize="small")
    return figure


def _course(one):
    return np.array(one.frequency), 100 * one.off
