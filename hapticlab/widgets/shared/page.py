"""The HTML of a shared file: a view, and the scene that runs in it."""

from html import escape

from .document import VIEW_SCRIPTS, document

PAGE_SCRIPTS = (
    "page/program.js", "page/stepping.js", "page/pace.js", "page/rows.js", "page/limits.js", "page/records.js", "page/motion.js",
    "page/status.js", "page/source.js", "page/drawing.js", "page/address.js", "page/npz.js", "page/files.js",
    "page/page.js", "page/start.js",
)  # fmt: skip
STYLES = ("view.css", "page/page.css")
#: what stands where the view will be, until it runs
WAITING = (
    "The scene starts in a moment. If this sentence stays, the page cannot run here: previews of mail and chat programs, and "
    "files on an iPhone or iPad, run no scripts. Save the file and open it in a current browser on a computer, or open it from "
    "a web address."
)
NO_SCRIPT = "This page runs a simulation, which needs JavaScript. Allow it for this file, or open the file in another browser."


def page(data, title, lead="", body="", picture=""):
    """Return the text of a shared file.

    Parameters
    ----------
    data : dict
        As :func:`~hapticlab.widgets.shared.page_data.page_data` makes it.
    title : str
    lead : str
        A sentence on the scene, in plain text.
    body : str
        HTML below the view, without scripts, without styles in attributes.
    picture : str
        An element that stands in the place of the view until it runs.
    """
    main = f"""<p class="hl-lead">{escape(lead)}</p>
<p id="hl-told" role="status"></p>
<div id="hl-view">{picture}<p>{WAITING}</p><noscript><p>{NO_SCRIPT}</p></noscript></div>
{body}"""
    scripts = (*VIEW_SCRIPTS, *PAGE_SCRIPTS)
    return document(title, main, data, scripts=scripts, styles=STYLES, description=lead)
