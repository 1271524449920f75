"""The alternative text of a figure: what a reader who does not see it is told, from its axes, lines, bars and legends."""

import re

import numpy as np

from .shows_itself import upper


def describe(figure):
    """Alternative text of a figure: titles, axes with their ranges, and the course of each line.

    Examples
    --------
    >>> from hapticlab.base.drawing import new_figure
    >>> figure = new_figure(height=2)
    >>> axes = figure.subplots()
    >>> _ = axes.plot([0, 1, 2], [5, 3, 1])
    >>> _ = axes.set(xlabel="time t [s]", ylabel="height [m]")
    >>> describe(figure)
    'Height [m] over time t [s], 0 to 2: falls from 5 to 1.'
    """
    panels = [axes for axes in figure.axes if axes.get_label() != "<colorbar>" and axes.get_visible()]
    scales = [axes for axes in figure.axes if axes.get_label() == "<colorbar>"]
    told = [_panel(axes) for axes in panels]
    if len(told) > 1:
        told = [f"Panel {number} of {len(told)}: {text}" for number, text in enumerate(told, 1)]
    told += [_sentence(f"Colour: {_span(axes, 'y')}") for axes in scales]
    told += [_legend(figure.legends, panels)]
    return " ".join(filter(None, [_sentence(figure.get_suptitle()), *told]))


def _panel(axes):
    """Alternative text of one pair of axes."""
    title = _sentence(axes.get_title())
    if not axes.axison:
        named = dict.fromkeys(_plain(text.get_text()) for text in axes.texts if text.get_text())
        return " ".join(filter(None, [title, _sentence(f"a drawing: {', '.join(named)}")]))
    told = [_course(axes, line) for line in axes.lines]
    for bars in axes.containers:
        told += _bars(axes, bars)
    told = list(dict.fromkeys(filter(None, told)))
    across, up = _span(axes, "x"), _span(axes, "y")
    if any(getattr(bars, "orientation", "") == "horizontal" for bars in axes.containers):
        text = across
    else:
        text = f"{up.split(', ')[0] if told and axes.lines else up} over {across}"
    text += (": " if told else "") + "; ".join(told)
    marked = dict.fromkeys(word for word in (_plain(one.get_text()) for one in axes.texts) if re.search("[a-zA-Z]{3}", word))
    marked = [word for word in marked if word not in text and word not in {_plain(line.get_label()) for line in axes.lines}]
    marked = _sentence(f"Marked: {', '.join(marked)}") if marked else ""
    return " ".join(filter(None, [title, _sentence(text), marked, _legend([axes.get_legend()], [axes])]))


def _span(axes, side):
    """Return the label of one side with its range, or the words at its ticks."""
    peers = getattr(axes, f"get_shared_{side}_axes")().get_siblings(axes)
    labels = [getattr(peer, f"get_{side}label")() for peer in (axes, *peers)]
    label = _plain(next(filter(None, [*labels, getattr(axes.figure, f"get_sup{side}label")()]), ""))
    words = [_plain(text.get_text()) for text in getattr(axes, f"get_{side}ticklabels")()]
    words = [word for word in words if re.search("[a-zA-Z]{2}", word)]
    if words:
        return f"{label or 'cases'}, {', '.join(words)}"
    ends = [end for line in axes.lines if line.get_transform() == axes.transData for end in _ends(line, side)]
    low, high = sorted(getattr(axes, f"get_{side}lim")())
    if side == "x" and ends and not _is_map(axes):
        low, high = max(low, min(ends)), min(high, max(ends))
    return f"{label or 'values'}, {low:.3g} to {high:.3g}"


def _is_map(axes):
    """Whether axes hold an image or a mesh of values, which fills them, beyond the lines over it."""
    return any(part.get_array() is not None for part in (*axes.images, *axes.collections))


def _ends(line, side):
    values = np.asarray(line.get_data(orig=False)["xy".index(side)], float)
    values = values[np.isfinite(values)]
    return (values.min(), values.max()) if len(values) else ()


def _course(axes, line):
    """The course of one line in words; nothing for what only guides the eye."""
    name, (xs, ys) = _plain(line.get_label()), (np.asarray(part, float) for part in line.get_data(orig=False))
    guide = name.startswith("_")
    if line.get_transform() != axes.transData:  # drawn right across: a level, or a place
        side, at = ("y", ys[0]) if np.ptp(ys) == 0 else ("x", xs[0])
        return "" if guide else f"{name}: {side} at {at:.3g}"
    left, right = sorted(axes.get_xlim())
    known = np.isfinite(xs) & np.isfinite(ys) & (left <= xs) & (xs <= right)
    xs, ys = xs[known], np.where(abs(ys[known]) < 1e-9 * np.ptp(axes.get_ylim()), 0.0, ys[known])
    alone = sum(not _plain(other.get_label()).startswith("_") for other in axes.lines) == 0 and len(axes.lines) <= 2
    if (guide and not alone) or not line.get_xdata(orig=False).size:
        return ""
    name = "" if guide else f"{name}: "
    if not np.isfinite(line.get_ydata(orig=False)).any():
        return f"{name}not known anywhere"
    if not len(ys):
        return ""
    if len(ys) == 1:
        return f"{name}at {xs[0]:.3g}, {ys[0]:.3g}"
    if line.get_linestyle() == "None":
        return f"{name}{_points(ys)}"
    if (np.diff(xs) < 0).any() and (np.diff(xs) > 0).any():
        return f"{name}a curve" if name else ""
    return name + _trend(ys)


def _points(ys):
    if len(ys) <= 6:
        return f"points at {', '.join(f'{y:.3g}' for y in ys)}"
    return f"{len(ys)} points between {ys.min():.3g} and {ys.max():.3g}"


def _trend(ys):
    rises, falls = (np.diff(ys) >= 0).all(), (np.diff(ys) <= 0).all()
    if rises and falls:
        return f"stays at {ys[0]:.3g}"
    if rises or falls:
        return f"{'rises' if rises else 'falls'} from {ys[0]:.3g} to {ys[-1]:.3g}"
    return f"from {ys[0]:.3g} to {ys[-1]:.3g}, between {ys.min():.3g} and {ys.max():.3g}"


def _bars(axes, container):
    """Return the lengths of bars, each with the word at its foot."""
    bars, flat = getattr(container, "patches", ()), getattr(container, "orientation", "") == "horizontal"
    axis = axes.yaxis if flat else axes.xaxis
    feet = dict(zip(axis.get_ticklocs(), (_plain(text.get_text()) for text in axis.get_ticklabels()), strict=False))
    told = []
    for bar in bars:
        at, length = (bar.get_y(), bar.get_width()) if flat else (bar.get_x(), bar.get_height())
        middle = at + (bar.get_height() if flat else bar.get_width()) / 2
        foot = min(feet, key=lambda place: abs(place - middle), default=None)
        told.append(f"{feet.get(foot, '')} {length:.3g}".strip())
    return told


def _legend(legends, panels):
    """Names in legends beyond those that the lines were told by."""
    told = {_plain(line.get_label()) for axes in panels for line in axes.lines}
    words = [_plain(text.get_text()) for legend in legends if legend for text in legend.get_texts()]
    words = [word for word in dict.fromkeys(words) if word not in told]
    return _sentence(f"also shown: {', '.join(words)}") if words else ""


def _plain(words):
    """Return a text without typesetting."""
    return " ".join(re.sub(r"[${}\\]|mathdefault", "", words).split())


def _sentence(words):
    words = _plain(words)
    return upper(words).rstrip(".") + "." if words else ""
