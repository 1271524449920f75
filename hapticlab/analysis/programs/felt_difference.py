"""Whether a hand notices what was left out of a scene: the same motion through both, their difference beside thresholds."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.arguments import having
from ...base.shows_itself import ShowsItself
from ...base.telemetry import Telemetry, check_record
from ...compiler.boards.cost import Cost, cost
from ...compiler.engines.evaluate import evaluate
from ...compiler.tick.compile_scene import compile
from ...device.device import known
from ...errors import AnalysisError
from ...scene.notation.written import no_scene
from ...scene.scene import Scene
from .felt_difference_plot import plot_difference
from .thresholds import Thresholds

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.figure import Figure

    from ...base.annotations import Array
    from ...device.device import AnyDevice


@dataclass(frozen=True, eq=False)
class FeltDifference(ShowsItself):
    """Two scenes over one motion of the handle, and their difference beside what a hand notices.

    Attributes
    ----------
    t : array, shape (N,)
        [s]
    full, smaller : array, shape (N,)
        Force of each scene [N], as the board computes it from what the encoder shows.
    own : array, shape (N,)
        Force that the paddle itself takes to move: m a + b v and friction [N]; the hand feels it together with the scene's.
    force : array, shape (W,)
        In each window, the rms difference over the least that is noticed: ``weber`` times the rms of full + own, or ``force``.
    vibration : array, shape (W,)
        In each window, the amplitude of the difference above ``slowest``, over the least that is noticed as a vibration.
    own_vibration : array, shape (W,)
        The same of what the encoder's counts put into the full scene's force. A weaker vibration is hidden by it.
    thresholds : Thresholds
    cost : tuple of Cost
        Of the full and the smaller scene on the board, with every parameter fixed.
    """

    t: Array = field(repr=False)
    full: Array = field(repr=False)
    smaller: Array = field(repr=False)
    own: Array = field(repr=False)
    force: Array = field(repr=False)
    vibration: Array = field(repr=False)
    own_vibration: Array = field(repr=False)
    thresholds: Thresholds
    cost: tuple[Cost, Cost] = field(repr=False)

    @property
    def same_bits(self) -> bool:
        """Whether both forces are the same number at every sample."""
        return bool(np.array_equal(self.full, self.smaller))

    @property
    def noticed(self) -> bool:
        """Whether a hand with these thresholds notices the difference anywhere in this motion, on this paddle."""
        return self.ratio > 1

    @property
    def ratio(self) -> float:
        """The largest part of a threshold that is reached; above 1 the difference is noticed."""
        return float(max(self.force.max(), self._shown.max()))

    @property
    def hidden(self) -> bool:
        """Whether the difference is not noticed only because the encoder's counts shake the handle more."""
        return not self.noticed and bool(self.vibration.max() > 1)

    @property
    def cycles(self) -> tuple[int, int]:
        """Typical cycles of one tick of the full and of the smaller scene."""
        return self.cost[0].typical, self.cost[1].typical

    @property
    def _shown(self):
        """The vibration over its threshold, and over the encoder's own where that is larger."""
        return self.vibration / np.maximum(1.0, self.own_vibration)

    def plot(self) -> Figure:
        """Draw both forces, and how much of each threshold is reached; return a figure."""
        return plot_difference(self)

    def __str__(self) -> str:
        if self.same_bits:
            return "not noticed: the same bits at every sample"
        word = "noticed" if self.noticed else "hidden by the encoder" if self.hidden else "not noticed"
        at = int((self._shown if self.noticed else self.vibration).argmax())  # both in one window, or they could not be compared
        return (
            f"{word}: {self.force.max():.2g} of the force threshold, {self.vibration[at]:.2g} of the vibration threshold "
            f"(the encoder alone: {self.own_vibration[at]:.2g})"
        )


def felt_difference(
    full: Scene,
    smaller: Scene,
    motion: Telemetry | Sequence[float] | Array,
    paddle: AnyDevice,
    *,
    thresholds: Thresholds | None = None,
    board: str = "uno",
    **options: Any,
) -> FeltDifference:
    """Replay one motion of the handle through a scene and through a smaller one, and say whether a hand notices.

    The handle moves as it is told in both, so that nothing but the scenes differs. A hand that moves freely may in addition
    notice that it was led elsewhere: feel both.

    Parameters
    ----------
    full, smaller : Scene
        Every parameter bound.
    motion : Telemetry or array
        A recording, whose x (``x_true`` of a simulated paddle) is replayed at its own T, with the parameters of the scenes and
        not of the record; or positions [m], one per period of the paddle.
    paddle : SimulatedPaddle, PaddleProfile or Device
        Its m, b, friction and encoder, and its hand if it has one, are what hides a difference.
    thresholds : Thresholds, optional
    board : str
        Where the scenes are priced, "uno" or "pico".
    **options
        Of :func:`hapticlab.compile`: method, substeps, hold.

    Returns
    -------
    FeltDifference

    Raises
    ------
    AnalysisError
        For what is no scene or no thresholds, a record too short for one window, or a paddle whose mass, damping or period
        is not known.

    Examples
    --------
    >>> import hapticlab as hl, numpy as np
    >>> soft, softer = hl.wall()(k=200, x_o=0), hl.wall()(k=190, x_o=0)
    >>> x = 0.01 * np.sin(2 * np.pi * np.arange(1000) * 1e-3)
    >>> found = felt_difference(soft, softer, x, hl.Device(m=0.05, b=0.1, T=1e-3))
    >>> found.noticed, round(float(found.force.max()), 2)       # 5 %, of which a hand needs 7 %
    (False, 0.73)
    """
    for scene in (full, smaller):
        if not isinstance(scene, Scene):
            raise AnalysisError(no_scene(scene, "needs two scenes, felt_difference(full, smaller, motion, paddle)"))
    chosen = Thresholds() if thresholds is None else thresholds
    having(chosen, "thresholds, such as hl.people.Thresholds(weber=0.1)", "window")
    true, seen, T = _motion(motion, paddle, chosen)
    rows = round(chosen.window / T)
    if len(true) < rows:
        raise AnalysisError(f"a motion of {len(true) * T:g} s; needs at least one window of {chosen.window:g} s")
    programs = [compile(scene, T=T, live=(), **options) for scene in (full, smaller)]
    F, F_smaller = (evaluate(program, x=seen).F for program in programs)
    m, b, coulomb, hand = known(paddle, "m", "b", or_none="coulomb hand")
    own = _own(true, T, m, b, coulomb or 0.0)
    held = (m, b, 0.0) if hand is None else (m + hand.m, b + hand.b, hand.k)
    force = _rms(F_smaller - F, rows) / np.maximum(chosen.force, chosen.weber * _rms(F + own, rows))
    counted = F - evaluate(programs[0], x=true).F
    shaken, own_shaken = (np.sqrt(2) * _rms(_in_thresholds(d, T, chosen, held), rows) for d in (F_smaller - F, counted))
    prices = cost(programs[0], board), cost(programs[1], board)
    return FeltDifference(T * np.arange(len(F)), F, F_smaller, own, force, shaken, own_shaken, chosen, prices)


def _motion(motion, paddle, thresholds):
    """The motion itself, what the encoder shows of it, and the period."""
    (counts,) = known(paddle, or_none="counts_per_metre")
    if not isinstance(motion, Telemetry):
        true, (T,) = _positions(motion), known(paddle, "T")
        return true, _counted(true, counts, getattr(paddle, "rounding", "floor")), T
    check_record(motion, "felt_difference")
    if "x_true" in motion.channels or counts is None:
        return motion.channels.get("x_true", motion.x), motion.x, motion.T
    return _below(motion.x, motion.T, thresholds.slowest), motion.x, motion.T  # the slow part of what a real encoder showed


def _positions(given):
    array = np.asarray(given)
    if array.dtype.kind not in "iuf" or array.ndim != 1 or not np.isfinite(array).all():
        raise AnalysisError(
            f"the motion has shape {array.shape}; needs a record, or one finite position [m] per sample, x=[0, 0.001, 0.002]"
        )
    return array.astype(float)


def _counted(x, counts, rounding):
    return x if counts is None else np.floor(x * counts + (0.5 if rounding == "nearest" else 0.0)) / counts


def _own(x, T, m, b, coulomb):
    v = np.gradient(x, T)
    return m * np.gradient(v, T) + b * v + coulomb * np.sign(np.where(np.abs(v) > 1e-4, v, 0.0))


def _rms(values, rows):
    whole = values[: len(values) // rows * rows]
    return np.sqrt(np.mean(whole.reshape(-1, rows) ** 2, axis=1))


def _filtered(values, T, gain):
    """The values, each frequency times a gain; mirrored at the end, so that no step is made there."""
    both = np.concatenate([values, values[::-1]])
    spectrum = np.fft.rfft(both)
    frequency = np.fft.rfftfreq(len(both), T)
    return np.fft.irfft(spectrum * gain(frequency), len(both))[: len(values)]


def _below(values, T, highest):
    return _filtered(values, T, lambda frequency: frequency < highest)


def _in_thresholds(force, T, thresholds, held):
    """A force's vibration, each frequency over the least amplitude that is noticed."""
    m, b, k = held

    def gain(frequency):
        quick = frequency >= thresholds.slowest
        least = thresholds.shaking_force(np.where(quick, frequency, thresholds.slowest), m=m, b=b, k=k)
        return np.where(quick, 1 / least, 0.0)

    return _filtered(force, T, gain)
