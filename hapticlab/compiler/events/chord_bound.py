"""How far what moves linearly may stray from the chord between both ends of a period: a bound, computed beforehand."""

import math

import numpy as np

from ..algebra.matrix_exponential import exponential

#: what rounding may add to a bound
INFLATED = 1 + 1e-6


def strays(A, c, h, degree, scale):
    """The largest distance of c y from its chord over [0, h], for a unit of each rate and of each drive.

    y(tau) = y(0) + Psi_0(tau) y'(0) + sum of Psi_j(tau) r_j for y'' = A y' + r_1 + r_2 tau + ..., the Psi_j of
    :func:`~hapticlab.compiler.algebra.matrix_exponential.held`. The largest of places h/16 apart or nearer; between two
    of them the second derivative bounds the rest, |row e^(H s)| <= |row| e^(|H| s).

    Parameters
    ----------
    A : array of shape (S, S)
    c : array of shape (S,)
    h : float
        Period [s].
    degree : int
        Of the drive.
    scale : array of shape (S,)
        Sizes of the states beside each other.

    Returns
    -------
    array of shape (degree + 1, S)

    Examples
    --------
    >>> import numpy as np
    >>> A, one = np.array([[0.0, 1.0], [0.0, 0.0]]), np.ones(2)
    >>> strays(A, np.array([1.0, 0.0]), 2.0, 0, one).round(3).tolist()  # h^2/8 = 0.5 for an acceleration of 1
    [[0.0, 0.502]]
    """
    n, ratio = len(A), scale[None, :] / scale[:, None]
    H = np.zeros((n * (degree + 2),) * 2)
    H[:n, :n] = A * h * ratio
    for k in range(degree + 1):
        H[k * n : (k + 1) * n, (k + 1) * n : (k + 2) * n] = np.eye(n)
    places = max(16, math.ceil(8 * np.abs(H[:n, :n]).sum(axis=1).max(initial=0.0)))
    E, row = exponential(H / places), np.r_[c * scale, np.zeros(n * (degree + 1))]
    rows = [row]
    for _ in range(places):
        rows.append(rows[-1] @ E)
    rows = np.array(rows)
    chord = np.linspace(0.0, 1.0, places + 1)[:, None] * (rows[-1] - rows[0])
    between = (np.abs(rows @ H @ H) @ exponential(np.abs(H) / places)).max(axis=0) / (8 * places**2)
    most = (np.abs(rows - rows[0] - chord).max(axis=0) + between)[n:].reshape(degree + 1, n)
    return most * INFLATED * h ** np.arange(1, degree + 2)[:, None] / scale


def power_strays(k):
    """The largest distance of theta^k from its chord over [0, 1]."""
    place = k ** (-1 / (k - 1))
    return (place - place**k) * INFLATED
