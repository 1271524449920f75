"""The emulated Uno closed around a handle: motor duty to force, handle position to the sensor's pins, 20 kHz."""

import math
from collections import deque
from dataclasses import replace

import numpy as np
from emulator import Uno

from hapticlab.device.board.settings import pins_of
from hapticlab.device.link.messages import MOTOR_LAWS, SENSORS
from hapticlab.device.simulated.moved_handle import Handle

STEP = 50e-6  # [s]
LINEAR, SQRT = 0, 1


class MagnetoresistiveSensor:
    """A KMA210 on A2: counts grow by ``wrap`` over half a turn of the magnet, then fly back to ``low`` in ``flight`` [s]."""

    def __init__(self, metres_per_count, wrap=920, low=52, offset=300, flight=0.0, channel=2):
        self.metres_per_count, self.wrap, self.low, self.offset = metres_per_count, wrap, low, offset
        self.flight, self.channel, self.flights, self._angle = flight, channel, 0, None

    def show(self, board, x):
        """Put the pin where a handle at ``x`` [m] puts it, a step after it was there."""
        before, angle = self._angle, x / self.metres_per_count + self.offset
        self._angle = angle
        turns, place = divmod(angle, self.wrap)
        counts = math.floor(place) + self.low
        if self.flight and before is not None and before // self.wrap != turns:
            end = max(turns, before // self.wrap) * self.wrap  # between two turns
            board.fly(counts, self.flight, STEP * (end - before) / (angle - before), self.channel)
            self.flights += 1
        else:
            board.adc(counts, self.channel)


class AngleSensor:
    """An AS5048A: ``wrap`` counts in a turn of the magnet, read over the SPI with a chip select on ``select``."""

    def __init__(self, metres_per_count, wrap=16384, offset=5000, select=10):
        self.metres_per_count, self.wrap, self.offset, self.select = metres_per_count, wrap, offset, select

    def show(self, board, x):
        """Turn the magnet to where a handle at ``x`` [m] has it."""
        board.sensor.select = self.select
        board.sensor.angle = math.floor(x / self.metres_per_count + self.offset) % self.wrap


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
    sensor : MagnetoresistiveSensor, AngleSensor or QuadratureSensor
    force_full : float
        Force at the handle at full duty [N].
    law : LINEAR or SQRT
        Duty grows with the force, or with its square root.
    motor_sign : int
        -1 where the motor's wires are swapped.
    dead : float
        Part of full duty below which the motor gives no force.
    delay : float
        Age of what the sensor shows [s].
    noise : float
        Standard deviation of the position that the sensor shows [m].
    """

    def __init__(self, board: Uno, handle, sensor, *, force_full, law=LINEAR, motor_sign=1, dead=0.0, delay=0.0, noise=0.0):
        self.board, self.handle, self.sensor = board, handle, sensor
        self.force_full, self.law, self.motor_sign, self.dead, self.noise = force_full, law, motor_sign, dead, noise
        self._past, self._random = deque(maxlen=1 + round(delay / STEP)), np.random.default_rng(7)
        self._step = round(STEP * board.hz)
        self._next = board.cycle
        self.x = handle.step(0.0, 0.0)
        self._show()

    def _show(self):
        """Let the sensor show where the handle was."""
        self._past.append(self.x)
        self.sensor.show(self.board, self._past[0] + (self.noise * self._random.standard_normal() if self.noise else 0.0))

    @property
    def now(self):
        """Virtual time [s]."""
        return self.board.now

    def force(self):
        """The motor's force at the handle now [N], along growing x."""
        duty = self.board.duty / 256
        part = max(0.0, (abs(duty) - self.dead) / (1 - self.dead))
        force = self.force_full * (part * part if self.law == SQRT else part)
        return self.motor_sign * math.copysign(force, duty)

    @classmethod
    def of(cls, settings, board, handle):
        """Close a board around a handle as its Settings say that both are."""
        step, pin = settings.metres_per_count, pins_of(settings.sensor_pins)[0]
        if settings.sensor == SENSORS["MAGNETORESISTIVE"]:
            sensor = MagnetoresistiveSensor(step, settings.wrap, flight=settings.sensor_flight, channel=pin - 14)
        elif settings.sensor == SENSORS["AS5048A"]:
            sensor = AngleSensor(step, settings.wrap, select=pin)
        else:
            sensor = QuadratureSensor(step)
        board.wire(settings.drive, pins_of(settings.motor_pins))
        law = SQRT if settings.motor_law == MOTOR_LAWS["SQRT"] else LINEAR
        return cls(
            board, handle, sensor, force_full=settings.force_full, law=law, motor_sign=settings.motor_sign,
            dead=settings.duty_dead, delay=settings.sensor_delay, noise=settings.sensor_noise,
        )  # fmt: skip

    def run_until(self, condition, seconds):
        """Go on until ``condition()`` holds, looked at every 50 us, or the time is over."""
        end = self.board.cycle + round(seconds * self.board.hz)
        while not condition() and self.board.cycle < end:
            self._next += self._step
            self.board.run_to(min(self._next, end))
            if self.board.cycle < self._next:  # the end lies between two steps
                self._next -= self._step
                return
            self.x = self.handle.step(self.force(), STEP)
            self._show()

    def run(self, seconds):
        """Go on for so long."""
        self.run_until(lambda: False, seconds)
