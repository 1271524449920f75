"""Coulomb friction located inside the period: slip, stop, stick, break away, reverse; nothing is smeared.

Over a piece h with b h/M and k h^2/M small, a slipping handle obeys v'' = -(b/M) v' - (k/M) v. Its velocity is a
Taylor polynomial to machine accuracy, and its acceleration changes sign at most once: so it stops where the polynomial
has its first zero, found by a fixed number of safeguarded Newton steps. A stuck handle waits until the net force,
linear in time, leaves [-coulomb, coulomb]. All of it is straight-line arithmetic; unneeded phases last no time.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from ...compiler.ir.trace import equal, maximum, minimum, select, sqrt
from ...errors import PaddleError

#: number of terms -> growth rate of the derivatives, per piece, for which the first neglected term is below 1e-17
TERMS = {8: 0.028, 12: 0.2, 20: 1.0}
#: from the zero of the parabola: over 6000 random pieces the worst error is 2e-7, 4e-13, 1e-15 after 4, 5, 6
NEWTON_STEPS = 6
#: pieces of a period; beyond, the linked program would be past a hundred thousand instructions
MOST_PIECES = 64
#: a bound told in three digits is still inside
ROUNDED_UP = 1.006


class Piece(NamedTuple):
    """A stretch of time and the coefficients in it."""

    h: Any  #: duration [s]
    gain: Any  #: h/M [s/kg], a force's change of velocity
    beta: Any  #: b h/M
    kappa: Any  #: k h^2/M, or None without a spring
    k: Any  #: [N/m], or None
    coulomb: Any  #: [N]
    terms: int


def resolution(length, M, b, k):
    """Number of pieces of a stretch [s], and of Taylor terms in each; arrays for arrays.

    The derivatives of v grow by at most g h from one to the next, where g solves g^2 = (b/M) g + k/M; h is chosen so
    that g h <= 1, which also leaves room for one zero of a homogeneous solution only.
    """
    g = growth(M, b, k)
    pieces = np.maximum(1, np.ceil(g * length)).astype(int)
    enough = np.searchsorted(list(TERMS.values()), g * length / pieces)
    return pieces, np.array(list(TERMS))[enough]


def growth(M, b, k):
    """Return by how much the derivatives of v grow, each beside the one before [1/s]."""
    with np.errstate(over="ignore"):
        rate = np.asarray(b, float) / M
        return (rate + np.sqrt(rate**2 + 4 * np.asarray(k, float) / M)) / 2


def check_pieces(length, M, b, k, *, m, T):
    """Refuse a stretch [s] of more than MOST_PIECES, naming the handle's m and T; of arrays, where it has the most."""
    arrays = np.broadcast_arrays(growth(M, b, k), length, M, b, k, m, T)
    g, length, M, b, k, m, T = (a.flat[np.argmax(arrays[0] * arrays[1])].item() for a in arrays)
    if not g * length <= MOST_PIECES:
        most = MOST_PIECES / length
        least = m - M + (b + k / most) / most
        sooner = f"T <= {T * MOST_PIECES / (g * length) / ROUNDED_UP:.3g} s, " if math.isfinite(g) else ""
        raise PaddleError(
            f"m = {m:g} kg, T = {T:g} s, coulomb > 0, and b = {b:g} N s/m with the hand's: the handle settles in "
            f"{1 / g:.3g} s, which would divide the period into {g * length:.3g} pieces; at most {MOST_PIECES}. Use m >= "
            f"{least * ROUNDED_UP:.3g} kg, {sooner}a softer or less damped hand, or coulomb=0."
        )


def slide(piece, x, v, u, d=None):
    """Advance over one piece under the force u + d t [N] and friction; d is None where the force is constant.

    Returns
    -------
    x, v : position [m] and velocity [m/s] at its end; v is exactly zero where the handle is stuck.
    """
    d = None if d is None else d * piece.h
    begun = 0.0  # of the piece; times are in pieces from here on
    # A constant force allows one stop in a piece, a ramp two.
    for searching in (True, False) if d is None else (True, True, False):
        net = u if d is None else u + d * begun
        if piece.k is not None:
            net = net - piece.k * x
        stuck = equal(v, 0.0) & (abs(net) <= piece.coulomb)
        wait = _wait(stuck, net, d, piece.coulomb, 1.0 - begun)
        if d is not None:
            net = net + d * wait
        heading = select(equal(v, 0.0), net if d is None else select(stuck, d, net), v)
        slipping = net - select(heading < 0.0, -piece.coulomb, piece.coulomb)
        series = _velocity_series(piece, v, slipping, d)
        begun = begun + wait
        lasting = rest = 1.0 - begun
        if searching:
            speed = [select(heading < 0.0, -c, c) for c in series]
            lasting, stopped = _first_zero(speed, rest, turns=d is not None)
        x = x + piece.h * (lasting * _at([c / (j + 1) for j, c in enumerate(series)], lasting))
        v = _at(series, lasting)
        v = select(stopped, 0.0, v) if searching else v
        begun = begun + lasting
    return x, v


def _wait(stuck, net, d, coulomb, rest):
    """Time that the handle stays stuck [s], at most rest."""
    if d is None:
        return select(stuck, rest, 0.0)
    still = equal(d, 0.0)
    limit = select(d < 0.0, -coulomb, coulomb)
    until = (limit - net) / select(still, 1.0, d)
    return select(stuck, select(still, rest, minimum(maximum(until, 0.0), rest)), 0.0)


def _velocity_series(piece, v, force, d):
    """Return the Taylor coefficients of v: v^(j+1) = -(b/M) v^(j) - (k/M) v^(j-1), in time over the piece."""
    derivatives = [v, piece.gain * force - piece.beta * v]
    for j in range(1, piece.terms):
        following = -piece.beta * derivatives[-1]
        if piece.kappa is not None:
            following = following - piece.kappa * derivatives[-2]
        if j == 1 and d is not None:
            following = following + piece.gain * d
        derivatives.append(following)
    return [value * (1 / math.factorial(j)) for j, value in enumerate(derivatives)]


def _first_zero(series, rest, turns):
    """Return when the speed, positive at first, is zero again (rest if it is not), and whether it is."""
    end = rest
    if turns:
        # A ramp can stop the handle and pull it on: both ends move forward, the turning point does not.
        rate = [j * c for j, c in enumerate(series)][1:]
        dips = (rate[0] < 0.0) & (_at(rate, rest) > 0.0)
        end = select(dips, _zero([-c for c in rate], rest, rest * 0.5), rest)
    stopped = _at(series, end) <= 0.0
    return select(stopped, _zero(series, end, _zero_of_parabola(*series[:3])), rest), stopped


def _zero_of_parabola(c, b, a):
    """Return the first positive zero of c + b t + a t^2, c >= 0; its vertex if it has none, -1 if it only rises."""
    root = sqrt(maximum(b * b - 4.0 * (a * c), 0.0))
    rising = b > 0.0
    over, under = select(rising, b + root, 2.0 * c), select(rising, -2.0 * a, root - b)
    return select(under > 0.0, over / select(under > 0.0, under, 1.0), -1.0)


def _zero(series, end, guess):
    """Return where a polynomial that is positive at 0 and not at end is zero: Newton, bisecting where that leaves."""
    low, high = 0.0, end
    at = select((0.0 <= guess) & (guess <= end), guess, end * 0.5)
    rate = [j * c for j, c in enumerate(series)][1:]
    for _ in range(NEWTON_STEPS):
        value, slope = _at(series, at), _at(rate, at)
        low, high = select(value > 0.0, at, low), select(value > 0.0, high, at)
        step = at - value / select(equal(slope, 0.0), 1.0, slope)
        at = select((low <= step) & (step <= high), step, (low + high) * 0.5)
    return at


def _at(series, time):
    """Evaluate by Horner's rule."""
    total = series[-1]
    for coefficient in reversed(series[:-1]):
        total = total * time + coefficient
    return total
