"""A simulated owner at a simulated board: what a bench asks is done with the handle, the switch, the cable and Ctrl-C."""

from dataclasses import replace

import numpy as np

from ..board.serial_paddle import SerialPaddle
from ..hand.hand import Hand
from ..hand.intents import MinimumJerk
from ..setup.practice import PractisingPerson
from ..simulated.moved_handle import Handle

#: s until an act comes, and for which a pulled cable stays out
SOON, OUT = 1.0, 0.3
#: in what the check of the sign asks for
SWAYS = "for 6 seconds"


class PractisingOwner(PractisingPerson):
    """Do with a simulated paddle what a bench asks of its owner.

    Examples
    --------
    >>> import hapticlab as hl
    >>> from hapticlab.device.bring_up.practised import PractisingOwner
    >>> with hl.connect("sim://hapkit") as board:
    ...     PractisingOwner(board).ask("Release the handle, and press Enter.")
    Release the handle, and press Enter.
    ''
    """

    def __init__(self, board):
        super().__init__(board)
        self.wires = self.port.wiring  # as they are: a switch does not swap them

    def plug_in(self):
        """The cable goes in again."""
        self.port.is_open = True
        self.board = SerialPaddle(self.board.url, T=self.board.T, port=self.port)
        return self.board

    def ask(self, question):
        known = {} if SWAYS in question else self._acts()
        act = next((act for words, act in known.items() if words in question), None)
        if act is None:
            return super().ask(question)
        print(question)
        act()
        return ""

    def choose(self, question, options):
        if not self.port.is_open:  # nobody reads: the board is alone for a while
            self.port.is_open, self.port.timeout = True, OUT
            self.port.read(65536)
            self.port.is_open = False
        pulls = self.port.board.duty != 0 and self.port.wiring != 0
        said = {"Do you feel a light pull?": pulls, "Has the pull ended?": not pulls}.get(question)
        if said is None:
            return super().choose(question, options)
        print(question, "yes" if said else "no")
        return "yes" if said else "no"

    def _acts(self):
        """Words of a question, and what they ask for; the first that fits is done."""
        return {
            "off the supply": lambda: self._supply(False),
            "Switch the supply off": lambda: self._supply(False),
            "Switch the supply on": lambda: self._supply(True),
            "on the switch": lambda: (self._supply(True), self.move(0.0)),
            "press Ctrl-C": lambda: self._later(self._interrupt),
            "USB cable out": lambda: self._later(self._pull),
            "Plug the cable in": lambda: None,
            "flick": lambda: self._push(0.02, lasts=0.08),
            "towards a stop": lambda: self._push(0.05, lasts=2.5),
            "loosely": lambda: self._take(Hand(m=0.005, b=0.2, k=8.0)),
            "Release": lambda: self._take(None),
            "back, twice": self._sweep,
            "one stop, then to the other": self._lead,
            "in the middle": lambda: self.move(0.0),
            "Rest the handle on the scale": lambda: self.move(0.0),
        }

    def _supply(self, on):
        self.port.wiring = self.wires if on else 0

    def _take(self, hand):
        handle = self.port.handle
        self.port.handle = Handle(replace(handle.paddle, hand=hand), handle.x, 0.0, handle.steps)

    def _push(self, far, lasts):
        self.move(0.0)
        now = self.port.handle
        self.hold(Hand("grip", intent=MinimumJerk(start=now.x, end=far, duration=lasts, begin=now.t + SOON)), 0)

    def _ends(self):
        kept = self.board.settings
        return (kept.travel_min, kept.travel_max) if kept else (-0.044, 0.044)

    def _sweep(self):
        low, high = self._ends()
        middle, half, begin = (low + high) / 2, (high - low) / 2, self.port.handle.t
        self.hold(Hand("grip", intent=lambda t: middle + half * np.sin(0.5 * np.pi * np.maximum(t - begin, 0))), 0)

    def _lead(self):
        for place in (*self._ends(), 0.0):
            self.move(place)

    def _later(self, act):
        """Hold the handle, and act once, soon."""
        self.move(0.0)
        due, done = self.port.handle.t + SOON, []

        def intent(t):
            if np.max(t) >= due + self.port.handle.paddle.T * 1024 and not done:  # a hand plans 1024 samples ahead
                done.append(True)
                act()
            return np.zeros_like(t)

        self.hold(Hand("grip", intent=intent), 0)

    def _interrupt(self):
        raise KeyboardInterrupt

    def _pull(self):
        self.port.is_open = False
