"""The page of one paddle: one HTML file that requests nothing, runs nothing, and escapes every text that came from a file."""

from __future__ import annotations

import base64
import hashlib
import math
from functools import cache
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING

from ...base.drawing import svg
from ...base.facts import short
from ...base.figure_words import describe
from ...base.profile.constants import CONSTANTS
from .figures import plot_rendered, plot_widths

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from matplotlib.figure import Figure

    from .record import PaddleQuality

#: constants of a profile that a page shows, in words
SHOWN = {
    "m": "mass at the handle", "b": "viscous damping", "coulomb": "dry friction", "T": "sampling period",
    "delay": "delay of the force", "sensor_delay": "lag of the sensor", "counts_per_metre": "encoder counts per metre",
    "sensor_noise": "noise of the sensor", "force_max": "largest force",
}  # fmt: skip
NOTES = (
    "Stiffness: differences below 23 % are taken as not felt (L. A. Jones and I. W. Hunter, Exp. Brain Res. 79 (1990) 150). "
    "Damping: below 34 % (the same authors, Exp. Brain Res. 94 (1993) 343, for 2 N s/m and more, which is above the damping of "
    "a paddle). In both studies people adjusted one motor until it felt like another; a forced choice gives smaller fractions.",
    "Assumptions of this page: the 23 % are applied to the whole impedance at each frequency, and the 34 % to the damping of "
    "paddle and wall together, although nobody judged these on a paddle.",
    "The borders are outcomes of trials in one hand, from the starts that were tried. Another hand or grip has other borders. A "
    "buzz counts as felt above 0.05 N, which is a convention.",
    "The cycles and the errors of velocities were computed in simulation.",
)


def quality_page(quality: PaddleQuality) -> str:
    """Return the page as text."""
    nominal = quality.profile.nominal and not quality.profile.estimates
    where = f"Measured on a {quality.on}, held by: {quality.held}."
    if quality.on != "board":
        where += " No real paddle was measured."
    if nominal:
        where += " Its constants are nominal: none was measured on this paddle."
    parts = [
        f"<header><h1>{escape(quality.name)}</h1><p>How good is this paddle? {escape(quality.date)}</p>"
        f"<p>{escape(where)}</p></header><main>",
        section("In words", bullets(quality.lines())),
        section("Constants", _constants(quality)),
    ]
    if quality.widths:
        figure = plot_widths(quality)
        told = "The grey range is the Z-width: walls that come to rest without a felt buzz."
        parts.append(section("Z-width and its two borders", picture(figure, told) + _widths(quality)))
    if quality.rendered is not None:
        told = "Grey bands: what a hand cannot tell from the ideal, as stated below."
        figure = plot_rendered(quality.rendered, quality.profile.b, quality.fractions)
        parts.append(section("Rendered impedance", picture(figure, told) + _rendered(quality)))
    if quality.velocities:
        parts.append(section("Velocity estimators", _velocities(quality)))
    parts.append(section("How to read this page", bullets(NOTES)))
    return document(f"{quality.name}: how good is this paddle?", "\n".join(parts) + "</main>")


def document(title: str, body: str) -> str:
    """Return a whole page, whose policy lets it load nothing but the pictures that stand in it."""
    style, allowed = _style()
    policy = f"default-src 'none'; img-src data:; style-src 'sha256-{allowed}'; base-uri 'none'; form-action 'none'"
    return (
        f'<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f'<meta http-equiv="Content-Security-Policy" content="{policy}">\n'
        f'<meta name="viewport" content="width=device-width, initial-scale=1">\n<title>{escape(title)}</title>\n'
        f"<style>{style}</style>\n</head>\n<body>\n{body}\n</body>\n</html>\n"
    )


@cache
def _style():
    style = (Path(__file__).parent / "quality.css").read_text("utf-8")
    return style, base64.b64encode(hashlib.sha256(style.encode()).digest()).decode()


def section(title: str, inside: str) -> str:
    """Return a section below its heading."""
    return f"<section><h2>{escape(title)}</h2>\n{inside}</section>"


def bullets(lines: Iterable[str]) -> str:
    """Return lines as a list."""
    return f"<ul>{''.join(f'<li>{escape(line)}</li>' for line in lines)}</ul>"


def table(caption: str, heads: Sequence[str], rows: Iterable[Sequence[str]], *, kind: str = "") -> str:
    """Return a table that can be scrolled by keyboard; the first cell of a row is its head, ``kind`` is a class of the style."""
    head = "".join(f'<th scope="col">{escape(one)}</th>' for one in heads)
    body = "".join(
        f'<tr><th scope="row">{escape(first)}</th>{"".join(f"<td>{escape(one)}</td>" for one in rest)}</tr>'
        for first, *rest in rows
    )
    return (
        f'<div class="scroll {kind}" role="region" tabindex="0" aria-label="{escape(caption)}"><table><caption>{escape(caption)}'
        f"</caption><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table></div>\n"
    )


def picture(figure: Figure, caption: str) -> str:
    """Return a figure as an image that stands in the page, with words for who does not see it."""
    encoded = base64.b64encode(svg(figure, outlines=False).encode()).decode()
    alt = escape(f"{caption} {describe(figure)}")
    source = f"data:image/svg+xml;base64,{encoded}"
    return f'<figure><img src="{source}" alt="{alt}"><figcaption>{escape(caption)}</figcaption></figure>\n'


def said(value: float, digits: int = 3) -> str:
    """Return a number for a table."""
    return "undecided" if math.isnan(value) else short(float(f"{value:.{digits}g}")) if math.isfinite(value) else "no limit"


def _constants(quality):
    profile, rows = quality.profile, []
    known = {one.name: one for one in profile.estimates}
    for name, words in SHOWN.items():
        value = getattr(profile, name)
        if value is None:
            continue
        unit = "" if CONSTANTS[name][0] == "1" else f" {CONSTANTS[name][0]}"
        one = known.get(name)
        if one is None:
            standing = "nominal" if profile.nominal else "not measured"
            rows.append([f"{words} ({name})", f"{short(value)}{unit}", "not known", standing])
        else:
            between = "exact" if one.low == one.high else f"{short(one.low)} to {short(one.high)}{unit}"
            rows.append([f"{words} ({name})", f"{short(value)}{unit}", between, one.source or "estimated"])
    return table(
        "Constants of this paddle, with intervals where they are known", ["constant", "value", "interval", "from"], rows
    ) + (f'<p class="aside">All other constants: {escape(profile.source or "source not given")}</p>')


def _widths(quality):
    rows = [
        [w.velocity, said(B), said(K), said(rest), said(quiet)]
        for w in quality.widths
        for B, K, rest, quiet in zip(w.B, w.K, w.rest, w.quiet, strict=True)
    ]
    heads = ["velocity", "B [N s/m]", "quiet and at rest up to K [N/m]", "comes to rest up to [N/m]", "no buzz up to [N/m]"]
    return table("Both borders, the worst of all starts", heads, rows)


def _rendered(quality):
    one = quality.rendered
    columns = (one.frequency, abs(one.Z), one.radius, one.stiffness, quality.profile.b + one.Z.real, 100 * one.off)
    rows = [[said(float(value)) for value in row] for row in zip(*columns, strict=True)]
    heads = ["f [Hz]", "|Z| [N s/m]", "+- [N s/m]", "stiffness [N/m]", "damping with b [N s/m]", "off the ideal [%]"]
    caption = f"Rendered wall of {said(one.K)} N/m and {said(one.B)} N s/m"
    return f"<details><summary>All frequencies</summary>{table(caption, heads, rows)}</details>"


def _velocities(quality):
    rows = [
        [v.name, said(1e3 * v.lag), said(1e3 * v.noise), str(v.cycles), "yes" if v.fits else "no"] for v in quality.velocities
    ]
    heads = ["velocity", "lag [ms]", "noise, rms [mm/s]", "cycles per tick", "fits the board"]
    return table("Velocity estimators on one motion", heads, rows)
