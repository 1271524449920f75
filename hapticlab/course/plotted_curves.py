"""Answers that are plots: the curves of a matplotlib figure, in SI by the units of its axis labels.

What matplotlib makes is asked for its curves and never drawn, so nothing of matplotlib opens here.
"""

import re

import numpy as np

from ..base.units import dimension, quantity, si_name
from ..errors import UnitsError
from .plain_values import NotPlain, a, numbers

#: more curves than any exercise asks for: one of very many would fit whatever is expected
MOST_CURVES = 16
#: what stands around a unit at the end of a label, "x [mm]", "x (mm)", "x / mm"
UNIT = re.compile(r"(?:\[([^\[\]]*)\]|\(([^()]*)\)|\s/\s*([^\s\[\]()]+))\s*$")
#: where a unit is looked for in turn: a bracket that stands alone, "k [N/m], log scale" (that of "x[n] (mm)" does not); the end
PLACES = re.compile(r"(?:^|\s)\[([^\[\]]*)\]"), UNIT, re.compile(r"\[([^\[\]]*)\]")
RAISED = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻⁺−", "0123456789-+-")


def curves(answer):
    """Return the curves of a figure or of axes, in SI.

    Parameters
    ----------
    answer : matplotlib Figure or Axes, or a list of Axes; of a tuple such as (figure, axes) the figure

    Returns
    -------
    dict of str to dict
        "curve 1" to ``x``, ``y`` (lists of float), ``x_unit``, ``y_unit`` (SI; empty where a label has none), ``x_label``,
        ``y_label`` and ``label``.

    Raises
    ------
    NotPlain
        It is something else, holds no curve or too many, or a unit is not known.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().subplots()
    >>> _ = axes.plot([0, 1], [2.0, 5.0]), axes.set(xlabel="position x [mm]", ylabel="force F [N]")
    >>> found = curves(axes)["curve 1"]
    >>> found["x"], found["y"], found["x_unit"], found["y_unit"]
    ([0.0, 0.001], [2.0, 5.0], 'm', 'N')
    """
    found = [curve for axes in _axes(answer) for curve in _of_axes(axes)]
    if not found:
        raise NotPlain("it contains no curve; draw one with axes.plot(...)")
    if len(found) > MOST_CURVES:
        raise NotPlain(f"it contains {len(found)} curves; needs at most {MOST_CURVES}")
    return {f"curve {number}": curve for number, curve in enumerate(found, start=1)}


def _axes(answer):
    """Return the axes of whatever was answered."""
    if isinstance(answer, list | tuple):
        answer = next((one for one in answer if isinstance(getattr(one, "axes", None), list)), answer)
    if hasattr(answer, "get_lines"):
        return [answer]
    several = getattr(answer, "axes", answer)
    several = list(several.flat) if isinstance(several, np.ndarray) else several
    if not isinstance(several, list | tuple) or not all(hasattr(one, "get_lines") for one in several):
        raise NotPlain(f"it is {a(answer)}, needs a matplotlib Figure or Axes")
    return list(several)


def _of_axes(axes):
    """Yield the lines and the scattered points of axes."""
    drawn = [(line.get_xydata(), line) for line in axes.get_lines() if line.get_transform().contains_branch(axes.transData)]
    drawn += [(part.get_offsets(), part) for part in axes.collections if np.size(part.get_offsets()) > 2]
    labels = {side: _label(axes, side) for side in "xy"}
    scales = {side: _unit(labels[side], side) for side in "xy"} if drawn else {}
    for points, artist in drawn:
        x, y = np.ma.filled(np.ma.asarray(points, float), np.nan).T
        yield {
            "label": str(artist.get_label())[:60],
            **{f"{side}_label": labels[side][:60] for side in "xy"},
            **{f"{side}_unit": scales[side][1] for side in "xy"},
            "x": numbers(x * scales["x"][0]),
            "y": numbers(y * scales["y"][0]),
        }


def _label(axes, side):
    """Return an axis's label; panels that share the axis, or a whole figure, may have it in one place."""
    sharing = [axes, *getattr(axes, f"get_shared_{side}_axes")().get_siblings(axes)]
    several = [getattr(one, f"get_{side}label")() for one in sharing]
    return str(next((label for label in several if label), getattr(axes.figure, f"get_sup{side}label")()))


def _unit(label, side):
    """Return (factor to SI, SI unit) of an axis label; (1, "") where it names no unit."""
    label = re.sub(r"\\mu\s*|[µμ]", "u", re.sub(r"\\mathrm|[${}]", "", label))
    label = re.sub("[⁻⁺]?[⁰¹²³⁴-⁹]+", lambda raised: f"^{raised.group()}", label).translate(RAISED)
    found = [match for place in PLACES if (match := place.search(label))]
    problems = []
    for text in (next(part.strip() for part in match.groups() if part is not None) for match in found):
        if text in ("", "-", "1"):
            return 1.0, "1" if text else ""
        try:
            factor, unit = quantity(f"1 {text}", f"the label of its {side} axis")
            return factor, si_name(dimension(unit))
        except UnitsError as problem:
            problems.append(problem)
    if problems:
        raise NotPlain(f"the {side} axis is labelled {label[:60]!r}: {problems[0]}")
    return 1.0, ""
