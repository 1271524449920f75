"""The HTML of a shared file: a view, and the scene that runs in it."""

from .document import VIEW_SCRIPTS, document

PAGE_SCRIPTS = (
    "page/program.js", "page/stepping.js", "page/pace.js", "page/rows.js", "page/limits.js", "page/records.js", "page/motion.js",
    "page/status.js", "page/source.js", "page/plain_picture.js", "page/start.js",
)  # fmt: skip
STYLES = ("view.css", "page/page.css")
NO_SCRIPT = "This page runs a simulation, which needs JavaScript. Allow it for this file, or open the file in another browser."


def page(data, body=""):
    """Return the text of a shared file.

    Parameters
    ----------
    data : dict
        As :func:`~hapticlab.widgets.shared.page_data.page_data` makes it; ``title`` and ``lead`` stand above the view.
    body : str
        HTML below the view, without scripts, without styles in attributes.
    """
    main = f'<div id="hl-view"><noscript>{NO_SCRIPT}</noscript></div>\n{body}'
    return document(data["scene"], main, data, scripts=(*VIEW_SCRIPTS, *PAGE_SCRIPTS), styles=STYLES)
