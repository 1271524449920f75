"""Backlash

A tooth that drives a load has play. The load stays where it is until a flank of the play pushes it with its dry friction.

What it teaches: a state that is a position. The force depends on where the load was left, so the loop of force over position
encloses the work against friction.

Labs: 16

* `g=10mm`: A wide play: the handle moves freely for 10 mm after each reversal.
* `F_c=0.5N`: A load with more friction: each flank is harder to push.
"""

import sympy as sp

import hapticlab as hl
from hapticlab import n, x

k, F_c, g = hl.parameters("k F_c g", units="N/m N m", values=(150, 0.2, 4e-3))
h = hl.signal("h", unit="m", initial=x(n))  # position of the load, which begins in the middle of its play
w = g / 2 + F_c / k  # the tooth is never farther from the load
flanks = k * (sp.Max(x(n) - h(n) - g / 2, 0) + sp.Min(x(n) - h(n) + g / 2, 0))
follows = sp.Eq(h(n), sp.Max(x(n) - w, sp.Min(x(n) + w, h(n - 1))))
scene = hl.Scene(force=flanks, eom=[follows], watch={"load_at": h(n)}, name="backlash")

load = [hl.shapes.Box("30 mm", "3 mm").at(x=h(n), y="-7.5 mm")]
paddle = hl.SimulatedPaddle.from_profile(hl.library.nominal, hand=hl.Hand("pinch"))
hl.share(scene, paddle, "backlash.html", picture=load)
