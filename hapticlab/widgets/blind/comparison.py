"""A blind comparison in a notebook: two presentations are felt one after the other, and a key says which was stronger."""

from __future__ import annotations

import copy
import math
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.arguments import instance, number
from ...device.simulated.simulated_paddle import SimulatedPaddle
from ...errors import AnalysisError, EngineMissingError, PaddleError
from ...experiments.forced_choice import ForcedChoice, Trial, forced_choice
from ...experiments.observers import SimulatedObserver
from ...experiments.tasks import Task
from ...experiments.up_down import UpDown
from ..browser_view import front as canvas
from ..session import Session
from ..sliders import open_ipywidgets
from .head import Words, head

if TYPE_CHECKING:
    from ...base.annotations import File
    from ...device.board.serial_paddle import SerialPaddle
    from ...experiments.observers import Answer
    from ...experiments.psi import ConstantLevels, Psi

WHICH: tuple[Answer, Answer] = ("first", "second")
#: how long a presentation may last, and the pause between two [s]
DURATIONS, PAUSES = (0.5, 60.0), (0.2, 10.0)
CURE = "hl.people.compare_blind needs widgets, which do not import here; do: pip install 'hapticlab[notebook]'"


def compare_blind(
    paddle: SimulatedPaddle | SerialPaddle,
    task: Task,
    procedure: UpDown | Psi | ConstantLevels | None = None,
    *,
    duration: float = 3.0,
    pause: float = 1.0,
    seed: int | None = None,
    keep: File | None = None,
) -> BlindComparison:
    """Compare pairs of presentations by hand in a notebook, and say which was stronger, without seeing the answer.

    A trial is a two-alternative forced choice as in :func:`forced_choice`. Press Space (or the button) and move the
    handle: the first presentation lasts ``duration``, then the picture is covered, and the second one follows. Press 1 or 2.
    Position, force, energy, target position and pointer are hidden, the handle starts from the middle each time, and
    nothing shows whether an answer was right. If the motor reaches its limit, the widget says so. On a board the motor is on
    during a presentation only, and each presentation waits for its own press.

    Parameters
    ----------
    paddle : SimulatedPaddle or SerialPaddle
        A simulated paddle without a hand gets the task's hand, which the pointer moves.
    task : Task
        ``hl.people.stiffness_task()``, ``damping_task()``, ``texture_task()``, or your own.
    procedure : UpDown, Psi or ConstantLevels, fresh
        By default two down, one up from ln 2.
    duration : float or text
        Of one presentation [s], 0.5 to 60.
    pause : float or text
        Between two presentations of a trial [s], 0.2 to 10.
    seed : int, optional
        Draws the order in each trial; by default another one each time.
    keep : path, optional
        A CSV file that is written after each answer, so that nothing is lost.

    Returns
    -------
    BlindComparison
        A notebook shows it where it is the last line of a cell; ``.result`` holds the answers, None before the first.

    Raises
    ------
    AnalysisError, PaddleError

    Examples
    --------
    >>> import hapticlab as hl
    >>> paddle = hl.SimulatedPaddle.from_profile("hapkit")
    >>> blind = hl.people.compare_blind(paddle, hl.people.stiffness_task(), seed=3)
    >>> found = blind.result or blind.rehearsal        # without a person a simulated observer answers
    >>> print(blind.result, found.observer)
    None simulated observer, Weber fraction 23 %, 0 % lapses, seed 3
    """
    instance("task", task, Task, "a Task, such as hl.people.stiffness_task()")
    procedure = UpDown(first=math.log(2)) if procedure is None else procedure
    if procedure.done:
        raise AnalysisError("The procedure has had all its answers already; make a fresh one.")
    limits = {"duration": (duration, DURATIONS), "pause": (pause, PAUSES)}
    seconds = {
        name: number(name, given, "s", "a blind comparison", least=least, most=most)
        for name, (given, (least, most)) in limits.items()
    }
    seed = int(np.random.default_rng().integers(2**31)) if seed is None else seed
    return BlindComparison(paddle, task, procedure, seed, keep, **seconds)


class BlindComparison:
    """Pairs that a person compares blindly; made by :func:`compare_blind`."""

    _shown: int | None  # which presentation is on view

    def __init__(self, paddle, task, procedure, seed, keep, *, duration, pause, **session):
        self.task, self._paddle, self._seed, self._keep = task, task.on(paddle), seed, keep
        self._fresh, self._procedure = copy.deepcopy(procedure), procedure
        self._order, self._trials, self._missed = np.random.default_rng(seed), [], 0
        scene = task.scene(**{task.parameter: task.standard})
        self._session = Session(self._paddle, scene, sliders={}, show_force=False, **session)
        self._session.stage.quiet = 0.0  # a presentation ends by itself, and no key both starts and stops
        self._seconds, self._box, self._head, self._rehearsed = {"duration": duration, "pause": pause}, None, None, None
        self._words = Words(self._session.clock)
        self._next_pair()

    @property
    def result(self) -> ForcedChoice | None:
        """The answers so far; None before the first one."""
        return self._found() if self._trials else None

    def _found(self) -> ForcedChoice:
        left = None if self._procedure.done else f"{len(self._trials)} trials so far; the procedure asks for more"
        stopped = getattr(self._procedure, "gave_up", None) or left
        estimate = None if stopped or not hasattr(self._procedure, "estimate") else self._procedure.estimate()
        by = "a person at the screen" if isinstance(self._paddle, SimulatedPaddle) else "a person at the paddle"
        task = self.task
        return ForcedChoice(task.name, task.parameter, task.unit, task.standard, tuple(self._trials), estimate,
                            str(self._procedure), by, str(self._paddle), self._seed, stopped)  # fmt: skip

    @property
    def rehearsal(self) -> ForcedChoice:
        """The same experiment, answered by a simulated observer with the task's Weber fraction, on a simulated paddle."""
        if not isinstance(self._paddle, SimulatedPaddle):
            raise PaddleError("No trial is answered yet, and a board has no rehearsal. Press Space in the view, and answer.")
        if self._rehearsed is None:
            observer = SimulatedObserver(weber=self.task.weber, seed=self._seed)
            self._rehearsed = forced_choice(self._paddle, self.task, observer, copy.deepcopy(self._fresh), seed=self._seed)
        return self._rehearsed

    @property
    def done(self) -> bool:
        """Whether the procedure has all its answers."""
        return self._procedure.done

    def show(self, which: int, age: float = 0.0) -> None:
        """Begin the first or second presentation, 0 or 1, from the middle; pressed so long ago in the page [s]."""
        if self.done or (which == 1 and 0 not in self._felt):
            return
        self._session.set(**{self.task.parameter: self._pair[which]})
        self._session.intend(0.0)
        self._session.hold(True)
        self._session.press("start", age)
        self._shown, self._limited = which, False
        self._tell()

    def _notice(self):
        """Count a presentation as felt once it runs: a board drops a Start that comes late."""
        session = self._session
        if self._shown is not None and session.motion.running and not session.source.waits:
            self._felt.add(self._shown)

    def hide(self) -> None:
        """End a presentation: nothing moves, and a board's motor is off; a simulated handle goes back to the middle, unseen."""
        self._session.intend(0.0)
        if self._shown is not None and self._session.source.kind == "simulated":
            self._session.press("start")
        missed, self._shown = self._shown is not None and self._shown not in self._felt, None
        self._session.press("pause")
        if missed:
            self._missed += 1
            self._tell()

    def answer(self, which: int) -> None:
        """Take the answer that the first or second presentation, 0 or 1, was stronger; the next pair is drawn."""
        if self.done:
            return
        if self._felt != {0, 1}:
            self.hide()
            return
        self.hide()
        first, second = self._pair
        trial = Trial(self._procedure.level, first, second, WHICH[which], self._pair[which] == max(self._pair))
        self._procedure.answer(trial.right)
        self._trials.append(trial)
        if self._keep is not None:
            self._found().to_csv(self._keep)
        if not self.done:
            self._next_pair()
        self._tell()

    def _next_pair(self):
        standard, comparison = self.task.standard, self.task.standard * math.exp(self._procedure.level)
        self._pair = (comparison, standard) if self._order.integers(2) else (standard, comparison)
        self._felt, self._shown, self._limited = set(), None, False

    def _heard(self, _, content, buffers):
        """Take a word of the page."""
        name, value, age = self._words.read(bytes(buffers[0]))
        self._notice()
        if name == "show":
            self.show(value, age)
        elif name == "answer":
            self.answer(value)
        elif name == "hide" or (self._shown is None and self._session.motion.running):
            self.hide()
        elif self._shown is not None and self._session.at_limit and not self._limited:
            self._limited = True
            self._tell()

    def _state(self):
        last = self._trials[-1].answer if self._trials else ""
        trial, felt = len(self._trials) + 1, len(self._felt)
        return {
            "trial": trial, "answered": last, "done": self.done, "limited": self._limited, "felt": felt, "missed": self._missed,
        }  # fmt: skip

    def _tell(self):
        if self._head is not None:
            self._head.state = self._state()

    def _front(self):
        """Return the widget: what leads through a trial above a live view that shows only the picture."""
        if self._box is None:
            widgets, board = open_ipywidgets(CURE), self._session.source.kind == "board"
            about = {"question": self.task.question, "board": board, **self._seconds}
            self._head = head(about, self._state())
            self._head.on_msg(self._heard)
            self._box = widgets.VBox([self._head, canvas(self._session, keys=False)])
            for name in ("hl-blind", "hl-board")[: 1 + board]:
                self._box.add_class(name)
        return self._box

    def __repr__(self) -> str:
        state = "complete" if self.done else "under way" if self._trials else "not begun"
        return f"blind comparison, {self.task.name}: {len(self._trials)} trials answered, {state}"

    def _repr_mimebundle_(self, **options: Any) -> Any:
        text = f"{self!r}\nIt is shown where a notebook shows widgets (JupyterLab, with: pip install 'hapticlab[notebook]')."
        try:
            bundle = self._front()._repr_mimebundle_(**options)
        except EngineMissingError:
            return {"text/plain": text}
        if isinstance(bundle, tuple):
            return {**bundle[0], "text/plain": text}, bundle[1]
        return {**(bundle or {}), "text/plain": text}
