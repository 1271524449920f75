"""What grading one submission found, as plain values: the same bytes for the same submission and seed, no times, no paths."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from typing import Any


@dataclass(frozen=True)
class Failing:
    """The first case that is wrong: what was given, what came, and what was expected, in floats, texts, lists and dicts.

    ``public`` tells a case of the lab's own checks, which its students know, from one drawn for this student.
    ``value`` is None where the answer gave none; ``expected`` is None where it is the answer itself (a value, a choice).
    """

    given: dict[str, Any]
    value: Any
    expected: Any
    unit: str
    public: bool


@dataclass(frozen=True)
class ExerciseReport:
    """One exercise: its points where every case is right, else none; of a design a part of them.

    Attributes
    ----------
    name, kind, asks : str
    points, earned : float
    answered : bool
    right, cases : int
        Of its cases, public and hidden.
    words : str
        What is wrong with the first wrong case, in a sentence; empty where all are right.
    slip : str
        The part of ``words`` that names a known mistake; what a class gets wrong alike is counted by it.
    hint : str
        Of the exercise, where it is wrong.
    ended : str
        Why its process ended early: "time", "memory", "processes", "exit", "signal 11", "flood", "garbage"; else empty.
    ended_hidden : bool
        Whether it was asked for cases then of which none is public.
    failing : Failing or None
    printed : str
        What its code printed in public cases.
    text : str
        Of a prediction or a discussion, which are noted and carry no points: what was written.
    designs : tuple of dict
        Of a design, for each scene: ``scene``, ``public``, the ``design`` and its ``figures`` (error [%], load [%], margin
        [N s/m]) or ``why`` it is not feasible, the reference ``points``, and the names of those that it ``dominates``.
    """

    name: str
    kind: str
    asks: str = ""
    points: float = 0.0
    earned: float = 0.0
    answered: bool = False
    right: int = 0
    cases: int = 0
    words: str = ""
    slip: str = ""
    hint: str = ""
    ended: str = ""
    ended_hidden: bool = False
    failing: Failing | None = None
    printed: str = ""
    text: str = ""
    designs: tuple[dict[str, Any], ...] = ()


@dataclass(frozen=True)
class Report:
    """One submission.

    Attributes
    ----------
    student : str
    lab : str
        Number and title are in ``lab`` and ``title``.
    title : str
    submission : str
        Name of the file or folder, without the way to it.
    sha256 : str
        Of what was handed in.
    problem : str
        Why nothing could be graded, else empty: no notebook inside, no JSON, too large.
    grader_failed : bool
        Whether ``problem`` is no fault of the student; another run may have more luck.
    cells : tuple of (int, str)
        Cells that failed, counted from 1 over code cells, and what they raised.
    exercises : tuple of ExerciseReport
        All of the lab, in its order, also where ``problem`` is set.
    """

    student: str
    lab: str
    title: str
    submission: str
    sha256: str = ""
    problem: str = ""
    grader_failed: bool = False
    cells: tuple[tuple[int, str], ...] = ()
    exercises: tuple[ExerciseReport, ...] = ()

    @property
    def points(self) -> float:
        """What all exercises are worth together."""
        return sum(one.points for one in self.exercises)

    @property
    def earned(self) -> float:
        """What the submission earned."""
        return sum(one.earned for one in self.exercises)

    def to_json(self) -> str:
        """Return one line of JSON."""
        return json.dumps(asdict(self), ensure_ascii=True, sort_keys=True)

    @classmethod
    def from_json(cls, line: str) -> Report:
        """Return the report that a line of JSON holds.

        Examples
        --------
        >>> report = Report("ada", "02", "Walls", "wall.ipynb", exercises=(ExerciseReport("k", "value", points=2.0),))
        >>> Report.from_json(report.to_json()) == report, report.points
        (True, 2.0)
        """
        held = json.loads(line)
        exercises = tuple(
            ExerciseReport(
                **{
                    **one,
                    "failing": Failing(**one["failing"]) if one["failing"] else None,
                    "designs": tuple(one.get("designs", ())),
                }
            )
            for one in held.pop("exercises")
        )
        return cls(**{**held, "exercises": exercises, "cells": tuple((cell, words) for cell, words in held["cells"])})
