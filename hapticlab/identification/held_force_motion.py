"""The handle under a force that is held, in closed form, many parameter sets side by side.

m x'' = push - scale F - b x' - coulomb sign(x'), stuck at rest while |push - scale F| <= coulomb; F[n] is felt over
[n T + delay, (n+1) T + delay). Between two changes of the force the speed is an exponential and a constant, so where it is
zero is a logarithm, and nothing is approximated.
"""

import math

import numpy as np

#: motions, at most, that are run one by one: a step of arrays takes as long as so many of numbers
FEW = 30
#: b h/m below which its functions are series; the first term left out is below 1e-15
SERIES = 2e-3


def positions(F, T, *, m, b, coulomb, delay, scale, push, x0, v0):
    """The handle's positions at the samples [m], shape (N, ...) with ... that of the parameters.

    Parameters
    ----------
    F : array of shape (N,) or (N, L)
        Force on the environment as commanded [N]; none was felt before the first.
    T : float
        [s]
    m, b, coulomb, delay, scale, push, x0, v0 : float or array of shape (..., L)
        Mass [kg], damping [N s/m], Coulomb friction [N], delay [s] of either sign, newtons at the handle for each
        commanded, a constant force beside the motor's [N], position [m] and velocity [m/s] at the first sample.

    Examples
    --------
    >>> coasting = positions(np.zeros(4), 0.1, m=1, b=0, coulomb=2, delay=0, scale=1, push=0, x0=0, v0=0.5)
    >>> coasting.round(6).tolist()                  # stops after 0.25 s, having gone v0^2/4 = 62.5 mm
    [0.0, 0.04, 0.06, 0.0625]
    """
    F = np.asarray(F, float)
    given = np.broadcast_arrays(*(np.asarray(a, float) for a in (m, b, coulomb, delay, scale, push, v0, x0)))
    if F.ndim == 1 and given[0].size <= FEW:
        return _one_by_one(F, T, given)
    shape = np.broadcast_shapes(*map(np.shape, (m, b, coulomb, delay, scale, push, x0, v0)), F.shape[1:])
    x, v, late = (np.broadcast_to(np.asarray(a, float), shape) for a in (x0, v0, delay))
    whole = np.floor(late / T).astype(int)
    first = late - whole * T  # of the period, under the force that was felt before
    column = (np.broadcast_to(np.arange(F.shape[1]), shape),) if F.ndim == 2 else ()
    beta, grip = b / m, coulomb / m
    parts = [(h, lag, _phi(beta, h)) for h, lag in ((first, whole + 1), (T - first, whole)) if np.any(h > 0)]
    found = np.empty((len(F), *shape))
    found[0] = x
    for n in range(len(F) - 1):
        for duration, lag, phi in parts:
            at = n - lag
            felt = F[(np.minimum(np.maximum(at, 0), len(F) - 1), *column)] * (at >= 0)
            x, v = _glide(x, v, (push - scale * felt) / m, beta, grip, duration, phi)
        found[n + 1] = x
    return found


def _one_by_one(F, T, given):
    """:func:`positions` of few parameter sets; those that differ in where they begin move alike."""
    runs, found = {}, np.empty((len(F), given[0].size))
    for k, (*constants, x0) in enumerate(zip(*(a.ravel().tolist() for a in given), strict=True)):
        one = tuple(constants)
        if one not in runs:
            runs[one] = _moved(F, T, *one) if all(map(math.isfinite, one)) else np.nan
        found[:, k] = x0 + runs[one]
    return found.reshape(len(F), *given[0].shape)


def _moved(F, T, m, b, coulomb, delay, scale, push, v):
    """How far one handle has moved at the samples [m]."""
    whole = math.floor(delay / T)
    beta, grip, first = b / m, coulomb / m, delay - whole * T
    pulls, parts = [], []
    for h, lag in ((first, whole + 1), (T - first, whole)):
        at = np.arange(len(F) - 1) - lag
        pulls.append(((push - scale * F[np.clip(at, 0, len(F) - 1)] * (at >= 0)) / m).tolist())
        parts.append((h, *_phi_of(beta, h)))
    x, found = 0.0, [0.0]
    for pair in zip(*pulls, strict=True):
        for pull, (h, phi1, phi2) in zip(pair, parts, strict=True):
            heading = v or (pull if abs(pull) > grip else 0.0)
            if heading:
                net = pull - math.copysign(grip, heading)
                end = v + (net - beta * v) * phi1
                if end * v > 0 or v * net >= 0:
                    x, v = x + v * phi1 + net * phi2, end
                else:
                    way, v = _turned(v, net, pull, beta, grip, h)
                    x += way
        found.append(x)
    return np.array(found)


def _turned(v, net, pull, beta, grip, h):
    """The way gone in a time h in which the handle stops, and its speed then: none, or the way of the pull."""
    z = -beta * v / net
    lasts = -v / net * (math.log1p(z) / z if abs(z) > 1e-300 else 1.0)
    phi1, phi2 = _phi_of(beta, lasts)
    way = v * phi1 + net * phi2
    if abs(pull) <= grip:
        return way, 0.0
    net = pull - math.copysign(grip, pull)
    phi1, phi2 = _phi_of(beta, h - lasts)
    return way + net * phi2, net * phi1


def _phi_of(beta, t):
    """:func:`_phi` of numbers."""
    z = beta * t
    if abs(z) < SERIES:
        one, two = 1 - z / 2 * (1 - z / 3 * (1 - z / 4 * (1 - z / 5))), 0.5 - z / 6 * (1 - z / 4 * (1 - z / 5 * (1 - z / 6)))
    else:
        one = -math.expm1(-z) / z
        two = (1 - one) / z
    return t * one, t * t * two


def _glide(x, v, pull, beta, grip, duration, phi):
    """Advance under a constant acceleration and friction; once stopped, stay or go the way of the pull."""
    heading = np.sign(v)
    net = pull - grip * heading
    end = v - (beta * v - net) * phi[0]
    if np.all(end * v > 0):  # the speed goes one way all the time, so nobody has stopped
        return x + v * phi[0] + net * phi[1], end
    heading = np.where(v == 0, np.where(np.abs(pull) > grip, np.sign(pull), 0.0), heading)
    net = np.where(heading == 0, 0.0, pull - grip * heading)
    lasts = np.minimum(duration, _stops(v, net, beta))
    phi1, phi2 = _phi(beta, lasts)
    x, end = x + v * phi1 + net * phi2, v - (beta * v - net) * phi1
    rest = duration - lasts
    if not np.any(rest > 0):
        return x, end
    again = np.where((rest > 0) & (np.abs(pull) > grip), pull - grip * np.sign(pull), 0.0)
    phi1, phi2 = _phi(beta, rest)
    return x + again * phi2, np.where(rest > 0, again * phi1, end)


def _stops(v, net, beta):
    """Time until v, with v' = net - beta v, comes to zero [s]; infinity where it does not."""
    brakes = v * net < 0
    ratio = np.where(brakes, -v / np.where(brakes, net, 1.0), 0.0)
    z = beta * ratio
    brakes = brakes & (z > -1)
    z = np.where(brakes, z, 0.0)
    tiny = np.abs(z) < 1e-300
    return np.where(brakes, ratio * np.where(tiny, 1.0, np.log1p(z) / np.where(tiny, 1.0, z)), np.inf)


def _phi(beta, t):
    """The integral of e^(-beta s) and of it again, from 0 to t."""
    z = beta * t
    small = np.abs(z) < SERIES
    safe = np.where(small, 1.0, z)
    one = np.where(small, 1 - z / 2 * (1 - z / 3 * (1 - z / 4 * (1 - z / 5))), -np.expm1(-safe) / safe)
    two = np.where(small, 0.5 - z / 6 * (1 - z / 4 * (1 - z / 5 * (1 - z / 6))), (1 - one) / safe)
    return t * one, t * t * two
