"""Figures of the limits: damping asked for by frequency, disks of passive hands, bounds side by side, couplers."""

import numpy as np

from ..drawing import FRAME, STYLES, house_style, new_figure, style_of


def plot_passivity_margin(margin):
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
        axes.plot(frequency, asked, label="any motion through the samples (Colgate and Schenkel)", **STYLES[0])
        axes.plot(frequency, -margin.equivalent_damper(theta), label="a sinusoid: $-b_{eq}$", **STYLES[1])
        axes.axhline(margin.b, label="the device's b", **STYLES[5])
        axes.fill_between(frequency, asked, margin.b, where=asked > margin.b, color="#c1440e", alpha=0.2, linewidth=0)
        if np.isfinite(margin.required):
            axes.plot(margin.frequency, margin.required, "ko", markersize=5)
        axes.set(xlim=(0, frequency[-1]), xlabel="frequency [Hz]", ylabel="damping asked for [N s/m]")
        axes.margins(y=0.15)
        late = f", delay {1e3 * margin.delay:g} ms" if margin.delay else ""
        axes.set_title(f"{margin.law.name}, T = {1e3 * margin.law.T:g} ms{late}", fontsize="small")
        axes.legend(fontsize="small", **FRAME)
    return figure


def plot_nyquist_disk(disk):
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
    with house_style():
        figure = new_figure(height=5.0, width=9.6)
        left, right = figure.subplots(1, 2)
        unit = disk.law.T / disk.b
        for number, at in enumerate(np.pi * np.array([0.2, 0.3, 0.5, 1.0])):
            around = (disk.centre(at) + disk.radius(at) * turn) / unit
            style = style_of(number)
            left.plot(around.real, around.imag, label=f"{at / np.pi:g} x Nyquist", **style)
            if np.isfinite(point := -1 / disk.law.at(at) / unit):
                left.plot(point.real, point.imag, marker="o", color=style["color"], markersize=7)
        with np.errstate(divide="ignore"):
            locus = -1 / disk.law.at(theta) / unit
        shown = np.abs(locus) < 1e3
        left.plot(locus.real[shown], locus.imag[shown], color="#8a8a8a", linewidth=1.0, label="-1/H; dots: there")
        left.set(xlabel="Re G [T/b]", ylabel="Im G [T/b]", xlim=(-1.7, 1.1), ylim=(-1.8, 1.0), aspect="equal")
        left.set_title("device in any passive hand: a disk each frequency", fontsize="small")
        mapped = disk.mapped(theta)
        right.plot(turn.real, turn.imag, label="unit circle", **STYLES[0])
        right.plot(mapped.real, mapped.imag, label="the law, mapped", **STYLES[1])
        worst = disk.mapped(disk.worst)
        right.plot(worst.real, worst.imag, "ko", markersize=5, label=f"worst: |M| = {abs(worst):.3g}")
        reach = max(1.3, min(3.0, 1.1 * np.abs(mapped).max()))
        right.set(xlabel="Re M", ylabel="Im M", xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal")
        right.set_title(f"{disk.law.name}, b = {disk.b:g} N s/m", fontsize="small")
        for axes in (left, right):
            axes.legend(fontsize="small", loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=3)
    return figure
