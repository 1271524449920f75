"""Buckling beam

Beyond the critical load the middle is unstable, and the handle snaps from one side to the other.

* `P=0.5`: Below the critical load the beam has one state of rest, in the middle.
* `P=2`: At twice the critical load, the two states are 42 mm from the middle.
"""

import hapticlab as hl

scene = hl.library.buckling_beam()

paddle = hl.SimulatedPaddle.from_profile(hl.library.nominal, hand=hl.Hand("pinch"))
hl.share(scene, paddle, "buckling_beam.html")
