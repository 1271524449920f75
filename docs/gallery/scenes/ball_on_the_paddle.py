"""Ball on the paddle

Juggle a ball. Each impact is located inside the sampling period.

* `e=0.3`: The ball loses most of its energy in each impact and comes to rest soon.
* `g=1.6m/s^2`: The gravity of the moon: you have time to look.
"""

import hapticlab as hl

scene = hl.library.ball_on_the_paddle()

paddle = hl.SimulatedPaddle.from_profile(hl.library.nominal, hand=hl.Hand("pinch"))
hl.share(scene, paddle, "ball_on_the_paddle.html", sliders={"e": (0, 1), "g": (1, 10), "m": (0.01, 0.1)})
