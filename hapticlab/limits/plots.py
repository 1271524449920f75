"""Figures of the limits: one limit, bounds side by side, damping asked for by frequency, disks of passive hands, couplers."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING

import numpy as np

from ..base.drawing import COLD, FRAME, HATCHED, STYLES, WARM, forbid, house_style, new_figure, style_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from .admittance import AdmittanceDesign
    from .bounds import Bounds, DiolaitiPoint
    from .colgate import PassivityMargin
    from .coupler import CouplerDesign
    from .limit import Limit
    from .linear_law import LinearLaw
    from .nyquist_disk import NyquistDisk
    from .two_port import TwoPort


def plot_limit(limit: Limit) -> Figure:
    """Draw the stiffnesses that a limit guarantees, filled, and those of which it guarantees nothing, hatched.

    Parameters
    ----------
    limit : Limit

    Returns
    -------
    matplotlib.figure.Figure
    """
    K, told = limit.K, textwrap.wrap(str(limit).splitlines()[0], 84)
    notes = [line for note in limit.assumptions for line in textwrap.wrap(note, 84)]
    most = 2 * K if 0 < K < np.inf else 1000.0
    with house_style():
        figure = new_figure(height=1.5 + 0.2 * (len(told) + len(notes)))
        axes = figure.subplots()
        axes.barh(0, min(K, most), color=COLD, label=f"guaranteed: up to {K:.4g} N/m" if K > 0 else "guaranteed: nothing")
        if np.isfinite(K):
            beyond = {"color": "white", "hatch": "///", "edgecolor": WARM}
            axes.barh(0, most - K, left=K, **beyond, label="stiffer: not guaranteed")
        axes.set(xlim=(0, most), yticks=[], xlabel="stiffness K [N/m]")
        axes.set_title("\n".join(told), fontsize="small")
        axes.grid(False)
        figure.supxlabel("\n".join(notes), fontsize="small")
        figure.legend(loc="outside upper center", ncols=2, **FRAME)
        hatched = f", hatched from there to {most:.4g} N/m" if np.isfinite(K) else ""
        figure.alt = f"{limit}\nA bar of stiffness, filled up to {min(K, most):.4g} N/m{hatched}."
    return figure


def plot_passivity_margin(margin: PassivityMargin) -> Figure:
    """Draw what each frequency asks of the device's damping, and what a pure sinusoid asks for.

    Parameters
    ----------
    margin : PassivityMargin

    Returns
    -------
    matplotlib.figure.Figure
    """
    theta = np.linspace(1e-3, np.pi, 800)
    frequency = theta / (2 * np.pi * margin.law.T)
    with house_style():
        figure = new_figure(height=4.0)
        axes = figure.subplots()
        asked = margin.asked(theta)
        axes.plot(frequency, asked, label="any motion (Colgate and Schenkel)", **STYLES[0])
        axes.plot(frequency, -margin.equivalent_damper(theta), label="a sinusoid: $-b_{eq}$", **STYLES[1])
        axes.axhline(margin.b, label="the device's b", **STYLES[5])
        if np.isfinite(margin.required):
            axes.plot(margin.frequency, margin.required, "ko", markersize=5)
        axes.set(xlim=(0, frequency[-1]), xlabel="frequency [Hz]", ylabel="damping needed [N s/m]")
        forbid(axes, margin.b, "not passive: more than the device has")
        late = f", delay {1e3 * margin.delay:g} ms" if margin.delay else ""
        axes.set_title(f"{margin.law.name}, T = {1e3 * margin.law.T:g} ms{late}", fontsize="small")
        figure.legend(fontsize="small", loc="outside lower center", ncols=2)
    return figure


def plot_nyquist_disk(disk: NyquistDisk) -> Figure:
    """Draw the disks in which a device in a passive hand lies with -1/H, and the unit disk with the mapped law.

    Parameters
    ----------
    disk : NyquistDisk

    Returns
    -------
    matplotlib.figure.Figure
    """
    theta = np.linspace(0.02, np.pi, 1500)
    turn = np.exp(1j * np.linspace(0, 2 * np.pi, 200))
    with house_style(), np.errstate(divide="ignore", invalid="ignore"):  # a law that gives no force here has no -1/H
        figure = new_figure(height=5.4, width=8.6)
        left, right = figure.subplots(1, 2)
        unit = disk.law.T / disk.b
        for number, at in enumerate(np.pi * np.array([0.2, 0.3, 0.5, 1.0])):
            around = (disk.centre(at) + disk.radius(at) * turn) / unit
            style = style_of(number)
            left.plot(around.real, around.imag, label=f"{at / np.pi:g} x Nyquist", **style)
            if np.isfinite(point := -1 / disk.law.at(at) / unit):
                left.plot(point.real, point.imag, marker="o", color=style["color"], markersize=7)
        locus = -1 / disk.law.at(theta) / unit
        shown = np.abs(locus) < 1e3
        left.plot(locus.real[shown], locus.imag[shown], color="#8a8a8a", linewidth=1.0, label="-1/H")
        left.set(xlabel="Re G [T/b]", ylabel="Im G [T/b]", xlim=(-1.7, 1.1), ylim=(-1.8, 1.0))
        circles = "a circle of all passive hands for each frequency;\nnot passive: a dot of -1/H inside its own circle"
        left.set_title(circles, fontsize="small")
        mapped = disk.mapped(theta)
        right.plot(turn.real, turn.imag, label="unit circle", **STYLES[0])
        right.plot(mapped.real, mapped.imag, label="the law, mapped", **STYLES[1])
        reach = min(max(1.3, 1.15 * np.abs(mapped).max()), 8.0)
        worst = complex(disk.mapped(disk.worst))
        seen = max(abs(worst.real), abs(worst.imag)) <= reach
        if seen:
            right.plot(worst.real, worst.imag, "ko", markersize=5, label=f"worst: |M| {disk.size}")
        else:  # in words only
            right.plot([], [], linestyle="", label=f"worst: |M| {disk.size}, off the picture")
        right.set(xlabel="Re M", ylabel="Im M", xlim=(-reach, reach), ylim=(-reach, reach))
        corner = 3 * reach  # hatched: the square beyond the unit circle
        square = np.array([[-corner, -corner], [corner, -corner], [corner, corner], [-corner, corner], [-corner, -corner]])
        right.fill(*np.vstack([square, np.column_stack([turn.real, -turn.imag])]).T, label="outside: not passive", **HATCHED)
        right.set_title(f"all circles mapped onto one\n{disk.law.name}, b = {disk.b:g} N s/m", fontsize="small")
        for axes in (left, right):
            axes.set_box_aspect(1)  # both sides have one length, so that circles are round
        figure.legend(loc="outside lower center", ncols=4, fontsize="small")
    return figure


def plot_coupler(design: CouplerDesign) -> Figure:
    """Draw the pairs of a coupler that are absolutely stable, and the criterion of the chosen one.

    Parameters
    ----------
    design : CouplerDesign

    Returns
    -------
    matplotlib.figure.Figure
    """
    theta = np.linspace(1e-2, np.pi, 600)
    dampers, springs = design.border()
    with house_style():
        figure = new_figure(height=4.0, width=9.6)
        left, right = figure.subplots(1, 2)
        left.plot(dampers, springs, **STYLES[0])
        left.fill_between(dampers, springs, color=COLD, alpha=0.15, linewidth=0)
        left.plot(design.b_c, design.k_c, "ko", label="this design")
        left.set(xlabel="coupler damping $b_c$ [N s/m]", ylabel="coupler stiffness $k_c$ [N/m]", ylim=(0, 1.15 * springs.max()))
        left.fill_between(dampers, springs, 1.15 * springs.max(), label="not absolutely stable", **HATCHED)
        left.set_title("absolutely stable below the line", fontsize="small")
        left.legend(fontsize="small", **FRAME)
        left.locator_params(axis="x", nbins=5)
        right.plot(theta / (2 * np.pi * design.T), design.two_port.criterion(theta), **STYLES[0])
        right.set(xlabel="frequency [Hz]", ylabel="Llewellyn's criterion", xlim=(0, 0.5 / design.T))
        forbid(right, 0.0, "below 0: not absolutely stable", below=True)
        right.legend(fontsize="small", **FRAME)
        right.set_title(f"b = {design.b:g} N s/m, T = {1e3 * design.T:g} ms, delay {1e3 * design.delay:g} ms", fontsize="small")
    return figure


def plot_admittance(design: AdmittanceDesign) -> Figure:
    """Draw the criterion of an admittance display, and the least mobility that a hand can be made to feel.

    Parameters
    ----------
    design : AdmittanceDesign

    Returns
    -------
    matplotlib.figure.Figure
    """
    theta, T = np.linspace(1e-2, np.pi, 600), design.two_port.T
    frequency = theta / (2 * np.pi * T)
    with house_style():
        figure = new_figure(height=4.0, width=9.6)
        left, right = figure.subplots(1, 2)
        left.plot(frequency, design.two_port.criterion(theta), **STYLES[0])
        forbid(left, 0.0, "below 0: not absolutely stable", below=True)
        left.set(ylabel="Llewellyn's criterion")
        left.legend(fontsize="small", **FRAME)
        right.plot(frequency, design.two_port.h(theta)[:, 0, 0].real, label="environment at rest", **STYLES[0])
        right.plot(frequency, design.two_port.least_resistance(theta), label="worst environment", **STYLES[1])
        right.set(ylabel="Re of the admittance felt [m/s/N]")
        right.legend(fontsize="small", **FRAME)
        for axes in (left, right):
            axes.set(xlabel="frequency [Hz]", xlim=(0, 0.5 / T))
        figure.suptitle(design.two_port.name, fontsize="small")
    return figure


def plot_bounds(bounds: Bounds) -> Figure:
    """Draw the named bounds as bars, those of passivity told apart from the others.

    Parameters
    ----------
    bounds : Bounds

    Returns
    -------
    matplotlib.figure.Figure
    """
    with house_style():
        figure = new_figure(height=0.55 * len(bounds.found) + 1.4)
        axes = figure.subplots()
        finite = [limit.K for limit in bounds.found.values() if not isinstance(limit, str) and np.isfinite(limit.K)]
        most = 1.25 * max(finite, default=1.0) or 1.0
        for row, limit in enumerate(bounds.found.values()):
            if isinstance(limit, str):
                axes.text(0.01 * most, row, "does not apply", va="center", fontsize="small", color="#555555")
                continue
            bar = {"color": COLD} if limit.any_hand else {"color": "white", "hatch": "///", "edgecolor": WARM}
            axes.barh(row, min(limit.K, most), height=0.6, **bar)
            axes.text(min(limit.K, most) + 0.01 * most, row, f"{limit.K:.4g}", va="center", fontsize="small")
        axes.set(yticks=range(len(bounds.found)), yticklabels=list(bounds.found), xlim=(0, 1.1 * most))
        signs = "filled: passive in any hand, hatched: stable in this hand"
        axes.set_xlabel(f"largest stiffness K [N/m]; no guarantee to the right of a bar\n{signs}")
        axes.set_title(f"law {bounds.law}, B = {bounds.B:g} N s/m", fontsize="small")
        axes.invert_yaxis()
    return figure


def plot_diolaiti(point: DiolaitiPoint) -> Figure:
    """Draw the four regions of Diolaiti's plane and one wall in it; along a ray from the origin K falls.

    Parameters
    ----------
    point : DiolaitiPoint

    Returns
    -------
    matplotlib.figure.Figure
    """
    calm = 0.5 + point.tau
    sigma = min(point.sigma, 1.5)
    right, top = 1.6 * max(calm, point.beta), 1.6 * max(0.5, sigma)
    with house_style():
        figure = new_figure(height=4.4)
        axes = figure.subplots()
        corners = (
            ("passive", calm, right, 0.5, top, "#ffffff"), ("limit cycles", calm, right, 0, 0.5, "#dfe6ee"),
            ("locally stable", 0, calm, 0.5, top, "#f0cfb8"), ("unstable", 0, calm, 0, 0.5, "#a9a9a9"),
        )  # fmt: skip
        for name, x0, x1, y0, y1, colour in corners:
            axes.fill_between([x0, x1], y0, y1, color=colour, linewidth=0)
            axes.text((x0 + x1) / 2, (y0 + 2 * y1) / 3, name, ha="center", va="center")
        axes.plot([0, 4 * point.beta], [0, 4 * sigma], label="softer walls lie farther out", **STYLES[1])
        axes.plot(point.beta, sigma, "ko", label="this wall")
        axes.set(xlim=(0, right), ylim=(0, top), xlabel=r"$\beta$ = b/(K T)", ylabel=r"$\sigma$ = $f_c$/(K $\Delta$)")
        axes.set_title(f"delay {point.tau:g} periods", fontsize="small")
        axes.legend(fontsize="small", loc="lower right", **FRAME)
    return figure


def plot_law(law: LinearLaw) -> Figure:
    """Draw the spring and the damper as which slow and fast sinusoids feel a law that is sampled and held.

    Parameters
    ----------
    law : LinearLaw

    Returns
    -------
    matplotlib.figure.Figure
    """
    theta = np.linspace(1e-3, np.pi, 800)
    frequency, omega = theta / (2 * np.pi * law.T), theta / law.T
    felt = law.at(theta) * (1 - np.exp(-1j * theta)) / (1j * theta)  # F/x of a sinusoid, the hold included
    with house_style():
        figure = new_figure(height=5.2)
        above, below = figure.subplots(2, 1, sharex=True)
        above.plot(frequency, felt.real, **STYLES[0])
        above.set(ylabel="felt stiffness [N/m]")
        above.set_title(f"{law.name}: response to a sinusoid, sampled and held", fontsize="small", wrap=True)
        damping = felt.imag / omega
        below.plot(frequency, damping, **STYLES[0])
        if (damping < 0).any():
            below.fill_between(
                frequency, damping, 0, where=damping < 0, **HATCHED, label="negative: it supplies energy to the hand"
            )
            below.legend(fontsize="small", **FRAME)
        below.axhline(0.0, color="#4d4d4d", linewidth=0.8)
        below.set(xlabel="frequency [Hz]", ylabel="felt damping [N s/m]", xlim=(0, 0.5 / law.T))
    return figure


def plot_two_port(port: TwoPort) -> Figure:
    """Draw Llewellyn's criterion over frequency.

    Parameters
    ----------
    port : TwoPort

    Returns
    -------
    matplotlib.figure.Figure
    """
    theta = np.linspace(1e-2, np.pi, 600)
    verdict = "absolutely stable" if port.absolutely_stable else "not absolutely stable"
    with house_style():
        figure = new_figure(height=3.8)
        axes = figure.subplots()
        criterion = port.criterion(theta)
        axes.plot(theta / (2 * np.pi * port.T), criterion, label="criterion", **STYLES[0])
        forbid(axes, 0.0, "below 0: not absolutely stable", below=True)
        axes.legend(fontsize="small", **FRAME)
        axes.set(xlabel="frequency [Hz]", ylabel="Llewellyn's criterion", xlim=(0, 0.5 / port.T))
        axes.set_title(f"{port.name}: {verdict}", fontsize="small", wrap=True)
    return figure
