"""Shared control: a hand follows a path, alone and with an automatic controller on the same handle; what each way costs."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ..analysis.records.energy import energy
from ..base.arguments import number
from ..base.drawing import house_style, new_figure, style_of
from ..base.shows_itself import ShowsItself, Tabular
from ..base.telemetry import Telemetry
from ..device.hand.intents import Tremor
from ..errors import PaddleError
from ..scene.notation.symbols import n, parameters, x
from ..scene.scene import Scene
from .paddle_needs import check_held
from .reaching import Anticipated, Load, check_path, handle, inverse_dynamics

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike

    from ..base.annotations import Array
    from ..device.simulated.simulated_paddle import SimulatedPaddle
    from .reaching import Path

#: what is in this band of a handle's motion is tremor [Hz]
BAND = (6.0, 14.0)


@dataclass(frozen=True, eq=False)
class Assisted(ShowsItself):
    """One hand on one path, with one scene.

    Attributes
    ----------
    scene : str
    error : float
        Root mean square of the handle's distance from the path, tremor's band left out [m].
    tremor : float
        Root mean square of the handle's motion within the band [m].
    peak_force : float
        Largest force of the controller [N].
    work : float
        Taken from the hand by the controller, on balance [J]; negative where the controller did the work.
    log : Telemetry
    """

    scene: str
    error: float
    tremor: float
    peak_force: float
    work: float
    log: Telemetry
    _hidden = ("log",)

    def __str__(self) -> str:
        return f"{self.scene}: error {1e3 * self.error:.4g} mm, tremor {1e3 * self.tremor:.4g} mm"


@dataclass(frozen=True, eq=False)
class Assistance(Tabular):
    """The same hand, tremor and path with several scenes; the first row is the hand alone."""

    rows: tuple[Assisted, ...]
    wanted: Array

    def _sentence(self):
        least = min(self.rows, key=lambda row: row.error)
        return f"{len(self.rows)} scenes with the same hand, tremor and path; the smallest error has {least.scene}"

    def __str__(self) -> str:
        lines = [f"{'':<24}{'error [mm]':>12}{'tremor [mm]':>13}{'peak force [N]':>16}{'work taken [mJ]':>17}"]
        for row in self.rows:
            lines.append(
                f"{row.scene:<24}{1e3 * row.error:>12.4g}{1e3 * row.tremor:>13.4g}{row.peak_force:>16.4g}{1e3 * row.work:>17.4g}"
            )
        return "\n".join(lines)

    def plot(self) -> Figure:
        """Draw where the handle was with each scene, against time; return the figure."""
        with house_style():
            figure = new_figure(height=3.4)
            axes = figure.subplots()
            axes.plot(self.rows[0].log.t, 1e3 * self.wanted, color="#8a8a8a", linewidth=4, alpha=0.5, label="meant")
            for number, row in enumerate(self.rows):
                axes.plot(row.log.t, 1e3 * handle(row.log), **style_of(number), label=row.scene)
            axes.set(xlabel="time [s]", ylabel="handle position x [mm]")
            axes.legend()
        return figure


def assistance(
    paddle: SimulatedPaddle,
    scenes: Scene | Iterable[Scene],
    path: Path,
    *,
    tremor: Callable[[Array], ArrayLike] | None = None,
    record: float = 4.0,
    band: tuple[float, float] = BAND,
    **options: Any,
) -> Assistance:
    """Let a hand follow a path without and with each scene, with the same intent, and measure.

    The intent is the one that would move hand and bare handle along the path
    (:func:`~hapticlab.experiments.reaching.follow`), with the tremor added: what the hand does is not adapted to what
    it feels.

    Parameters
    ----------
    paddle : SimulatedPaddle
        With a hand that has k > 0.
    scenes : sequence of Scene
        Such as ``hl.laws.tremor_filter()(B=20)``, ``hl.laws.guidance(path)(...)``, ``hl.library.virtual_fixture()``.
    path : object with ``at(t)``
        As ``hl.people.MinimumJerk``.
    tremor : callable, optional
        Of times [s], in metres; 0.3 mm root mean square within 8 to 12 Hz by default.
    record : float
        [s]; a whole number of periods of neither path nor tremor is needed.
    band : (low, high)
        [Hz], what counts as tremor.
    **options
        Of hapticlab.compile.

    Returns
    -------
    Assistance

    Examples
    --------
    >>> import hapticlab as hl
    >>> from hapticlab.experiments.shared_control import assistance
    >>> paddle = hl.SimulatedPaddle(m=0.03, b=0.1, T=1e-3, hand=hl.Hand("pinch"))
    >>> found = assistance(paddle, [hl.laws.tremor_filter()(B=10)], hl.people.MinimumJerk(end=0.02, duration=1.0, begin=1.0))
    >>> alone, filtered = found.rows
    >>> bool(filtered.tremor < 0.4 * alone.tremor), bool(filtered.error < 0.0003)
    (True, True)
    """
    hand = check_held(paddle, "assistance")
    check_path(path)
    scenes = (scenes,) if isinstance(scenes, Scene) else scenes
    if not (tremor is None or callable(tremor)):
        raise PaddleError(f"tremor = {tremor!r}; needs a path of times in metres, such as hl.people.Tremor(rms=3e-4).")
    low, high = (number("band", edge, "Hz", "a tremor", above=0, error=PaddleError) for edge in band)
    tremor = Tremor(rms=3e-4) if tremor is None else tremor
    times = np.arange(paddle.ticks(record) + 1) * paddle.T
    intent = Anticipated(times, inverse_dynamics(hand, Load(m=paddle.m, b=paddle.b), path, times)) + tremor
    here = replace(paddle, hand=replace(hand, intent=intent))
    wanted, rows = path.at(times[:-1])[0], list[Assisted]()
    for scene in (_alone(), *scenes):
        log = here.run(scene, duration=record, progress=False, **options)
        away = np.fft.rfft(handle(log) - wanted)
        f = np.fft.rfftfreq(len(wanted), log.T)
        shaking = np.fft.irfft(np.where((f >= low) & (f <= high), away, 0.0), len(wanted))
        slow = np.fft.irfft(np.where(f < low, away, 0.0), len(wanted))
        name = "hand alone" if not rows else log.scene
        rows.append(Assisted(name, _rms(slow), _rms(shaking), float(abs(log.F).max()), float(energy(log).W[-1]), log))
    return Assistance(tuple(rows), wanted)


def _alone():
    return Scene(force=parameters("k", units="N/m", values=0) * x(n), name="hand alone")


def _rms(values):
    return float(np.sqrt(np.mean(values**2)))
