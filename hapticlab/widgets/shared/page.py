"""The HTML of a shared file: one page that asks for nothing beyond itself, and runs no script but its own."""

import base64
import hashlib
import json
from html import escape

from ... import __version__
from ..browser_view import BROWSER, SCRIPTS

#: what a view is made of, without a notebook's source, then the page's own
VIEW_SCRIPTS = tuple(script for script in SCRIPTS if script != "kernel.js")
PAGE_SCRIPTS = (
    "page/program.js", "page/stepping.js", "page/pace.js", "page/rows.js", "page/limits.js", "page/records.js", "page/motion.js",
    "page/status.js", "page/source.js", "page/plain_picture.js", "page/start.js",
)  # fmt: skip
STYLES = ("view.css", "page/page.css")
LICENCE = "Copyright (c) 2026, the hapticlab developers. BSD 3-Clause License."
NO_SCRIPT = "This page runs a simulation, which needs JavaScript. Allow it for this file, or open the file in another browser."
#: what stands for everything that the page may do: no address but itself, and none of its own scripts by eval
POLICY = (
    "default-src 'none'; script-src {script} 'wasm-unsafe-eval'; style-src {style}; img-src data: blob:; base-uri 'none'; "
    "form-action 'none'"
)


def page(data, body=""):
    """Return the text of a shared file.

    Parameters
    ----------
    data : dict
        As :func:`~hapticlab.widgets.shared.page_data.page_data` makes it; ``title`` and ``lead`` stand above the view.
    body : str
        HTML below the view, without scripts, without styles in attributes.
    """
    style, script = _read(STYLES), _closed(_read((*VIEW_SCRIPTS, *PAGE_SCRIPTS)))
    policy = POLICY.format(script=_hash(script), style=_hash(style))
    title = escape(data["scene"])
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="{policy}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="generator" content="hapticlab {__version__}">
<title>{title}</title>
<style>{style}</style>
</head>
<body>
<main>
<h1>{title}</h1>
<div id="hl-view"><noscript>{NO_SCRIPT}</noscript></div>
{body}</main>
<footer><p>hapticlab {__version__}. {LICENCE}</p></footer>
<script type="application/json" id="hl-data">{_json(data)}</script>
<script>{script}</script>
</body>
</html>
"""


def _read(names):
    return "\n".join((BROWSER / name).read_text("utf-8") for name in names)


def _closed(script):
    """Scripts in a scope of their own; nothing in them ends the element that they stand in."""
    return '"use strict";(() => {\n' + script.replace("</", "<\\/") + "\n})()"


def _json(data):
    """Data that can end no element, whatever a scene, a parameter or a label is called."""
    return json.dumps(data, allow_nan=False, ensure_ascii=False).replace("<", "\\u003c").replace("&", "\\u0026")


def _hash(text):
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"
