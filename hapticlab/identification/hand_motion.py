"""Handle and hand under a held force: mass, damper, spring to a resting place, and the device's Coulomb friction."""

import numpy as np

from ..device.simulated.transition import transition

#: instead of zero under a fraction: N/m, 1/s^2
LEAST = 1e-12


def hand_positions(F, T, *, m, b, k, coulomb, delay, rest, x0, v0):
    """Positions at the samples [m] of m x'' = -F - b x' - k (x - rest) - coulomb sign(x'), shape (N, ...).

    Parameters
    ----------
    F : array, shape (N,)
        Force on the environment [N]; none was felt before the first.
    T, coulomb, delay : float
        [s], [N], [s], the device's and known.
    m, b, k, rest, x0, v0 : float or array
        Of handle and hand together [kg], [N s/m], [N/m]; where the spring is at rest [m], and the start [m], [m/s].

    Examples
    --------
    >>> swing = hand_positions(np.zeros(3), np.pi / 4, m=1, b=0, k=4, coulomb=0, delay=0, rest=0, x0=1, v0=0)
    >>> swing.round(9).tolist()                            # cos 2t
    [1.0, 0.0, -1.0]
    """
    shape = np.broadcast_shapes(*map(np.shape, (m, b, k, rest, x0, v0)))
    m, b, k, rest, x0, v = (np.broadcast_to(np.asarray(a, float), shape) for a in (m, b, k, rest, x0, v0))
    whole = int(np.floor(delay / T + 1e-9))
    late = max(delay - whole * T, 0.0)
    parts = [(h, whole + lag) for h, lag in ((late, 1), (T - late, 0)) if h > 1e-9 * T]
    steps = [(_Friction(m, b, k, coulomb, h) if coulomb else _linear(m, b, k, h), lag) for h, lag in parts]
    y, found = x0 - rest, np.empty((len(F), *shape))
    found[0] = x0
    for n in range(len(F) - 1):
        for advance, lag in steps:
            y, v = advance(y, v, -F[n - lag] if n >= lag else 0.0)
        found[n + 1] = y + rest
    return found


def _linear(m, b, k, h):
    phi = transition(m, b, k, h)
    return lambda y, v, u: (
        phi["xx"] * y + phi["xv"] * v + phi["xu"] * u,
        phi["vx"] * y + phi["vv"] * v + phi["vu"] * u,
    )


class _Friction:
    """A step with friction: a swing about where the force and the friction of one heading balance, until it stops."""

    def __init__(self, m, b, k, coulomb, h):
        self.k, self.coulomb, self.h = np.where(k == 0, LEAST, k), coulomb, h
        self.sigma, self.square = b / m / 2, self.k / m
        bend = self.sigma**2 - self.square
        self.swings, self.rate = bend < 0, np.sqrt(np.maximum(np.abs(bend), LEAST))
        self.whole = self._shape(np.broadcast_to(h, self.rate.shape))

    def __call__(self, y, v, u):
        heading = np.sign(v)
        middle = (u - self.coulomb * heading) / self.k
        end, speed = self._swung(y - middle, v, self.whole)
        if np.all(speed * v > 0):  # nobody has stopped: a period is far shorter than a swing
            return end + middle, speed
        pull = u - self.k * y
        heading = np.where(v == 0, np.where(np.abs(pull) > self.coulomb, np.sign(pull), 0.0), heading)
        middle = (u - self.coulomb * heading) / self.k
        lasts = np.where(heading == 0, 0.0, np.minimum(self.h, self._stops(y - middle, v, heading)))
        moved, speed = self._swung(y - middle, v, self._shape(lasts))
        y, v = np.where(heading == 0, y, moved + middle), np.where((heading == 0) | (lasts < self.h), 0.0, speed)
        rest = np.where(heading == 0, 0.0, self.h - lasts)
        if not np.any(rest > 0):
            return y, v
        pull = u - self.k * y
        again = (rest > 0) & (np.abs(pull) > self.coulomb)
        middle = (u - self.coulomb * np.sign(pull)) / self.k
        moved, speed = self._swung(y - middle, 0.0, self._shape(rest))
        return np.where(again, moved + middle, y), np.where(again, speed, v)

    def _shape(self, t):
        """e^(-sigma t) cos, and e^(-sigma t) sin over the rate, hyperbolic where nothing swings."""
        angle, fades = self.rate * t, np.exp(-self.sigma * t)
        cos = np.where(self.swings, np.cos(angle), np.cosh(np.minimum(angle, 300.0)))
        sin = np.where(self.swings, np.sin(angle), np.sinh(np.minimum(angle, 300.0)))
        return fades * cos, fades * sin / self.rate

    def _swung(self, z, v, shape):
        cos, sin = shape
        return z * (cos + self.sigma * sin) + v * sin, v * (cos - self.sigma * sin) - self.square * z * sin

    def _stops(self, z, v, heading):
        """Time until the speed is zero next [s], infinity where it never is."""
        over, under = self.rate * v * heading, (self.sigma * v + self.square * z) * heading
        ratio = over / np.where(under == 0, LEAST, under)
        creeps = np.arctanh(np.where((ratio > 0) & (ratio < 1), ratio, 0.0))
        angle = np.where(self.swings, np.arctan2(over, under), np.where((ratio > 0) & (ratio < 1), creeps, np.inf))
        return np.where(v == 0, np.inf, angle / self.rate)
