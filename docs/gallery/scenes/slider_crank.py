"""Slider and crank

At a dead centre the handle cannot turn the crank. Only the flywheel carries it through.

* `J=2e-4kg*m^2`: Five times the flywheel carries the crank through the dead centre more easily, but it is heavier everywhere.
* `c=5e-4N*m*s/rad`: With more friction in the bearing the crank stops soon after you stop.
"""

import hapticlab as hl

scene = hl.library.slider_crank()

paddle = hl.SimulatedPaddle.from_profile(hl.library.nominal, hand=hl.Hand("pinch"))
hl.share(scene, paddle, "slider_crank.html", sliders={"J": (1e-5, 3e-4), "c": (0, 1e-3)})
