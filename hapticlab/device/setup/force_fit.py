"""Force constant and law of a motor, by least squares from duties and the forces that a scale or a weight told."""

from dataclasses import dataclass

import numpy as np

from ...errors import PaddleError
from ..board.settings import changed
from ..link.messages import MOTOR_LAWS

#: a fit is poor where its residual is more than this part of the range of forces, or this many newtons (3 g on a scale)
POOR_PART, POOR_N = 0.05, 0.03
#: the other law is taken where its residual is so many times smaller
CLEARLY = 2.0
#: N at full duty: outside these it is no paddle's motor
LEAST, MOST = 0.1, 100.0


@dataclass(frozen=True)
class ForceFit:
    """force_full [N] with its standard error [N], the law, the residuals [N, rms] of both laws."""

    force_full: float
    error: float
    law: str
    residuals: dict

    def words(self, was):
        """The fit in lines; ``was`` is the law the board had."""
        rms = ", ".join(f"{1e3 * a:.1f} mN with {law}" for law, a in self.residuals.items() if np.isfinite(a))
        error = f" +- {self.error:.2g}" if np.isfinite(self.error) else ""
        lines = [f"measured   force_full = {self.force_full:.4g}{error} N", f"measured   residual {rms}"]
        if self.law != was:
            return [*lines, f"measured   force follows {self.law}, not {was}; the stored law changes too"]
        told = len([a for a in self.residuals.values() if np.isfinite(a)]) > 1
        return [*lines, f"kept       motor law {was}" + ("" if told else ", because so few points do not show the law")]


def fit_force(duties, forces, settings, *, intercept=True):
    """Fit force = offset + force_full part(duty), where the part of the full force is by the motor's law and dead band.

    Parameters
    ----------
    duties, forces : array_like, shape (points,)
        0 ... 1, and [N].
    settings : Settings
        The board's. LINEAR or SQRT in the place of its law is taken only if it fits clearly better; a MEASURED law stays.
    intercept : bool
        Whether an offset (tare, constant friction) is fitted.

    Raises
    ------
    PaddleError
        If the force does not grow with the duty, or no law fits.

    Examples
    --------
    >>> from hapticlab.device.board.settings import nominal
    >>> from hapticlab.device.link.messages import MOTOR_LAWS
    >>> from hapticlab.device.setup.force_fit import fit_force
    >>> linear = nominal("hapkit", motor_law=MOTOR_LAWS["LINEAR"])
    >>> found = fit_force([0, 0.1, 0.2, 0.3], [0.0, 0.4, 0.8, 1.2], linear)
    >>> round(found.force_full, 6), found.law
    (4.0, 'LINEAR')
    """
    duties, forces, law = np.asarray(duties, float), np.asarray(forces, float), law_of(settings)
    laws = (law,) if law == "MEASURED" else ("LINEAR", "SQRT")
    fits = {name: _line(_parts(duties, settings, name), forces, intercept) for name in laws}
    if len(duties) < (4 if intercept else 3):
        fits = {name: (full, error, rms if name == law else np.nan, rest) for name, (full, error, rms, rest) in fits.items()}
    best = next((name for name in laws if CLEARLY * fits[name][2] < fits[law][2]), law)
    full, error, rms, rest = fits[best]
    _require_growth(full, forces)
    allowed = max(POOR_PART * np.ptp(forces), POOR_N)
    if rms > allowed:
        worst = int(np.argmax(np.abs(rest)))
        raise PaddleError(
            f"force: no motor law fits: residual {rms:.3g} N, {allowed:.3g} N is allowed. The reading {forces[worst]:.3g} N at "
            f"duty {duties[worst]:.2f} is {rest[worst]:+.2g} N off; tap the table before each reading, make sure that the "
            "handle touches only the scale, and measure again."
        )
    _require_sense(full, error)
    return ForceFit(full, error, best, {name: fit[2] for name, fit in fits.items()})


def law_of(settings):
    """Return the name of a board's motor law."""
    return next(name for name, number in MOTOR_LAWS.items() if number == settings.motor_law)


def _parts(duties, settings, law):
    """Return the parts of the full force that duties give by a law."""
    motor = changed(settings, motor_law=MOTOR_LAWS[law], motor_sign=1, force_full=1.0)
    return np.array([motor.force_of_duty(duty) for duty in duties])


def _line(g, forces, intercept):
    """Return slope, its standard error, rms residual, residuals of a straight line."""
    columns = np.column_stack([g, np.ones_like(g)] if intercept else [g])
    found = np.linalg.lstsq(columns, forces, rcond=None)[0]
    rest = forces - columns @ found
    free = len(g) - columns.shape[1]
    if free <= 0:
        return float(found[0]), np.nan, 0.0, rest
    variance = rest @ rest / free * np.linalg.pinv(columns.T @ columns)[0, 0]
    return float(found[0]), float(np.sqrt(variance)), float(np.sqrt(np.mean(rest**2))), rest


def _require_growth(full, forces):
    if np.ptp(forces) < POOR_N and full < 1:
        raise PaddleError(
            f"force: the same {np.mean(forces):.3g} N at every duty; the motor has no supply, or the handle does not press "
            "on the scale. Check both and measure again."
        )
    if full <= 0:
        raise PaddleError(
            f"force: {full:.3g} N at full duty, and the force falls as the duty grows, so the handle presses in the other "
            "direction. Choose the other direction, or check the sign of the motor."
        )


def _require_sense(full, error):
    if not LEAST <= full <= MOST:
        raise PaddleError(f"force: {full:.3g} N at full duty; a paddle has {LEAST:g} to {MOST:g} N. Did you enter grams?")
    if np.isfinite(error) and error > full / 5:
        raise PaddleError(
            f"force: {full:.3g} +- {error:.2g} N at full duty is too uncertain; measure more carefully, or with a larger force."
        )
