"""Who answers: an observer of signal detection theory, or a person."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from ..base.shows_itself import ShowsItself
from ..device.setup.person import Person
from ..errors import AnalysisError
from .response_curves import Psychometric

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..base.telemetry import Telemetry
    from .tasks import Task

Answer = Literal["first", "second"]
INTERVALS: dict[Answer, str] = {"first": "the first one", "second": "the second one"}


@dataclass(frozen=True, kw_only=True)
class SimulatedObserver(ShowsItself):
    """An observer of signal detection theory who feels the recorded force.

    What is felt of a presentation, its logarithm, is blurred by Gaussian noise of standard deviation ln(1 + weber); the
    larger of the two is answered. So a comparison (1 + weber) times the standard is at d' = 1, right in 76 % of trials;
    D. M. Green and J. A. Swets, *Signal Detection Theory and Psychophysics*, 1966.

    Parameters
    ----------
    weber : float
        Weber fraction, > 0.
    lapse : float
        Part of trials answered without having felt, 0 to 1; half of these answers are right.
    bias : float
        Added to the second presentation's logarithm: > 0 answers "second" too often.
    seed : int

    Examples
    --------
    >>> observer = SimulatedObserver(weber=0.2)
    >>> round(float(observer.curve()(math.log(1.2))), 4)
    0.7602
    """

    weber: float
    lapse: float = 0.0
    bias: float = 0.0
    seed: int = 0

    def __post_init__(self) -> None:
        if not (self.weber > 0 and 0 <= self.lapse < 1 and math.isfinite(self.weber) and math.isfinite(self.bias)):
            raise AnalysisError(
                f"weber = {self.weber:g}, lapse = {self.lapse:g}, bias = {self.bias:g}; an observer needs weber > 0, "
                "0 <= lapse < 1 and a finite bias"
            )

    def curve(self) -> Psychometric:
        """The psychometric function over ln(comparison/standard) that follows, for no bias."""
        return Psychometric(math.log1p(self.weber), 1.0, 0.5, self.lapse / 2)

    def ready(self, task: Task, which: Answer) -> None:
        """Announce the first or second presentation.

        Parameters
        ----------
        task : Task
            What is presented next.
        which : {"first", "second"}
            Which presentation of the trial it is.
        """

    def compare(self, task: Task, logs: Sequence[Telemetry], trial: int) -> Answer:
        """The answer: "first" or "second", whichever felt stronger in these two records.

        Parameters
        ----------
        task : Task
            What is compared.
        logs : sequence of Telemetry
            The records of both presentations.
        trial : int
            Number of the trial, from 0; it draws the noise.
        """
        return self.decide([task.felt(log) for log in logs], trial)

    def decide(self, felt: Sequence[float], trial: int) -> Answer:
        """The answer to two felt magnitudes > 0; the trial's number draws the noise.

        Parameters
        ----------
        felt : (float, float)
            Felt magnitudes of the first and the second presentation, in the unit of the task, > 0.
        trial : int
            Number of the trial, from 0.
        """
        rng = np.random.default_rng([self.seed, trial])
        if rng.random() < self.lapse:
            return ("first", "second")[rng.integers(2)]
        if min(felt) <= 0:
            raise AnalysisError(f"felt {felt[0]:g} and {felt[1]:g}; Weber's law needs magnitudes > 0")
        first, second = np.log(felt) + math.log1p(self.weber) * rng.standard_normal(2)
        return "first" if first > second + self.bias else "second"

    def told(self, right: bool) -> None:
        """Report whether the answer was right.

        Parameters
        ----------
        right : bool
            Whether the answer was right.
        """

    def __str__(self) -> str:
        return f"simulated observer, Weber fraction {100 * self.weber:g} %, {100 * self.lapse:g} % lapses, seed {self.seed}"


@dataclass(frozen=True)
class PersonObserver(ShowsItself):
    """A person at the paddle, asked at the terminal.

    Parameters
    ----------
    person : Person
    feedback : bool
        Tell whether each answer was right.
    """

    person: Person
    feedback: bool = False

    def ready(self, task: Task, which: Answer) -> None:
        """Ask the person to hold the handle, and wait for Enter.

        Parameters
        ----------
        task : Task
            What is presented next.
        which : {"first", "second"}
            Which presentation of the trial it is.
        """
        self.person.ask(f"{which.capitalize()} one: hold the handle and press Enter, then feel it for {task.duration:g} s.")

    def compare(self, task: Task, logs: Sequence[Telemetry], trial: int) -> Answer:
        """Return the answer of the person, "first" or "second".

        Parameters
        ----------
        task : Task
            What is compared.
        logs : sequence of Telemetry
            The records of both presentations, which the person does not see.
        trial : int
            Number of the trial, from 0.
        """
        return self.person.choose(task.question, INTERVALS)

    def told(self, right: bool) -> None:
        """Say whether the answer was right, where feedback is on.

        Parameters
        ----------
        right : bool
            Whether the answer was right.
        """
        if self.feedback:
            self.person.say("right" if right else "wrong")

    def __str__(self) -> str:
        return "a person"
