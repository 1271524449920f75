"""The figure of a class: each concept before and after on one line, as SVG."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...base.drawing import COLD, WARM
from ...course.cards.chart import GREY, WIDTH, disc, picture, words
from ...course.cards.page_text import clean

if TYPE_CHECKING:
    from collections.abc import Sequence

    from .class_summary import Gain

LEFT, ROW, TOP, BOTTOM = 210, 30, 34, 44


def gain_figure(gains: Sequence[Gain]) -> str:
    """Return an SVG with a row for each concept: a ring before, a disc after, and a line between them.

    Parameters
    ----------
    gains : sequence of Gain
    """
    low = TOP + ROW * len(gains)

    def across(part: float) -> float:
        return LEFT + part * (WIDTH - LEFT - 24)

    inside = []
    for percent in (0, 25, 50, 75, 100):
        x = across(percent / 100)
        inside.append(f'<path d="M{x:.1f},{TOP - 8}V{low}" stroke="#ddd"/>')
        inside.append(words(x, low + 18, percent))
    inside.append(words((LEFT + WIDTH) / 2, low + 38, "right answers [%]"))
    for k, (when, fill) in enumerate((("before", "#fff"), ("after", COLD))):
        inside.append(disc(LEFT + 10 + 110 * k, 12, fill, 6) + words(LEFT + 24 + 110 * k, 16, when, anchor="start"))
    for k, one in enumerate(gains):
        y, first, last = TOP + ROW * (k + 0.5), across(one.before), across(one.after)
        colour = GREY if one.after >= one.before else WARM
        dash = "" if one.after >= one.before else ' stroke-dasharray="5 3"'
        inside.append(words(LEFT - 14, y + 4, clean(one.title, 40), anchor="end"))
        inside.append(f'<path d="M{first:.1f},{y:.1f}H{last:.1f}" stroke="{colour}" stroke-width="3"{dash}/>')
        inside.append(disc(first, y, "#fff", 6) + disc(last, y, COLD, 6))
    told = "; ".join(f"{one.title}: {100 * one.before:.0f} % before, {100 * one.after:.0f} % after" for one in gains)
    return picture(WIDTH, low + BOTTOM, "".join(inside), f"Right answers by concept. {told}.")
