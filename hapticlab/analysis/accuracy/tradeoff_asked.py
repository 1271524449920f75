"""What a trade-off tries, and under which conditions: its two records."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from numbers import Real
from typing import TYPE_CHECKING, Literal

from ...base.shows_itself import ShowsItself
from ...compiler.events.taylor_method import Taylor
from ...compiler.ir.options import choice, period
from ...compiler.methods.chosen_method import chosen_method
from ...compiler.methods.force_timing import FORCE_AT
from ...compiler.tick.handle_samples import HOLDS, hold_named
from ...errors import AnalysisError

if TYPE_CHECKING:
    from ...compiler.methods.chosen_method import AnyMethod
    from ...compiler.tick.handle_samples import Hold
    from .handle_motions import HandleMotion

#: float64 is the pc's alone
PRECISIONS = ("float32", "float64")


def several(given):
    """Return one thing, or a sequence of them, as a tuple."""
    return (given,) if isinstance(given, (str, Real)) or not isinstance(given, Iterable) else tuple(given)


@dataclass(frozen=True, kw_only=True)
class Tried(ShowsItself):
    """The settings that a trade-off tries: every combination of these.

    Parameters
    ----------
    methods : "auto" or sequence of methods
        Of :func:`hapticlab.compile`; all but forward Euler, and midpoint beside Heun, unless given.
    T : float, text or sequence of them
        Sampling periods [s], whole numbers of 10 us or of a quarter of the shortest.
    substeps, holds, force_at, precision : sequences
        Of :func:`hapticlab.compile`; precision is its ``dtype``.

    Examples
    --------
    >>> import hapticlab as hl
    >>> hl.methods.Tried(T=["1 ms", 5e-4]).T
    (0.001, 0.0005)
    """

    methods: Literal["auto"] | Sequence[AnyMethod] = "auto"
    T: float | Iterable[float] = (2e-3, 1e-3, 5e-4)
    substeps: Sequence[int] = (1, 2, 4)
    holds: Sequence[str | Hold] = tuple(HOLDS)
    force_at: Sequence[str] = ("before",)
    precision: Sequence[str] = PRECISIONS

    def __post_init__(self) -> None:
        object.__setattr__(self, "T", tuple(period(one) for one in several(self.T)))
        for name, given in vars(self).items():
            if name != "T" and (name, given) != ("methods", "auto") and (isinstance(given, str) or not tuple(given)):
                raise AnalysisError(f"{name} = {given!r}; needs a sequence of at least one, such as {name}=[{given!r}]")
        if self.methods != "auto":
            names = tuple(m if isinstance(m, Taylor) else str(chosen_method(m)) for m in self.methods)
            object.__setattr__(self, "methods", names)
        object.__setattr__(self, "holds", tuple(hold_named(hold) for hold in self.holds))
        for when, real in itertools.product(self.force_at, self.precision):
            choice("force_at", when, FORCE_AT), choice("precision", real, PRECISIONS)


@dataclass(frozen=True, kw_only=True)
class Conditions(ShowsItself):
    """The conditions of a trade-off that are the same for every setting: motions of the handle and compile options.

    Parameters
    ----------
    motions : HandleMotion or sequence of them, optional
        :func:`~hapticlab.analysis.accuracy.handle_motions.handle_motions` unless given.
    velocity : {"backward_difference", "measured"}
        Of :func:`hapticlab.compile`.
    live : str or sequence of names, or None for all
        Parameters that stay settable while running, none unless given: constants make every method cheaper, and "exact"
        possible.
    every : int
        Ticks per sample of telemetry, part of a board's load.

    Examples
    --------
    >>> import hapticlab as hl
    >>> hl.methods.Conditions(live="k").every
    10
    """

    motions: HandleMotion | Iterable[HandleMotion] | None = None
    velocity: Literal["backward_difference", "measured"] = "backward_difference"
    live: str | Iterable[str] | None = ()
    every: int = 10


TRIED, CONDITIONS = Tried(), Conditions()
