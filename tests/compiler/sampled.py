"""What is linear between switches, sampled, without the package.

:func:`motion`, a mass in two modes to forty digits: each piece a power series, its end by mpmath's root finder.
:func:`followed`, any number of masses and modes to double precision: each piece an exponential, its end by bracketing.
"""

import math

import mpmath as mp
import numpy as np
from scipy.linalg import matrix_balance
from scipy.optimize import brentq

ORDER = 90


def motion(samples, T, modes, depth, start):
    """Return z and z' at the samples, and how many switches there were.

    Between two samples the handle is the parabola of "soh" with backward differences.

    Parameters
    ----------
    samples : sequence of float
        Of the handle [m].
    modes : dict bool -> (stiffness, damping, a, b, c)
        z'' = -stiffness z - damping z' + a x + b x' + c, apart and in contact.
    depth : (a, b, c)
        In contact where a z + b x + c > 0, or at 0.
    start : (z, z')
    """
    mp.mp.dps = 40
    T, depth = mp.mpf(T), [mp.mpf(d) for d in depth]
    modes = {closed: [mp.mpf(c) for c in mode] for closed, mode in modes.items()}
    z, w, before, switches, found = *map(mp.mpf, start), [mp.mpf(float(samples[0]))] * 2, 0, []
    for sample in samples:
        found.append((z, w))
        x0, (x1, x2) = mp.mpf(float(sample)), before
        bend = (x0 - 2 * x1 + x2) / T**2
        x, before = [x0, (x0 - x1) / T + bend * T / 2, bend / 2], (x0, x1)
        left, closed = T, depth[0] * z + depth[1] * x0 + depth[2] >= 0
        while left > 0:
            series = _series(modes[closed], z, w, x)
            gap = [(depth[0] * c + depth[1] * (x[k] if k < 3 else 0)) * (1 if closed else -1) for k, c in enumerate(series)]
            gap[0] += depth[2] * (1 if closed else -1)
            taken = _first_root(gap, left)
            z, w = mp.polyval(series[::-1], taken), mp.polyval([k * c for k, c in enumerate(series)][:0:-1], taken)
            x = [mp.polyval(x[::-1], taken), x[1] + 2 * x[2] * taken, x[2]]
            left, closed, switches = left - taken, closed ^ (taken < left), switches + (taken < left)
    return np.array(found), switches


def _series(mode, z, w, x):
    stiffness, damping, a, b, c = mode
    drive = [a * x[0] + b * x[1] + c, a * x[1] + 2 * b * x[2], a * x[2]]
    series = [z, w]
    for k in range(ORDER):
        pushed = (drive[k] if k < 3 else 0) - stiffness * series[k] - damping * (k + 1) * series[k + 1]
        series.append(pushed / ((k + 1) * (k + 2)))
    return series


def _first_root(gap, left, parts=128):
    """Return where a polynomial first goes below zero within ``left``, looked for at so many places; ``left`` if not."""
    scaled = np.array([float(c * left**k) for k, c in enumerate(gap)])
    values = np.polynomial.polynomial.polyval(np.arange(1, parts + 1) / parts, scaled)
    below = np.flatnonzero(values < -1e-9 * abs(scaled).max())
    if not len(below):
        return left
    low, high = (left * mp.mpf(int(below[0]) + k) / parts for k in (0, 1))
    return mp.findroot(lambda t: mp.polyval(gap[::-1], t), (low if below[0] else high / 1e6, high), solver="anderson", tol=1e-60)


def followed(samples, T, hold, start, rates, rows, mode, after):
    """Return y at the samples, and how many switches, of what is linear between them: exponentials and bracketed roots.

    Y = [y, x, x', x'', 1] is what moves over a period, with the handle as ``hold`` has it.

    Parameters
    ----------
    start : sequence of float, shape (S,)
    rates : callable mode -> array of shape (S, S + 4)
        y' by Y.
    rows : callable mode -> array of shape (W, S + 4)
        None of them times Y is negative while the mode lasts.
    mode : callable (Y, mode of the period before or None) -> mode
    after : callable (mode, Y, number of the row that became negative) -> (mode, y)
    """
    y, before, now, switches, found = np.array(start, float), [samples[0]] * 2, None, 0, []
    for x in samples:
        found.append(y)
        (x1, x2), before = before, (x, before[0])
        bend = (x - 2 * x1 + x2) / T**2 if hold == "soh" else 0.0
        Y, left = np.r_[y, x, (x - x1) / T + bend * T / 2, bend, 1.0], T
        now = mode(Y, now)
        while left > 0:
            H, S = np.zeros((len(Y), len(Y))), len(y)
            H[:S], H[S, S + 1], H[S + 1, S + 2] = rates(now), hold != "zoh", 1.0
            taken, row = _first_negative(H, rows(now), Y, left)
            Y, left = _exponential(H * taken) @ Y, left - taken
            if row is not None:
                now, Y[:S] = after(now, Y, row)
                switches += 1
        y = Y[:S]
    return np.array(found), switches


def _first_negative(H, rows, Y, left, parts=64):
    """Return when a row first becomes negative within ``left``, and which; looked for at so many places."""
    step, places = _exponential(H * left / parts), [Y]
    for k in range(parts):
        places.append(step @ places[-1])
        negative = np.flatnonzero(rows @ places[-1] < -1e-14 * np.abs(rows) @ np.abs(places[-1]))
        if len(negative):
            roots = [(left * k / parts + _root(H, rows[r], places[-2], left / parts), r) for r in negative]
            return min(roots)
    return left, None


def _exponential(A):
    """Return e^A by its series, of what is halved until it is short; of matrices as small, scipy's waits for its threads."""
    A, (size, _) = matrix_balance(A, permute=False, separate=True)
    halved = max(0, math.ceil(math.log2(np.abs(A).sum(axis=1).max() + 1e-300)) + 1)
    term = found = np.eye(len(A))
    for k in range(1, 16):
        term = term @ A / (k * 2.0**halved)
        found = found + term
    for _ in range(halved):
        found = found @ found
    return size[:, None] * found / size


def _root(H, row, Y, length):
    def at(tau):
        return row @ _exponential(H * tau) @ Y

    return brentq(at, 0.0, length, xtol=1e-18, rtol=1e-15) if at(0.0) > 0 else 0.0
