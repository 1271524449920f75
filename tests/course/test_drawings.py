"""Drawings that explain: readable in light and dark, whole, and right about who pushes whom."""

import re
from xml.etree import ElementTree

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.course.drawings import pen
from hapticlab.course.drawings.drawing import SHEETS


@pytest.mark.always("paddle", "loop", "signs")
@pytest.mark.parametrize("name", SHEETS)
def test_a_page_shows_a_drawing_in_its_own_colour_and_with_words(name):
    drawn = hl.devices.drawing(name)
    shown, about = drawn._repr_mimebundle_()
    figure = ElementTree.fromstring(shown["text/html"])
    image = figure[0]
    assert image.tag == "svg"
    assert "<style" not in shown["text/html"], "a style in it is one of the whole notebook"
    assert {part.get("stroke-linejoin") for part in image.iter("g")} == {"round", None}, "the joins that the style gave"
    assert image.get("role") == "img" and image.get("aria-label") == drawn.alt == about["image/png"]["alt"]
    assert drawn.title in "".join(figure.itertext()) and drawn.alt in shown["text/plain"]
    colours = set(re.findall(r"#[0-9a-f]{6}", shown["text/html"]))
    assert colours <= {pen.WARM, pen.COLD, pen.GREY}, "all else is drawn in the colour of the page's text"
    assert len(shown["text/html"]) < (100_000 if name.startswith("wiring") else 60_000)  # a wiring has three times the words


@pytest.mark.parametrize("colour", [pen.WARM, pen.COLD, pen.GREY])
@pytest.mark.parametrize("page", ["#ffffff", "#111111"])
def test_colours_are_seen_on_a_light_page_and_on_a_dark_one(colour, page):
    bright, dim = sorted((luminance(colour), luminance(page)), reverse=True)
    assert (bright + 0.05) / (dim + 0.05) >= 3  # WCAG 2.2, 1.4.11


def luminance(colour):
    """Return the relative luminance of WCAG."""
    parts = np.array([int(colour[k : k + 2], 16) for k in (1, 3, 5)]) / 255
    return np.where(parts <= 0.04045, parts / 12.92, ((parts + 0.055) / 1.055) ** 2.4) @ [0.2126, 0.7152, 0.0722]


@pytest.mark.always("paddle", "drive", "wiring pico_as5048a")
@pytest.mark.parametrize("name", SHEETS)
def test_no_word_lies_beyond_the_sheet_or_on_another(name):
    figure = hl.devices.drawing(name).plot()
    (axes,) = figure.axes
    figure.draw_without_rendering()
    boxes = {text.get_text(): text.get_window_extent() for text in axes.texts if text.get_text()}
    width, height = figure.get_size_inches() * figure.dpi
    for words, box in boxes.items():
        assert box.x0 >= 0 and box.y0 >= 0 and box.x1 <= width and box.y1 <= height, words
        assert not [other for other, place in boxes.items() if other != words and place.overlaps(box)], words


def test_the_motor_pushes_the_handle_against_the_force_on_the_environment():
    (axes,) = hl.devices.drawing("signs").plot().axes
    arrows = {tuple(one.arrow_patch.get_edgecolor()): one for one in axes.texts if not one.get_text()}
    ways = {colour: one.xy[0] - one.xyann[0] for colour, one in arrows.items()}
    rgba = lambda colour: (*(int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5)), 1)  # noqa: E731
    assert ways[rgba(pen.COLD)] > 0 > ways[rgba(pen.WARM)], "F_e, and -F_e"


def test_the_held_force_begins_each_period_on_the_ideal_one():
    (axes,) = hl.devices.drawing("sample_and_hold").plot().axes
    ideal = next(one for one in axes.lines if one.get_linestyle() == "--" and len(one.get_xdata()) > 2)
    held = next(one for one in axes.lines if one.get_color() == pen.WARM and len(one.get_xdata()) > 2)
    times, forces = held.get_data()
    assert np.diff(times)[::2] == pytest.approx(1), "held for one period"
    assert np.ptp(np.reshape(forces[:-1], (-1, 2)), axis=1) == pytest.approx(0)
    assert forces[:-1:2] == pytest.approx(np.interp(times[:-1:2], *ideal.get_data()))
    assert (forces[2:6] < np.interp(times[2:6] + 1e-3, *ideal.get_data())).all(), "below it on the way in"


def test_a_wrong_name_is_answered_with_those_there_are():
    with pytest.raises(hl.HapticlabError, match="'lop' is not a drawing; there are paddle, drive, loop, sample_and_hold, signs"):
        hl.devices.drawing("lop")
    with pytest.raises(hl.HapticlabError, match=r"\[\] is not a drawing; there are paddle"):
        hl.devices.drawing([])
