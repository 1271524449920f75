"""What a sweep measures, computed inside the linked program tick by tick, so that no trace is stored.

A measure keeps a few numbers a lane and hands them out; ``value(outputs, count=, quarter=)`` turns the last ones into the
metric, given one encoder count [m] for every lane and the length of a quarter of the run [s]. Quarters and
halves of the run are counted in ticks, as :func:`hapticlab.analysis.chatter.chatter` counts them.
"""

import numpy as np

from ..compiler.ir import Channel
from ..compiler.trace import equal, maximum, minimum, select
from .chatter import LOCK, REVERSALS

#: a swing below this [m] is rounding of a float32 scene: some ulp of a position of centimetres
LEAST = 2e-8


def _f64(*names):
    return tuple(Channel(name, unit, "f64") for name, unit in names)


def _number(tick):
    return tick.builder.emit("itof", tick, type="f64")


class Swing:
    """Peak-to-peak of the handle in the third and the last quarter, and its reversals in both together."""

    states = _f64(("low", "m"), ("high", "m"), ("before", "m"), ("heading", "m/s"), ("reversals", "1"))
    outputs = _f64(("before", "m"), ("after", "m"), ("reversals", "1"))

    def __init__(self, ticks):
        self.third, self.last = float(ticks - 2 * (ticks // 4)), float(ticks - ticks // 4)

    def init(self, sample):
        x = sample["x_true"]
        zero = x.builder.const(0.0, "f64")
        return [x, x, zero, zero, zero]

    def update(self, sample, states):
        low, high, before, heading, reversals = states
        x, v, now = sample["x_true"], sample["v_true"], _number(sample["tick"])
        before = select(equal(now, self.last), high - low, before)
        starts = equal(now, self.third) | equal(now, self.last)
        low, high = select(starts, x, minimum(x, low)), select(starts, x, maximum(x, high))
        turned = (heading * v < 0.0) & (now > self.third)
        reversals = select(turned, reversals + 1.0, reversals)
        heading = select(equal(v, 0.0), heading, v)
        return [before, high - low, reversals], [low, high, before, heading, reversals]


class Chatter(Swing):
    """Sustained or growing amplitude [m]; 0 where the handle rests, its motion decays or stays within one encoder count.

    nan where it turned round but once, and has not come to rest: the run is too short to tell.
    """

    unit = "m"

    def value(self, outputs, *, count, quarter):
        before, after, reversals = outputs
        lasting = (reversals > 0) & (after > np.maximum(1.001 * count, LEAST)) & (after > (1 - LOCK) * before)
        return np.where(lasting, np.where(reversals >= REVERSALS, after / 2, np.nan), 0.0)


class Growth(Swing):
    """Logarithm of the swing's ratio between the last two quarters, per second [1/s]; -inf where the handle rests."""

    unit = "1/s"

    def value(self, outputs, *, count, quarter):
        before, after, _ = outputs
        with np.errstate(divide="ignore", invalid="ignore"):
            rate = np.log(after / before) / quarter
        return np.where(after == 0, -np.inf, rate)


class Contacts:
    """How often the force goes from zero to nonzero over the last half of the run [1/s]."""

    unit = "1/s"
    states = _f64(("force", "N"), ("contacts", "1"))
    outputs = _f64(("contacts", "1"))

    def __init__(self, ticks):
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
    states = _f64(("W", "J"), ("least", "J"), ("force", "N"))
    outputs = _f64(("least", "J"))

    def __init__(self, ticks):
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
    states = _f64(("peak", "N"))
    outputs = _f64(("peak", "N"))

    def __init__(self, ticks):
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


METRICS = {"chatter": Chatter, "growth": Growth, "contacts": Contacts, "energy": Energy, "peak_force": PeakForce}
