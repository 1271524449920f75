"""hl.plot of plain curves: the numbers given, in the house style, with words for who cannot see them."""

import numpy as np
import pytest

import hapticlab as hl
from hapticlab.base.drawing import STYLES
from hapticlab.course.plotted_curves import curves

pytest.importorskip("matplotlib")
K = np.array([40.0, 160.0, 640.0])


def test_curves_hold_the_numbers_given():
    figure = hl.plot({"pinch": (K, 2 * K), "free": (K, 3 * K, "both")}, xlabel="stiffness K [N/mm]", ylabel="force F [N]")
    pinch, free = curves(figure).values()  # the reader of students' figures
    np.testing.assert_allclose([pinch["x"], pinch["y"], free["y"]], [1e3 * K, 2 * K, 3 * K], rtol=1e-15)
    assert (pinch["label"], pinch["x_unit"], pinch["y_unit"]) == ("pinch", "N/m", "N")
    (axes,) = figure.axes
    assert [line.get_color() for line in axes.lines] == [style["color"] for style in STYLES[:2]]
    assert [line.get_marker() for line in axes.lines] == ["None", "s"]
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["pinch", "free"]


def test_labels_may_be_numbers():
    figure = hl.plot({100: (K, K), 200: (K, 2 * K)}, at_x={160: 160})
    assert [text.get_text() for text in figure.axes[0].get_legend().get_texts()] == ["100", "200"]
    two = hl.plot({1: {100: (K, K)}, 2: {100: (K, -K)}})
    assert [axes.get_title(loc="left") for axes in two.axes] == ["1", "2"] and figure._repr_png_() and two._repr_png_()


def test_points_and_intervals():
    figure = hl.plot({"": (["once", "twice"], [3.0, 5.0], "points", [0.5, 0.1])}, ylabel="beta [1/s]")
    (axes,) = figure.axes
    assert axes.lines[0].get_linestyle() == "None" and axes.get_legend() is None
    ends = sorted(end for part in axes.collections for segment in part.get_segments() for end in segment[:, 1])
    np.testing.assert_allclose(ends, [2.5, 3.5, 4.9, 5.1])
    assert "once, twice: beta: points at 3, 5" in figure._repr_mimebundle_()[0]["text/plain"]


@pytest.mark.parametrize("log", ["", "x", "y", "xy"])
def test_scales(log):
    (axes,) = hl.plot({"law": (K, K**2)}, log=log).axes
    assert [axes.get_xscale() == "log", axes.get_yscale() == "log"] == ["x" in log, "y" in log]


def test_places_and_ranges_are_marked_in_words():
    figure = hl.plot({"free": (K, K)}, at_x={"design limit": 160}, at_y={"inside": (0, 50)}, xlim=(0, 700))
    (axes,) = figure.axes
    assert list(axes.lines[1].get_xdata()) == [160, 160] and axes.get_xlim() == (0, 700)
    told = figure._repr_mimebundle_()[0]["text/plain"]
    assert "design limit: x at 160" in told and "Marked: inside." in told
    assert hl.plot({"free": (K, K)}, alt="All alike.")._repr_mimebundle_()[0]["text/plain"] == "All alike."


def test_panels_share_their_axes_and_one_legend():
    figure = hl.plot({law: {"ball": (K, K), "plate": (K, -K)} for law in ("penalty", "impulse")}, xlabel="t", ylabel="height")
    above, below = figure.axes
    assert above.get_ylim() == below.get_ylim() and above.get_xlim() == below.get_xlim()
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["ball", "plate"]
    assert [axes.get_title(loc="left") for axes in figure.axes] == ["penalty", "impulse"]


def test_panels_of_one_curve_each_need_no_names():
    figure = hl.plot({"A": {"": ([0, 1], [0, 1])}, "B": {"": ([0, 1], [1, 0])}}, xlabel="a", ylabel="b")
    assert [axes.get_title(loc="left") for axes in figure.axes] == ["A", "B"] and not figure.legends


def test_long_names_stand_below_the_axes():
    (axes,) = (figure := hl.plot({"a name of the law that is long " * 2: (K, K), "and another " * 4: (K, -K)})).axes
    assert axes.get_legend() is None and len(figure.legends) == 1


@pytest.mark.parametrize(
    ("given", "options", "words"),
    [
        ({}, {}, r"plot of \{\}; needs a record, log = paddle.run\(...\), or curves"),
        ({"a": [1, 2]}, {}, r"curve 'a': \[1, 2\]; needs \{\"label\": \(xs, ys\)\}"),
        ({"a": (K, K[:2])}, {}, r"curve 'a' has shapes \(3,\) and \(2,\); needs one list of numbers each"),
        ({"a": (K, "abc")}, {}, "curve 'a' holds something else than numbers"),
        ({"a": (K, K, "dots")}, {}, "how of curve 'a' = 'dots'; needs one of line, points, both"),
        ({"a": (K, K)}, {"log": "z"}, "log = 'z'; needs"),
        ({"a": (K, K)}, {"over": "x"}, "plot of curves has no over="),
        ({"a": (K, K), "b": {"c": (K, K)}}, {}, "curves beside panels"),
        ({"a": (K, K, "points", [1, -2, 3])}, {}, "curve 'a' has a half width of -2; half widths need to be 0 or more"),
        ({"$x_{$": (K, K)}, {}, r"'\$x_\{\$' has a formula between dollar signs that matplotlib cannot typeset \(.*\). Close"),
        ({"a": (K, K)}, {"title": r"$\nothing$"}, r"nothing\$' has a formula between .* \(.*Unknown symbol: .nothing"),
        ({"a": (K, K)}, {"at_x": 3}, r"at_x = 3; needs words and their place on the axis: at_x=\{'limit': 200\}"),
        ({"a": (K, K)}, {"at_y": {"w": (1,)}}, r"at_y\['w'\] = \(1,\); needs two numbers, \(low, high\)"),
        ({"a": (K, K)}, {"at_y": {"w": "here"}}, r"at_y\['w'\] = 'here'; needs a finite at_y\['w'\]. Give a number"),
        ({"a": (K, K)}, {"xlim": 5}, r"xlim = 5; needs two numbers, \(low, high\)"),
        ({"a": (K, K)}, {"ylim": (0, np.inf)}, "high end of ylim = inf; needs a finite end"),
        ({"a": (K, K)}, {"height": -1}, r"height = -1; a figure needs height \[inch\] > 0 and <= 50"),
        ({"a": (K, K)}, {"xlabl": "K"}, "plot of curves has no xlabl=; it takes xlabel=, ylabel=, log=, title=, at_x="),
    ],
)
def test_what_is_no_curve_is_refused(given, options, words):
    with pytest.raises(hl.errors.AnalysisError, match=words):
        hl.plot(given, **options)
