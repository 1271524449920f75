"""Drawings of wirings show every wire of the record at both ends, and the files of the owner's guide are these drawings."""

import re
from pathlib import Path
from xml.etree import ElementTree

import pytest

import hapticlab as hl
from hapticlab.course.drawings import pen
from hapticlab.course.drawings.wiring import BOARD, COLOURS, HEADERS, PART
from hapticlab.course.drawings.wiring_files import wiring_svg
from hapticlab.device.wiring import Wiring
from hapticlab.device.wirings import BUILDS, built_as

FILES = Path(__file__).parents[2] / "docs/paddle/images/wiring"


def level_words(axes, x, side):
    """Return the words that end (or begin) at an edge, by their height."""
    return {round(t.get_position()[1], 6): t.get_text() for t in axes.texts if abs(t.get_position()[0] - x - side * 0.15) < 1e-6}


@pytest.mark.always("l298")
@pytest.mark.parametrize("name", BUILDS)
def test_every_wire_of_the_record_is_drawn_between_its_two_ends(name):
    (axes,) = hl.devices.drawing(f"wiring {name}").plot().axes
    at_board, at_part = level_words(axes, BOARD[1], -1), level_words(axes, PART[0], 1)
    drawn = []
    for one in axes.lines:
        xs, ys = one.get_data()
        if list(xs) == [BOARD[1], PART[0]] and ys[0] == ys[1]:
            drawn.append((at_board[round(ys[0], 6)], at_part[round(ys[0], 6)], one.get_color(), one.get_linestyle() == "--"))
    wires = [one for one in BUILDS[name].wires() if one.begin[0] == "board"]
    assert drawn == [(one.begin[1], one.end[1], COLOURS[one.carries], one.fixed) for one in wires]
    right = [t.get_text() for t in axes.texts if abs(t.get_position()[0] - PART[1] + 0.15) < 1e-6]
    power = [one for one in BUILDS[name].wires() if one.begin[0] != "board"]
    assert sorted(right) == sorted(one.begin[1] if one.begin[0] == "driver" else one.end[1] for one in power)
    texts = [t.get_text() for t in axes.texts]
    assert {"fuse", "switch", "motor", "supply"} <= set(texts)
    assert texts.count("10 k\N{GREEK CAPITAL LETTER OMEGA}") == len(BUILDS[name].held_low())


@pytest.mark.parametrize("board", HEADERS)
def test_the_header_of_a_board_has_every_pin_that_a_wiring_may_use(board):
    from hapticlab.compiler.boards.board_pins import PINS

    printed = [name for row in HEADERS[board] for name in row]
    for pin in PINS[board].names.values():
        assert printed.count(pin) == 1, pin
    assert PINS[board].supply in printed


def test_a_filled_pin_of_the_board_is_one_that_a_person_wires():
    """The driver of a shield is plugged in: its pins stay empty, those of the encoder are filled."""
    (axes,) = hl.devices.drawing("wiring motor_shield").plot().axes
    filled = {tuple(one.get_data()[0]) for one in axes.lines if one.get_marker() == "s" and one.get_fillstyle() == "full"}
    named = {(t.get_position()[0],): t.get_text() for t in axes.texts}
    assert sorted(named[at] for at in filled) == ["5V", "D2", "D3", "GND", "GND", "GND"]


@pytest.mark.always("hapkit", "l298")
@pytest.mark.parametrize("name", BUILDS)
def test_the_file_of_the_guide_is_this_drawing(name):
    """Compared by words and places, not by bytes: another matplotlib writes other bytes."""
    kept, now = ((FILES / f"{name}.svg").read_text("utf-8"), wiring_svg(BUILDS[name]))
    assert places(kept) == places(now), (
        "write the files again: python -m hapticlab.course.drawings.wiring_files docs/paddle/images/wiring"
    )
    root = ElementTree.fromstring(kept)
    assert root[1].text.startswith("Wiring: ") and all(" ".join(one.end) in root[2].text for one in BUILDS[name].wires())
    assert set(re.findall(r"#[0-9a-f]{6}\b", kept)) <= {pen.WARM, pen.COLD, pen.GREY, "#1b1b1b", "#e8e8e8", "#ffffff"}


def places(text):
    root = ElementTree.fromstring(text)
    return [
        ("".join(part.itertext()).strip(), round(float(part.get("x")), 1), round(float(part.get("y")), 1))
        for part in root.iter("{http://www.w3.org/2000/svg}text")
    ]


def test_a_wiring_of_ones_own_has_a_drawing_too():
    own = built_as("uno", Wiring("MAGNETORESISTIVE", "TWO_INPUTS", (3, 11), (14,)))
    words = wiring_svg(own)
    assert own.name == "own" and all(f">{pin}<" in words for pin in ("D3", "D11", "A0", "IN2"))
