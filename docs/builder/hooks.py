"""What Sphinx does at its events: descriptions of pages for search engines and previews of links, pictures that open."""

import re
from html import escape

from docutils import nodes

#: of a description, what search engines and previews show at most
LONGEST = 160


def setup(app):
    """Sphinx calls this; it is named in the ``extensions`` of conf.py."""
    app.connect("html-page-context", describe)
    app.connect("html-page-context", open_pictures)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def describe(app, page, _template, context, tree):
    """Give a page its title and its first sentence as a description."""
    first = next(iter(tree.findall(nodes.paragraph)), None) if tree else None
    words = (
        shortened(first.astext()) if first else "Scenes, paddles and virtual walls for courses on system dynamics and haptics."
    )
    title = escape(re.sub(r"<[^>]+>", "", context.get("title", "")), quote=True)
    context["metatags"] = context.get("metatags", "") + (
        f'<meta name="description" content="{escape(words)}">\n'
        f'<meta property="og:title" content="{title}">\n<meta property="og:description" content="{escape(words)}">\n'
    )


def open_pictures(app, page, _template, context, tree):
    """Let a link to a picture open it, where Sphinx would have it saved."""
    context["body"] = re.sub(r' download=""(?= href="[^"]+\.(?:png|svg)")', "", context.get("body", ""))


def shortened(text):
    """Return a text as far as its last whole word that fits.

    Examples
    --------
    >>> shortened("a wall that  chatters"), shortened("stiff " * 40)[-9:]
    ('a wall that chatters', 'stiff ...')
    """
    text = " ".join(text.split())
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 4].rpartition(' ')[0]} ..."
