"""The small figure of a record in a notebook."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .drawing import COLD, SHOWN, WARM, house_style, new_figure

if TYPE_CHECKING:
    from .telemetry import Telemetry


def thumbnail(log: Telemetry) -> Any:
    """A small figure of position and force over time; None of a record too short to draw."""
    if len(log) < 2:
        return None
    with house_style():
        figure = new_figure(height=1.7, width=6.4)
        for axes, name, colour in zip(figure.subplots(1, 2), ("x", "F"), (COLD, WARM), strict=True):
            scale, unit = SHOWN.get(log.units[name], (1.0, log.units[name]))
            axes.plot(log.t, scale * getattr(log, name), color=colour)
            axes.set(xlabel="time t [s]", ylabel=f"{name} [{unit}]")
    return figure
