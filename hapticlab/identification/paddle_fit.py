"""What was found out about a paddle, as a profile and as a paddle to simulate."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Literal

from ..base.telemetry import PaddleProfile
from ..device.simulated.simulated_paddle import SimulatedPaddle
from ..errors import AnalysisError
from .fit_result import Found


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
        T: float | None = None,
        force_max: float | None = None,
        rounding: Literal["floor", "nearest"] = "floor",
    ) -> PaddleProfile:
        """A PaddleProfile of what was found, marked as measured.

        Raises
        ------
        AnalysisError
            If the mass was not found: a spin-down alone tells ratios.
        """
        if "m" not in self.estimates:
            raise AnalysisError(
                "the mass was not found, because a spin-down determines only b/m and coulomb/m. Add a step or a chirp, or give m="
            )
        told: dict[str, Any] = {key: self[key].value for key in ("m", "b", "coulomb") if key in self.estimates}
        told |= {key: max(told[key], 0.0) for key in ("b", "coulomb") if key in told}
        return PaddleProfile(
            name, **{"b": 0.0, **told}, counts_per_metre=1 / self.quantum if self.quantum else None, rounding=rounding,
            force_max=force_max, T=T or self.T, nominal=False,
            source=f"identified from {len(self.measured)} samples, {self.confidence:.0%} intervals",
        )  # fmt: skip

    def paddle(self, **changes: Any) -> SimulatedPaddle:
        """A SimulatedPaddle with what was found."""
        delay = {"delay": max(self["delay"].value, 0.0)} if "delay" in self.estimates else {}
        return SimulatedPaddle.from_profile(self.profile(), **{**delay, **changes})
