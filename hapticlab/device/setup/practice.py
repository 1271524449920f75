"""A board to practise on: its constants and its wires are a little wrong, and a simulated person plays the student."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ...errors import PaddleError
from ..board.serial_paddle import SerialPaddle
from ..board.settings import nominal
from ..hand.hand import Hand
from ..hand.intents import MinimumJerk
from ..link.serial_ports import open_port
from ..simulated.moved_handle import Handle
from ..simulated.simulated_paddle import SimulatedPaddle
from .person import Person

if TYPE_CHECKING:
    from collections.abc import Mapping

#: weight of a gram [N]
GRAM = 9.80665e-3


class PractisingPerson(Person):
    """Do with a simulated handle what you would do with a real one, and print each question with its answer."""

    def __init__(self, board: SerialPaddle):
        self.board, self.port = board, board.exchange.port

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

    def ask(self, question: str) -> str:
        answer = ""
        if "LEFT" in question:
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
        elif not question.startswith("Press Enter, then move the handle"):  # of a doctor, who asks for nothing else
            raise PaddleError(f"the simulated person of the practice board has no answer to: {question}")
        print(question, answer)
        return answer

    def choose(self, question: str, options: Mapping[str, str]) -> str:
        answer = next(word for word in ("right", "mm", "scale", "away", "yes") if word in options)
        print(question, answer)
        return answer


def practice_board() -> tuple[SerialPaddle, Person]:
    """Make a simulated board that needs calibration, and a simulated person who does what ``hl.calibrate`` asks.

    The board believes its data sheet, 12.8 um per count and 8 N at full duty. The handle and the motor really have 12.1 um
    per count and 7 N, and the two wires of the motor are swapped.

    Returns
    -------
    board : SerialPaddle
    person : Person

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
    port = open_port("sim://hapkit")
    port.put_on(
        SimulatedPaddle(m=0.03, b=0.1, T=1e-3),
        settings=nominal("hapkit", metres_per_count=12.1e-6, force_full=7.0),
        store=nominal("hapkit", ident=1, wired=1).to_bytes(),
    )
    port.wiring = -1
    board = SerialPaddle("sim://hapkit", port=port)
    return board, PractisingPerson(board)
