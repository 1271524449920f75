"""The index of papers: which names, labs, tests and files of code cite each paper."""

import re

from . import uses

PAGE = "reference/papers"
#: authors and year, as docstrings cite: Abbott and Okamura 2005, Diolaiti et al. (2006), Mirtich and Canny (1995)
SURNAME = r"(?:(?:[Vv]an(?: de)?|Vander) )?[A-Z][a-z]+"
CITED = re.compile(rf"\b({SURNAME}(?:, {SURNAME})*,?(?: and {SURNAME}| et al\.)?),? \(?((?:19|20)\d\d)\b")
#: what stands before a year and is no author
NO_AUTHORS = {"August", "Functions", "Symposium", "Graphics", "Format"}
HEAD = """# Papers

Each paper below has a page with its claim, computed from its formula and with hapticlab, and with where the exact sampled device
differs. [The pages of papers](../papers/README.md) say how close each claim is.

"""


def write(source):
    """Write the page into the copied source."""
    (source / "reference").mkdir(exist_ok=True)
    (source / f"{PAGE}.md").write_text(page(lambda address: (source / f"{address}.md").is_file()), "utf-8")


def page(exists=lambda address: True):
    """The page of all papers: those with a page of their own, then those that are cited only."""
    own = [text for text in uses.texts() if text.kind == "papers"]
    keys = {key for text in own for key in _keys(text.address)}
    sections = [_section(text, exists) for text in own]
    rest = {cited: files for cited, files in sorted(citations().items()) if not any(_is(key, *cited) for key in keys)}
    rows = [f"| {authors} ({year}) | {', '.join(_shown(files))} |" for (authors, year), files in rest.items()]
    table = "\n".join(["## Cited in docstrings", "", "| work | cited by |", "| --- | --- |", *rows, ""])
    return HEAD + "\n".join(sections) + "\n" + table


def _section(text, exists):
    keys = _keys(text.address)
    citing = [one for one in uses.citing_texts() if any(_cites(one.text, *key) for key in keys) and one is not text]
    used = [uses.docstrings(name) for name in uses.own_names() if text in uses.uses_of(name).get("papers", [])]
    names = list(dict.fromkeys([*(one for one in citing if one.kind == "names"), *used]))
    kinds = {"names": names} | uses.by_kind(one for one in citing if one.kind not in ("names", "papers"))
    anchor = text.address.rpartition("/")[2].replace("_", "-")
    lines = uses.links({kind: some for kind, some in kinds.items() if some}, PAGE, exists)
    return "\n".join([f"({anchor})=", f"## {text.title}", "", f"[The page](../{text.address}.md)", "", *lines, ""])


def _keys(address):
    """First author and year of the papers of a page: ``gil_2004_hulin_2006`` gives two."""
    return [
        (names.strip("_").split("_")[0].capitalize(), year)
        for names, year in re.findall(r"([a-z_]+)_(\d{4})", address.rpartition("/")[2])
    ]


def _cites(text, author, year):
    # most texts name no author, and the search is slow
    return author in text and re.search(rf"\b{author}\b[^.;]{{0,60}}{year}", text) is not None


def _is(key, authors, year):
    return authors.startswith(key[0]) and year == key[1]


def citations():
    """(authors, year) -> the names and files of code that cite a work; what a name cites is not listed again for its file."""
    found = {}
    for text in uses.citing_texts():
        if text.kind in ("names", "code"):
            for authors, year in CITED.findall(" ".join(text.text.split())):
                if not NO_AUTHORS & set(authors.rstrip(",").split()):
                    found.setdefault((authors.rstrip(","), year), []).append(text)
    return {cited: names if (names := [one for one in texts if one.kind == "names"]) else texts for cited, texts in found.items()}


def _shown(texts):
    return [uses.link(text, PAGE, lambda address: True) for text in dict.fromkeys(texts)]
