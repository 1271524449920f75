"""What is found of chatter in a record, in words and as a picture."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal

from ...base.shows_itself import ShowsItself
from ...base.telemetry import Telemetry
from .finding_plots import plot_chatter

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class Chatter(ShowsItself):
    """What the last half of a record shows.

    Attributes
    ----------
    state : {"none", "chatter", "growing", "decaying", "undecided", "driven", "runaway"}
        "chatter" is a sustained limit cycle: it has settled (``locked``), or it shrinks towards a cycle and not to rest.
        "growing" ends in a cycle too, or in none; "decaying" dies out. "undecided": it oscillates, and the record does not
        tell whether it lasts, as ``longer`` may; or it turned round once in the last half and still moves, half a swing
        that may be a slow oscillation or none.
        "driven": it oscillates because, and as, what drives it does. "runaway": it does not turn round and becomes faster.
    amplitude : float
        Half the peak-to-peak of the handle's oscillation over the last half [m]; 0 where there is none. Without the part
        that is driven, where ``driven`` was given.
    frequency : float or None
        [Hz], from interpolated zero crossings; its error is below one sampling period in half the record.
    contacts_per_second : float
        How often the force goes from zero to nonzero [1/s], over the last half.
    growth : float
        Logarithm of the amplitude's ratio between the last two quarters, per second [1/s]; nan where one has no swing.
    locked : bool
        True for a sustained oscillation that has settled: its last quarters agree within 1 %, or differ by less than its
        own irregularity explains.
    dither : bool
        The sensed position takes two neighbouring values and no other: one encoder count.
    rest : float
        Mean position over the last quarter [m].
    travel : float
        Peak-to-peak of the handle over the last quarter [m].
    period : int or None
        Samples after which a locked cycle repeats itself, to 1e-4 of its amplitude; None where it is not locked to the
        sampling within 2000 samples.
    scatter : float
        Standard deviation of what is left where that is white noise of the sensor, and so no motion [m]; else 0.
    levels_off : bool
        A decay that becomes slower and slower, or whose force is at its limit: onto a cycle, perhaps, and not to rest.
    driven : float
        Half the peak-to-peak of the part that follows the drive [m]; 0 where none was given.
    growth_error : float
        Standard error of ``growth`` [1/s], by what four windows differ from an exponential; nan with too few cycles.
    ends_at : (float, float) or None
        Lowest and highest amplitude at which the oscillation ends [m], by a constant plus an exponential through its
        swings; None where it was not looked for: the handle leaves no wall and no motor is at its limit.
    longer : float or None
        Where it is undecided, the length of a record that may decide [s]: twice this one, which decided about
        two thirds of such records on a map of random plants.
    amplitude_at_end : float
        Half the peak-to-peak of the last cycle [m]; of the last quarter where no cycle is seen.
    inside_growth : float
        How small oscillations grow that do not leave the wall [1/s], by the linear motion of the samples inside; nan where
        the record does not show it: an encoder, friction or noise, a law that is not linear, or too few samples.
    record : Telemetry
        Where it was found.
    """

    state: Literal["none", "chatter", "growing", "decaying", "undecided", "driven", "runaway"]
    amplitude: float
    frequency: float | None
    contacts_per_second: float
    growth: float
    locked: bool
    dither: bool
    rest: float
    travel: float
    period: int | None = None
    driven: float = 0.0
    growth_error: float = math.nan
    scatter: float = 0.0
    levels_off: bool = False
    ends_at: tuple[float, float] | None = None
    longer: float | None = None
    amplitude_at_end: float = 0.0
    inside_growth: float = math.nan
    record: Telemetry | None = field(default=None, repr=False, compare=False)

    def plot(self) -> Figure:
        """Return a figure: the handle's motion with the swing found in its last half, and which frequencies are in it."""
        return plot_chatter(self)

    def __str__(self) -> str:
        if self.state == "runaway":
            return f"runaway: the handle moves by {1e3 * self.travel:.4g} mm in the last quarter, faster and faster"
        if self.state == "driven":
            return (
                f"driven: {1e3 * self.driven:.4g} mm follow the excitation of the handle; the handle has no oscillation "
                "of its own"
            )
        if self.scatter:
            noise = f"the sensor scatters by {1e3 * self.scatter:.3g} mm (standard deviation)"
            return f"none: the handle rests at {1e3 * self.rest:.4g} mm; {noise}, which is not motion"
        if self.state == "none":
            moves = self.travel > 1e-3 * abs(self.rest) + 1e-6
            where = f"drifts by {1e3 * self.travel:.4g} mm" if moves else f"rests at {1e3 * self.rest:.4g} mm"
            return f"none: the handle {where}, with no oscillation in the last half"
        tone = "no measurable frequency" if self.frequency is None else f"{self.frequency:.4g} Hz"
        size = f"{1e3 * self.amplitude:.4g} mm"
        if self.state == "decaying":
            size = f"{1e3 * self.amplitude_at_end:.3g} mm at the end, of up to {size} in the last half,"
        place = f"{size} at {tone}, {self.contacts_per_second:.4g} contacts/s"
        if self.dither:
            place += "; the sensed position moves by one encoder count only: dither of the encoder"
        place += f", in addition to {1e3 * self.driven:.4g} mm that follow the excitation" if self.driven else ""
        if self.locked:
            cycle = f", repeats itself every {self.period} samples" if self.period else ""
            return f"chatter: {place}; sustained (growth {self.growth:+.2g} 1/s){cycle}"
        if self.state == "chatter" and self.inside_growth > 0:
            return (
                f"chatter: {place}; it ends in a cycle: inside the wall small oscillations grow by {self.inside_growth:.2g} 1/s"
            )
        if self.state == "chatter" and self.ends_at:
            low, high = (1e3 * a for a in self.ends_at)
            return f"chatter: {place}; it shrinks towards a cycle of {low:.3g} to {high:.3g} mm (growth {self.growth:+.3g} 1/s)"
        cure = "it dies out" if self.state == "decaying" else "run longer to find its final amplitude"
        cure = "it may end in a cycle instead of at rest; run longer" if self.levels_off else cure
        if self.state == "undecided":
            cure = "it may die out or last; run longer" + (f", {self.longer:.2g} s may be enough" if self.longer else "")
        growth = "growth unknown" if math.isnan(self.growth) else f"growth {self.growth:+.3g} 1/s"
        return f"{self.state}: {place}; not locked ({growth}): {cure}"
