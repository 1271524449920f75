"""Texture

One half of the path is rough, although nothing moves sideways but the force.

Labs: 17

* `p_2=3mm`: Both gratings now have the same pitch, and the surface feels ribbed instead of rough.
* `A=0.05N`: Half the force is half the height that a finger seems to feel.
"""

import hapticlab as hl

scene = hl.library.texture()

paddle = hl.SimulatedPaddle.from_profile(hl.library.nominal, hand=hl.Hand("pinch"))
hl.share(scene, paddle, "texture.html")
