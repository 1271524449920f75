"""Figures of what was found in a record: chatter, energy through the port, energy books."""

import textwrap

import numpy as np

from ...base.drawing import COLD, FRAME, STYLES, WARM, house_style, legend_above, new_figure
from ...errors import AnalysisError


def plot_chatter(found):
    """Draw the handle's motion with the swing of its last half, and how much of each frequency is in that.

    Parameters
    ----------
    found : Chatter
        As :func:`hapticlab.chatter` returns it.

    Returns
    -------
    matplotlib.figure.Figure
    """
    log = found.record
    if log is None:
        raise AnalysisError("this Chatter contains no record; use the one that hl.chatter(log) returns")
    t, x = np.asarray(log.t), 1e3 * np.asarray(log.channels.get("x_true", log.x), float)
    half = len(t) // 2
    with house_style():
        figure = new_figure(height=5.4)
        above, below = figure.subplots(2, 1, height_ratios=(3, 2))
        above.axvspan(t[-half], t[-1], color="#e4e4e4", linewidth=0, label="examined: the last half")
        above.plot(t, x, **STYLES[0], label="handle") if len(t) < 3000 else above.plot(t, x, "k-", lw=0.6, label="handle")
        if found.amplitude:
            middle = (x[-half:].max() + x[-half:].min()) / 2
            for sign, label in ((1, f"amplitude, {1e3 * found.amplitude:.3g} mm to either side"), (-1, None)):
                above.plot(t[[-half, -1]], [middle + sign * 1e3 * found.amplitude] * 2, **STYLES[1], label=label)
        above.set(xlabel="time t [s]", ylabel="handle position x [mm]")
        above.set_title("\n".join(textwrap.wrap(str(found), 92)), fontsize="small")
        legend_above(above, 3)
        _spectrum(below, t[-half:], x[-half:], found)
    return figure


def _spectrum(axes, t, x, found):
    """Draw the amplitude of each frequency in a motion, less its straight line, and the frequency that was found."""
    window = np.hanning(len(x) + 2)[1:-1]
    swing = x - np.polyval(np.polyfit(t, x, 1), t)
    size = 2 * np.abs(np.fft.rfft(window * swing, 8 * len(x))) / window.sum()
    frequency = np.fft.rfftfreq(8 * len(x), t[1] - t[0])
    axes.plot(frequency, size, **STYLES[0], label="amplitude in the last half")
    end = frequency[-1]
    if found.frequency:
        axes.axvline(found.frequency, **STYLES[1], label=f"found: {found.frequency:.4g} Hz")
        end = min(end, max(5 * found.frequency, 20.0))
    axes.set(xlabel="frequency [Hz]", ylabel="amplitude [mm]", xlim=(0, end), ylim=(0, None))
    axes.legend(fontsize="small", **FRAME)


def plot_energy(found):
    """Draw the energy that the environment holds of what it took, hatched where it gave more than that.

    Parameters
    ----------
    found : Energy
        As :func:`hapticlab.energy` returns it.

    Returns
    -------
    matplotlib.figure.Figure
    """
    W = 1e3 * found.W
    with house_style():
        figure = new_figure(height=3.8)
        axes = figure.subplots()
        axes.plot(found.t, W, **STYLES[0], label="taken from the handle minus returned")
        axes.axhline(0.0, color="#4d4d4d", linewidth=0.8)
        if found.extracted > 0:
            given = f"returned beyond the energy taken, at most {1e3 * found.extracted:.3g} mJ"
            axes.fill_between(found.t, W, 0, where=W < 0, facecolor="none", edgecolor=WARM, hatch="///", linewidth=0, label=given)
        axes.set(xlabel="time t [s]", ylabel="energy [mJ]")
        axes.set_title("\n".join(textwrap.wrap(str(found), 92)), fontsize="small")
        axes.legend(fontsize="small", **FRAME)
    return figure


def plot_balance(books):
    """Draw where the supplied energy is, and what the books cannot account for.

    Parameters
    ----------
    books : Balance
        As :func:`hapticlab.records.balance` returns it.

    Returns
    -------
    matplotlib.figure.Figure
    """
    t, stored, lost = books.t, 1e3 * books.stored, 1e3 * (books.dissipated - books.dissipated[0])
    with house_style():
        figure = new_figure(height=5.4)
        above, below = figure.subplots(2, 1, sharex=True, height_ratios=(3, 2))
        above.fill_between(t, lost, color=COLD, alpha=0.35, linewidth=0, label="dissipated")
        above.fill_between(t, lost, lost + stored, facecolor="none", edgecolor=WARM, hatch="...", linewidth=0, label="stored")
        above.plot(t, 1e3 * (books.supplied - books.supplied[0] + books.stored[0]), **STYLES[0], label="supplied")
        above.set(ylabel="energy [mJ]")
        above.set_title("\n".join(textwrap.wrap(str(books), 96)), fontsize="small")
        above.legend(fontsize="small", **FRAME)
        below.plot(t, 1e3 * books.leak, **STYLES[0], label="leak: supplied, neither stored nor dissipated (the method)")
        below.plot(t, 1e3 * books.sampling, **STYLES[1], label="returned at the port, not supplied (sampling and hold)")
        below.set(xlabel="time t [s]", ylabel="energy [mJ]")
        legend_above(below, 3)
    return figure
