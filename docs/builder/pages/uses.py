"""Where labs, pages, papers and tests use a public name, and where they cite an equation or a figure of the chapter."""

import inspect
import json
import re
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path

from .public_names import NAMESPACES, module_of, names_of, own_names

ROOT = Path(__file__).parents[3]
_DOTTED = re.compile(r"\bhl\.(\w+)(?:\.(\w+))?")
_IMPORTED = re.compile(r"^ *from (hapticlab[\w.]*) import (\([^)]*\)|.*)", re.M)
#: in a text, or in the name of a test
EQUATION = re.compile(r"\(23\.(\d+)\)|(?<!fig)_23_(\d+)")
FIGURE = re.compile(r"Fig(?:s?\.|ure) 23\.(\d+)|fig_23_(\d+)")
KINDS = ("names", "labs", "pages", "papers", "tests", "code")
#: folders of docs/ whose pages are looked through
FOLDERS = ("tutorial", "how_to", "explanation", "teaching", "paddle", "extending", "project")


@dataclass(frozen=True)
class Text:
    """One text that may use a name: its kind ("labs", "pages", "papers", "tests"), its address, its title, and itself."""

    kind: str
    address: str
    title: str
    text: str

    @cached_property
    def names(self):
        """The public names that it uses, as ``(namespace, short)``, and what it imports, as ``(module, name)``."""
        found = {(first, second) if first in NAMESPACES else ("hl", first) for first, second in _DOTTED.findall(self.text)}
        return found | {
            (module.replace("hapticlab", "hl") if module.count(".") == 0 else module, one)
            for module, names in _IMPORTED.findall(self.text)
            for one in re.findall(r"\w+", names)
        }

    @cached_property
    def equations(self):
        """The numbers of the chapter's equations that it names."""
        return {int(one or other) for one, other in EQUATION.findall(self.text)}

    @cached_property
    def figures(self):
        """The numbers of the chapter's figures that it names."""
        return {int(one or other) for one, other in FIGURE.findall(self.text)}


@cache
def texts():
    """Return every text, labs first."""
    return (*_labs(), *_pages(), *_files("tests", "tests/**/test_*.py"))


def _labs():
    for path in sorted((ROOT / "labs").glob("[0-9]*/*.ipynb")):
        cells = json.loads(path.read_text("utf-8"))["cells"]
        text = "\n".join("".join(cell["source"]) for cell in cells)
        title = f"Lab {path.stem[:2]}, {path.stem[3:].replace('_', ' ')}"
        yield Text("labs", f"labs/{path.stem}", title, text)


def _pages():
    for path in sorted((ROOT / "docs").glob("**/*.md")):
        address = path.relative_to(ROOT / "docs").with_suffix("").as_posix()
        kind = {"papers": "papers"}.get(address.partition("/")[0], "pages")
        if path.stem != "README" and (kind == "papers" or address.partition("/")[0] in FOLDERS):
            text = path.read_text("utf-8")
            yield Text(kind, address, _title(text, path.stem), text)


def _title(text, stem):
    found = re.search(r"^# (.+)$", text, re.M)
    return found[1].strip() if found else stem


def _files(kind, pattern):
    """Files of code; the address of each is its path in the repository, for the site holds none."""
    for path in sorted(ROOT.glob(pattern)):
        address = path.relative_to(ROOT).as_posix()
        yield Text(kind, address, address, path.read_text("utf-8"))


@cache
def citing_texts():
    names = [docstrings(name) for name in own_names()]
    return (*names, *texts(), *_files("code", "hapticlab/**/*.py"))


def uses_of(name):
    """The texts that use a public name under any of its paths, by kind; first the tests of its own module."""
    spelt = _spellings(name)
    own = f"test_{getattr(name.value, '__module__', '').rpartition('.')[2]}"
    found = [text for text in texts() if text.names & spelt]
    return by_kind(sorted(found, key=lambda text: text.title.rpartition("/")[2].removesuffix(".py") != own))


def _spellings(name):
    """Every ``(namespace, short)`` of a name, and ``(module, name)`` of where it is defined."""
    defined = {(getattr(name.value, "__module__", ""), getattr(name.value, "__name__", ""))}
    return defined | {(page, short) for page, short, value in _everywhere() if value is name.value}


@cache
def _everywhere():
    return [(page, short, getattr(module_of(page), short)) for page in NAMESPACES for short in names_of(page)]


def citing(number, kind):
    """The texts that name an equation or a figure of the chapter, by kind: names, labs, pages, papers, tests, code."""
    return by_kind(text for text in citing_texts() if number in (text.equations if kind == "equation" else text.figures))


def by_kind(found):
    """Texts by their kind, in the order of KINDS."""
    kinds = {kind: [] for kind in KINDS}
    for text in found:
        kinds[text.kind].append(text)
    return {kind: some for kind, some in kinds.items() if some}


def links(found, there, exists=lambda address: True, most=12):
    """Yield a line of Markdown on each kind of text: links from the page ``there``; of tests, and of pages not built, names."""
    for kind, some in found.items():
        shown = [link(text, there, exists) for text in some[:most]]
        rest = f" and {len(some) - most} more" if len(some) > most else ""
        yield f"- {kind.capitalize()}: {', '.join(shown)}{rest}"


def link(text, there, exists):
    if text.kind == "names":
        return f"{{py:obj}}`{text.title} <{text.title.replace('hl', 'hapticlab', 1)}>`"
    if text.kind in ("tests", "code"):
        return f"`{text.address}`"
    steps = "../" * there.count("/")
    return f"[{text.title}]({steps}{text.address}.md)" if exists(text.address) else text.title


def docstrings(name):
    """What a public name and its members say of themselves."""
    said = [name.doc, *(inspect.getdoc(member) or "" for member in name.members.values())]
    return Text("names", name.document, name.typed, "\n".join(said))
