"""Moving pictures in the browser's code: the face is at x, springs end at their bodies, no label covers another."""

import sys

import numpy as np
import pytest
from lab import REPOSITORY

from hapticlab.widgets.picture import moving_picture

sys.path.insert(0, str(REPOSITORY / "tests" / "benchmarks"))
from gallery import browser_page, draw, scenes

SCENES = scenes()
#: of a stage beside traces, of one alone, and of a flat one [px]
SIZES = ((440, 220), (840, 220), (640, 150))


@pytest.fixture(scope="module")
def page(browser):
    page = browser_page(browser)
    yield page
    page.close()


def positions(scene, count):
    """Yield a picture and states of it: the handle anywhere, bodies within 20 mm of it, angles of up to 1 rad."""
    picture, random = moving_picture(scene), np.random.default_rng(5)
    low, high = picture.reach
    for _ in range(count):
        x = random.uniform(0.8 * low, 0.8 * high)
        near = {name: x + random.uniform(-0.02, 0.02) for name, q in picture.channels.items() if q.unit == "m"}
        turned = {name: random.uniform(-1, 1) for name, q in picture.channels.items() if q.unit == "rad"}
        hand = {"F": random.uniform(-5, 5), "intent": random.uniform(low, high)}
        yield picture, {**dict(scene.values), **near, **turned, "x": x, **hand}


def overlaps(placed):
    """Return pairs of labels that cover each other."""
    return [(a["words"], b["words"]) for k, a in enumerate(placed) for b in placed[k + 1 :] if meet(a, b)]


def meet(a, b):
    """Tell whether two boxes have a point in common."""
    return a["left"] < b["right"] and b["left"] < a["right"] and a["top"] < b["bottom"] and b["top"] < a["bottom"]


@pytest.mark.parametrize("name", [pytest.param(n, marks=[] if n == "gears" else pytest.mark.wide) for n in SCENES])
def test_no_label_covers_another_wherever_things_are(page, name):
    lost = total = 0
    for wide, high in SIZES:
        for picture, state in positions(SCENES[name], 12):
            told = draw(page, picture, state, wide=wide, high=high)
            placed = told["placed"]
            assert overlaps(placed) == []
            for label in placed:
                assert label["left"] >= 0 and label["right"] <= wide and label["top"] >= 0 and label["bottom"] <= high - 20
            lost, total = lost + told["waiting"] - len(placed), total + told["waiting"]
    assert lost <= 0.02 * total  # a label that finds no place at all is left out


def columns(page, colour, row):
    """Return the first column of a row of the canvas that has a colour, and the one after the last [px]."""
    found = page.evaluate(
        """([colour, row]) => {
            const canvas = document.querySelector("canvas")
            const { data } = canvas.getContext("2d").getImageData(0, row, canvas.width, 1)
            const off = (x) => colour.reduce((sum, part, k) => sum + Math.abs(data[4 * x + k] - part), 0)
            return Array.from({ length: canvas.width }, (_, x) => x).filter((x) => off(x) < 24)
        }""",
        [colour, row],
    )
    return min(found), max(found) + 1


HANDLE, WALL = (0x3F, 0x55, 0x63), (0xE9, 0xEB, 0xEE)


@pytest.mark.parametrize(("x", "x_o", "side"), [(0.004, 0.01, 1), (0.01, 0.01, 1), (0.013, 0.01, 1), (-0.012, -0.01, -1)])
def test_the_handles_face_is_at_x_and_the_wall_gives_as_far_as_it_is_inside(page, x, x_o, side):
    scene = SCENES["a wall" if side > 0 else "a wall on the left"](x_o=abs(x_o))
    picture = moving_picture(scene)
    told = draw(page, picture, {**dict(scene.values), "x": x, "F": 0.0, "intent": x})
    left, right, bottom, top = picture.box
    scale = min(840 / (right - left), 200 / (top - bottom))  # the place of x by this test's own arithmetic
    at = 840 / 2 + scale * (x - (left + right) / 2)
    row = round(told["base"]) + 8
    face = columns(page, HANDLE, row)[side > 0]
    assert abs(face - at) <= 1.5
    rim = columns(page, WALL, row)[side < 0]
    boundary = 840 / 2 + scale * (x_o - (left + right) / 2)
    deepest = max(at, boundary) if side > 0 else min(at, boundary)
    assert abs(rim - deepest) <= 3.5  # the line of the rim is 2.5 px wide


def test_a_body_that_left_the_picture_is_marked_at_the_rim_and_a_longer_rod_widens_the_frame(page):
    scene = SCENES["a mass of one's own"]
    picture = moving_picture(scene)
    state = {**dict(scene.values), "x": 0.0, "F": 0.0, "intent": 0.0}
    beyond = [label["words"] for label in draw(page, picture, {**state, "z": 0.4})["placed"] if "farther" in label["words"]]
    assert len(beyond) == 1 and beyond[0].startswith("$z$ is ") and beyond[0].endswith(" mm farther out")
    assert not [label for label in draw(page, picture, {**state, "z": 0.0})["placed"] if "farther" in label["words"]]
    swing = SCENES["a pendulum of one's own"]
    picture = moving_picture(swing)
    state = {**dict(swing.values), "x": 0.0, "z": 0.0, "theta": 0.3, "F": 0.0, "intent": 0.0}
    short, long = (draw(page, picture, {**state, "l": l}) for l in (0.15, 0.4))
    assert long["scale"] < 0.6 * short["scale"]
    assert not [label for label in long["placed"] if "farther" in label["words"]]
