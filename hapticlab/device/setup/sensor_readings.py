"""What a sensor reads while the motor is off: counts of a handle that rests or is moved, and what is wrong with them."""

from dataclasses import dataclass

import numpy as np

from ...errors import PaddleError
from ...scene.notation.symbols import n, parameters, x
from ...scene.scene import Scene
from ..link.messages import SENSORS
from .still_noise import still_noise

#: counts: at rest no more than this is noise, and no less than this is a motion
NOISY, LEAST_SWEEP = 6, 50
#: the same of an angle sensor with more than 10 bits, from end to end of a second: of an AS5048A's 14 bits the noise is about
#: 2.7 counts rms, and a Pico's 12 bits have some 8 counts of their own
NOISY_FINE, COARSE = 30, 1024
#: counts by which a sensor may leave the straight line through its neighbours
JUMP = 20
#: part of the sweep at either end where a handle that hits its stop is no jump of the sensor
STOPS_PART = 0.02
#: s of watching a handle at rest
REST = 1.0
#: counts that one line of an encoder alone makes, and changes from which that is clear
TO_AND_FRO, CHANGES = 2, 10


@dataclass(frozen=True)
class Readings:
    """Counts of a handle that was watched, shape (N,), and the fault that ended it or None."""

    counts: np.ndarray
    fault: str | None = None

    @property
    def sweep(self):
        """From the least to the greatest [counts]."""
        return float(np.ptp(self.counts)) if len(self.counts) else 0.0

    @property
    def travelled(self):
        """From the first to the last [counts]."""
        return float(self.counts[-1] - self.counts[0]) if len(self.counts) else 0.0

    @property
    def jump(self):
        """Return the largest distance of a sample from the middle between its neighbours, away from both stops [counts]."""
        counts, stop = self.counts, STOPS_PART * self.sweep
        free = (counts[1:-1] > counts.min() + stop) & (counts[1:-1] < counts.max() - stop)
        off = np.abs(counts[1:-1] - (counts[2:] + counts[:-2]) / 2)
        return float(np.max(off, where=free, initial=0.0))

    @property
    def is_to_and_fro(self):
        """Whether the count only goes up and down by one, as where one line of an encoder is missing."""
        return 0 < self.sweep <= TO_AND_FRO and np.count_nonzero(np.diff(self.counts)) >= CHANGES


def most_at_rest(settings):
    """Return how many counts the reading of a resting handle may wander by, from end to end; settings may be None."""
    fine = settings is not None and settings.sensor != SENSORS["QUADRATURE"] and settings.wrap > COARSE
    return NOISY_FINE if fine else NOISY


def measure_noise(paddle, person):
    """Return the standard deviation of the sensor's noise [m], without its counting, and what was found, in lines.

    Raises
    ------
    PaddleError
        If the handle moved, or the sensor is too noisy.
    """
    person.ask("Let the handle rest, do not touch it, and press Enter. The motor is off.")
    rest = readings(paddle, REST)
    most = most_at_rest(paddle.settings)
    if rest.sweep > most:
        raise PaddleError(
            f"sensor: at rest the reading wanders by {rest.sweep:.0f} counts; needs {most} at most. Let the handle rest against "
            "a stop. If it wanders again, check the supply of the sensor, and keep its wires away from those of the motor."
        )
    found, step = still_noise(np.round(rest.counts)), abs(paddle.settings.metres_per_count) * 1e6
    between = f"between {found.low * step:.3g} and {found.high * step:.3g}"
    words = f"measured   at rest {rest.sweep:.0f} counts wide; noise {found.value * step:.3g} um rms, {between}"
    return found.value * step * 1e-6, [words]


def watch(paddle, seconds):
    """Return the Telemetry of a handle watched with the motor off."""
    return paddle.run(watched_scene(), duration=seconds, passive=True, progress=False)


def watched_scene():
    """Return a scene that reads the handle and gives no force."""
    k = parameters("k", units="N/m")
    return Scene(force=k * x(n), name="watching")(k=0.0)


def readings(paddle, seconds):
    """Watch the handle with the motor off and return its Readings."""
    log = watch(paddle, seconds)
    return Readings(log.x / (paddle.settings.metres_per_count if paddle.settings else 1.0), log.fault)
