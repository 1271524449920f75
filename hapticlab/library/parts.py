"""What the parts of a display list look like: lines, areas, arrows and labels, for whatever cannot draw a spring itself.

``hapticlab/widgets/browser/parts.js`` draws the same parts on a canvas.
"""

import math

import numpy as np

from ..base.drawing import COLD, WARM
from .sketch import HANDLE, INK, SOFT, ring

PAPER, MEDIUM = "#ffffff", "#e9ebee"
#: up to how many times the full force an arrow grows
MOST = 1.5
#: the share of the full force below which nothing is coloured or drawn
LEAST = 0.02


def primitives(items, F=math.nan):
    """Return items as lines, areas, arrows and labels alone.

    Parameters
    ----------
    items : sequence of items, as :mod:`hapticlab.library.display_list` lists them
    F : float
        The force on the environment [N]; without one no force is drawn.

    Examples
    --------
    >>> spring = ("spring", [(0.0, 0.0), (0.1, 0.0)], {"coils": 4, "high": 0.01})
    >>> [kind for kind, *_ in primitives([spring])]
    ['line']
    """
    full = next((style.get("full", math.nan) for kind, _, style in items if kind == "force"), math.nan)
    found = []
    for kind, points, style in items:
        if kind in PARTS:
            found += PARTS[kind](points, {**style, "F": F, "full": full})
        elif kind != "frame":
            found.append((kind, points, style))
    return found


def _line(points, colour=INK, width=1.2, dash=()):
    return "line", points, {"colour": colour, "width": width, "dash": dash}


def _area(points, fill, edge=INK):
    return "area", points, {"fill": fill, "edge": edge}


def _frame(start, end):
    """A function from (part of the way from start to end, distance to its left [m]) to a point, and the way's length."""
    (x1, y1), (x2, y2) = start, end
    length = math.hypot(x2 - x1, y2 - y1) or 1e-9
    ax, ay = (x2 - x1) / length, (y2 - y1) / length
    return lambda part, left=0.0: (x1 + part * (x2 - x1) - left * ay, y1 + part * (y2 - y1) + left * ax), length


def force_colour(F, full):
    """Return the colour of what carries a force: from ink at none to orange at the full force, by its root.

    Examples
    --------
    >>> force_colour(0.0, 5.0), force_colour(-5.0, 5.0)
    ('#000000', '#cc5a1a')
    """
    level = math.sqrt(min(abs(F) / full, 1.0)) if math.isfinite(F) and full > 0 else 0.0
    return "#" + "".join(f"{round(level * int(WARM[k : k + 2], 16)):02x}" for k in (1, 3, 5))


def _carried(points, style):
    """Colour of a spring or damper: by the force it carries, where that is known."""
    if style.get("carries") == "F":
        return force_colour(style["F"], style["full"])
    if style.get("k") is not None:
        return force_colour(style["k"] * (math.dist(*points) - style["rest"]), style["full"])
    return INK


def _spring(points, style):
    at, length = _frame(*points)
    high, coils = style["high"], style["coils"]
    lead = min(0.2, 1.5 * high / length)
    turns = [at(lead + (1 - 2 * lead) * (k + 0.5) / (2 * coils), high * (-1) ** k) for k in range(2 * coils)]
    return [_line([points[0], at(lead), *turns, at(1 - lead), points[1]], _carried(points, style))]


def _damper(points, style):
    at, length = _frame(*points)
    high, colour = style["high"], _carried(points, style)
    # the cup keeps its size while the piston's rod gets longer
    cup = min(4.5 * high, 0.6 * length) / length
    begin, end, piston = 0.5 - cup / 2, 0.5 + cup / 2, min(max(0.5 - 0.2 * cup, 0.0), 1.0)
    return [
        _line([points[0], at(begin)], colour),
        _line([at(end, high), at(begin, high), at(begin, -high), at(end, -high)], colour),
        _line([at(piston, 0.7 * high), at(piston, -0.7 * high)], colour, 2.0),
        _line([at(piston), points[1]], colour),
    ]


def _ground(points, style):
    at, length = _frame(*points)
    deep = style["deep"]
    step, hatched = abs(deep), []
    for k in range(1, math.ceil(length / step)):
        hatched += [at(k * step / length), at((k * step - step) / length, -deep), at(k * step / length)]
    return [_line(points, width=1.6), *([_line(hatched, width=0.8)] if hatched else [])]


def _disc(points, style):
    centre, rim = points
    found = [_area(ring(centre, math.dist(centre, rim), 48), style["fill"], style.get("edge", INK))]
    return found + ([_line([centre, rim], SOFT, 1.0)] if style.get("mark") else [])


def _gear(points, style):
    centre, tip = points
    teeth, deep = int(style["teeth"]), style["deep"]
    radius, turn = math.dist(centre, tip) - deep, math.atan2(tip[1] - centre[1], tip[0] - centre[0])
    at = np.linspace(0, 2 * np.pi, 8 * teeth + 1)
    rim = radius + deep * np.clip(3 * np.cos(teeth * (at - turn)), -1, 1)
    return [_area((np.asarray(centre) + rim[:, None] * np.column_stack([np.cos(at), np.sin(at)])).tolist(), style["fill"])]


def dent(depth, face, high):
    """Return the rim of a wall that gives: pairs (how far in, how far along) [m] from -high to high.

    Examples
    --------
    >>> max(dent(0.003, 0.01, 0.02))[0], dent(0.0, 0.01, 0.02)
    (0.003, [(0.0, -0.02), (0.0, 0.02)])
    """
    if depth <= 0:
        return [(0.0, -high), (0.0, high)]
    slope = min(max(1.2 * depth, 0.25 * face), high - face) if high > face else 0.0
    turns = [(face + slope * k / 8, depth * (0.5 + 0.5 * math.cos(math.pi * k / 8))) for k in range(9)]
    right = [(inside, along) for along, inside in turns] + [(0.0, high)]
    return [(inside, -along) for inside, along in reversed(right)] + right


def _wall(points, style):
    place, face, far = points
    at, length = _frame(place, far)
    middle, high = style["middle"], style["high"]
    depth = (face[0] - place[0]) * (far[0] - place[0]) / length + (face[1] - place[1]) * (far[1] - place[1]) / length
    rim = [at(inside / length, along) for inside, along in dent(depth, style["face"], high - abs(middle))]
    rim = [at(0.0, middle - high), *rim, at(0.0, middle + high)]
    colour = force_colour(style["F"] if depth > 0 else 0.0, style["full"])
    return [_area([*rim, at(1.0, middle + high), at(1.0, middle - high)], MEDIUM, ""), _line(rim, colour, 2.5)]


def _track(points, style):
    (left, level), (right, _) = points
    heights = style["heights"]
    rim = [(left + (right - left) * k / (len(heights) - 1), level + height) for k, height in enumerate(heights)]
    return [_area([*rim, (right, level), (left, level)], MEDIUM, ""), _line(rim, width=1.8)]


def _handle(points, style):
    face, back, knob = points
    high, middle = style["high"], ((face[0] + back[0]) / 2, (face[1] + back[1]) / 2)
    at, length = _frame(middle, knob)
    thick = math.dist(face, back)
    blade = high > 0 and thick == 0
    found = [_line([at(high / length) if blade else middle, at(1 - style["round"] / length)], HANDLE, 5.0)]
    if high and not blade:
        # the face's corners, then the back's: of a plate whose face is exactly at x
        corners = [(x + s * (at(high / length)[0] - middle[0]), y + s * (at(high / length)[1] - middle[1]))
                   for (x, y), s in ((face, 1), (face, -1), (back, -1), (back, 1))]  # fmt: skip
        found.append(_area(corners, HANDLE, ""))
    elif blade:
        found.append(_line([at(-high / length), at(high / length)], HANDLE, 2.0))
    return [*found, _area(ring(knob, style["round"], 32), HANDLE, "")]


def _hand(points, style):
    high = 0.45 * style["round"]
    coil = _spring(points, {"high": high, "coils": 7})[0][1] if math.dist(*points) > 0.1 * high else points
    return [_line(coil, COLD, 1.5), _area(ring(points[1], 0.6 * style["round"], 24), PAPER, COLD)]


def _force(points, style):
    (foot, tip), F, full = points, style["F"], style["full"]
    if not math.isfinite(F):
        return []
    level = min(abs(F) / full, MOST)
    end = foot[0] + level * (tip[0] - foot[0]), foot[1] + level * (tip[1] - foot[1])
    away = (tip[0] - foot[0]) + (tip[1] - foot[1])
    tail, head = (foot, end) if -F * away > 0 else (end, foot)
    found = [("arrow", [tail, head], {"colour": force_colour(F, full)})] if level > LEAST else []
    return [*found, ("label", [end, end], {"words": f"motor {abs(F):.1f} N", "colour": INK})]


PARTS = {
    "spring": _spring, "damper": _damper, "ground": _ground, "disc": _disc, "gear": _gear, "wall": _wall, "handle": _handle,
    "hand": _hand, "track": _track, "force": _force,
}  # fmt: skip
