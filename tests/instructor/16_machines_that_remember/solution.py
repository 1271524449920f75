"""Answers of lab 16."""

import math

import sympy as sp

import hapticlab as hl
from hapticlab import n, x

prediction_gives = "B"
prediction_rate = 500


# under names of its own: the notebook has values for the paddle in use
_k, _d, _x_on, _x_off = hl.parameters("k d x_on x_off", units="N/m m m m")
_s = hl.signal("s", unit="1")
_moves = hl.when(x(n) > _x_on, 1, hl.when(x(n) < _x_off, 0, _s(n - 1)))
switch = hl.Scene(force=_k * (x(n) - _d * _s(n)), eom=[sp.Eq(_s(n), _moves)], name="switch")
_F_c, _g = hl.parameters("F_c g", units="N m")
_h = hl.signal("h", unit="m", initial=x(n))
_F = _k * (sp.Max(x(n) - _h(n) - _g / 2, 0) + sp.Min(x(n) - _h(n) + _g / 2, 0))
_w = _g / 2 + _F_c / _k
gear = hl.Scene(force=_F, eom=[sp.Eq(_h(n), sp.Max(x(n) - _w, sp.Min(x(n) + _w, _h(n - 1))))], name="gear")


def lost(k, d, x_on, x_off):
    """Return a parallelogram: k d high, x_on - x_off wide."""
    return k * d * (x_on - x_off)


def gear_lost(F_c, k, g, X):
    """Return the work of friction: the load goes 2X less the play and two compressions, there and back."""
    return 2 * F_c * max(2 * X - g - 2 * F_c / k, 0.0)


def period(tau, hot, low, high):
    """Return the time of heating plus the time of cooling."""
    return tau * (math.log((hot - low) / (hot - high)) + math.log(high / low))


def latch(set, reset, q):
    """Return the states of a latch whose reset wins."""
    states = []
    for s, r in zip(set, reset, strict=True):
        q = 0 if r else 1 if s else q
        states.append(q)
    return states


def remembered(x_off, x_on, count):
    """Return how many multiples of a count lie from x_off to x_on."""
    return math.floor(x_on / count) - math.ceil(x_off / count) + 1


gives = "c"
discussion = (
    "I would render the click switch, whose force drops on the way in, and the gear, because both take energy from the hand: the "
    "area of their loops is positive. I would not render the switch whose force rises: the slower a hand moves, the less a "
    "damper takes, and the machine still gives the same area per cycle, so only dry friction could pay for it. The hysteresis "
    "should be at least four counts of my encoder, or the state flickers when the handle rests on the threshold, and for a "
    "rising force more than the distance by which the jump pushes the handle back. A thermostat needs a band as well, because "
    "without it the relay switches every few samples."
)
