"""What was found out about a paddle, as a profile and as a paddle to simulate."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, Literal

from ..base.profile.estimate import Estimate
from ..base.profile.paddle_profile import PaddleProfile
from ..base.statistics import student
from ..device.simulated.simulated_paddle import SimulatedPaddle
from ..errors import AnalysisError
from .fit_result import Found
from .twin import NO_MASS, bounded, exact, identify_twin

if TYPE_CHECKING:
    from ..base.annotations import File
    from ..device.board.serial_paddle import SerialPaddle

#: of two encoders that are the same: relative difference of their counts per metre, as a board keeps these in float32
SAME_ENCODER = 1e-6


@dataclass(frozen=True, eq=False)
class PaddleFit(Found):
    """Constants of a paddle found from records; ``found["m"]`` is an Estimate. Print it, or plot what it left."""

    about = "paddle"
    lacking = "a stop, a hand, backlash, friction that is not constant"
    advice = "a push, steps and a chirp (hl.identify.paddle does this), with forces of several sizes in both directions"
    above = ("m", "scale")
    bounded = ("m", "b", "coulomb", "scale", "b/m", "coulomb/m")
    constants: ClassVar = {
        "m": ("mass", "kg"), "b": ("viscous damping", "N s/m"), "coulomb": ("Coulomb friction", "N"), "delay": ("delay", "s"),
        "scale": ("force constant", "1"), "b/m": ("damping over mass", "1/s"), "coulomb/m": ("friction over mass", "m/s^2"),
    }  # fmt: skip

    def profile(
        self,
        name: str = "identified",
        *,
        base: PaddleProfile | SimulatedPaddle | SerialPaddle | File | None = None,
        T: float | None = None,
        force_max: float | None = None,
        rounding: Literal["floor", "nearest"] | None = None,
        date: str | None = None,
    ) -> PaddleProfile:
        """A PaddleProfile of what was found, each constant with its interval: :func:`identify_twin` of this fit alone.

        Raises
        ------
        AnalysisError
            If the mass was not found: a spin-down alone tells ratios.

        Examples
        --------
        >>> import hapticlab as hl
        >>> unknown = hl.SimulatedPaddle(m=0.03, b=0.1, T=1e-3, coulomb=0.05, noise=5e-6, force_max=2.0)
        >>> twin = hl.identify.paddle(unknown, kinds=("steps",)).profile("bench 7", base="hapkit")
        >>> hl.SimulatedPaddle.from_profile(twin).coulomb in twin["coulomb"]
        True
        """
        given = {"T": T, "force_max": force_max, "rounding": rounding}
        known = {key: value for key, value in given.items() if value is not None}
        return identify_twin(name, self, base=base, date=date, **known)

    def as_constants(self, base: PaddleProfile | None) -> list[Estimate]:
        """Return what was found as constants of a profile, the others of which come from ``base``."""
        if "b/m" in self.estimates or ("m" not in self.estimates and base is None):
            raise AnalysisError(NO_MASS)
        source = f"identified from {len(self.measured)} samples, {self.confidence:.0%} interval"
        source += "" if self.explained else ", too narrow: the fit does not explain the record"
        source += "" if self.converged else ", not converged"
        found = [bounded(name, self[name], source) for name in ("m", "b", "coulomb") if name in self.estimates]
        found += [exact("T", self.T, "period of the record"), *self._delays(source), *self._counting(base)]
        if self.dithered and self.explained:
            found.append(bounded("sensor_noise", self._noise(), source))
        if "scale" in self.estimates and base is not None and base.force_full:
            scale = self["scale"]
            value, low, high = (base.force_full * end for end in (scale.value, scale.low, scale.high))
            full = Estimate("force_full", value, low, high, "N")
            found.append(bounded("force_full", full, f"{source}, as a part of that of {base.name}"))
        return found

    def _delays(self, source):
        """The delay; nothing where it was not sought."""
        if "delay" not in self.estimates:
            return []
        return [bounded("delay", self["delay"], source), exact("sensor_delay", 0.0, "part of the delay")]

    def _counting(self, base):
        """The encoder of the record, where the base does not have it."""
        if not self.quantum:
            return []
        counts = 1 / self.quantum
        if base is None or base.counts_per_metre is None:
            return [exact("counts_per_metre", counts, "encoder of the record")]
        if abs(base.counts_per_metre / counts - 1) > SAME_ENCODER:
            raise AnalysisError(
                f"the fit was made with {counts:.6g} counts per metre, and {base.name} has {base.counts_per_metre:.6g}. Give the "
                "profile of the same encoder as base=, or counts_per_metre= to the identification"
            )
        return []

    def _noise(self):
        """The deviation of the noise with its interval: relatively 1/sqrt(2 N), and more where positions are counted."""
        counting = 1 + self.quantum**2 / (12 * self.sigma**2) if self.counted else 1.0
        samples = len(self.measured)
        half = student(self.confidence, samples) * self.sigma * counting / (2 * samples) ** 0.5
        return Estimate("sensor_noise", self.sigma, self.sigma - half, self.sigma + half, "m")

    def paddle(self, **changes: Any) -> SimulatedPaddle:
        """A SimulatedPaddle with what was found."""
        delay = {"delay": max(self["delay"].value, 0.0)} if "delay" in self.estimates else {}
        return SimulatedPaddle.from_profile(self.profile(), **{**delay, **changes})
