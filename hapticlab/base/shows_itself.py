"""How everything that a public call returns shows itself: a sentence, a small table with units, the figure, details folded.

A class says what it is by ``__str__``, whose first line is its sentence, by the units of its documented attributes, and by
``plot`` where a figure is due. From these come one line for ``repr``, and HTML for a notebook: without scripts, names and
style sheets, in the colours of the page.
"""

from __future__ import annotations

import inspect
from collections.abc import Iterator
from html import escape
from typing import Any, ClassVar

from ..errors import HapticlabError
from .facts import Fact, are_records, facts, in_words
from .grid import Grid

#: facts and rows that are shown before the rest is folded, or left to print and to_pandas
OPEN, ROWS = 8, 20
#: names of laws and holds that are one word, which begin a sentence as they are typed
LAWS = ("zoh", "foh", "soh", "ellis", "deadbeat")
#: numbers of one fact that stand in a line
FEW = 6
_LINE = "var(--jp-border-color2, rgba(128, 128, 128, 0.4))"
_ROW = f"border-bottom: 1px solid {_LINE}"
_CELL = "text-align: left; padding: 0.15em 1em 0.15em 0; border: 0"
_TABLE = "margin: 0.3em 0; border-collapse: collapse; color: inherit"
_QUIET = "color: var(--jp-ui-font-color2, inherit)"


class ShowsItself:
    """What a notebook shows of an object, and its ``repr`` in one line; ``_hidden`` are facts that say nothing there.

    Examples
    --------
    >>> from dataclasses import dataclass
    >>> @dataclass
    ... class Spring(ShowsItself):
    ...     '''A spring.
    ...
    ...     Attributes
    ...     ----------
    ...     K : float
    ...         Stiffness [N/m].
    ...     '''
    ...     K: float
    ...     def __str__(self):
    ...         return f"a spring of {self.K:g} N/m"
    >>> Spring(200)
    Spring(a spring of 200 N/m)
    >>> "<td" in Spring(200)._repr_html_()
    True
    """

    _hidden: ClassVar[tuple[str, ...]] = ()
    _own_line: ClassVar[bool] = False

    def __init_subclass__(cls, **options: Any) -> None:
        """Give a class one line for ``repr``, where it says itself by ``__str__`` and inherits no ``__repr__`` written by hand.

        A dataclass, which is made after this, keeps a method that stands in the class itself.
        IPython looks for both methods in one class after the other, so each has its own entry.
        """
        super().__init_subclass__(**options)
        cls._repr_pretty_ = ShowsItself._all_words  # type: ignore[attr-defined]
        if "__repr__" in cls.__dict__:
            cls._own_line = True
        elif cls._own_line:
            cls.__repr__ = cls.__repr__  # type: ignore[method-assign]
        elif cls.__str__ is not object.__str__:
            cls.__repr__ = _in_one_line  # type: ignore[method-assign, assignment]

    def _sentence(self) -> str:
        """What it says first: the first line of its text, or of what its class says of itself."""
        told = type(self).__str__ is object.__str__ and inspect.getdoc(type(self))
        return " ".join((told or str(self)).split("\n")[0].split()).rstrip(":")

    def _tables(self) -> Iterator[tuple[str, Grid]]:
        """Tables to show, each below its name: by default of every attribute that has records in it."""
        for fact in self._facts():
            if are_records(fact.value):
                yield fact.name, Grid.of(fact.value)

    def _details(self) -> Iterator[tuple[str, str]]:
        """What is folded, each text below its title: by default all words, where they are more than the sentence."""
        if "\n" in str(self):
            yield "In words", str(self)

    def _figure(self) -> Any:
        """The figure, or None: by default what ``plot`` draws; it is drawn only where a notebook asks."""
        return self.plot() if hasattr(self, "plot") else None

    def _facts(self) -> list[Fact]:
        return [fact for fact in facts(self) if fact.name not in self._hidden]

    def _line(self) -> str:
        return f"{type(self).__name__}({self._sentence()})"

    def _text(self) -> str:
        """What stands below its cell where no HTML is shown: by default all words."""
        return str(self)

    def _all_words(self, printer: Any, cycle: bool) -> None:
        """All words where it stands alone in a cell, its one line inside a list or a dict."""
        lines = [repr(self)] if cycle or len(printer.stack) > 1 else self._text().split("\n")
        for number, line in enumerate(lines):
            if number:
                printer.break_()
            printer.text(line)

    def _repr_html_(self) -> str:
        return f'<div style="overflow-x: auto">{self._head_html()}{self._body_html()}</div>'

    def _head_html(self):
        sentence = " ".join(self._sentence().split())  # a blank line, as in a name, would end the HTML inside Markdown
        return f"<p><strong>{escape(upper(sentence))}</strong></p>"

    def _is_open(self, fact):
        """Whether a fact stands in the table: numbers do, texts and arrays are folded."""
        few = isinstance(fact.value, tuple) and 0 < len(fact.value) <= FEW
        return all(isinstance(part, (bool, int, float)) for part in (fact.value if few else [fact.value]))

    def _rows(self):
        """The rows of the table of facts, and those that are folded: also what is beyond the first few."""
        shown, folded = [], []
        for fact in self._facts():
            text, unit = in_words(fact.value, fact.unit)
            if text and not are_records(fact.value):
                (shown if self._is_open(fact) else folded).append((fact.name, text, unit, fact.meaning))
        if len(shown) > OPEN + 1:  # one line more takes no more room than the title of what is folded
            shown, folded = shown[:OPEN], shown[OPEN:] + folded
        return shown, folded

    def _stands_open(self, grid):
        """Whether a table is not folded."""
        return len(grid) <= OPEN

    def _body_html(self):
        rows, folded = self._rows()
        tables = [(name, grid) for name, grid in self._tables() if len(grid)]
        told = [_fact_table(rows), "".join(self._captioned(*one) for one in tables if self._stands_open(one[1]))]
        told = [*(reversed(told) if isinstance(self, Tabular) else told), _drawn(self._figure)]
        told += [
            _folded(f"{_title(name) or 'Table'}: {len(grid)} rows", self._cut(name, grid))
            for name, grid in tables
            if not self._stands_open(grid)
        ]
        told += [_folded("More facts", _fact_table(folded))]
        told += [_folded(title, f"<pre>{escape(text)}</pre>") for title, text in self._details()]
        return "".join(told)

    def _captioned(self, name, grid):
        caption = f'<p style="margin: 0.4em 0 0">{escape(_title(name))}</p>' if name not in ("", "rows") else ""
        return caption + self._cut(name, grid)

    def _cut(self, name, grid):
        """A table with its first rows, and the attribute or the method that has all."""
        first = next(iter(self._tables()))[0] == name and hasattr(self, "to_pandas")
        return grid_html(grid, name if name.isidentifier() and hasattr(self, name) else "to_pandas()" if first else "")


def _in_one_line(self: ShowsItself) -> str:
    return self._line()


class Tabular(ShowsItself):
    """What is first of all a table, which stands before other facts, and which pandas can take over."""

    def _stands_open(self, grid):
        return len(grid) <= ROWS or not hasattr(self, "plot")

    def to_pandas(self) -> Any:
        """The table as a ``pandas.DataFrame`` in SI units, which its ``attrs["units"]`` names; pandas is optional.

        Raises
        ------
        AnalysisError
            Where pandas is not installed.
        """
        return next((grid for _, grid in self._tables()), Grid({})).to_pandas()


class Typeset(ShowsItself):
    """What is first of all equations, shown as Markdown: every front end typesets LaTeX there, few do within HTML."""

    _repr_html_ = None  # type: ignore[assignment]

    def _equations(self) -> list[str]:
        """The lines, in LaTeX."""
        raise NotImplementedError

    def _repr_latex_(self) -> str:
        return "$\\displaystyle " + _aligned(self._equations()) + "$"

    def _repr_markdown_(self) -> str:
        body = self._body_html().replace("\n\n", "\n&nbsp;\n")  # a blank line would end the HTML
        return f"{self._head_html()}\n\n$$\n{_aligned(self._equations())}\n$$\n\n<div>{body}</div>\n"


def _aligned(lines):
    return "\\begin{array}{l}\n" + " \\\\\n".join(lines) + "\n\\end{array}"


def upper(sentence):
    """The sentence with a capital where it begins with a word, not with a symbol or a name of the code."""
    first = sentence.split(" ")[0]
    return (
        sentence[:1].upper() + sentence[1:]
        if first.isalpha() and first.islower() and (len(first) > 1 or first == "a") and first not in LAWS
        else sentence
    )


def _fact_table(rows):
    if not rows:
        return ""
    lines = (  # a long text keeps its own lines
        f'<tr style="{_ROW}"><td style="{_CELL}"><code>{escape(name)}</code></td><td style="{_CELL}; white-space: pre-line">'
        f"{escape(text)} {escape(unit)}</td>"
        f'<td style="{_CELL}; {_QUIET}">{escape(meaning)}</td></tr>'
        for name, text, unit, meaning in rows
    )
    return f'<table style="{_TABLE}"><tbody>{"".join(lines)}</tbody></table>'


def grid_html(grid: Grid, whole: str = "") -> str:
    """A table with a head that carries the units, cut to its first rows with a sentence on the attribute that is whole."""
    heads = "".join(f'<th scope="col" style="{_CELL}">{escape(head)}</th>' for head in grid.heads)
    lines = "".join(f'<tr style="{_ROW}">{"".join(map(_cell, row))}</tr>' for row in grid.rows(ROWS))
    table = f'<table style="{_TABLE}"><thead><tr>{heads}</tr></thead><tbody>{lines}</tbody></table>'
    where = f"; <code>.{whole}</code> has all" if whole else ""
    more = f"<p>The first {ROWS} of {len(grid)} rows{where}.</p>"
    return table + more * (len(grid) > ROWS)


def _cell(text):
    return f'<td style="{_CELL}">{escape(text)}</td>'


def _title(name):
    return name[:1].upper() + name[1:].replace("_", " ")


def _drawn(figure):
    """The figure as an image with its alternative text; a sentence where there is nothing to draw."""
    try:
        drawn = figure()
        if drawn is None:
            return ""
        data, _ = drawn._repr_mimebundle_()
        return data["text/html"]
    except HapticlabError as nothing:
        why = str(nothing)
    except Exception as bug:  # a notebook would hide a result whose figure fails, with its sentence and its table
        why = f"{type(bug).__name__}: {bug}"
    return f'<p style="{_QUIET}">No figure: {escape(why)}</p>'


def _folded(title, inside):
    return f"<details><summary>{escape(title)}</summary>{inside}</details>" if inside else ""
