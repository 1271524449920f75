"""A switch that clicks

The force drops where the switch goes down, and comes back at a smaller displacement where the switch comes up.

What it teaches: a machine with two states. Its thresholds differ, so a hand that presses and releases it loses the energy
k d (x_on - x_off). If the thresholds were equal, the switch would buzz at the boundary.

Labs: 16

* `d=1mm`: The force drops by a third as much, and the click is faint.
* `x_off=2mm`: The switch comes up much later. The loop of force over position becomes wide, and you lose more energy.
"""

import sympy as sp

import hapticlab as hl
from hapticlab import n, x

k, d = hl.parameters("k d", units="N/m m", values=(150, 3e-3))
x_on, x_off = hl.parameters("x_on x_off", units="m m", values=(8e-3, 6e-3))
s = hl.signal("s", unit="1")  # 0 is up, and it begins up
moves = hl.when(x(n) > x_on, 1, hl.when(x(n) < x_off, 0, s(n - 1)))
scene = hl.Scene(force=k * (x(n) - d * s(n)), eom=[sp.Eq(s(n), moves)], watch={"down": s(n)}, name="click")

paddle = hl.SimulatedPaddle.from_profile(hl.library.nominal, hand=hl.Hand("pinch"))
hl.share(scene, paddle, "click.html")
