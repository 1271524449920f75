"""The handle of a simulated paddle, moved from outside one period at a time: force in, position out.

Where a program runs elsewhere, in the firmware's core or on an emulated board, this is the mechanics around it. It is
the plant that SimulatedPaddle links into its program, here in plain floats.
"""

import math
from dataclasses import replace

import numpy as np

from .plant import NOWHERE, sensor_age, values

#: periods whose noise and intent are made at once
BLOCK = 1024


class Handle:
    """Mechanics of a simulated paddle, stepped.

    Parameters
    ----------
    paddle : SimulatedPaddle
        Its T is the step.
    x, v : float
        Position [m] and velocity [m/s] at the start.

    Attributes
    ----------
    x, v : float
        True position [m] and velocity [m/s], now.
    steps : int
        Periods done.

    Examples
    --------
    >>> from hapticlab.device.hand.hand import Hand
    >>> from hapticlab.device.simulated.moved_handle import Handle
    >>> from hapticlab.device.simulated.simulated_paddle import SimulatedPaddle
    >>> handle = Handle(SimulatedPaddle(m=0.05, b=0.0, T=1e-3, hand=Hand(push=2.0)))
    >>> for _ in range(100):
    ...     handle.step(0.0)
    >>> round(handle.x, 12)                                 # push t^2 / 2 m
    0.2
    """

    def __init__(self, paddle, x=0.0, v=0.0, steps=0):
        self.paddle, self.steps = paddle, steps
        self._plant = paddle.plant
        self._parameters = dict(zip((c.name for c in self._plant.channels()), values(paddle), strict=True))
        self._past = [0.0] * (self._plant.whole + self._plant.split)
        self.put(x, v)
        self._streams = [np.random.default_rng([paddle.seed, stream]) for stream in (0, 1)]
        self._rows, self._first_row = (), steps

    def put(self, x, v=0.0):
        """Put the handle to x [m] with v [m/s]; to its sensor it came evenly."""
        self.x, self.v, age = float(x), float(v), sensor_age(self.paddle)
        self._read = [self.x - self.v * (age + k * self.paddle.T) for k in range(self._plant.readings)]

    @property
    def t(self):
        """Time since the start [s]."""
        return self.steps * self.paddle.T

    @property
    def seen(self):
        """The position as the sensor reads it, late and with its noise [m]."""
        return [self.x, *self._read][-1] + (self._row()[2] if self.paddle.noise else 0.0)

    def counts(self):
        """Return the encoder's reading, or None where the paddle has no encoder."""
        per_metre = self.paddle.counts_per_metre
        if per_metre is None:
            return None
        return math.floor(self.seen * per_metre + (0.5 if self.paddle.rounding == "nearest" else 0.0))

    def step(self, F):
        """Advance one period in which the force on the environment F [N] is computed at its begin."""
        forces = [float(F), *self._past]
        applied, before = forces[self._plant.whole], forces[-1] if self._plant.split else None
        intent, rate, _, shake = self._row()
        at_sample = self.x
        x_seen, _, self.x, self.v = self._plant.step(self._parameters, self.x, self.v, before, applied, intent, rate, shake)
        self._past = forces[: len(self._past)]
        read = at_sample if self._plant.seen == NOWHERE else x_seen
        self._read = [read, *self._read][: len(self._read)]
        self.steps += 1

    def with_period(self, T):
        """Return the same handle, now, with another step [s]."""
        return Handle(replace(self.paddle, T=T), self.x, self.v, math.ceil(self.t / T - 1e-9))

    def _row(self):
        """Return intent [m], its rate [m/s], sensor noise [m] and hand noise [N] of this period."""
        k = self.steps - self._first_row
        if not 0 <= k < len(self._rows):
            self._rows, self._first_row, k = self._block(), self.steps, 0
        return self._rows[k]

    def _block(self):
        paddle, hand = self.paddle, self.paddle.hand
        columns = np.zeros((4, BLOCK))
        if self._plant.ramp:
            intent = hand.samples(BLOCK, paddle.T, first=self.steps)
            columns[0], columns[1] = intent[:-1], np.diff(intent) / paddle.T
        for row, stream, deviation in ((2, 0, paddle.noise), (3, 1, hand.push_noise if hand else 0.0)):
            if deviation:
                columns[row] = deviation * self._streams[stream].standard_normal(BLOCK)
        return columns.T.tolist()
