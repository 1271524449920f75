"""A surface with friction

The handle draws a proxy over a flat surface under a load of 1 N. The proxy sticks until the spring pulls with the friction force,
and then follows.

What it teaches: friction that sticks and needs no estimate of the velocity. The loop of force over position has the same area
at every speed.

Labs: 17

* `K=100N/m`: A softer spring: the handle moves by 6 mm before the proxy has turned its direction.
"""

import hapticlab as hl

scene = hl.laws.proxy_curve(lambda z: 0 * z, load="1 N", mu=0.3)(K=500)

paddle = hl.SimulatedPaddle.from_profile(hl.library.nominal, hand=hl.Hand("pinch"))
hl.share(scene, paddle, "rough_surface.html")
