"""Tuned vibration absorber

A machine that shakes, and a small mass that takes over its vibration.

* `Omega=38rad/s`: The excitation is 20 % faster than the absorber. The vibration of the machine comes back.
* `b_2=0.3N*s/m`: A damped absorber no longer stops the machine completely, but it works over a wider band of frequencies.
"""

import hapticlab as hl

scene = hl.library.tuned_absorber()

paddle = hl.SimulatedPaddle.from_profile(hl.library.nominal, hand=hl.Hand("pinch"))
hl.share(scene, paddle, "tuned_absorber.html")
