"""The picture of a wall map: four regions in four greys of one colour, and the lines of the theory on them."""

import numpy as np

from ..drawing import axis_label, house_style, new_figure, outline, scale_axis

#: light to dark, so that grey print keeps their order
COLOURS = ("#eef4d4", "#a9cfa0", "#4f93a8", "#2b2f5c")
LINES = {
    "passivity": ("passivity, any passive hand", "black", (0, (6, 2))),
    "stability": ("exact linear stability, this hand", "black", "-"),
    "abbott_okamura": ("Abbott and Okamura, any hand", "#c1440e", (0, (4, 1, 1, 1))),
    "diolaiti": ("Diolaiti, any hand", "#c1440e", (0, (3, 1, 1, 1, 1, 1))),
    "gil": ("Gil, this hand", "#c1440e", (0, (1, 1))),
}


def plot_wall_map(found):
    """Draw a map's regions, and the lines of passivity and exact stability.

    Parameters
    ----------
    found : WallMap

    Returns
    -------
    matplotlib.figure.Figure
    """
    (across, K), (up, other) = found.axes.items()
    x_scale, x_label = axis_label(across, found.units[across])
    y_scale, y_label = axis_label(up, found.units[up])
    shades = np.array([[int(c[i : i + 2], 16) / 255 for i in (1, 3, 5)] for c in COLOURS])
    with house_style():
        figure = new_figure(height=5.6)
        axes = figure.subplots()
        axes.pcolormesh(x_scale * K, y_scale * other, shades[found.regions.T], shading="nearest", rasterized=True)
        names = ("passive", "stable, not passive", "chatters", f"unusable: swings over {1e3 * found.unusable:g} mm")
        patch = {"marker": "s", "linestyle": "none", "markersize": 11, "markeredgecolor": "#808080"}
        for number, (colour, name) in enumerate(zip(COLOURS, names, strict=True)):
            if (found.regions == number).any():
                axes.plot([], [], color=colour, label=name, **patch)
        for name in found.limits:
            (label, colour, dash), limit = LINES[name], found.limit(name)
            shown = np.where(limit > K[-1], np.nan, limit)
            if np.isfinite(shown).sum() > 1:
                edge = [outline(3.6)]
                axes.plot(x_scale * shown, y_scale * found.rows, color=colour, linestyle=dash, path_effects=edge, label=label)
        axes.set(xlabel=x_label, ylabel=y_label)
        scale_axis(axes, "x", x_scale * K)
        scale_axis(axes, "y", y_scale * other)
        axes.set(xlim=(x_scale * K[0], x_scale * K[-1]), ylim=(y_scale * other[0], y_scale * other[-1]))
        axes.grid(False)
        axes.set_title(found.about.splitlines()[0], fontsize="small")
        figure.legend(fontsize="small", loc="outside lower center", ncols=3)
    return figure
