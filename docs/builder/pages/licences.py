"""The page of licences: the text of everything that the site ships, part by part, and which files belong to which part."""

from dataclasses import dataclass
from fnmatch import fnmatchcase
from importlib.metadata import distribution
from pathlib import Path

PAGE = "project/licences.md"
TEXTS = Path(__file__).with_name("texts")
LICENCE = ("licen[cs]e*", "copying*")
HEAD = """# Licences

Everything that this site ships, with the text of its licence. The labs in a browser, where the site has them, bring a list of
their own.
"""


@dataclass(frozen=True)
class Part:
    """A part of the site: the patterns of its files below ``_static``, whose it is, and where its licence text comes from.

    ``holder`` is the copyright line of a text that names none; ``package`` is installed and brings its own text.
    """

    name: str
    files: tuple[str, ...]
    package: str = ""
    holder: str = ""
    texts: tuple[str, ...] = ()

    @property
    def text(self):
        """The whole text of its licence."""
        own = [_installed(self.package)] if self.package else []
        return "\n\n".join(
            [*filter(None, [self.holder]), *own, *((TEXTS / name).read_text("utf-8") for name in self.texts)]
        ).strip()


PARTS = (
    Part("hapticlab", tuple(path.name for path in (Path(__file__).parents[1] / "static").iterdir()), package="hapticlab"),
    Part("Sphinx", (
        "basic.css", "doctools.js", "documentation_options.js", "searchtools.js", "sphinx_highlight.js", "language_data.js",
        "translations.js", "*.png",
    ), package="sphinx"),
    Part("Snowball, which finds the stems of words", ("*-stemmer.js",), package="snowballstemmer"),
    Part("Pygments, whose styles colour code", ("pygments.css",), package="pygments"),
    Part("PyData Sphinx Theme", ("*.html", "styles/*", "scripts/pydata-sphinx-theme.js*"), package="pydata-sphinx-theme"),
    Part("Bootstrap", ("scripts/bootstrap.js*",), holder="Copyright (c) 2011-2024 The Bootstrap Authors", texts=("mit.txt",)),
    Part(
        "Font Awesome Free",
        ("scripts/fontawesome.js*", "vendor/fontawesome/*"),
        holder="Copyright Fonticons, Inc. (https://fontawesome.com)\n\nThe code is under the MIT License, the fonts "
        "are under the SIL OFL 1.1 and the icons under CC BY 4.0 (https://creativecommons.org/licenses/by/4.0/), in this order.",
        texts=("mit.txt", "ofl-1.1.txt", "cc-by-4.0.txt"),
    ),
    Part("sphinx-design", ("sphinx-design.min.css", "design-tabs.js"), package="sphinx-design"),
    Part("sphinx-copybutton", ("copybutton.css", "copybutton.js", "copybutton_funcs.js"), package="sphinx-copybutton"),
    Part("clipboard.js", ("clipboard.min.js",), holder="Copyright (c) Zeno Rocha", texts=("mit.txt",)),
    Part("Tabler Icons", ("copy-button.svg", "check-solid.svg"), holder="Copyright (c) 2020-2024 Paweł Kuna", texts=("mit.txt",)),
    Part("MathJax 3.2.2", ("tex-svg.js",), holder="Copyright (c) 2009-2022 The MathJax Consortium", texts=("apache-2.0.txt",)),
)  # fmt: skip


def write(source):
    """Write the page into the copied source."""
    sections = [f"## {part.name}\n\n```text\n{part.text}\n```\n" for part in PARTS]
    (source / PAGE).write_text("\n".join([HEAD, *sections]), "utf-8")


def without_a_part(files):
    """Return those files below ``_static``, by their names there, that belong to no part.

    Examples
    --------
    >>> without_a_part(["basic.css", "vendor/fontawesome/webfonts/fa-solid-900.woff2", "stray.js"])
    ['stray.js']
    """
    patterns = [pattern for part in PARTS for pattern in part.files]
    return [name for name in files if not any(fnmatchcase(name, pattern) for pattern in patterns)]


def _installed(package):
    """Return the licence texts that an installed package brings."""
    found = distribution(package)
    paths = [path for path in found.files or () if any(fnmatchcase(path.name.lower(), pattern) for pattern in LICENCE)]
    inside = [path for path in paths if ".dist-info" in path.parts[0] and path.suffix != ".py"]
    if not inside and package == "hapticlab":  # from a checkout
        return (Path(__file__).resolve().parents[3] / "LICENSE").read_text("utf-8")
    return "\n\n".join(Path(found.locate_file(path)).read_text("utf-8") for path in inside)
