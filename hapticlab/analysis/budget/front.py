"""Several designs of one task, measured: which of them no other one dominates."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.grid import Grid
from ...base.shows_itself import Tabular
from ...errors import AnalysisError
from .front_plot import plot_front
from .measured import MeasuredDesign, measured

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from .task import Task


@dataclass(frozen=True, eq=False)
class DesignFront(Tabular):
    """Measured designs of one task, by their names.

    Attributes
    ----------
    task : Task
    designs : dict of str to MeasuredDesign
    reference_points : dict of str to (error [%], load [%], margin [N s/m])
        Drawn beside the designs.
    """

    task: Task
    designs: Mapping[str, MeasuredDesign]
    reference_points: Mapping[str, Sequence[float]] = field(default_factory=dict)

    @property
    def front(self) -> tuple[str, ...]:
        """The names of the feasible designs that no other one dominates, those of least load first."""
        found = [name for name, one in self.designs.items() if one.feasible and not self._dominated(one)]
        return tuple(sorted(found, key=lambda name: self.designs[name].load))

    def _dominated(self, one):
        return any(other.dominates(one) for other in self.designs.values())

    def _tables(self):
        return [("designs", self._grid())]

    def _grid(self):
        names = [name for name, one in self.designs.items() if one.feasible]
        shown, front = [self.designs[name] for name in names], self.front
        columns: dict[str, list[Any]] = {"design": names, "on the front": ["yes" if name in front else "" for name in names]}
        columns |= {what: [f"{getattr(one, what):.3g} %" for one in shown] for what in ("error", "load")}
        columns["margin"] = [f"{one.margin:.3g} N s/m" for one in shown]
        return Grid(columns)

    def plot(self) -> Figure:
        """Return a figure: error and passivity margin against load, the front filled, reference points as letters."""
        return plot_front(self)

    def __str__(self) -> str:
        failed = [f"  {name}: {one}" for name, one in self.designs.items() if not one.feasible]
        front, grid = self.front, self._grid()
        words = f"{len(front)} of {len(grid)} feasible designs are on the front" if len(grid) else "no design is feasible"
        lines = grid.lines() if len(grid) else []
        return "\n".join([f"{self.task.name}: {words}", *(f"  {line}" for line in lines), *failed])


def front(
    task: Task, designs: Mapping[str, Mapping[str, Any]], *, reference_points: Mapping[str, Sequence[float]] | None = None
) -> DesignFront:
    """Measure several designs of a task and find the front: those that no other one dominates.

    A design dominates another one if none of its three figures is worse and one is better.

    Parameters
    ----------
    task : Task
    designs : dict of str to dict
        Designs by their names, each as :func:`~hapticlab.analysis.budget.measured.measured` takes it.
    reference_points : dict of str to (error [%], load [%], margin [N s/m]), optional
        To be drawn beside the designs.

    Returns
    -------
    DesignFront

    Raises
    ------
    AnalysisError
        For what is no task, designs that are not in a dict by their names, and reference points without three numbers.

    Examples
    --------
    >>> import hapticlab as hl
    >>> quick = {"T": 1e-3, "law": "zoh", "velocity": "backward"}
    >>> slow = {**quick, "T": 2e-3}
    >>> hl.design.front(hl.design.task("wall"), {"quick": quick, "slow": slow}).front
    ('slow', 'quick')
    """
    if not isinstance(designs, Mapping):
        raise AnalysisError("designs need names; give a dict such as {'first': {'T': 0.001, ...}, 'second': {...}}")
    for name, point in (reference_points or {}).items():
        if np.shape(point) != (3,):
            raise AnalysisError(f"reference point {name} = {point!r}; needs three numbers: error [%], load [%], margin [N s/m]")
    return DesignFront(task, {str(name): measured(task, one) for name, one in designs.items()}, dict(reference_points or {}))
