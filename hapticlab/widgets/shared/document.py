"""A page as one file: it asks for nothing beyond itself, and runs no script but its own."""

import base64
import hashlib
import json
from html import escape

from ... import __version__
from ..browser_view import BROWSER, SCRIPTS

#: what a view is made of, without a notebook's source
VIEW_SCRIPTS = tuple(script for script in SCRIPTS if script != "kernel.js")
LICENCE = "Copyright (c) 2026, the hapticlab developers. BSD 3-Clause License."
#: a handle at a wall, 32 pixels wide
ICON = (
    "data:image/svg+xml,%3Csvg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 32 32'%3E%3Crect width='32' height='32' rx='6' "
    "fill='%23fff'/%3E%3Cpath d='M22 4h6v24h-6z' fill='%23888'/%3E%3Cpath d='M4 15h11v2H4z' fill='%23cc5a1a'/%3E%3Ccircle "
    "cx='16' cy='16' r='5' fill='%231a4b84'/%3E%3C/svg%3E"
)
#: what stands for everything that the page may do: no address but itself, and none of its own scripts by eval
POLICY = "default-src 'none'; script-src {script}; style-src {style}; img-src data: blob:; base-uri 'none'; form-action 'none'"


def document(title, main, data, *, scripts, styles, wasm=True, description=""):
    """Return the text of a page.

    Parameters
    ----------
    title : str
    main : str
        HTML of the page, without scripts, without styles in attributes.
    data : dict
        For its scripts, which find it as JSON in the element hl-data.
    scripts, styles : sequence of str
        In the folder of the view's own, the scripts in the order in which they run.
    wasm : bool
        Whether the page may compile WebAssembly.
    description : str
        A sentence for search engines and previews.
    """
    style, script = read(styles), _closed(read(scripts))
    about = f'<meta name="description" content="{escape(description)}">\n' if description else ""
    policy = POLICY.format(script=_hash(script) + (" 'wasm-unsafe-eval'" if wasm else ""), style=_hash(style))
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="{policy}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="generator" content="hapticlab {__version__}">
{about}<meta name="color-scheme" content="light dark">
<title>{escape(title)}</title>
<link rel="icon" href="{ICON}">
<style>{style}</style>
</head>
<body>
<main>
<h1>{escape(title)}</h1>
{main}</main>
<footer><p>hapticlab {__version__}. {LICENCE}</p></footer>
<script type="application/json" id="hl-data">{_json(data)}</script>
<script>{script}</script>
</body>
</html>
"""


def read(names):
    """The texts of files of the view, one after another."""
    return "\n".join((BROWSER / name).read_text("utf-8") for name in names)


def _closed(script):
    """Scripts in a scope of their own; nothing in them ends the element that they stand in."""
    return '"use strict";(() => {\n' + script.replace("</", "<\\/") + "\n})()"


def _json(data):
    """Data that can end no element, whatever a scene, a parameter or a label is called."""
    return json.dumps(data, allow_nan=False, ensure_ascii=False).replace("<", "\\u003c").replace("&", "\\u0026")


def _hash(text):
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"
