"""The licence texts of everything that a site contains, in its folder ``licences``, and what has none."""

import json
import re
import zipfile
from dataclasses import dataclass
from html import escape
from importlib.metadata import distribution
from pathlib import Path, PurePosixPath

from .lite import EXTENSIONS
from .needs import normal
from .pages import PAGES
from .pyodide_archive import CORE, LOCK

FOLDER = "licences"
TEXTS = Path(__file__).with_name("texts")
#: what JupyterLite writes into the root of a site
LITE = {
    "bootstrap.js", "config-utils.js", "icon-120x120.png", "icon-512x512.png", "jupyter-lite.ipynb", "jupyter-lite.json",
    "jupyterlite.schema.v0.json", "manifest.webmanifest", "package.json", "service-worker.js",
}  # fmt: skip
OWN = {"index.html", ".nojekyll", "hapticlab-site.json", "overrides.json", "pypi/all.json"}
#: part of a file's name -> the fonts that it is of, and the package of JavaScript that brings their licence
FONTS = {"MathJax_": ("Fonts of MathJax", "mathjax-full"), "fa-": ("Font Awesome", "@fortawesome/fontawesome-free")}
#: beginnings of the names of packages that bring no text -> the text that they are under
WITHOUT_A_TEXT = {
    "@jupyter": "jupyterlab.txt", "@lumino/": "jupyterlab.txt", "@microsoft/fast": "mit.txt",
    "json-schema-merge-allof": "mit.txt", "vega": "vega.txt", "pyserial": "pyserial.txt",
}  # fmt: skip
#: packages whose wheels of Pyodide contain compiled libraries of others, and bring only their own text -> the texts of these
LIBRARIES = {
    "matplotlib": ("matplotlib.txt", "freetype.txt"), "pillow": ("pillow.txt", "freetype.txt"), "scipy": ("openblas.txt",),
}  # fmt: skip
LICENCE = re.compile(r"licen[cs]e|copying|notice|authors", re.I)
CODE = {".py", ".pyi", ".pyc", ".json", ".js", ".html"}
HEAD = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Licences of this site</title>
<style>
:root { color-scheme: light dark; }
body { margin: 0 auto; padding: 1.5rem 1.25rem 3rem; max-width: 52rem; font: 16px/1.5 system-ui, sans-serif; }
</style>
</head>
<body>
<h1>Licences of this site</h1>
<p>Each file of this site belongs to one part of this list, and each part has its licence text.</p>
<ul>
"""


@dataclass(frozen=True)
class Part:
    """A part of a site: its files, its licence text, and the names of what in it has no text."""

    name: str
    files: tuple[str, ...]
    text: str
    lacking: tuple[str, ...] = ()

    @property
    def address(self):
        """The file of its text."""
        return f"{re.sub(r'[^a-z0-9]+', '-', self.name.lower()).strip('-')}.txt"


def write(site):
    """Write the texts and their list into a site's folder; return the names of files and packages without a text."""
    folder = Path(site, FOLDER)
    folder.mkdir()
    found, rows = parts(site), []
    for part in found:
        if part.name:
            (folder / part.address).write_text(part.text, "utf-8")
            rows.append(f'<li><a href="{part.address}">{escape(part.name)}</a>: {_counted(part.files)}</li>\n')
    (folder / "index.html").write_text(HEAD + "".join(rows) + "</ul>\n</body>\n</html>\n", "utf-8")
    return without_text(found)


def without_text(found):
    """Return the names of files and packages that have no licence text, of some parts."""
    return [name for part in found for name in (part.lacking or (() if part.text.strip() else part.files))]


def _counted(files):
    return escape(files[0]) if len(files) == 1 else f"{len(files)} files, such as {escape(files[0])}"


def parts(site):
    """Return the parts of a site in the order of their names; the one without a name has the files of no known part."""
    site, owned = Path(site), {}
    for path in sorted(path.relative_to(site).as_posix() for path in site.rglob("*") if path.is_file()):
        if not path.startswith(f"{FOLDER}/"):
            owned.setdefault(owner(path), []).append(path)
    packages = {one["name"]: one for one in _javascript(site / "build")}
    made = [Part(name, tuple(files), *_text(name, site, files, packages)) for name, files in owned.items()]
    return sorted(made, key=lambda part: part.name.lower())


def owner(path):
    """Return the name of the part that a file of a site belongs to; empty where it is none that is known.

    Examples
    --------
    >>> owner("build/MathJax_Main-Bold.woff"), owner("static/pyodide/pyodide.mjs"), owner("lab/index.html"), owner("stray.js")
    ('Fonts of MathJax', 'Pyodide and Python', 'JupyterLab and JupyterLite', '')
    """
    parts = PurePosixPath(path).parts
    if path.endswith(".whl") and parts[0] in ("pypi", "static"):
        return " ".join(parts[-1].split("-")[:2])
    if parts[:2] == ("static", "pyodide") and parts[-1] in (*CORE, LOCK):
        return "Pyodide and Python"
    if parts[0] == "extensions":
        return next((name for name, folder in EXTENSIONS.items() if path.startswith(f"extensions/{folder}/")), "")
    for beginning, (name, _) in FONTS.items():
        if parts[0] == "build" and parts[-1].startswith(beginning):
            return name
    if parts[0] in ("build", "lab", "notebooks", "tree") or path in LITE or parts[:2] == ("static", "favicons"):
        return "JupyterLab and JupyterLite"
    own = parts[0] in ("files", "api") or path in OWN or path in {page.file for page in PAGES}
    return "hapticlab" if own else ""


def _text(name, site, files, packages):
    """Return the text of a part, and what in it has none."""
    fonts = {font: packages.get(package, {}).get("extractedText", "") for font, package in FONTS.values()}
    if name in fonts:
        return fonts[name], ()
    if name == "Pyodide and Python":
        return "\n\n".join(_brought(text) for text in ("mpl-2.0.txt", "python.txt", "mit.txt", "c-libraries.txt")), ()
    if name == "JupyterLab and JupyterLite":
        return _joined(_installed("jupyterlite-core"), packages.values())
    if name in EXTENSIONS:
        return _joined(_installed(name), _javascript(site / "extensions" / EXTENSIONS[name] / "static"))
    if name == "hapticlab":
        return _of_wheel(next((site / "pypi").glob("hapticlab-*.whl"))), ()
    return (_of_wheel(site / files[0]), ()) if files[0].endswith(".whl") else ("", ())


def _joined(text, packages):
    """Return a text, followed by those of packages of JavaScript, and the names of packages without any."""
    texts = {one["name"]: one["extractedText"].strip() or _instead(one["name"]) for one in packages}
    whole = [text, *(f"{'=' * 80}\n{name}\n\n{found}" for name, found in texts.items())]
    return "\n\n".join(whole), tuple(name for name, found in texts.items() if not found)


def _javascript(folder):
    """Return the records of packages that a folder of bundled JavaScript lists."""
    path = folder / "third-party-licenses.json"
    return json.loads(path.read_text("utf-8"))["packages"] if path.is_file() else []


def _instead(name):
    """Return the text of a package that brings none; empty where that is not known."""
    return next((_brought(text) for beginning, text in WITHOUT_A_TEXT.items() if name.startswith(beginning)), "")


def _brought(name):
    return (TEXTS / name).read_text("utf-8")


def _installed(name):
    """Return the licence texts of an installed package."""
    found = distribution(name)
    paths = [path for path in found.files or () if ".dist-info" in path.parts[0] and LICENCE.search(path.name)]
    return "\n\n".join(Path(found.locate_file(path)).read_text("utf-8") for path in paths) or _instead(normal(name))


def _of_wheel(wheel):
    """Return the licence texts of a wheel: its own, those of fonts and sources in it, and those of compiled libraries in it."""
    package = normal(wheel.name.partition("-")[0])
    with zipfile.ZipFile(wheel) as packed:
        names = [path for path in map(PurePosixPath, packed.namelist()) if LICENCE.search(path.name) and path.suffix not in CODE]
        texts = [packed.read(str(path)).decode("utf-8", "replace") for path in names]
        own = any(path.parts[0].endswith(".dist-info") for path in names)
        compiled = any(name.endswith(".so") for name in packed.namelist())
    brought = map(_brought, LIBRARIES.get(package, ())) if compiled else ()
    return "\n\n".join([*([] if own else filter(None, [_instead(package)])), *texts, *brought])
