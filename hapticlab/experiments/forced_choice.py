"""Two-alternative forced choice on a paddle: which of two presentations was stronger?"""

from __future__ import annotations

import csv
import json
import math
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.arguments import instance
from ..base.drawing import COLD, WARM, house_style, new_figure, scale_axis
from ..base.shows_itself import ShowsItself, Tabular
from ..device.setup.person import Person
from ..errors import AnalysisError
from .observers import PersonObserver, SimulatedObserver
from .psychometric import psychometric
from .tasks import Task
from .up_down import UpDown

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..base.annotations import File
    from ..device.board.serial_paddle import SerialPaddle
    from ..device.simulated.simulated_paddle import SimulatedPaddle
    from .observers import Answer
    from .psi import ConstantLevels, Psi
    from .psychometric import PsychometricFit


@dataclass(frozen=True)
class Trial(ShowsItself):
    """One comparison: the level ln(comparison/standard), what was shown first and second, and the answer."""

    level: float
    first: float
    second: float
    answer: Answer
    right: bool


@dataclass(frozen=True)
class ForcedChoice(Tabular):
    """What was asked and answered.

    Attributes
    ----------
    task, parameter, unit : str
    standard : float
    trials : tuple of Trial
    estimate : float or None
        Threshold by the procedure's own rule, as ln(comparison/standard).
    procedure, observer, paddle : str
    seed : int
    stopped : str or None
        Why it ended early.
    """

    task: str
    parameter: str
    unit: str
    standard: float
    trials: tuple[Trial, ...]
    estimate: float | None
    procedure: str
    observer: str
    paddle: str
    seed: int
    stopped: str | None = None

    def fit(self, **options: Any) -> PsychometricFit:
        """Fit the psychometric function of all answers; options of :func:`hapticlab.people.psychometric`."""
        return psychometric([t.level for t in self.trials], [t.right for t in self.trials], **options)

    def weber(self, **options: Any) -> tuple[float, float, float]:
        """The Weber fraction at d' = 1 and its interval, from the fit with slope and lapses."""
        found = self.fit(**options)
        low, high = found.interval["threshold"]
        return math.expm1(found.curve.threshold), math.expm1(low), math.expm1(high)

    def __str__(self) -> str:
        right = sum(t.right for t in self.trials)
        head = f"{self.task}, standard {self.standard:g} {self.unit}: {len(self.trials)} trials, {right} right, {self.procedure}"
        lines = [head, f"  {self.observer}"]
        if self.estimate is not None:
            part = 100 * math.expm1(self.estimate)
            lines.append(f"  difference threshold {part:.3g} % of the standard, by the procedure's own rule")
        return "\n".join(lines + ([f"  ended early: {self.stopped}"] if self.stopped else []))

    def to_csv(self, path: File) -> Path:
        """Write one row a trial and return the path."""
        with open(path, "w", newline="", encoding="utf-8") as file:
            table = csv.writer(file, lineterminator="\n")
            table.writerow(_header(self.unit))
            table.writerows(_row(trial) for trial in self.trials)
        return Path(path)

    def save(self, path: File) -> Path:
        """Write everything as JSON and return the path."""
        Path(path).write_text(json.dumps(asdict(self), indent=1), encoding="utf-8")
        return Path(path)

    @classmethod
    def load(cls, path: File) -> ForcedChoice:
        """Read what :meth:`save` wrote."""
        try:
            held = json.loads(Path(path).read_text(encoding="utf-8"))
            return cls(**{**held, "trials": tuple(Trial(**t) for t in held["trials"])})
        except (KeyError, TypeError, ValueError) as problem:
            raise AnalysisError(f"{path} is not an experiment ({problem}); needs a file that result.save() wrote") from None

    def plot(self) -> Figure:
        """Draw the level of each trial, filled where the answer was right, and the threshold."""
        if not self.trials:
            raise AnalysisError(f"no trial was answered, so there is nothing to plot; it ended early: {self.stopped}")
        with house_style():
            figure = new_figure(height=3.6)
            axes = figure.subplots()
            number = np.arange(1, len(self.trials) + 1)
            level = np.array([100 * math.expm1(t.level) for t in self.trials])
            right = np.array([t.right for t in self.trials], bool)
            axes.plot(number, level, color="#8a8a8a", linewidth=0.8, zorder=1)
            axes.scatter(number[right], level[right], 28, color="#000000", label="right", zorder=2)
            axes.scatter(number[~right], level[~right], 36, marker="x", color=WARM, label="wrong", zorder=3)
            if self.estimate is not None:
                at = 100 * math.expm1(self.estimate)
                axes.axhline(at, color=COLD, linestyle="--", label=f"threshold {at:.3g} %")
            axes.set(xlabel="trial", ylabel=f"difference in {self.task} [%]")
            if level.min() > 0:
                scale_axis(axes, "y", np.geomspace(level.min(), max(level.max(), 10 * level.min()), 3))
            figure.legend(loc="outside upper center", ncols=3)
        return figure


def forced_choice(
    paddle: SimulatedPaddle | SerialPaddle,
    task: Task,
    observer: SimulatedObserver | PersonObserver | Person | None = None,
    procedure: UpDown | Psi | ConstantLevels | None = None,
    *,
    seed: int = 0,
    keep: File | None = None,
    **options: Any,
) -> ForcedChoice:
    """Measure a difference threshold by two-alternative forced choice, on a simulated paddle or a board.

    Each trial shows the standard and a comparison exp(level) times as strong, in an order drawn from the seed, with the
    motor off between them and while the observer is asked. A fault of the paddle ends it, and so does a simulated observer
    who felt nothing, or a staircase that finds no turning points; what was answered is returned, with the reason.

    Parameters
    ----------
    paddle : SimulatedPaddle or SerialPaddle
        A simulated paddle without a hand gets the task's exploring hand.
    task : Task
        :func:`stiffness_task`, :func:`damping_task`, :func:`texture_task`, or your own.
    observer : SimulatedObserver, PersonObserver or Person
        By default a simulated one with the task's Weber fraction.
    procedure : UpDown, Psi or ConstantLevels, fresh
        Levels are ln(comparison/standard); by default two down, one up from ln 2.
    seed : int
    keep : path, optional
        A CSV file to which each trial is written at once, so that an interrupt loses nothing.
    **options
        Of paddle.run, such as ``force_max=2`` on a board.

    Returns
    -------
    ForcedChoice

    Examples
    --------
    >>> import hapticlab as hl
    >>> paddle = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3)
    >>> asked = hl.people.ConstantLevels([0.1, 0.5], repeats=2)
    >>> found = hl.people.forced_choice(paddle, hl.people.stiffness_task(), hl.people.SimulatedObserver(weber=0.05), asked)
    >>> len(found.trials), found.trials[-1].right
    (4, True)
    """
    instance("task", task, Task, "a Task, such as hl.people.stiffness_task()")
    observer = observer or SimulatedObserver(weber=task.weber, seed=seed)
    observer = PersonObserver(observer) if isinstance(observer, Person) else observer
    if not hasattr(observer, "compare"):
        raise AnalysisError(f"observer = {observer!r}; needs hl.people.SimulatedObserver(weber=...) or a Person")
    procedure = procedure or UpDown(first=math.log(2))
    if procedure.done:
        raise AnalysisError("the procedure already has all its answers; make a new one")
    paddle, rng, trials, stopped = task.on(paddle), np.random.default_rng(seed), list[Trial](), None
    show = task.presenter(paddle, **options)
    with _table(keep, task) as row:
        while not procedure.done and stopped is None:
            level, reverse = procedure.level, bool(rng.integers(2))
            shown = [task.standard, task.standard * math.exp(level)]
            shown = shown[::-1] if reverse else shown
            logs, stopped = _present(show, task, observer, shown)
            if stopped is None:
                try:
                    answer = observer.compare(task, logs, len(trials))
                except AnalysisError as nothing:
                    stopped = f"no answer to {task.parameter} = {shown[0]:.4g} and {shown[1]:.4g} {task.unit}: {nothing}"
                    break
                trial = Trial(level, shown[0], shown[1], answer, answer == ("first" if reverse else "second"))
                observer.told(trial.right)
                procedure.answer(trial.right)
                trials.append(trial)
                row(trial)
    stopped = stopped or getattr(procedure, "gave_up", None)
    estimate = None if stopped or not hasattr(procedure, "estimate") else procedure.estimate()
    return ForcedChoice(task.name, task.parameter, task.unit, task.standard, tuple(trials), estimate, str(procedure),
                        str(observer), str(paddle), seed, stopped)  # fmt: skip


def _present(show, task, observer, shown):
    """Show the two, one after the other; return the records, and what went wrong or None."""
    logs = []
    for which, value in zip(("first", "second"), shown, strict=True):
        observer.ready(task, which)
        logs.append(show(value))
        if logs[-1].fault is not None:
            return logs, f"the {which} presentation of a trial, {task.parameter} = {value:.4g} {task.unit}: {logs[-1].fault}"
    return logs, None


@contextmanager
def _table(keep, task):
    """Give what takes a trial: a row of the file, if there is one, on the disk at once."""
    if keep is None:
        yield lambda trial: None
        return
    with open(keep, "w", newline="", encoding="utf-8") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(_header(task.unit))

        def row(trial):
            table.writerow(_row(trial))
            file.flush()

        yield row


def _header(unit):
    return ["level [1]", f"first [{unit}]", f"second [{unit}]", "answer", "right"]


def _row(trial):
    return [trial.level, trial.first, trial.second, trial.answer, int(trial.right)]
