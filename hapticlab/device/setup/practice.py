"""A board to practise on: its constants and its wires are a little wrong, and a simulated person plays the student."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ...errors import PaddleError
from ..board.serial_paddle import SerialPaddle
from ..board.settings import changed, nominal
from ..hand.hand import Hand
from ..hand.intents import MinimumJerk
from ..link.serial_ports import open_port
from ..simulated.moved_handle import Handle
from ..simulated.simulated_paddle import SimulatedPaddle
from ..wiring import Wiring
from ..wirings import build
from .person import Person
from .wiring_check import rewired

if TYPE_CHECKING:
    from collections.abc import Mapping

#: weight of a gram [N]
GRAM = 9.80665e-3


class PractisingPerson(Person):
    """Do with a simulated handle what you would do with a real one, and print each question with its answer."""

    def __init__(self, board: SerialPaddle, built: str = "hapkit"):
        self.board, self.port, self.built = board, board.exchange.port, built

    def hold(self, hand: Hand, seconds: float) -> None:
        """Let a hand hold the handle from now on, and wait."""
        handle = self.port.handle
        self.port.handle = Handle(replace(handle.paddle, hand=hand), handle.x, handle.v, handle.steps)
        self.board.exchange.wait(lambda: False, seconds)

    def move(self, place: float) -> None:
        """Move the handle to a place [m], as people do."""
        now = self.port.handle
        path = MinimumJerk(start=now.x, end=place, duration=0.4, begin=now.t)
        self.hold(Hand("grip", intent=path), 0.6)

    def sway(self) -> None:
        """Move the handle back and forth, lightly, from now on."""
        begin = self.port.handle.t
        self.hold(Hand(m=0.02, b=0.5, k=40, intent=lambda t: 0.018 * np.sin(np.pi * (t - begin))), 0)

    def weigh(self) -> str:
        """Return what a kitchen scale under the handle shows [g]."""
        self.board.wait(0.02)
        return f"{abs(self.port.settings.force_of_duty(self.port.board.duty)) / GRAM:.0f}"

    def sweep(self) -> None:
        """Move the handle slowly to the right stop from now on."""
        now = self.port.handle
        path = MinimumJerk(start=now.x, end=0.044, duration=3.0, begin=now.t)
        self.hold(Hand("grip", intent=path), 0)

    def ask(self, question: str) -> str:
        answer = ""
        if question.startswith("Press Enter, then move the handle slowly to the RIGHT"):
            self.sweep()
        elif "LEFT" in question:
            self.move(-0.044)
        elif "RIGHT" in question:
            self.move(0.044)
        elif "one stop" in question:
            for place in (-0.0445, 0.0445, 0.0):
                self.move(place)
        elif "Hold the handle" in question:
            self.sway()
        elif "Travel" in question:
            answer = "88"  # mm, with a ruler
        elif "scale show" in question:
            answer = self.weigh()
        elif question.startswith("Switch the supply of the motor OFF"):
            pass
        elif question.startswith("Let the handle rest"):
            self.move(0.0)
        elif not question.startswith("Press Enter, then move the handle"):  # of a doctor, who asks for nothing else
            raise PaddleError(f"the simulated person of the practice board has no answer to: {question}")
        print(question, answer)
        return answer

    def choose(self, question: str, options: Mapping[str, str]) -> str:
        if question.startswith("Which paddle is built"):
            answer = self.built
        elif question.startswith("By the stored calibration"):
            answer = "yes" if "on the right" in question else "no"  # of the walls
        else:
            answer = next(word for word in ("right", "mm", "scale", "away", "yes") if word in options)
        if question.startswith("Correct it"):
            self.port.sensor = lambda counts: counts  # the wire is where it belongs now
        print(question, answer)
        return answer


#: what is wrong with a practice board, in addition to its constants
TROUBLES = ("motor wires", "wrong wiring", "loose wire", "sensor direction", "dead band")


def practice_board(trouble: str = "motor wires") -> tuple[SerialPaddle, Person]:
    """Make a simulated board that needs calibration, and a simulated person who does what ``hl.calibrate`` asks.

    The board believes its data sheet, 12.8 um per count and 8 N at full duty. The handle and the motor really have 12.1 um
    per count and 7 N. One thing more is wrong, and calibration finds it.

    Parameters
    ----------
    trouble : {"motor wires", "wrong wiring", "loose wire", "sensor direction", "dead band"}
        ``"motor wires"``: the two wires of the motor are swapped. ``"wrong wiring"``: the board is set to a Hapkit, but a
        Longhorn Hapkit is built. ``"loose wire"``: one line of its encoder has no contact until it is corrected.
        ``"sensor direction"``: the lines of its encoder were swapped since the last calibration. ``"dead band"``: the
        driver gives no force below 12 % duty.

    Returns
    -------
    board : SerialPaddle
    person : Person

    Raises
    ------
    PaddleError
        If there is no such trouble.

    Examples
    --------
    >>> import hapticlab as hl
    >>> board, person = hl.devices.practice_board()
    >>> kept = hl.calibrate(board, person, only="stops")  # doctest: +ELLIPSIS
    <BLANKLINE>
    == stops
    ...
    >>> f"{1e6 * kept.metres_per_count:.1f} um per count"
    '12.1 um per count'
    """
    if trouble not in TROUBLES:
        raise PaddleError(f"trouble = {trouble!r}; a practice board has one of {', '.join(TROUBLES)}.")
    hapkit = nominal("hapkit", ident=1, wired=1)
    longhorn = changed(rewired(hapkit, build("longhorn_d6").wiring), wired=1)
    is_hapkit = trouble in ("motor wires", "dead band")
    store = hapkit if is_hapkit or trouble == "wrong wiring" else longhorn
    if trouble == "sensor direction":
        store = changed(store, metres_per_count=12.1e-6, date=20260901)
    port = open_port("sim://hapkit")
    truth = {"metres_per_count": 12.1e-6, "force_full": 7.0, "duty_dead": 0.12 if trouble == "dead band" else 0.0}
    port.put_on(
        SimulatedPaddle(m=0.03, b=0.1, T=1e-3),
        settings=changed(hapkit if is_hapkit else longhorn, **truth),
        store=store.to_bytes(),
    )
    board = SerialPaddle("sim://hapkit", port=port)
    port.wiring = -1 if trouble == "motor wires" else 1
    port.sensor = _sensor(trouble, board)
    return board, PractisingPerson(board, "hapkit" if is_hapkit else "longhorn_d6")


def _sensor(trouble, board):
    """Return what a board reads of its sensor's counts, as a function."""
    if trouble == "wrong wiring":  # nothing is on the pins that the board reads, until it is told the right ones
        return lambda counts: counts if Wiring.of(board.settings) == build("longhorn_d6").wiring else 0
    if trouble == "loose wire":  # of the four edges of an encoder those of one line are left, which go up and down
        return lambda counts: counts // 2 % 2
    return (lambda counts: -counts) if trouble == "sensor direction" else (lambda counts: counts)
