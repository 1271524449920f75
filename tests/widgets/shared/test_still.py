import re
from xml.etree import ElementTree

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.library.parts import primitives
from hapticlab.widgets.shared.still import WIDE, still
from hapticlab.widgets.stage import Stage

PADDLE = hl.SimulatedPaddle(m=0.05, b=0.3, T=1e-3, hand=hl.Hand("pinch"))


@pytest.mark.parametrize(
    "scene", [hl.library.four_bar(), hl.library.texture(), hl.wall()(k=300, x_o=0.01)], ids=lambda scene: scene.name
)
@pytest.mark.always("texture", "zoh wall")
def test_a_still_picture_has_the_places_of_the_first_picture(scene):
    stage = Stage(PADDLE, scene, clock=lambda: 0.0)
    items, box = stage.drawn(None), stage.picture.box
    svg = ElementTree.fromstring(still(items, box, 'a "<picture>"'))
    assert svg.get("aria-label") == 'a "<picture>"' and not [one for one in svg.iter() if "style" in one.attrib]
    drawn = [points for kind, points, _ in primitives(items, 0.0) if kind != "label"]
    heads = [one for one in svg.iter("polygon") if one.get("stroke") is None]
    shapes = [one for one in svg if one.tag in ("polyline", "polygon") and one not in heads]
    assert len(shapes) == len(drawn) > 2
    scale = WIDE / (box[1] - box[0])
    for shape, points in zip(shapes, drawn, strict=True):
        there = np.array(re.findall(r"[-\de.]+", shape.get("points")), float).reshape(-1, 2)
        metres = there / scale * [1, -1] + [box[0], box[3]]
        assert np.allclose(metres, points, rtol=1e-5, atol=0.06 / scale)
