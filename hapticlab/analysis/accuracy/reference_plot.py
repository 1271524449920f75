"""A figure of a reference: the motion, the force, and what programs make of it."""

import numpy as np

from ...base.drawing import STYLES, house_style, legend_above, new_figure, style_of
from .port_error import recorded


def plot_reference(reference, programs):
    """Draw the motion and the force, and beside it the forces that programs hold, and by how much they are wrong.

    Parameters
    ----------
    reference : Reference
    programs : sequence of Program

    Returns
    -------
    matplotlib.figure.Figure
    """
    known, rows = reference.t <= reference.horizon, 3 if programs else 2
    with house_style():
        figure = new_figure(height=1.4 + 1.7 * rows)
        panels = figure.subplots(rows, 1, sharex=True)
        position, _, _ = reference.motion.at(reference.t)
        panels[0].plot(reference.t, 1e3 * position, **STYLES[0])
        panels[0].set(ylabel="handle position x [mm]")
        panels[0].set_title(str(reference), fontsize="small", wrap=True)
        panels[1].plot(reference.t[known], reference.F[known], **STYLES[0], label="reference")
        panels[1].set(ylabel="force F [N]")
        for number, program in enumerate(programs, 1):
            F = recorded(program, reference.motion)
            t, style = program.T * np.arange(len(F)), style_of(number)
            panels[1].step(t, F, where="post", **style, label=_name(program))
            true = np.interp(t, reference.t[known], reference.F[known], right=np.nan)
            panels[2].semilogy(t, np.where(F == true, np.nan, abs(F - true)), **style, label=_name(program))
            panels[2].set(ylabel="error at the samples [N]")
        if programs:
            legend_above(panels[1], 1 + len(programs))
        panels[-1].set_xlabel("time t [s]")
    return figure


def _name(program):
    made = [f"{program.facts[name]}" for name in ("method", "hold") if name in program.facts]
    return f"{', '.join(made) or program.name}, T = {1e3 * program.T:g} ms"
