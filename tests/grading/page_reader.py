"""A page as tests read it: its words, its tags, and whether its elements nest."""

from html.parser import HTMLParser

VOID = {"meta", "path", "rect", "circle", "br"}
#: all that a page is made of: nothing here loads or runs anything
TAGS = {
    "html", "head", "meta", "title", "style", "body", "header", "main", "footer", "section", "div", "h1", "h2", "h3", "p",
    "pre", "code",
    "strong", "span", "bdi", "a", "table", "caption", "thead", "tbody", "tr", "th", "td", "figure", "figcaption", "details",
    "summary", "ul", "li", "svg", "path", "rect", "circle", "text", "defs", "pattern",
}  # fmt: skip
ATTRIBUTES = {
    "lang", "charset", "http-equiv", "content", "name", "class", "id", "href", "scope", "role", "aria-label", "aria-hidden",
    "dir", "tabindex",
    "viewbox", "width", "height", "d", "fill", "stroke", "stroke-width", "stroke-linecap", "stroke-dasharray", "x",
    "y", "cx", "cy",
    "r", "text-anchor", "transform", "patternunits", "patterntransform",
}  # fmt: skip


class Page(HTMLParser):
    """What a page holds, after looking whether its elements nest."""

    def __init__(self, path):
        super().__init__()
        self.open, self.tags, self.attributes, self.text, self.links = [], [], [], [], []
        self.source = path.read_text("utf-8")
        self.feed(self.source)
        self.close()
        assert self.open == []
        self.words = " ".join(" ".join(self.text).split())

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        self.attributes += attrs
        self.links += [value for name, value in attrs if name == "href"]
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.tags.append(tag)
        self.attributes += attrs

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if "style" not in self.open:
            self.text.append(data)
