"""Virtual fixtures

A guide draws the handle to a line, and a wall forbids a region.

* `x_g=-20mm`: The guide has moved to the left.
* `k_w=100N/m`: The forbidden region becomes soft: with the same push you go four times as deep.
"""

import hapticlab as hl

scene = hl.library.virtual_fixture()

paddle = hl.SimulatedPaddle.from_profile(hl.library.nominal, hand=hl.Hand("pinch"))
hl.share(scene, paddle, "virtual_fixture.html")
