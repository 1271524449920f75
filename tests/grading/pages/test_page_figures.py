"""Figures of the pages stand where their numbers are."""

import re

import numpy as np

from hapticlab.course.cards.chart import bounded, chart


def test_a_figure_stands_where_its_numbers_are():
    """Marks of the picture, mapped back by two ticks on each axis, are the numbers again."""
    x, y = np.array([0.0, 1.0, 2.5, 4.0]), np.array([-3.0, 8.5, 2.25, 40.0])
    svg = chart({"expected": (x, y), "got": (x, np.array([1.0, np.nan, 2.0, 3.0]))}, ("t [s]", "F [N]"), "words")
    marks = np.array(re.findall(r'<circle cx="([\d.]+)" cy="([\d.]+)"', svg)[:4], float)
    up = np.array(re.findall(r'y="([\d.]+)" text-anchor="end">([-\d.]+)<', svg), float) - [4.0, 0.0]
    across = np.array(re.findall(r'<text x="([\d.]+)" y="210" text-anchor="middle">([-\d.]+)<', svg), float)
    assert np.allclose(np.polyval(np.polyfit(*across.T, 1), marks[:, 0]), x, atol=0.01)
    assert np.allclose(np.polyval(np.polyfit(*up.T, 1), marks[:, 1]), y, atol=0.05)
    (course,) = re.findall(r'<path d="([^"]*)" fill="none" stroke="#cc5a1a"', svg.split("got")[0].split("expected")[1])[:1]
    assert course.count("M") == 2 and course.count("L") == 1, "a gap where there is no number"
    assert np.isnan(bounded(np.array([np.inf, np.nan]))).all()


def test_a_long_line_keeps_its_peaks():
    y = np.zeros(50_000)
    y[31_234], y[7] = 5.0, -2.0
    svg = chart({"expected": (np.arange(50_000.0), y)}, ("sample", "F [N]"), "words")
    assert len(svg) < 30_000
    heights = {float(h) for h in re.findall(r"[ML][\d.]+,([\d.]+)", max(re.findall('d="([^"]*)"', svg), key=len))}
    ticks = np.array(re.findall(r'y="([\d.]+)" text-anchor="end">([-\d.]+)<', svg), float) - [4.0, 0.0]
    seen = np.polyval(np.polyfit(*ticks.T, 1), sorted(heights))
    assert np.isclose(seen.max(), 5.0, atol=0.02) and np.isclose(seen.min(), -2.0, atol=0.02)
