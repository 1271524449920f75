"""Two masses on a spring

The second mass can hold the first one still, at one frequency.

* `k=200N/m`: Four times the stiffness doubles the antiresonance, from 3.6 Hz to 7.1 Hz.
* `b=1N*s/m`: With more damping between the masses, the ringing ends sooner and the antiresonance becomes shallow.
"""

import hapticlab as hl

scene = hl.library.two_masses()

paddle = hl.SimulatedPaddle.from_profile(hl.library.nominal, hand=hl.Hand("pinch"))
hl.share(scene, paddle, "two_masses.html", sliders={"k": (10, 300), "b": (0, 2)})
