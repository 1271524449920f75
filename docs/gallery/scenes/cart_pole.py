"""Cart and pole

Balance a pole by hand. The force of the cart tells you to which side it leans.

* `l=1m`: A longer pole falls more slowly, with sqrt(g/l) = 3.1 per second instead of 5.7, and is easier to balance.
* `g=1.6m/s^2`: The gravity of the moon gives you more than twice as much time.
"""

import hapticlab as hl

scene = hl.library.cart_pole()

paddle = hl.SimulatedPaddle.from_profile(hl.library.nominal, hand=hl.Hand("pinch"))
hl.share(scene, paddle, "cart_pole.html", sliders={"l": (0.1, 1.5), "g": (1, 10), "m": (0.01, 0.1)})
