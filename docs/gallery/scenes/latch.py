"""A latch

The latch catches the handle at 10 mm. It lets go when the handle is pulled back with 3 N.

What it teaches: a state with an input that sets it and an input that resets it. The input that must win comes first.

Labs: 16

* `F_max=1N`: The latch lets go of the handle at a third of the force.
* `x_set=20mm`: The latch is farther away.
"""

import sympy as sp

import hapticlab as hl
from hapticlab import n, x

K, x_set, F_max = hl.parameters("K x_set F_max", units="N/m m N", values=(150, 10e-3, 3.0))
held = hl.signal("held", unit="1")
pulled = K * (x(n) - x_set)
catch = sp.Eq(held(n), hl.when(pulled < -F_max, 0, hl.when(x(n) > x_set, 1, held(n - 1))))
scene = hl.Scene(force=hl.when(held(n) > 0, pulled), eom=[catch], watch={"held": held(n)}, name="latch")

paddle = hl.SimulatedPaddle.from_profile(hl.library.nominal, hand=hl.Hand("pinch"))
hl.share(scene, paddle, "latch.html")
