"""A drawing by its name: what a notebook shows of it, in light and dark, and the text that stands for it."""

from __future__ import annotations

import html
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from ...base.drawing import bundle, svg
from ...device.wirings import BUILDS
from ...errors import CourseError
from . import drive, loop, paddle, sample_and_hold, signs
from .pen import INK
from .wiring import WiringSheet

if TYPE_CHECKING:
    from collections.abc import Callable

    from matplotlib.figure import Figure

SHEETS: dict[str, Any] = {"paddle": paddle, "drive": drive, "loop": loop, "sample_and_hold": sample_and_hold, "signs": signs}
SHEETS |= {f"wiring {name}": WiringSheet(build) for name, build in BUILDS.items()}


#: of a file that stands alone: its ground and its ink
GROUND = (
    "<style>svg { background: #fff; color: #1b1b1b } "
    "@media (prefers-color-scheme: dark) { svg { background: #111; color: #e8e8e8 } }</style>"
)


@dataclass(frozen=True)
class Drawing:
    """A drawing that explains; a cell that ends in it shows it."""

    name: str
    title: str
    alt: str
    make: Callable[[], Figure] = field(repr=False)

    def plot(self) -> Figure:
        """Return the drawing as a figure, black on white."""
        figure = self.make()
        figure.alt = self.alt  # type: ignore[attr-defined]
        return figure

    def page_svg(self) -> str:
        """Return the drawing as an SVG file with a ground of its own, light or dark as the reader's system is."""
        head, rest = svg(self.make(), outlines=False).replace(INK, "currentColor").split(">", 1)
        words = f"<title>{html.escape(self.title)}</title><desc>{html.escape(self.alt)}</desc>"
        return f"{head}>{GROUND}{words}{rest}"

    def __str__(self) -> str:
        return f"{self.title}. {self.alt}"

    def _repr_mimebundle_(self, include: object = None, exclude: object = None) -> tuple[dict[str, str], dict[str, Any]]:
        shown, about = bundle(self.plot(), self.alt)
        return {**shown, "text/html": self._on_a_page(), "text/plain": str(self)}, about

    def _on_a_page(self) -> str:
        """HTML in the page's own colour of text, so that it reads in the dark."""
        drawn = svg(self.make()).replace(INK, "currentColor")
        head, rest = drawn.split(">", 1)
        width = head.split('width="')[1].split('"')[0]
        view = head.split('viewBox="')[1].split('"')[0]
        opened = f'<svg role="img" aria-label="{html.escape(self.alt)}" viewBox="{view}" style="width: {width}; max-width: 100%"'
        caption = f'<figcaption style="font-size: 0.9em">{html.escape(self.title)}</figcaption>'
        return f'<figure style="margin: 0.5em 0">{opened} xmlns:xlink="http://www.w3.org/1999/xlink">{rest}{caption}</figure>'


def drawing(name: str) -> Drawing:
    """Show how a paddle is built, who pushes whom, or what a sampled force looks like: a drawing for the labs.

    Parameters
    ----------
    name : {"paddle", "drive", "loop", "sample_and_hold", "signs", "wiring hapkit", ...}
        ``"paddle"``: its parts. ``"drive"``: handle, sector, drum, motor, amplifier and sensor. ``"loop"``: sensor, computer
        and motor, with the forces of Fig. 23.5. ``"sample_and_hold"``: position and held force over time, as in Fig. 23.6.
        ``"signs"``: the sign convention on one card. ``"wiring hapkit"`` and the others of hapticlab.device.wirings.BUILDS:
        every wire of a paddle, from pin to terminal.

    Returns
    -------
    Drawing
        A notebook shows it in the colours of its page, with an alternative text; ``.plot()`` is the figure.

    Raises
    ------
    CourseError
        If there is no drawing of that name.

    Examples
    --------
    >>> import hapticlab as hl
    >>> print(hl.devices.drawing("signs").title)
    Signs: to the right is positive
    """
    if not isinstance(name, str) or name not in SHEETS:
        raise CourseError(f"{name!r} is not a drawing; there are {', '.join(SHEETS)}.")
    sheet = SHEETS[name]
    return Drawing(name, sheet.TITLE, sheet.ALT, sheet.draw)
