"""Identify a paddle by moving it: from small forces up, within a stated travel, on a simulated paddle or a board."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

import numpy as np

from ..base.arguments import having, number
from ..base.profile.estimate import Estimate
from ..device.board.serial_paddle import SerialPaddle
from ..errors import AnalysisError, PaddleError
from .handle_records import MOVED, HandleRecord, identify
from .identifying_forces import LEAD, Excitation, centring, designed
from .paddle_fit import PaddleFit
from .twin import bounded, exact

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from ..device.simulated.simulated_paddle import SimulatedPaddle

#: of the largest force: where the search begins, and by what it grows until the handle moves
FIRST, GROWS = 1 / 64, 2**0.5
#: parts of the travel that a handle moves, at least, for its constants to be known roughly; steps' lengths [s] of the search
FOUND, PILOT = 0.05, 0.02
#: times the counts that tell anything, which the handle moves by
ENOUGH = 1.1
#: N and m, where neither paddle nor caller says
FORCE, TRAVEL = 1.0, 0.02
#: s that a handle is led back for, and damping over stiffness of what leads it [s]
BACK_TIME, BACK_DAMPING = 0.8, 0.03


@dataclass(frozen=True, eq=False)
class Identified(PaddleFit):
    """A :class:`PaddleFit` with the records it was made from.

    Attributes
    ----------
    records : tuple of HandleRecord
    """

    records: tuple[HandleRecord, ...] = ()

    @property
    def sensor_delay(self) -> Estimate:
        """The lag of the sensor [s]: the part of the delay that the computation did not take, where the motor follows at once.

        Raises
        ------
        AnalysisError
            If the delay was not estimated.
        """
        found, own = self["delay"], float(np.mean([record.log.delay for record in self.records]))
        return Estimate("sensor_delay", found.value - own, found.low - own, found.high - own, "s")

    def _delays(self, source):
        """The time that the computation took, and the lag of the sensor: the rest."""
        if "delay" not in self.estimates:
            return []
        own = float(np.mean([record.log.delay for record in self.records]))
        return [exact("delay", own, "computation, as the records say"), bounded("sensor_delay", self.sensor_delay, source)]

    def loaded(self, mass: float) -> tuple[HandleRecord, ...]:
        """The records as those of a handle with a known mass [kg] fixed to it; see :func:`identify`."""
        return tuple(replace(record, added=mass) for record in self.records)


def identify_paddle(
    paddle: SimulatedPaddle | SerialPaddle,
    *,
    force: float | None = None,
    travel: float | None = None,
    kinds: Iterable[Literal["kick", "steps", "chirp"]] = ("kick", "steps", "chirp"),
    added: float = 0.0,
    beside: Sequence[HandleRecord] = (),
    confidence: float = 0.95,
) -> Identified:
    """Move a free handle and return its mass, damping, Coulomb friction and delay, with confidence intervals.

    Nobody holds the handle. Forces grow from 1/64 of ``force`` until it moves; what that tells sizes a kick, steps and a
    chirp that fill 60 % of the travel. Past the travel the motor gives nothing; a fault of a board ends everything with
    the motor off.

    Parameters
    ----------
    paddle : SimulatedPaddle or SerialPaddle
    force : float, optional
        The largest force [N]; by default what the paddle stands for long, or 1 N.
    travel : float, optional
        How far the handle may move from its place, either way [m]; by default 80 % of a board's way to its nearer stop,
        or 20 mm.
    kinds : sequence of {"kick", "steps", "chirp"}
    added : float
        A known mass fixed to the handle [kg]; the constants found are those without it.
    beside : sequence of HandleRecord, optional
        Records of the same paddle, without the mass: the ``records`` of an earlier call. With ``added`` they tell the
        force constant, too.
    confidence : float

    Returns
    -------
    Identified

    Raises
    ------
    AnalysisError, PaddleError

    Examples
    --------
    >>> import hapticlab as hl
    >>> paddle = hl.SimulatedPaddle(m=0.03, b=0.1, T=1e-3, coulomb=0.05, noise=5e-6, force_max=2.0)
    >>> found = hl.identify.paddle(paddle, kinds=("steps",))
    >>> 0.03 in found["m"], 0.1 in found["b"], 0.05 in found["coulomb"], 0.0 in found["delay"]
    (True, True, True, True)
    """
    if beside and not added:
        raise AnalysisError(
            "beside= without added=: records with and without a known mass determine the force constant. Give added="
        )
    having(paddle, "a paddle, as hl.SimulatedPaddle.from_profile(...) or hl.connect()", "run", error=PaddleError)
    force, travel = _limits(paddle, force, travel)
    added = number("added", added, "kg", "an identification", least=0, error=PaddleError)
    pilot, size = _pilot(paddle, force, travel)
    per_metre = counts_per_metre_of(paddle)
    rough = identify(pilot, counts_per_metre=per_metre)
    constants = {name: max(rough[name].value, 1e-4 if name == "m" else 0.0) for name in ("m", "b", "coulomb", "delay")}
    size = min(force, max(size, 4 * constants["coulomb"]))
    # friction holds a handle that was led back; without it, it may still drift
    rests = _rests(paddle) or rough["coulomb"].low > 0
    records = []
    for nth, kind in enumerate(kinds, 1):
        excited = designed(kind, size, paddle.T, travel, constants)
        records.append(HandleRecord(_run(paddle, excited, force, travel, nth), added=added, at_rest=rests))
    together = (*records, *beside)
    found = identify(*together, counts_per_metre=per_metre, force_constant=bool(beside), confidence=confidence, near=rough)
    return Identified(**vars(found), records=tuple(records))


def _limits(paddle, force, travel):
    """The largest force [N] and travel [m]."""
    settings = getattr(paddle, "settings", None)
    if isinstance(paddle, SerialPaddle) and settings is None:
        raise PaddleError("the board has no calibration, so its travel and force are not known. Run `hapticlab calibrate` first.")
    if settings is not None:
        usual = min(settings.force_continuous, settings.force_max), 0.8 * min(-settings.travel_min, settings.travel_max)
    else:
        usual = paddle.force_max or FORCE, TRAVEL
    force = number("force", usual[0] if force is None else force, "N", "an identification", above=0, error=PaddleError)
    return force, number("travel", usual[1] if travel is None else travel, "m", "an identification", above=0, error=PaddleError)


def counts_per_metre_of(paddle):
    """The encoder counts per metre of a board or of a simulated paddle, None without an encoder."""
    return 1 / paddle.settings.metres_per_count if isinstance(paddle, SerialPaddle) else paddle.counts_per_metre


def _rests(paddle):
    """Whether a run begins at rest whatever the handle is: a simulated one does."""
    return not isinstance(paddle, SerialPaddle)


def _pilot(paddle, force, travel):
    """A record of the first force that moves the handle by FOUND of the travel, and enough counts; and that force [N]."""
    length, size = max(4, round(PILOT / paddle.T)), force * FIRST
    least = max(FOUND * travel, ENOUGH * MOVED / abs(counts_per_metre_of(paddle) or np.inf))
    if least > travel:
        raise AnalysisError(
            f"hl.identify.paddle: travel = {1e3 * travel:.3g} mm; this encoder needs {1e3 * least:.3g} mm, because fewer than "
            f"{MOVED} counts determine nothing. Give a larger travel="
        )
    while True:
        steps = Excitation("steps", size, length, 2 * LEAD + 8 * length)
        log = _run(paddle, steps, force, travel)
        if np.ptp(log.x) >= least:
            return HandleRecord(log, at_rest=_rests(paddle)), size
        if size >= force:
            raise AnalysisError(
                f"hl.identify.paddle: {force:.3g} N moves the handle by {1e3 * np.ptp(log.x):.2g} mm only; needs "
                f"{1e3 * least:.2g} mm. Check the motor's supply, make sure that nobody holds the handle, or give "
                "a larger force="
            )
        size = min(size * GROWS, force)


def _run(paddle, excited, force, travel, number=0):
    """Run an excitation and return its record, with the forces that the motor gave; ``number`` draws noise of its own."""
    scene, duration = excited.scene(travel), excited.samples * paddle.T
    if not isinstance(paddle, SerialPaddle):
        return replace(paddle, seed=paddle.seed + number).run(scene, duration=duration, progress=False)
    back = centring(force / travel, BACK_DAMPING * force / travel)
    after(paddle.run(back, duration=BACK_TIME, force_max=force, progress=False), "hl.identify.paddle")
    log = after(paddle.run(scene, duration=duration, every=1, force_max=force, progress=False), "hl.identify.paddle")
    return replace(log, F=given(paddle, log.F))


def after(log, asked):
    """Return the record of a run on a board that ``asked`` made, or raise what stopped it."""
    if log.fault:
        raise PaddleError(f"{asked} stopped: {log.fault}")
    return log


def given(paddle, F):
    """The forces [N] that a board's motor gave for those it was asked for: its duty has steps."""
    settings, steps = paddle.settings, paddle.board["duty_full"]
    return np.array([settings.force_of_duty(settings.duty(force, steps)) for force in F])
