"""A map of a wall: its regions, the limits on it, and what it says of itself."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np

from ...base.arguments import choice
from ...base.grid import labelled
from ...base.shows_itself import ShowsItself
from ...errors import AnalysisError
from ...limits.passivity import SWITCHING_NOT_COVERED
from .wall_map_plot import plot_wall_map

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from ...base.annotations import Array, Flags
    from ...limits.limit import Limit

Region = Literal["passive", "stable", "chatters", "unusable"]
REGIONS: tuple[Region, ...] = get_args(Region)


@dataclass(frozen=True, eq=False)
class WallMap(ShowsItself):
    """A wall over stiffness and one more quantity.

    ``passive``: within the passivity limit of this device, so that no passive hand of any kind sets it chattering, and
    resting in the simulation too. ``stable``: beyond that limit, but at rest at the end of the simulated contact, in this
    hand, from this start. ``chatters``: a sustained or growing oscillation, larger than one encoder count. ``unusable``: one
    of more than ``unusable`` [m] half the swing, or a handle thrown off that is not back in time where the linear loop is
    unstable or not known, or forces that are not finite.

    Attributes
    ----------
    axes : dict of str to array
        K [N/m], then the other quantity; SI.
    regions : int array of shape (len(K), len(other))
        0 passive, 1 stable, 2 chatters, 3 unusable.
    amplitude : array of that shape
        Half the largest swing of the last quarter [m], 0 at rest; nan where the run cannot tell.
    undecided : bool array of that shape
        Points that the linear theory decides, because the run cannot tell.
    rows : array
        Values of the other quantity at which theory was computed.
    limits : dict of str to tuple of Limit
        "passivity", "stability" and bounds by name: the largest K at each of ``rows``; None where a bound does not hold.
    unusable : float
        Half the swing above which a wall is unusable [m].
    duration : float
        Simulated time of a point [s], or a little more where T is an axis.
    units : dict of str to str
    about : str
        Law, paddle and start, in lines.
    seconds : float
        How long the map took [s].
    """

    axes: dict[str, Array]
    regions: NDArray[np.int_]
    amplitude: Array
    undecided: Flags
    rows: Array
    limits: dict[str, tuple[Limit | None, ...]]
    unusable: float
    duration: float
    units: dict[str, str] = field(default_factory=dict)
    about: str = ""
    seconds: float = math.nan

    def limit(self, name: str) -> Array:
        """Return the stiffnesses [N/m] of a limit at ``rows``; nan where a bound's assumptions fail."""
        if name not in self.limits:
            raise AnalysisError(f"there is no limit {name} here; the map has {', '.join(self.limits)}")
        return np.array([math.nan if one is None else one.K for one in self.limits[name]])

    def share(self, region: Region) -> float:
        """Return the part of the map that is a region, 0 to 1."""
        choice("region", region, REGIONS)
        return float((self.regions == REGIONS.index(region)).mean())

    @property
    def surprises(self) -> Flags:
        """Points within the passivity limit that chatter all the same, as an encoder or friction makes them: bool array."""
        return under(self, "passivity") & (self.regions >= 2)

    @property
    def inside_only(self) -> bool:
        """Whether the passivity limit says nothing about the switching at the boundary: a law with a memory, or delay."""
        return any(SWITCHING_NOT_COVERED in one.assumptions for one in self.limits.get("passivity", ()) if one)

    @property
    def beyond_words(self) -> str:
        """Why points beyond the line of exact stability come to rest, in a sentence; empty where none do."""
        resting = int((beyond(self) & (self.regions <= 1)).sum())
        if not resting:
            return ""
        return (
            f"{resting} points beyond the line of exact linear stability come to rest from this start: the line ignores "
            "Coulomb friction and the encoder, and it is about an endless time"
        )

    def plot(self) -> Figure:
        """Draw the regions with the lines of the theory; see :func:`hapticlab.analysis.walls.wall_map_plot.plot_wall_map`."""
        return plot_wall_map(self)

    _hidden = ("axes", "regions", "rows", "limits", "units", "seconds")

    def to_xarray(self) -> Any:
        """An ``xarray.Dataset`` of regions and amplitude over K and the other quantity, SI; units in ``attrs["units"]``.

        Raises
        ------
        AnalysisError
            Where xarray, which is optional, is not installed.
        """
        over = tuple(self.axes)
        variables = {name: (over, getattr(self, name)) for name in ("regions", "amplitude", "undecided")}
        made = labelled(variables, self.axes, self.units | {"amplitude": "m"}, about=self.about)
        made["regions"].attrs |= {"flag_values": list(range(len(REGIONS))), "flag_meanings": " ".join(REGIONS)}
        return made

    def __str__(self) -> str:
        (K, k), (other, a) = self.axes.items()
        known = "passivity" in self.limits
        shares = ", ".join(f"{name} {100 * self.share(name):.1f} %" for name in REGIONS[0 if known else 1 :])
        shares += "" if known else '; passive: not known for a scene (laws by name, such as law="zoh", also show the theory)'
        lines = [
            f"wall map over {K} = {k[0]:g} to {k[-1]:g} N/m and {other} = {a[0]:g} to {a[-1]:g} {self.units[other]}: {shares}",
            f"  {self.about}".replace("\n", "\n  "),
            f"  {self.regions.size} points of {self.duration:g} s; unusable is an oscillation of more than "
            f"{1e3 * self.unusable:g} mm to either side, or a handle thrown out by an unstable loop",
        ]
        if self.surprises.any():
            lines.append(
                f"  {self.surprises.sum()} points within the passivity limit chatter; this limit accounts for device "
                "damping only, not for an encoder"
            )
        if self.beyond_words:
            lines.append(f"  {self.beyond_words}")
        if self.undecided.any():
            judge = "by the linear theory" if "stability" in self.limits else "against the wall"
            lines.append(f"  {self.undecided.sum()} points are decided {judge}, because the handle does not come back in time")
        if "stability" not in self.limits:
            lines.append(
                "  without linear= no theory is known for a scene, so a decaying oscillation is regarded as coming to rest"
            )
        if self.inside_only:
            lines.append("  passivity assumes that the spring always acts; it does not account for switching at the boundary")
        return "\n".join(lines)


def under(found, name):
    """Return where K is at most a limit, straight lines between the rows; nowhere where the limit is not known."""
    K, other = found.axes.values()
    if name not in found.limits:
        return np.zeros((len(K), len(other)), bool)
    top = np.minimum(found.limit(name), 1e300)
    return K[:, None] <= np.interp(other, found.rows, top)[None, :]


def beyond(found):
    """Return where the linear loop is known to be unstable."""
    return ~under(found, "stability") & ("stability" in found.limits)


def regions_of(found, fault):
    """Return the number of the region of every point."""
    amplitude = np.nan_to_num(found.amplitude)
    lost = found.undecided & (beyond(found) | ("stability" not in found.limits))
    kinds = [fault | lost | (amplitude > found.unusable), amplitude > 0, ~under(found, "passivity")]
    return np.select(kinds, [3, 2, 1], 0)
