"""How a handle on a spring and a damper moves under a force that is held or ramps, exact for any mass.

M x'' = u + d t - b x' - k x. The matrix exponential is exact where nothing happens many times over within the step; beside
a damper that stops a light handle in a billionth of it, or a spring that swings a thousand times, closed forms are.
"""

import math

import numpy as np

from ...compiler.algebra.matrix_exponential import exponential

#: entry of the transition -> its unit; u is a force, d the rate of a force
PHI = {
    "xx": "1", "xv": "s", "xu": "m/N", "xd": "m s/N", "vx": "1/s", "vv": "1", "vu": "m/(N s)", "vd": "m/N",
}  # fmt: skip
#: sqrt(k/M) h [rad] from which a spring's swings are taken in closed form, and k h^2/M from which at any damping
FAST, SETTLED = 100.0, 1e8
#: k h^2/M at most, where no damper ends the swings: rounding of the angle alone is 1e-7 rad there
MOST_SWINGS = 1e18
#: b h/M from which a damper does end them: e^-40 is below the rounding of what stays
RINGS = 80.0
#: b h/M, k h^2/M and h/M [s/kg] at most, so that all that is made of them is finite
LARGEST = 1e300


def transition(M, b, k, h):
    """Return the exact map over h seconds of M x'' = u + d t - b x' - k x, as {entry: coefficient}.

    Parameters
    ----------
    M, b, k, h : float or array
        Mass [kg] > 0, damping [N s/m], stiffness [N/m], duration [s] >= 0.

    Returns
    -------
    dict of str to float or array
        x(h) = xx x + xv v + xu u + xd d and v(h) = vx x + vv v + vu u + vd d.

    Examples
    --------
    >>> from hapticlab.device.simulated.transition import transition
    >>> phi = transition(M=0.05, b=0.0, k=0.0, h=1e-3)
    >>> round(phi["xu"] * 1e6, 9), round(phi["vu"], 9)      # h**2/2M and h/M
    (10.0, 0.02)
    """
    # In time over h, with v h, u h^2/M and d h^3/M as coordinates, every entry is of order one and so keeps its
    # relative accuracy; in SI units h^3/6M would drown beside 1. On a spring that oscillates within h, v h/(w h).
    M, b, k, h = np.broadcast_arrays(*(np.asarray(a, float) for a in (M, b, k, h)))
    kappa, beta = k * h * h / M, b * h / M
    closed = _closed_forms(beta, kappa)
    left = ~np.logical_or.reduce([lanes for lanes, _ in closed])
    stiff, damped = np.where(left, kappa, 0.0), np.where(left, beta, 0.0)
    s = np.sqrt(np.maximum(stiff, 1.0))
    A = np.zeros((*h.shape, 4, 4))
    A[..., 0, 1], A[..., 1, 2], A[..., 2, 3] = s, 1 / s, 1
    A[..., 1, 0], A[..., 1, 1] = -stiff / s, -damped
    E = exponential(A)
    for lanes, rows in closed:
        E[lanes, :2] = rows(beta[lanes], kappa[lanes])
    scale = {"x": 1.0, "v": h / s, "u": h * h / M, "d": h**3 / M}
    row = {"x": (0, 1.0), "v": (1, np.where(h > 0, s / np.where(h > 0, h, 1.0), 0.0))}
    column = {name: position for position, name in enumerate("xvud")}
    found = {e: E[..., row[e[0]][0], column[e[1]]] * scale[e[1]] * row[e[0]][1] for e in PHI}
    return found if h.ndim else {e: float(c) for e, c in found.items()}


def _closed_forms(beta, kappa):
    """Return (where, its rows of e^A) for what squaring a matrix loses: next to no mass, with a spring or without."""
    free, root = kappa == 0, np.sqrt(kappa)
    creeps = ~free & (beta >= 16) & (beta >= 4 * root)
    return (free, dragged), (creeps, creeping), (~creeps & ((kappa >= SETTLED) | ((root >= FAST) & (beta < root))), swinging)


def dragged(beta, _=None):
    """Return the first rows of e^A without a spring, shape (n, 2, 4), for an array of b h/M >= 0, however large.

    A mass alone coasts without any rounding: 1, 1, 1/2, 1/6.
    """
    phi = _phi(beta)
    one, zero = np.ones_like(beta), np.zeros_like(beta)
    return np.moveaxis(np.array([[one, *phi[1:]], [zero, *phi[:3]]]), -1, 0)


def creeping(beta, kappa):
    """Return the rows on a spring with far more damping than it needs: by the rates of b against m and of k against b.

    Both from products, as differences would leave nothing of the slow one.
    """
    away = np.sqrt(beta / 2 - np.sqrt(kappa)) * np.sqrt(beta / 2 + np.sqrt(kappa))
    fast = beta / 2 + away
    slow, gap = kappa / fast, 2 * away
    soon, late = _phi(fast), _phi(slow)
    xx, vv = (fast * late[0] - slow * soon[0]) / gap, (fast * soon[0] - slow * late[0]) / gap
    return _rows(kappa, xx, vv, *((b - a) / gap for a, b in zip(soon[:3], late[:3], strict=True)))


def swinging(beta, kappa):
    """Return the rows on a spring that swings many times within h, or has come to rest before its end."""
    away = np.sqrt(np.abs(beta / 2 - np.sqrt(kappa))) * np.sqrt(beta / 2 + np.sqrt(kappa))
    away = np.maximum(away, 1.0)  # less only where e^-beta/2 leaves nothing
    cos, sin = np.exp(-beta / 2) * np.cos(away), np.exp(-beta / 2) * np.sin(away) / away
    xx = cos + beta / 2 * sin
    xu = (1 - xx) / kappa
    return _rows(kappa, xx, cos - beta / 2 * sin, sin, xu, (1 - sin - beta * xu) / kappa)


def _rows(kappa, xx, vv, xv, xu, xd):
    return np.moveaxis(np.array([[xx, xv, xu, xd], [-kappa * xv, vv, xv, xu]]), -1, 0)


def _phi(beta):
    """Return phi_0 ... phi_3 of -beta: phi_0 = e^-beta and phi_j = (1/(j-1)! - phi_j-1)/beta.

    Downwards from the series of phi_3 where that would cancel.
    """
    series, small = np.zeros_like(beta), np.minimum(beta, 1.0)
    for j in range(20, 2, -1):  # by Horner's rule, up to beta^17/20!
        series = 1 / math.factorial(j) - small * series
    up, down, large = [np.exp(-beta)], [series], np.maximum(beta, 1.0)
    for j in range(3):
        up.append((1 / math.factorial(j) - up[-1]) / large)
        down.insert(0, 1 / math.factorial(2 - j) - small * down[0])
    return [np.where(beta < 1, low, high) for low, high in zip(down, up, strict=True)]


def smallest_mass(b, k, h):
    """Return the least mass [kg] from which on :func:`transition` is right, with b, k and h as it takes them.

    Examples
    --------
    >>> print(f"{smallest_mass(b=0.0, k=1e6, h=1e-3):.1e}", f"{smallest_mass(b=0.1, k=200.0, h=1e-3):.1e}")
    1.0e-18 1.0e-303
    """
    finite = np.maximum(np.maximum(h, b * h), k * h * h) / LARGEST
    swings = k * h * h / MOST_SWINGS
    return np.maximum(finite, np.where(b * h < RINGS * swings, swings, 0.0))
