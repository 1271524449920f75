"""The emulated Uno closed around a handle: motor duty to force, handle position to the sensor's pins, 20 kHz."""

import math
from dataclasses import replace

from emulator import CYCLES_PER_SECOND, Uno

from hapticlab.device.link.messages import MOTOR_LAWS, SENSORS
from hapticlab.device.simulated.moved_handle import Handle

STEP = 50e-6  # [s]
LINEAR, SQRT = 0, 1


class MagnetoresistiveSensor:
    """A KMA210 on A2: counts grow by ``wrap`` over half a turn of the magnet, then begin again at ``low``."""

    def __init__(self, metres_per_count, wrap=920, low=52, offset=300):
        self.metres_per_count, self.wrap, self.low, self.offset = metres_per_count, wrap, low, offset

    def show(self, board, x):
        """Put the pin where a handle at ``x`` [m] puts it."""
        board.adc(math.floor((x / self.metres_per_count + self.offset) % self.wrap) + self.low)


class QuadratureSensor:
    """An encoder on D2 and D3, D2 leading when counts grow; edges come one after the other."""

    def __init__(self, metres_per_count):
        self.metres_per_count, self.count = metres_per_count, None

    def show(self, board, x):
        """Walk the lines to where a handle at ``x`` [m] puts them."""
        goal = math.floor(x / self.metres_per_count)
        if self.count is None:
            self._drive(board, goal)
        while self.count != goal:
            self._drive(board, self.count + (1 if goal > self.count else -1))
            if self.count != goal:  # the interrupt of one edge ends before the next comes
                board.run(1e-5)

    def _drive(self, board, count):
        self.count = count
        for pin, level in zip((2, 3), ((0, 0), (1, 0), (1, 1), (0, 1))[count % 4], strict=True):
            board.pin(pin, level)


class PaddleHandle:
    """The handle of a SimulatedPaddle, as ClosedLoop moves it. Its x has the paddle's sensor noise."""

    def __init__(self, paddle, x=0.0, v=0.0):
        self.handle = Handle(replace(paddle, T=STEP), x, v)

    def step(self, force, seconds):
        """Apply the motor's force [N] for STEP; the force on the environment is its opposite."""
        if seconds:
            self.handle.step(-force)
        return self.handle.seen


class ClosedLoop:
    """An :class:`Uno` and what it moves.

    Parameters
    ----------
    board : Uno
    handle : object
        ``step(force_N, seconds)`` moves it and returns its position [m].
    sensor : MagnetoresistiveSensor or QuadratureSensor
    force_full : float
        Force at the handle at full duty [N].
    law : LINEAR or SQRT
        Duty grows with the force, or with its square root.
    motor_sign : int
        -1 where the motor's wires are swapped.
    """

    def __init__(self, board: Uno, handle, sensor, *, force_full, law=LINEAR, motor_sign=1):
        self.board, self.handle, self.sensor = board, handle, sensor
        self.force_full, self.law, self.motor_sign = force_full, law, motor_sign
        self._step = round(STEP * CYCLES_PER_SECOND)
        self._next = board.cycle
        self.x = handle.step(0.0, 0.0)
        sensor.show(board, self.x)

    @property
    def now(self):
        """Virtual time [s]."""
        return self.board.now

    def force(self):
        """The motor's force at the handle now [N], along growing x."""
        part = self.board.duty / 256
        return self.motor_sign * self.force_full * (part * abs(part) if self.law == SQRT else part)

    @classmethod
    def of(cls, settings, board, handle):
        """Close a board around a handle as its Settings say that both are."""
        if settings.sensor == SENSORS["MAGNETORESISTIVE"]:
            sensor = MagnetoresistiveSensor(settings.metres_per_count, settings.wrap)
        else:
            sensor = QuadratureSensor(settings.metres_per_count)
        law = SQRT if settings.motor_law == MOTOR_LAWS["SQRT"] else LINEAR
        return cls(board, handle, sensor, force_full=settings.force_full, law=law, motor_sign=settings.motor_sign)

    def run_until(self, condition, seconds):
        """Go on until ``condition()`` holds, looked at every 50 us, or the time is over."""
        end = self.board.cycle + round(seconds * CYCLES_PER_SECOND)
        while not condition() and self.board.cycle < end:
            self._next += self._step
            self.board.run_to(min(self._next, end))
            if self.board.cycle < self._next:  # the end lies between two steps
                self._next -= self._step
                return
            self.x = self.handle.step(self.force(), STEP)
            self.sensor.show(self.board, self.x)

    def run(self, seconds):
        """Go on for so long."""
        self.run_until(lambda: False, seconds)
