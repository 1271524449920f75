"""A mass behind a spring and a damper

Slowly, the handle feels a spring. Faster, it feels the resonance of the body, and then a mass.

* `k=400N/m`: Four times the stiffness doubles the natural frequency of the body on its own spring, from 5 Hz to 10 Hz.
* `b=2N*s/m`: The damping ratio rises from 0.02 to 0.32, so the ringing after a knock ends sooner.
* `m=0.4kg`: Four times the mass halves the natural frequency. The handle feels heavier when you shake it.
"""

import hapticlab as hl

scene = hl.library.mass_spring_damper()

paddle = hl.SimulatedPaddle.from_profile(hl.library.nominal, hand=hl.Hand("pinch"))
hl.share(scene, paddle, "mass_spring_damper.html", sliders={"k": (0, 500), "b": (0, 3), "m": (0.05, 0.5)})
