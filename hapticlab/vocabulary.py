"""The pages of public names, and ``hl.find``, which says what does what."""

from __future__ import annotations

import html
import importlib
import inspect
import sys
from difflib import get_close_matches
from types import ModuleType
from typing import Any, NoReturn

#: every namespace of ``hl``, in the order in which a course meets them
PAGES = (
    "library", "laws", "velocity", "contact", "shapes", "mechanics", "devices", "people", "records", "passivity", "stability",
    "bounds", "design", "measure", "identify", "methods", "errors",
)  # fmt: skip

#: what objects say of themselves that can carry no docstring
SAYS = {
    "hl.T": "Sampling period T [s] in a scene: a parameter that gets its value from ``hl.compile(scene, T=...)`` or the paddle.",
    "hl.n": "Number of the present sample: ``x(n)`` is the position now, ``x(n-1)`` one sample before.",
    "hl.t": "Time t [s] in an equation of motion: ``x(t)`` is the position of the handle, ``z.diff(t)`` a rate.",
    "hl.library.catalogue": "All ready scenes by name, with their equations, what they need and where they run; print it.",
    "hl.library.nominal": "Profile of the paddle that the library's scenes are set for: round numbers, not measured.",
    "hl.design.textbook": "Profile of the paddle that the tasks of designs are set for by default: round numbers, not measured.",
}


class Page(ModuleType):
    """A module that prints as the list of what it holds, and answers a wrong name with those that come near."""

    __all__: list[str]

    def __dir__(self) -> list[str]:
        return self.__all__

    def __getattr__(self, name: str) -> Any:
        title = self.__name__.replace("hapticlab", "hl", 1)
        if name.startswith("_"):
            raise AttributeError(f"{title} has no {name}")
        raise AttributeError(f"{title} has no {name}; {_cure(name)}")

    def __call__(self, *_: Any, **__: Any) -> NoReturn:
        title = self.__name__.replace("hapticlab", "hl", 1)
        some = ", ".join(f"{title}.{name}" for name in self.__all__ if name.islower())
        raise TypeError(f"{title} is a page of names, no function; it holds {some}")

    def __repr__(self) -> str:
        return "\n".join([str(self.__doc__).strip(), "", *_columns(self._rows())])

    def _repr_html_(self) -> str:
        return f"<pre>{html.escape(str(self.__doc__).strip())}</pre>{_table(self._rows())}"

    def _rows(self) -> dict[str, str]:
        title = self.__name__.replace("hapticlab", "hl", 1)
        paths = {f"{title}.{name}": getattr(self, name) for name in self.__all__}
        return {path: _first_line(path, value) for path, value in paths.items()}


def page(name: str) -> None:
    """Make the module of this name a :class:`Page`."""
    sys.modules[name].__class__ = Page


class Found(dict[str, str]):
    """Public names, each with the first line of what it says of itself."""

    def __repr__(self) -> str:
        return "\n".join(_columns(self)) or "nothing found; print(hl.laws) and the other pages list what there is"

    def _repr_html_(self) -> str:
        return _table(self) if self else f"<pre>{self!r}</pre>"


def find(words: str = "") -> Found:
    """Find public names by words in the name or in its first line, or, if there is none, in its description.

    Parameters
    ----------
    words : str
        One or more words, such as "velocity" or "largest stiffness"; without a word every public name is listed.

    Returns
    -------
    Found
        A dict from name to the first line of its docstring; it prints as a table.

    Examples
    --------
    >>> import hapticlab as hl
    >>> print(hl.find("kalman"))
    hl.velocity.kalman  Kalman filter of position and velocity under white acceleration, held over each period.
    """
    asked = words.lower().split()
    values = public()
    lines = {name: _first_line(name, value) for name, value in values.items()}
    at_once = {name: line for name, line in lines.items() if all(word in f"{name} {line}".lower() for word in asked)}
    return Found(at_once or {name: line for name, line in lines.items() if _speaks_of(values[name], asked)})


def _speaks_of(value, asked):
    described = (inspect.getdoc(value) or "").lower()
    return all(word in described for word in asked)


def public() -> dict[str, Any]:
    """Every public name and what it stands for, those of ``hl`` itself first; what stands in both is there once."""
    house = importlib.import_module("hapticlab")
    here = {f"hl.{name}": getattr(house, name) for name in house.__all__ if name not in PAGES}
    pages = {name: importlib.import_module(f"hapticlab.{name}") for name in PAGES}
    there = {f"hl.{title}.{name}": getattr(page, name) for title, page in pages.items() for name in page.__all__}
    known = {id(value) for value in here.values()}
    return here | {name: value for name, value in there.items() if id(value) not in known}


def _first_line(path, value):
    return SAYS.get(path) or (inspect.getdoc(value) or "").partition("\n")[0]


def _columns(rows):
    width = max(map(len, rows), default=0)
    return [f"{name:<{width}}  {line}" for name, line in rows.items()]


def _table(rows):
    cells = ((html.escape(name), html.escape(line)) for name, line in rows.items())
    left = 'style="text-align: left"'
    lines = (f"<tr><td {left}><code>{name}</code></td><td {left}>{line}</td></tr>" for name, line in cells)
    return f"<table>{''.join(lines)}</table>"


def _cure(wrong):
    """The public names that a wrong one may mean, in words."""
    known = public()
    words = {path: (path.rpartition(".")[2].lower(), getattr(value, "__name__", "")) for path, value in known.items()}
    if exact := [path for path, names in words.items() if wrong.lower() in names]:
        return f"did you mean {' or '.join(exact)}?"
    asked = set(wrong.lower().split("_"))
    paths = list(known)
    holding = [path for path in paths if asked <= set(path.lower().replace(".", "_").split("_")[1:])]
    ends = {path.rpartition(".")[2].lower(): path for path in paths}
    near = [ends[end] for end in get_close_matches(wrong.lower(), ends, 2, 0.75)]
    if found := sorted(holding, key=len)[:3] or near:
        return f"did you mean {' or '.join(found)}?"
    return "hl.find('a word') lists the names that speak of it"


def unknown(name: str) -> str:
    """What to say of a name that ``hl`` does not hold."""
    return f"hapticlab has no {name}; {_cure(name)}"
