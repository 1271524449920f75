"""The figure of a trade-off: error against load, both logarithmic, a line for each method."""

from collections import Counter

from ...base.drawing import FRAME, house_style, log_scales, new_figure, style_of
from .tradeoff_rows import TOO_LARGE

MARKERS = {"zoh": "s", "foh": "^", "soh": "o"}
#: with a force of the period's end or mean a marker has a bar through it
BARRED = {"before": None, "after": "|", "mean": "_"}
#: an error of nothing at all is drawn here
LEAST = 1e-12
#: why a setting is not allowed
WORDS = {
    "margin": "near its longest stable step", "contact": "too few steps in a contact", "passive": "not passive on this device",
    "encoder": "the encoder is too coarse", "doubt": "the reference is too rough", "held": "the hold errs too much",
    "size": "too large for the board",
}  # fmt: skip
#: of a scene without a name
UNNAMED = "scene"
#: panels beside each other
ACROSS = 2


def plot_work_precision(tradeoff, targets=None, asked=None):
    """Draw the error of the force against the load of the target, a panel for each.

    A marker is a setting, its shape the hold, filled where stability, contacts, passivity and the board allow it, with a
    black edge where its numbers are float64; the legend says what most of the hollow ones lack. A line goes along the
    settings of one method that none of its others beats. Dashed: the error that the encoder alone makes.

    Parameters
    ----------
    tradeoff : Tradeoff
    targets : sequence of str, optional
    asked : Asked
        What decides which markers are filled, and where tolerance and load are drawn.

    Returns
    -------
    matplotlib.figure.Figure
    """
    targets = list(targets or tradeoff.targets)
    shown = {target: [row for row in tradeoff.table if row.target == target and row.ran and row.load > 0] for target in targets}
    methods = list(dict.fromkeys(row.method for rows in shown.values() for row in rows))
    down, across = -(-len(targets) // ACROSS), min(ACROSS, len(targets))
    with house_style():
        figure = new_figure(
            height=1.0 + 3.4 * down + 0.25 * ((len(methods) + 6) // (2 * across) + 1), width=(7.2, 10.6)[across - 1]
        )
        panels = figure.subplots(down, across, sharey=True, squeeze=False).ravel()
        for axes, target in zip(panels, targets, strict=False):
            _panel(axes, shown[target], methods, asked)
            _asked(axes, _places(shown[target])[0], _places([row for rows in shown.values() for row in rows])[1], asked)
        for axes in panels[len(targets) :]:
            axes.set_visible(False)
        for axes in panels[::across]:
            axes.set_ylabel("greatest error of the force [% of its peak]")
        named = "" if tradeoff.name == UNNAMED else f"{tradeoff.name}: "
        figure.suptitle(f"{named}error against load{f', on {targets[0]}' if len(targets) == 1 else ''}", fontsize="medium")
        if len(targets) > 1:
            for axes, target in zip(panels, targets, strict=False):
                axes.set_title(f"on {target}", fontsize="medium")
        _legend(figure, panels[0], methods, [row for rows in shown.values() for row in rows], asked)
    return figure


def _panel(axes, rows, methods, asked):
    for number, method in enumerate(methods):
        own, style = [row for row in rows if row.method == method], style_of(number)
        best = front(own)
        axes.plot(*_places(best), **style, linewidth=1.2, zorder=2)
        for row in own:
            allowed = not _excess(row, asked)
            axes.plot(
                *_places([row]), MARKERS[row.hold], color=style["color"], markersize=6, zorder=3,
                markerfacecolor=style["color"] if allowed else "white", markeredgewidth=0.8,
                markeredgecolor="black" if row.precision == "float64" else style["color"],
            )  # fmt: skip
            if BARRED[row.force_at]:
                axes.plot(*_places([row]), BARRED[row.force_at], color="black", markersize=8, zorder=4)
    _sensor(axes, {row.T: row.sensor_floor for row in rows if row.sensor_floor > 0})
    axes.set(xlabel="load [% of the period]")


def _asked(axes, loads, errors, asked):
    """Draw what is asked for, or name it at the edge where no marker is within a decade: an empty one tells nothing."""
    for side, many, wanted, line in (("x", loads, asked.load, axes.axvline), ("y", errors, asked.tolerance, axes.axhline)):
        low, high = (min(many) / 2, max(many) * 2) if many else (100 * wanted / 3, 300 * wanted)
        if low / 10 < 100 * wanted < 10 * high:
            line(100 * wanted, color="black", linestyle=":", linewidth=1.0, zorder=1)
            low, high = min(low, 50 * wanted), max(high, 200 * wanted)
        else:
            far = "right" if side == "x" else "above"
            place = {"x": ((0.99, 0.02), "right", "bottom"), "y": ((0.01, 0.99), "left", "top")}[side]
            text = f"asked for: {100 * wanted:g} %, far {far if 100 * wanted > high else 'left' if side == 'x' else 'below'}"
            style = {"ha": place[1], "va": place[2], "fontsize": "x-small", "color": "#4d4d4d"}
            axes.annotate(text, place[0], xycoords="axes fraction", **style)
        axes.set(**{f"{side}lim": (low, high)})
    log_scales(axes)


def _sensor(axes, floors):
    """Draw what the encoder alone makes of error at each period, those that lie near each other under one label."""
    labels = []
    for T, floor in sorted(floors.items(), key=lambda item: item[1]):
        axes.axhline(100 * floor, color="#4d4d4d", linestyle="--", linewidth=1.0, zorder=1)
        if labels and floor < 1.6 * labels[-1][0]:
            labels[-1][:] = [floor, [*labels[-1][1], T]]
        else:
            labels.append([floor, [T]])
    for floor, periods in labels:
        text = "sensor at " + ", ".join(f"{T * 1e3:g}" for T in sorted(periods)) + " ms"
        style = {"ha": "right", "va": "bottom", "fontsize": "x-small", "color": "#4d4d4d"}
        axes.annotate(text, (0.995, 100 * floor), xycoords=("axes fraction", "data"), annotation_clip=True, **style)


def front(rows):
    """Return the rows that none of them beats in both load and error, cheapest first."""
    found = []
    for row in sorted(rows, key=lambda row: (row.load, row.err_max)):
        if not found or row.err_max < found[-1].err_max:
            found.append(row)
    return found


def _places(rows):
    return [100 * row.load for row in rows], [100 * max(row.err_max, LEAST) for row in rows]


def _forbidden(rows, asked):
    """Yield what most of the hollow markers lack."""
    lacking = Counter(WORDS[next(iter(found))] for row in rows if (found := _excess(row, asked)))
    for word, _ in lacking.most_common(1):
        yield f"hollow: {word}{' and others' if len(lacking) > 1 else ''}"


def _excess(row, asked):
    """Return what a row misses beside tolerance and load."""
    missed = [name for name in asked.excess(row) if name not in ("tolerance", "load")]
    return missed or (["size"] if row.status == TOO_LARGE else [])


def _legend(figure, axes, methods, rows, asked):
    """Tell lines and markers apart below the panels."""

    def sign(label, **style):
        return axes.plot([], [], label=label, **style)[0]

    signs = [sign(method, **style_of(number)) for number, method in enumerate(methods)]
    grey = {"color": "#8a8a8a", "linestyle": "", "markersize": 6}
    signs += [sign(f"hold {hold}", marker=mark, **grey) for hold, mark in MARKERS.items() if hold in {row.hold for row in rows}]
    signs += [sign(words, marker="o", markerfacecolor="white", **grey) for words in _forbidden(rows, asked)]
    if any(row.precision == "float64" for row in rows):
        signs += [sign("black edge: float64", marker="o", markeredgecolor="black", **grey)]
    signs += [sign("asked for: left of and below it", color="black", linestyle=":")]
    figure.legend(handles=signs, loc="outside lower center", ncols=2 if len(figure.axes) == 1 else 4, fontsize="small", **FRAME)
