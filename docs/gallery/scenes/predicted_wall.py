"""A wall that looks half a sample ahead

The spring acts on the position that is predicted for the middle of the period, Eq. (23.3), so that the hold costs no energy. At
the same stiffness as the plain wall this one is quiet.

What it teaches: a prediction compensates the hold, and its price is the difference of two counts of the encoder. On entry the
predicted force rises at once by more than the spring, because the law also acts on the displacement of the last period.

Labs: 04, 11

* `k=1000N/m`: A softer wall: the prediction matters less, because the leak grows with the stiffness.
* `x_o=0mm`: The boundary is where the handle starts.
"""

import hapticlab as hl

scene = hl.wall("half_sample")(k=4000, x_o="5 mm")

paddle = hl.SimulatedPaddle.from_profile("hapkit", hand=hl.Hand("pinch"))
hl.share(scene, paddle, "predicted_wall.html", sliders={"k": (100, 5000), "x_o": (0, 0.02)})
