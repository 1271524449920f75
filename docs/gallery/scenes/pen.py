"""A pen that clicks

Press and release: the button clicks and stays in. Press and release again: it clicks and comes out.

What it teaches: a machine with two states. One state knows whether the button is down, with two thresholds so that it does not
flicker, and the other changes with every press. The first press costs energy, and the second press returns it.

Labs: 16

* `d=1mm`: The force drops by a third as much, and the click is faint.
* `x_off=2mm`: The button must come back further before it can click again.
"""

import sympy as sp

import hapticlab as hl
from hapticlab import n, x

k, d = hl.parameters("k d", units="N/m m", values=(150, 3e-3))
x_on, x_off = hl.parameters("x_on x_off", units="m m", values=(8e-3, 6e-3))
p, q = hl.signal("p", unit="1"), hl.signal("q", unit="1")  # both begin with 0
pressed = sp.Eq(p(n), hl.when(x(n) > x_on, 1, hl.when(x(n) < x_off, 0, p(n - 1))))
toggles = sp.Eq(q(n), hl.when(p(n) > p(n - 1), 1 - q(n - 1), q(n - 1)))
scene = hl.Scene(force=k * (x(n) - d * q(n)), eom=[pressed, toggles], watch={"clicked": q(n)}, name="pen")

paddle = hl.SimulatedPaddle.from_profile(hl.library.nominal, hand=hl.Hand("pinch"))
hl.share(scene, paddle, "pen.html")
