"""Counts to metres: the handle led to both stops, twice, and the travel between them measured with a ruler."""

import math
from dataclasses import dataclass

from ...errors import PaddleError
from ..board.settings import changed
from .person import number

#: readings of a handle at rest, and how far they lie apart [s]
READINGS, BETWEEN = 10, 0.02
#: counts by which a handle at rest may still move, and two sweeps may differ; the latter also as part of the span
STILL, AGREE, AGREE_PART = 3, 4, 1 / 400
#: counts; less is no sweep but noise
LEAST_SPAN = 50


@dataclass(frozen=True)
class Stops:
    """What two sweeps told: mean span [counts, signed: positive where counts grow into the wall], spread, travel [m]."""

    span: float
    spread: float
    travel: float

    @property
    def metres_per_count(self):
        """Handle travel of one count [m]; its sign makes x grow into the wall."""
        return self.travel / self.span

    def into(self, settings):
        """Return the settings with this travel, x = 0 in its middle; the motor's sign is to be checked anew."""
        half = self.travel / 2
        return changed(settings, metres_per_count=self.metres_per_count, travel_min=-half, travel_max=half, checked=0)

    def words(self):
        """The stops in lines."""
        return [
            f"measured   {abs(self.span):.0f} counts between the stops ({self.spread:.0f} counts between two sweeps)",
            f"measured   travel {self.travel * 1e3:g} mm, so {abs(self.metres_per_count) * 1e6:.4g} um per count",
            f"chosen     x increases into the wall as counts {'increase' if self.span > 0 else 'decrease'}; x = 0 is the middle",
        ]


def measure_stops(paddle, person):
    """Lead a person through two sweeps from stop to stop and return the Stops.

    Raises
    ------
    PaddleError
        If the handle hardly moved, or the two sweeps disagree: what to look at is said.
    """
    ends = [(_resting_at(paddle, person, "LEFT", again), _resting_at(paddle, person, "RIGHT", again)) for again in ("", " again")]
    spread = _compared(ends)
    span = sum(right - left for left, right in ends) / 2
    side = person.choose("On which side do you want the walls? x increases into them.", {"left": "", "right": ""})
    return Stops(span if side == "right" else -span, spread, _travel(person))


def read_counts(paddle):
    """Return mean counts of a handle at rest, and by how many they varied."""
    seen = []
    for _ in range(READINGS):
        paddle.exchange.wait(lambda: False, BETWEEN)
        seen.append(paddle.state()["counts"])
    return sum(seen) / len(seen), max(seen) - min(seen)


def _resting_at(paddle, person, side, again):
    while True:
        person.ask(f"Move the handle slowly to the {side} stop{again}, hold it there, and press Enter.")
        mean, moved = read_counts(paddle)
        if moved <= STILL:
            return mean
        person.say(f"The sensor moved by {moved} counts during the reading. Hold the handle still against the stop.")


def _compared(ends):
    """Return by how many counts two sweeps disagree, or refuse them."""
    (left, right), (left_again, right_again) = ends
    spans = right - left, right_again - left_again
    allowed = max(AGREE, AGREE_PART * abs(spans[0]))
    if min(map(abs, spans)) < LEAST_SPAN:
        raise PaddleError(
            f"stops: {min(map(abs, spans)):.0f} counts from stop to stop; a sweep needs at least {LEAST_SPAN}. Check the "
            "sensor's wires and its magnet, and move the handle from one stop to the other."
        )
    spread = abs(spans[1] - spans[0])
    if spread > allowed:
        raise PaddleError(
            f"stops: {spans[0]:.0f} counts in the first sweep, {spans[1]:.0f} in the second; they may differ by {allowed:.0f}. "
            "Move the handle slowly and hold it against each stop. Tighten the cable, belt or wheel, and make sure that the "
            "magnet is fixed and close to the sensor."
        )
    shift = max(abs(left_again - left), abs(right_again - right))
    if shift > 2 * allowed:
        raise PaddleError(
            f"stops: between the sweeps both stops moved by {shift:.0f} counts; the drive slipped. Tighten and clean the "
            "cable, belt or wheel, then sweep again."
        )
    return spread


def _travel(person):
    how = person.choose(
        "How was the travel of the handle measured?",
        {"mm": "from stop to stop, along the path of the fingers", "angle": "radius of the handle and angle between the stops"},
    )
    if how == "mm":
        return number(person, "Travel from stop to stop [mm]?", low=5, high=1000) * 1e-3
    radius = number(person, "Distance from the axis to the fingers [mm]?", low=5, high=1000) * 1e-3
    return radius * math.radians(number(person, "Angle between the stops [degrees]?", low=2, high=360))
