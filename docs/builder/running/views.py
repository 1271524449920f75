"""Live views that examples and labs open: on a page each is a shared file in a frame, and the reader is its hand."""

import contextlib
from tempfile import TemporaryDirectory

import hapticlab as hl
from hapticlab.errors import PaddleError

from .frames import frame

#: options of ``hl.live`` that a shared file does not take
OF_A_NOTEBOOK = {"rehearsal", "plain"}


@contextlib.contextmanager
def noted():
    """Note what ``hl.live`` is asked to show: the list that is given gets the arguments of each view, by name."""
    opened, live = [], hl.live

    def noted_live(*given, **options):
        opened.append(dict(zip(("paddle", "scene"), given, strict=False)) | options)
        return live(*given, **options)

    hl.live = noted_live
    try:
        yield opened
    finally:
        hl.live = live


def shared_text(asked):
    """Return the text of the shared file of a noted view.

    Raises
    ------
    PaddleError
        For a board, which no page drives.
    """
    options = {name: value for name, value in asked.items() if name not in ("paddle", "scene", *OF_A_NOTEBOOK)}
    with TemporaryDirectory() as folder:
        return hl.share(asked["scene"], asked["paddle"], f"{folder}/view.html", **options).path.read_text("utf-8")


def frame_of_view(name, asked, *, source, page):
    """Return the frame of a noted view; empty for a board."""
    try:
        text = shared_text(asked)
    except PaddleError:
        return ""
    return frame(name, text, folder=source, page=page.removesuffix(".md"), title=f"{asked['scene'].name}, live")
