"""The dead band and the curve of a motor, from duties and the forces that a scale showed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..base.drawing import FRAME, STYLES, house_style, new_figure
from ..base.grid import Grid
from ..base.profile.estimate import Estimate
from ..base.statistics import student
from ..errors import AnalysisError
from .fit_result import Estimated
from .twin import bounded

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike

    from ..base.annotations import Array
    from ..base.profile.paddle_profile import PaddleProfile

#: what is found, and its unit
NAMES = {"force_full": "N", "duty_dead": "1", "duty_25": "1", "duty_50": "1", "duty_75": "1", "offset": "N"}
PARTS = np.array([0.0, 0.25, 0.5, 0.75, 1.0])
#: readings, and the duty that the largest of them reaches, at least
LEAST_READINGS, LEAST_DUTY = 9, 0.8
#: a duty is known where its interval is narrower than this to either side; a fit is poor beyond this part of the forces
VAGUE, POOR = 0.1, 0.05


@dataclass(frozen=True, eq=False)
class MotorCurve(Estimated):
    """What a motor gives for a duty; ``found["duty_dead"]`` is an Estimate. Print it, or plot what it was found from.

    Attributes
    ----------
    estimates : dict of str to Estimate
        force_full [N], at full duty; duty_dead, below which there is no force; duty_25, duty_50, duty_75, at a quarter, half
        and three quarters of force_full; offset [N], what the scale showed without a force.
    confidence, rms : float
        Of the intervals, and of the residuals [N].
    duties, forces : array, shape (N,)
    """

    estimates: dict[str, Estimate]
    confidence: float
    rms: float
    duties: Array
    forces: Array

    def force(self, duties: ArrayLike) -> Array:
        """Return the force [N] at duties 0 ... 1, without the offset.

        Parameters
        ----------
        duties : array_like
            Duties, 0 ... 1.
        """
        return _curve([self[name].value for name in NAMES if name != "offset"], np.asarray(duties, float))

    def values(self) -> dict[str, float]:
        """Return force_full and the duties by name, as a PaddleProfile, a SimulatedPaddle and a board's settings take them."""
        return {name: self[name].value for name in NAMES if name != "offset"}

    def as_constants(self, base: PaddleProfile | None) -> list[Estimate]:
        """Return what was found as constants of a profile.

        Parameters
        ----------
        base : PaddleProfile or None
            Not read: what a scale found needs no other constant.
        """
        source = f"identified from {len(self.duties)} readings of a scale, {self.confidence:.0%} interval"
        return [bounded(name, self[name], source) for name in NAMES if name != "offset"]

    def _tables(self):
        yield "", Grid.of(self.estimates, "value", "low", "high", "unit")

    def __str__(self) -> str:
        lines = [f"motor identified from {len(self.duties)} readings, {self.confidence:.0%} confidence:"]
        lines += [f"  {found}" for found in self.estimates.values()]
        return "\n".join([*lines, f"  residual {1e3 * self.rms:.3g} mN rms"])

    def plot(self) -> Figure:
        """A figure: the readings, and the curve through them."""
        duties = np.linspace(0, 1, 201)
        with house_style():
            figure = new_figure(height=3.2)
            axes = figure.subplots()
            axes.plot(self.duties, self.forces - self["offset"].value, "o", color="#000000", markersize=4, label="measured")
            axes.plot(duties, self.force(duties), **STYLES[1], label="fitted")
            axes.set(xlabel="part of full duty [1]", ylabel="force [N]", title="Duty and force of the motor")
            axes.legend(**FRAME)
        return figure


def identify_motor(duties: ArrayLike, forces: ArrayLike, *, confidence: float = 0.95) -> MotorCurve:
    """Dead band, curve and full force of a motor, from duties and the forces that a scale showed.

    No force below the dead band, then straight lines through a quarter, half and three quarters of the force at full duty:
    the law MEASURED of a board. An offset of the scale is fitted too.

    Parameters
    ----------
    duties : array_like, shape (N,)
        Parts of full duty, 0 ... 1; at least nine readings, from 0 to 0.8 or more, some in each quarter of the force.
    forces : array_like, shape (N,)
        [N]
    confidence : float
        Of the intervals.

    Returns
    -------
    MotorCurve

    Raises
    ------
    AnalysisError
        For too few readings, readings that leave a part of the curve open, and a force that does not grow with the duty.

    Examples
    --------
    >>> import numpy as np
    >>> import hapticlab as hl
    >>> duties = np.linspace(0, 1, 21)
    >>> forces = np.interp(duties, [0.1, 0.2, 0.45, 0.7, 1], [0, 1, 2, 3, 4])
    >>> found = hl.identify.motor(duties, forces + 0.01 * np.random.default_rng(3).standard_normal(21))
    >>> 0.1 in found["duty_dead"], 0.45 in found["duty_50"], 4.0 in found["force_full"]
    (True, True, True)
    >>> hl.SimulatedPaddle(m=0.03, b=0.1, T=1e-3, compensated=False, **found.values()).duty_dead == found["duty_dead"].value
    True
    """
    from scipy.optimize import least_squares

    given, felt = _checked(duties, forces)
    least = [-np.inf, 0.0, *[-np.inf] * 4]  # a dead band is not below zero
    fitted = least_squares(
        lambda p: _curve(p[:-1], given) + p[-1] - felt, _start(given, felt), x_scale="jac", bounds=(least, np.inf)
    )
    order, rest = fitted.x[1:-1], fitted.fun
    if fitted.x[0] <= 0 or np.any(np.diff([*order, 1.0]) <= 0):
        raise AnalysisError(
            "identify.motor: the force does not grow with the duty. Check the direction of the motor and the scale, tap the "
            "table before each reading, and measure again."
        )
    _require_readings(given, [*order, 1.0])
    free = len(given) - len(NAMES)
    variance = rest @ rest / free * np.diag(np.linalg.pinv(fitted.jac.T @ fitted.jac))
    half = student(confidence, free) * np.sqrt(variance)
    rms = float(np.sqrt(np.mean(rest**2)))
    poor = POOR * float(np.ptp(felt))
    if rms > poor or np.max(half[1:-1]) > VAGUE:
        raise AnalysisError(
            f"identify.motor: the readings lie {rms:.3g} N rms off the curve, and its duties are known to +- "
            f"{np.max(half[1:-1]):.2g} at worst; needs {poor:.2g} N and +- {VAGUE:g}. Measure more carefully, "
            "with more duties."
        )
    estimates = {
        name: Estimate(name, value, max(value - width, 0.0) if name == "duty_dead" else value - width, value + width, unit)
        for (name, unit), value, width in zip(NAMES.items(), fitted.x.tolist(), half.tolist(), strict=True)
    }
    return MotorCurve(estimates, confidence, rms, given, felt)


def _curve(p, duties):
    """Return the force at duties for (force_full, duty_dead, duty_25, duty_50, duty_75); finite for knots in any order."""
    full, knots = p[0], np.maximum.accumulate([*p[1:], 1.0]) + 1e-9 * np.arange(5)
    return full * np.interp(duties, knots, PARTS)


def _checked(duties: ArrayLike, forces: ArrayLike) -> tuple[Array, Array]:
    """Return duties and forces by rising duty, as arrays."""
    duties, forces = np.asarray(duties, float), np.asarray(forces, float)
    if duties.shape != forces.shape or duties.ndim != 1:
        raise AnalysisError(f"identify.motor: {duties.shape} duties, {forces.shape} forces; needs one force for each duty.")
    if not (np.isfinite(forces).all() and np.all((duties >= 0) & (duties <= 1))):
        raise AnalysisError("identify.motor: needs duties from 0 to 1 and forces that are finite, in N.")
    if len(np.unique(duties)) < LEAST_READINGS or duties.max() < LEAST_DUTY:
        raise AnalysisError(
            f"identify.motor: {len(np.unique(duties))} different duties up to {duties.max(initial=0):.2g}; needs "
            f"{LEAST_READINGS} or more, up to {LEAST_DUTY:g}. Measure at more duties."
        )
    order = np.argsort(duties, kind="stable")
    return duties[order], forces[order]


def _start(duties, forces):
    """Return first values: the curve through the readings, made to rise."""
    offset = forces[0]
    rising = np.maximum.accumulate(forces - offset)
    full = rising[-1] + (rising[-1] - rising[-3]) / (duties[-1] - duties[-3]) * (1 - duties[-1]) or 1.0
    distinct = rising + 1e-9 * full * np.arange(len(rising))
    quarters = np.interp(PARTS[1:-1] * full, distinct, duties)
    felt = np.interp(0.03 * full, distinct, duties)
    return np.array([full, np.clip(felt, 1e-3, 0.9 * quarters[0]), *quarters, offset])


def _require_readings(duties, knots):
    """Refuse readings of which none lies in a quarter of the force."""
    for low, high, part in zip(knots, knots[1:], PARTS, strict=False):
        if not np.any((duties > low) & (duties <= high)):
            raise AnalysisError(
                f"identify.motor: no reading between {low:.2f} and {high:.2f} of full duty, where the force goes from "
                f"{100 * part:.0f} to {100 * part + 25:.0f} % of its full size. Measure there too."
            )
    if not np.any(duties <= max(knots[0], 0.0)):
        raise AnalysisError("identify.motor: no reading without a force. Measure at duty 0 too.")
