"""Lines as SVG, written at once: a class has thousands, and a matplotlib figure takes a hundred times as long.

Colours are those of the house style; whatever a colour tells is told by a shape or a dash as well.
"""

import math

import numpy as np

from ...base.drawing import COLD, WARM
from .page_text import clean

#: of a picture, and above and below its axes, in pixels
WIDTH, HEIGHT, ABOVE, BELOW = 640, 240, 30, 48
#: more points than these are thinned; fewer than those get a mark each
MOST_POINTS, MARKED = 600, 60
#: labels of axes that count from 0: samples follow one another, points are drawn at random
SAMPLE, POINT = "sample", "point"
GREY, HUGE, TINY = "#767676", 1e290, 1e-290


def chart(lines, labels, alt):
    """One or two lines as SVG.

    Parameters
    ----------
    lines : dict of str to (ndarray, ndarray)
        "expected" and "got", each along x and along y; what is no number leaves a gap.
    labels : tuple of str
        Of the horizontal and the vertical axis; along POINT no line joins the marks.
    alt : str
        What it shows, in words.

    Examples
    --------
    >>> chart({"expected": (np.arange(3.0), np.array([0.0, 1.0, 4.0]))}, ("n", "F [N]"), "rises")[:38]
    '<svg role="img" aria-label="rises" vie'
    """
    lines = {name: tuple(map(bounded, line)) for name, line in lines.items()}
    across, up = (span(several) for several in zip(*lines.values(), strict=True))
    marks = axis_ticks(*up)
    left = 34 + 7.5 * max((len(text) for _, text in marks), default=1)

    def place(many, axis):
        (low, high), (begin, end) = ((across, (left + 8, WIDTH - 12)), (up, (HEIGHT - BELOW, ABOVE)))[axis]
        return begin + (many - low) / (high - low) * (end - begin)

    grid = [_up_tick(place(tick, 1), text, left) for tick, text in marks]
    grid += [_across_tick(place(tick, 0), text) for tick, text in axis_ticks(*across, most=8, whole=labels[0] in (SAMPLE, POINT))]
    grid.append(words((left + WIDTH) / 2, HEIGHT - 8, clean(labels[0], 60)))
    grid.append(words(14, (ABOVE + HEIGHT - BELOW) / 2, clean(labels[1], 40), turned=True))
    joined = labels[0] != POINT
    for k, (name, (x, y)) in enumerate(lines.items()):
        picked = _thinned(y)
        grid.append(_line(name, place(x[picked], 0), place(y[picked], 1), joined))
        grid.append(_key(name, left + 8 + 140 * k, joined))
    return picture(WIDTH, HEIGHT, "".join(grid), alt)


def picture(width, height, inside, alt):
    """An SVG element with the words that stand for it."""
    return f'<svg role="img" aria-label="{clean(alt, 1000)}" viewBox="0 0 {width} {height}" width="{width}">{inside}</svg>'


def words(x, y, escaped, *, anchor="middle", turned=False):
    """Words of a picture at x and y [pixels]; ``anchor`` is what of them is there, turned ones rise."""
    turn = f' transform="rotate(-90 {x:.0f} {y:.0f})"' if turned else ""
    return f'<text x="{round(x, 1):g}" y="{round(y, 1):g}" text-anchor="{anchor}"{turn}>{escaped}</text>'


def disc(x, y, fill, radius):
    """A disc of a picture, or a ring if it is filled with the colour of the page."""
    return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{radius:g}" fill="{fill}" stroke="{COLD}" stroke-width="2"/>'


def cross(x, y, half):
    """A cross of a picture."""
    both = f"M{x - half:.1f},{y - half:.1f}l{2 * half},{2 * half}m0,-{2 * half}l-{2 * half},{2 * half}"
    return f'<path d="{both}" stroke="{WARM}" stroke-width="2"/>'


def bounded(many):
    """Numbers whose sums do not overflow; what is not finite becomes NaN, a gap."""
    return np.where(np.isfinite(many), np.clip(many, -HUGE, HUGE), np.nan)


def span(several):
    """The ends of an axis with some room beyond what is drawn."""
    finite = np.concatenate([line[np.isfinite(line)] for line in several])
    low, high = (float(finite.min()), float(finite.max())) if len(finite) else (0.0, 0.0)
    least = max(1e-9 * max(abs(low), abs(high)), TINY)
    if high - low <= least and max(abs(low), abs(high)) < TINY:
        return -1.0, 1.0
    room = max(0.06 * (high - low), least)
    return low - room, high + room


def axis_ticks(low, high, most=5, whole=False):
    """Places of 1, 2 or 5 times a power of ten with their texts; ``whole`` ones count samples."""
    rough = max((high - low) / most, float(whole))
    tens = 10.0 ** math.floor(math.log10(rough))
    step = next(tens * part for part in (1, 2, 5, 10) if tens * part >= rough * (1 - 1e-9))
    places = [k * step for k in range(math.ceil(low / step), math.floor(high / step) + 1)]
    digits = 1 + math.ceil(math.log10(max(abs(low), abs(high)) / step))
    return [(tick, f"{tick:.{max(digits, 5)}g}") for tick in places]


def _up_tick(y, text, left):
    return f'<path d="M{left:.0f},{y:.1f}H{WIDTH - 4}" stroke="#ddd"/>' + words(left - 6, y + 4, text, anchor="end")


def _across_tick(x, text):
    return f'<path d="M{x:.1f},{HEIGHT - BELOW}v5" stroke="{GREY}"/>' + words(x, HEIGHT - BELOW + 18, text)


def _thinned(line):
    """The points of a line that are drawn: of a long one, the lowest and the highest in each of many parts."""
    if len(line) <= MOST_POINTS:
        return np.arange(len(line))
    numbers = np.nan_to_num(line)
    parts = np.array_split(np.arange(len(line)), MOST_POINTS // 2)
    ends = [(part[numbers[part].argmin()], part[numbers[part].argmax()]) for part in parts]
    return np.unique([0, len(line) - 1, *np.ravel(ends)])


def _line(name, across, up, joined):
    """A line with gaps where there is no number: expected is whole with rings, got is dashed with crosses."""
    colour, dash = (WARM, ' stroke-dasharray="7 4"') if name == "got" else (COLD, "")
    course, marks, pen = [], [], "M"
    for x, y in zip(across.tolist(), up.tolist(), strict=True):
        if not math.isfinite(x + y):
            pen = "M"
            continue
        course.append(f"{pen}{x:.1f},{y:.1f}{'h0' if pen == 'M' else ''}")
        pen = "L"
        if len(across) <= MARKED or not joined:
            marks.append(_mark(name, x, y))
    pen = f'fill="none" stroke="{colour}" stroke-width="2" stroke-linecap="round"{dash}'
    return f'<path d="{"".join(course)}" {pen}/>{"".join(marks)}' if joined else "".join(marks)


def _mark(name, x, y):
    return cross(x, y, 4) if name == "got" else disc(x, y, "#fff", 4.5)


def _key(name, x, joined):
    ends = np.array([x, x + 34.0] if joined else [x + 32.0])
    return _line(name, ends, np.full(len(ends), 14.0), joined) + words(x + 46, 18, clean(name, 30), anchor="start")
