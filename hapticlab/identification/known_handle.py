"""What is known of the handle that a hand holds, and how far an estimate of the hand is off where that is uncertain."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from math import hypot
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.profile.paddle_profile import PaddleProfile
from ..base.statistics import student
from ..base.telemetry import Telemetry
from ..device.device import total_delay
from ..device.profiles import profile as named_profile
from ..errors import AnalysisError
from .scoring import linearised

if TYPE_CHECKING:
    from collections.abc import Callable

    from ..base.annotations import Array
    from .scoring import Fitted

_CURE = "Give device=, such as a twin of hl.identify.twin, its file, a PaddleProfile, or found.profile() of hl.identify.paddle"


@dataclass(frozen=True)
class KnownHandle:
    """Constants of a handle without a hand [kg], [N s/m], [N], [s].

    Attributes
    ----------
    delay : float
        From where the handle is to the force that follows from it.
    half_widths : dict of str to float
        Half the interval of each constant that was measured.
    """

    m: float
    b: float
    coulomb: float
    delay: float
    half_widths: dict[str, float] = field(default_factory=dict)

    @classmethod
    def of(cls, device: Any, record: Telemetry) -> KnownHandle:
        """Return what is known of the handle of a record.

        A profile says it of the paddle that it was identified on. Where its delay was not identified, the record says how
        long the computation took, which a board measures. Nothing else is read from the record of a simulated paddle.
        """
        device = named_profile(device) if isinstance(device, str | PathLike) else getattr(device, "settings", device)
        m, b, coulomb = (float(getattr(device, name, None) or 0.0) for name in ("m", "b", "coulomb"))
        if isinstance(device, Telemetry) or not m:
            raise AnalysisError(f"hl.identify.hand: the paddle is not known. {_CURE}")
        if not isinstance(device, PaddleProfile):
            return cls(m, b, coulomb, float(total_delay(device if hasattr(device, "delay") else record)))
        half = {one.name: max(one.high - one.value, one.value - one.low) for one in device.estimates}
        computed = device.delay if "delay" in half else record.delay
        half["delay"] = hypot(half.get("delay", 0.0), half.pop("sensor_delay", 0.0))
        known = {name: width for name, width in half.items() if name in ("m", "b", "coulomb", "delay") and width > 0}
        return cls(m, b, coulomb, float(computed + device.sensor_delay), known)

    def off(self, name: str) -> KnownHandle:
        """Return the handle with one constant at the upper end of its interval."""
        return replace(self, **{name: getattr(self, name) + self.half_widths[name]})


def widened(
    fitted: Fitted, y: Array, motion: Callable[[KnownHandle], Callable], scales: Array, handle: KnownHandle, confidence: float
) -> Fitted:
    """Return a fit of one record whose intervals also contain what is not known of the handle.

    Each constant of the handle that is off by half its interval would shift the estimate. The shifts, found by linear least
    squares, are regarded as independent of each other and of the noise.
    """
    if not handle.half_widths:
        return fitted
    at, covariance, t = fitted.values, fitted.covariance.copy(), float(student(confidence, fitted.freedom)[0])
    rest, slopes = linearised(motion(handle), y, at, scales)
    for name in handle.half_widths:
        moved = rest - (y - motion(handle.off(name))(at[:, None])[:, 0])
        shift = np.linalg.lstsq(slopes[:, :, 0], -moved[:, 0], rcond=None)[0] * scales[:, 0]
        covariance[0] += np.outer(shift, shift) / t**2
    return replace(fitted, covariance=covariance)
