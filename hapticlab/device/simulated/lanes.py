"""Simulated paddles side by side: they share one linked program and differ in numbers only, a lane each."""

from dataclasses import fields
from types import SimpleNamespace

import numpy as np

from .motor import is_distorted, knots
from .plant import sensor_age, values


def together(paddle, columns, plant=None):
    """Return paddles that differ in columns only, dict name -> array: what a paddle is, with arrays for these numbers."""
    own = {f.name: getattr(paddle, f.name) for f in fields(paddle)}
    return SimpleNamespace(**{**own, **columns}, plant=plant, velocity=paddle.velocity)


def device_values(paddle):
    """Return the linked program's parameters between the scene's and the start: numbers, arrays where the paddle's are."""
    sensor = () if paddle.velocity == "measured" else (1 / paddle.T,)
    encoder = () if paddle.counts_per_metre is None else (paddle.counts_per_metre, 1 / paddle.counts_per_metre)
    limit = () if paddle.force_max is None else (paddle.force_max,)
    lag = (sensor_age(paddle), paddle.T) if paddle.plant.readings else ()
    motor = (paddle.force_max if paddle.force_full is None else paddle.force_full, *knots(paddle)[:-1])
    return (*values(paddle), *sensor, *encoder, *limit, *lag, *(motor if is_distorted(paddle) else ()))


def lane_values(paddle, columns):
    """Return :func:`device_values` of paddles of one structure, shape (parameters, lanes).

    Examples
    --------
    >>> import numpy as np
    >>> from hapticlab.device.simulated.simulated_paddle import SimulatedPaddle
    >>> paddle = SimulatedPaddle(m=0.05, b=0.0, T=1e-3)
    >>> lane_values(paddle, {"m": np.array([0.05, 0.1])})[-1].round(9).tolist()  # T/m
    [0.02, 0.01]
    """
    rows = device_values(together(paddle, columns, paddle.plant))
    lanes = len(next(iter(columns.values()))) if columns else 1
    return np.array([np.broadcast_to(row, lanes) for row in rows]).reshape(len(rows), lanes)
