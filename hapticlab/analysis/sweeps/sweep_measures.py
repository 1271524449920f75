"""What a sweep measures, computed inside the linked program tick by tick, so that no trace is stored.

A measure keeps a few numbers a lane and hands them out; ``value(outputs, count=, quarter=)`` turns the last ones into the
metric, given one encoder count [m] for every lane and the length of a quarter of the run [s]. Quarters and
halves of the run are counted in ticks, as :func:`hapticlab.analysis.records.chatter.chatter` counts them.
"""

from typing import Any

import numpy as np

from ...compiler.ir.program import Channel
from ...compiler.ir.trace import equal, maximum, minimum, select
from ..records.chatter import decaying

#: a swing below this [m] is rounding of a float32 scene: some ulp of a position of centimetres
LEAST = 2e-8
#: bounces that shrink may still end in a cycle, unless a quarter of the run reduces them to this fraction
FALLEN = 1 / 3


def f64(*names):
    """Return float64 channels from pairs of name and unit."""
    return tuple(Channel(name, unit, "f64") for name, unit in names)


def _number(tick):
    return tick.builder.emit("itof", tick, type="f64")


class Swing:
    """The swings of the handle, each from one turning point to the next, that end in the third and the last quarter.

    Swings need no whole number of cycles to be compared. Turning points lie between samples: with the force held the
    handle moves there on a parabola, x_prev + v_prev^2 T / 2(v_prev - v).
    """

    states = f64(
        ("x", "m"), ("v", "m/s"), ("heading", "m/s"), ("anchor", "m"), ("turns", "1"),
        ("largest_before", "m"), ("least_before", "m"), ("largest", "m"),
    )  # fmt: skip
    outputs = f64(
        ("largest_before", "m"), ("least_before", "m"), ("largest", "m"), ("turns", "1"), ("heading", "m/s"), ("v", "m/s")
    )  # fmt: skip

    def __init__(self, ticks, T):
        self.third, self.last, self.T = float(ticks - 2 * (ticks // 4)), float(ticks - ticks // 4), T

    def init(self, sample):
        x = sample["x_true"]
        zero = x.builder.const(0.0, "f64")
        return [x, zero, zero, x, zero, zero, zero + 1e300, zero]

    def update(self, sample, states):
        x_prev, v_prev, heading, anchor, turns, largest_before, least_before, largest = states
        x, v, now = sample["x_true"], sample["v_true"], _number(sample["tick"])
        turned = heading * v < 0.0
        extreme = x_prev + v_prev * v_prev * (self.T / 2) / select(turned, v_prev - v, 1.0)
        swing = abs(extreme - anchor)
        counts = turned & (turns > 0.0)  # the way from the start to the first turning point is no swing
        in_third, in_last = counts & (now > self.third) & (now <= self.last), counts & (now > self.last)
        largest_before = select(in_third, maximum(swing, largest_before), largest_before)
        least_before = select(in_third, minimum(swing, least_before), least_before)
        largest = select(in_last, maximum(swing, largest), largest)
        anchor, turns = select(turned, extreme, anchor), select(turned, turns + 1.0, turns)
        heading = select(equal(v, 0.0), heading, v)
        new = [x, v, heading, anchor, turns, largest_before, least_before, largest]
        return [largest_before, least_before, largest, turns, heading, v], new


class Chatter(Swing):
    """Sustained or growing amplitude [m]; 0 where the handle rests, or its swings shrink or stay within one encoder count.

    nan where the run cannot tell: nothing ever moved, a handle that turned has no swing in one of the quarters, or a
    handle that bounces off the wall swings less and less, towards rest or towards a cycle. A longer run tells, or
    :func:`hapticlab.chatter` of one record.
    """

    unit = "m"
    states = (*Swing.states, *f64(("outside", "1")))
    outputs = (*Swing.outputs, *f64(("outside", "1")))

    def init(self, sample):
        return [*super().init(sample), sample["x_true"].builder.const(0.0, "f64")]

    def update(self, sample, states):
        *own, outside = states
        outputs, following = super().update(sample, own)
        leaves = equal(sample["F"], 0.0) & (_number(sample["tick"]) > self.third)
        outside = select(leaves, 1.0, outside)
        return [*outputs, outside], [*following, outside]

    def value(self, outputs, *, count, quarter):
        *swings, outside = outputs
        largest_before, _, largest, *_ = swings
        found = lasting(swings, count=count, quarter=quarter)
        slow = moves(largest, count) & (largest > FALLEN * largest_before)
        return np.where((found == 0) & slow & (outside > 0), np.nan, found)


def moves(swing, count):
    """Tell whether a swing [m] is more than one encoder count, and more than rounding."""
    return swing > np.maximum(1.001 * count, LEAST)


def lasting(outputs, *, count, quarter):
    """Return the sustained or growing amplitude of a :class:`Swing` [m], 0 also where it shrinks slowly; nan if nothing tells."""
    largest_before, least_before, largest, turns, heading, v = outputs
    seen = moves(largest, count)
    lasts = seen & ~decaying(largest, least_before, largest_before)
    still = (turns == 0) & (heading == 0)
    away = (turns > 0) & (largest == 0) & (abs(v) * quarter > LEAST)  # thrown off, and not back in time
    unknown = still | away | (seen & (largest_before == 0))
    return np.where(unknown, np.nan, np.where(lasts, largest / 2, 0.0))


class Growth(Swing):
    """Logarithm of the largest swings' ratio between the last two quarters, per second [1/s]; nan where either has none."""

    unit = "1/s"

    def value(self, outputs, *, count, quarter):
        largest_before, _, largest, *_ = outputs
        with np.errstate(divide="ignore", invalid="ignore"):
            rate = np.log(largest / largest_before) / quarter
        return np.where((largest_before > 0) & (largest > 0), rate, np.nan)


class Contacts:
    """How often the force goes from zero to nonzero over the last half of the run [1/s]."""

    unit = "1/s"
    states = f64(("force", "N"), ("contacts", "1"))
    outputs = f64(("contacts", "1"))

    def __init__(self, ticks, T):
        self.half = float(ticks - 2 * (ticks // 4))

    def init(self, sample):
        zero = sample["x_true"].builder.const(0.0, "f64")
        return [zero, zero]

    def update(self, sample, states):
        force, contacts = states
        F = sample["F"]
        begins = equal(force, 0.0) & ~equal(F, 0.0) & (_number(sample["tick"]) > self.half)
        contacts = select(begins, contacts + 1.0, contacts)
        return [contacts], [F, contacts]

    def value(self, outputs, *, count, quarter):
        return outputs[0] / (2 * quarter)


class Energy:
    """The most energy ever drawn from the environment through the port [J]: max(0, -min W) up to the last sample."""

    unit = "J"
    states = f64(("W", "J"), ("least", "J"), ("force", "N"))
    outputs = f64(("least", "J"))

    def __init__(self, ticks, T):
        pass

    def init(self, sample):
        zero = sample["x_true"].builder.const(0.0, "f64")
        return [zero, zero, zero]

    def update(self, sample, states):
        W, least, force = states
        least = minimum(W, least)
        F, at = sample["F_applied"], sample["x_switch"]
        work = force * (at - sample["x_true"]) + F * (sample["x_next"] - at)
        return [least], [W + work, least, F]

    def value(self, outputs, *, count, quarter):
        return np.maximum(-outputs[0], 0.0)


class PeakForce:
    """The largest magnitude of the force [N]."""

    unit = "N"
    states = f64(("peak", "N"))
    outputs = f64(("peak", "N"))

    def __init__(self, ticks, T):
        pass

    def init(self, sample):
        return [sample["x_true"].builder.const(0.0, "f64")]

    def update(self, sample, states):
        peak = maximum(abs(sample["F"]), states[0])
        return [peak], [peak]

    def value(self, outputs, *, count, quarter):
        return outputs[0]


class WithFault:
    """A measure, and last whether the program faulted."""

    def __init__(self, measure):
        self.measure, self.states, self.init = measure, measure.states, measure.init
        self.outputs = (*measure.outputs, Channel("fault", "1", "f64"))

    def update(self, sample, states):
        outputs, following = self.measure.update(sample, states)
        one = sample["x_true"].builder.const(1.0, "f64")
        return [*outputs, select(sample["fault"], one, 0.0)], following


class WithUnlocated:
    """A :class:`WithFault`, and last whether an event was left unlocated so far."""

    def __init__(self, measure):
        missed = f64(("unlocated", "1"))
        self.measure, self.states, self.outputs = measure, (*measure.states, *missed), (*measure.outputs, *missed)

    def init(self, sample):
        return [*self.measure.init(sample), sample["x_true"].builder.const(0.0, "f64")]

    def update(self, sample, states):
        *own, missed = states
        outputs, following = self.measure.update(sample, own)
        missed = select(0.0 < sample["unlocated"], 1.0, missed)
        return [*outputs, missed], [*following, missed]


METRICS: dict[str, Any] = {"chatter": Chatter, "growth": Growth, "contacts": Contacts, "energy": Energy, "peak_force": PeakForce}
