"""The page of a class: every paddle in one table and two figures, and the files that were left out."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from .figures import plot_class, plot_overlay
from .page import bullets, document, picture, said, section, table

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from .record import PaddleQuality

HEADS = (
    "paddle", "name", "Eq. (23.10) [N/m]", "stiffest quiet K [N/m]", "with B [N s/m]", "velocity", "same up to [Hz]",
    "same damping up to [N/m]", "b [N s/m]", "dry friction [N]", "m [g]", "T [ms]", "count [µm]", "constants", "on", "day",
)  # fmt: skip
NOTES = (
    "Paddles are sorted by the stiffest wall that came to rest without a felt buzz, with any damping and velocity that was "
    "tried. A paddle on which more was tried has an advantage.",
    "Constants: measured where an interval is known for at least one of them, else nominal. Nominal paddles of one kind are the "
    "same on paper, and not on the bench.",
    "Same up to: the frequency up to which the rendered wall differs by less than 23 % from the ideal one. Same damping: the "
    "stiffness up to which hold and delay take away less than 34 % of the paddle's own damping. The fractions are those of "
    "Jones and Hunter (1990, 1993), applied as the page of each paddle says.",
)


def class_page(qualities: Sequence[PaddleQuality], skipped: Mapping[str, str]) -> str:
    """Return the page as text; the paddles in the order given."""
    numbers = range(1, len(qualities) + 1)
    many = f"{len(qualities)} paddle{'s' * (len(qualities) != 1)}"
    real = sum(one.on == "board" for one in qualities)
    parts = [
        f"<header><h1>How good are our paddles?</h1><p>{many}, {real} of them on a board, the others simulated.</p></header>",
        "<main>",
        section("Borders", picture(plot_class(qualities, numbers), "Each row is a paddle, in the order of the table.")),
    ]
    if any(one.rendered is not None for one in qualities):
        told = "How far each rendered wall is from the ideal one. Of many paddles, the best and the worst have a name."
        parts.append(section("Rendered impedance", picture(plot_overlay(qualities, numbers), told)))
    rows = [_row(number, one) for number, one in zip(numbers, qualities, strict=True)]
    parts.append(section("Table", table("All paddles", HEADS, rows, kind="class")))
    if skipped:
        parts.append(section("Files that were left out", bullets(skipped.values())))
    parts.append(section("How to read this page", bullets(NOTES)))
    return document(f"{many}: how good are they?", "\n".join(parts) + "</main>")


def _row(number, one):
    profile, (K, B, velocity) = one.profile, one.stiffest
    count = math.nan if profile.counts_per_metre is None else 1e6 / profile.counts_per_metre
    known = "measured" if profile.estimates and not profile.nominal else "nominal"
    measured = not math.isnan(K)
    return [
        str(number), one.name, said(one.passive), said(K) if measured else "not measured", said(B) if measured else "", velocity,
        "not measured" if one.rendered is None else said(one.rendered.same_up_to), said(one.same_damping), said(profile.b),
        said(profile.coulomb), said(1e3 * profile.m), said(1e3 * profile.T), "none" if math.isnan(count) else said(count), known,
        one.on, one.date,
    ]  # fmt: skip
