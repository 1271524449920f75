"""Detents

The handle rests at every multiple of a pitch, as a knob that clicks.

Labs: 17

* `p=20mm`: The stable positions are 20 mm apart, and half as stiff.
* `A=0.2N`: A third of the force: the detents are as far apart, and easy to leave.
"""

import hapticlab as hl

scene = hl.library.detents()

paddle = hl.SimulatedPaddle.from_profile(hl.library.nominal, hand=hl.Hand("pinch"))
hl.share(scene, paddle, "detents.html")
