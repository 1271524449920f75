"""Pendulum on the handle

A crane in small: the handle carries a pendulum and feels its swing.

* `l=0.6m`: Four times the length doubles the period of the swing.
* `m=0.2kg`: A heavier bob pulls the handle with it.
"""

import hapticlab as hl

scene = hl.library.pendulum_on_the_handle()

paddle = hl.SimulatedPaddle.from_profile(hl.library.nominal, hand=hl.Hand("pinch"))
hl.share(scene, paddle, "pendulum_on_the_handle.html", sliders={"l": (0.05, 0.8), "m": (0.01, 0.3)})
