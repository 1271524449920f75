"""A plate without thickness

The proxy, or god-object, is a point that follows the handle and never passes the plate. A spring pulls the handle to the proxy,
so the plate holds from both sides however hard you push.

What it teaches: a penalty needs a solid with an inside. A proxy remembers the side from which it came, so it needs none.

Labs: 17

* `x_o=0mm`: The plate is where the handle starts. The handle counts as before it.
* `K=100N/m`: A softer spring to the proxy: the handle goes deeper, the proxy does not.
"""

import hapticlab as hl

scene = hl.laws.proxy_wall("both")(K=500, x_o="10 mm")

plate = hl.shapes.Box("0.4 mm", "40 mm").at(x="10 mm", name="plate")
point = hl.shapes.Circle("2 mm").at(x=scene.signals[-1], y="15 mm", name="proxy")
paddle = hl.SimulatedPaddle.from_profile(hl.library.nominal, hand=hl.Hand("pinch"))
hl.share(scene, paddle, "thin_plate.html", picture=[plate, point], sliders={"x_o": (-0.02, 0.02), "K": (50, 1500)})
