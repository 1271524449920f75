"""Two paddles coupled over a link: the runner, which relays positions and velocities and computes no force."""

from __future__ import annotations

import math
import time
from contextlib import ExitStack
from typing import TYPE_CHECKING

from ...base.arguments import number
from ...base.shows_itself import ShowsItself
from ...errors import PaddleError
from ..board.serial_paddle import SerialPaddle
from ..simulated.simulated_paddle import SimulatedPaddle
from ..turns import begin
from .coupled_run import CoupledRun, link_times
from .relay import Relay
from .sides import BoardSide, SimulatedSide

if TYPE_CHECKING:
    from ...base.annotations import Number
    from ...compiler.ir.program import Program
    from ...scene.scene import Scene
    from ..paddle import Paddle

    Pair = tuple[float, float]

#: between two looks at boards that run by their own clocks [s]
LOOK = 5e-4
#: of a wait [s]: Windows interrupts none for a thread before it is over
SLICE = 0.05
#: of a time that is a whole number of ticks [s]
ROUNDING = 1e-9
NO_RUN = "nothing runs; start the pair first: pair.start()"


class TwoPaddles(ShowsItself):
    """Two paddles coupled with each other, both simulated, both on boards, or one of each.

    Each runs a scene of :func:`hapticlab.laws.bilateral_coupling` and hears where the other handle is, how fast it
    moves and what its side heard; no force is sent. A scene that does not hear the other fades to 0 N by itself. A side
    that stops, for whatever reason, stops both.

    Two simulated paddles run in lockstep, in virtual time: the same call gives the same run. Boards run by their own
    clocks, and the delay is then in addition to the time that the link takes.

    Parameters
    ----------
    left, right : SimulatedPaddle or SerialPaddle
        A simulated one moves in its own hand, which follows its own intent.
    scene, right_scene : Scene or Program
        Of the left paddle and of the right one; the same for both unless given.
    delay, jitter : float or text [s]
        Each message is late by delay, and by a random part of jitter. In virtual time the delay is rounded to whole
        ticks, one at least: a sample cannot be used before the next one.
    loss : float
        Part of the messages that is lost, 0 <= loss < 1.
    seed : int
        Of jitter and loss.

    Attributes
    ----------
    delay : float
        As rounded [s].

    Raises
    ------
    PaddleError

    Examples
    --------
    >>> import hapticlab as hl
    >>> import numpy as np
    >>> left = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3, hand=hl.Hand("pinch", intent=lambda t: 0.01 * np.sin(6 * t)))
    >>> right = hl.SimulatedPaddle(m=0.05, b=0.1, T=1e-3)
    >>> pair = hl.devices.TwoPaddles(left, right, hl.laws.bilateral_coupling()(k=100, b=0.5), delay="5 ms")
    >>> run = pair.run("2 s")
    >>> round(float(run.right.x.max() / run.left.x.max()), 2)        # the right handle swings too far: it is free
    1.2
    """

    def __init__(
        self,
        left: Paddle,
        right: Paddle,
        scene: Scene | Program,
        right_scene: Scene | Program | None = None,
        *,
        delay: Number = 0.0,
        jitter: Number = 0.0,
        loss: float = 0.0,
        seed: int = 0,
    ) -> None:
        _check_two(left, right)
        scenes = scene, scene if right_scene is None else right_scene
        self._sides = [
            _side(name, paddle, its) for name, paddle, its in zip(("left", "right"), (left, right), scenes, strict=True)
        ]
        self._left, self._right = self._sides
        self._left.wants(self._right)
        self._right.wants(self._left)
        self._realtime = any(side.realtime for side in self._sides)
        if self._realtime and any(side.lockstep for side in self._sides):
            raise PaddleError(
                "one board runs by the clock and the other in virtual time; give both ?pace=real, as sim://hapkit?pace=real"
            )
        if not self._realtime and not math.isclose(left.T, right.T, rel_tol=1e-9):
            raise PaddleError(f"T = {left.T:g} s and {right.T:g} s; two paddles in virtual time need the same T")
        late = {"delay": delay, "jitter": jitter}
        delay, jitter = (number(name, s, "s", "a link", least=0, error=PaddleError) for name, s in late.items())
        why = "no message would come"
        self._loss, self._seed = number("loss", loss, "", "a link", least=0, below=1, why=why, error=PaddleError), seed
        tick = 0.0 if self._realtime else left.T
        self.delay = max(tick, round(delay / tick) * tick) if tick else delay
        self.jitter, self._turns, self._running = jitter, None, False
        self._fault: str | None = None

    def run(self, duration: Number, *, x: Pair = (0.0, 0.0), v: Pair = (0.0, 0.0)) -> CoupledRun:
        """Couple the paddles for a duration and return what both recorded; the motors are off before and after.

        Parameters
        ----------
        duration : float or text [s]
        x, v : (float, float)
            Position [m] and velocity [m/s] of simulated handles at the first sample, left and right.

        Returns
        -------
        CoupledRun
        """
        seconds = number("duration", duration, "s", "a run", above=0, error=PaddleError)
        self.start(x=x, v=v)
        try:
            self.wait(seconds)
        except BaseException:
            self._halt()
            raise
        return self.stop()

    def start(self, *, x: Pair = (0.0, 0.0), v: Pair = (0.0, 0.0)) -> None:
        """Start both scenes, the left one first, and relay from then on until :meth:`stop`.

        In virtual time nothing moves but in :meth:`wait`. ``x`` and ``v`` are as for :meth:`run`.

        Parameters
        ----------
        x : (float, float)
            Positions of both handles at the start [m]; of simulated paddles alone.
        v : (float, float)
            Their velocities there [m/s].
        """
        if self._running:
            raise PaddleError("the pair runs already; end it first: pair.stop()")
        self._fault, self._now = None, 0.0
        self._relays = [Relay(self.delay, self.jitter, self._loss, [self._seed, k]) for k in range(2)]
        for side, place, speed in zip(self._sides, x, v, strict=True):
            side.prepare(place, speed)  # both, before either motor is on
        self._running = True
        try:
            for side in self._sides:
                if self._realtime:
                    side.source.warm()
                side.start()
        except BaseException:
            self._halt()
            raise
        self._began = time.monotonic()
        self._clock = (lambda: time.monotonic() - self._began) if self._realtime else (lambda: self._now)
        if self._realtime:
            self._turns = begin(self._relay_on(), "hapticlab pair")

    def wait(self, seconds: Number) -> None:
        """Let the pair run for so long [s], or until one side stops, which stops both and is reported.

        An interrupt switches both motors off; :meth:`stop` still returns what was recorded.

        Parameters
        ----------
        seconds : float or text
            [s], >= 0, or a text with its unit.
        """
        seconds = number("seconds", seconds, "s", "a wait", least=0, error=PaddleError)
        self._require_run()
        try:
            self._wait(seconds)
        except BaseException:
            self._fault = "the wait was interrupted"
            self._motors_off()
            self._end_relay()
            raise
        if self._fault is not None:
            print(f"both motors are off. {self._fault}")

    def set(self, **values: float | str) -> None:
        """Set parameters of both scenes, such as k and b, while they run or before.

        Parameters
        ----------
        **values : float or text
            Parameters by name, in SI or with a unit; both scenes get the same.
        """
        for side in self._sides:
            side.source.check(**values)
        for side in self._sides:
            side.set(**values) if self._running else side.source.set(**values)

    def stop(self) -> CoupledRun:
        """Switch both motors off and return what was recorded."""
        self._require_run()
        self._halt()
        left, right = self._sides
        fault = self._fault or "; ".join(f"{side.name}: {side.failed}" for side in self._sides if side.failed) or None
        return CoupledRun(left.telemetry(), right.telemetry(), link_times(left, right), link_times(right, left), fault)

    def _require_run(self):
        if not self._running:
            raise PaddleError(NO_RUN)

    def _halt(self):
        """End the relay, and switch both motors off."""
        self._running = False
        self._end_relay()

    def _end_relay(self):
        """Wait for its last turn, which may still begin a side that was waiting, and switch both motors off."""
        turns, self._turns = self._turns, None
        try:
            if turns is not None:
                turns.join(2)
        finally:
            self._motors_off()

    def _motors_off(self):
        """Switch both motors off, each also where the other one's port has failed."""
        with ExitStack() as both:
            for side in self._sides:
                both.callback(side.stop)

    def _turn(self):
        """Give each side what has arrived for it, let time pass, and send what was measured on its way."""
        for side, relay in zip(self._sides, reversed(self._relays), strict=True):
            side.hear(relay.arrived(self._clock() + ROUNDING))
        for side, other, relay in zip(self._sides, reversed(self._sides), self._relays, strict=True):
            ticks = side.due(self._clock()) if self._realtime else 1
            rows = side.advance(ticks, self._clock) if ticks else None
            if rows is not None:
                relay.send(side.message(rows, other), self._clock())
        self._fault = self._fault or "; ".join(f"{side.name}: {side.off}" for side in self._sides if side.off) or None
        if self._fault:
            self._motors_off()

    def _relay_on(self):
        """Turns of a pair that runs by the clock; however they end, both motors are off."""
        try:
            while self._running and self._fault is None:
                self._turn()
                yield LOOK
        except Exception as problem:
            self._fault = f"the relay ended: {type(problem).__name__}: {problem}"
        finally:
            if self._running:
                self._motors_off()

    def _wait(self, seconds):
        if self._realtime:
            self._wait_by_the_clock(seconds)
            return
        T = self._left.T
        for _ in range(round(seconds / T)):
            if self._fault is None:
                self._turn()
                self._now = round(self._now / T + 1) * T

    def _wait_by_the_clock(self, seconds):
        turns, until = self._turns, time.monotonic() + seconds
        while (left := until - time.monotonic()) > 0 and not turns.join(min(left, SLICE)):
            pass

    def __str__(self) -> str:
        left, right = (side.source.program.name for side in self._sides)
        clock = "by the clock" if self._realtime else "in virtual time"
        return f"two paddles {clock}, messages late by {1e3 * self.delay:g} ms: {left} / {right}"

    def __repr__(self) -> str:
        return f"<TwoPaddles: {self}>"


def _side(name, paddle, scene):
    return (SimulatedSide if isinstance(paddle, SimulatedPaddle) else BoardSide)(name, paddle, scene)


def _check_two(left, right):
    for name, paddle in (("left", left), ("right", right)):
        if not isinstance(paddle, (SimulatedPaddle, SerialPaddle)):
            raise PaddleError(f"{name} = {paddle!r}; needs a SimulatedPaddle, or a paddle of hl.connect()")
    if isinstance(left, SerialPaddle) and left is right:
        raise PaddleError(f"{left.url} is given for both sides; a coupling needs two boards, each on a port of its own")
