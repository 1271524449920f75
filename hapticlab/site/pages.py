"""Pages of the site beside the labs: what each is, and the function that writes it."""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from pathlib import Path


@dataclass(frozen=True)
class Page:
    """A page that one function of the package writes.

    Attributes
    ----------
    file : str
        Its name in the site, such as "paddle.html".
    title : str
        The words of its link on the front page.
    about : str
        A sentence beside that link.
    written_by : str
        "module.function" of the package, which returns the whole page as text.
    scene : bool
        Whether the page is a scene to feel at once, which the front page lists before the labs.
    """

    file: str
    title: str
    about: str
    written_by: str
    scene: bool = False

    def html(self) -> str:
        """Return the page."""
        module, _, function = self.written_by.rpartition(".")
        return getattr(import_module(f"hapticlab.{module}"), function)()


#: a page is added here, and by nothing else: it is written, linked from the front page, and covered by hapticlab's licence
PAGES = (
    Page(
        "wall.html", "A virtual wall", "Push into a spring, and make it stiff until it chatters.", "site.scenes.wall", scene=True
    ),
    Page(
        "pendulum.html",
        "A pendulum in the hand",
        "Swing it, and see how it moves the handle.",
        "site.scenes.pendulum",
        scene=True,
    ),
    Page("ball.html", "A ball on the paddle", "Juggle it.", "site.scenes.ball", scene=True),
    Page("crank.html", "A slider-crank mechanism", "Turn a crank through its dead points.", "site.scenes.crank", scene=True),
    Page(
        "paddle.html",
        "A real paddle, by its USB cable",
        "In Chrome or Edge on a computer. The page is untried: it never ran with a real paddle.",
        "widgets.board_page.page.paddle_page",
    ),
)


def write_pages(folder):
    """Write every page into a site's folder."""
    for page in PAGES:
        Path(folder, page.file).write_text(page.html(), "utf-8")
