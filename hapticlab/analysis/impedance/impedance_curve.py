"""The impedance of a scene over frequency, as a picture: where it is a spring, a damper, a mass."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...base.drawing import STYLES, house_style, log_scales, new_figure
from ...base.shows_itself import ShowsItself

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from ...base.annotations import Array

#: where an impedance is looked at unless frequencies are given [Hz]
LOOKED_AT = np.geomspace(0.1, 200.0, 600)
SOFT = "#8a8a8a"


@dataclass(frozen=True, eq=False)
class Impedance(ShowsItself):
    """What a scene is at its port.

    Attributes
    ----------
    name : str
    frequency : array, shape (P,)
        [Hz]
    Z : complex array, shape (P,)
        F/v [N s/m].
    """

    name: str
    frequency: Array
    Z: NDArray[np.complex128]

    def __str__(self) -> str:
        ends = (f"{abs(self.Z[k]):.3g} N s/m at {self.frequency[k]:.3g} Hz, {_like(self.Z[k])}" for k in (0, -1))
        return f"impedance of {self.name}: " + "; ".join(ends)

    def plot(self) -> Figure:
        """Return a figure: size and angle over frequency; a mass leads by 90 degrees, a damper by none, a spring lags."""
        with house_style():
            figure = new_figure(height=5.4)
            above, below = figure.subplots(2, 1, sharex=True, height_ratios=(3, 2))
            above.plot(self.frequency, abs(self.Z), **STYLES[0])
            log_scales(above)
            above.set(ylabel="|Z| = |F/v| [N s/m]")
            above.set_title(str(self), fontsize="small", wrap=True)
            below.plot(self.frequency, np.degrees(np.angle(self.Z)), **STYLES[0])
            for angle, word in ((90, "mass"), (0, "damper"), (-90, "spring")):
                below.axhline(angle, color=SOFT, linewidth=0.8)
                below.annotate(word, (1.0, angle), xycoords=("axes fraction", "data"), ha="right", va="bottom", fontsize="small")
            below.set(xlabel="frequency [Hz]", ylabel="angle of Z [degrees]", ylim=(-115, 125), yticks=(-90, -45, 0, 45, 90))
        return figure


def _like(Z):
    """Say what an impedance is most like."""
    angle = np.degrees(np.angle(Z))
    return "like a mass" if angle > 60 else "like a spring" if angle < -60 else "like a damper"
