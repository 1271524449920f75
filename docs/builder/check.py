"""What is wrong with the HTML of a site: links and anchors that lead nowhere, and whatever a page would load from elsewhere."""

import html
import re
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from urllib.parse import unquote, urlsplit

TAG = re.compile(r"<(?P<name>[a-zA-Z][\w-]*)(?P<attributes>(?:\s+[\w:@.-]+(?:\s*=\s*(?:\"[^\"]*\"|'[^']*'|[^\s>\"']+))?)*)\s*/?>")
ATTRIBUTE = re.compile(r"([\w:@.-]+)\s*=\s*(?:\"([^\"]*)\"|'([^']*)'|([^\s>\"']+))")
SCRIPT = re.compile(r"(<script\b[^>]*>).*?(</script>)", re.S | re.I)
#: addresses in style sheets
URL = re.compile(r"""url\(\s*["']?([^"')]+)["']?\s*\)|@import\s+["']([^"']+)""")
ARTICLE = re.compile(r"<article\b.*?</article>", re.S)
#: attributes by which a page loads a file when it opens; those of other links only say where a reader may go
LOADS = {"src", "srcset", "poster", "data"}
#: kinds of <link> that load nothing
SAYS = {"canonical", "next", "prev", "index", "search", "author", "copyright", "license"}
#: folders that are looked through by the tests of what makes them
OF_OTHERS = ("labs_in_browser/", "_static/")
#: folders whose pages take values of parameters in the place of an anchor
WITH_VALUES = ("live/",)


@dataclass
class Counted:
    """What a site holds, and what is wrong with it, a line for each."""

    pages: int = 0
    words: int = 0
    links: int = 0
    wrong: list[str] = field(default_factory=list)


class Html:
    """One page: its links, its anchors, what it loads."""

    def __init__(self, text):
        self.text = text
        plain = SCRIPT.sub(r"\1\2", text)
        self.tags = [
            (tag["name"].lower(), {name: html.unescape(a or b or c) for name, a, b, c in ATTRIBUTE.findall(tag["attributes"])})
            for tag in TAG.finditer(plain)
        ]

    @cached_property
    def anchors(self):
        """Names that an address can point to."""
        return {found[key] for _, found in self.tags for key in ("id", "name") if key in found}

    @property
    def links(self):
        """Addresses that a reader may follow."""
        return [found["href"] for name, found in self.tags if name == "a" and "href" in found]

    @property
    def loaded(self):
        """Addresses that the page loads when it opens."""
        for name, found in self.tags:
            if name == "link" and not SAYS & set(found.get("rel", "").split()):
                yield found.get("href", "")
            for key in LOADS & found.keys():
                yield from (
                    (part.split()[0] for part in found[key].split(",") if part.split()) if key == "srcset" else [found[key]]
                )

    @property
    def words(self):
        """How many words its article has."""
        article = ARTICLE.search(self.text)
        return len(re.sub(r"<[^>]+>", " ", article[0]).split()) if article else 0


def look_through(site, asked=()):
    """Return what the HTML and the style sheets in a folder hold, and what is wrong with them.

    ``asked`` has the addresses that the site must have, as ``(file, anchor)``.
    """
    site, counted = Path(site), Counted()
    files = {path.relative_to(site).as_posix() for path in site.rglob("*") if path.is_file()}
    pages = {
        name: Html((site / name).read_text("utf-8"))
        for name in sorted(files)
        if name.endswith(".html") and not name.startswith(OF_OTHERS)
    }
    for name, page in pages.items():
        counted.pages += 1
        counted.words += page.words
        counted.links += len(page.links)
        counted.wrong += [f"{name}: {why}" for why in dict.fromkeys(_wrong_in(name, page, pages, files))]
    for name, anchor in sorted(asked):
        if name not in pages or anchor not in pages[name].anchors:
            counted.wrong.append(f"{name}#{anchor} is no address of this site")
    for name in sorted(files):
        if name.endswith(".css") and not name.startswith(OF_OTHERS):
            urls = [a or b for a, b in URL.findall((site / name).read_text("utf-8"))]
            counted.wrong += [f"{name} loads {url}, which is elsewhere" for url in urls if _elsewhere(url)]
    return counted


def _elsewhere(address):
    return bool(urlsplit(address).netloc) and not address.startswith("data:")


def _wrong_in(name, page, pages, files):
    for address in page.loaded:
        if _elsewhere(address):
            yield f"loads {address}, which is elsewhere"
        elif address and not address.startswith(("data:", "about:", "blob:")) and _target(name, address)[0] not in files:
            yield f"loads {address}, which is not there"
    for address in page.links:
        parts = urlsplit(address)
        if parts.scheme or parts.netloc:
            if parts.scheme not in ("http", "https", "mailto"):
                yield f"links {address}, which is no address of the web"
            continue
        file, anchor = _target(name, address)
        if file not in files:
            yield f"links {address}, which is not there"
        elif anchor and file in pages and not file.startswith(WITH_VALUES) and anchor not in pages[file].anchors:
            yield f"links {address}, which has no such anchor"


def _target(name, address):
    """Return the file of the site that an address means on a page, and the anchor there."""
    parts = urlsplit(address)
    if not parts.path:
        return name, unquote(parts.fragment)
    steps = [] if parts.path.startswith("/") else name.split("/")[:-1]
    for step in unquote(parts.path).split("/"):
        if step == "..":
            steps = steps[:-1] if steps else ["outside"]
        elif step not in ("", "."):
            steps.append(step)
    file = "/".join(steps)
    return (f"{file}/index.html".lstrip("/") if parts.path.endswith("/") or not file else file), unquote(parts.fragment)
