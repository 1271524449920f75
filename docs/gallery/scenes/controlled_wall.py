"""A stiff wall with a passivity controller

An observer adds up the energy that the wall has generated. A controller dissipates this energy with a damper that changes in
every period.

What it teaches: passivity can be enforced at run time, without a model of the paddle. The controller acts after the energy was
generated, and its damper is limited by the noise of the velocity.

Labs: 05, 15

* `k=500N/m`: A soft wall: the controller has little to do.
"""

import hapticlab as hl

scene = hl.laws.passivity_controller(hl.wall())(k=4000, x_o="5 mm", alpha_max=2)

paddle = hl.SimulatedPaddle.from_profile("hapkit", hand=hl.Hand("pinch"))
hl.share(scene, paddle, "controlled_wall.html", sliders={"k": (100, 5000)})
