"""The page of a real paddle, as one HTML file for a site."""

from ..shared.document import VIEW_SCRIPTS, document
from .programs import page_data

BOARD_SCRIPTS = (
    "page/rows.js", "page/limits.js", "page/records.js", "page/status.js", "page/drawing.js", "page/npz.js", "page/files.js",
    "board/messages.js", "board/link.js", "board/port.js", "board/paddle.js", "board/source.js", "board/page.js",
    "board/start.js",
)  # fmt: skip
STYLES = ("view.css", "page/page.css", "board/page.css")
NO_SCRIPT = "This page talks to a board, which needs JavaScript. Allow it for this page."
MAIN = f"""<p>This page runs a scene on a real paddle by its USB cable. <strong>It is untried on silicon: nothing here was ever on
a bench.</strong> The page is no emergency stop. Keep your other hand near the switch in the supply of the motor, and hold the
handle before you press Start.</p>
<noscript><p>{NO_SCRIPT}</p></noscript>
<div class="hl-setup">
<p><label for="hl-scene">Scene</label> <select id="hl-scene"></select>
<button type="button" id="hl-connect">Connect a paddle</button></p>
<p id="hl-about"></p>
<p id="hl-words" role="status" aria-live="polite"></p>
<dl id="hl-facts"></dl>
</div>
<div id="hl-view"></div>
<button type="button" id="hl-stop" hidden>■ Stop motor <kbd>Space</kbd> <kbd>Esc</kbd></button>
"""


def paddle_page(data=None):
    """Return the text of the page.

    Parameters
    ----------
    data : dict, optional
        As :func:`~hapticlab.widgets.board_page.programs.page_data` makes it, which compiles every scene for every board.
    """
    scripts = (*VIEW_SCRIPTS, *BOARD_SCRIPTS)
    return document("A real paddle", MAIN, page_data() if data is None else data, scripts=scripts, styles=STYLES, wasm=False)
