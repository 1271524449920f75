"""Gears and a flywheel

A gear ratio of three makes a flywheel feel nine times as large.

* `J_2=8e-6kg*m^2`: Four times the flywheel: the handle feels 205 g instead of 70 g.
* `c=1e-4N*m*s/rad`: The bearing now feels viscous: c/r^2 = 0.25 N s/m at the handle.
"""

import hapticlab as hl

scene = hl.library.gears()

paddle = hl.SimulatedPaddle.from_profile(hl.library.nominal, hand=hl.Hand("pinch"))
hl.share(scene, paddle, "gears.html", sliders={"J_2": (0, 1e-5), "c": (0, 2e-4)})
