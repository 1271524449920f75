"""The gallery of scenes: a page each, from a file of ``docs/gallery/scenes``, which is run; and a page of cards."""

import contextlib
import io
import re
import tempfile
from dataclasses import dataclass
from pathlib import Path
from textwrap import dedent

import matplotlib.pyplot as plt
import numpy as np

import hapticlab as hl
from hapticlab.base.drawing import HOUSE
from hapticlab.compiler.boards.cost import cost

from ..running.examples import ExampleError
from ..running.frames import frame
from .library_code import library_code

REPOSITORY = Path(__file__).parents[3]
SCENES = Path("gallery", "scenes")
#: the scene of the front page
FIRST = "wall"
#: picture on a card, in parts of its size in a notebook
SMALLER = 0.7
BOARDS = {"uno": "Arduino Uno", "pico": "Raspberry Pi Pico", "cortex-m4f": "Cortex-M4F at 168 MHz"}
#: what is tried on a board where the library names nothing: the method that hl.compile chooses, then the cheapest
TRIED: tuple[dict[str, str], ...] = ({}, {"method": "semi_implicit_euler"})
_CHANGE = re.compile(r"^\* `(\S+)`: ", re.MULTILINE)
INDEX = """# Gallery

Every scene of the library, and scenes of walls, surfaces and machines that remember. Each page has the scene to move, the code
that makes it, its equations, and what it costs on a board. [Figures](figures/index.md) shows every kind of figure.

## Scenes of the library

{library}

## Walls, surfaces and machines

{own}

```{{toctree}}
:hidden:

figures/index
{pages}
```
"""
PAGE = """# {title}

{words}

{frame}

## Change this number
{changes}

## Equations

$$
{equations}
$$

{values}

## Code

{code}
{teaches}
## Method, period and cost

{costs}

{labs}
"""


@dataclass(frozen=True)
class Source:
    """A file of ``docs/gallery/scenes``: its docstring holds the words of the page.

    Attributes
    ----------
    name, title, words, code : str
        ``words`` are Markdown, ``code`` is what a reader types.
    labs : tuple of str
        Numbers of labs that use the scene.
    changes : dict
        Values in the notation of a shared file's address, and what a hand feels then.
    """

    name: str
    title: str
    words: str
    code: str
    labs: tuple
    changes: dict

    @classmethod
    def read(cls, path):
        """Return what a file says.

        Examples
        --------
        >>> Source.read(REPOSITORY / "docs/gallery/scenes/detents.py").labs
        ('17',)
        """
        _, doc, code = path.read_text("utf-8").split('"""', 2)
        (title, doc), labs = doc.split("\n", 1), re.search(r"^Labs: (.*)$", doc, re.MULTILINE)
        head, *changes = _CHANGE.split(doc.replace(labs[0], "") if labs else doc)
        told = {address: " ".join(words.split()) for address, words in zip(changes[::2], changes[1::2], strict=True)}
        return cls(path.stem, title, head.strip(), code.strip(), tuple(labs[1].split(", ")) if labs else (), told)

    @property
    def summary(self):
        """The first paragraph, for a card."""
        return " ".join(self.words.split("\n\n")[0].split())

    @property
    def entry(self):
        """The entry of the library, or None."""
        return dict(hl.library.catalogue).get(self.name)


def sources(folder):
    """Return the scenes of the gallery, those of the library in its order first."""
    found = {path.stem: Source.read(path) for path in sorted(Path(folder).glob("*.py"))}
    lacking = [name for name in hl.library.catalogue if name not in found]
    if lacking:
        raise ValueError(f"the gallery has no file for the library's {lacking[0]}; add docs/gallery/scenes/{lacking[0]}.py")
    return {name: found[name] for name in (*hl.library.catalogue, *(n for n in found if n not in hl.library.catalogue))}


def run(source):
    """Run the code of a page as a reader does; return the scene and the text of the file that hl.share wrote."""
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder), contextlib.redirect_stdout(io.StringIO()):
        names = {}
        exec(compile(source.code, f"{source.name}.py", "exec"), names)
        return names["scene"], Path(f"{source.name}.html").read_text("utf-8")


def page(source, scene, live):
    """Return the Markdown of a scene's page; ``live`` is the HTML of its frame."""
    address = f"../live/{source.name}.html"
    changes = [f"* {_link(f'{address}#{values}', values, source.name)}: {words}" for values, words in source.changes.items()]
    units = {name: "" if one.unit == "1" else f" {one.unit}" for name, one in scene.parameters.items()}
    values = [f"`{name} = {value:g}{units[name]}`" for name, value in scene.values.items()]
    return PAGE.format(
        title=source.title, words=source.words, frame=live, changes="\n".join(["", *changes]),
        equations=scene._repr_latex_().strip("$").removeprefix("\\displaystyle "),
        values=f"Here {', '.join(values)}." if values else "", code=code(source, scene), teaches=teaches(source),
        costs=costs(source, scene), labs=labs(source),
    )  # fmt: skip


def _link(address, words, frame_name):
    """A link that gives values to the frame on this page."""
    return f'<a href="{address}" target="{frame_name}">{words.replace(";", "; ").replace("*", "&#42;")}</a>'


def code(source, scene):
    """Return what a reader types, and for a scene of the library its equations written out, which give the same scene."""
    shown = f"```py\n{source.code}\n```\n"
    if source.entry is None:
        return shown
    written, names = library_code(source.entry.scene), {}
    exec(written, names)
    if names["scene"] != scene:
        raise ValueError("the code that the page writes out does not give the scene of the library")
    return f"{shown}\nThe same scene, written out:\n\n```py\n{written}\n```\n"


def teaches(source):
    """Return what the library says of a scene beyond its title: what one feels, and what it teaches."""
    if source.entry is None:
        return ""
    title, *rest = dedent("    " + source.entry.scene.__doc__).strip().split("\n\n")
    words = "\n\n".join([title, *rest]).split("\nParameters\n")[0].split("\nReturns\n")[0]
    plain = words.replace("\\|", "|").replace("``", "`")
    return "\n## What it teaches\n\n" + re.sub(r"([*_])(?=\w*['(])", r"\\\1", plain).strip() + "\n"


def costs(source, scene):
    """Return a table: what one tick of the scene takes of each board."""
    rows = [_row(board, called, source, scene) for board, called in BOARDS.items()]
    head = "| board | method | rate | cycles of the scene | of the period | |\n| --- | --- | --- | --- | --- | --- |\n"
    return (
        head
        + "\n".join(rows)
        + (
            "\n\nThe share of the period includes the rest of a control step and the telemetry. The cycles of the\n"
            "Uno and the Pico were measured in emulation, those of the Cortex-M4F are modelled. No board was on a bench."
        )
    )


def _row(board, called, source, scene):
    entry, usual = source.entry, {"T": hl.library.nominal.T}
    tried = [entry.uno] if entry and entry.uno and board == "uno" else [usual | more for more in TRIED]
    for options in tried:
        try:
            found = cost(hl.compile(scene, **options), board)
        except hl.HapticlabError:  # a method that this scene cannot have
            continue
        if found.fits:
            break
    method = found.program.facts.get("method") or "no equation of motion"
    why = "fits" if found.fits else found.memory_problem or f"does not fit; needs T >= {1e3 * found.T_needed():.3g} ms"
    return f"| {called} | {method.replace('_', ' ')} | {1 / found.T:.0f} Hz | {found.typical} | {found.share:.0%} | {why} |"


def labs(source):
    """Return links to the labs that use a scene."""
    used = set(source.labs)
    for notebook in (REPOSITORY / "labs").glob("*/*.ipynb"):
        if re.search(rf"library\.{source.name}\b", notebook.read_text("utf-8")):
            used.add(notebook.stem[:2])
    names = {path.name[:2]: path.name for path in (REPOSITORY / "labs").glob("[0-9][0-9]_*")}
    links = [f"[lab {number}](../labs/{names[number]}.md)" for number in sorted(used)]
    return f"In the labs: {', '.join(links)}." if links else ""


def card(source, plain=False):
    """Return a card of the index, without its picture where it is ``plain``."""
    picture = "" if plain else f":img-top: images/{source.name}.svg\n"
    return f""":::{{grid-item-card}} {source.title}
:link: {source.name}
:link-type: doc
{picture}
{source.summary}
:::"""


def index(found, plain=False):
    """Return the Markdown of the page of cards."""
    grids = [[card(one, plain) for one in found.values() if bool(one.entry) is of_library] for of_library in (True, False)]
    library, own = ("::::{grid} 1 2 3 3\n:gutter: 3\n\n" + "\n".join(cards) + "\n::::" for cards in grids)
    return INDEX.format(library=library, own=own, pages="\n".join(found))


def write(source: Path, quick: bool = False) -> None:
    """Write the pages of all scenes and their cards; where ``quick``, run the scene of the front page alone."""
    folder, found = Path(source, "gallery"), sources(source / SCENES)
    (folder / "images").mkdir(exist_ok=True)
    for name, one in found.items():
        try:
            text = f"# {one.title}\n\n{one.words}\n" if quick and name != FIRST else _page_that_ran(one, folder)
        except Exception as problem:
            raise ExampleError(f"docs/gallery/scenes/{name}.py: {type(problem).__name__}: {problem}") from problem
        (folder / f"{name}.md").write_text(text, "utf-8")
    (folder / "index.md").write_text(index(found, quick), "utf-8")


def _page_that_ran(source, folder):
    """Run a scene, write its picture and its frame, and return its page."""
    scene, html = run(source)
    title = f"{source.title}: a scene to move"
    live = frame(source.name, html, folder=folder.parent, page=f"gallery/{source.name}", title=title)
    thumbnail(scene, bool(source.entry)).savefig(folder / "images" / f"{source.name}.svg", metadata={"Date": None})
    return page(source, scene, live)


def thumbnail(scene, of_library):
    """Return a small picture for a card: what moves, or for a scene that is a law alone its force, there and back."""
    if of_library or any(type(q).unit in ("m", "rad") for q in scene.coordinates):
        figure = hl.mechanics.picture(scene)
        figure.axes[0].set_title("")  # the card has it
        figure.set_size_inches(SMALLER * figure.get_size_inches())
        return figure
    there_and_back = 0.01 * (1 - np.cos(np.pi * np.linspace(0, 2, 2001)))
    log = hl.records.evaluate(hl.compile(scene, T=1e-3), x=there_and_back)
    with plt.rc_context(HOUSE):
        figure, axes = plt.subplots(figsize=(3.6, 1.67), layout="constrained")
        axes.plot(1e3 * log.x, log.F)
        axes.set(xlabel="x [mm]", ylabel="F [N]")
        plt.close(figure)
    return figure
