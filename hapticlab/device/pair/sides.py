"""One paddle of a pair: a simulated one or one on a board, both asked in the same words."""

import math

import numpy as np

from ...errors import HapticlabError, PaddleError
from ...scene.laws.bilateral import BEAT, HEARD
from ..board.streaming import Streaming
from ..live_parameters import named_values
from ..simulated.stepping import Stepping, told

#: beats return to 1 after so many ticks, whole numbers in float32 until then
BEATS = 2**23
#: a simulated paddle that is late makes up for so much at once [s]
LONGEST_BURST = 0.1


class Side:
    """A paddle of a pair, its scene, what it recorded, and in words what failed.

    Parameters
    ----------
    name : str
        left or right.
    source : Stepping or Streaming
    """

    def __init__(self, name, source):
        self.name, self.source, program = name, source, source.program
        self.parameters = {c.name for c in program.parameters}
        self.columns = {"x", "v", *(c.name for c in program.outputs[1:])}
        if not {BEAT, "other_x"} <= self.parameters or "heard" not in self.columns:
            raise PaddleError(
                f"{name}: {program.name} does not hear another paddle. Give a scene of hl.laws.bilateral_coupling(), with its "
                "stiffness and damping bound"
            )

    @property
    def T(self):
        return self.source.program.T

    @property
    def off(self):
        """Why the motor is off, in words; empty while it is on, or waits for the handle to be led."""
        source = self.source
        return self.failed or source.fault or ("" if source.kind == "simulated" or source.begun else "the motor is off")

    def wants(self, other):
        """Refuse another side that does not record what this one has to hear."""
        lacking = [HEARD[name] for name in HEARD if name in self.parameters and HEARD[name] not in other.columns]
        if lacking:
            raise PaddleError(
                f"{self.name}: {self.source.program.name} needs {', '.join(lacking)} of the other paddle, whose "
                f"{other.source.program.name} does not watch it. Give both sides the same architecture and controller; in "
                "position-force one is the leader and one the follower"
            )

    def start(self):
        """Start the scene; its coupling gives no force before the other is heard."""
        self.rows, self.changes, self._values, self.arrivals, self.failed = [], [], named_values(self.source.program), [], ""
        self._waits = None
        self.source.start()

    def advance(self, ticks, clock):
        """Let so many ticks pass, or look at what a board sent meanwhile; return the new rows, None where there are none."""
        new = self._asked(self.source.advance, self._intent(ticks))
        if new is None or not len(new["t"]):
            return None
        self.rows.append(new)
        self.arrivals.append((new["t"][-1], clock() - new["t"][-1]))
        return new

    def hear(self, message):
        """Give the scene what the other paddle sent, or None for nothing new; what a board is not ready for waits.

        A message with what is no number is not passed on: to this side it is silence.
        """
        if message is not None and all(map(math.isfinite, message.values())):
            self._waits = message
        if self._waits and self._asked(self.source.hear, **self._waits):
            self._waits = None

    def stop(self):
        """Switch the motor off; a failure is told by :attr:`failed`, so that the other side is stopped too."""
        self._asked(self.source.stop)

    def _asked(self, what, *given, **named):
        """Ask the source; a port that fails stops this side, in words."""
        try:
            return what(*given, **named)
        except HapticlabError as problem:
            self.failed = self.failed or str(problem)

    def message(self, rows, other):
        """What the other side is to hear of the newest of these rows."""
        heard = {name: float(rows[column][-1]) for name, column in HEARD.items() if name in other.parameters}
        return heard | {BEAT: float(round(rows["t"][-1] / self.T) % BEATS + 1)}

    def set(self, **values):
        """Set parameters of the scene, and note when."""
        self.changes.append((self.source.set(**values), self.source.check(**values)))

    def telemetry(self):
        """Return what was recorded since the start."""
        if not self.rows:
            raise PaddleError(f"{self.name}: nothing was recorded{f': {self.off}' if self.off else ''}")
        rows = {name: np.concatenate([part[name] for part in self.rows]) for name in self.rows[0]}
        return self.source.telemetry(rows, values=self._values, changes=self.changes)

    def _intent(self, ticks):
        return np.zeros(ticks + 1)


class SimulatedSide(Side):
    """A simulated paddle in its own hand, which follows its own intent."""

    realtime = lockstep = False

    def __init__(self, name, paddle, scene):
        super().__init__(name, Stepping(paddle, scene, own_hand=True))
        self._begin = 0.0, 0.0

    def prepare(self, x, v):
        """Put the handle to x [m] with v [m/s]."""
        if (x, v) != self._begin:
            source, self._begin = self.source, (x, v)
            self.source = Stepping(source.paddle, source.program, x=x, v=v, own_hand=True)

    def _intent(self, ticks):
        hand = self.source.paddle.hand
        if hand is None or not hand.moves or hand.intent is told:
            return np.zeros(ticks + 1)
        return hand.samples(ticks, self.T, first=self.source.ticks)

    def due(self, now):
        """Ticks that have passed on a clock [s] and not here."""
        late = int(now / self.T + 1e-9) - self.source.ticks
        return max(0, min(late, int(LONGEST_BURST / self.T)))


class BoardSide(Side):
    """A paddle on a board, in a hand of flesh."""

    def __init__(self, name, paddle, scene):
        super().__init__(name, Streaming(paddle, scene))
        self.lockstep = paddle.exchange.lockstep
        self.realtime = not self.lockstep

    def prepare(self, x, v):
        """Have the handle led to its stops where the board does not know its place, with the motor off."""
        if x or v:
            raise PaddleError(
                f"{self.name}: x = {x:g} m, v = {v:g} m/s: on a board the handle starts where it is. Move the handle there, "
                "or use a SimulatedPaddle"
            )
        if self.source.is_lost():
            print(f"the {self.name} paddle:")
            self.source.paddle.home()

    def due(self, now):
        """One look: time passes there by itself."""
        return 1
