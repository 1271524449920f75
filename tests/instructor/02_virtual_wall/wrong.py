"""Wrong answers as students write them: each earns nothing, and the lab has a sentence for it."""

import numpy as np

import hapticlab as hl
from hapticlab import n, x

k, x_o = hl.parameters("k x_o", units="N/m m")

WRONG = [
    ("held_work", lambda k, x, D: k * (x + D / 2) * D),
    ("period_leak", lambda k, D: k * D**2),
    ("bounce_gain", lambda k, m, T: np.pi * T * np.sqrt(k / m)),
    ("bounce_gain", lambda k, m, T: 100 * np.pi / 2 * T * np.sqrt(k / m)),
    ("bounce_gain", lambda k, m, T: np.pi / 2 * T * np.sqrt(m / k)),
    ("energy_generated", lambda x, k: -np.sum(k * np.maximum(x, 0)[1:] * np.diff(x))),
    ("energy_generated", lambda x, k: np.sum(k * np.maximum(x, 0)[:-1] * np.diff(x))),
    ("two_walls", hl.Scene(force=hl.when(x(n) >= x_o, k * (x(n) - x_o)))),
    ("two_walls", hl.Scene(force=hl.when(x(n) >= x_o, k * (x(n) - x_o)) + hl.when(x(n) <= -x_o, k * x(n)))),
    ("two_walls", hl.Scene(force=hl.when(x(n) <= x_o, k * (x(n) - x_o)) + hl.when(x(n) >= -x_o, k * (x(n) + x_o)))),
    ("two_walls", hl.Scene(force=hl.when(x(n) < x_o, k * (x(n) - x_o)) + hl.when(x(n) > -x_o, k * (x(n) + x_o)))),
    ("two_walls", hl.Scene(force=hl.when(x(n) >= x_o, k * (x(n) + x_o)) + hl.when(x(n) <= -x_o, k * (x(n) - x_o)))),
    ("damping_that_pays", 0.5),
    ("who_pays", "c"),
]  # fmt: skip

_SQUARED = "1000000 times too large. Was a value in millimetres or milliseconds squared?"
_OR_T = "In this case T = 0.001, so a factor T may also be missing"
#: (exercise, answer, sentence): slips that are not of one lab, so that hapticlab has the sentence
ANYWHERE = [
    ("held_work", lambda k, x, D: k * 1e3 * x * 1e3 * D, _SQUARED),
    ("period_leak", lambda k, D: k * (1e3 * D) ** 2 / 2, _SQUARED),
    ("bounce_gain", lambda k, m, T: np.pi / 2 * np.sqrt(k / m), _OR_T),
]
