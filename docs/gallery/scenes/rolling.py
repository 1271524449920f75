"""Disc that rolls on a plate

The plate drags the disc along with a third of its own acceleration.

* `alpha=0.1rad`: The plate is tilted: the disc rolls down with 2/3 of g sin(alpha), and the weight pulls the handle.
* `m=0.45kg`: Three times the mass: the handle feels M + m/3 = 0.2 kg instead of 0.1 kg.
"""

import hapticlab as hl

scene = hl.library.rolling()

paddle = hl.SimulatedPaddle.from_profile(hl.library.nominal, hand=hl.Hand("pinch"))
hl.share(scene, paddle, "rolling.html")
