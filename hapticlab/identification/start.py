"""Where a fit begins: the equation of motion integrated twice is linear in what is sought."""

import numpy as np

#: counts, or noises, that a handle moves within WINDOW samples on either side, at least, if it moves at all
MOVED, WINDOW = 4.0, 3
#: whole samples of delay that are tried
DELAYS = range(6)


def begin(y, F, T, *, push=0.0, m=None, noise=0.0, delays=DELAYS, without=(), coulomb=None):
    """First values of (m, b, coulomb, delay) and of the start (x0, v0), from one record.

    x = x0 + (v0 + b/m x0) t - b/m int x - coulomb/m iint sign(x') + 1/m iint (push - F): least squares, for each whole
    delay that is tried. As nothing is differentiated noise in x hardly matters. A resting handle has no net force.

    Parameters
    ----------
    y, F : array, shape (N,)
        Positions [m] and forces on the environment [N].
    T, push, m : float
        [s], [N], and the mass [kg] where it is known.
    noise : float
        What a resting handle seems to move by [m].
    without : sequence of {"b", "coulomb"}
        Taken for zero: over a short record damping and friction may stand for each other, and for some of the mass.
    coulomb : float, optional
        Friction [N] that is taken for known: where most of the force goes into it, least squares take it for damping.

    Examples
    --------
    >>> t = np.arange(0, 0.2, 1e-3)
    >>> found, start = begin(0.4 * t - t**2 / 2, 0 * t, 1e-3, m=0.05)      # coulomb/m = 1 m/s^2
    >>> round(found["coulomb"], 3), round(float(start[1]), 3)
    (0.05, 0.4)
    """
    tries = [_with_delay(y, F, T, push, m, noise, whole, without, coulomb) for whole in delays]
    return min(tries, key=lambda found: found[0])[1:]


def _with_delay(y, F, T, push, m, noise, whole, without, coulomb):
    samples = np.arange(len(y))
    felt = np.interp(samples - whole, samples, F, left=0.0)
    sign = heading(y, noise)
    rubbed = 0.0 if coulomb is None else coulomb * sign
    driven = _sum(_sum((push - felt) * (sign != 0) - rubbed, T), T)
    columns = [np.ones(len(y)), samples * T, -_sum(y - y[0], T), -_sum(_sum(sign, T), T)]
    for column, name in ((2, "b"), (3, "coulomb")):
        columns[column] = columns[column] * (name not in without and (name != "coulomb" or coulomb is None))
    rest = y - y[0]
    if m is None:
        columns.append(driven)
    else:
        rest = rest - driven / m
    A = np.column_stack(columns)
    size = np.linalg.norm(A, axis=0)
    size = np.where(size > 0, size, 1.0)
    found = np.linalg.lstsq(A / size, rest, rcond=1e-9)[0] / size
    left = np.sum((rest - A @ found) ** 2)
    m = float(1 / max(found[4], 0.2)) if m is None else m
    b, friction = (max(float(a), 0.0) * m for a in found[2:4])
    friction = friction if coulomb is None else coulomb
    return left, {"m": m, "b": b, "coulomb": friction, "delay": whole * T}, (y[0] + found[0], found[1])


def _sum(values, T):
    """Integrate by trapezia from zero."""
    return np.concatenate([[0.0], np.cumsum((values[1:] + values[:-1]) / 2)]) * T


def heading(y, noise):
    """The sign of the velocity over a window, 0 where the handle seems to rest."""
    moved = np.pad(y, (0, WINDOW), "edge")[WINDOW:] - np.pad(y, (WINDOW, 0), "edge")[:-WINDOW]
    return np.where(np.abs(moved) > MOVED * noise, np.sign(moved), 0.0)
