"""Stick-slip

A block sticks to a rough floor until the spring pulls hard enough. Then it jumps.

* `F_s=1N`: If the friction at rest is not larger than the friction in motion, the block slides without jumps.
* `K=400N/m`: A stiffer spring makes the jumps shorter: 2 (F_s - F_c)/K is 5 mm instead of 10 mm.
"""

import hapticlab as hl

scene = hl.library.stick_slip()

paddle = hl.SimulatedPaddle.from_profile(hl.library.nominal, hand=hl.Hand("pinch"))
hl.share(scene, paddle, "stick_slip.html")
