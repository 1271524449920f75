"""The paddles of a class side by side: a folder of their files as one table, one figure and one page."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from ...base.grid import Grid
from ...base.shows_itself import Tabular
from ...errors import AnalysisError
from .comparison_page import class_page
from .figures import plot_class
from .join import read_quality
from .record import PaddleQuality
from .record_file import SUFFIX

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ...base.annotations import File

#: files of a folder that are read
MOST = 400


@dataclass(frozen=True)
class QualityComparison(Tabular):
    """Paddles side by side, the stiffest quiet wall first; nan where it was not measured or undecided.

    Attributes
    ----------
    qualities : tuple of PaddleQuality
    skipped : dict of str to str
        File that was left out -> why.
    """

    qualities: tuple[PaddleQuality, ...]
    skipped: dict[str, str] = field(default_factory=dict)

    _hidden = ("qualities",)

    def _sentence(self):
        left_out = f", {len(self.skipped)} file{'s' * (len(self.skipped) != 1)} left out" if self.skipped else ""
        return f"{len(self.qualities)} paddle{'s' * (len(self.qualities) != 1)} side by side{left_out}"

    def _tables(self):
        columns = {
            "paddle": [one.name for one in self.qualities],
            "on": [one.on for one in self.qualities],
            "passive K": [one.passive for one in self.qualities],
            "stiffest quiet K": [one.stiffest[0] for one in self.qualities],
            "with B": [one.stiffest[1] for one in self.qualities],
            "velocity": [one.stiffest[2] for one in self.qualities],
            "same up to": [one.rendered.same_up_to if one.rendered else float("nan") for one in self.qualities],
        }
        units = {"passive K": "N/m", "stiffest quiet K": "N/m", "with B": "N s/m", "same up to": "Hz"}
        yield "", Grid(columns, units)

    def __str__(self) -> str:
        (_, grid), *_ = self._tables()
        skipped = [f"left out: {why}" for why in self.skipped.values()]
        return "\n".join([self._sentence(), *grid.lines(), *skipped])

    def plot(self) -> Figure:
        """Draw a row for each paddle with its borders."""
        return plot_class(self.qualities, range(1, len(self.qualities) + 1))

    def page(self, path: File) -> Path:
        """Write the page of the class, one HTML file that requests nothing else, and return its path."""
        path = Path(path)
        path.write_text(class_page(self.qualities, self.skipped), encoding="utf-8", newline="\n")
        return path


def compare_qualities(folder: File) -> QualityComparison:
    """Put the paddles of a class side by side, from a folder of the files that ``quality.save`` wrote.

    A file that is damaged is named with the reason and left out. Other files than JSON are not read.

    Parameters
    ----------
    folder : path

    Returns
    -------
    QualityComparison

    Raises
    ------
    AnalysisError
        If the folder cannot be read or has no such file.

    Examples
    --------
    >>> import tempfile
    >>> import hapticlab as hl
    >>> folder = tempfile.mkdtemp()
    >>> for name in ("hapkit", "hapkit_slow"):
    ...     paddle = hl.SimulatedPaddle.from_profile(name)
    ...     _ = hl.measure.quality(name, paddle, date="2026-11-20").save(f"{folder}/{name}.json")
    >>> [round(one.passive) for one in hl.measure.compare_qualities(folder).qualities]
    [200, 47]
    """
    folder = Path(folder)
    try:
        files = sorted(path for path in folder.iterdir() if path.suffix == SUFFIX and path.is_file())
    except OSError as problem:
        raise AnalysisError(
            f"the folder {folder.name} cannot be read ({problem.strerror or problem}). Give the folder in which the files of "
            "the class are"
        ) from None
    if not files or len(files) > MOST:
        raise AnalysisError(
            f"the folder {folder.name} has {len(files)} files that end in {SUFFIX}; needs 1 to {MOST} that quality.save() wrote"
        )
    found, skipped = [], {}
    for path in files:
        try:
            found.append(read_quality(path))
        except AnalysisError as problem:
            skipped[path.name] = str(problem)
    if not found:
        raise AnalysisError(f"no file of {folder.name} could be used. The first: {next(iter(skipped.values()))}")
    found.sort(key=_rank)
    return QualityComparison(tuple(found), skipped)


def _rank(one):
    K = one.stiffest[0]
    return (-K if K == K else 0.0, -one.passive, one.name)
