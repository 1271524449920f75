"""The quality of a paddle: both borders over virtual damping, the rendered impedance, and its velocities, beside theory."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ...base.facts import short
from ...base.profile.paddle_profile import PaddleProfile
from ...base.shows_itself import ShowsItself
from ...device.device import total_delay
from ...limits.passivity import passivity_limit
from .figures import plot_quality
from .page import quality_page
from .record_file import write_quality

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from ...base.annotations import Array, File

#: Weber fractions: of stiffness, L. A. Jones and I. W. Hunter, Exp. Brain Res. 79 (1990) 150; of viscosity, the same authors,
#: Exp. Brain Res. 94 (1993) 343, both by adjustment of one arm's motor to the other's
STIFFNESS, DAMPING = 0.23, 0.34
#: amplitude of a buzz that is felt [N], the default of a Judgement
FELT = 0.05


def _in(unit):
    return field(metadata={"unit": unit})


@dataclass(frozen=True)
class Width(ShowsItself):
    """Both borders over virtual damping with one velocity estimate; nan where undecided.

    Attributes
    ----------
    velocity : str
    B : tuple of float
        Virtual damping [N s/m].
    K : tuple of float
        The largest stiffness that both borders allow [N/m].
    rest, quiet : tuple of float
        Up to which stiffness walls come to rest, and up to which no buzz is felt [N/m], from the worst start.
    """

    velocity: str
    B: tuple[float, ...] = _in("N s/m")
    K: tuple[float, ...] = _in("N/m")
    rest: tuple[float, ...] = _in("N/m")
    quiet: tuple[float, ...] = _in("N/m")


@dataclass(frozen=True)
class Rendered(ShowsItself):
    """The impedance of one wall, as rendered.

    Attributes
    ----------
    K, B : float
        Stiffness [N/m] and damping [N s/m] of the ideal wall.
    frequency : tuple of float
        [Hz]
    real, imaginary, radius : tuple of float
        Parts of Z = F/v, and the radius of the circle that holds the truth with 95 % confidence [N s/m].
    """

    K: float = _in("N/m")
    B: float = _in("N s/m")
    frequency: tuple[float, ...] = _in("Hz")
    real: tuple[float, ...] = _in("N s/m")
    imaginary: tuple[float, ...] = _in("N s/m")
    radius: tuple[float, ...] = _in("N s/m")

    @property
    def Z(self) -> NDArray[np.complex128]:
        """The rendered impedance [N s/m], complex."""
        return np.array(self.real) + 1j * np.array(self.imaginary)

    @property
    def ideal(self) -> NDArray[np.complex128]:
        """The impedance K/s + B that was meant [N s/m], complex."""
        return self.K / (2j * np.pi * np.array(self.frequency)) + self.B

    @property
    def stiffness(self) -> Array:
        """Effective stiffness [N/m], the real part of s Z."""
        return -2 * np.pi * np.array(self.frequency) * np.array(self.imaginary)

    @property
    def off(self) -> Array:
        """How far the rendered impedance is from the ideal, as a part of the ideal: abs(Z/ideal - 1)."""
        return np.abs(self.Z / self.ideal - 1)

    @property
    def same_up_to(self) -> float:
        """The highest frequency [Hz] up to which the impedance differs by less than 23 %; 0 where the first differs more."""
        differs = np.flatnonzero(~(self.off <= STIFFNESS))
        last = len(self.frequency) if not len(differs) else int(differs[0])
        return self.frequency[last - 1] if last else 0.0


@dataclass(frozen=True)
class Velocity(ShowsItself):
    """What one velocity estimate says of a record: how late and how rough it is, and what it costs.

    Attributes
    ----------
    name : str
    lag : float
        [s]
    noise : float
        Root mean square [m/s].
    cycles : int
        Of a tick of a damper with it.
    fits : bool
        Whether that damper fits the board at this T.
    """

    name: str
    lag: float = _in("s")
    noise: float = _in("m/s")
    cycles: int = _in("")
    fits: bool = _in("")


@dataclass(frozen=True)
class PaddleQuality(ShowsItself):
    """How good one paddle is: what was measured of it, beside what theory says of its constants.

    ``save`` writes a JSON file to share, ``page`` one HTML file to read; ``hl.measure.compare_qualities`` joins the files
    of a class.

    Attributes
    ----------
    name : str
    date : str
        Day of the measurement.
    on : str
        "simulated paddle", "simulated board" or "board".
    held : str
        The simulated hand, "a person's hand" at a board, or "nobody".
    profile : PaddleProfile
        The constants, those that were measured with intervals.
    widths : tuple of Width
    rendered : Rendered or None
    velocities : tuple of Velocity
    """

    name: str
    date: str
    on: str
    held: str
    profile: PaddleProfile
    widths: tuple[Width, ...] = ()
    rendered: Rendered | None = None
    velocities: tuple[Velocity, ...] = ()

    _hidden = ("widths", "velocities")

    @property
    def fractions(self) -> tuple[float, float]:
        """The Weber fractions of stiffness and of damping that a hand is taken to have [1]."""
        return STIFFNESS, DAMPING

    @property
    def passive(self) -> float:
        """The stiffness that Eq. (23.10) guarantees in every passive hand, with the paddle's delays [N/m]."""
        return passivity_limit(self.profile).K

    @property
    def one_count(self) -> float:
        """The stiffness at which one encoder count alone buzzes by 0.05 N [N/m]; inf without an encoder."""
        counts = self.profile.counts_per_metre
        return math.inf if counts is None else math.sqrt(2) * FELT * counts

    @property
    def same_damping(self) -> float:
        """The stiffness up to which the damping that the hold and the delays take away stays below 34 % of b [N/m]."""
        late = self.profile.T / 2 + total_delay(self.profile)
        return DAMPING * self.profile.b / late

    @property
    def stiffest(self) -> tuple[float, float, str]:
        """The stiffest quiet wall: K [N/m], its damping B [N s/m] and its velocity; nan where none was measured."""
        walls = [(K, B, w.velocity) for w in self.widths for K, B in zip(w.K, w.B, strict=True) if not math.isnan(K)]
        return max(walls, key=lambda wall: wall[0], default=(math.nan, math.nan, ""))

    def save(self, path: File) -> Path:
        """Write the record to a JSON file and return its path (``.json`` is added where missing)."""
        return write_quality(self, path)

    def page(self, path: File) -> Path:
        """Write the page of this paddle, one HTML file that requests nothing else, and return its path."""
        path = Path(path)
        path.write_text(quality_page(self), encoding="utf-8", newline="\n")
        return path

    def plot(self) -> Figure:
        """Draw both borders with each velocity, and the rendered impedance with what a hand can tell apart."""
        return plot_quality(self)

    def lines(self) -> list[str]:
        """What was found, in sentences."""
        told = [f"Eq. (23.10) guarantees walls up to {_short(self.passive)} N/m in every passive hand."]
        if math.isfinite(self.one_count):
            told.append(f"Without friction, one encoder count buzzes by {FELT:g} N at {_short(self.one_count)} N/m.")
        K, B, velocity = self.stiffest
        if K > 0:
            told.append(
                f"The stiffest wall that came to rest without a felt buzz has {_short(K)} N/m, with B = {B:.3g} N s/m by the "
                f"{velocity}."
            )
        if self.rendered is not None:
            told.append(self._same())
        told.append(
            f"A hand that judges damping alone may tell walls above {_short(self.same_damping)} N/m from ideal ones, because "
            f"they take away more than {100 * DAMPING:.0f} % of the paddle's own damping."
        )
        return told

    def _same(self):
        one = self.rendered
        wall = f"A wall of {_short(one.K)} N/m" + (f" and {one.B:.3g} N s/m" if one.B > 5e-4 else "")
        if not one.same_up_to:
            return f"{wall} differs by more than {100 * STIFFNESS:.0f} % from the ideal at every frequency that was measured."
        return f"{wall} is rendered within {100 * STIFFNESS:.0f} % of the ideal up to {one.same_up_to:.3g} Hz."

    def __str__(self) -> str:
        return "\n".join([f"{self.name}, {self.date}, {self.on}, held by {self.held}", *(f"  {line}" for line in self.lines())])


def _short(value):
    """Three digits, without a power of ten."""
    return short(float(f"{value:.3g}"))
