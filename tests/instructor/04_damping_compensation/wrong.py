"""Wrong answers as students write them: each earns nothing, and the lab has a sentence for it."""

import numpy as np

import hapticlab as hl
from hapticlab import n, v, x

viscous, dry = hl.parameters("viscous dry", units="1 1")
b, f_c, speed = hl.parameters("b f_c speed", units="N*s/m N m/s")
s = hl.when(v(n) > speed, 1, hl.when(v(n) < -speed, -1, 0))
k, x_o = hl.parameters("k x_o", units="N/m m")
B = hl.parameters("B", units="N*s/m", ranges=(-1, 1))
moved = x(n) - x(n - 1)


def ends_of(b, b_low, b_high, coulomb, coulomb_low, coulomb_high):
    return {"viscous": b_high / b, "dry": coulomb_high / coulomb}


WRONG = [
    ("compensating", hl.Scene(force=viscous * b * v(n) + dry * f_c * s)),
    ("compensating", hl.Scene(force=-viscous * b * v(n) - dry * f_c * hl.when(v(n) > speed, 1, -1))),
    ("compensating", hl.Scene(force=-viscous * b * v(n) - dry * f_c * v(n) / (v(n) ** 2 + speed**2) ** 0.5)),
    ("compensating", hl.Scene(force=-viscous * b * v(n) - dry * f_c * hl.when(v(n) > speed, 1, 0))),
    ("compensating", hl.Scene(force=-viscous * b * v(n) + dry * f_c * s)),
    ("coast", lambda v0, m, b, coulomb: m * v0 / b),
    ("coast", lambda v0, m, b, coulomb: m / b * np.log(1 + b * v0 / coulomb)),
    ("coast", lambda v0, m, b, coulomb: m / b * (v0 - coulomb / b * np.log10(1 + b * v0 / coulomb))),
    ("cycle_amplitude", lambda g, k, kept: g / k * kept / (1 - kept)),
    ("cycle_amplitude", lambda g, k, kept: g / k / (1 - kept)),
    ("onset", lambda kept: (1 - kept) / (1 + kept)),
    ("onset", lambda kept: 1.0),
    ("safe_fractions", ends_of),
    ("safe_fractions", lambda b, b_low, b_high, coulomb, coulomb_low, coulomb_high: {
        "viscous": b / b_high, "dry": coulomb / coulomb_high}),
    ("stiffest_passive", lambda b, b_added, B, T: max(0, 2 * (b + b_added - B) / T)),
    ("stiffest_passive", lambda b, b_added, B, T: 2 * (b + b_added - abs(B)) / T),
    ("free_air_wall", hl.Scene(force=hl.when(x(n) >= x_o, k * (x(n) - x_o)) + B * moved / hl.T)),
    ("free_air_wall", hl.Scene(force=hl.when(x(n) >= x_o, B * moved / hl.T, k * (x(n) - x_o)))),
    ("which_design", "a"),
    ("which_design", "c"),
]  # fmt: skip
