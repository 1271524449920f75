"""A ratchet

The handle moves freely to the right. On the way back, a pawl holds it at the last tooth that it has passed. The pawl lifts if you
pull with more than 1 N, and falls into the next tooth.

What it teaches: a state that is a position. The pawl remembers how far the handle has been.

Labs: 16

* `a=10mm`: The teeth are 10 mm apart, so the handle moves back further before it is held.
* `F_max=0.3N`: The pawl lifts easily, and the handle clicks on its way back.
"""

import sympy as sp

import hapticlab as hl
from hapticlab import n, x

K, a, F_max = hl.parameters("K a F_max", units="N/m m N", values=(400, 4e-3, 1.0))
h = hl.signal("h", unit="m")  # position of the pawl
tooth = a * sp.floor(x(n) / a)  # the last tooth before the handle
lifts = K * (x(n) - h(n - 1)) < -F_max
falls = sp.Eq(h(n), hl.when(lifts, tooth, sp.Max(h(n - 1), tooth)))
scene = hl.Scene(force=K * sp.Min(x(n) - h(n), 0), eom=[falls], watch={"pawl_at": h(n)}, name="ratchet")

pawl = [hl.shapes.Box("1 mm", "6 mm").at(x=h(n), y="-7.5 mm", name="pawl")]
paddle = hl.SimulatedPaddle.from_profile(hl.library.nominal, hand=hl.Hand("pinch"))
hl.share(scene, paddle, "ratchet.html", picture=pawl)
