"""Figures of plain curves, in the house style: what a lab has computed itself."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

import numpy as np

from ..errors import AnalysisError
from .arguments import choice, number
from .drawing import FRAME, house_style, new_figure, plain_log, style_of, typeset

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike

    How: TypeAlias = Literal["line", "points", "both"]
    #: along x and along y; how it is drawn; half of an interval around each y
    Curve: TypeAlias = (
        tuple[ArrayLike, ArrayLike] | tuple[ArrayLike, ArrayLike, How] | tuple[ArrayLike, ArrayLike, How, ArrayLike]
    )
    #: words -> a place, or the two ends of a range
    Marks: TypeAlias = Mapping[str, float | tuple[float, float]]

HOW, LOG = ("line", "points", "both"), ("", "x", "y", "xy")
POINTS = "os^Dvp"
#: letters of a legend that fit inside a figure, and of a name in a legend of three columns
INSIDE, WIDE = 90, 24
#: of a figure [inch]
TALLEST = 50
SHAPE = '{"label": (xs, ys)}, {"label": (xs, ys, "points")} or {"label": (xs, ys, "points", half_widths)}'
GUIDE = {"color": "#4d4d4d", "linewidth": 1.2, "linestyle": (0, (1, 1.5))}


def draw_curves(curves: Mapping[str, Curve] | Mapping[str, Mapping[str, Curve]], *, xlabel: str = "", ylabel: str = "",
                log: str = "", title: str = "", at_x: Marks | None = None, at_y: Marks | None = None,
                xlim: tuple[float, float] | None = None, ylim: tuple[float, float] | None = None,
                height: float | None = None, alt: str = "") -> Figure:  # fmt: skip
    """Draw curves over common axes, as :func:`hapticlab.plot` describes; a mapping of mappings gives a panel to each."""
    choice("log", log, LOG, need='"x", "y", "xy" or ""')
    if height is not None:
        height = number("height", height, "", "a figure", above=0, most=TALLEST, what="height [inch]")
    limits = {f"{side}lim": _ends(f"{side}lim", ends) for side, ends in (("x", xlim), ("y", ylim)) if ends is not None}
    marks = [(side, *mark) for side, given in (("x", at_x), ("y", at_y)) for mark in _marks(f"at_{side}", given)]
    panels = _panels(curves)
    labels = [label for drawn in panels.values() for label in drawn]
    for words in (xlabel, ylabel, title, *panels, *labels, *(words for _, words, _ in marks)):
        typeset(words)
    handles: dict[str, Any] = {}
    with house_style():
        figure = new_figure(height=height or (3.6 if len(panels) == 1 else 0.8 + 1.3 * len(panels)))
        rows = figure.subplots(len(panels), 1, sharex=True, sharey=True, squeeze=False)[:, 0]
        for axes, (name, drawn) in zip(rows, panels.items(), strict=True):
            for nth, (label, curve) in enumerate(drawn.items()):
                handles.setdefault(label, _draw(axes, nth, label or ylabel, _checked(label, curve)))
            for mark in marks:
                _mark(axes, *mark)
            axes.set_title(name, loc="left", fontsize="small")
            axes.set(**limits)
        for side in log:
            plain_log(rows[0], side)
        rows[-1].set_xlabel(xlabel)
        figure.supylabel(ylabel, fontsize=11) if len(rows) > 1 else rows[0].set_ylabel(ylabel)
        if title:
            figure.suptitle(title, fontsize="medium")
        _legend(figure, rows, {label: handle for label, handle in handles.items() if label})
        figure.alt = alt or None
    return figure


def _panels(curves):
    """Return the curves of each panel by its title."""
    if not isinstance(curves, Mapping) or not curves:
        raise AnalysisError(f"a plot of {curves!r:.60}; needs a record, log = paddle.run(...), or curves: {SHAPE}")
    nested = [isinstance(one, Mapping) for one in curves.values()]
    if any(nested) and not all(nested):
        raise AnalysisError("a plot of curves beside panels; give every curve a panel, or none")
    panels = curves if all(nested) else {"": curves}
    return {str(name): {str(label): curve for label, curve in one.items()} for name, one in panels.items()}


def _marks(name, given):
    """Return pairs of words and a place, or a range, on an axis."""
    if not isinstance(given, Mapping | None):
        raise AnalysisError(f"{name} = {given!r:.60}; needs words and their place on the axis: {name}={{'limit': 200}}")
    places = {str(words): place for words, place in (given or {}).items()}
    return [(words, (_ends if np.ndim(place) else number)(f"{name}[{words!r}]", place)) for words, place in places.items()]


def _ends(name, given):
    """Return the two ends of a range."""
    if np.shape(given) != (2,):
        raise AnalysisError(f"{name} = {given!r:.60}; needs two numbers, (low, high)")
    return tuple(number(f"{side} end of {name}", end, what="end") for side, end in zip(("low", "high"), given, strict=True))


def _checked(label, curve):
    """Return xs, ys, how and half widths of a curve, as arrays; xs may be words."""
    if not isinstance(curve, tuple) or not 2 <= len(curve) <= 4:
        raise AnalysisError(f"curve {label!r}: {curve!r:.60}; needs {SHAPE}")
    how = choice(f"how of curve {label!r}", curve[2], HOW) if len(curve) > 2 else "line"
    try:
        numbers = [np.atleast_1d(np.asarray(part, float)) for part in (curve[1], *curve[3:])]
        x = np.atleast_1d(np.asarray(curve[0]))
        x = x if x.dtype.kind == "U" else np.asarray(x, float)
    except (TypeError, ValueError) as problem:
        raise AnalysisError(f"curve {label!r} holds something else than numbers ({problem}); needs {SHAPE}") from None
    if x.ndim != 1 or any(part.shape != x.shape for part in numbers):
        shapes = " and ".join(str(part.shape) for part in (x, *numbers))
        raise AnalysisError(f"curve {label!r} has shapes {shapes}; needs one list of numbers each, all equally long")
    if len(numbers) > 1 and (numbers[1] < 0).any():
        raise AnalysisError(f"curve {label!r} has a half width of {numbers[1].min():g}; half widths need to be 0 or more")
    return x, numbers[0], how, numbers[1] if len(numbers) > 1 else None


def _draw(axes, nth, label, curve):
    """Draw one curve, with an interval around each point, and return its line."""
    x, y, how, half = curve
    style = style_of(nth) | {"label": label.partition(" [")[0] or "_"}
    if how != "line":
        style |= {"marker": POINTS[nth % len(POINTS)], "markerfacecolor": "white" if len(x) > 1 else style["color"]}
    if how == "points":
        style["linestyle"] = "none"
    (line,) = axes.plot(x, y, **style)
    if half is not None:
        axes.errorbar(x, y, yerr=half, capsize=4, fmt="none", ecolor=style["color"], label="_")
    if x.dtype.kind == "U":
        axes.margins(x=0.2)
    return line


def _mark(axes, side, words, place):
    """Draw a dotted line across at a place, or a band over a range, with words beside it."""
    upright = side == "x"
    if np.ndim(place):
        low, high = place
        (axes.axvspan if upright else axes.axhspan)(low, high, color="#8a8a8a", alpha=0.25, linewidth=0, zorder=0)
    else:
        low = place
        (axes.axvline if upright else axes.axhline)(low, label=words, **GUIDE)
    beside = {"fontsize": "small", "color": "#3d3d3d", "textcoords": "offset points", "annotation_clip": True}
    if upright:
        beside |= {"xy": (low, 1), "xycoords": ("data", "axes fraction"), "xytext": (4, -3), "va": "top"}
    else:
        beside |= {"xy": (1, low), "xycoords": ("axes fraction", "data"), "xytext": (-2, 3), "va": "bottom", "ha": "right"}
    axes.annotate(words, **beside)


def _legend(figure, rows, handles):
    """Put the names of the curves where they cover nothing: inside where they are short, else below."""
    if not handles:
        return
    if len(rows) == 1 and len(handles) <= 4 and sum(map(len, handles)) <= INSIDE:
        rows[0].legend(handles.values(), handles, fontsize="small", **FRAME)
    else:
        columns = 2 if max(map(len, handles)) > WIDE else 3
        figure.legend(handles.values(), handles, loc="outside lower center", ncols=columns, fontsize="small")
