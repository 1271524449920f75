"""Figures of predictions: how much a step makes motions grow, and how much damping each frequency asks for."""

import itertools
import textwrap

import numpy as np

from ...base.drawing import FRAME, STYLES, forbid, house_style, new_figure
from ...limits.port import asked


def plot_step_limit(limit):
    """Draw the spectral radius of each mode's step matrix, per second of its motion, against the step.

    Parameters
    ----------
    limit : StepLimit

    Returns
    -------
    matplotlib.figure.Figure
    """
    ends = [m.h_max for m in limit.modes if 0 < m.h_max < np.inf]
    steps = np.geomspace(min([limit.h, *ends]) / 10, max([limit.h, *ends]) * 3, 200)
    with house_style():
        figure = new_figure(height=3.8)
        axes = figure.subplots()
        for mode, style in zip(limit.modes, itertools.cycle(STYLES)):
            with np.errstate(all="ignore"):
                axes.plot(1e3 * steps, _radius(mode.step(steps)), label=f"{mode.mode}; {mode.point}", **style)
        axes.axvline(1e3 * limit.h, color="#8a8a8a", label="the step used")
        axes.set(xscale="log", ylim=(0.0, 2.0), xlabel="step h [ms]", ylabel="largest |eigenvalue| of a step")
        forbid(axes, 1.0, "above 1: the step is unstable")
        axes.set_title(f"{limit.scene}, {limit.method}", fontsize="small")
        axes.legend(fontsize="small", loc="lower right", **FRAME)
    return figure


def _radius(R):
    """Return the largest |eigenvalue| of matrices, inf where one has overflowed."""
    whole = np.isfinite(R).all(axis=(-2, -1))
    found = np.abs(np.linalg.eigvals(np.where(whole[..., None, None], R, 0.0))).max(axis=-1, initial=0.0)
    return np.where(whole, found, np.inf)


def plot_port(port):
    """Draw the damping that each frequency asks of a device, in every mode, with what the device has.

    Parameters
    ----------
    port : PortPassivity

    Returns
    -------
    matplotlib.figure.Figure
    """
    frequency = np.geomspace(0.1, 0.5 / port.T, 600)
    with house_style():
        figure = new_figure(height=3.8)
        axes = figure.subplots()
        for mode, style in zip(port.modes, itertools.cycle(STYLES)):
            if np.isfinite(mode.b_req):
                b = asked(*mode.tick, port.T, 2 * np.pi * frequency * port.T, port.delay)
                axes.plot(frequency, b, label=f"{mode.mode}; {mode.point}", **style)
        if port.b_device is not None:
            axes.axhline(port.b_device, color="#8a8a8a", label="damping of the device")
        most = 1.2 * max([port.b_device or 0.0, *(mode.b_req for mode in port.modes if np.isfinite(mode.b_req))]) or 1.0
        axes.set(xscale="log", ylim=(-most, most), xlabel="frequency [Hz]", ylabel="damping asked for [N s/m]")
        if port.b_device is not None:
            forbid(axes, port.b_device, "not passive: more than the device has")
        axes.set_title(f"{port.scene}, T = {1e3 * port.T:g} ms", fontsize="small")
        axes.legend(fontsize="small", loc="lower left", **FRAME)
    return figure


def plot_worst_motion(motion):
    """Draw a closed motion, and the energy that it draws beside what the device dissipates, over two cycles.

    Parameters
    ----------
    motion : WorstMotion

    Returns
    -------
    matplotlib.figure.Figure
    """
    t = np.r_[0.0, np.cumsum(np.tile(motion.durations, 2))]
    x = np.r_[np.tile(motion.positions, 2), motion.positions[0]]
    steps = np.diff(x)
    drawn = np.cumsum(np.r_[0.0, -np.tile(motion.held, 2) * steps])
    with house_style():
        figure = new_figure(height=5.0)
        above, below = figure.subplots(2, 1, sharex=True)
        above.plot(1e3 * t, 1e3 * x, marker=".", **STYLES[0])
        above.set(ylabel="handle position x [mm]")
        above.set_title(str(motion).splitlines()[0], fontsize="small", wrap=True)
        below.plot(1e3 * t, 1e6 * drawn, label="drawn from the scene", **STYLES[1])
        if motion.b_device is not None:
            rate = motion.friction / max(np.abs(steps[: len(motion.held)]).sum(), 1e-300)
            lost = motion.b_device * steps**2 / np.tile(motion.durations, 2) + rate * np.abs(steps)
            below.plot(1e3 * t, 1e6 * np.cumsum(np.r_[0.0, lost]), label="dissipated by the device", **STYLES[2])
        searched = textwrap.fill(f"searched: {motion.searched}", 72)
        below.set(xlabel=f"time t [ms]\n{searched}", ylabel="energy [µJ]")
        below.legend(fontsize="small")
    return figure
