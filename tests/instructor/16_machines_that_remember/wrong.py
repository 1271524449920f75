"""Wrong answers as students write them: each earns nothing, and the lab has a sentence for it."""

import math

import numpy as np
import sympy as sp

import hapticlab as hl
from hapticlab import n, x

k, d, x_on, x_off = hl.parameters("k d x_on x_off", units="N/m m m m")
F_c, g = hl.parameters("F_c g", units="N m")
s, h = hl.signal("s", unit="1"), hl.signal("h", unit="m", initial=x(n))
w = g / 2 + F_c / k
on, off = x(n) > x_on, x(n) < x_off


def switch_by(moves, state=None):
    return hl.Scene(force=k * (x(n) - d * (s(n) if state is None else state)), eom=[sp.Eq(s(n), moves)])


def gear_by(load):
    F = k * (sp.Max(x(n) - h(n) - g / 2, 0) + sp.Min(x(n) - h(n) + g / 2, 0))
    return hl.Scene(force=F, eom=[sp.Eq(h(n), load)])


kept = hl.when(on, 1, hl.when(off, 0, s(n - 1)))
forgets = hl.when(on, 1, hl.when(off, 0, 0))
swapped = hl.when(x(n) > x_off, 1, hl.when(x(n) < x_on, 0, s(n - 1)))


def latch_by(after):
    """Return a latch with its next state after (set, reset, state)."""

    def latch(set, reset, q):
        states = []
        for one, other in zip(set, reset, strict=True):
            q = after(one, other, q)
            states.append(q)
        return states

    return latch


def set_wins(one, other, q):
    return 1 if one else 0 if other else q


def linear(tau, hot, low, high):
    middle = (low + high) / 2
    return tau * (high - low) * (1 / (hot - middle) + 1 / middle)


WRONG = [
    ("switch", switch_by(forgets)),
    ("switch", switch_by(swapped)),
    ("switch", switch_by(kept, s(n - 1))),
    ("switch", switch_by(kept, -s(n))),
    ("lost", lambda k, d, x_on, x_off: k * d * (x_on - x_off) / 2),
    ("lost", lambda k, d, x_on, x_off: -k * d * (x_on - x_off)),
    ("lost", lambda k, d, x_on, x_off: k * d * x_on),
    ("lost", lambda k, d, x_on, x_off: k * (x_on**2 - x_off**2) / 2),
    ("gear", gear_by(sp.Max(x(n) - F_c / k, sp.Min(x(n) + F_c / k, h(n - 1))))),
    ("gear", gear_by(sp.Min(x(n) - w, sp.Max(x(n) + w, h(n - 1))))),
    ("gear", gear_by(sp.Max(x(n) - w, sp.Min(x(n) + w, 0 * h(n - 1))))),
    ("gear", gear_by(sp.Max(x(n) - g - F_c / k, sp.Min(x(n) + g + F_c / k, h(n - 1))))),
    ("gear_lost", lambda F_c, k, g, X: 4 * F_c * X),
    ("gear_lost", lambda F_c, k, g, X: 2 * F_c * max(2 * X - g, 0)),
    ("gear_lost", lambda F_c, k, g, X: 2 * F_c * (2 * X - g - 2 * F_c / k)),
    ("gear_lost", lambda F_c, k, g, X: 2 * F_c * max(2 * X - g - F_c / k, 0)),
    ("gear_lost", lambda F_c, k, g, X: F_c * max(2 * X - g - 2 * F_c / k, 0)),
    ("period", lambda tau, hot, low, high: tau * math.log((hot - low) / (hot - high))),
    ("period", lambda tau, hot, low, high: tau * math.log(high / low)),
    ("period", lambda tau, hot, low, high: tau * math.log(hot / (hot - high) * high / low)),
    ("period", lambda tau, hot, low, high: tau * np.log10((hot - low) * high / (hot - high) / low)),
    ("period", lambda tau, hot, low, high: 2 * tau * math.log(high / low)),
    ("period", linear),
    ("latch", latch_by(set_wins)),
    ("latch", lambda set, reset, q: [int(one and not other) for one, other in zip(set, reset, strict=True)]),
    ("latch", latch_by(lambda one, other, q: 1 - q if one else 0 if other else q)),
    ("remembered", lambda x_off, x_on, count: (x_on - x_off) / count),
    ("remembered", lambda x_off, x_on, count: round((x_on - x_off) / count)),
    ("remembered", lambda x_off, x_on, count: math.floor(x_on / count) - math.ceil(x_off / count)),
    ("remembered", lambda x_off, x_on, count: math.floor(x_on / count) - math.floor(x_off / count) + 1),
    ("gives", "a"),
    ("gives", "b"),
    ("gives", "d"),
]  # fmt: skip
