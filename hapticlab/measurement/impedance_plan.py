"""How an impedance is measured: what shakes the handle, what is averaged, and what a board's handle may do."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, get_args

import numpy as np

from ..base.arguments import choice, count, numbers
from ..base.shows_itself import ShowsItself
from .impedance_signal import How

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from .measured import Drive


@dataclass(frozen=True, kw_only=True, eq=False)
class Excitation(ShowsItself):
    """The excitation of the handle while its impedance is measured.

    Parameters
    ----------
    how : {"multisine", "swept_sine"}
        Odd lines at once with phases of low crest factor, anew in each realization; or a periodic chirp through the
        band.
    drive : {"hand", "motor"}, optional
        By default the hand where a simulated paddle has one with k or b, else the motor.
    frequency : array, optional
        [Hz]; the nearest odd lines are taken. By default 24 from 2 Hz to a fifth of the sampling rate.
    amplitude : float or text, optional
        Peak of the intent [m], 1 mm, or of the motor's force [N], 0.1 N; a text needs the drive.
    seed : int
        Of the phases.

    Examples
    --------
    >>> import hapticlab as hl
    >>> hl.measure.Excitation(drive="motor", amplitude="200 mN").amplitude
    0.2
    """

    how: How = "multisine"
    drive: Drive | None = None
    frequency: ArrayLike | None = None
    amplitude: float | None = None
    seed: int = 0

    def __str__(self) -> str:
        lines = "" if self.frequency is None else f" of {np.size(self.frequency)} lines"
        amplitude = "" if self.amplitude is None else f", amplitude {self.amplitude:g}"
        return (
            f"{self.how.replace('_', ' ')}{lines} by the {self.drive or 'hand, or else the motor'}{amplitude}, seed {self.seed}"
        )

    def __post_init__(self) -> None:
        choice("how", self.how, get_args(How))
        choice("drive", self.drive, (None, "hand", "motor"), need="'hand' or 'motor'")
        unit = {"hand": "m", "motor": "N", None: ""}[self.drive]
        numbers(self, "an excitation", amplitude={"unit": unit, "above": 0})


@dataclass(frozen=True, kw_only=True)
class Averaging(ShowsItself):
    """The amount of recorded data, and the fraction that is used.

    Parameters
    ----------
    period : float or text
        Of the excitation [s].
    blocks, realizations : int
        Periods that are kept of each realization, and how many of these there are.
    settle : float or text
        What is waited for before the first block [s].

    Examples
    --------
    >>> import hapticlab as hl
    >>> hl.measure.Averaging(blocks=8, settle="500 ms")
    Averaging(period=1.0, blocks=8, realizations=2, settle=0.5)
    """

    period: float = 1.0
    blocks: int = 4
    realizations: int = 2
    settle: float = 2.0

    def __post_init__(self) -> None:
        numbers(self, "averaging", period={"unit": "s", "above": 0}, settle={"unit": "s", "least": 0})
        for name in ("blocks", "realizations"):
            object.__setattr__(self, name, count(name, getattr(self, name), "averaging"))


@dataclass(frozen=True, kw_only=True)
class Safety(ShowsItself):
    """Limits on the motion of a board's handle while its motor shakes it; a simulated handle has none.

    Parameters
    ----------
    force_max : float or text, optional
        The largest force of the motor [N]; by default what holds the place and twice the amplitude.
    reach : float or text
        How far from where it began the handle may go [m].
    speed_max : float or text
        How fast it may move [m/s].

    Examples
    --------
    >>> import hapticlab as hl
    >>> hl.measure.Safety(reach="5 mm").reach
    0.005
    """

    force_max: float | None = None
    reach: float = 0.02
    speed_max: float = 1.0

    def __post_init__(self) -> None:
        force, length, speed = ({"unit": unit, "above": 0} for unit in ("N", "m", "m/s"))
        numbers(self, "a board", force_max=force, reach=length, speed_max=speed)


EXCITATION, AVERAGING, SAFETY = Excitation(), Averaging(), Safety()
