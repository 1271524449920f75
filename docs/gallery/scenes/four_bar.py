"""Four-bar linkage

A crank that turns fully swings a rocker. The mass that the handle feels depends on the position.

* `J_4=8e-4kg*m^2`: Four times the inertia of the rocker: the mass is felt where the rocker runs, and almost
  vanishes where the rocker turns round.
* `B=1e-3N*m*s/rad`: With more friction in the joint the linkage stops sooner.
"""

import hapticlab as hl

scene = hl.library.four_bar()

paddle = hl.SimulatedPaddle.from_profile(hl.library.nominal, hand=hl.Hand("pinch"))
hl.share(scene, paddle, "four_bar.html", sliders={"J_4": (1e-4, 1e-3), "B": (0, 2e-3)})
