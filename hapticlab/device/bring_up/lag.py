"""How long after the command the handle begins to move: a square wave of force, fitted with a delay.

In a window around each change of the force the handle obeys m x'' = -F(t - lag) - b x' - k x - f_c sign(x') + c, where m, b and
k include the fingers that hold it. Integrated twice this is linear in 1/m, b/m, k/m and f_c/m, and a constant and a slope
of time, which are projected out of every window; no derivative of a reading in steps is taken. The lag is the one that leaves
the least. What it holds is all from the sample that computes a force to the reading that shows it: step, motor driver, sensor.
"""

from dataclasses import dataclass

import numpy as np

#: lags tried [s], a window [s], half of the samples over which the sign of the velocity is taken
LAGS, WINDOW, ACROSS = np.arange(-0.5e-3, 6e-3, 0.05e-3), 0.12, 4
#: groups of windows that are fitted apart, for the spread
GROUPS = 5


@dataclass(frozen=True)
class Lag:
    """The lag [s], its spread over groups of the record [s], and the mass felt [kg]: negative where the motor's sign is wrong."""

    lag: float
    spread: float
    mass: float


def fit_lag(t, x, changes):
    """Return the Lag of positions x [m] at times t [s] under forces that change as ``changes`` say: (time, force [N]).

    Parameters
    ----------
    t, x : array of shape (N,)
    changes : sequence of (float, float)
        The force on the environment holds from each time on; the motor gives its opposite.

    Returns
    -------
    Lag

    Examples
    --------
    A free mass of 0.1 kg, pushed and pulled by 0.4 N every 60 ms, 1 ms late:

    >>> import numpy as np
    >>> t = np.arange(0, 1.2, 1e-3)
    >>> changes = [(0.06 * k, 0.4 * (-1) ** k) for k in range(20)]
    >>> steps = [(when, f - before) for (when, f), (_, before) in zip(changes, [(0, 0.0), *changes])]
    >>> x = sum(-step / 0.1 * np.maximum(t - when - 1e-3, 0) ** 2 / 2 for when, step in steps)
    >>> found = fit_lag(t, x, changes)
    >>> round(1e3 * found.lag, 2), round(found.mass, 3)
    (1.0, 0.1)
    """
    windows = [_Window(t, x, changes, when) for when, _ in changes if t[0] <= when - WINDOW / 2 and when + WINDOW / 2 <= t[-1]]
    groups = [windows[k::GROUPS] for k in range(GROUPS)]
    lags = [_best(group)[0] for group in groups if group]
    lag, mass = _best(windows)
    return Lag(lag, float(np.std(lags) / np.sqrt(max(len(lags) - 1, 1))), mass)


class _Window:
    """One stretch of the record, everything in it twice integrated and freed of a constant and a slope."""

    def __init__(self, t, x, changes, when):
        near = np.abs(t - when) <= WINDOW / 2
        self.t, y = t[near] - when, x[near]
        steps = [(at - when, f - before) for (at, f), (_, before) in zip(changes, [(0, 0.0), *changes], strict=False)]
        self.steps = [step for step in steps if abs(step[0]) <= WINDOW / 2 + LAGS[-1]]  # others are a parabola here, or nothing
        self.line = np.linalg.qr(np.vander(self.t, 3))[0]  # t^2: a constant force, as of a slope or of the hand
        v = np.sign(np.convolve(np.gradient(y, self.t), np.ones(2 * ACROSS + 1), "same"))
        self.y = self.freed(y)
        self.known = [self.freed(c) for c in (self.sum(y), self.sum(self.sum(y)), self.sum(self.sum(v)))]

    def freed(self, column):
        return column - self.line @ (self.line.T @ column)

    def sum(self, column):
        """Integrate by trapezia."""
        return np.concatenate([[0.0], np.cumsum((column[1:] + column[:-1]) / 2 * np.diff(self.t))])

    def force(self, lag):
        """The force twice integrated, as late as that."""
        return self.freed(sum(step * np.maximum(self.t - at - lag, 0.0) ** 2 / 2 for at, step in self.steps))


def _best(windows):
    """Return the lag [s] that leaves the least, between those tried, and the mass [kg]."""
    fits = [_fit(windows, lag) for lag in LAGS]
    rest = np.array([left for left, _ in fits])
    k = int(np.clip(np.argmin(rest), 1, len(LAGS) - 2))
    bend = rest[k + 1] - 2 * rest[k] + rest[k - 1]
    off = 0.5 * (rest[k - 1] - rest[k + 1]) / bend if bend > 0 else 0.0
    return float(LAGS[k] + off * (LAGS[1] - LAGS[0])), fits[k][1]


def _fit(windows, lag):
    y = np.concatenate([w.y for w in windows])
    columns = [np.concatenate([w.force(lag) for w in windows])]
    columns += [np.concatenate([w.known[k] for w in windows]) for k in range(3)]
    A = np.column_stack(columns)
    size = np.where(np.linalg.norm(A, axis=0) > 0, np.linalg.norm(A, axis=0), 1.0)
    found, *_ = np.linalg.lstsq(A / size, y, rcond=1e-9)
    return float(np.sum((y - A / size @ found) ** 2)), float(-size[0] / found[0])
