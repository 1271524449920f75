"""A ball on a spring contact

The ball of the library with a penalty contact: a spring acts while ball and plate overlap. Any method of integration can run it,
on a board as well.

What it teaches: a stiff contact lasts a few steps only. If the contact lasts too few steps, the method adds energy. The contact
by an impulse on the page [Ball on the paddle](ball_on_the_paddle.md) needs no step that is short enough.

Labs: 08

* `k_b=150N/m`: A soft contact: the ball dips visibly into the plate.
* `k_b=1000N/m`: A stiffer contact is shorter, and each bounce is felt as a knock.
"""

import hapticlab as hl

k_b = hl.parameters("k_b", units="N/m", values=500)
scene = hl.library.ball_on_the_paddle(hl.contact.penalty(k=k_b))

paddle = hl.SimulatedPaddle.from_profile(hl.library.nominal, hand=hl.Hand("pinch"))
hl.share(scene, paddle, "penalty_ball.html", method="semi_implicit_euler")
