"""Live views that examples open: on a page each is a shared file in a frame, and the reader is its hand."""

from tempfile import TemporaryDirectory

import hapticlab as hl
from hapticlab.errors import PaddleError

from .frames import frame

#: options of ``hl.live`` that a shared file does not take
OF_A_NOTEBOOK = {"rehearsal", "plain"}


def frame_of_view(name, given, options, *, source, page):
    """Return the frame of what ``hl.live`` was asked to show; empty for a board, which no page drives."""
    asked = dict(zip(("paddle", "scene"), given, strict=False)) | options
    paddle, scene = asked.pop("paddle"), asked.pop("scene")
    with TemporaryDirectory() as folder:
        try:
            shared = hl.share(
                scene, paddle, f"{folder}/{name}.html", **{k: v for k, v in asked.items() if k not in OF_A_NOTEBOOK}
            )
        except PaddleError:
            return ""
        text = shared.path.read_text("utf-8")
    return frame(name, text, folder=source, page=page.removesuffix(".md"), title=f"{scene.name}, live")
