"""The first picture of a scene as SVG, for where a page's scripts do not run: the preview of a mail program, a printed page."""

from html import escape

from ...library.parts import primitives

WIDE = 720  # units of the drawing across the picture
_ARROW = 9.0  # length of an arrow's head, in these units


def still(items, box, words):
    """Return a picture as an ``<svg>`` element; its labels are left out.

    Parameters
    ----------
    items : sequence of items, as :mod:`hapticlab.library.display_list` lists them
    box : (left, right, bottom, top)
        What is shown [m].
    words : str
        What it shows, for who does not see it.

    Examples
    --------
    >>> line = ("line", [(0.0, 0.0), (0.05, 0.02)], {"colour": "#000000", "width": 1.5, "dash": ()})
    >>> still([line], (0.0, 0.1, 0.0, 0.04), "a line").splitlines()[2]
    '<polyline points="0,288 360,144" fill="none" stroke="#000000" stroke-width="1.5"/>'
    """
    left, right, bottom, top = box
    scale = WIDE / (right - left)
    high = scale * (top - bottom)
    parts = [
        f'<svg class="hl-still" role="img" aria-label="{escape(words)}" viewBox="0 0 {WIDE} {high:g}">',
        f'<rect width="{WIDE}" height="{high:g}" fill="#ffffff"/>',
    ]
    for kind, points, style in primitives(items, 0.0):
        if kind in _DRAWN:
            parts.append(_DRAWN[kind]([(scale * (x - left), scale * (top - y)) for x, y in points], style))
    return "\n".join([*parts, "</svg>"])


def _line(points, style):
    dash = f' stroke-dasharray="{" ".join(f"{part:g}" for part in style["dash"])}"' if style["dash"] else ""
    return f'<polyline points="{_text(points)}" fill="none" stroke="{style["colour"]}" stroke-width="{style["width"]:g}"{dash}/>'


def _area(points, style):
    return f'<polygon points="{_text(points)}" fill="{style["fill"]}" stroke="{style.get("edge") or "none"}" stroke-width="1.4"/>'


def _arrow(points, style):
    (x, y), (u, v) = points
    long = ((u - x) ** 2 + (v - y) ** 2) ** 0.5 or 1.0
    along, across = ((u - x) * _ARROW / long, (v - y) * _ARROW / long), ((y - v) * _ARROW / long / 3, (u - x) * _ARROW / long / 3)
    sides = [(u - along[0] + side * across[0], v - along[1] + side * across[1]) for side in (1, -1)]
    shaft = _line(points, {"colour": style["colour"], "width": 1.4, "dash": ()})
    return shaft + f'<polygon points="{_text([(u, v), *sides])}" fill="{style["colour"]}"/>'


def _text(points):
    return " ".join(f"{round(x, 1):g},{round(y, 1):g}" for x, y in points)


_DRAWN = {"line": _line, "area": _area, "arrow": _arrow}
