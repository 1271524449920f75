"""A display list on matplotlib's axes: what a still picture shows of it, each label where nothing else is."""

import math

import numpy as np

from ...library.parts import primitives

#: of a figure at most [inches]
WIDE, HIGH = 7.2, 3.0
LETTERS = {"fontsize": 11, "ha": "center", "va": "center", "zorder": 9, "clip_on": False}
#: directions about what is named, from where its label belongs [degrees]; farther ones where all are taken
AROUND, FARTHER = (0, 45, -45, 90, -90, 135, -135, 180), (1.0, 1.6, 2.4, 3.4)
#: a name that finds no room on what it names stands so far beside it [px]
NEAR = 20.0


def paint(figure, items, box, F=math.nan, title=""):
    """Draw items on a new pair of axes, and fit the figure to them.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
    items : sequence of items, as hapticlab.library.display_list lists them
    box : (left, right, bottom, top)
        What is shown [m]; more where something reaches farther.
    F : float
        Force on the environment [N], for the colours and the motor's arrow.
    title : str
    """
    axes = figure.subplots()
    axes.axis("off")
    (left, right), (bottom, top) = _limits(items, *box)
    items = primitives(items, F)
    axes.set(xlim=(left, right), ylim=(bottom, top), aspect="equal")
    axes.set_title(title, fontsize="small")
    figure.set_size_inches(WIDE, min(WIDE * (top - bottom) / (right - left), HIGH) + 0.35)
    for order, (kind, points, style) in enumerate(items):
        xs, ys = zip(*points, strict=True)
        if kind == "line":
            dash = (0, style["dash"]) if style["dash"] else "-"
            axes.plot(xs, ys, color=style["colour"], linewidth=style["width"], linestyle=dash, zorder=2 + 1e-3 * order)
        elif kind == "area":
            edge = style.get("edge") or "none"
            axes.fill(xs, ys, facecolor=style["fill"], edgecolor=edge, linewidth=1.4, zorder=2 + 1e-3 * order)
        elif kind == "arrow":
            look = {"arrowstyle": "-|>", "color": style["colour"], "linewidth": 1.4, "shrinkA": 0, "shrinkB": 0}
            axes.annotate("", points[1], points[0], arrowprops=look, zorder=8)
    _name(figure, axes, items)


def _limits(items, left, right, bottom, top):
    """What is shown: the frame, and more where something reaches farther, but for what has no end."""
    ended = primitives([item for item in items if item[0] not in ("track", "wall")])
    reach = np.concatenate([[(left, bottom), (right, top)], *(points for _, points, _ in ended)])
    spare, frame = 0.01 * (right - left), ((left, right), (bottom, top))
    return [
        (min(low, mine.min() - spare), max(high, mine.max() + spare)) for (low, high), mine in zip(frame, reach.T, strict=True)
    ]


def _name(figure, axes, items):
    """Write the labels, each at the best place that covers no other and the fewest lines."""
    figure.draw_without_rendering()  # from here on a place in metres is one in pixels
    change, taken = axes.transData, []
    lines = [change.transform(points) for kind, points, _ in items if kind != "label"]
    segments = np.concatenate([np.hstack([line[:-1], line[1:]]) for line in lines]) if lines else np.zeros((0, 4))
    for kind, points, style in items:
        if kind == "label":
            text = axes.text(*points[1], style["words"], color=style["colour"], **LETTERS)
            box, (anchor, wanted) = text.get_window_extent(), change.transform(points)
            half = np.array([box.width, box.height]) / 2 + 1.5
            places = [place for place in _around(anchor, wanted) if _inside(place, half, figure.bbox, axes.bbox.y1)] or [wanted]
            clear = [place for place in places if not any(_overlap(place, half, *other) for other in taken)] or places
            best = min(clear, key=lambda place: crossed(segments, place, half))
            text.set_position(change.inverted().transform(best))
            taken.append((best, half))


def _around(anchor, wanted):
    """Yield places for a label, the best first."""
    yield wanted
    way = wanted - anchor
    reach, first = max(np.hypot(*way), NEAR), math.atan2(way[1], way[0]) if way.any() else math.pi / 2
    for times in FARTHER:
        for turn in np.radians(AROUND):
            yield anchor + times * reach * np.array([math.cos(first + turn), math.sin(first + turn)])


def _inside(place, half, frame, top):
    return bool(np.all(place - half >= (frame.x0, frame.y0)) and np.all(place + half <= (frame.x1, top)))


def _overlap(place, half, other, reach):
    return bool(np.all(np.abs(place - other) < half + reach))


def crossed(segments, place, half):
    """Return how many segments (x1, y1, x2, y2) go through a box of these half sizes about a place.

    Examples
    --------
    >>> lines = np.array([[0.0, 0.0, 4.0, 4.0], [0.0, 3.0, 1.0, 4.0]])
    >>> crossed(lines, np.array([2.0, 2.0]), np.array([0.5, 0.5]))
    1
    """
    start, end = segments[:, :2] - place, segments[:, 2:] - place
    beside = np.any((np.minimum(start, end) > half) | (np.maximum(start, end) < -half), axis=1)
    corners = half * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    way = end - start
    side = way[:, None, 0] * (corners[:, 1] - start[:, None, 1]) - way[:, None, 1] * (corners[:, 0] - start[:, None, 0])
    return int(np.sum(~beside & ~(np.all(side > 0, axis=1) | np.all(side < 0, axis=1))))
