"""The figure of several designs: error and passivity margin against load."""

from ...base.drawing import COLD, WARM, house_style, new_figure, plain_log

#: of each panel: the place among (error, load, margin), and the label of its axis
PANELS = (
    (0, "error at the handle [%]", "below and to the left is better"),
    (2, "passivity margin [N s/m]", "above and to the left is better"),
)


def plot_front(found):
    """Draw designs as circles, filled where no other one dominates them, and reference points as crosses with letters."""
    front = found.front
    with house_style():
        figure = new_figure(height=3.9, width=9.6)
        for axes, (place, label, better) in zip(figure.subplots(1, 2), PANELS, strict=True):
            for name, one in found.designs.items():
                if one.feasible:
                    inside = COLD if name in front else "white"
                    at = one.load, one.figures[place]
                    axes.plot(*at, "o", color=COLD, markerfacecolor=inside, markersize=7, zorder=3)
                    _named(axes, name, at, COLD)
            for name, figures in found.reference_points.items():
                at = figures[1], figures[place]
                axes.plot(*at, "x", color=WARM, markersize=7, zorder=2)
                _named(axes, name, at, WARM, below=True)
            if place == 0:
                plain_log(axes, "y")
            else:
                axes.axhline(0, color="black", linewidth=0.8, linestyle=":", zorder=1)
            axes.margins(0.1)
            axes.set(xlabel="load of the board [%]", ylabel=label)
            axes.set_title(better, fontsize="small")
        figure.suptitle(f"{found.task.name}: filled circles are on the front, crosses are reference points", fontsize="medium")
    figure.alt = _in_words(found, front)
    return figure


def _named(axes, name, at, colour, below=False):
    away = (4, -10) if below else (4, 4)
    axes.annotate(name, at, away, textcoords="offset points", fontsize="x-small", color=colour, zorder=4)


def _in_words(found, front):
    """Return what the figure shows, for who cannot see it."""
    said = [f"{name}: {one}{', on the front' if name in front else ''}" for name, one in found.designs.items()]
    said += [
        f"reference point {name}: error {error:.3g} %, load {load:.3g} %, margin {margin:.3g} N s/m"
        for name, (error, load, margin) in found.reference_points.items()
    ]
    return f"Designs of the task {found.task.name}. " + "; ".join(said)
