"""A wall that chatters

A spring behind a boundary, with its force computed once per period and held. In the pinch of your pointer this wall is stiffer
than the stability limit of the paddle, so it oscillates as long as you press.

The held force gives back more energy than it takes in, as lab 02 derives. Below 2 b/T, Eq. (23.10), no passive hand can make the
wall chatter. A particular hand, such as this pinch, allows more.

Labs: 02, 03, 05

* `k=500N/m`: The wall is soft and quiet.
* `k=2000N/m`: Close to the stability limit of paddle and pinch, the oscillation dies out slowly.
* `B=0.5N*s/m;k=2000N/m`: A virtual damper shortens the oscillation further.
"""

import hapticlab as hl

scene = hl.wall()(k=4000, x_o="5 mm")

paddle = hl.SimulatedPaddle.from_profile("hapkit", hand=hl.Hand("pinch"))
hl.share(scene, paddle, "wall.html", sliders={"k": (100, 5000), "B": (0, 2)})
