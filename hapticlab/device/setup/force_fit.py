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


#: dead bands that are tried, parts of full duty; one is seen from so many points on
DEAD_BANDS, POINTS = np.linspace(0.0, 0.4, 161), 6
#: part of full duty that a measurement must reach before its own curve may be stored
MOST_OF_IT = 0.75


@dataclass(frozen=True)
class ForceFit:
    """force_full [N] with its standard error [N], the law, the residuals [N, rms] of all laws, the duties of the motor.

    ``duties`` are parts of full duty: of no force (the dead band), and of a quarter, half and three quarters of force_full.
    """

    force_full: float
    error: float
    law: str
    residuals: dict
    duties: tuple

    def into(self, settings):
        """Return the settings with what was measured."""
        names = ("duty_dead", "duty_25", "duty_50", "duty_75")[: 4 if self.law == "MEASURED" else 1]
        values = dict(zip(names, self.duties, strict=False))
        return changed(settings, force_full=self.force_full, motor_law=MOTOR_LAWS[self.law], **values)

    def words(self, was, dead=0.0):
        """The fit in lines; ``was`` is the law the board had, ``dead`` its dead band."""
        rms = ", ".join(f"{1e3 * a:.1f} mN with {law}" for law, a in self.residuals.items() if np.isfinite(a))
        error = f" +- {self.error:.2g}" if np.isfinite(self.error) else ""
        lines = [f"measured   force_full = {self.force_full:.4g}{error} N", f"measured   residual {rms}"]
        if self.duties[0] != dead:
            lines.append(f"measured   no force below {100 * self.duties[0]:.1f} % duty, the dead band; {100 * dead:.1f} % before")
        if self.law == "MEASURED":
            quarters = ", ".join(f"{100 * duty:.0f}" for duty in self.duties[1:])
            lines.append(f"measured   {quarters} % duty for a quarter, half and three quarters of the force")
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
        The board's. LINEAR or SQRT in the place of its law, or another dead band, is taken only if it fits clearly better. A
        MEASURED law stays. It is begun where neither law fits, but the forces reach three quarters of full duty.
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
    tried = [(name, settings.duty_dead) for name in ((law,) if law == "MEASURED" else ("LINEAR", "SQRT"))]
    fits = {name: _line(_parts(duties, settings, name, dead), forces, intercept) for name, dead in tried}
    if len(duties) < (4 if intercept else 3):
        fits = {name: (full, error, rms if name == law else np.nan, rest) for name, (full, error, rms, rest) in fits.items()}
    best, dead = next((name for name, _ in tried if CLEARLY * fits[name][2] < fits[law][2]), law), settings.duty_dead
    if len(duties) >= POINTS and law != "MEASURED":
        other = _dead_band(duties, forces, settings, intercept)
        if CLEARLY * other[2] < fits[best][2]:
            best, dead = other[:2]
            fits[best] = other[3]
    full, error, rms, rest = fits[best]
    _require_growth(full, forces)
    allowed = max(POOR_PART * np.ptp(forces), POOR_N)
    residuals = {name: fit[2] for name, fit in fits.items()}
    if rms > allowed and max(duties) >= MOST_OF_IT:
        return _measured_curve(duties, forces, residuals)
    if rms > allowed:
        worst = int(np.argmax(np.abs(rest)))
        raise PaddleError(
            f"force: no motor law fits: residual {rms:.3g} N, {allowed:.3g} N is allowed. The reading {forces[worst]:.3g} N at "
            f"duty {duties[worst]:.2f} is {rest[worst]:+.2g} N off; tap the table before each reading, make sure that the "
            "handle touches only the scale, and measure again."
        )
    _require_sense(full, error)
    return ForceFit(full, error, best, residuals, (dead,))


def _dead_band(duties, forces, settings, intercept):
    """Return law, dead band, residual [N] and fit of the law and the dead band that fit best."""
    found = []
    for name in ("LINEAR", "SQRT"):
        for dead in DEAD_BANDS[DEAD_BANDS < max(duties)]:
            fit = _line(_parts(duties, settings, name, float(dead)), forces, intercept)
            found.append((name, float(dead), fit[2], fit))
    return min(found, key=lambda one: one[2])


def _measured_curve(duties, forces, residuals):
    """Return the fit of a motor that follows no law: straight lines through what was measured, and on to full duty."""
    order = np.argsort(duties)
    duties, forces = duties[order], forces[order] - forces[order][0]  # the first reading, at no duty, is the tare
    if np.any(np.diff(forces) < -POOR_N):
        raise PaddleError("force: the force falls as the duty grows. Tap the table before each reading, and measure again.")
    forces = np.maximum.accumulate(forces)
    slope = (forces[-1] - forces[-2]) / (duties[-1] - duties[-2])
    full = float(forces[-1] + slope * (1 - duties[-1]))
    _require_sense(full, np.nan)
    felt = int(np.argmax(forces > POOR_N))
    rise = (forces[felt + 1] - forces[felt]) / (duties[felt + 1] - duties[felt])
    dead = float(np.clip(duties[felt] - forces[felt] / rise, duties[max(felt - 1, 0)], duties[felt]))
    known = np.append(duties[felt:], 1.0), np.append(forces[felt:], full)
    quarters = tuple(float(np.interp(part * full, [0.0, *known[1]], [dead, *known[0]])) for part in (0.25, 0.5, 0.75))
    return ForceFit(full, np.nan, "MEASURED", residuals, (dead, *quarters))


def law_of(settings):
    """Return the name of a board's motor law."""
    return next(name for name, number in MOTOR_LAWS.items() if number == settings.motor_law)


def _parts(duties, settings, law, dead):
    """Return the parts of the full force that duties give by a law, with a dead band."""
    motor = changed(settings, motor_law=MOTOR_LAWS[law], motor_sign=1, force_full=1.0, duty_dead=dead)
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
