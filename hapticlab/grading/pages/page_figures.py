"""Figures of the page of a class, written as SVG at once, as those of :mod:`hapticlab.course.cards.chart`."""

from ...base.drawing import COLD, WARM
from ...course.cards.chart import ABOVE, BELOW, GREY, HEIGHT, WIDTH, picture, words
from ...course.cards.page_text import clean


def bars(counts, label, alt):
    """A distribution as SVG.

    Parameters
    ----------
    counts : dict of str to int
        What stands under each bar, and its height.
    label : str
        Of the horizontal axis.
    alt : str
    """
    most, wide = max(1, *counts.values()), (WIDTH - 16) / len(counts)
    inside = [f'<path d="M4,{HEIGHT - BELOW}H{WIDTH - 4}" stroke="{GREY}"/>']
    for k, (under, count) in enumerate(counts.items()):
        high = count / most * (HEIGHT - BELOW - ABOVE)
        x, top = 8 + k * wide, HEIGHT - BELOW - high
        inside += [
            f'<rect x="{x + 0.12 * wide:.1f}" y="{top:.1f}" width="{0.76 * wide:.1f}" height="{high:.1f}" fill="{COLD}"/>',
            words(x + wide / 2, top - 6, count),
            words(x + wide / 2, HEIGHT - BELOW + 18, clean(under, 20)),
        ]
    inside.append(words(WIDTH / 2, HEIGHT - 6, clean(label, 60)))
    return picture(WIDTH, HEIGHT, "".join(inside), alt)


#: part of a bar -> how it is filled; the stripes of "wrong" are told from the rest in grey print too
FILLS = {"right": COLD, "partly": "url(#dots)", "wrong": "url(#stripes)", "no answer": "#fff", "cell failed": "url(#bars)"}
STRIPES = "".join(
    f'<pattern id="{name}" width="8" height="8" patternUnits="userSpaceOnUse" patternTransform="rotate({turned})">'
    f'<rect width="8" height="8" fill="#fff"/><rect width="{wide}" height="8" fill="{colour}"/></pattern>'
    for name, turned, wide, colour in (("stripes", 45, 4, WARM), ("dots", 0, 4, COLD), ("bars", 90, 2, GREY))
)


def shares(rows, alt):
    """Bars as SVG, each divided into the parts of FILLS.

    Parameters
    ----------
    rows : dict of str to dict of str to int
        Exercise to the count of each part.
    alt : str
    """
    left, row = 20 + 10 * max(len(name[:30]) for name in rows), 30
    inside = [f"<defs>{STRIPES}</defs>"]
    parts = [part for part in FILLS if any(part in counts for counts in rows.values())]
    step = min(150, (WIDTH - 8) // len(parts))
    for k, part in enumerate(parts):
        inside.append(f'<rect x="{8 + step * k}" y="4" width="22" height="14" fill="{FILLS[part]}" stroke="{GREY}"/>')
        inside.append(words(8 + step * k + 28, 16, part, anchor="start"))
    for k, (name, counts) in enumerate(rows.items()):
        y, x, whole = 30 + k * row, left, max(1, sum(counts.values()))
        inside.append(words(left - 10, y + 16, clean(name, 30), anchor="end"))
        for part, count in counts.items():
            if count:
                wide = count / whole * (WIDTH - left - 8)
                inside.append(f'<rect x="{x:.1f}" y="{y}" width="{wide:.1f}" height="22" fill="{FILLS[part]}" stroke="{GREY}"/>')
                x += wide
    return picture(WIDTH, 34 + row * len(rows), "".join(inside), alt)
