"""A measured impedance: force over velocity at the handle, beside the law's own and the ideal."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from ..base.grid import Grid
from ..base.shows_itself import Tabular
from ..errors import AnalysisError
from .impedance_plot import plot_impedance
from .spectrum import Response

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from ..base.annotations import Array

#: part of an impedance by which blocks may differ without a word
UNSURE = 0.02
Drive = Literal["hand", "motor"]


@dataclass(frozen=True, eq=False)
class MeasuredImpedance(Tabular):
    """Impedances Z = F/v at the handle [N s/m], complex, one a frequency.

    Attributes
    ----------
    frequency : array, shape (L,)
        [Hz]
    measured : Response
        Of the environment: the scene's force as held and delayed, over the handle's velocity, at its samples.
    law : array
        The same from the scene's own H(e^jwT), linearised at the place, held and delayed.
    ideal : array or None
        What the scene stands for, without sampling.
    other : Response
        What drove feels: the simulated hand F_h/v, device included; the motor its mechanics, device and hand.
    drive : {"hand", "motor"}
    device : array or None
        m s + b of a simulated paddle.
    left_wall : int
        Samples without force: the motion left the wall, and no linear impedance describes it.
    distortion : float
        Force at lines that nothing excites, over the force at those that are; rms. nan for a chirp.
    about : str
        What drove, and what was not observable.
    """

    frequency: Array
    measured: Response
    law: NDArray[np.complex128]
    ideal: NDArray[np.complex128] | None
    other: Response
    drive: Drive
    device: NDArray[np.complex128] | None
    left_wall: int
    distortion: float
    about: str

    @property
    def rendered(self) -> NDArray[np.complex128]:
        """Z = F/v of the environment as rendered [N s/m]."""
        return self.measured.value

    @property
    def radius(self) -> Array:
        """Radius of the circle around ``rendered`` that holds the truth with 95 % confidence [N s/m]."""
        return self.measured.radius

    @property
    def coherence(self) -> Array:
        """Coherence of motion and force over the blocks."""
        return self.measured.coherence

    @property
    def handle(self) -> NDArray[np.complex128]:
        """Impedance that a simulated hand feels where it drives [N s/m], device included, as by a force sensor between them."""
        if self.drive != "hand":
            raise AnalysisError(
                "the motor was the excitation, and a paddle has no force sensor, so the impedance that the "
                "hand feels was not observed"
            )
        return self.other.value

    @property
    def felt(self) -> NDArray[np.complex128]:
        """Impedance that the hand feels beyond the device's own m s + b [N s/m]: the rendered one, measured another way."""
        assert self.device is not None  # a hand drives in simulation alone, where the device is known
        return self.handle - self.device

    @property
    def mechanics(self) -> NDArray[np.complex128]:
        """Impedance of device and hand together, where the motor drives [N s/m]; true if its force is the computed one."""
        if self.drive != "motor":
            raise AnalysisError("the hand was the excitation. To measure the mechanics that the motor moves, give drive='motor'")
        return self.other.value

    @property
    def transparency(self) -> NDArray[np.complex128]:
        """Rendered over ideal impedance, 1 where the environment is rendered as it is meant."""
        return self.rendered / self._meant()

    @property
    def transparency_at_handle(self) -> NDArray[np.complex128]:
        """Impedance that the hand feels over the ideal one: the device's own mass and damping count too."""
        return self.handle / self._meant()

    def _meant(self):
        if self.ideal is None:
            raise AnalysisError("the ideal impedance is not known. Give it: hl.measure.impedance(..., ideal=lambda s: k/s + b)")
        return self.ideal

    @property
    def stiffness(self) -> Array:
        """Real part of s Z, rendered [N/m]."""
        return (2j * np.pi * self.frequency * self.rendered).real

    @property
    def damping(self) -> Array:
        """Real part of Z, rendered [N s/m]: below zero the environment gives energy at that frequency."""
        return self.rendered.real

    def plot(self) -> Figure:
        """Draw magnitude, and real part: measured, the law's own, the ideal."""
        return plot_impedance(self)

    _hidden = ("measured", "other")

    def _sentence(self):
        span = f"{self.frequency[0]:.4g} to {self.frequency[-1]:.4g} Hz"
        return f"impedance at {len(self.frequency)} frequencies, {span}: {self.about}"

    def _tables(self):
        Z, law = self.rendered, np.abs(self.rendered / self.law)
        part = {} if self.ideal is None else {"|Z/ideal|": np.abs(self.transparency)}
        columns = {"f": self.frequency, "|Z|": np.abs(Z), "+-": self.radius, "Re Z": Z.real, "|Z/law|": law, **part}
        yield "", Grid(columns | {"coherence": self.coherence}, {"f": "Hz", "|Z|": "N s/m", "+-": "N s/m", "Re Z": "N s/m"})

    def __str__(self) -> str:
        """Print a table: rendered, and what the driver feels, each with its 95 % circle."""
        driver = "hand" if self.drive == "hand" else "motor"
        head = f"{'f [Hz]':>8} {'|Z| [N s/m]':>12} {'+-':>8} {'Re Z':>9} {'|Z/law|':>8} {'|Z/ideal|':>10} {'angle':>8} "
        head += f"{'coherence':>9} {f'|Z {driver}|':>9} {'+-':>8}"
        rows = []
        for k, f in enumerate(self.frequency):
            Z, part = self.rendered[k], self.transparency[k] if self.ideal is not None else np.nan
            rows.append(
                f"{f:8.4g} {abs(Z):12.5g} {self.radius[k]:8.2g} {Z.real:9.4g} {abs(Z / self.law[k]):8.5f} {abs(part):10.5f} "
                f"{np.angle(part, deg=True):7.2f}\N{DEGREE SIGN} {self.coherence[k]:9.5f} "
                f"{abs(self.other.value[k]):9.4g} {self.other.radius[k]:8.2g}"
            )
        return "\n".join([self.about, *self._warnings(), head, *rows])

    def _warnings(self):
        left, unsure = self.left_wall, np.nanmax(self.other.radius / abs(self.other.value), initial=0.0)
        lines = [f"the handle left the wall in {left} samples; press deeper or use a smaller excitation"] if left else []
        if unsure > UNSURE:
            lines.append(
                f"blocks differ, |Z {self.drive}| by up to {100 * unsure:.0f} %, because of noise or because the motion had "
                "not settled: give a longer Averaging(settle=...)"
            )
        return lines

    def __repr__(self) -> str:
        span = f"{self.frequency[0]:.4g} to {self.frequency[-1]:.4g} Hz"
        return f"MeasuredImpedance({len(self.frequency)} frequencies, {span})"
