"""Scenes to feel at once on the first page: files of hl.share, which run without Python."""

import tempfile
from pathlib import Path

from ..device.hand.hand import Hand
from ..device.simulated.simulated_paddle import SimulatedPaddle
from ..library.entries import CATALOGUE, NOMINAL
from ..scene.laws import chapter_laws
from ..widgets.shared.share import share


def wall():
    """Return the page of a virtual wall, with its stiffness on a slider."""
    paddle = SimulatedPaddle.from_profile("hapkit", hand=Hand("pinch"))
    return _shared(chapter_laws.wall()(k=300, x_o=0.01), paddle, sliders={"k": (50, 1500)})


def pendulum():
    """Return the page of a pendulum below the handle."""
    return _of_the_library("pendulum_on_the_handle")


def ball():
    """Return the page of a ball that bounces on the paddle."""
    return _of_the_library("ball_on_the_paddle")


def crank():
    """Return the page of a slider-crank mechanism."""
    return _of_the_library("slider_crank")


def _of_the_library(name):
    entry = CATALOGUE[name]
    options = {key: value for key, value in entry.options.items() if key != "T"}
    paddle = SimulatedPaddle.from_profile(NOMINAL, hand=Hand("pinch"))
    return _shared(entry.scene(), paddle, **options)


def _shared(scene, paddle, **options):
    with tempfile.TemporaryDirectory() as folder:
        return share(scene, paddle, Path(folder, "scene.html"), **options).path.read_text("utf-8")
