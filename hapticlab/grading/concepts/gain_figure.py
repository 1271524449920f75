"""The figure of a class: each concept before and after on one line, as SVG."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...base.drawing import COLD, WARM
from ...course.cards.chart import GREY, WIDTH, picture
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
        inside.append(f'<text x="{x:.1f}" y="{low + 18}" text-anchor="middle">{percent}</text>')
    inside.append(f'<text x="{(LEFT + WIDTH) / 2:.0f}" y="{low + 38}" text-anchor="middle">right answers [%]</text>')
    for k, (words, fill) in enumerate((("before", "#fff"), ("after", COLD))):
        inside.append(_dot(LEFT + 10 + 110 * k, 12, fill) + f'<text x="{LEFT + 24 + 110 * k}" y="16">{words}</text>')
    for k, one in enumerate(gains):
        y, first, last = TOP + ROW * (k + 0.5), across(one.before), across(one.after)
        colour = GREY if one.after >= one.before else WARM
        dash = "" if one.after >= one.before else ' stroke-dasharray="5 3"'
        inside.append(f'<text x="{LEFT - 14}" y="{y + 4:.1f}" text-anchor="end">{clean(one.title, 40)}</text>')
        inside.append(f'<path d="M{first:.1f},{y:.1f}H{last:.1f}" stroke="{colour}" stroke-width="3"{dash}/>')
        inside.append(_dot(first, y, "#fff") + _dot(last, y, COLD))
    told = "; ".join(f"{one.title}: {100 * one.before:.0f} % before, {100 * one.after:.0f} % after" for one in gains)
    return picture(WIDTH, low + BOTTOM, "".join(inside), f"Right answers by concept. {told}.")


def _dot(x: float, y: float, fill: str) -> str:
    return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="6" fill="{fill}" stroke="{COLD}" stroke-width="2"/>'
