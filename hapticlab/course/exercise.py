"""What a lab asks: exercises with their public cases. Cases hold numbers, never a formula of the answer."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal, get_args

from ..errors import CourseError

if TYPE_CHECKING:
    from collections.abc import Sequence

#: what is judged, and what is only noted
Judged = Literal["function", "scene", "expression", "plot", "value", "choice", "design"]
Noted = Literal["prediction", "text"]
Kind = Judged | Noted
JUDGED, NOTED = get_args(Judged), get_args(Noted)


@dataclass(frozen=True)
class Case:
    """One set of givens with the answer expected.

    Parameters
    ----------
    given : dict
        The arguments of a function, by name (lists become NumPy arrays); what a scene is run with, see
        :func:`hapticlab.course.felt.felt`; the points of an expression, ``at``, with what an equation is solved for,
        ``solve_for``, see :func:`hapticlab.course.expression.values`, and optionally its ``unit``; empty for a value or a
        choice; the task of a design and its constants, ``{"task": "wall", "K": 500.0}``.
    expected : float, bool, str, sequence of float (nested for more axes), or dict of str to these
        Of an expression a number for each point; of a plot its curves, see :func:`hapticlab.course.plotted_curves.curves`;
        of a design the reference points, ``{"A": [error in %, load in %, margin in N s/m]}``.
    unit : str
        Of what is expected.
    slips : dict or sequence of (wrong, sentence)
        A typical wrong result and the sentence that teaches: a number, a tuple shaped as what is expected, or a dict of
        the parts that are wrong; of a design a dict of names that it gives so.

    Examples
    --------
    >>> Case({"x": 0.012, "k": 200.0}, 2.4, unit="N", slips={-2.4: "The sign is wrong."}).slips
    ((-2.4, 'The sign is wrong.'),)
    """

    given: Mapping[str, Any]
    expected: Any
    unit: str = ""
    slips: Mapping[Any, str] | Sequence[tuple[Any, str]] = ()

    def __post_init__(self) -> None:
        if not isinstance(self.given, Mapping):
            raise CourseError(f"given = {self.given!r}; a case needs a dict, such as Case({{'x': 0.01}}, 2.0)")
        pairs = self.slips.items() if isinstance(self.slips, Mapping) else self.slips
        object.__setattr__(self, "slips", tuple((wrong, sentence) for wrong, sentence in pairs))


@dataclass(frozen=True)
class Exercise:
    """One question of a lab; the student's answer has its name in the notebook.

    Parameters
    ----------
    name : str
    kind : {"function", "scene", "expression", "plot", "value", "choice", "design", "prediction", "text"}
        The last two are noted and never judged. A plot is a matplotlib Figure or Axes, or a function that makes one.
    points : float
        Earned where every case is right, else none; of a design a part for each reference point, see ``full``.
    asks : str
        What is asked for, in a few words with units.
    cases : sequence of Case
        The public ones.
    options : dict of str to str
        Of a choice: key and words.
    rtol, atol : float
        How far a number may be off: ``atol + rtol*|expected|``, of an array's largest number.
    hint : str
        Printed where a case is wrong.
    least_words : int
        Of a text.
    matters : str
        Printed where every case is right: why the result matters, in a sentence that holds for any numbers.
    full : int
        Of a design: how many reference points of each scene it must dominate to earn all points; see
        :func:`hapticlab.course.design_answer.share`.

    Examples
    --------
    >>> Exercise("stiffness", kind="value", points=1, cases=[Case({}, 150.0, unit="N/m")]).judged
    True
    """

    name: str
    kind: Kind = "function"
    points: float = 0
    asks: str = ""
    cases: Sequence[Case] = ()
    options: dict[str, str] = field(default_factory=dict)
    rtol: float = 1e-6
    atol: float = 1e-12
    hint: str = ""
    least_words: int = 0
    matters: str = ""
    full: int = 0

    def __post_init__(self) -> None:
        object.__setattr__(self, "cases", tuple(self.cases))
        if self.kind not in JUDGED + NOTED:
            raise CourseError(f"{self.name}: kind = {self.kind!r}; needs one of {', '.join(JUDGED + NOTED)}")
        if not self.name.isidentifier():
            raise CourseError(f"exercise {self.name!r}: needs the name of a Python variable, such as 'wall_force'")
        if not self.judged and (self.points or self.cases):
            raise CourseError(f"{self.name}: a {self.kind} is saved, not marked; leave out points and cases")
        if (self.kind == "design") != (self.full > 0):
            raise CourseError(f"{self.name}: full = {self.full}; a design needs full >= 1, and no other kind has it")
        few = next((len(c.expected) for c in self.cases if self.kind == "design" and len(c.expected) < self.full), None)
        if few is not None:
            raise CourseError(f"{self.name}: full = {self.full}, but a case has only {few} reference points")
        strange = [c.expected for c in self.cases if self.kind == "choice" and c.expected not in self.options]
        if strange:
            raise CourseError(f"{self.name}: {strange[0]!r} is not one of the options {', '.join(self.options)}")

    @property
    def judged(self) -> bool:
        """Whether it can be right or wrong."""
        return self.kind in JUDGED


@dataclass(frozen=True)
class Lab:
    """A lab: what a student opens, with its exercises.

    Parameters
    ----------
    number : str
        Two digits, as its folder begins.
    title : str
    minutes : int
        What a student needs for it.
    exercises : sequence of Exercise

    Examples
    --------
    >>> lab = Lab("02", "The virtual wall", minutes=90, exercises=[Exercise("force", points=2), Exercise("k", "value", 1)])
    >>> lab.points, lab.exercise("k").kind
    (3, 'value')
    """

    number: str
    title: str
    minutes: int
    exercises: Sequence[Exercise]

    def __post_init__(self) -> None:
        object.__setattr__(self, "exercises", tuple(self.exercises))
        if not (isinstance(self.number, str) and re.fullmatch("[0-9][0-9]", self.number)):
            raise CourseError(f"lab number {self.number!r}: needs two digits as text, as its folder begins, such as '02'")
        names = [e.name for e in self.exercises]
        twice = sorted({name for name in names if names.count(name) > 1})
        if twice:
            raise CourseError(f"lab {self.number}: {', '.join(twice)} appears twice; each exercise needs a name of its own")

    @property
    def points(self) -> float:
        """What all exercises are worth together."""
        return sum(e.points for e in self.exercises)

    def exercise(self, name: str) -> Exercise:
        """Return the exercise of that name."""
        found = {e.name: e for e in self.exercises}
        if name not in found:
            raise CourseError(f"lab {self.number} has no exercise {name}; it has {', '.join(found) or 'none'}")
        return found[name]
