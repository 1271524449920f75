"""The picture of a wall map: four regions in four greys of one colour, and the lines of the theory on them."""

from textwrap import wrap

import numpy as np

from ...base.drawing import WARM, axis_label, house_style, new_figure, outline, scale_axis

#: light to dark, so that grey print keeps their order
COLOURS = ("#eef4d4", "#a9cfa0", "#4f93a8", "#2b2f5c")
#: what an axis of a map alone may be
LABELS = {
    "hand_m": "mass of the hand", "hand_b": "damping of the hand", "coulomb": "Coulomb friction", "counts_per_metre": "encoder",
    "sensor_delay": "lag of the sensor",
}  # fmt: skip
SHADES = np.array([[int(c[i : i + 2], 16) / 255 for i in (1, 3, 5)] for c in COLOURS])
LINES = {
    "passivity": ("passivity, any passive hand", "black", (0, (6, 2))),
    "stability": ("exact linear stability, this hand", "black", "-"),
    "abbott_okamura": ("Abbott and Okamura, any hand", WARM, (0, (4, 1, 1, 1))),
    "diolaiti": ("Diolaiti, any hand", WARM, (0, (3, 1, 1, 1, 1, 1))),
    "gil": ("Gil, this hand", WARM, (0, (1, 1))),
}


def plot_wall_map(found):
    """Draw a map's regions, and the lines of passivity, of exact stability and of the bounds asked for.

    Parameters
    ----------
    found : WallMap

    Returns
    -------
    matplotlib.figure.Figure
    """
    return WallMapPicture(found).figure


class WallMapPicture:
    """The figure of a map, which another map over the same axes may be drawn into.

    Parameters
    ----------
    found : WallMap
    every : bool
        Name every region and line in the legend, whether this map has it or not: another one may. The legend then stands
        beside the map, for room below a row of sliders.
    """

    def __init__(self, found, every=False):
        (across, K), (up, other) = found.axes.items()
        self.x_scale, x_label = axis_label(across, found.units[across])
        self.y_scale, y_label = axis_label(LABELS.get(up, up), found.units[up])
        self.start, self.edge = self.x_scale * K[0], K[-1]
        with house_style():
            self.figure = new_figure(height=3.7, width=8.4) if every else new_figure(height=5.6)
            axes = self.figure.subplots()
            x, y = self.x_scale * K, self.y_scale * other
            self.mesh = axes.pcolormesh(x, y, SHADES[found.regions.T], shading="nearest", rasterized=True)
            _name_regions(axes, found, every)
            self.lines = {name: self._line(axes, found, name, every) for name in found.limits}
            axes.set(xlabel=x_label, ylabel=y_label)
            scale_axis(axes, "x", x)
            scale_axis(axes, "y", y)
            axes.set(xlim=(x[0], x[-1]), ylim=(y[0], y[-1]))
            axes.grid(False)
            words = [found.about.splitlines()[0], f"colour: a simulated contact of {found.duration:g} s per cell; lines: theory"]
            axes.set_title("\n".join([*words, *([] if every else wrap(found.beyond_words, 84))]), fontsize="small")
            place = {"loc": "outside right upper"} if every else {"loc": "outside lower center", "ncols": 2}
            self.figure.legend(fontsize="small", **place)

    def show(self, found):
        """Draw another map in place of the one shown; where its labels stay, they are not laid out again."""
        self.figure.set_layout_engine("none")
        self.mesh.set_array(SHADES[found.regions.T])
        for name, line in self.lines.items():
            line.set_data(*self._curve(found, name))

    def _line(self, axes, found, name, every):
        label, colour, dash = LINES[name]
        x, y = self._curve(found, name)
        shown = np.isfinite(x).sum() > 1 and np.nanmax(x) >= self.start
        label = label if every or shown else None
        return axes.plot(x, y, color=colour, linestyle=dash, path_effects=[outline(3.6)], label=label)[0]

    def _curve(self, found, name):
        limit = found.limit(name)
        return self.x_scale * np.where(limit > self.edge, np.nan, limit), self.y_scale * found.rows


def _name_regions(axes, found, every):
    """Put the colours of the regions into the legend."""
    passive = "passive, the spring always acting" if found.inside_only else "passive"
    stable = "stable, not passive" if "passivity" in found.limits else "stable"
    names = (passive, stable, "chatters", f"unusable: oscillates by more than {1e3 * found.unusable:g} mm")
    patch = {"marker": "s", "linestyle": "none", "markersize": 11, "markeredgecolor": "#808080"}
    for number, (colour, name) in enumerate(zip(COLOURS, names, strict=True)):
        if every or (found.regions == number).any():
            axes.plot([], [], color=colour, label=name, **patch)
