"""A table of records or of a grid of points: named columns with units, as lines of text and as a frame of pandas."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import islice
from typing import Any

from ..errors import AnalysisError
from .facts import facts, in_words, short, shown_unit


class Grid:
    """Columns of equal length in SI units.

    Parameters
    ----------
    columns : dict of str to sequence
    units : dict of str to str
        SI unit of a column; none is needed for a number without unit, or a text.

    Examples
    --------
    >>> grid = Grid({"law": ["zoh", "ellis"], "depth": [0.002, 0.0015]}, {"depth": "m"})
    >>> grid.heads, list(grid.rows())
    (['law', 'depth [mm]'], [['zoh', '2'], ['ellis', '1.5']])
    """

    def __init__(self, columns: Mapping[str, Sequence[Any]], units: Mapping[str, str] | None = None) -> None:
        self.columns, self.units = dict(columns), dict(units or {})
        numbers = {name: _numbers(values) for name, values in self.columns.items()}
        self._scales = {
            name: shown_unit(found, self.units.get(name, "")) if len(found) else (1.0, "") for name, found in numbers.items()
        }

    @classmethod
    def of(cls, records: Mapping[str, Any] | Iterable[Any], *names: str) -> Grid:
        """The table of records of one class: the attributes named, or all documented ones that a cell can hold."""
        named = {"": list(records)} if isinstance(records, Mapping) else {}
        listed = [facts(one) for one in (records.values() if isinstance(records, Mapping) else records)]
        hidden = getattr(type(next(iter(records.values() if named else records), None)), "_hidden", ())  # type: ignore[union-attr]
        columns = {f.name: [] for f in listed[0] if f.name not in hidden} if listed else {}  # type: ignore[var-annotated]
        for fact in (fact for known in listed for fact in known if fact.name in columns):
            columns[fact.name].append(fact.value)
        shown = {name: columns[name] for name in names or columns if any(map(_fits_a_cell, columns.get(name, ())))}
        return cls({**named, **shown}, {fact.name: fact.unit for fact in listed[0]} if listed else {})

    def __len__(self) -> int:
        return len(next(iter(self.columns.values()), ()))

    @property
    def heads(self) -> list[str]:
        """The names of the columns, with the units in which they are shown."""
        units = {name: unit for name, (_, unit) in self._scales.items()}
        return [f"{name} [{units[name]}]" if units[name] else name for name in self.columns]

    def rows(self, most: int | None = None) -> Iterator[list[str]]:
        """The cells of each line, as texts."""
        for values in islice(zip(*self.columns.values(), strict=True), most):
            yield [self._cell(name, value) for name, value in zip(self.columns, values, strict=True)]

    def lines(self) -> list[str]:
        """The heads and every line as texts, in columns of equal width.

        Examples
        --------
        >>> Grid({"law": ["zoh", "ellis"], "taps": [1, 2]}).lines()
        ['law    taps', 'zoh    1', 'ellis  2']
        """
        cells = [self.heads, *self.rows()]
        wide = [max(map(len, column)) for column in zip(*cells, strict=True)]
        return ["  ".join(map(str.ljust, row, wide)).rstrip() for row in cells]

    def _cell(self, name, value):
        factor, _ = self._scales[name]
        value = value.item() if hasattr(value, "item") and not value.shape else value
        if isinstance(value, float) or (isinstance(value, int) and self.units.get(name) and not isinstance(value, bool)):
            return "" if value != value else short(value * factor)  # the head has the unit
        return " ".join(filter(None, in_words(value, self.units.get(name, ""))))

    def to_pandas(self) -> Any:
        """The table as a ``pandas.DataFrame`` in SI, whose ``attrs["units"]`` has the units."""
        return frame(self.columns, self.units)


def _fits_a_cell(value):
    return not getattr(value, "shape", ()) and bool(in_words(value)[0])


def _numbers(values):
    plain = (value.item() if hasattr(value, "item") and not value.shape else value for value in values)
    return [value for value in plain if isinstance(value, (int, float)) and not isinstance(value, bool)]


def frame(columns: Mapping[str, Any], units: Mapping[str, str], **attrs: Any) -> Any:
    """Columns as a ``pandas.DataFrame``; units and more go to its ``attrs``."""
    table = _package("pandas").DataFrame(dict(columns))
    table.attrs = {"units": {name: units[name] for name in columns if units.get(name)}, **attrs}
    return table


def labelled(
    variables: Mapping[str, tuple[Sequence[str], Any]], coordinates: Mapping[str, Any], units: Mapping[str, str], **attrs: Any
) -> Any:
    """Arrays over named axes as an ``xarray.Dataset``; each variable and axis has its unit in its ``attrs``."""
    made = _package("xarray").Dataset(dict(variables), dict(coordinates), attrs)
    for name in made.variables:
        if units.get(name):
            made[name].attrs["units"] = units[name]
    return made


def _package(name):
    import importlib

    try:
        return importlib.import_module(name)
    except ModuleNotFoundError:
        raise AnalysisError(f"to_{name}() needs {name}, which is not installed. Install it: pip install {name}") from None
