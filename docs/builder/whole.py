"""A whole build: sources are copied, pages are written and their examples run, Sphinx makes HTML, and the HTML is checked."""

import contextlib
import gc
import io
import shutil
import tempfile
import time
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

from hapticlab.errors import HapticlabError

from . import anchors, check
from .generators import GENERATORS, INDEXES, LONG
from .pages.lab_pages import IN_BROWSER
from .pages.licences import without_a_part
from .running import outcomes
from .running.examples import ExampleError
from .running.frames import LIVE

DOCS = Path(__file__).resolve().parents[1]
#: in the folder of a build: what says that the next one may replace it
MARK = ".hapticlab-docs"
#: pages whose examples run in the small form
QUICK = ("how_to/live.md", "explanation/people.md", "papers/abbott_okamura_2005.md")


class BuildError(Exception):
    """The site cannot be built, with every reason in its message."""


@dataclass(frozen=True)
class Built:
    """What was built: where, its pages, words and links, the examples that ran, and how long it took."""

    folder: Path
    counted: check.Counted
    examples: int
    seconds: float


def build(folder, *, quick=False, labs=False, pyodide=None, say=print):
    """Build the site.

    Parameters
    ----------
    folder : Path
        Where to; an earlier build there is replaced.
    quick : bool
        Whether to run the examples of a few pages alone.
    labs : bool
        Whether to embed the labs in a browser.
    pyodide : Path, optional
        Distribution of Pyodide for these.
    say : callable
        Is told each step and how long it took.

    Raises
    ------
    BuildError
        If the folder holds anything else, an example fails, Sphinx warns, a link leads nowhere, or the labs cannot be embedded.
    """
    folder, began = Path(folder).resolve(), time.monotonic()
    _check_folder(folder)
    with tempfile.TemporaryDirectory() as aside:
        source, made = Path(aside, "docs"), Path(aside, "site")
        shutil.copytree(DOCS, source, ignore=shutil.ignore_patterns("__pycache__"))
        clock = _Clock(say)
        if labs:
            _embed_labs(Path(aside, IN_BROWSER), pyodide, say)  # first, since it asks for most
            clock.say("the labs in a browser")
            (source / IN_BROWSER).mkdir()  # pages of labs link to it
        _write_pages(source, quick, clock)
        ran = _run_examples(source, quick)
        clock.say(f"{ran} examples")
        _sphinx(source, made)
        if (source / LIVE).is_dir():
            shutil.copytree(source / LIVE, made / LIVE)
        clock.say("Sphinx")
        if labs:
            Path(aside, IN_BROWSER).rename(made / IN_BROWSER)
        counted = check.look_through(made, anchors.expected())
        static = made / "_static"
        shipped = [path.relative_to(static).as_posix() for path in static.rglob("*") if path.is_file()]
        wrong = counted.wrong + [f"_static/{name} has no licence in licences.py" for name in without_a_part(shipped)]
        if wrong:
            raise BuildError("\n".join(wrong))
        clock.say(f"{counted.pages} pages with {counted.words} words and {counted.links} links, all of which lead somewhere")
        (made / ".nojekyll").touch()  # GitHub's pages would leave out folders that begin with an underscore
        _replace(folder, made)
    seconds = time.monotonic() - began
    say(f"{folder}: built in {seconds:.0f} s without a warning")
    return Built(folder, counted, ran, seconds)


class _Clock:
    """Says what was done, and how long after the last word."""

    def __init__(self, say):
        self._say, self._last = say, time.monotonic()

    def say(self, words):
        now = time.monotonic()
        self._say(f"{now - self._last:6.1f} s  {words}")
        self._last = now


def _check_folder(folder):
    """Make the folder, unless it holds anything but a site."""
    if folder.is_relative_to(DOCS):
        raise BuildError(
            f"{folder} is inside {DOCS}, so that the next build would copy the site into itself; name another folder"
        )
    if folder.exists() and not (folder.is_dir() and ((folder / MARK).exists() or not any(folder.iterdir()))):
        raise BuildError(f"{folder} is there and is no site of an earlier build; name an empty or a new folder")
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as problem:
        raise BuildError(f"{folder} cannot be written: {problem.strerror}; name another folder") from problem


def _replace(folder, made):
    """Put a site into its folder, which is marked throughout: what is cut off on the way is replaced by the same command."""
    (folder / MARK).touch()
    for path in folder.iterdir():
        if path.is_dir() and not path.is_symlink():
            shutil.rmtree(path)
        elif path.name != MARK:
            path.unlink()
    shutil.copytree(made, folder, dirs_exist_ok=True)


def _write_pages(source, quick, clock):
    """Have every generator write its pages."""
    for generator in (*GENERATORS, *LONG, *INDEXES):
        try:
            generator(source, **({"quick": quick} if generator in LONG else {}))
        except ExampleError as problem:
            raise BuildError(str(problem)) from problem
        clock.say(f"pages by {generator.__module__.rpartition('.')[2]}")


def _run_examples(source, quick):
    """Run the examples of every page, or of a few; return how many ran."""
    pages = sorted(path.relative_to(source).as_posix() for path in source.rglob("*.md"))
    try:
        return sum(outcomes.write(source, page) for page in pages if page in QUICK or not quick)
    except ExampleError as problem:
        raise BuildError(str(problem)) from problem


def _sphinx(source, made):
    """Make the HTML; every warning is an error."""
    from sphinx.application import Sphinx
    from sphinx.util.console import nocolor
    from sphinx.util.docutils import docutils_namespace, patch_docutils

    (mathjax,) = Path(find_spec("sphinx-mathjax-offline").origin).parent.glob("static/mathjax/tex-svg.js")
    shutil.copy(mathjax, source / "builder" / "static")
    nocolor()
    warned = io.StringIO()
    folders = {"srcdir": source, "confdir": source / "builder", "outdir": made, "doctreedir": made.with_name("doctrees")}
    with patch_docutils(), docutils_namespace(), contextlib.redirect_stderr(warned):
        app = Sphinx(**folders, buildername="html", status=None, warning=warned, parallel=2)
        with _rare_collection():
            app.build(force_all=True)
    if warned.getvalue().strip():
        raise BuildError(warned.getvalue())


@contextlib.contextmanager
def _rare_collection():
    """Look for garbage rarely: Sphinx unpickles every page, and each look walks through all pages before it."""
    before = gc.get_threshold()
    gc.set_threshold(1_000_000, *before[1:])
    try:
        yield
    finally:
        gc.set_threshold(*before)


def _embed_labs(folder, pyodide, say):
    from hapticlab.site.build import build_site

    try:
        build_site(folder, pyodide=pyodide, say=say)
    except HapticlabError as problem:
        raise BuildError(str(problem)) from problem
