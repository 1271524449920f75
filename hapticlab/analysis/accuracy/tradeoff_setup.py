"""What all settings of a trade-off are tried on: a scene, a paddle, and the force that it would give without samples."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ...device.device import total_delay
from ...errors import AnalysisError
from ...scene.notation.symbols import delay, lag_of, v, x
from ..stability.operating_points import TRAVEL
from ..stability.trial_limits import Limits
from .tradeoff_rows import percent

if TYPE_CHECKING:
    from ...base.profile.paddle_profile import PaddleProfile
    from ...device.simulated.simulated_paddle import SimulatedPaddle
    from ...scene.scene import Scene
    from .reference import Reference


@dataclass(frozen=True, eq=False)
class Bench:
    """What all settings of a scene are tried on.

    Attributes
    ----------
    scene, paddle
    runs : tuple of Reference
        Each with its motion.
    boards : tuple of str
    every, velocity, live
        As of :func:`~hapticlab.analysis.accuracy.tradeoff.tradeoff`.
    """

    scene: Scene
    paddle: SimulatedPaddle | PaddleProfile
    runs: tuple[Reference, ...]
    boards: tuple[str, ...]
    every: int
    velocity: str
    live: Any = ()

    def __post_init__(self) -> None:
        if not self.peak > 0:
            motions = ", ".join(known.motion.name for known in self.runs)
            raise AnalysisError(
                f"{self.scene.name}: during {motions} the force is 0 N throughout or is not finite, so there is nothing to "
                "compare. Give motions=[HandleMotion(...)] that move the handle to where the force acts"
            )

    @functools.cached_property
    def peak(self) -> float:
        """Greatest force of the reference [N]."""
        return max(known.peak for known in self.runs)

    @property
    def doubt(self) -> float:
        """By which part of the greatest force the solvers of the reference differ."""
        return max(known.agreement for known in self.runs) / self.peak

    @property
    def certainty(self) -> str:
        """How far the solvers of the reference agree, in words."""
        if not np.isfinite(self.doubt):
            return "a motion has only one solver, so no error is certain"
        return f"the solvers of its reference differ by {percent(self.doubt)} of it"

    @property
    def chaotic(self) -> float | None:
        """From when on rounding decides the motion [s]; None where it does not."""
        return min((known.horizon for known in self.runs if known.chaotic), default=None)

    @property
    def faulted(self) -> float | None:
        """From when on the force of the reference is no number [s]; None where it always is one."""
        return min((known.horizon for known in self.runs if known.faulted), default=None)

    @property
    def delay(self) -> float:
        """After which the paddle's force is felt [s]."""
        return float(getattr(self.paddle, "delay", 0.0))

    @property
    def notes(self) -> list[str]:
        """What is to be known of the whole, in sentences."""
        told, most = [], getattr(self.paddle, "force_max", None)
        if most and self.peak > most:
            told += [
                f"the paddle gives at most {most:.3g} N; a larger force is not felt, and the errors here do not account for that"
            ]
        if any(_lagged(expr) for expr in _equations(self.scene)):
            told += [
                "the reference uses present values for past samples and delayed forces, so their lateness counts as an error"
            ]
        return told

    @functools.cached_property
    def limits(self) -> Limits:
        """Of stability and passivity, for all settings: over a paddle's travel, or further where the motions go further."""
        reach = max(float(np.abs(known.motion.at(known.t)[0]).max()) for known in self.runs)
        return Limits(self.scene, max(reach, TRAVEL), float(total_delay(self.paddle)))

    @functools.cached_property
    def same(self):
        """Pairs of holds that were found to compile to the same instructions."""
        return set()

    def options(self, setting):
        """Return the options of :func:`hapticlab.compile` of a setting or a row."""
        made = {name: getattr(setting, name) for name in ("method", "T", "substeps", "hold", "force_at")}
        return made | {"dtype": setting.precision, "velocity": self.velocity, "live": self.live}

    @functools.lru_cache(maxsize=8)  # noqa: B019  it lives as long as its worker
    def samples(self, T):
        """Return the samples x, v of each motion, arrays of shape (ticks, 2)."""
        counts = [round(known.horizon / T) for known in self.runs]
        return [np.stack(known.motion.at(T * np.arange(n))[:2], 1) for n, known in zip(counts, self.runs, strict=True)]


def _equations(scene):
    form = scene.explicit()
    return [form.force, *form.f, *form.updates.values()]


def _lagged(expr):
    """Tell whether an expression takes samples of before, or a delayed force."""
    return expr.has(delay) or any(lag_of(sample) for sample in expr.atoms(x, v))
