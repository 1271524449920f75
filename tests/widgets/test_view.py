"""Sliders without a browser: ipywidgets alone, moved as a mouse moves them."""

import sys
import threading
from copy import copy
from dataclasses import replace

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.analysis.walls.wall_map import WallMaps
from hapticlab.errors import AnalysisError, EngineMissingError
from hapticlab.widgets.view import MapView, explore

PADDLE = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, coulomb=0.02, hand=hl.Hand(m=0.02, b=0.5, push=1.0))
SMALL = {"K": [100.0, 500.0, 2000.0], "B": [0.0, 0.1], "duration": 0.2}


@pytest.fixture(scope="module")
def maps():
    return WallMaps(PADDLE, **SMALL)


@pytest.fixture
def view(maps):
    pytest.importorskip("ipywidgets")
    pytest.importorskip("matplotlib")
    made = MapView(PADDLE, copy(maps))
    assert made.wait(60), made.text.value
    return made


@pytest.mark.always("threads")
def test_the_map_follows_its_sliders(both, view):
    np.testing.assert_array_equal(view.map.regions, hl.stability.wall_map(PADDLE, **SMALL).regions)
    first = bytes(view.image.value)
    view.set(b=0.3, hand_b=1.5, coulomb=0.06)
    assert view.wait(60)
    moved = replace(PADDLE, b=0.3, coulomb=0.06, hand=replace(PADDLE.hand, b=1.5))
    assert view.paddle.b == pytest.approx(0.3) and view.paddle.hand.b == pytest.approx(1.5)
    np.testing.assert_array_equal(view.map.regions, hl.stability.wall_map(moved, **SMALL).regions)
    assert view.image.value[:8] == b"\x89PNG\r\n\x1a\n" and view.image.value != first
    now, first = (hl.stability_limit(paddle).K for paddle in (moved, PADDLE))
    assert f"exact linear stability up to {now:.5g} N/m, at first {first:.5g} N/m" in view.text.value
    assert "passivity in any hand up to 600 N/m, at first 200 N/m" in view.text.value  # 2 b/T


def test_a_slider_of_the_period_compiles_nothing():
    pytest.importorskip("ipywidgets")
    pytest.importorskip("matplotlib")
    moved = explore(PADDLE, sliders={"T": (0.5e-3, 2e-3), "hand_push": (0.5, 2.0)}, **SMALL)
    assert moved.wait(60)
    kept = set(moved.maps.runs._loaded)
    moved.set(T=0.75e-3, hand_push=1.5)
    assert moved.wait(60) and moved.paddle.T == pytest.approx(0.75e-3) and set(moved.maps.runs._loaded) == kept
    expected = hl.stability.wall_map(moved.paddle, **SMALL)
    np.testing.assert_array_equal(moved.map.regions, expected.regions)
    np.testing.assert_array_equal(moved.map.limit("stability"), expected.limit("stability"))


@pytest.mark.wide
def test_no_queue_piles_up(view):
    """While the first map is held up, a hundred places of the slider pass; one map more is made, of the last of them."""
    made, go, begun, draw = [], threading.Event(), threading.Event(), view.maps.of

    def slow(paddle):
        begun.set()
        assert go.wait(10)
        made.append(paddle.b)
        return draw(paddle)

    view.maps.of = slow
    view.set(b=0.1 * 1.5)
    assert begun.wait(10)
    for b in np.linspace(0.05, 0.25, 100):
        view.set(b=b)
    go.set()
    assert view.wait(60)
    assert made == [pytest.approx(0.15), pytest.approx(0.25, abs=0.005)]


def test_what_goes_wrong_is_shown(view):
    def broken(paddle):
        raise AnalysisError("this was given; <that> is needed")

    view.maps.of = broken
    view.set(b=0.2)
    assert view.wait(60) and "no map:</b> this was given; &lt;that&gt; is needed" in view.text.value


def test_it_begins_at_the_paddles_own_values_on_a_step_of_each_slider(view):
    for name, own in (("m", 0.05), ("b", 0.1), ("delay", 0.0), ("coulomb", 0.02), ("hand_m", 0.02), ("hand_b", 0.5)):
        slider = view.sliders[name]
        steps = (slider.value - slider.min) / slider.step
        assert slider.value == own and steps == pytest.approx(round(steps), abs=1e-9)


def test_more_than_three_sliders_fold(view):
    shown, folded = view.box.children[:2], view.box.children[2]
    assert [slider.description[:1] for slider in shown] == ["m", "b"]
    (more,) = folded.children
    assert len(more.children) == 4 and folded.selected_index is None and "coulomb [N]" in folded.titles[0]


def test_the_default_map_shows_both_borders():
    pytest.importorskip("ipywidgets")
    held = replace(PADDLE, coulomb=0.0)
    made = explore(held, sliders={"b": (0.05, 0.3)}, points=12, duration=0.1)
    assert made.wait(60), made.text.value
    K = made.map.axes["K"]
    assert K[0] < 200 < hl.stability_limit(held).K < K[-1]  # 200 = 2 b/T
    assert min(made.map.share(region) for region in ("passive", "stable")) > 0.02
    assert made.map.share("chatters") + made.map.share("unusable") > 0.05
    figure = made._picture.figure
    assert 110 * figure.get_size_inches()[1] < 450


def test_a_notebook_shows_it(view):
    bundle = view._repr_mimebundle_()
    assert "application/vnd.jupyter.widget-view+json" in (bundle[0] if isinstance(bundle, tuple) else bundle)
    assert list(view.sliders) == ["m", "b", "delay", "coulomb", "hand_m", "hand_b"]
    assert view.sliders["b"].description == "b [N s/m]" and view.sliders["b"].continuous_update


@pytest.mark.parametrize(
    ("sliders", "words"),
    [
        ({"colour": (0, 1)}, "Give one of B?"),
        ({"B": (0, 1)}, "B is not a quantity that a slider can move"),
        ({"counts_per_metre": (1e3, 1e4)}, "has no counts_per_metre"),
        ({"b": (1, 1)}, "low < high"),
        ({"b": 0.3}, r"b = 0.3; a slider needs \(low, high\)"),
        ({"b": ("low", 1)}, "two numbers in N s/m"),
        (["b"], "needs a dict of name to"),
    ],
)
def test_sliders_that_move_nothing_are_refused(sliders, words):
    pytest.importorskip("ipywidgets")
    with pytest.raises(AnalysisError, match=words.replace("B?", "")):
        explore(PADDLE, sliders=sliders, **SMALL)


def test_an_axis_is_no_slider():
    pytest.importorskip("ipywidgets")
    with pytest.raises(AnalysisError, match="b is an axis"):
        explore(PADDLE, sliders={"b": (0, 1)}, over=("K", "b"), K=[1.0, 2.0], b=[0.1, 0.2], duration=0.2)


def test_without_ipywidgets_it_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "ipywidgets", None)
    with pytest.raises(EngineMissingError, match="pip install ipywidgets"):
        explore(PADDLE, **SMALL)
